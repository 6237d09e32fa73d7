"""Shares of the processor time of a call: `python -m benchmarks.ensembles.shares`, part of `make bench`.

Each call computes the 512 runs of a workload. Kernels are rewritten without the measured part, or with a counter. The
variants alternate on the same runs, and the medians of the rounds are compared.
"""

import argparse
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cache, partial
from pathlib import Path
from statistics import median
from types import ModuleType
from unittest.mock import patch

import numpy as np
import xarray as xr

from stylobate.compiler.programs import Bound, Functions, text_of
from stylobate.compiler.sources import written_module
from stylobate.compiler.unit import ArrayArgument
from stylobate.compiler.values import NumberKind
from stylobate.engine.kernel.driver import loop
from stylobate.engine.kernel.kernels import Kernel

from . import ours, peak, tables
from .one_core import use_one_core
from .workloads import MIX_DISTINCT, WORKLOADS, Workload

_FOLDER = Path(__file__).parents[2] / "docs" / "_static" / "benchmarks"
_OBSERVATION, _STEP = "        observe(buf, i)\n", "            step(buf, width, group)\n"
# Number of steps of all runs of "rolling" before other work is due.
_STEPS = 1000
_STEPS_ALONE = """

def steps_alone(buf, count):
    for _ in range(count):
        step(buf, WIDTH, 0)
"""


@dataclass(frozen=True, slots=True)
class Shares:
    """Processor time of a call and of its parts [s].

    Parameters
    ----------
    method, workload
        Method and workload.
    call
        Call of `simulate_ensemble`.
    steps, events, observation, python
        Attempted steps; events and the driver between steps; integrals over the last periods; all code outside kernels.
    occupied
        Accepted steps over the attempted steps of all lanes.
    of_peak
        Arithmetic of DOP853's steps, without events, over the arithmetic peak in the time of an attempt.
    """

    method: str
    workload: str
    call: float
    steps: float
    events: float
    observation: float
    python: float
    occupied: float
    of_peak: float | None


def main() -> None:
    """Measure the shares and write the table."""
    arguments = _arguments()
    print(use_one_core())
    rounds = 1 if arguments.quick else arguments.rounds
    arithmetic_peak = peak.measured_peak()
    found = [_shares(method, workload, rounds, arithmetic_peak) for method in ours.NAMES for workload in WORKLOADS]
    text = tables.shares_table(found) + f"\nMeasured with {peak.in_words(arithmetic_peak)}.\n"
    arguments.into.mkdir(parents=True, exist_ok=True)
    (arguments.into / "shares.txt").write_text(text, encoding="utf-8")
    print(text)


def _shares(method: str, name: str, rounds: int, arithmetic_peak: float) -> Shares:
    follow = partial(ours.simulate, WORKLOADS[name](MIX_DISTINCT), threads=1, method=method)
    made, attempts, width = _counted(follow)
    steps_alone = _steps_alone(method)
    calls, inside, unobserved, alone = [], [], [], []
    _timed(follow, _without_observation)  # compiles
    for _ in range(rounds):
        call, within = _timed(follow, _as_it_is)
        calls.append(call)
        inside.append(within)
        unobserved.append(_timed(follow, _without_observation)[1])
        alone.append(steps_alone(round(attempts / width)))
    of_peak = peak.flops_of_a_step() * attempts / median(alone) / arithmetic_peak if method == "dop853" else None
    return Shares(
        method=method,
        workload=name,
        call=median(calls),
        steps=median(alone),
        events=_median_of_differences(unobserved, alone),
        observation=_median_of_differences(inside, unobserved),
        python=_median_of_differences(calls, inside),
        occupied=made / attempts,
        of_peak=of_peak,
    )


def _timed(follow: Callable[[], xr.Dataset], change: Callable[[Kernel], Kernel]) -> tuple[float, float]:
    """Measure the processor time of a call with changed kernels, and of its kernels [s]."""
    with _kernels(change) as within:
        begun = time.process_time()
        follow()
        return time.process_time() - begun, within[0]


def _median_of_differences(longer: Sequence[float], shorter: Sequence[float]) -> float:
    return median(a - b for a, b in zip(longer, shorter, strict=True))


