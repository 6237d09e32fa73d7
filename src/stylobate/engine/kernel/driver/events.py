"""What a lane is stopped for, and dealing with it."""

import math

from stylobate.engine.kernel.bound import CAN_LOSE, CAN_PASS, CAN_REST, ORDER, PLANAR, SERIES, R
from stylobate.engine.kernel.columns import Status
from stylobate.engine.kernel.driver.equations import lean_of_new, row_state
from stylobate.engine.kernel.driver.moving import set_lean, set_state
from stylobate.engine.kernel.driver.passages import cross_upright, hop, hops, loses, strike
from stylobate.engine.kernel.driver.peaks import closest_within, measure_peak, take_back
from stylobate.engine.kernel.driver.resting import rest_within_step, settle
from stylobate.engine.kernel.driver.stops import go_on, meet_stop
from stylobate.engine.kernel.driver.tracing import untrace
from stylobate.engine.kernel.driver.within import set_within
from stylobate.engine.kernel.layout import Table
from stylobate.engine.kernel.roots import first_growth_past, first_return

# An event is met by repeated steps towards it, so often at most; a further step below the second number, in units of
# the longest step, is made by a Taylor polynomial, whose error is its third power.
MOST_AIMS, SHORT_AIM = 6, 1e-6
# A step back to an event has at least this part of the step that met it.
SHORTEST_AIM = 1e-9


def event_ahead(buf: Table, i: int) -> float:
    """Return the step to the first event within a step that was held back."""
    h = buf[R.HELD_STEP, i]
    tilt0, radial0 = buf[R.TILT, i], buf[R.RADIAL, i]
    x1, y1, vx1, vy1 = lean_of_new(buf, i)
    square0, square1 = tilt0 * tilt0, x1 * x1 + y1 * y1
    slope0, slope1 = 2.0 * h * radial0, 2.0 * h * (x1 * vx1 + y1 * vy1)
    found = h
    if PLANAR:
        side = buf[R.SIDE, i]
        found = first_return(
            h,
            side * buf[R.STATE, i],
            side * buf[R.STATE + 1, i],
            side * buf[R.SLOPE + 1, i],
            side * buf[R.NEW, i],
            side * buf[R.NEW + 1, i],
            side * buf[R.SLOPE_NEW + 1, i],
        )
    limit, no_return = buf[R.TILT_LIMIT, i], buf[R.NO_RETURN, i]
    tilt1 = math.sqrt(square1)
    if tilt1 > limit:
        found = min(found, h * first_growth_past(limit * limit, square0, square1, slope0, slope1))
    if tilt1 > no_return and slope1 > 0.0:
        found = min(found, h * first_growth_past(no_return * no_return, square0, square1, slope0, slope1))
    return found


def meets_upright(buf: Table, i: int) -> bool:
    """Return whether the event that a lane was aimed at is the upright."""
    return PLANAR and buf[R.TILT, i] < 0.5 * min(buf[R.TILT_LIMIT, i], buf[R.NO_RETURN, i])


def miss(buf: Table, i: int) -> float:
    """Return the further step to the event at which an aimed step has arrived."""
    tilt, radial, h = buf[R.TILT, i], buf[R.RADIAL, i], buf[R.MADE, i]
    bound = min(buf[R.TILT_LIMIT, i], buf[R.NO_RETURN, i])
    further = 0.0
    if meets_upright(buf, i):
        speed = buf[R.STATE + 1, i]
        further = -buf[R.STATE, i] / speed if speed != 0.0 else 0.0
    elif buf[R.BY_TILT, i] > 0.0:
        further = (bound - tilt) * tilt / radial if radial > 0.0 else 0.0
    else:
        set_within(buf, i, 0.0)
        x, y, vx, vy = lean_of_new(buf, i)
        before = x * vx + y * vy
        further = -radial * h / (radial - before) if radial != before else 0.0
    return min(max(further, -0.5 * abs(h)), 0.5 * abs(h))


def creep(buf: Table, i: int, h: float) -> None:
    """Go on by a time so short that the step's series, or two terms of another, give the state."""
    if SERIES:
        set_within(buf, i, buf[R.MADE, i] + h)
        set_state(buf, i, row_state(buf, i, R.NEW))
    for j in range(0 if SERIES else ORDER):
        slope = buf[R.SLOPE + j, i]
        bend = (slope - buf[R.LAST_SLOPE + j, i]) / buf[R.MADE, i]
        buf[R.STATE + j, i] += h * (slope + 0.5 * h * bend)
    buf[R.TIME, i] += h
    set_lean(buf, i)


