"""`stylobate simulate`: one column, one base motion, one outcome."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from stylobate.cli import options as opt
from stylobate.cli.output import check_writable, print_json, print_table, save_figure
from stylobate.cli.source import read_source

if TYPE_CHECKING:
    from stylobate.models import Model
    from stylobate.results import Response

Source = Annotated[
    Path | None, typer.Argument(help="TOML description, or a saved run (.nc) to repeat", show_default=False)
]


def simulate(
    context: typer.Context,
    source: Source = None,
    tilt: opt.Tilt = None,
    tilt_rate: opt.TiltRate = None,
    spin: opt.Spin = None,
    twist: opt.Twist = None,
    position: opt.Position = None,
    velocity: opt.Velocity = None,
    clearance: opt.Clearance = None,
    duration: opt.Duration = None,
    friction_coefficient: opt.FrictionCoefficient = None,
    rtol: opt.Rtol = None,
    tilt_limit: opt.TiltLimit = None,
    rest_energy: opt.RestEnergy = None,
    max_steps: opt.MaxSteps = None,
    samples: opt.Samples = None,
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
    spin_friction: opt.SpinFriction = None,
    rolling_resistance: opt.RollingResistance = None,
    restitution: opt.Restitution = None,
    constraint: opt.Constraint = None,
    passage_tilt: opt.PassageTilt = None,
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
    sample_record: opt.SampleRecord = None,
    units: opt.Units = None,
    step: opt.TimeStep = None,
    scale: opt.Scale = None,
    rotation: opt.Rotation = None,
    tail: opt.Tail = None,
    figure: opt.Figure = None,
    output: opt.Output = None,
    as_json: opt.Json = False,
) -> None:
    """Follow one column from a start to its outcome.

    Everything can be given as options or in a TOML file with the same names; options win. Examples:

    stylobate simulate --radius 0.5 --height 10 --density 2700 --damping 0.02 --motion straight
    --acceleration 1.5 --angular-frequency 4 --start-phase 1.57 --duration 30

    stylobate simulate run.toml --duration 60 --figure run.png --output run.nc

    stylobate simulate --radius 0.3 --height 3 --density 2700 --record quake_NS.txt --record quake_EW.txt --units g

    A run under a record or a pulse needs no duration: it goes on for a free tail of 20/p after it.
    """
    check_writable(figure, output)
    described = read_source(source)
    from stylobate import spec  # noqa: PLC0415  heavy imports wait until the options are read

    description = spec.SimulationDescription.parse(opt.overlay(described, context.params, opt.RUN_NAMES))
    setup = description.build()
    from stylobate import engine  # noqa: PLC0415  … and the heaviest until they can be used

    run = engine.simulate(setup.model, setup.motion, **setup.options)
    if output is not None:
        run.save(output)
    if figure is not None:
        from stylobate import plots  # noqa: PLC0415

        save_figure(plots.plot(run), figure)
    if as_json:
        print_json(_summary(run))
    else:
        print_table("run", [*_column_rows(setup.model), *_rows(run)])


def _summary(run: "Response") -> dict[str, Any]:
    return {
        "outcome": run.outcome.name,
        "reason": run.reason,
        "decided_at": run.decided_at,
        "uncertain": run.uncertain,
        "planar": run.planar,
        "events": [{"kind": event.kind, "time": event.time} for event in run.events],
        "measures": dict(run.measures),
        "warnings": list(run.warnings),
        "thresholds": dict(run.thresholds),
        "provenance": dict(run.provenance),
    }


def _column_rows(model: "Model") -> list[tuple[str, str]]:
    column = model.column
    return [
        ("column", f"c = {column.slenderness:.5g}, ω0 = {column.frequency_scale:.5g} rad/s, {column.mass:.6g} kg"),
        ("released above", f"{column.slenderness * column.gravity:.5g} m/s² of horizontal acceleration"),
    ]


def _rows(run: "Response") -> list[tuple[str, str]]:
    events = ", ".join(f"{event.kind} at {event.time:.4f} s" for event in run.events[:_SHOWN])
    more = f", and {len(run.events) - _SHOWN} more" if len(run.events) > _SHOWN else ""
    measures = run.measures
    rows = [
        ("outcome", run.outcome.value + (" (uncertain)" if run.uncertain else "")),
        ("because", run.reason),
        ("decided at", f"{run.decided_at:.4f} s"),
        ("largest tilt", f"{measures['largest_tilt']:.6g} rad, {measures['largest_tilt_over_c']:.4g} c"),
        ("at", f"{measures['time_of_largest_tilt']:.4f} s"),
        ("turns of the contact point", f"{measures['turns']:.3f}"),
        ("events", (events + more) or "none"),
        ("steps", f"{measures['steps']:.0f}"),
    ]
    if "mean_rolling_rate" in measures:
        rows.insert(6, ("mean rolling rate", f"{measures['mean_rolling_rate']:.6g} rad/s"))
    return [*rows, *_contact_rows(run), *_demand_rows(run), *(("warning", warning) for warning in run.warnings)]


def _contact_rows(run: "Response") -> list[tuple[str, str]]:
    """Return how the column was on the plane and where it came to, of a model that slides."""
    measures = run.measures
    if "residual_displacement" not in measures:
        return []
    kinds = ("resting", "sliding", "rolling", "slipping", "flying")
    times = ", ".join(f"{kind} {measures[f'time_{kind}']:.4g} s" for kind in kinds if measures[f"time_{kind}"] > 0.0)
    moved = ", ".join(f"{measures[f'residual_displacement_{axis}']:.4g} m along {axis}" for axis in "xy")
    return [
        ("time", times),
        ("moved by", moved),
        ("twisted by", f"{measures['residual_twist']:.4g} rad"),
        ("slipped", f"{measures['slip_distance']:.4g} m in all"),
        ("impacts", f"{measures['impacts']:.0f}"),
    ]


def _demand_rows(run: "Response") -> list[tuple[str, str]]:
    measures = run.measures
    rows = [
        ("needs a friction coefficient of", "largest_friction_demand", ""),
        ("and to resist pivoting with", "largest_pivoting_demand", " of normal force times radius"),
        ("least normal force", "least_normal_force", " of the weight"),
    ]
    return [(label, f"{measures[name]:.4g}{unit}") for label, name, unit in rows if name in measures]


_SHOWN = 4

__all__ = ["simulate"]
