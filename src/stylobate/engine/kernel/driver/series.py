"""Step by Taylor series, vectorised over lanes.

The generated function `expand` computes the coefficients of the states order by order, by recurrences from the
recorded equations of the model. The last two coefficients limit the step; the defect of the equations at the end of the
step is its error. For equations with few products this takes half the work of a Runge–Kutta method.
"""

import math

from stylobate.compiler.marks import fast, lanes
from stylobate.engine.elementary import turning_point
from stylobate.engine.kernel.bound import COEFFICIENTS, DEGREES, INTEGRALS, ORDER, RATES_OF, R, expand
from stylobate.engine.kernel.driver.equations import State, numbers, rates_at
from stylobate.engine.kernel.driver.push import push_series
from stylobate.engine.kernel.layout import Table
from stylobate.engine.kernel.shape import SERIES_ORDER
from stylobate.engine.sums import polynomial, reciprocals, value_and_slope

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
