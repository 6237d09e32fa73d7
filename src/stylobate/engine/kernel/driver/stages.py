"""Steps of a lane: stages of DOP853, Taylor series, and the state within the step just made."""

import math

from stylobate.compiler.marks import fast, flat, lanes
from stylobate.engine.dop853 import A_EXTRA, C_EXTRA, STAGES, A, B, C, D
from stylobate.engine.elementary import cubic, polynomial, reciprocals, turning_point, value_and_slope, weighted
from stylobate.engine.kernel.bound import (
    COEFFICIENTS,
    DEGREES,
    GROUP_MOVING,
    GUARDS,
    INTEGRALS,
    ORDER,
    RATES_OF,
    SERIES,
    WIDTH,
    R,
    Table,
    expand,
)
from stylobate.engine.kernel.driver.equations import (
    State,
    accelerations,
    end_push,
    guards_under,
    keep_end_push,
    lean_of,
    numbers,
    push_series,
    rates_at,
    rates_under,
    row_state,
    stage_state,
)
from stylobate.engine.kernel.driver.events import Lean, lean, margins_of_limits
from stylobate.engine.kernel.shape import DENSE_TERMS, SERIES_ORDER

STAGE_NUMBERS = tuple(range(1, STAGES + 1))
STAGE_WEIGHTS = (*A, B)
"""Weights of the slopes in each stage; the last stage is the end of the step."""
GUARD_STAGES = (6, 9, 10, STAGES)
"""Stages at which the guards are evaluated, in the order of their times: about 1/4, 3/5, 6/7 and the end of a step."""


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
def make_long_stage(buf: Table, stage: int, group: int) -> None:
    """Evaluate a stage as `make_stage` does, with one compiled copy of the equations for all stages."""
    block = flat(buf)
    for n in lanes(GROUP_MOVING[group] * WIDTH):
        slopes = tuple(block[(R.SLOPE + earlier * ORDER) * WIDTH + n] for earlier in range(stage))
        step = block[R.STEP * WIDTH + n]
        block[R.STAGE * WIDTH + n] = block[R.STATE * WIDTH + n] + step * weighted(STAGE_WEIGHTS[stage], slopes)
    share = 1.0 if stage == STAGES else C[stage]
    if stage in GUARD_STAGES:
        evaluate_with_guards(buf, share, group)
    else:
        evaluate(buf, share, group)
    for n in lanes(GROUP_MOVING[group] * WIDTH):
        block[(R.SLOPE + stage * ORDER) * WIDTH + n] = block[R.RATE * WIDTH + n]


@fast
def evaluate(buf: Table, share: float, group: int) -> None:
    """Evaluate the equations in all lanes at this fraction of the step."""
    for i in lanes(WIDTH):
        push = accelerations(buf, i, buf[R.TIME, i] + share * buf[R.H, i])
        slopes = rates_under(buf, i, stage_state(buf, i, group), push)
        for j in range(GROUP_MOVING[group]):
            buf[R.RATE + j, i] = slopes[j]


@fast
def evaluate_with_guards(buf: Table, share: float, group: int) -> None:
    """Evaluate the equations as `evaluate` does, and mark the lanes with a broken guard or beyond a limit."""
    for i in lanes(WIDTH):
        push = accelerations(buf, i, buf[R.TIME, i] + share * buf[R.H, i])
        state = stage_state(buf, i, group)
        slopes = rates_under(buf, i, state, push)
        for j in range(GROUP_MOVING[group]):
            buf[R.RATE + j, i] = slopes[j]
        mark_broken_guards(buf, i, guards_under(buf, i, state, push), lean(*lean_of(buf, i, state)))


def mark_broken_guards(buf: Table, i: int, margins: tuple[float, ...], here: Lean) -> None:
    limits = margins_of_limits(buf, i, here)
    least = limits[0]
    for limit in limits[1:]:
        least = min(least, limit)
    for k in range(GUARDS - 1):
        least = min(least, margins[k])
    # The last guard counts only if it falls through zero.
    last, before = margins[GUARDS - 1], buf[R.GUARD_NOW, i]
    buf[R.GUARD_NOW, i] = last
    crossed = (1.0 if last < 0.0 else 0.0) * (0.0 if before < 0.0 else 1.0)
    buf[R.BROKEN, i] = max(buf[R.BROKEN, i], crossed, 1.0 if least < 0.0 else 0.0)


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


