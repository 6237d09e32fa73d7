"""stylobate's ensembles, with all their events, outcomes and summaries."""

from collections.abc import Callable
from functools import partial

import numpy as np

import stylobate as sb

from .answers import Answer
from .workloads import ATOL, COLUMN, ETA, RTOL, Workload

NAMES = {"dop853": "stylobate, DOP853", "taylor": "stylobate, Taylor"}
MODEL = sb.Slender(COLUMN, damping=ETA)


def prepare(workload: Workload, *, method: str) -> Callable[[Workload], Answer]:
    """Return what computes a workload of this kind by this method."""
    del workload
    return partial(solve, threads=1, method=method)


def solve(
    workload: Workload,
    *,
    threads: int,
    method: str = "dop853",
    model: sb.Model = MODEL,
    demands: bool = False,
    rtol: float = RTOL,
    atol: float = ATOL,
) -> Answer:
    """Follow every run of the workload."""
    data = sb.simulate_ensemble(
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
    parts = [data["end_tilt"].values, data["end_tilt_rate"].values]
    if "end_spin" in data:
        parts.append(data["end_spin"].values[:, np.newaxis])
    overturned = data["outcome"].values == sb.Outcome.OVERTURNED
    return Answer(np.concatenate(parts, axis=1), data["end_time"].values, overturned, int(data["steps"].values.sum()))
