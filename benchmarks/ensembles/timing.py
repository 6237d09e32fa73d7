"""Times the engines in turns, round after round, so that what disturbs the machine disturbs them alike."""

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from statistics import median

import numpy as np

from . import diffrax_lanes, scipy_loop
from .answers import Answer, errors
from .engines import Engine
from .quiet import wait_for_quiet
from .workloads import MIX_DISTINCT, WORKLOADS, Workload, mix


@dataclass(frozen=True, slots=True)
class Timing:
    """What one engine did on one workload.

    Parameters
    ----------
    engine, workload
        Their keys.
    count
        Runs in each repetition.
    seconds
        Processor time of each repetition.
    error
        Of the end states: the largest where the exact solution is known, else the median.
    other_outcomes
        How many of the 512 distinct runs of the mix overturned where the reference did not, or the other way round.
    steps
        Accepted steps a run.
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
        """Runs a second, the median of the repetitions."""
        return self.count / median(self.seconds)

    @property
    def fastest(self) -> float:
        """Runs a second, the fastest of the repetitions."""
        return self.count / min(self.seconds)


def timings(engines: Sequence[Engine], workload: str, *, repetitions: int, shorter: int = 1) -> list[Timing]:
    """Time each engine on a workload; compiling, and a first round, are left out."""
    runs, solvers = {}, {}
    for engine in engines:
        runs[engine.key] = WORKLOADS[workload](max(engine.counts[workload] // shorter, _least(engine, workload)))
        solvers[engine.key] = engine.prepare(runs[engine.key])
        solvers[engine.key](_warm_up(engine, runs[engine.key]))
    seconds, answers = in_turns({key: partial(solve, runs[key]) for key, solve in solvers.items()}, repetitions)
    truth = None if workload == "rolling" else scipy_loop.solve(mix(MIX_DISTINCT), rtol=1e-12, atol=1e-14)
    return [
        timing_of(engine.key, runs[engine.key], seconds[engine.key], answers[engine.key], truth) for engine in engines
    ]


def in_turns(
    tasks: Mapping[str, Callable[[], Answer]], repetitions: int
) -> tuple[dict[str, list[float]], dict[str, Answer]]:
    """Return the processor times of every task in each round, and its last answer."""
    seconds: dict[str, list[float]] = {key: [] for key in tasks}
    answers = {}
    for _ in range(repetitions):
        wait_for_quiet()
        for key, task in tasks.items():
            begun = time.process_time()
            answers[key] = task()
            seconds[key].append(time.process_time() - begun)
    return seconds, answers


def _least(engine: Engine, workload: str) -> int:
    return max(MIX_DISTINCT if workload == "mix" else 16, diffrax_lanes.LANES if engine.key == "diffrax" else 0)


def _warm_up(engine: Engine, runs: Workload) -> Workload:
    return runs.take(slice(0, 4)) if engine.key == "scipy" else runs


def timing_of(key: str, runs: Workload, seconds: Sequence[float], answer: Answer, truth: Answer | None) -> Timing:
    """Compare with the exact ends of the runs, or, of the mix, with a `truth` of the distinct ones."""
    other = None
    if truth is None:
        assert runs.exact is not None
        error = float(np.abs(answer.end - runs.exact).max())
    else:
        first = answer.take(slice(0, MIX_DISTINCT))
        error = float(np.median(errors(first, truth)))
        other = int((first.overturned != truth.overturned).sum())
    assert answer.steps is not None
    return Timing(key, runs.name, len(runs), tuple(seconds), error, other, answer.steps / len(runs))
