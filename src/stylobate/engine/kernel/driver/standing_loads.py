"""Contact loads while the column stands."""

import math

from stylobate.engine.kernel.bound import DEGREE, DEMANDS, R
from stylobate.engine.kernel.driver.equations import LEAST_NORMAL
from stylobate.engine.kernel.driver.push import accelerations
from stylobate.engine.kernel.layout import Table
from stylobate.engine.tolerances import SAMPLES_PER_PERIOD


def record_standing_loads(buf: Table, i: int, start: float, end: float) -> None:
    """Record the peak friction demand |a_h|/(1 + a_z) and the minimum normal force while standing from start to end.

    If the acceleration is linear in time, both occur at an end, because the demand is quasi-convex. Otherwise they are
    extremes of parabolas through three samples, spaced as in the search for uplift.
    """
    if not DEMANDS or end <= start:
        return
    parts = 1
    if DEGREE != 1:
        frequency = buf[R.FREQUENCY, i]
        spacing = 2.0 * math.pi / (frequency * SAMPLES_PER_PERIOD) if frequency > 0.0 else end - start
        parts = max(2, math.ceil((end - start) / spacing))
    d0, n0 = standing_load(buf, i, start)
    d1, n1 = d0, n0
    most, least = d0, n0
    for k in range(1, parts + 1):
        d2, n2 = standing_load(buf, i, end if k == parts else start + (end - start) * (k / parts))
        most = max(most, d2)
        least = min(least, n2)
        if k > 1:
            most = max(most, crest(d0, d1, d2))
            least = min(least, -crest(-n0, -n1, -n2))
        d0, n0, d1, n1 = d1, n1, d2, n2
    buf[R.FRICTION, i] = max(buf[R.FRICTION, i], most)
    buf[R.NORMAL, i] = min(buf[R.NORMAL, i], least)


def standing_load(buf: Table, i: int, t: float) -> tuple[float, float]:
    """Return the friction demand and the normal force over the weight of a column that stands at `t`."""
    ax, ay, az = accelerations(buf, i, t)
    return math.hypot(ax, ay) / max(1.0 + az, LEAST_NORMAL), 1.0 + az


def crest(before: float, here: float, after: float) -> float:
    """Return the maximum of the parabola through three equidistant values, or the middle value if it has none there."""
    bend = before - 2.0 * here + after
    slant = after - before
    return here - slant * slant / (8.0 * bend) if abs(slant) < -2.0 * bend else here
