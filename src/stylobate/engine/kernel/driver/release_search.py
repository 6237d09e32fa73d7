"""Search for the next uplift of a standing column, and its time limit."""

import math

from stylobate.engine.kernel.bound import DEGREE, R
from stylobate.engine.kernel.driver.release import release_time
from stylobate.engine.kernel.driver.stops import leg_end
from stylobate.engine.kernel.layout import Table

# Number of periods that show all of a periodic motion, whatever the phase at their start.
PERIODS_KNOWN = 2.0


def next_release(buf: Table, i: int, t: float) -> float:
    """Return the time of the next uplift before the leg ends, or infinity.

    NaN means that the search reached its limit of one period per allowed step; a moving column takes two steps in a
    period.
    """
    end = search_end(buf, i, t)
    release = release_time(buf, i, t, end)
    return math.nan if release > end and end < leg_end(buf, i) and not repeats_to_the_end(buf, i) else release


def search_end(buf: Table, i: int, t: float) -> float:
    """Return the end of the search for uplift that begins at `t` within the leg."""
    end, frequency = leg_end(buf, i), buf[R.FREQUENCY, i]
    if DEGREE == 1 or frequency == 0.0:
        return end
    most = t + buf[R.MOST_STEPS, i] * (2.0 * math.pi / frequency)
    known = t + PERIODS_KNOWN * buf[R.PERIOD, i]
    return min(end, known if end > most and known < most and repeats_to_the_end(buf, i) else most)


def repeats_to_the_end(buf: Table, i: int) -> bool:
    """Return whether the base motion is periodic from now to the end of the run."""
    return buf[R.PERIOD, i] > 0.0 and min(buf[R.LEG_ENDS, i], buf[R.BREAKS_AT, i]) >= buf[R.END, i]
