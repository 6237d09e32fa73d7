"""Accepted steps of an integrator, and what is found on their dense output."""

import math
from typing import Any, TypeVar

import numpy as np
from scipy.integrate import DenseOutput, OdeSolver
from scipy.optimize import brentq

_Solver = TypeVar("_Solver", bound=Any)

# Points of a step at which a planar motion is looked at for a swing over the upright and back.
_DIP_SAMPLES = 9

# A step cut at its very start keeps this length, in units of the larger of 1 and the time.
_SHORTEST = 1e-15

# A swing shorter than this part of a step leaves the column at rest on its base.
_SMALLEST_SWING = 1e-12


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


def back_at_upright(dense: DenseOutput, side: float, start: float, end: float) -> float | None:
    """Return when a planar tilt first comes back to the upright from its `side` within a step, or None.

    It is `start` where the swing begins and ends within a part of the step too small to be told.
    """

    def height(tau: float) -> float:
        return side * float(dense(tau)[0])

    beyond = end if height(end) < 0.0 else _dip(dense, side, start, end)
    if beyond is None:
        return None
    candidates = start + (beyond - start) * np.concatenate([[0.0], np.geomspace(0.5, _SMALLEST_SWING, 40)])
    above = next((float(time) for time in candidates if height(float(time)) > 0.0), None)
    return start if above is None else float(brentq(height, above, beyond, xtol=4e-15 * max(1.0, beyond)))


def _dip(dense: DenseOutput, side: float, start: float, end: float) -> float | None:
    """Return the time within a step at which a planar tilt lies lowest beyond the upright, if it goes and returns."""
    tau = np.linspace(start, end, _DIP_SAMPLES)
    rate = side * dense(tau)[1]
    for i in np.flatnonzero((rate[:-1] < 0.0) & (rate[1:] > 0.0)):
        lowest = float(brentq(lambda t: side * float(dense(t)[1]), tau[i], tau[i + 1]))
        if side * float(dense(lowest)[0]) < 0.0:
            return lowest
    return None