@contextmanager
def _kernels(change: Callable[[Kernel], Kernel], pieces: np.ndarray | None = None) -> Iterator[list[float]]:
    """Replace the kernels of all calls, and their polynomials, which harmonic motion does not use.

    The yielded list holds the processor time within the kernels [s].
    """
    own, within = Kernel.advance, [0.0]

    def advance(kernel, table, polynomials, *others, **options):
        changed = change(kernel)
        begun = time.process_time()
        try:
            return own(changed, table, polynomials if pieces is None else pieces, *others, **options)
        finally:
            within[0] += time.process_time() - begun

    with patch.object(Kernel, "advance", advance):
        yield within


def _as_it_is(kernel: Kernel) -> Kernel:
    return kernel


@cache
def _without_observation(kernel: Kernel) -> Kernel:
    return _rewritten(kernel, _OBSERVATION, _OBSERVATION.replace("observe(buf, i)", "pass"))


@cache
def _with_counter(kernel: Kernel) -> Kernel:
    return _rewritten(kernel, _STEP, _STEP + _STEP.replace("step(buf, width, group)", "pieces[0, 0] += width"))


def _rewritten(kernel: Kernel, old: str, new: str) -> Kernel:
    text = text_of(loop)
    assert text.count(old) == 1, old
    program = _OtherBatch(kernel.compiled.program(), text.replace(old, new))
    return replace(kernel, compiled=replace(kernel.compiled, program=lambda: program))


@dataclass(frozen=True, eq=False)
class _OtherBatch:
    """Program of a kernel with another text of the module that drives a batch through the lanes."""

    own: Bound
    text: str

    @property
    def texts(self) -> list[str]:
        return [*self.own.texts, self.text]

    def module(self, name: str, functions: Functions) -> ModuleType:
        other = written_module(f"{name}_batch", self.text, {})
        modules = [other if module is loop else module for module in self.own.modules]
        return replace(self.own, modules=modules).module(name, functions)


def _counted(follow: Callable[[], xr.Dataset]) -> tuple[int, int, int]:
    """Count the accepted steps of all runs, the attempted steps of all lanes, and the lanes."""
    counter, widths = np.zeros((1, 5)), []

    def counting(kernel: Kernel) -> Kernel:
        widths.append(kernel.shape.width)
        return _with_counter(kernel)

    with _kernels(counting, counter):
        made = int(follow()["steps"].sum())
    return made, int(counter[0, 0]), widths[0]


def _steps_alone(method: str) -> Callable[[int], float]:
    """Return a function that computes a number of rolling steps in all lanes and returns the time of the steps [s].

    A step has no branches, so its time does not depend on the run.
    """
    kernel, begun = _begun(method)
    program = _OtherBatch(kernel.compiled.program(), text_of(loop) + _STEPS_ALONE)
    steps = replace(
        kernel.compiled,
        name="steps_alone",
        program=lambda: program,
        arguments=(ArrayArgument(begun.shape), NumberKind.INTEGER),
    )
    buffer = kernel.buffer()

    def timed(count: int) -> float:
        taken = 0.0
        for first in range(0, count, _STEPS):
            buffer[:] = begun
            start = time.process_time()
            steps(buffer, min(_STEPS, count - first))
            taken += time.process_time() - start
        return taken

    timed(1)  # compiles
    return timed


def _begun(method: str) -> tuple[Kernel, np.ndarray]:
    """Return the kernel of "rolling" and its buffer after the first step."""
    kept: list[tuple[Kernel, np.ndarray]] = []
    own = Kernel.advance

    def advance(kernel, table, pieces, halt, buffer, **options):
        own(kernel, table, pieces, np.ones_like(halt), buffer, **options)
        kept.append((kernel, buffer.copy()))
        return True

    runs: Workload = WORKLOADS["rolling"](MIX_DISTINCT)
    with patch.object(Kernel, "advance", advance):
        ours.simulate(runs, threads=1, method=method)
    return kept[0]


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.ensembles.shares", description=__doc__)
    parser.add_argument("--into", type=Path, default=_FOLDER, help="folder for the table")
    parser.add_argument("--rounds", type=int, default=21, help="number of rounds; the median counts")
    parser.add_argument("--quick", action="store_true", help="one round, as a check")
    return parser.parse_args()


if __name__ == "__main__":
    main()