# Maximum ratio of a step to the step that the previous coefficients allowed, and to the previous step.
ROOM, MOST_GROWTH = 1.5, 10.0
# Minimum factor by which one attempt shortens a step.
LEAST_SHARE = 1e-3


@fast
def make_series_step(buf: Table, width: int) -> None:
    """Compute the coefficients, the length of the step, the new state and its error."""
    for i in lanes(width):
        t = buf[R.TIME, i]
        start = tuple(buf[R.STATE + j, i] for j in range(ORDER))
        states, rates, squares = expand(start, push_series(buf, i, t, SERIES_ORDER + 1), numbers(buf, i))
        for k in range(SERIES_ORDER + 1):
            buf[R.SQUARE + k, i] = squares[k]
        choose_length(buf, i, states)
        h = buf[R.H, i]
        for j in range(ORDER):
            if INTEGRALS[j] == j:
                for k in range(1, DEGREES[j] + 1):
                    buf[COEFFICIENTS[j] + k - 1, i] = states[j][k]
                value, slope = value_and_slope(states[j], h)
                buf[R.NEW + j, i] = value
                if RATES_OF[j] >= 0:
                    buf[R.NEW + RATES_OF[j], i] = slope
        find_defect(buf, i, t + h, start, rates)


def choose_length(buf: Table, i: int, states: tuple[tuple[float, ...], ...]) -> None:
    """Shorten the step to the length that the last coefficients allow, and propose the next step."""
    tried, last = buf[R.H, i], SERIES_ORDER
    base = abs(tried)
    power2 = base * base
    power4 = power2 * power2
    power8 = power4 * power4
    # |c15| b^15 + |c16| b^16 in tolerances, with b the step tried.
    before = power8 * power4 * power2 * base
    full = before * base
    per_scale = reciprocals(tuple(buf[R.ATOL_NOW, i] + buf[R.RTOL, i] * abs(state[0]) for state in states))
    size = 0.0
    for j in range(ORDER):
        size = size + (abs(states[j][last - 1]) * before + abs(states[j][last]) * full) * per_scale[j]
    root = math.sqrt(math.sqrt(math.sqrt(math.sqrt(size))))
    factor = 1.0 / max(root, 1.0 / MOST_GROWTH)
    # Sums instead of maxima, here and in the error, propagate NaN, and the step is rejected.
    buf[R.H, i] = tried * max(LEAST_SHARE, min(1.0, factor))
    buf[R.PROPOSED, i] = base * factor * ROOM


def find_defect(buf: Table, i: int, t: float, start: State, rates: tuple[tuple[float, ...], ...]) -> None:
    """Compute the error of the step from the defect of the equations at its end."""
    h = buf[R.H, i]
    new = tuple(buf[R.NEW + j, i] for j in range(ORDER))
    slopes = rates_at(buf, i, t, new)
    error = 0.0
    for j in range(ORDER):
        if RATES_OF[j] < 0:  # the defect of a rate covers its integral
            defect = abs(slopes[j] - polynomial(rates[j], h))
            error = error + defect / (buf[R.ATOL_NOW, i] + buf[R.RTOL, i] * max(abs(start[j]), abs(new[j])))
    buf[R.ERROR, i] = error * abs(h) * (1.0 / (SERIES_ORDER + 1))


# Within a step


def series_terms(buf: Table, i: int, j: int) -> tuple[float, ...]:
    """Return the coefficients of a state in the step just made, in powers of the time since its start."""
    integral = INTEGRALS[j]
    first = COEFFICIENTS[integral] - 1
    start = buf[R.LAST_STATE + j, i]
    if integral == j:
        return start, *(buf[first + k, i] for k in range(1, DEGREES[j] + 1))
    return start, *(float(k) * buf[first + k, i] for k in range(2, DEGREES[integral] + 1))


def series_within(buf: Table, i: int, elapsed: float) -> State:
    """Return the state at the time `elapsed` after the start of the step just made."""
    return tuple(polynomial(series_terms(buf, i, j), elapsed) for j in range(ORDER))


