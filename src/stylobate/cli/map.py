"""`stylobate map`: what becomes of the column over two parameters."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from stylobate import config, conveying, studies
from stylobate.cli import options as opt
from stylobate.cli.given import Given
from stylobate.cli.many_runs import check_axes, check_outputs, computed, end, is_to_compute, write
from stylobate.cli.output import print_json, print_table
from stylobate.cli.saved import axes_of, open_saved, plain_axes, provenance_of
from stylobate.cli.source import read_source
from stylobate.text import plural

if TYPE_CHECKING:
    import xarray as xr

Source = Annotated[
    Path | None,
    typer.Argument(
        help="TOML description, or a saved map (.nc) or store (.zarr) to show or repeat", show_default=False
    ),
]


@opt.with_waveforms
def overturning_map(
    context: typer.Context,
    source: Source = None,
    x: opt.X = None,
    y: opt.Y = None,
    x_spacing: opt.XSpacing = None,
    y_spacing: opt.YSpacing = None,
    tilt: opt.Tilt = None,
    tilt_rate: opt.TiltRate = None,
    spin: opt.Spin = None,
    duration: opt.Duration = None,
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
    constraint: opt.Constraint = None,
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
    """Tell what becomes of the column over two parameters: stays, rocks, rolls or overturns.

    Of --model sliding: whether it stays, slides, rocks or rolls, slips, flies or overturns.

    A number of column, model, motion or start can vary along each axis: angular-frequency, acceleration, start-phase,
    damping, size, tilt-x … A saved map is shown; options that change it compute it anew. Examples:

    stylobate map --slenderness 0.1 --damping 0.1 --motion circular --x angular-frequency 0.5 6 100
    --y acceleration 0.05 0.6 100 --periods 100 --output map.zarr --figure map.png

    stylobate map map.zarr --resume
    """
    given, complete = Given.of(context), True
    check_outputs(given)
    saved = open_saved(source)
    if not is_to_compute(saved, given):
        assert saved is not None
        found = _counted(saved)
    else:
        if saved is None:
            described = read_source(source)
        else:
            described = config.MapConfig.of_saved(provenance_of(saved), axes_of(saved)).values()
        kind = config.MapConfig
        values = opt.overlay_axes(opt.overlay(described, given, kind.model_fields), given, "map")
        setup = kind.parse(values).build()
        check_axes("map", setup)
        study = conveying.contact_map if setup.model.switches else studies.overturning_map
        found, complete = computed(study, setup, given, "map")
    write(found, given)
    if as_json:
        print_json(_summary(found))
    else:
        _print(found)
    end(found, given, complete=complete)


def _counted(saved: "xr.Dataset") -> "xr.Dataset":
    from stylobate.conveying.contact_maps import class_shares  # noqa: PLC0415
    from stylobate.studies.maps.overturning import outcome_shares  # noqa: PLC0415

    return class_shares(saved) if "time_flying" in saved else outcome_shares(saved)


def _summary(found: "xr.Dataset") -> dict[str, Any]:
    return {
        "kind": found.attrs["kind"],
        **plain_axes(found),
        "outcomes": {name: {"count": count, "share": share} for name, count, share in _shares(found)},
        "uncertain": int(found["uncertain"].sum()),
        "computed": int(found["computed"]),
        "runs": found["outcome"].size,
        "provenance": provenance_of(found),
    }


# What the counts of each kind of map are over.
_NAMES = {"overturning map": "outcome_name", "contact map": "class_name"}


def _shares(found: "xr.Dataset") -> list[tuple[str, int, float]]:
    table = (found[name].to_numpy() for name in (_NAMES[found.attrs["kind"]], "count", "share"))
    return [(str(name), int(count), float(share)) for name, count, share in zip(*table, strict=True)]


def _print(found: "xr.Dataset") -> None:
    rows = [(name, str(count), f"{100.0 * share:.2f} %") for name, count, share in _shares(found) if count]
    over = " and ".join(str(dim) for dim in found["outcome"].dims)
    done, total = int(found["computed"]), found["outcome"].size
    title = f"{plural(total, 'run')} over {over}" + (f", {done} of them done" if done < total else "")
    uncertain = int(found["uncertain"].sum())
    print_table(title + (f"; {uncertain} uncertain" if uncertain else ""), rows, ("outcome", "runs", "share"))
