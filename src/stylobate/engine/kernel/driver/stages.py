"""Stages of DOP853, vectorised over lanes, and dense output and stability of a step in one lane.

E. Hairer, S. P. Nørsett, G. Wanner, "Solving Ordinary Differential Equations I", 2nd ed., II.5 and II.6: twelve
stages of order 8, error estimates of orders 5 and 3, and three more stages for dense output of order 7.
"""

import math

from stylobate.compiler.marks import fast, flat, lanes
from stylobate.engine.dop853 import A_EXTRA, C_EXTRA, STAGES, A, B, C, D
from stylobate.engine.kernel.bound import ORDER, WIDTH, R
from stylobate.engine.kernel.driver.equations import State, rates_at, rates_under, row_state
from stylobate.engine.kernel.driver.push import accelerations, end_push, keep_end_push
from stylobate.engine.kernel.layout import Table
from stylobate.engine.kernel.shape import DENSE_TERMS
from stylobate.engine.sums import weighted

STAGE_NUMBERS = tuple(range(1, STAGES + 1))
STAGE_WEIGHTS = (*A, B)
"""Weights of the slopes in each stage; the last stage is the end of the step."""


def slopes_of(buf: Table, i: int, j: int) -> tuple[float, ...]:
    """Return the slopes of a state at all stages; the last one is at the end of the step."""
    return tuple(buf[R.SLOPE + stage * ORDER + j, i] for stage in range(STAGES + 1))


@fast
def make_stage(buf: Table, stage: int, width: int) -> None:
    """Evaluate the equations at a stage; the last stage gives the new state and its slope."""
    for i in lanes(width):
        h, t = buf[R.H, i], buf[R.TIME, i]
        state = tuple(
            buf[R.STATE + j, i] + h * weighted(STAGE_WEIGHTS[stage], slopes_of(buf, i, j)) for j in range(ORDER)
        )
        # The last two stages have the same time.
        push = end_push(buf, i) if stage == STAGES else accelerations(buf, i, t + C[stage] * h)
        if stage == STAGES - 1:
            keep_end_push(buf, i, push)
        slopes = rates_under(buf, i, state, push)
        for j in range(ORDER):
            buf[R.SLOPE + stage * ORDER + j, i] = slopes[j]
            if stage == STAGES:
                buf[R.NEW + j, i] = state[j]


# Long equations are compiled once, in a function that all stages call. Its states are in rows; operations that are the
# same for each state are one loop over the block of all states of all lanes.


@fast
def make_long_stage(buf: Table, stage: int) -> None:
    """Evaluate a stage as `make_stage` does, with one compiled copy of the equations for all stages."""
    block = flat(buf)
    for n in lanes(ORDER * WIDTH):
        slopes = tuple(block[(R.SLOPE + earlier * ORDER) * WIDTH + n] for earlier in range(stage))
        step = block[R.STEP * WIDTH + n]
        block[R.STAGE * WIDTH + n] = block[R.STATE * WIDTH + n] + step * weighted(STAGE_WEIGHTS[stage], slopes)
    evaluate(buf, 1.0 if stage == STAGES else C[stage])
    for n in lanes(ORDER * WIDTH):
        block[(R.SLOPE + stage * ORDER) * WIDTH + n] = block[R.RATE * WIDTH + n]


@fast
def evaluate(buf: Table, share: float) -> None:
    """Evaluate the equations in all lanes at this fraction of the step."""
    for i in lanes(WIDTH):
        push = accelerations(buf, i, buf[R.TIME, i] + share * buf[R.H, i])
        slopes = rates_under(buf, i, row_state(buf, i, R.STAGE), push)
        for j in range(ORDER):
            buf[R.RATE + j, i] = slopes[j]


# One lane


def set_dense(buf: Table, i: int, state: int, slope: int, t: float, h: float) -> None:
    """Compute the dense output of the step h from t; `state` and `slope` are the first rows of its start."""
    for number in EXTRA_NUMBERS:
        for j in range(ORDER):
            combination = weighted(A_EXTRA[number], stage_slopes(buf, i, slope, j))
            buf[R.DENSE + j, i] = buf[state + j, i] + h * combination
        slopes = rates_at(buf, i, t + C_EXTRA[number] * h, row_state(buf, i, R.DENSE))
        for j in range(ORDER):
            buf[R.EXTRA + number * ORDER + j, i] = slopes[j]
    for j in range(ORDER):
        slopes_here = stage_slopes(buf, i, slope, j)
        change = buf[R.NEW + j, i] - buf[state + j, i]
        buf[R.DENSE + j, i] = change
        buf[R.DENSE + ORDER + j, i] = h * slopes_here[0] - change
        buf[R.DENSE + 2 * ORDER + j, i] = 2.0 * change - h * (slopes_here[0] + slopes_here[STAGES])
        for k in DENSE_NUMBERS:
            buf[R.DENSE + (3 + k) * ORDER + j, i] = h * weighted(D[k], slopes_here)


EXTRA_NUMBERS, DENSE_NUMBERS = tuple(range(3)), tuple(range(4))


def stage_slopes(buf: Table, i: int, slope: int, j: int) -> tuple[float, ...]:
    """Return the slopes of a state at all stages and at the extra stages; `slope` is the first row of the start."""
    first = buf[slope + j, i]
    stages = tuple(buf[R.SLOPE + stage * ORDER + j, i] for stage in range(1, STAGES + 1))
    return first, *stages, *(buf[R.EXTRA + number * ORDER + j, i] for number in EXTRA_NUMBERS)


def dense_state(buf: Table, i: int, u: float) -> State:
    """Return the state at the fraction `u` of the step whose dense output is set, from the state of the lane."""
    return tuple(buf[R.STATE + j, i] + dense_change(buf, i, u, j) for j in range(ORDER))


def dense_change(buf: Table, i: int, u: float, j: int) -> float:
    """Return the change of a state from the start of the step to its fraction `u`."""
    change = 0.0
    for k in tuple(range(DENSE_TERMS)):
        term = DENSE_TERMS - 1 - k
        change = (change + buf[R.DENSE + term * ORDER + j, i]) * (u if term % 2 == 0 else 1.0 - u)
    return change


def stability(buf: Table, i: int) -> float:
    """Return hλ of the step just made, from the slopes of its last two stages, whose times are equal.

    E. Hairer, G. Wanner, "Solving Ordinary Differential Equations II", section IV.2.
    """
    h = buf[R.MADE, i]
    apart, change = 0.0, 0.0
    last = STAGES - 1
    for j in range(ORDER):
        slopes = stage_slopes(buf, i, R.LAST_SLOPE, j)
        step = buf[R.NEW + j, i] - buf[R.LAST_STATE + j, i] - h * weighted(A[last], slopes)
        turned = slopes[STAGES] - slopes[last]
        apart += step * step
        change += turned * turned
    return h * math.sqrt(change / apart) if apart > 0.0 else 0.0
