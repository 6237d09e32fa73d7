"""Contact loads within a step, vectorised over lanes: values at quarters of the step, extremes by parabolas."""

from stylobate.compiler.marks import fast, lanes
from stylobate.engine.kernel.bound import ORDER, SERIES, R
from stylobate.engine.kernel.driver.equations import State, loads_of
from stylobate.engine.kernel.driver.push import accelerations
from stylobate.engine.kernel.driver.series import series_within
from stylobate.engine.kernel.layout import Table

PLACES = tuple(range(1, 5))
"""Numbers of the equal parts of a step; the loads are evaluated at the end of each part."""
LOADS = 3
"""Normal force, friction demand and pivoting demand, in the order of their rows."""


@fast
def follow_demands(buf: Table, width: int) -> None:
    """Record the extremes of the loads within the step just made; the loads at its start remain from the last step."""
    for place in PLACES:  # one loop over lanes for each place: a joint loop would be too long
        evaluate_loads(buf, place, width)
    for i in lanes(width):
        record_extreme(buf, i, 0, R.NORMAL, -1.0)
        record_extreme(buf, i, 1, R.FRICTION, 1.0)
        record_extreme(buf, i, 2, R.PIVOTING, 1.0)


@fast
def evaluate_loads(buf: Table, place: int, width: int) -> None:
    """Compute the loads at the end of one part of the step."""
    for i in lanes(width):
        share = place / len(PLACES)
        h, t = buf[R.MADE, i], buf[R.TIME, i]
        time = t if place == len(PLACES) else t - (1.0 - share) * h
        loads = loads_of(buf, i, state_within(buf, i, share), accelerations(buf, i, time))
        for load in range(LOADS):
            buf[R.LOADS + LOADS * place + load, i] = loads[load]


def state_within(buf: Table, i: int, share: float) -> State:
    """Return the state at this fraction of the step, by cubics through its ends or by its series."""
    if share == 1.0:
        return tuple(buf[R.STATE + j, i] for j in range(ORDER))
    h = buf[R.MADE, i]
    if SERIES:
        return series_within(buf, i, share * h)
    return tuple(
        cubic_within(
            share, h, buf[R.LAST_STATE + j, i], buf[R.STATE + j, i], buf[R.LAST_SLOPE + j, i], buf[R.SLOPE + j, i]
        )
        for j in range(ORDER)
    )


def cubic_within(share: float, h: float, start: float, end: float, slope: float, end_slope: float) -> float:
    """Return the value at this fraction of a step of the cubic with these values and slopes at its ends."""
    rest = 1.0 - share
    value = rest * rest * (1.0 + 2.0 * share) * start + share * share * (3.0 - 2.0 * share) * end
    return value + h * (share * rest * rest * slope + -share * share * rest * end_slope)


def record_extreme(buf: Table, i: int, load: int, row: int, sign: float) -> None:
    """Record the maximum (sign 1) or minimum (sign −1) of a load within the step just made."""
    values = tuple(buf[R.LOADS + LOADS * place + load, i] for place in range(len(PLACES) + 1))
    top = values[0]
    for first in range(0, len(PLACES), 2):
        start, middle, end = values[first], values[first + 1], values[first + 2]
        bend = start - 2.0 * middle + end
        slant = end - start
        # The parabola has an extreme of the right kind within these two parts.
        inside = 1.0 if abs(slant) < -2.0 * sign * bend else 0.0
        peak = middle - slant * slant / (8.0 * (bend if inside > 0.0 else 1.0))
        peak = peak if inside > 0.0 else middle
        top = farther(farther(top, peak, sign), end, sign)
    go, before = buf[R.GO, i], buf[row, i]
    buf[row, i] = farther(before, top, sign) if go > 0.0 else before
    buf[R.LOADS + load, i] = values[-1] if go > 0.0 else values[0]


def farther(a: float, b: float, sign: float) -> float:
    return min(a, b) if sign < 0.0 else max(a, b)
