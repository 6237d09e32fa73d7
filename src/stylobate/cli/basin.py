"""`stylobate basin`: which starts lead where."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from stylobate import config, studies
from stylobate.cli import options as opt
from stylobate.cli.given import Given
from stylobate.cli.many_runs import check_outputs, computed, end, is_to_compute, write
from stylobate.cli.output import print_json, print_table
from stylobate.cli.saved import axes_of, open_saved, plain_axes, provenance_of
from stylobate.cli.source import read_source
from stylobate.errors import FileError
from stylobate.text import plural

if TYPE_CHECKING:
    import xarray as xr

_STARTS = "Starts"

Source = Annotated[
    Path | None,
    typer.Argument(
        help="TOML description, or saved basins (.nc) or their store (.zarr) to show or repeat", show_default=False
    ),
]
Random = Annotated[int | None, typer.Option(help="draw so many starts in the ranges --over", rich_help_panel=_STARTS)]
Seed = Annotated[int | None, typer.Option(help="seed they are drawn with, 0 by default", rich_help_panel=_STARTS)]
Over = Annotated[
    list[str] | None,
    typer.Option(help="range of a start that is drawn; repeat it", metavar="NAME LOW HIGH", rich_help_panel=_STARTS),
]
Strobes = Annotated[int | None, typer.Option(help="last states kept, one a period; 32 by default")]
Confidence = Annotated[float | None, typer.Option(help="of the intervals of the fractions, 0.95 by default")]


@opt.with_waveforms
def basin(
    context: typer.Context,
    source: Source = None,
    x: opt.X = None,
    y: opt.Y = None,
    x_spacing: opt.XSpacing = None,
    y_spacing: opt.YSpacing = None,
    random: Random = None,
    seed: Seed = None,
    over: Over = None,
    tilt: opt.Tilt = None,
    tilt_rate: opt.TiltRate = None,
    spin: opt.Spin = None,
    duration: opt.Duration = None,
    periods: opt.Periods = None,
    strobes: Strobes = None,
    confidence: Confidence = None,
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
    constraint: opt.Constraint = None,
    passage_tilt: opt.PassageTilt = None,
    motion: opt.Motion = None,
    acceleration: opt.Acceleration = None,
    angular_frequency: opt.AngularFrequency = None,
    frequency: opt.Frequency = None,
    amplitude: opt.Amplitude = None,
    phase: opt.Phase = None,
    direction: opt.Direction = None,
    sense: opt.Sense = None,
    stroke: opt.Stroke = None,
    diameter: opt.Diameter = None,
    rpm: opt.Rpm = None,
    start_phase: opt.StartPhase = None,
    ramp: opt.Ramp = None,
    record: opt.RecordFiles = None,
    record_direction: opt.RecordDirections = None,
    single: opt.Single = None,
    sample_record: opt.SampleRecord = None,
    units: opt.Units = None,
    step: opt.TimeStep = None,
    scale: opt.Scale = None,
    rotation: opt.Rotation = None,
    tail: opt.Tail = None,
    resume: opt.Resume = False,
    executor: opt.Executor = None,
    threads: opt.ThreadCount = None,
    figure: opt.Figure = None,
    output: opt.OutputOrStore = None,
    as_json: opt.Json = False,
) -> None:
    """Tell which starts lead to which attractor, and how often: on a grid of two of them, or from a random sample.

    Starts are tilt-x, tilt-y, tilt-rate-x, tilt-rate-y and start-phase. Saved basins are shown; options that change
    them compute them anew. Examples:

    stylobate basin --slenderness 0.1 --damping 0.1 --motion circular --acceleration 0.02 --angular-frequency 1.2
    --x tilt-x -0.08 0.08 200 --y tilt-y -0.08 0.08 200 --periods 100 --figure basin.png

    stylobate basin basin.toml --random 10000 --seed 1 --over tilt-x -0.08 0.08 --over tilt-rate-x -0.1 0.1
    """
    given, complete = Given.of(context), True
    check_outputs(given)
    saved = open_saved(source)
    if not is_to_compute(saved, given):
        assert saved is not None
        found = _labelled(saved, source, given["confidence"])
    else:
        if saved is None:
            described = read_source(source)
        else:
            described = config.BasinConfig.of_saved(provenance_of(saved), axes_of(saved)).values()
        kind = config.BasinConfig
        values = opt.overlay_sample(opt.overlay(described, given, kind.model_fields), given, "basin")
        setup = kind.parse(opt.overlay_axes(values, given, "basin")).build()
        _check_names(setup.options)
        found, complete = computed(studies.basins, setup, given, "basins")
    write(found, given)
    if as_json:
        print_json(_summary(found))
    else:
        _print(found)
    end(found, given, complete=complete)


def _check_names(options: Mapping[str, Any]) -> None:
    """Raise ParameterError for a name that is no start, by its place on the command line or in the file."""
    from stylobate.studies.checks import require_starts  # noqa: PLC0415

    places = ["over"] * len(options["over"]) if "count" in options else ["x", "y"]
    for place, name in zip(places, options["over"], strict=True):
        require_starts(f"basin.{place}", {name: None})


def _labelled(saved: "xr.Dataset", source: Path | None, confidence: float | None) -> "xr.Dataset":
    """Return saved basins; the runs of a store with the attractor that each has come to."""
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
        message = f"{source} holds runs without strobed states, from which no attractors are told; see stylobate map"
        raise FileError(message)
    setup = config.BasinConfig.of_saved(provenance_of(saved), axes_of(saved)).build()
    share = 0.95 if confidence is None else confidence
    labelled = studies.label_attractors(saved, setup.model, setup.motion, confidence=share)
    return labelled.assign_attrs(kind="basins")


def _summary(found: "xr.Dataset") -> dict[str, Any]:
    return {
        "kind": found.attrs["kind"],
        **plain_axes(found),
        "attractors": [_attractor(found.isel(attractor_index=i)) for i in range(found.sizes["attractor_index"])],
        "unsettled": int(found["unsettled"]),
        "computed": int(found["computed"]),
        "runs": found["outcome"].size,
        "confidence": float(found.attrs["confidence"]),
        "provenance": provenance_of(found),
    }


def _attractor(one: "xr.Dataset") -> dict[str, Any]:
    numbers = ("mean_tilt", "largest_tilt", "turns")
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


def _print(found: "xr.Dataset") -> None:
    confidence = f"{100.0 * float(found.attrs['confidence']):g} % interval"
    told = _summary(found)
    rows = [
        (
            one["name"],
            f"{one['turns']:.4g}" if one["mean_tilt"] > 0.0 else "",
            f"{one['mean_tilt']:.5g} rad" if one["mean_tilt"] > 0.0 else "",
            str(one["count"]),
            f"{100.0 * one['fraction']:.2f} %",
            f"{100.0 * one['fraction_low']:.2f} to {100.0 * one['fraction_high']:.2f} %",
        )
        for one in told["attractors"]
    ]
    title = plural(told["runs"], "start") + (f", {told['computed']} done" if told["computed"] < told["runs"] else "")
    print_table(title, rows, ("attractor", "turns a period", "mean tilt", "starts", "fraction", confidence))
    if told["unsettled"]:
        from stylobate.studies.maps.attractor_search import REMEDY  # noqa: PLC0415  heavy, as above

        print(REMEDY)
