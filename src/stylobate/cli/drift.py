"""`stylobate drift`: mean transport velocity of a column on a vibrating base."""

import math
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stylobate import config, conveying
from stylobate.cli.command import command
from stylobate.cli.declarations import AXES, COMPUTING, OUTPUT_OR_STORE, Option, run_numbers
from stylobate.cli.many_runs import finish, run_study, study_values
from stylobate.cli.options import Options
from stylobate.cli.output import DEGREES, Practical, practical, print_table
from stylobate.cli.overlay import merge, with_axes
from stylobate.cli.parts import COLUMN, MOTION_WITHOUT_RECORDS, SLIDING
from stylobate.cli.saved import axes_of, number_of_runs, open_saved, provenance_of, study_summary
from stylobate.errors import FileError, ParameterError
from stylobate.run_arguments import SharedByRuns

if TYPE_CHECKING:
    import xarray as xr

# Maximum rows of a table; longer tables show only the fastest runs.
_ROWS, _FASTEST = 40, 12


@command(
    Option("late", "number of last periods of the initial runs over which means are taken; 20 by default", int),
    Option("tolerance", "relative half-width of the interval of a speed; 0.02 by default"),
    Option("most_periods", "maximum duration of a run in periods; 2000 by default"),
    Option("confidence", "confidence level of the intervals; 0.9 by default"),
    argument="TOML description, or a saved drift (.nc) or store (.zarr) to show or repeat",
    groups=(
        AXES,
        run_numbers(SharedByRuns).without("duration"),
        COLUMN,
        SLIDING,
        MOTION_WITHOUT_RECORDS,
        COMPUTING,
        OUTPUT_OR_STORE,
    ),
)
def drift(options: Options) -> None:
    """Compute the mean transport velocity of a column on a vibrating base.

    One or two numbers of column, model, base motion or initial state vary: friction-coefficient, acceleration,
    angular-frequency, stroke, angle … The model is sliding. Each run lasts 60 periods at first, and longer until the
    interval of its mean velocity is narrow enough. A part that accelerates beyond the friction angle has no mean
    velocity. The result also holds the mean rate of rotation about the axis. Examples:

    stylobate drift --radius 20mm --height 30mm --density 7800 --friction-coefficient 0.3 --motion stroke
    --frequency 50Hz --angle 30deg --x stroke 0.1mm 1.2mm 23 --tilt 0 0.1deg --figure drift.png

    stylobate drift drift.toml --y friction-coefficient 0.1 0.5 9 --output drift.zarr
    """
    source = options["source"]
    result, complete = run_study(
        options,
        open_saved(source),
        lambda saved: _with_speeds(saved, source),
        lambda saved: _prepared(saved, options),
    )
    finish(result, options, _summary, _print, complete=complete)


def _prepared(saved: "xr.Dataset | None", options: Options) -> "tuple[Callable[..., xr.Dataset], config.Setup]":
    from stylobate.studies.sweeps.quantities import check_quantities  # noqa: PLC0415

    kind = conveying.config.DriftConfig
    values = with_axes(study_values(saved, options, kind, {"model": {"kind": "sliding"}}), options, "drift")
    if not values.get("drift"):
        message = (
            "drift.x is missing. State what varies: --x acceleration 2 30 29, or --x acceleration 9 9 1 for one run."
        )
        raise ParameterError(message)
    merge(values, "drift", options.pick("late", "tolerance", "most_periods", "confidence"))
    setup = kind.parse(values).build()
    for place, name in zip("xy", setup.options["over"], strict=False):
        check_quantities(f"drift.{place}", setup.model, [name], setup.motion)
    return conveying.drift, setup


