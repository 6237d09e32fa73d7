"""Functions of compiled code: elementary functions, sums, roots of events and linear equations."""

import math
from typing import NamedTuple

import numpy as np

from stylobate.compiler.marks import fast
from stylobate.engine.kernel.bound import Row, Table


@fast
def cos_turns(u: float) -> float:
    """Return cos 2πu with an error of 3e-16, by the minimax odd polynomial of degree 15 for sin 2πs, |s| ≤ ¼."""
    s: float = 0.25 - abs(u - np.floor(u + 0.5))
    z = s * s
    series = -0.6913364032112558
    series = z * series + 3.8170966486840054
    series = z * series - 15.094481573379602
    series = z * series + 42.05868882331772
    series = z * series - 76.70585966228043
    series = z * series + 81.60524927525293
    series = z * series - 41.34170224039673
    series = z * series + 6.2831853071795845
    return s * series


def length(x: float, y: float) -> float:
    """Return the length of a vector, several times as fast as `math.hypot`; squares below 1e-308 count as zero."""
    return math.sqrt(x * x + y * y)


@fast
def winding(x0: float, y0: float, x1: float, y1: float, momentum: float) -> float:
    """Return +1 or −1 if the path from (x0, y0) to (x1, y1) crosses the negative x axis anticlockwise or clockwise.

    Within a right angle the path is the shorter one. Beyond, the sign of the `momentum` x ẏ − y ẋ decides on which side
    of the origin it passes.
    """
    cross = x0 * y1 - y0 * x1
    sense = cross if x0 * x1 + y0 * y1 > 0.0 else momentum
    upper = (1.0 if y1 >= 0.0 else 0.0) - (1.0 if y0 >= 0.0 else 0.0)
    # Positive if the azimuth, from −π to π, is larger at the second point.
    growth = upper if upper != 0.0 else cross
    forward = (1.0 if sense > 0.0 else 0.0) * (1.0 if growth < 0.0 else 0.0)
    backward = (1.0 if sense < 0.0 else 0.0) * (1.0 if growth > 0.0 else 0.0)
    return forward - backward


@fast
def turning_point(start: float, end: float, slope: float, end_slope: float, sign: float) -> tuple[float, float]:
    """Return place on [0, 1] and value of the extreme of the cubic with these end values and slopes.

    `sign` is 1 for a maximum, −1 for a minimum; meaningful only if the slopes have opposite signs.
    """
    rise = end - start
    b = 3.0 * rise - 2.0 * slope - end_slope
    a = slope + end_slope - 2.0 * rise
    u = slope / (sign * math.sqrt(abs(b * b - 3.0 * a * slope)) - b)
    return u, start + u * (slope + u * (b + u * a))


def weighted(weights: tuple[float, ...], values: tuple[float, ...]) -> float:
    """Return a linear combination without the terms of weight zero."""
    return sum(weight * value for weight, value in zip(weights, values, strict=False) if weight != 0.0)


