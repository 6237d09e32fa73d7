"""`stylobate drift`: where a vibrating base walks the column to, the question of a conveyor."""

import math
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from stylobate import conveying
from stylobate.cli import options as opt
from stylobate.cli.given import Given
from stylobate.cli.many_runs import check_outputs, computed, end, is_to_compute, write
from stylobate.cli.output import print_json, print_table
from stylobate.cli.saved import axes_of, open_saved, plain_axes, provenance_of
from stylobate.cli.source import read_source
from stylobate.errors import FileError, ParameterError
from stylobate.text import plural

if TYPE_CHECKING:
    import xarray as xr

Source = Annotated[
    Path | None,
    typer.Argument(
        help="TOML description, or a saved drift (.nc) or store (.zarr) to show or repeat", show_default=False
    ),
]
Late = Annotated[int | None, typer.Option(help="over how many of the last periods means are taken [default: 20]")]

# Tables longer than this show the fastest runs only.
_ROWS, _FASTEST = 40, 12


def drift(
    context: typer.Context,
    source: Source = None,
    x: opt.X = None,
    y: opt.Y = None,
    x_spacing: opt.XSpacing = None,
    y_spacing: opt.YSpacing = None,
    late: Late = None,
    tilt: opt.Tilt = None,
    tilt_rate: opt.TiltRate = None,
    spin: opt.Spin = None,
    periods: opt.Periods = None,
    method: opt.Method = None,
    rtol: opt.Rtol = None,
    tilt_limit: opt.TiltLimit = None,
    rest_energy: opt.RestEnergy = None,
    max_steps: opt.MaxSteps = None,
    shape: opt.Shape = None,
    radius: opt.Radius = None,
    height: opt.Height = None,
    density: opt.Density = None,
    inner_radius: opt.InnerRadius = None,
    top_radius: opt.TopRadius = None,
    slenderness: opt.Slenderness = None,
    gravity: opt.Gravity = None,
    model: opt.Model = None,
    damping: opt.Damping = None,
    spin_damping: opt.SpinDamping = None,
    rolling_resistance: opt.RollingResistance = None,
    restitution: opt.Restitution = None,
    passage_tilt: opt.PassageTilt = None,
    friction_coefficient: opt.FrictionCoefficient = None,
    static_friction_coefficient: opt.StaticFriction = None,
    patch: opt.Patch = None,
    incline: opt.Incline = None,
    incline_direction: opt.InclineDirection = None,
    motion: opt.Motion = None,
    acceleration: opt.Acceleration = None,
    angular_frequency: opt.AngularFrequency = None,
    frequency: opt.Frequency = None,
    amplitude: opt.Amplitude = None,
    phase: opt.Phase = None,
    direction: opt.Direction = None,
    angle: opt.Angle = None,
    sense: opt.Sense = None,
    stroke: opt.Stroke = None,
    diameter: opt.Diameter = None,
    rpm: opt.Rpm = None,
    start_phase: opt.StartPhase = None,
    ramp: opt.Ramp = None,
    resume: opt.Resume = False,
    executor: opt.Executor = None,
    threads: opt.ThreadCount = None,
    figure: opt.Figure = None,
    output: opt.OutputOrStore = None,
    as_json: opt.Json = False,
) -> None:
    """Tell at which mean speed a vibrating base walks the column along, and how fast it turns it.

    Over one quantity or two of column, model, motion or start: friction-coefficient, acceleration, angular-frequency …
    The model is sliding. Means are over the last periods of 60. Examples:

    stylobate drift --radius 0.02 --height 0.03 --density 7800 --friction-coefficient 0.3 --motion oblique
    --angle 0.52 --angular-frequency 60 --x acceleration 2 30 29 --figure drift.png

    stylobate drift drift.toml --y friction-coefficient 0.1 0.5 9 --output drift.zarr
    """
    from stylobate.studies.sweeps.quantities import check_quantities  # noqa: PLC0415

    given, complete = Given.of(context), True
    check_outputs(given)
    saved = open_saved(source)
    if not is_to_compute(saved, given):
        assert saved is not None
        found = _walked(saved, source)
    else:
        if saved is None:
            described = {"model": {"kind": "sliding"}, **read_source(source)}
        else:
            described = conveying.config.DriftConfig.of_saved(provenance_of(saved), axes_of(saved)).values()
        fields = conveying.config.DriftConfig.model_fields
        values = opt.overlay_axes(opt.overlay(described, given, fields), given, "drift")
        if not values.get("drift"):
            message = "drift.x is missing: what varies, such as --x acceleration 2 30 29"
            raise ParameterError(message)
        setup = conveying.config.DriftConfig.parse(opt.overlay_late(values, given, "drift")).build()
        for place, name in zip("xy", setup.options["over"], strict=False):
            check_quantities(f"drift.{place}", setup.model, [name])
        found, complete = computed(conveying.drift, setup, given, "drift")
    write(found, given)
    if as_json:
        print_json(_summary(found))
    else:
        _print(found)
    end(found, given, complete=complete)


