"""`stylobate hierarchy`: one case through all levels of the ladder of models."""

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import numpy as np
import typer

from stylobate import config, plots, studies
from stylobate.cli import options as opt
from stylobate.cli.given import Given
from stylobate.cli.output import check_writable, print_json, print_table, save_figure
from stylobate.cli.response import plain_curves, save_curves
from stylobate.cli.source import read_source
from stylobate.errors import ParameterError

if TYPE_CHECKING:
    import xarray as xr

Source = Annotated[Path | None, typer.Argument(help="TOML description, or a saved run (.nc)", show_default=False)]
ScaledTo = Annotated[
    list[float] | None,
    typer.Option(help="slenderness to which the case is scaled, tilts and base motion with it; repeat it"),
]
NoModel = Annotated[str | None, typer.Option("--model", hidden=True)]
Reference = Annotated[str | None, typer.Option(help="level from which differences are taken, rolling by default")]


@opt.with_waveforms
def model_hierarchy(
    context: typer.Context,
    source: Source = None,
    *,
    scaled_to: ScaledTo = None,
    reference: Reference = None,
    tilt: opt.Tilt = None,
    tilt_rate: opt.TiltRate = None,
    spin: opt.Spin = None,
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
    model: NoModel = None,
    damping: opt.Damping = None,
    spin_damping: opt.SpinDamping = None,
    restitution: opt.Restitution = None,
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
    figure: opt.Figure = None,
    output: opt.Output = None,
    as_json: opt.Json = False,
) -> None:
    """Run one case by every model of the column, from the slender one to the one that rolls, and compare them.

    A file is that of `simulate`; its kind of model is of no concern here. --samples keeps histories, which --figure
    draws. Examples:

    stylobate hierarchy --slenderness 0.1 --damping 0.1 --spin-damping 0.1 --motion circular --acceleration 0.065
    --angular-frequency 1.8 --tilt 0.04 0 --tilt-rate 0 0.07 --duration 100 --figure ladder.png

    stylobate hierarchy run.toml --scaled-to 0.05 --scaled-to 0.1 --scaled-to 0.2
    """
    if model is not None:
        message = "ladder runs all levels of the ladder, and not one model; leave out --model"
        raise ParameterError(message)
    if any(not 0.0 < c < math.inf for c in scaled_to or ()):
        message = f"--scaled-to must be followed by a positive slenderness, got {', '.join(map(str, scaled_to or ()))}"
        raise ParameterError(message)
    given = Given.of(context)
    check_writable(given["figure"], given["output"])
    values = opt.overlay(read_source(source), given, config.HierarchyConfig.model_fields)
    setup = config.HierarchyConfig.parse(opt.overlay_ladder(values, given)).build()
    given.refuse_unused()
    options = setup.options
    if figure is not None and options["samples"] is None:
        options = {**options, "samples": _DRAWN}
    found = studies.model_hierarchy(setup.model.column, setup.motion, **options)
    if output is not None:
        save_curves(found, output)
    if figure is not None:
        save_figure(plots.plot(found), figure)
    if as_json:
        print_json({**plain_curves(found), "attributes": {name: found.attrs[name] for name in _TOLD}})
    else:
        _print(found)


_TOLD = ("reference", "column_slenderness", "provenance")

# Samples of the histories in a figure, unless --samples says how many.
_DRAWN = 4000


def _print(found: "xr.Dataset") -> None:
    several = "slenderness" in found.dims
    rows = []
    for index in range(found.sizes["slenderness"] if several else 1):
        at = found.isel(slenderness=index) if several else found
        c = float(at["slenderness"]) if several else float(found.attrs["column_slenderness"])
        rows += [_row(at.sel(level=level), c, several=several) for level in found["level"].to_numpy()]
    header = (*(("c",) if several else ()), *_HEADER)
    from_where = f"distance: the largest of the tilt vector from that of {found.attrs['reference']}"
    print_table(f"tilts over c; late: the last fifth of the run; {from_where}", rows, header)
    if "deviation_order" in found:
        for first, second in (("slender", "wobbling"), ("slender rolling", "rolling"), ("slender", "rolling")):
            order = float(found["deviation_order"].sel(level=first, other_level=second))
            print(f"the distance of {second} from {first} goes with c to the power {order:.2f}")
    for level, warnings in _warnings(found):
        print(f"{level}: {warnings}")


_HEADER = ("level", "outcome", "top tilt", "late mean", "spin rad/s", "friction", "pivoting", "least N", "distance")


def _row(at: "xr.Dataset", c: float, *, several: bool) -> list[str]:
    from stylobate.results.outcomes import outcome_label  # noqa: PLC0415  heavy, as above

    name = str(at["level"].to_numpy())
    distance = float(at["deviation"].sel(other_level=at.attrs["reference"])) / c
    return [
        *([f"{c:.4g}"] if several else []),
        name,
        outcome_label(int(at["outcome"])) + (" (uncertain)" if bool(at["uncertain"]) else ""),
        _cell(float(at["largest_tilt"]) / c),
        _cell(float(at["mean_late_tilt"]) / c),
        _cell(float(at["mean_late_spin"])),
        _cell(float(at["largest_friction_demand"])),
        _cell(float(at["largest_pivoting_demand"])),
        _cell(float(at["least_normal_force"])),
        _cell(distance),
    ]


def _cell(value: float) -> str:
    return "" if np.isnan(value) else "unbounded" if np.isinf(value) else f"{value:.4g}"


def _warnings(found: "xr.Dataset") -> list[tuple[str, str]]:
    """Return the levels with warnings; over several slendernesses those of the largest."""
    shown = found
    if "slenderness" in found.dims:
        shown = found.isel(slenderness=int(np.argmax(found["slenderness"].to_numpy())))
    told = zip(shown["level"].to_numpy(), shown["warnings"].to_numpy(), strict=True)
    return [(str(level), str(line)) for level, line in told if line]
