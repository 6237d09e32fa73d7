"""Timing of engines in alternating rounds, so that disturbances affect all engines alike."""

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from statistics import median

import numpy as np

from . import scipy_loop
from .answers import Answer, errors
from .engines import Engine
from .quiet import wait_for_quiet
from .workloads import MIX_DISTINCT, WORKLOADS, Workload, mix


@dataclass(frozen=True, slots=True)
class Timing:
    """Times and errors of one engine on one workload.

    Parameters
    ----------
    engine, workload
        Keys of engine and workload.
    count
        Runs in each repetition.
    seconds
        Processor time of each repetition.
    error
        Error of the end states: the largest if the exact solution is known, otherwise the median.
    other_outcomes
        Number of the 512 distinct runs of the mix with another outcome than the reference.
    steps
        Accepted steps per run.
    """

    engine: str
    workload: str
    count: int
    seconds: tuple[float, ...]
    error: float
    other_outcomes: int | None
    steps: float

    @property
    def rate(self) -> float:
        """Runs per second, the median of the repetitions."""
        return self.count / median(self.seconds)

    @property
    def fastest(self) -> float:
        """Runs per second, the fastest of the repetitions."""
        return self.count / min(self.seconds)


def timings(
    engines: Sequence[Engine],
    workload: str,
    *,
    repetitions: int,
    shorter: int = 1,
    compared: int = MIX_DISTINCT,
    reference: float = 1e-12,
) -> list[Timing]:
    """Time each engine on a workload, without compilation and a first round.

    For the mix, the first `compared` runs are compared with SciPy's at the tolerance `reference`.
    """
    fewest = compared if workload == "mix" else 16
    runs, solvers = {}, {}
    for engine in engines:
        runs[engine.key] = WORKLOADS[workload](max(engine.counts[workload] // shorter, fewest, engine.lanes))
        solvers[engine.key] = engine.prepare(runs[engine.key])
        solvers[engine.key](runs[engine.key].take(slice(0, engine.warm_up)))
    seconds, answers = in_turns({key: partial(solve, runs[key]) for key, solve in solvers.items()}, repetitions)
    truth = None
    if workload == "mix":
        truth = scipy_loop.solve(mix(MIX_DISTINCT).take(slice(0, compared)), rtol=reference, atol=1e-2 * reference)
    return [
        timing_of(engine.key, runs[engine.key], seconds[engine.key], answers[engine.key], truth) for engine in engines
    ]


def in_turns(
    tasks: Mapping[str, Callable[[], Answer]], repetitions: int
) -> tuple[dict[str, list[float]], dict[str, Answer]]:
    """Return the processor times of each task in each round, and its last result."""
    seconds: dict[str, list[float]] = {key: [] for key in tasks}
    answers = {}
    for _ in range(repetitions):
        wait_for_quiet()
        for key, task in tasks.items():
            begun = time.process_time()
            answers[key] = task()
            seconds[key].append(time.process_time() - begun)
    return seconds, answers


def timing_of(key: str, runs: Workload, seconds: Sequence[float], answer: Answer, truth: Answer | None) -> Timing:
    """Compare with the exact end states of the runs or, for the mix, with the `truth` of the first runs."""
    other = None
    if truth is None:
        assert runs.exact is not None
        error = float(np.abs(answer.end - runs.exact).max())
    else:
        compared = slice(0, min(len(runs), len(truth.time)))
        first, reference = answer.take(compared), truth.take(compared)
        error = float(np.median(errors(first, reference)))
        other = int((first.overturned != reference.overturned).sum())
    assert answer.steps is not None
    return Timing(key, runs.name, len(runs), tuple(seconds), error, other, answer.steps / len(runs))
