"""`stylobate hierarchy`: comparison of all models of the hierarchy in one case."""

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from stylobate import config, studies
from stylobate.cli.command import command
from stylobate.cli.options import Options, merge, overlay, read_source
from stylobate.cli.output import check_writable, deliver, print_table
from stylobate.cli.response import plain_curves, save_curves
from stylobate.config.options import COLUMN, MODEL, MOTION_WITHOUT_RECORDS, OUTPUT, Chosen, Group, Option, run_numbers
from stylobate.errors import ParameterError
from stylobate.run_arguments import OneRun

if TYPE_CHECKING:
    import xarray as xr


def _dissipation(chosen: Chosen) -> list[Option]:
    """List the options of the dissipation parameters that the models of the hierarchy share."""
    from stylobate.config.hierarchy import HierarchyDissipation

    return [one for one in MODEL.make(chosen) if one.name in HierarchyDissipation.model_fields]


@command(
    Option(
        "scaled_to",
        "slenderness to which the case is scaled, with its tilts and base motion; can be repeated",
        list[float],
    ),
    Option("reference", "model from which distances are measured; rolling by default", str),
    Option("model", type=str, hidden=True),
    argument="TOML description, or a saved run (.nc)",
    groups=(
        run_numbers(OneRun),
        COLUMN,
        Group(_dissipation),
        MOTION_WITHOUT_RECORDS,
        OUTPUT,
    ),
)
def hierarchy(options: Options) -> None:
    """Compare all models of the hierarchy in one case.

    The file is that of `simulate`; the kind of its model is ignored. --samples keeps histories; --figure draws them.

    Examples
    --------
    stylobate hierarchy --slenderness 0.1 --damping 0.1 --spin-damping 0.1 --motion circular --acceleration 0.065
    --angular-frequency 1.8 --tilt 0.04 0 --tilt-rate 0 0.07 --duration 100 --figure hierarchy.png

    stylobate hierarchy run.toml --scaled-to 0.05 --scaled-to 0.1 --scaled-to 0.2
    """
    if options["model"] is not None:
        raise ParameterError(f"--model: hierarchy runs all models (got {options['model']!r}). Remove it.")
    scaled_to = options["scaled_to"] or ()
    if any(not 0.0 < c < math.inf for c in scaled_to):
        raise ParameterError(
            f"--scaled-to must be followed by a positive slenderness, got {', '.join(map(str, scaled_to))}"
        )
    check_writable(options["figure"], options["output"])
    values = overlay(read_source(options), options, config.HierarchyConfig.model_fields)
    merge(values, "hierarchy", _compared(options))
    setup = config.HierarchyConfig.parse(values).build()
    options.refuse_unused()
    arguments = setup.options
    if options["figure"] is not None and arguments["samples"] is None:
        arguments = {**arguments, "samples": _DRAWN}
    result = studies.model_hierarchy(setup.model.column, setup.motion, **arguments)
    deliver(result, options, save_curves, _summary, _print)


def _compared(options: Options) -> dict[str, Any]:
    """Return the slendernesses and the reference that options state."""
    compared: dict[str, Any] = {}
    if options["scaled_to"]:
        compared["slenderness"] = options["scaled_to"]
    if options["reference"]:
        compared["reference"] = options["reference"].replace("-", " ").replace("_", " ")
    return compared


def _summary(result: "xr.Dataset") -> dict[str, Any]:
    return {**plain_curves(result), "attributes": {name: result.attrs[name] for name in _ATTRIBUTES}}


_ATTRIBUTES = ("reference", "column_slenderness", "provenance")

# Samples of the histories in a figure, unless --samples states another number.
_DRAWN = 4000


def _print(result: "xr.Dataset") -> None:
    several = "slenderness" in result.dims
    rows = []
    for index in range(result.sizes["slenderness"] if several else 1):
        at = result.isel(slenderness=index) if several else result
        c = float(at["slenderness"]) if several else float(result.attrs["column_slenderness"])
        rows += [_row(at.sel(model=model), c, several=several) for model in result["model"].to_numpy()]
    header = (*(("c",) if several else ()), *_HEADER)
    distance = f"distance: maximum deviation of the tilt vector from {result.attrs['reference']}"
    print_table(f"tilts over c; late: the last fifth of the run; {distance}", rows, header)
    if "deviation_order" in result:
        for first, second in (("slender", "wobbling"), ("slender rolling", "rolling"), ("slender", "rolling")):
            order = float(result["deviation_order"].sel(model=first, other_model=second))
            print(f"the distance of {second} from {first} is proportional to c to the power {order:.2f}")
    for model, warnings in _warnings(result):
        print(f"{model}: {warnings}")


_HEADER = ("model", "outcome", "peak tilt", "late mean", "spin rad/s", "friction", "pivoting", "min N", "distance")


def _row(at: "xr.Dataset", c: float, *, several: bool) -> list[str]:
    from stylobate.results.outcomes import outcome_label

    name = str(at["model"].to_numpy())
    distance = float(at["deviation"].sel(other_model=at.attrs["reference"])) / c
    return [
        *([f"{c:.4g}"] if several else []),
        name,
        outcome_label(int(at["outcome"])) + (" (numerically uncertain)" if bool(at["uncertain"]) else ""),
        _cell(float(at["peak_tilt"]) / c),
        _cell(float(at["mean_late_tilt"]) / c),
        _cell(float(at["mean_late_spin"])),
        _cell(float(at["peak_friction_demand"])),
        _cell(float(at["peak_pivoting_demand"])),
        _cell(float(at["minimum_normal_force"])),
        _cell(distance),
    ]


def _cell(value: float) -> str:
    return "" if np.isnan(value) else "unbounded" if np.isinf(value) else f"{value:.4g}"


def _warnings(result: "xr.Dataset") -> list[tuple[str, str]]:
    """Return the models with warnings; over several slendernesses, the warnings at the largest."""
    shown = result
    if "slenderness" in result.dims:
        shown = result.isel(slenderness=int(np.argmax(result["slenderness"].to_numpy())))
    labelled = zip(shown["model"].to_numpy(), shown["warnings"].to_numpy(), strict=True)
    return [(str(model), str(line)) for model, line in labelled if line]