def falls_and_rises(slope: float, end_slope: float) -> float:
    """Return 1 if a function with these end slopes falls and then rises, else 0."""
    return (1.0 if slope < 0.0 else 0.0) * (1.0 if end_slope > 0.0 else 0.0)


def rises_and_falls(slope: float, end_slope: float) -> float:
    """Return 1 if a function with these end slopes rises and then falls, else 0."""
    return (1.0 if slope > 0.0 else 0.0) * (1.0 if end_slope < 0.0 else 0.0)


def extremes_by_series(buf: Table, i: int) -> tuple[float, float, float, float, float]:
    """Return minimum flag, minimum, maximum flag, maximum of the tilt, and the fraction of the step at the maximum.

    A step may be long: cubics over its halves locate the extremes, and the series gives their values. Each half has at
    most one extreme; of two minima or two maxima the first is used.
    """
    h = buf[R.H, i]
    half = 0.5 * h
    squares = tuple(buf[R.SQUARE + k, i] for k in range(SERIES_ORDER + 1))
    middle, slope = value_and_slope(squares, half)
    tilt0, tilt1 = buf[R.TILT, i], buf[R.NEW_TILT, i]
    values = tilt0 * tilt0, middle, tilt1 * tilt1
    slopes = 2.0 * buf[R.RADIAL, i] * half, slope * half, 2.0 * buf[R.NEW_RADIAL, i] * half
    low_early = falls_and_rises(slopes[0], slopes[1])
    high_early = rises_and_falls(slopes[0], slopes[1])
    falls = max(low_early, falls_and_rises(slopes[1], slopes[2]))
    rises = max(high_early, rises_and_falls(slopes[1], slopes[2]))
    at_low = place_of_extreme(values, slopes, low_early, -1.0)
    at_high = place_of_extreme(values, slopes, high_early, 1.0)
    lowest = math.sqrt(max(polynomial(squares, at_low * h), 0.0))
    highest = math.sqrt(max(polynomial(squares, at_high * h), 0.0))
    return falls, lowest, rises, highest, at_high


Three = tuple[float, float, float]


def place_of_extreme(values: Three, slopes: Three, early: float, sign: float) -> float:
    """Return the fraction of the step at which an extreme lies, in the first half of the step if `early` is 1."""
    start = values[0] if early > 0.0 else values[1]
    end = values[1] if early > 0.0 else values[2]
    slope = slopes[0] if early > 0.0 else slopes[1]
    end_slope = slopes[1] if early > 0.0 else slopes[2]
    place, _ = turning_point(start, end, slope, end_slope, sign)
    return 0.5 * (place + (0.0 if early > 0.0 else 1.0))


def set_dense_output(buf: Table, i: int) -> None:
    """Compute the dense output of the step just made."""
    if not SERIES:
        for j in range(ORDER):
            buf[R.NEW + j, i] = buf[R.STATE + j, i]
        h = buf[R.MADE, i]
        set_dense(buf, i, R.LAST_STATE, R.LAST_SLOPE, buf[R.TIME, i] - h, h)


def set_within_closely(buf: Table, i: int, elapsed: float) -> None:
    """Set the state as `set_within` does, but from the dense output, at the order of the method."""
    if SERIES:
        set_within(buf, i, elapsed)
        return
    u = elapsed / buf[R.MADE, i]
    for j in range(ORDER):
        buf[R.NEW + j, i] = buf[R.LAST_STATE + j, i] + dense_change(buf, i, u, j)


def set_within(buf: Table, i: int, elapsed: float) -> None:
    """Set the rows of the new state to the state at the time `elapsed` after the start of the step just made.

    The state is that of the series of the step, or of cubics through its ends.
    """
    if SERIES:
        state = series_within(buf, i, elapsed)
        for j in range(ORDER):
            buf[R.NEW + j, i] = state[j]
        return
    h = buf[R.MADE, i]
    for j in range(ORDER):
        slope, end_slope = h * buf[R.LAST_SLOPE + j, i], h * buf[R.SLOPE + j, i]
        buf[R.NEW + j, i] = cubic(elapsed / h, buf[R.LAST_STATE + j, i], buf[R.STATE + j, i], slope, end_slope)
