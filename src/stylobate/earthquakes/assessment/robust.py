"""Repeated verdicts on one column: under small changes at each dissipation, and with Housner's planar column."""

import numpy as np
import xarray as xr

from stylobate.earthquakes import planar_bias, robustness
from stylobate.earthquakes.assessment.inputs import CENTRAL, Inputs
from stylobate.earthquakes.assessment.parts import Parts
from stylobate.earthquakes.fragility.observations import LIMIT_STATE
from stylobate.earthquakes.planar_comparison import bias_of
from stylobate.studies.sweeps import Executor
from stylobate.studies.sweeps.computing import Progress

_AXES = 2
# Variables that count records.
_COUNTS = ("only_space", "only_planar")
# Number of records in one stored part: enough to occupy the cores, few enough to lose at Ctrl-C.
_TOGETHER = 4


def robustness_of(inputs: Inputs, column: str, parts: Parts, *, executor: Executor | None) -> xr.Dataset:
    """Repeat the verdicts on a column under small changes.

    Returns
    -------
    xarray.Dataset
        Over `dissipation`, `scale`, `record` and `change`: `applies`, 1 if the change applies to the record;
        `flips`, 1 if the change flips the verdict, 0 if it does not, −1 if the change does not apply or a run is
        undecided; `changed_tilt_ratio`. Without `change`: `flipped`, `compared` and `undecided`, the numbers of
        changes that flip the verdict, that apply and are decided, that apply and are undecided; `tilt_ratio_low`,
        `tilt_ratio_high`. Along `change` `change_of`.
    """

    def at(level: str, scale: float) -> xr.Dataset:
        few = [_robustness_at(some, column, level, scale, parts, executor) for some in _some_at_a_time(inputs)]
        return xr.concat(few, dim="record", data_vars="minimal", join="override")

    by_level = [
        xr.concat(
            [at(level, scale) for scale in inputs.scales.tolist()],
            dim=xr.Variable("scale", inputs.scales),
            data_vars="all",
            join="override",
        )
        for level in inputs.changes_at
    ]
    levels = xr.Variable("dissipation", list(inputs.changes_at))
    joined: xr.Dataset = xr.concat(by_level, dim=levels, data_vars="all", join="override")
    return joined.assign(change_of=by_level[0]["change_of"].isel(scale=0, drop=True))


def _some_at_a_time(inputs: Inputs) -> list[Inputs]:
    names = list(inputs.records)
    return [inputs.with_records(names[at : at + _TOGETHER]) for at in range(0, len(names), _TOGETHER)]


def _part_name(column: str, what: str, inputs: Inputs) -> str:
    first, last = next(iter(inputs.records)), list(inputs.records)[-1]
    return f"{column}: {what}, {first}" + (f" to {last}" if last != first else "")


def _robustness_at(
    inputs: Inputs, column: str, level: str, scale: float, parts: Parts, executor: Executor | None
) -> xr.Dataset:
    def compute(progress: Progress) -> xr.Dataset:
        return _as_dataset(
            robustness(
                inputs.columns[column][level],
                dict(inputs.records),
                scale=scale,
                changes=inputs.changes,
                tail=inputs.tail,
                executor=executor,
                progress=progress,
                **inputs.options,
            )
        )

    identity = {
        **inputs.identity(column, level),
        "scale": scale,
        "changes": [repr(change) for change in inputs.changes],
    }
    runs = len(inputs.records) * (1 + len(inputs.changes))
    what = f"small changes, {level} dissipation, scale {scale:g}, {runs} runs"
    return parts.get(_part_name(column, what, inputs), runs, identity, compute)


def robustness_runs(inputs: Inputs) -> int:
    """Return the number of runs for the robustness of one column."""
    return len(inputs.records) * (1 + len(inputs.changes)) * inputs.scales.size * len(inputs.changes_at)


def _as_dataset(found: xr.Dataset) -> xr.Dataset:
    overturning = found["reached"].sel({LIMIT_STATE: "overturning"}, drop=True)
    given = found["reached_as_given"].sel({LIMIT_STATE: "overturning"}, drop=True)
    decided = (overturning >= 0) & (given >= 0)
    flips = (overturning != given).astype(np.int8).where(decided, np.int8(-1)).astype(np.int8)
    undecided = (found["applies"] & ~decided).sum("change")
    plain = xr.Dataset(
        {
            "applies": found["applies"].astype(np.int8).assign_attrs(long_name="the change applies"),
            "flips": flips.assign_attrs(long_name="the verdict differs from that without the change"),
            "changed_tilt_ratio": found["tilt_ratio"],
            "flipped": (flips == 1).sum("change").assign_attrs(units="1", long_name="changes that flip the verdict"),
            "compared": decided.sum("change").assign_attrs(units="1", long_name="changes that apply and are decided"),
            "undecided": undecided.assign_attrs(units="1", long_name="changes that apply and are not decided"),
            "tilt_ratio_low": found["tilt_ratio_low"],
            "tilt_ratio_high": found["tilt_ratio_high"],
            "change_of": ("change", found["change_of"].to_numpy().astype(str)),
        }
    )
    return plain.drop_vars([name for name in plain.coords if name not in ("record", "change")])


def planar_of(inputs: Inputs, column: str, parts: Parts, *, executor: Executor | None) -> xr.Dataset:
    """Compute the response of Housner's planar column, at the central dissipation.

    Returns
    -------
    xarray.Dataset
        Over `record` and `scale`: `planar_tilt_ratio`, the larger one of the two components, infinite if it
        overturns, and `log_ratio` of the tilts if both columns rock; over `scale` `bias`, `standard_error`,
        `compared`, `only_space`, `only_planar`.
    """
    few = [_planar_at(some, column, parts, executor) for some in _some_at_a_time(inputs)]
    records = xr.concat([one.drop_vars(_COUNTS) for one in few], dim="record", join="override")
    counts = xr.concat([one[list(_COUNTS)] for one in few], dim="part").sum("part", keep_attrs=True)
    return records.assign({**counts.data_vars, **bias_of(records["log_ratio"])})


def _planar_at(inputs: Inputs, column: str, parts: Parts, executor: Executor | None) -> xr.Dataset:
    def compute(progress: Progress) -> xr.Dataset:
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

    identity = {**inputs.identity(column, CENTRAL), "scales": inputs.scales.tolist()}
    runs = len(inputs.records) * inputs.scales.size * (1 + _AXES)
    return parts.get(_part_name(column, "planar", inputs), runs, identity, compute)


def planar_runs(inputs: Inputs) -> int:
    """Return the number of runs for the planar comparison of one column."""
    return len(inputs.records) * inputs.scales.size * (1 + _AXES)
