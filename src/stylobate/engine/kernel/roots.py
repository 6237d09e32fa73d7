"""Root finding for events within a step, from the values and slopes at both ends of the step."""

import math

import numpy as np

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