def _walked(saved: "xr.Dataset", source: Path | None) -> "xr.Dataset":
    """Return a saved drift; the runs of a store with speeds and throw numbers."""
    from stylobate.conveying.transport import walked  # noqa: PLC0415

    if "transport_speed" in saved:
        return saved
    if saved.attrs["kind"] not in ("sweep", "drift") or "mean_twist_rate" not in saved:
        message = f"{source} holds a {saved.attrs['kind']}, and no drift; see stylobate map"
        raise FileError(message)
    setup = conveying.config.DriftConfig.of_saved(provenance_of(saved), axes_of(saved)).build()
    return walked(saved, setup.model, setup.motion)


def _summary(found: "xr.Dataset") -> dict[str, Any]:
    return {
        "kind": found.attrs["kind"],
        **plain_axes(found),
        "drifts": _rows(found),
        "computed": int(found["computed"]),
        "runs": found["outcome"].size,
        "provenance": provenance_of(found),
    }


def _rows(found: "xr.Dataset") -> list[dict[str, Any]]:
    """Return what is told of each run, in the order of its names."""
    names = [str(dim) for dim in found["outcome"].dims]
    runs = found.stack(run=names)
    meanings = str(found["contact_class"].attrs["flag_meanings"]).split()
    return [_row(runs.isel(run=place), names, meanings) for place in range(runs.sizes["run"])]


def _row(one: "xr.Dataset", names: list[str], meanings: list[str]) -> dict[str, Any]:
    x, y = one["mean_velocity"].to_numpy()
    numbers = ("transport_speed", "mean_twist_rate", "throw_number")
    return {
        **{name: float(one[name]) for name in names},
        "mean_velocity": [float(x), float(y)],
        **{name: float(one[name]) for name in numbers},
        "contact_class": meanings[int(one["contact_class"]) + 1],
    }


def _print(found: "xr.Dataset") -> None:
    told = _rows(found)
    names = [str(dim) for dim in found["outcome"].dims]
    done, total = int(found["computed"]), found["outcome"].size
    title = f"{plural(total, 'run')} over {' and '.join(names)}" + (f", {done} of them done" if done < total else "")
    if total > _ROWS:
        told = sorted(told, key=lambda row: -_or_zero(row["transport_speed"]))[:_FASTEST]
        title += f"; the {_FASTEST} fastest are shown, --json tells all"
    print_table(
        title,
        [_cells(row, names) for row in told],
        (*(name.replace("_", " ") for name in names), "velocity x, y", "twist rate", "throw number", "what it did"),
    )


def _or_zero(speed: float) -> float:
    return speed if math.isfinite(speed) else 0.0


def _cells(row: Mapping[str, Any], names: list[str]) -> list[str]:
    x, y = row["mean_velocity"]
    return [
        *(f"{row[name]:.6g}" for name in names),
        f"{x:.4g}, {y:.4g} m/s",
        f"{row['mean_twist_rate']:.4g} rad/s",
        f"{row['throw_number']:.4g}",
        row["contact_class"].lower().replace("_", " "),
    ]
