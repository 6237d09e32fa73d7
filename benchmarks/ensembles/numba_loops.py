"""Right-hand sides compiled by numba, for SciPy's `solve_ivp` (steps in Python) and CyRK (steps in C++).

CyRK's solver supports no events of compiled callers, so it computes "rolling" only.
"""

import math
from collections.abc import Callable
from functools import cache, partial
from typing import Any

import numpy as np

from . import scipy_loop
from .answers import Answer
from .workloads import ATOL, ETA, RTOL, C, Workload

SCIPY_NAME = "SciPy, loop, compiled right-hand side"
CYRK_NAME = "CyRK, DOP853, compiled loop"


def prepare_scipy(workload: Workload, *, rtol: float = RTOL, atol: float = ATOL) -> Callable[[Workload], Answer]:
    """Return a function that computes a workload of this kind by SciPy's DOP853."""
    del workload
    return partial(scipy_loop.solve, rtol=rtol, atol=atol, rates_of=_rates_of)


def prepare_cyrk(workload: Workload, *, rtol: float = RTOL, atol: float = ATOL) -> Callable[[Workload], Answer]:
    """Compile the loop and return a function that computes a workload of this kind by CyRK's DOP853."""
    del workload
    return partial(_solve, _cyrk_loop(), rtol, atol)


@cache
def _accelerations() -> Any:
    from numba import njit

    @njit
    def accelerations(tau, x, y, vx, vy, numbers):
        nu, cx, cy, sx, sy = numbers
        lean = 1.0 - C / math.sqrt(x * x + y * y)
        p, q = math.cos(nu * tau), math.sin(nu * tau)
        return lean * x - ETA * vx - cx * p - sx * q, lean * y - ETA * vy - cy * p - sy * q

    return accelerations


@cache
def _rates() -> Any:
    from numba import njit

    accelerations = _accelerations()

    @njit
    def rates(tau, state, numbers):
        x, y, vx, vy = state
        return np.array((vx, vy, *accelerations(tau, x, y, vx, vy, numbers)))

    return rates


def _rates_of(workload: Workload, i: int) -> scipy_loop.Rates:
    rates, numbers = _rates(), tuple(_numbers(workload)[i].tolist())
    return lambda tau, state: rates(tau, state, numbers)


@cache
def _cyrk_loop() -> Any:
    from CyRK import cyjit, nbsolve2_ivp
    from numba import carray, njit

    accelerations = _accelerations()

    @cyjit
    def rates(slopes, tau, state, numbers):
        x, y, vx, vy = state[0], state[1], state[2], state[3]
        slopes[0], slopes[1] = vx, vy
        slopes[2], slopes[3] = accelerations(tau, x, y, vx, vy, carray(numbers, 5))

    address = rates.address

    @njit
    def follow(start, duration, numbers, rtol, atol, end):
        steps = 0
        for i in range(len(duration)):
            solution = nbsolve2_ivp(
                address, (0.0, duration[i]), start[i], method="DOP853", args=numbers[i], rtol=rtol, atol=atol
            )
            end[i] = solution.y[:, -1]
            steps += solution.size - 1
            solution.free()
        return steps

    vars(follow)["rates"] = rates  # keeps the right-hand side alive as long as the loop
    return follow


def _solve(follow: Any, rtol: float, atol: float, workload: Workload) -> Answer:
    end = np.empty((len(workload), 4))
    steps = follow(workload.start, workload.duration, _numbers(workload), rtol, atol, end)
    return Answer(end, workload.duration, np.zeros(len(workload), bool), int(steps))


def _numbers(workload: Workload) -> np.ndarray:
    return np.column_stack([workload.nu, workload.cos, workload.sin])
