"""Every verdict on one column again under small changes; and by Housner's planar column."""

import numpy as np
import xarray as xr

from stylobate.studies.assessment.inputs import CENTRAL, Inputs
from stylobate.studies.assessment.parts import Parts
from stylobate.studies.fragility.observations import LIMIT_STATE
from stylobate.studies.shaking import planar_bias, robustness
from stylobate.studies.sweeps import Executor
from stylobate.studies.sweeps.computing import Progress

_AXES = 2


def robustness_of(inputs: Inputs, column: str, parts: Parts, *, executor: Executor | None) -> xr.Dataset:
    """Return which verdicts on a column flip, at the central dissipation.

    Returns
    -------
    xarray.Dataset
        Over `scale`, `record` and `change`: `flips`, 1 where the change makes it overturn or not, 0 where it does
        not, −1 where the change does not apply or a run does not tell; `changed_tilt_ratio`. Without `change`:
        `flipped` and `compared`, numbers of changes; `tilt_ratio_low`, `tilt_ratio_high`. Along `change`
        `change_of`.
    """
    found = []
    for scale in inputs.scales.tolist():

        def compute(progress: Progress, scale: float = scale) -> xr.Dataset:
            return _told(
                robustness(
                    inputs.columns[column][CENTRAL],
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
            **inputs.identity(column, CENTRAL),
            "scale": scale,
            "changes": [repr(change) for change in inputs.changes],
        }
        runs = len(inputs.records) * (1 + len(inputs.changes))
        found.append(parts.get(f"{column}: small changes, scale {scale:g}", runs, identity, compute))
    joined: xr.Dataset = xr.concat(found, dim=xr.Variable("scale", inputs.scales), data_vars="all", join="override")
    return joined


def robustness_runs(inputs: Inputs) -> int:
    """Return how many runs the robustness of one column takes."""
    return len(inputs.records) * (1 + len(inputs.changes)) * inputs.scales.size


def _told(found: xr.Dataset) -> xr.Dataset:
    overturning = found["reached"].sel({LIMIT_STATE: "overturning"}, drop=True)
    given = found["reached_as_given"].sel({LIMIT_STATE: "overturning"}, drop=True)
    told = (overturning >= 0) & (given >= 0)
    flips = (overturning != given).astype(np.int8).where(told, np.int8(-1)).astype(np.int8)
    plain = xr.Dataset(
        {
            "flips": flips.assign_attrs(long_name="another verdict than as given"),
            "changed_tilt_ratio": found["tilt_ratio"],
            "flipped": (flips == 1).sum("change").assign_attrs(units="1", long_name="changes that flip the verdict"),
            "compared": told.sum("change").assign_attrs(units="1", long_name="changes that apply and tell"),
            "tilt_ratio_low": found["tilt_ratio_low"],
            "tilt_ratio_high": found["tilt_ratio_high"],
            "change_of": ("change", found["change_of"].to_numpy().astype(str)),
        }
    )
    return plain.drop_vars([name for name in plain.coords if name not in ("record", "change")])


def planar_of(inputs: Inputs, column: str, parts: Parts, *, executor: Executor | None) -> xr.Dataset:
    """Return the answers of Housner's planar column, at the central dissipation.

    Returns
    -------
    xarray.Dataset
        Over `record` and `scale`: `planar_tilt_ratio`, that of the worse of the two components, infinite where it
        overturns, and `log_ratio` of the tilts where both rock; over `scale` `bias`, `standard_error`, `compared`,
        `only_space`, `only_planar`.
    """

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
        kept = found[["log_ratio", "bias", "standard_error", "compared", "only_space", "only_planar"]]
        kept = kept.assign(planar_tilt_ratio=found["worst_planar_tilt_ratio"])
        return kept.drop_vars([name for name in kept.coords if name not in ("record", "scale")])

    identity = {**inputs.identity(column, CENTRAL), "scales": inputs.scales.tolist()}
    return parts.get(f"{column}: planar", planar_runs(inputs), identity, compute)


def planar_runs(inputs: Inputs) -> int:
    """Return how many runs the planar answers on one column take."""
    return len(inputs.records) * inputs.scales.size * (1 + _AXES)
