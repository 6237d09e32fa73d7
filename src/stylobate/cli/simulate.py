"""`stylobate simulate`: one column, one base motion, one outcome."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from stylobate import config, engine, plots
from stylobate.cli import options as opt
from stylobate.cli.given import Given
from stylobate.cli.output import check_writable, print_json, print_table, save_figure
from stylobate.cli.source import read_source

if TYPE_CHECKING:
    from stylobate.column import Column
    from stylobate.results import Response
    from stylobate.results.summary import Rows

Source = Annotated[
    Path | None, typer.Argument(help="TOML description, or a saved run (.nc) to repeat", show_default=False)
]


@opt.with_waveforms
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
    spin_damping: opt.SpinDamping = None,
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
    record_direction: opt.RecordDirections = None,
    single: opt.Single = None,
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

    A run under a record, a pulse or a sine sweep needs no duration: it goes on for a free tail of 20/p after it.
    """
    given = Given.of(context)
    check_writable(given["figure"], given["output"])
    described = read_source(source)
    kind = config.SimulationConfig
    setup = kind.parse(opt.overlay(described, given, kind.model_fields)).build()
    given.refuse_unused()
    run = engine.simulate(setup.model, setup.motion, **setup.options)
    if output is not None:
        run.save(output)
    if figure is not None:
        save_figure(plots.plot(run), figure)
    if as_json:
        print_json(_summary(run))
    else:
        print_table("run", _rows(run, setup.model.column))


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


def _rows(run: "Response", column: "Column") -> "Rows":
    from stylobate.results.summary import column_rows, measure_rows, verdict_rows  # noqa: PLC0415

    warnings = [("warning", warning) for warning in run.warnings]
    return [*column_rows(column), *verdict_rows(run), *measure_rows(run), *warnings]


__all__ = ["simulate"]
