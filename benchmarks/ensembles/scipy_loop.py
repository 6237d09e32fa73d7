"""Loop over SciPy's DOP853 with a right-hand side in plain Python."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

import stylobate as sb

from .answers import Answer
from .workloads import ATOL, ETA, ROLLING_ACCELERATION, RTOL, C, Workload

NAME = "SciPy, loop"

Rates = Callable[..., Any]
"""Right-hand side as a function of time and state."""


def prepare(workload: Workload) -> Callable[[Workload], Answer]:
    """Return a function that computes a workload of this kind; rolling omits the event, which is faster."""
    del workload
    return solve


def plain_rates(workload: Workload, i: int) -> Rates:
    """Return the right-hand side of a run in plain Python."""
    return _rolling_rates(workload, i) if workload.circular else _rates(workload, i)


def solve(
    workload: Workload,
    *,
    rtol: float = RTOL,
    atol: float = ATOL,
    rates_of: Callable[[Workload, int], Rates] = plain_rates,
) -> Answer:
    """Integrate all runs of the workload."""
    end, time = np.empty((len(workload), 4)), np.empty(len(workload))
    overturned = np.zeros(len(workload), bool)
    steps = 0
    for i in range(len(workload)):
        rates = rates_of(workload, i)
        events = None if workload.circular else _no_return(float(workload.no_return[i]))
        flow = solve_ivp(
            rates, (0.0, workload.duration[i]), workload.start[i], method="DOP853", rtol=rtol, atol=atol, events=events
        )
        end[i], time[i], overturned[i] = flow.y[:, -1], flow.t[-1], flow.status == 1
        steps += len(flow.t) - 1
    return Answer(end, time, overturned, steps)


def solve_model(model: sb.Model, workload: Workload) -> Answer:
    """Integrate all runs by the model's own equations, in plain Python on floats, without events."""
    end = np.empty((len(workload), len(model.state_names)))
    steps = 0
    for i in range(len(workload)):
        rates, duration = _model_rates(model, workload, i), workload.duration[i]
        flow = solve_ivp(rates, (0.0, duration), workload.start[i], method="DOP853", rtol=RTOL, atol=ATOL)
        end[i] = flow.y[:, -1]
        steps += len(flow.t) - 1
    return Answer(end, workload.duration, np.zeros(len(workload), bool), steps)


def _model_rates(model: sb.Model, workload: Workload, i: int) -> Rates:
    nu, cos, sin = float(workload.nu[i]), math.cos, math.sin
    (cx, cy), (sx, sy) = workload.cos[i].tolist(), workload.sin[i].tolist()
    right_hand_side, parameters = model.rates, model.parameters

    def rates(tau, state):
        turned = nu * tau
        p, q = cos(turned), sin(turned)
        return right_hand_side(*state.tolist(), cx * p + sx * q, cy * p + sy * q, 0.0, *parameters)

    return rates


def _rolling_rates(workload: Workload, i: int) -> Rates:
    nu, cos, sin, hypot, a0 = float(workload.nu[i]), math.cos, math.sin, math.hypot, ROLLING_ACCELERATION

    def rates(tau, state):
        x, y, vx, vy = state.tolist()  # Python floats are faster than NumPy floats
        lean = 1.0 - C / hypot(x, y)
        turned = nu * tau
        return vx, vy, lean * x - ETA * vx - a0 * cos(turned), lean * y - ETA * vy - a0 * sin(turned)

    return rates


def _rates(workload: Workload, i: int) -> Rates:
    nu, cos, sin, hypot = float(workload.nu[i]), math.cos, math.sin, math.hypot
    (cx, cy), (sx, sy) = workload.cos[i].tolist(), workload.sin[i].tolist()

    def rates(tau, state):
        x, y, vx, vy = state.tolist()
        lean = 1.0 - C / hypot(x, y)
        turned = nu * tau
        p, q = cos(turned), sin(turned)
        return vx, vy, lean * x - ETA * vx - cx * p - sx * q, lean * y - ETA * vy - cy * p - sy * q

    return rates


def _no_return(tilt: float) -> Callable[..., float]:
    def event(tau, state):
        del tau
        x, y, _, _ = state.tolist()
        return math.hypot(x, y) - tilt

    event.terminal = True  # type: ignore[attr-defined]
    event.direction = 1.0  # type: ignore[attr-defined]
    return event
