"""Elementary functions without branches and without calls into the C library, which compilers can vectorise."""

import math

import numpy as np

from stylobate.compiler.marks import fast


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
