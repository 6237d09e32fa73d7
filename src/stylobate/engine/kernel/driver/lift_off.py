"""Lift-off: the time at which the base begins to fall faster than gravity."""

import math

from stylobate.engine.kernel.bound import DEGREE, VERTICAL, R
from stylobate.engine.kernel.driver.base_motion import set_leg
from stylobate.engine.kernel.driver.push import accelerations
from stylobate.engine.kernel.driver.stops import set_break
from stylobate.engine.kernel.layout import Table
from stylobate.engine.tolerances import SAMPLES_PER_PERIOD


def find_lift(buf: Table, i: int, table: Table, pieces: Table) -> None:
    """Set the time at which the base begins to fall faster than gravity."""
    buf[R.LIFTS_AT, i] = math.inf
    if not VERTICAL or buf[R.MINIMUM_VERTICAL, i] > -1.0:
        return
    t, end = buf[R.TIME, i], buf[R.END, i]
    first = int(buf[R.NEXT_BREAK, i])
    while t < end and math.isinf(buf[R.LIFTS_AT, i]):
        leg_end = min(end, buf[R.LEG_ENDS, i])
        while buf[R.BREAKS_AT, i] <= t:
            buf[R.NEXT_BREAK, i] += 1.0
            set_break(buf, i, table)
        leg_end = min(leg_end, buf[R.BREAKS_AT, i])
        buf[R.LIFTS_AT, i] = lift_in_leg(buf, i, t, leg_end)
        t = leg_end
        if t < end:
            set_leg(buf, i, table, pieces, t)
    buf[R.NEXT_BREAK, i] = first
    set_break(buf, i, table)
    set_leg(buf, i, table, pieces, buf[R.TIME, i])


def weight(buf: Table, i: int, t: float) -> float:
    return 1.0 + accelerations(buf, i, t)[2]


def lift_in_leg(buf: Table, i: int, start: float, end: float) -> float:
    frequency = buf[R.FREQUENCY, i]
    # A weight that is linear in time has its minimum at an end.
    sampled = frequency > 0.0 and DEGREE != 1
    spacing = 2.0 * math.pi / (frequency * SAMPLES_PER_PERIOD) if sampled else end - start
    t0 = t1 = start
    w0 = w1 = weight(buf, i, start)
    if w0 < 0.0:
        return start
    for k in range(1, math.ceil((end - start) / spacing) + 1):
        t2 = min(start + k * spacing, end)
        w2 = weight(buf, i, t2)
        below = t2
        if k > 1 and w1 <= w0 and w1 <= w2 and w2 >= 0.0:
            low, high = t0, t2  # minimum weight between three samples, by ternary search
            for _ in range(80):
                a, b = low + (high - low) / 3.0, high - (high - low) / 3.0
                if weight(buf, i, a) < weight(buf, i, b):
                    high = b
                else:
                    low = a
            below = low
        if weight(buf, i, below) < 0.0:
            low, high = t0, below
            for _ in range(60):
                middle = 0.5 * (low + high)
                if weight(buf, i, middle) < 0.0:
                    high = middle
                else:
                    low = middle
            return high
        t0, t1, w0, w1 = t1, t2, w1, w2
    return math.inf