def held_back(buf: Table, i: int, table: Table, pieces: Table) -> int:
    """Aim at the event within the step that was held back."""
    h = buf[R.TRIED, i]
    buf[R.HELD_STEP, i] = h
    ahead = event_ahead(buf, i)
    if ahead <= 0.0:  # a swing that begins and ends within a part of the step too small to be resolved
        buf[R.STATE, i] = 0.0
        return settle(buf, i, table, pieces, buf[R.TIME, i])
    aim(buf, i, ahead)
    return Status.WAITING


def aim(buf: Table, i: int, ahead: float) -> None:
    """Let the next step end at the event that lies `ahead`."""
    # Of the two conditions of overturning, which is met last: tilt, or growth of the tilt. A lossy passage, −1, is
    # aimed at as the latter: where the tilt begins to grow.
    buf[R.BY_TILT, i] = 1.0 if buf[R.TILT, i] < min(buf[R.TILT_LIMIT, i], buf[R.NO_RETURN, i]) else 0.0
    buf[R.H, i] = ahead
    buf[R.AIMED, i] = 1.0


def arrived(buf: Table, i: int, table: Table, pieces: Table) -> int:
    """Go nearer to the event that the lane was aimed at, or deal with it."""
    further = miss(buf, i)
    short = abs(further) < SHORT_AIM * min(1.0, buf[R.LONGEST_STEP, i])
    if not short and buf[R.AIMED, i] < MOST_AIMS:
        buf[R.H, i] = further
        buf[R.AIMED, i] += 1.0
        return Status.WAITING
    creep(buf, i, further)
    buf[R.AIMED, i] = 0.0
    if buf[R.TILT, i] > buf[R.PEAK_TILT, i]:
        buf[R.PEAK_TILT, i] = buf[R.TILT, i]
        buf[R.LARGEST_AT, i] = buf[R.TIME, i]
    if meets_upright(buf, i):
        return cross_upright(buf, i, table, pieces)
    if CAN_LOSE and buf[R.BY_TILT, i] < 0.0:
        return strike(buf, i, table, pieces)
    return Status.LIMIT if buf[R.TILT_LIMIT, i] <= buf[R.NO_RETURN, i] else Status.OVERTURNED


def near_upright(buf: Table, i: int, table: Table) -> float:
    """Deal with a passage near the upright, out of a plane; return when the column came to rest there, or NaN."""
    if CAN_LOSE and loses(buf, i):
        aim(buf, i, -max(closest_within(buf, i), SHORTEST_AIM * buf[R.MADE, i]))
        buf[R.BY_TILT, i] = -1.0
        return math.nan
    if CAN_REST and buf[R.REST_ENERGY, i] > 0.0 and buf[R.LOW, i] < buf[R.SLOW, i] * buf[R.REST_TILT, i]:
        rest = rest_within_step(buf, i)
        if not math.isnan(rest):
            return rest
    if CAN_PASS and hops(buf, i):
        hop(buf, i, table)
    return math.nan


def handle(buf: Table, i: int, table: Table, pieces: Table) -> int:
    """Deal with a lane that needs it; return the status of a run that ends, or WAITING."""
    if buf[R.HELD, i] > 0.0:
        return held_back(buf, i, table, pieces)
    if buf[R.GO, i] == 0.0:
        return Status.STEP_TOO_SMALL
    if buf[R.PEAK, i] > 0.0:
        ahead = measure_peak(buf, i)
        if ahead > 0.0 and buf[R.AIMED, i] == 0.0:  # the limit lies between the ends of the step and its peak
            take_back(buf, i)
            untrace(buf, i)
            aim(buf, i, ahead)
            return Status.WAITING
    if buf[R.AIMED, i] > 0.0:
        return arrived(buf, i, table, pieces)
    if buf[R.STEPS, i] >= buf[R.MOST_STEPS, i]:
        return Status.STEP_LIMIT
    if not PLANAR:
        rest = near_upright(buf, i, table)
        if not math.isnan(rest):
            return settle(buf, i, table, pieces, rest)
        if buf[R.AIMED, i] > 0.0:
            return Status.WAITING
    t = buf[R.TIME, i]
    if t >= buf[R.STOP, i]:
        status = meet_stop(buf, i, table, pieces, t)
        if status != Status.WAITING:
            return status
    go_on(buf, i)
    return Status.WAITING