def _with_speeds(saved: "xr.Dataset", source: Path | None) -> "xr.Dataset":
    """Return a saved drift; add speeds and throw numbers to the runs of a store."""
    from stylobate.conveying.transport import drift_of_runs  # noqa: PLC0415

    if "speed_high" in saved:
        return saved
    if saved.attrs["kind"] not in ("sweep", "drift") or "mean_twist_rate" not in saved:
        message = f"{source}: no drift (got a {saved.attrs['kind']}). Show it with stylobate map."
        raise FileError(message)
    setup = conveying.config.DriftConfig.of_saved(provenance_of(saved), axes_of(saved)).build()
    arguments = {name: value for name, value in setup.options.items() if name not in ("over", "late")}
    return drift_of_runs(saved, setup.model, setup.motion, **arguments)


def _summary(result: "xr.Dataset") -> dict[str, Any]:
    return study_summary(result, drifts=_rows(result))


def _rows(result: "xr.Dataset") -> list[dict[str, Any]]:
    """Return the numbers of each run, in the order of its names."""
    names = [str(dim) for dim in result["outcome"].dims]
    runs = result.stack(run=names)
    meanings = str(result["contact_class"].attrs["flag_meanings"]).split()
    return [_row(runs.isel(run=place), names, meanings) for place in range(runs.sizes["run"])]


def _row(one: "xr.Dataset", names: list[str], meanings: list[str]) -> dict[str, Any]:
    x, y = one["mean_velocity"].to_numpy()
    numbers = ("transport_speed", "speed_low", "speed_high", "periods_computed", "mean_twist_rate", "throw_number")
    known = str(one["transport"].attrs["flag_meanings"]).split()
    return {
        **{name: float(one[name]) for name in names},
        "mean_velocity": [float(x), float(y)],
        **{name: float(one[name]) for name in numbers},
        "transport": known[int(one["transport"])],
        "contact_class": meanings[int(one["contact_class"]) + 1],
    }


def _print(result: "xr.Dataset") -> None:
    from stylobate.conveying.contact_maps import knife_edge_remarks  # noqa: PLC0415

    rows = _rows(result)
    names = [str(dim) for dim in result["outcome"].dims]
    title = number_of_runs(result, f" over {' and '.join(names)}")
    if len(rows) > _ROWS:
        rows = sorted(rows, key=lambda row: -_or_zero(row["transport_speed"]))[:_FASTEST]
        title += f"; the {_FASTEST} fastest are shown, --json shows all"
    axes = {name: practical([row[name] for row in rows], str(result[name].attrs.get("units", "1"))) for name in names}
    pace = practical([row["transport_speed"] for row in rows], "m s-1")
    twist = Practical(DEGREES.factor, "°/s")
    print_table(
        "; ".join([title, *knife_edge_remarks(result)]),
        [_cells(row, axes, pace, twist) for row in rows],
        (
            *(f"{name.replace('_', ' ')} {one.bracketed}".rstrip() for name, one in axes.items()),
            f"velocity x, y {pace.bracketed}",
            f"speed {pace.bracketed}",
            f"twist rate {twist.bracketed}",
            "throw number",
            "contact class",
        ),
    )


def _speed(row: Mapping[str, Any], unit: Practical) -> str:
    """Write the speed with the half-width of its interval, or the reason why there is none."""
    if row["transport"] in ("ACCELERATES", "ENDED"):
        return str(row["transport"]).lower()
    half = row["speed_high"] - row["transport_speed"]
    wide = " (unsettled)" if row["transport"] == "UNSETTLED" else ""
    return f"{unit.factor * row['transport_speed']:.4g} ± {unit.factor * half:.2g}{wide}"


def _or_zero(speed: float) -> float:
    return speed if math.isfinite(speed) else 0.0


def _cells(row: Mapping[str, Any], axes: Mapping[str, Practical], pace: Practical, twist: Practical) -> list[str]:
    x, y = (pace.factor * one for one in row["mean_velocity"])
    moves = math.isfinite(row["transport_speed"])
    return [
        *(f"{unit.factor * row[name]:.6g}" for name, unit in axes.items()),
        f"{x:.4g}, {y:.4g}" if moves else "none",
        _speed(row, pace),
        f"{twist.factor * row['mean_twist_rate']:.4g}",
        f"{row['throw_number']:.4g}",
        row["contact_class"].lower().replace("_", " "),
    ]
