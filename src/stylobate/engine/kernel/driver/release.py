"""Uplift of a standing column: the first time at which the base acceleration exceeds the capacity."""

import math

from stylobate.engine.elementary import length
from stylobate.engine.kernel.bound import DEGREE, R
from stylobate.engine.kernel.driver.base_motion import held_for_good
from stylobate.engine.kernel.driver.push import accelerations
from stylobate.engine.kernel.layout import Table
from stylobate.engine.tolerances import SAMPLES_PER_PERIOD

# Time difference that counts as zero [samples].
MOMENT = 1e-6
# Weight that counts as zero.
RELEASE_MARGIN = 8.0 * 2.220446049250313e-16


def excess(buf: Table, i: int, t: float) -> float:
    ax, ay, az = accelerations(buf, i, t)
    pushed = length(ax + buf[R.SLOPE_X, i], ay + buf[R.SLOPE_Y, i])
    return pushed - buf[R.CAPACITY, i] * (1.0 + az + buf[R.SLOPE_Z, i])


def release_time(buf: Table, i: int, start: float, end: float) -> float:
    """Return the first time of uplift of a standing column in [start, end), or infinity."""
    if held_for_good(buf, i) or end <= start:
        return math.inf
    if DEGREE == 1:
        return release_on_line(buf, i, start, end)
    frequency = buf[R.FREQUENCY, i]
    spacing = 2.0 * math.pi / (frequency * SAMPLES_PER_PERIOD) if frequency > 0.0 else end - start
    spacing = min(spacing, 0.5 * (end - start))
    # An excess that vanishes at once is a rounding error of the time at which the column came to rest.
    if excess(buf, i, start) > 0.0:
        moment = min(start + MOMENT * spacing, end)
        if excess(buf, i, moment) > 0.0:
            return start
        start = moment
    e1 = excess(buf, i, start)
    t0, e0, t1 = start, e1, start
    for k in range(1, math.ceil((end - start) / spacing) + 1):
        t2 = min(start + k * spacing, end)
        e2 = excess(buf, i, t2)
        curvature = e0 - 2.0 * e1 + e2
        # A peak counts if twice the rise of the parabola through three samples would pass the limit.
        if k > 1 and e1 >= e0 and e1 >= e2 and curvature < 0.0:
            rise = -((e2 - e0) ** 2) / (8.0 * curvature)
            if e1 + 2.0 * rise - curvature > 0.0:
                top = peak(buf, i, t0, t2)
                if excess(buf, i, top) > 0.0:
                    return crossing(buf, i, t0, top)
        if e2 > 0.0:
            found = crossing(buf, i, t1, t2)
            return found if found < end else math.inf
        t0, e0, t1, e1 = t1, e1, t2, e2
    return math.inf


def release_on_line(buf: Table, i: int, start: float, end: float) -> float:
    """Return the same for a base acceleration linear in time: the excess is convex, with its maximum at an end."""
    if excess(buf, i, start) > 0.0:
        moment = min(start + MOMENT * (end - start), end)
        if excess(buf, i, moment) > 0.0:
            return start
        start = moment
    if excess(buf, i, end) <= 0.0:
        return math.inf
    found = crossing(buf, i, start, end)
    return found if found < end else math.inf


def peak(buf: Table, i: int, low: float, high: float) -> float:
    """Return the time of the maximum excess, by golden-section search."""
    golden = 0.6180339887498949
    a, b = high - golden * (high - low), low + golden * (high - low)
    ea, eb = excess(buf, i, a), excess(buf, i, b)
    for _ in range(50):
        if ea > eb:
            high, b, eb = b, a, ea
            a = high - golden * (high - low)
            ea = excess(buf, i, a)
        else:
            low, a, ea = a, b, eb
            b = low + golden * (high - low)
            eb = excess(buf, i, b)
    return a if ea > eb else b


def crossing(buf: Table, i: int, low: float, high: float) -> float:
    if excess(buf, i, low) >= 0.0:
        return low
    for _ in range(60):
        middle = 0.5 * (low + high)
        if excess(buf, i, middle) > 0.0:
            high = middle
        else:
            low = middle
    return high