def reciprocals(values: tuple[float, ...]) -> tuple[float, ...]:
    """Return the reciprocals of the values, with one division for each two."""
    out: tuple[float, ...] = ()
    for j in tuple(range((len(values) + 1) // 2)):
        if 2 * j + 1 < len(values):
            one, other = values[2 * j], values[2 * j + 1]
            per_both = 1.0 / (one * other)
            out = (*out, per_both * other, per_both * one)
        else:
            out = (*out, 1.0 / values[2 * j])
    return out


def polynomial(coefficients: tuple[float, ...], u: float) -> float:
    """Return the value of a polynomial at `u`, by Horner's rule."""
    return value_and_slope(coefficients, u)[0]


def value_and_slope(coefficients: tuple[float, ...], u: float) -> tuple[float, float]:
    """Return value and derivative of a polynomial at `u`, by Horner's rule."""
    value, slope = coefficients[-1], 0.0
    for k in tuple(range(len(coefficients) - 1)):
        slope = value if k == 0 else slope * u + value
        value = value * u + coefficients[len(coefficients) - 2 - k]
    return value, slope


_BISECTIONS = 52
# Bisections for a growth past a bound: the cubic is right to 1e-4 of the step, and steps aimed at the event are exact.
_FEW_BISECTIONS = 14
# The search for a first return begins at this fraction of the step, doubles up to the second number, and then
# continues at equal steps.
_FIRST_FRACTION, _EQUAL = 2.0**-40, 1.0 / 16.0
# Relative accuracy of a root.
_ROOT = 1e-14


def cubic(u: float, start: float, end: float, slope: float, end_slope: float) -> float:
    """Return the value at `u` of the cubic on [0, 1] with these values and slopes at its ends."""
    rise = end - start
    b = 3.0 * rise - 2.0 * slope - end_slope
    a = slope + end_slope - 2.0 * rise
    return start + u * (slope + u * (b + u * a))


def cubic_rate(u: float, start: float, end: float, slope: float, end_slope: float) -> float:
    """Return the derivative of `cubic`."""
    rise = end - start
    b = 3.0 * rise - 2.0 * slope - end_slope
    a = slope + end_slope - 2.0 * rise
    return slope + u * (2.0 * b + 3.0 * u * a)


def first_growth_past(bound: float, start: float, end: float, slope: float, end_slope: float) -> float:
    """Return the smallest u in (0, 1] at which the cubic lies above `bound` and grows; 1 if only its end does."""
    if _grows_past(0.0, bound, start, end, slope, end_slope):
        return _ROOT
    before = 0.0
    for k in range(1, 17):
        u = k / 16.0
        if _grows_past(u, bound, start, end, slope, end_slope):
            low, high = before, u
            for _ in range(_FEW_BISECTIONS):
                middle = 0.5 * (low + high)
                if _grows_past(middle, bound, start, end, slope, end_slope):
                    high = middle
                else:
                    low = middle
            return high
        before = u
    return 1.0


def _grows_past(u: float, bound: float, start: float, end: float, slope: float, end_slope: float) -> bool:
    above = cubic(u, start, end, slope, end_slope) >= bound
    return above and cubic_rate(u, start, end, slope, end_slope) > 0.0


def quintic(
    u: float, h: float, x0: float, v0: float, a0: float, x1: float, v1: float, a1: float
) -> tuple[float, float]:
    """Return value and slope in u of the quintic on [0, 1] with these values, rates and accelerations at both ends.

    Rates and accelerations are time derivatives; the interval has the duration `h`.
    """
    p1, p2 = v0 * h, 0.5 * a0 * h * h
    rise, q1, q2 = x1 - x0, v1 * h, 0.5 * a1 * h * h
    p3 = 10.0 * rise - 6.0 * p1 - 4.0 * q1 - 3.0 * p2 + q2
    p4 = -15.0 * rise + 8.0 * p1 + 7.0 * q1 + 3.0 * p2 - 2.0 * q2
    p5 = 6.0 * rise - 3.0 * (p1 + q1) - p2 + q2
    value = x0 + u * (p1 + u * (p2 + u * (p3 + u * (p4 + u * p5))))
    return value, p1 + u * (2.0 * p2 + u * (3.0 * p3 + u * (4.0 * p4 + u * 5.0 * p5)))


def first_return(h: float, s0: float, v0: float, a0: float, s1: float, v1: float, a1: float) -> float:
    """Return the first time in (0, h] at which a height s > 0 falls below zero; 0 if at once, h if never.

    The height is the quintic with these values, speeds and accelerations at both ends. Near the start its relative
    accuracy is that of the acceleration there.
    """
    # A swing from the vertical takes at least half the time that speed and acceleration at the start give.
    p1, p2 = v0 * h, 0.5 * a0 * h * h
    u = _EQUAL
    if s0 == 0.0 and p2 < 0.0:
        u = min(u, -0.5 * p1 / p2)
    elif s0 == 0.0:
        u = _FIRST_FRACTION
    if u < _FIRST_FRACTION:
        return 0.0
    low, low_value = 0.0, s0
    value = quintic(u, h, s0, v0, a0, s1, v1, a1)[0]
    while value >= 0.0:
        if u >= 1.0:
            return h
        low, low_value = u, value
        u = 2.0 * u if u < _EQUAL else min(1.0, u + _EQUAL)
        value = quintic(u, h, s0, v0, a0, s1, v1, a1)[0]
    return _falling_root(low, low_value, u, value, h, s0, v0, a0, s1, v1, a1) * h


def _falling_root(
    low: float,
    low_value: float,
    high: float,
    high_value: float,
    h: float,
    s0: float,
    v0: float,
    a0: float,
    s1: float,
    v1: float,
    a1: float,
) -> float:
    """Return the root of the quintic between `low` and `high`, by Newton's method with bisection as safeguard."""
    u = 0.5 * (low + high) if low_value <= 0.0 else (low_value * high - high_value * low) / (low_value - high_value)
    for _ in range(_BISECTIONS):
        value, slope = quintic(u, h, s0, v0, a0, s1, v1, a1)
        if value >= 0.0:
            low = u
        else:
            high = u
        closer = u - value / slope if slope < 0.0 else 0.5 * (low + high)
        if not low < closer < high:
            closer = 0.5 * (low + high)
        if abs(closer - u) <= _ROOT * closer:
            return closer
        u = closer
    return u


def turns_of(x: float, y: float) -> float:
    """Return the azimuth of (x, y) in turns, −½ to ½; y = −0 counts as y = 0, as in `winding`."""
    return math.atan2(y + 0.0, x) / (2.0 * math.pi)


def nearest_turn(azimuth: float, previous: float) -> float:
    """Return `azimuth` [turns] plus the whole turns that bring it nearest to `previous`; NaN there means none.

    Of two equally near values the even number of turns is taken: rocking through the vertical adds no turns.
    """
    turns: float = np.rint(previous - azimuth)
    return azimuth if math.isnan(previous) else azimuth + turns


class NewtonRoom(NamedTuple):
    """Work arrays of an implicit step of n equations.

    `changes` and `corrections` of the state at the three nodes of the step, 3n; the Jacobian, n x n, and the `coupled`
    states, on which the rates depend; factors of the matrices of Newton's method for these states, n x n and 2n x 2n,
    with their row exchanges; and parts of vectors in the real and in the complex modes, n and 2n.
    """

    change: Row
    correction: Row
    jacobian: Table
    coupled: Row
    single: Table
    single_pivots: Row
    double: Table
    double_pivots: Row
    real: Row
    turned: Row


def factor(matrix: Table, pivots: Row, n: int) -> bool:
    """Replace the first n rows and columns of a matrix by their factors L and U; return False if they are singular.

    `pivots` records the row exchanges, and the diagonal of U holds reciprocals. A matrix with numbers that are not
    finite counts as singular.
    """
    for k in range(n):
        largest = k
        for row in range(k + 1, n):
            if abs(matrix[row, k]) > abs(matrix[largest, k]):
                largest = row
        pivots[k] = largest
        if not 0.0 < abs(matrix[largest, k]) < math.inf:
            return False
        if largest != k:
            for column in range(n):
                matrix[k, column], matrix[largest, column] = matrix[largest, column], matrix[k, column]
        matrix[k, k] = 1.0 / matrix[k, k]
        for row in range(k + 1, n):
            share = matrix[row, k] * matrix[k, k]
            matrix[row, k] = share
            for column in range(k + 1, n):
                matrix[row, column] -= share * matrix[k, column]
    return True


def solve(factors: Table, pivots: Row, x: Row, n: int) -> None:
    """Replace the first n numbers of `x` by the solution of the equations with the `factors` from `factor`."""
    for k in range(n):
        largest = int(pivots[k])
        x[k], x[largest] = x[largest], x[k]
    for k in range(n):
        for row in range(k + 1, n):
            x[row] -= factors[row, k] * x[k]
    for done in range(n):
        k = n - 1 - done
        x[k] *= factors[k, k]
        for row in range(k):
            x[row] -= factors[row, k] * x[k]
