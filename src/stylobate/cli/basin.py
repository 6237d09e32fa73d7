"""`stylobate basin`: basins of attraction over initial conditions."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stylobate import config, studies
from stylobate.cli.command import command
from stylobate.cli.declarations import AXES, COMPUTING, EARLY_END, OUTPUT_OR_STORE, RECORD, Group, Option, run_numbers
from stylobate.cli.many_runs import finish, run_study, study_values
from stylobate.cli.options import Options
from stylobate.cli.output import print_table
from stylobate.cli.overlay import with_axes
from stylobate.cli.parts import COLUMN, MODEL_WITHOUT_SLIDING, MOTION
from stylobate.cli.saved import axes_of, number_of_runs, open_saved, provenance_of, study_summary
from stylobate.cli.usage import named_range
from stylobate.errors import FileError
from stylobate.run_arguments import SharedByRuns, Stroboscopic

if TYPE_CHECKING:
    import xarray as xr

_INITIAL_CONDITIONS = Group.of(
    "Initial conditions",
    Option("random", "number of initial conditions to draw in the ranges --over", int),
    Option("seed", "seed of the draw; 0 by default", int),
    Option("over", "range of an initial condition that is drawn; repeat it", list[str], metavar="NAME LOW HIGH"),
)


@command(
    argument="TOML description, or saved basins (.nc) or their store (.zarr) to show or repeat",
    groups=(
        AXES,
        _INITIAL_CONDITIONS,
        run_numbers(SharedByRuns),
        run_numbers(Stroboscopic),
        EARLY_END,
        COLUMN,
        MODEL_WITHOUT_SLIDING,
        MOTION,
        RECORD,
        COMPUTING,
        OUTPUT_OR_STORE,
    ),
)
def basin(options: Options) -> None:
    """Compute basins of attraction over initial conditions, and their fractions.

    The initial conditions are a grid of two of tilt-x, tilt-y, tilt-rate-x, tilt-rate-y and start-phase, or a random
    sample. Saved basins are shown; options that change them compute them again. Examples:

    stylobate basin --slenderness 0.1 --damping 0.1 --motion circular --acceleration 0.02 --angular-frequency 1.2
    --x tilt-x -0.08 0.08 200 --y tilt-y -0.08 0.08 200 --periods 100 --figure basin.png

    stylobate basin basin.toml --random 10000 --seed 1 --over tilt-x -0.08 0.08 --over tilt-rate-x -0.1 0.1
    """
    source = options["source"]
    result, complete = run_study(
        options,
        open_saved(source),
        lambda saved: _labelled(saved, source, options["confidence"]),
        lambda saved: _prepared(saved, options),
    )
    finish(result, options, _summary, _print, complete=complete)


def _prepared(saved: "xr.Dataset | None", options: Options) -> "tuple[Callable[..., xr.Dataset], config.Setup]":
    values = _with_sample(study_values(saved, options, config.BasinConfig), options)
    setup = config.BasinConfig.parse(with_axes(values, options, "basin")).build()
    _check_names(setup.options)
    return studies.basins, setup


def _with_sample(values: dict[str, Any], options: Options) -> dict[str, Any]:
    """Lay the random sample that options state over the values; it replaces a grid in the file."""
    table = values.get("basin", {})
    if not isinstance(table, Mapping):
        return values
    sample = options.pick("random")
    ranges = dict(named_range(text) for text in options["over"] or ())
    if sample or table.get("random") is not None:
        sample |= options.pick("seed")  # a grid has no seed
    if "random" in sample:
        table = {name: value for name, value in table.items() if name not in ("x", "y")}
    if ranges:
        sample["over"] = ranges
    return {**values, "basin": {**table, **sample}} if sample else values


def _check_names(options: Mapping[str, Any]) -> None:
    """Raise ParameterError for a name that is no initial condition; the message names its place."""
    from stylobate.studies.checks import require_starts  # noqa: PLC0415

    places = ["over"] * len(options["over"]) if "count" in options else ["x", "y"]
    for place, name in zip(places, options["over"], strict=True):
        require_starts(f"basin.{place}", {name: None})


def _labelled(saved: "xr.Dataset", source: Path | None, confidence: float | None) -> "xr.Dataset":
    """Return saved basins; add to the runs of a store the attractor of each."""
    from stylobate.studies.maps.attractor_search import NOT_SETTLED  # noqa: PLC0415
    from stylobate.studies.proportions import fraction_interval  # noqa: PLC0415

    if "attractor_name" in saved:
        if confidence is None:
            return saved
        unknown = saved["unsettled"].where(saved["attractor_kind"] != NOT_SETTLED, 0)
        low, high = fraction_interval(saved["count"], unknown, saved["computed"], confidence=confidence)
        ends = {"fraction_low": ("attractor_index", low), "fraction_high": ("attractor_index", high)}
        return saved.assign(ends).assign_attrs(confidence=confidence)
    if "strobe_tilt" not in saved:
        message = f"{source}: runs without stroboscopic samples have no attractors. Show them with stylobate map."
        raise FileError(message)
    setup = config.BasinConfig.of_saved(provenance_of(saved), axes_of(saved)).build()
    share = 0.95 if confidence is None else confidence
    labelled = studies.label_attractors(saved, setup.model, setup.motion, confidence=share)
    return labelled.assign_attrs(kind="basins")


def _summary(result: "xr.Dataset") -> dict[str, Any]:
    return study_summary(
        result,
        attractors=[_attractor(result.isel(attractor_index=i)) for i in range(result.sizes["attractor_index"])],
        unsettled=int(result["unsettled"]),
        confidence=float(result.attrs["confidence"]),
    )


def _attractor(one: "xr.Dataset") -> dict[str, Any]:
    numbers = ("mean_tilt", "peak_tilt", "turns")
    period = int(one["attractor_period"])
    points = {"orbit_point": slice(0, max(period, 1))}
    return {
        "name": str(one["attractor_name"].item()),
        "kind": str(one["attractor_kind"].item()),
        "period": period,
        **{name: float(one[f"attractor_{name}"]) for name in numbers},
        **{name: one[f"attractor_{name}"].isel(points).to_numpy().tolist() for name in ("tilt", "tilt_rate")},
        "count": int(one["count"]),
        **{name: float(one[name]) for name in ("fraction", "fraction_low", "fraction_high")},
    }


def _print(result: "xr.Dataset") -> None:
    confidence = f"{100.0 * float(result.attrs['confidence']):g} % interval"
    summary = _summary(result)
    rows = [
        (
            one["name"],
            f"{one['turns']:.4g}" if one["mean_tilt"] > 0.0 else "",
            f"{one['mean_tilt']:.5g} rad" if one["mean_tilt"] > 0.0 else "",
            str(one["count"]),
            f"{100.0 * one['fraction']:.2f} %",
            f"{100.0 * one['fraction_low']:.2f} to {100.0 * one['fraction_high']:.2f} %",
        )
        for one in summary["attractors"]
    ]
    title = number_of_runs(result, word="initial condition")
    print_table(title, rows, ("attractor", "turns per period", "mean tilt", "runs", "fraction", confidence))
    if summary["unsettled"]:
        from stylobate.studies.maps.attractor_search import REMEDY  # noqa: PLC0415  heavy, as above

        print(REMEDY)
