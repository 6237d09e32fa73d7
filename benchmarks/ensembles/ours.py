"""stylobate's ensembles as an engine, with all events, outcomes and summaries."""

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import xarray as xr

import stylobate as sb

from .answers import Answer
from .workloads import ATOL, COLUMN, ETA, RTOL, Workload

NAMES = {"dop853": "stylobate, DOP853", "taylor": "stylobate, Taylor"}
MODEL = sb.Slender(COLUMN, damping=ETA)


def prepare(workload: Workload, *, method: str, rtol: float = RTOL, atol: float = ATOL) -> Callable[[Workload], Answer]:
    """Return a function that computes a workload of this kind by this method."""
    del workload
    return partial(solve, threads=1, method=method, rtol=rtol, atol=atol)


def solve(workload: Workload, **options: Any) -> Answer:
    """Integrate all runs of the workload; options as for `simulate`."""
    data = simulate(workload, **options)
    parts = [data["end_tilt"].values, data["end_tilt_rate"].values]
    if "end_spin" in data:
        parts.append(data["end_spin"].values[:, np.newaxis])
    overturned = data["outcome"].values == sb.Outcome.OVERTURNED
    return Answer(np.concatenate(parts, axis=1), data["end_time"].values, overturned, int(data["steps"].values.sum()))


def simulate(
    workload: Workload,
    *,
    threads: int,
    method: str = "dop853",
    model: sb.Model = MODEL,
    demands: bool = False,
    rtol: float = RTOL,
    atol: float = ATOL,
) -> xr.Dataset:
    """Integrate all runs of the workload and return their results."""
    return sb.simulate_ensemble(
        model,
        workload.motion,
        tilt=workload.start[:, :2],
        tilt_rate=workload.start[:, 2:4],
        spin=workload.start[:, 4] if model.spin_state else 0.0,
        duration=workload.duration,
        parameters=workload.parameters,
        method=method,
        rtol=rtol,
        atol=atol,
        demands=demands,
        threads=threads,
    )
