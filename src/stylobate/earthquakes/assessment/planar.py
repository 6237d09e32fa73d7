"""Verdicts on one column beside those of Housner's planar column."""

import xarray as xr

from stylobate.earthquakes import planar_bias
from stylobate.earthquakes.assessment.inputs import CENTRAL, Inputs
from stylobate.earthquakes.assessment.parts import Parts
from stylobate.earthquakes.planar_comparison import bias_of
from stylobate.progress import Report
from stylobate.studies.sweeps import Executor

_AXES = 2
# Variables that count records.
_COUNTS = ("only_space", "only_planar")
# Number of records in one stored part: enough to occupy the cores, few enough to lose at Ctrl-C.
_TOGETHER = 4


def some_at_a_time(inputs: Inputs) -> list[Inputs]:
    """Split the records into groups that are computed and stored together."""
    names = list(inputs.records)
    return [inputs.with_records(names[at : at + _TOGETHER]) for at in range(0, len(names), _TOGETHER)]


def part_name(column: str, what: str, inputs: Inputs) -> str:
    """Return the name of the part of a group of records."""
    first, last = next(iter(inputs.records)), list(inputs.records)[-1]
    return f"{column}: {what}, {first}" + (f" to {last}" if last != first else "")


def planar_of(inputs: Inputs, column: str, parts: Parts, *, executor: Executor | None) -> xr.Dataset:
    """Compute the response of Housner's planar column, at the central dissipation.

    Returns
    -------
    xarray.Dataset
        Over `record` and `scale`: `planar_tilt_ratio`, the larger one of the two components, infinite if it
        overturns, and `log_ratio` of the tilts if both columns rock; over `scale` `bias`, `standard_error`,
        `compared`, `only_space`, `only_planar`.
    """
    few = [_planar_at(some, column, parts, executor) for some in some_at_a_time(inputs)]
    records = xr.concat([one.drop_vars(_COUNTS) for one in few], dim="record", join="override")
    counts = xr.concat([one[list(_COUNTS)] for one in few], dim="part").sum("part", keep_attrs=True)
    return records.assign({**counts.data_vars, **bias_of(records["log_ratio"])})


def _planar_at(inputs: Inputs, column: str, parts: Parts, executor: Executor | None) -> xr.Dataset:
    def compute(progress: Report) -> xr.Dataset:
        found = planar_bias(
            inputs.columns[column][CENTRAL],
            dict(inputs.records),
            scales=inputs.scales,
            tail=inputs.tail,
            executor=executor,
            progress=progress,
            **inputs.options,
        )
        kept = found[["log_ratio", *_COUNTS]].assign(planar_tilt_ratio=found["worst_planar_tilt_ratio"])
        return kept.drop_vars([name for name in kept.coords if name not in ("record", "scale")])

    identity = {**inputs.identity(column, inputs.columns[column][CENTRAL]), "scales": inputs.scales.tolist()}
    runs = len(inputs.records) * inputs.scales.size * (1 + _AXES)
    return parts.get(part_name(column, "planar", inputs), runs, identity, compute)


def planar_runs(inputs: Inputs) -> int:
    """Return the number of runs for the planar comparison of one column."""
    return len(inputs.records) * inputs.scales.size * (1 + _AXES)
