"""diffrax on a CPU: Dopri8 over 1024 simultaneous runs by `vmap`."""

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from .answers import Answer
from .workloads import ATOL, ETA, ROLLING_ACCELERATION, RTOL, C, Workload

LANES = 1024
NAME = f"diffrax, {LANES} lanes"


def prepare(workload: Workload, *, rtol: float = RTOL, atol: float = ATOL) -> Callable[[Workload], Answer]:
    """Compile the solver and return a function that computes a workload of this kind."""
    solver = _solver(circular=workload.circular, rtol=rtol, atol=atol)
    return partial(_solve, solver)


def _solver(*, circular: bool, rtol: float, atol: float) -> Any:
    import diffrax
    import jax
    import jax.numpy as jnp
    import optimistix

    jax.config.update("jax_enable_x64", True)

    def rates(tau, state, args):
        x, y, vx, vy = state
        nu, cx, cy, sx, sy, _ = args
        lean = 1.0 - C / jnp.sqrt(x * x + y * y)
        p, q = jnp.cos(nu * tau), jnp.sin(nu * tau)
        if circular:
            ax, ay = ROLLING_ACCELERATION * p, ROLLING_ACCELERATION * q
        else:
            ax, ay = cx * p + sx * q, cy * p + sy * q
        return vx, vy, lean * x - ETA * vx - ax, lean * y - ETA * vy - ay

    def past_no_return(t, y, args, **rest):
        del t, rest
        return jnp.sqrt(y[0] ** 2 + y[1] ** 2) - args[-1]

    # Rolling omits the event, which is faster.
    find = optimistix.Newton(1e-10, 1e-10, optimistix.rms_norm)
    event = None if circular else diffrax.Event(past_no_return, find, direction=True)

    def solve(start, duration, args):
        solution = diffrax.diffeqsolve(
            diffrax.ODETerm(rates),
            diffrax.Dopri8(),
            t0=0.0,
            t1=duration,
            dt0=None,
            y0=start,
            args=args,
            saveat=diffrax.SaveAt(t1=True),
            stepsize_controller=diffrax.PIDController(rtol=rtol, atol=atol),
            event=event,
            max_steps=None,
            throw=False,
        )
        fell = jnp.asarray(False) if event is None else solution.event_mask
        return solution.ts[-1], [part[-1] for part in solution.ys], fell, solution.stats["num_accepted_steps"]

    return jax.jit(jax.vmap(solve))


def _solve(solver: Any, workload: Workload) -> Answer:
    count = len(workload)
    end, time = np.empty((count, 4)), np.empty(count)
    overturned = np.zeros(count, bool)
    steps = 0
    for first in range(0, count, LANES):
        rows = np.arange(first, first + LANES)
        part = workload.take(np.minimum(rows, count - 1))
        args = (part.nu, *part.cos.T, *part.sin.T, part.no_return)
        ts, ys, fell, made = solver(tuple(part.start.T), part.duration, args)
        kept = slice(0, count - first)
        time[first : first + LANES] = np.asarray(ts)[kept]
        end[first : first + LANES] = np.stack([np.asarray(y) for y in ys], axis=1)[kept]
        overturned[first : first + LANES] = np.asarray(fell)[kept]
        steps += int(np.asarray(made)[kept].sum())
    return Answer(end, time, overturned, steps)
