"""Accepted steps of an integrator."""

import math
from typing import Any, TypeVar

import numpy as np
from scipy.integrate import DenseOutput, OdeSolver

_Solver = TypeVar("_Solver", bound=Any)

# A step cut at its very start keeps this length, in units of the larger of 1 and the time.
_SHORTEST = 1e-15


def with_finite_step(solver: _Solver) -> _Solver:
    """Return the solver with a first step that is a number.

    SciPy's guess of the first step is NaN where the squares of the rates overflow. A NaN never becomes shorter than the
    shortest step, so that the first step would be tried for ever. The whole way, tried first, is shortened until it
    fits, or until the solver fails.
    """
    if not math.isfinite(solver.h_abs):
        solver.h_abs = abs(solver.t_bound - solver.t)
    return solver


def attempted(solver: OdeSolver) -> str | None:
    """Make a step and return why it failed, or None; trial steps that overflow are shortened without a warning."""
    with np.errstate(over="ignore", invalid="ignore"):
        failure = solver.step()
    return None if failure is None else str(failure)


class Steps:
    """Accepted steps of one solver, with their dense output."""

    def __init__(self, start: float) -> None:
        self.times = [start]
        self.dense: list[DenseOutput] = []

    def add(self, solver: OdeSolver) -> DenseOutput:
        """Keep the step just made and return its dense output."""
        dense = solver.dense_output()
        self.times.append(float(solver.t))
        self.dense.append(dense)
        return dense

    def drop(self) -> None:
        """Forget the last step."""
        del self.times[-1], self.dense[-1]

    def cut(self, time: float) -> None:
        """End the last step at `time`, where an event was found; no step is left without extent."""
        before = self.times[-2]
        self.times[-1] = max(time, before + _SHORTEST * max(1.0, abs(before)))


def just_before(stop: float) -> float:
    """Return the last time before `stop`: what acts up to a break of the acceleration is its limit from the left."""
    return stop * (1.0 - 4.0 * np.finfo(float).eps)
