"""Verdicts on one column: every record, scale and level of dissipation, with and without the vertical component."""

from collections.abc import Mapping

import numpy as np
import xarray as xr

from stylobate.earthquakes import incremental_dynamic_analysis
from stylobate.earthquakes.assessment.inputs import CENTRAL, Inputs
from stylobate.earthquakes.assessment.parts import Parts
from stylobate.earthquakes.fragility.observations import LIMIT_STATE
from stylobate.progress import Report
from stylobate.studies.sweeps import Executor

_DEMANDS: Mapping[str, tuple[str, str]] = {
    "peak_friction_demand": ("friction_demand", "peak friction force over normal force"),
    "peak_pivoting_demand": ("pivoting_demand", "peak moment about the vertical over normal force and radius"),
    "minimum_normal_force": ("minimum_normal_force", "minimum normal force over weight"),
}


def verdicts_on(inputs: Inputs, column: str, parts: Parts, *, contact: bool, executor: Executor | None) -> xr.Dataset:
    """Compute the verdicts on a column.

    Returns
    -------
    xarray.Dataset
        Over `record`, `dissipation`, `vertical` and `scale`: `overturned` (1, 0, −1 if the run is undecided),
        `outcome`, `tilt_ratio`, `uncertain`, `friction_demand` (standing and moving), `pivoting_demand`,
        `minimum_normal_force`.
    """
    vertical = (True, False) if inputs.has_vertical else (True,)
    levels = inputs.dissipation[column]
    names = list(levels[CENTRAL])
    parameters = {name: np.array([numbers[name] for numbers in levels.values()]) for name in names}

    options = inputs.options.copy()
    options["demands"] = contact
    options.setdefault("recheck", True)

    def compute(progress: Report) -> xr.Dataset:
        runs = incremental_dynamic_analysis(
            inputs.columns[column][CENTRAL],
            dict(inputs.records),
            scales=inputs.scales,
            vertical=vertical,
            parameters=parameters,
            tail=inputs.tail,
            executor=executor,
            progress=progress,
            **options,
        )
        return _table_of_verdicts(runs.expand_dims("vertical") if len(vertical) == 1 else runs)

    count = len(inputs.records) * len(levels) * len(vertical) * inputs.scales.size
    identity = {**inputs.identity(column), "scales": inputs.scales.tolist(), "contact": contact}
    found = parts.get(f"{column}: verdicts", count, identity, compute)
    return found.assign_coords(dissipation=list(levels), vertical=["with", "without"][: len(vertical)])


def verdict_runs(inputs: Inputs) -> int:
    """Return the number of runs for the verdicts on one column."""
    return len(inputs.records) * len(inputs.levels) * (2 if inputs.has_vertical else 1) * inputs.scales.size


def _table_of_verdicts(runs: xr.Dataset) -> xr.Dataset:
    plain = runs.rename(property_sample="dissipation")
    plain = plain.drop_vars([name for name in plain.coords if name not in ("record", "scale", LIMIT_STATE)])
    found = {
        "overturned": plain["reached"].sel({LIMIT_STATE: "overturning"}, drop=True).astype(np.int8),
        "outcome": plain["outcome"],
        "tilt_ratio": plain["tilt_ratio"],
        "uncertain": plain["uncertain"].astype(np.int8),
    }
    empty = xr.full_like(plain["tilt_ratio"], np.nan)
    for name, (own, long_name) in _DEMANDS.items():
        found[own] = plain.get(name, empty).assign_attrs(units="1", long_name=long_name)
    ordered = {name: one.transpose("record", "dissipation", "vertical", "scale") for name, one in found.items()}
    return xr.Dataset(ordered).assign_attrs(provenance=runs.attrs["provenance"])
