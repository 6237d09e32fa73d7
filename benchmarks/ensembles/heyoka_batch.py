"""heyoka's batch mode: a Taylor integrator for several runs in the lanes of SIMD registers.

A batch stops at the terminal event of any lane, and the lane is then refilled. Runs are sorted by frequency, so that
runs without event end at similar times.
"""

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from .answers import Answer
from .workloads import ATOL, ETA, ROLLING_ACCELERATION, RTOL, C, Workload


def name(width: int) -> str:
    """Return the name of the engine in tables."""
    return f"heyoka, batch of {width}"


def prepare(
    workload: Workload, *, width: int = 8, rtol: float = RTOL, atol: float = ATOL
) -> Callable[[Workload], Answer]:
    """Compile the integrator, which has one tolerance, and return a function that computes a workload of this kind."""
    del atol
    integrator = _integrator(workload, width, rtol)
    return partial(_solve, integrator)


def _integrator(workload: Workload, width: int, tolerance: float) -> Any:
    import heyoka as hy

    x, y, vx, vy = hy.make_vars("x", "y", "vx", "vy")
    nu, no_return = hy.par[0], hy.par[1]
    p, q = hy.cos(nu * hy.time), hy.sin(nu * hy.time)
    if workload.circular:
        ax, ay = ROLLING_ACCELERATION * p, ROLLING_ACCELERATION * q
    else:
        ax, ay = hy.par[2] * p + hy.par[4] * q, hy.par[3] * p + hy.par[5] * q
    square = x * x + y * y
    lean = 1.0 - C * square**-0.5  # one power is faster than a root and a quotient
    equations = [(x, vx), (y, vy), (vx, lean * x - ETA * vx - ax), (vy, lean * y - ETA * vy - ay)]
    overturning = hy.t_event_batch(square - no_return * no_return, direction=hy.event_direction.positive)
    return hy.taylor_adaptive_batch(
        equations,
        np.ones((4, width)),
        pars=np.ones((2 if workload.circular else 6, width)),
        t_events=[overturning],
        tol=tolerance,
        fast_math=True,
    )


def _solve(integrator: Any, workload: Workload) -> Answer:
    import heyoka as hy

    count, width = len(workload), integrator.batch_size
    end, time = np.empty((count, 4)), np.empty(count)
    overturned = np.zeros(count, bool)
    parameters = [workload.nu[:, None], workload.no_return[:, None]]
    if not workload.circular:
        parameters += [workload.cos, workload.sin]
    table = np.concatenate(parameters, axis=1)
    going_on = (hy.taylor_outcome.time_limit, hy.taylor_outcome.success)
    queue = iter(np.argsort(workload.nu, kind="stable").tolist())
    state, pars = integrator.state, integrator.pars
    runs = [-1] * width
    now, ends = np.zeros(width), np.zeros(width)

    def fill(lane: int) -> None:
        run = next(queue, -1)
        runs[lane] = run
        now[lane] = 0.0
        integrator.reset_cooldowns(lane)
        if run < 0:  # no run left: the lane keeps a harmless state
            ends[lane] = 0.0
            state[:, lane], pars[:, lane] = workload.start[0], table[0]
            return
        ends[lane] = workload.duration[run]
        state[:, lane], pars[:, lane] = workload.start[run], table[run]

    for lane in range(width):
        fill(lane)
    steps = 0
    while max(runs) >= 0:
        integrator.set_time(now)
        integrator.propagate_until(ends)
        now[:] = integrator.time
        for lane, (outcome, _, _, made) in enumerate(integrator.propagate_res):
            run = runs[lane]
            if run < 0:
                continue
            steps += made
            fell = outcome not in going_on
            if fell or now[lane] >= ends[lane]:
                end[run], time[run], overturned[run] = state[:, lane], now[lane], fell
                fill(lane)
    return Answer(end, time, overturned, steps)
