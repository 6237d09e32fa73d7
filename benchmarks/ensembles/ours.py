"""stylobate's ensembles, with all their events, outcomes and summaries."""

from collections.abc import Callable
from functools import partial

import numpy as np

import stylobate as sb
from stylobate.results.outcomes import code_of

from .answers import Answer
from .workloads import ATOL, COLUMN, ETA, RTOL, Workload

NAMES = {"dop853": "stylobate, DOP853", "taylor": "stylobate, Taylor"}
MODEL = sb.Slender(COLUMN, damping=ETA)


def prepare(workload: Workload, *, method: str) -> Callable[[Workload], Answer]:
    """Return what computes a workload of this kind by this method."""
    del workload
    return partial(solve, threads=1, method=method)


def solve(workload: Workload, *, threads: int, method: str = "dop853") -> Answer:
    """Follow every run of the workload."""
    data = sb.simulate_ensemble(
        MODEL,
        workload.motion,
        tilt=workload.start[:, :2],
        tilt_rate=workload.start[:, 2:],
        duration=workload.duration,
        parameters=workload.parameters,
        method=method,
        rtol=RTOL,
        atol=ATOL,
        threads=threads,
    )
    end = np.concatenate([data["end_tilt"].values, data["end_tilt_rate"].values], axis=1)
    overturned = data["outcome"].values == code_of(sb.Outcome.OVERTURNED)
    return Answer(end, data["end_time"].values, overturned, int(data["steps"].values.sum()))
