"""Events of a lane: overturning, tilt limit, passage through the vertical, rest, and stops."""

import math

from stylobate.engine.kernel.bound import CAN_LOSE, CAN_PASS, CAN_REST, ORDER, PLANAR, SERIES, R
from stylobate.engine.kernel.columns import Status
from stylobate.engine.kernel.driver.equations import lean_of_new, row_state
from stylobate.engine.kernel.driver.moving import set_lean, set_state
from stylobate.engine.kernel.driver.passages import (
    apply_impact,
    cross_vertical,
    loses_energy,
    nears_vertical,
    pass_analytically,
)
from stylobate.engine.kernel.driver.peaks import closest_within, measure_peak, undo_step
from stylobate.engine.kernel.driver.resting import rest_within_step, settle
from stylobate.engine.kernel.driver.stops import meet_stop, set_next_stop
from stylobate.engine.kernel.driver.tracing import remove_trace_entry
from stylobate.engine.kernel.driver.within import set_within
from stylobate.engine.kernel.layout import Table
from stylobate.engine.kernel.roots import first_growth_past, first_return

# Maximum number of steps aimed at an event. A remaining step below the second number, in units of the longest step, is
# made by a Taylor polynomial, whose error is of third order.
MOST_AIMS, SHORT_AIM = 6, 1e-6
# Minimum step back to an event, as a fraction of the step that passed it.
SHORTEST_AIM = 1e-9


def event_ahead(buf: Table, i: int) -> float:
    """Return the time to the first event within a step that was held back."""
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


def meets_vertical(buf: Table, i: int) -> bool:
    """Return whether the targeted event is the passage through the vertical."""
    return PLANAR and buf[R.TILT, i] < 0.5 * min(buf[R.TILT_LIMIT, i], buf[R.NO_RETURN, i])


def remaining_step(buf: Table, i: int) -> float:
    """Return the time from the end of an aimed step to its event."""
    tilt, radial, h = buf[R.TILT, i], buf[R.RADIAL, i], buf[R.MADE, i]
    bound = min(buf[R.TILT_LIMIT, i], buf[R.NO_RETURN, i])
    further = 0.0
    if meets_vertical(buf, i):
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


def advance_briefly(buf: Table, i: int, h: float) -> None:
    """Advance by a very short time, by the series of the step or by two Taylor terms."""
    if SERIES:
        set_within(buf, i, buf[R.MADE, i] + h)
        set_state(buf, i, row_state(buf, i, R.NEW))
    for j in range(0 if SERIES else ORDER):
        slope = buf[R.SLOPE + j, i]
        bend = (slope - buf[R.LAST_SLOPE + j, i]) / buf[R.MADE, i]
        buf[R.STATE + j, i] += h * (slope + 0.5 * h * bend)
    buf[R.TIME, i] += h
    set_lean(buf, i)


def handle_held_step(buf: Table, i: int, table: Table, pieces: Table) -> int:
    """Aim at the event within the step that was held back."""
    h = buf[R.TRIED, i]
    buf[R.HELD_STEP, i] = h
    ahead = event_ahead(buf, i)
    if ahead <= 0.0:  # a swing too short to be resolved within the step
        buf[R.STATE, i] = 0.0
        return settle(buf, i, table, pieces, buf[R.TIME, i])
    aim(buf, i, ahead)
    return Status.WAITING


def aim(buf: Table, i: int, ahead: float) -> None:
    """Let the next step end at the event at the time `ahead`."""
    # The condition of overturning that is met last: tilt, or growth of the tilt. A lossy passage, −1, is located as the
    # latter, at the minimum tilt.
    buf[R.BY_TILT, i] = 1.0 if buf[R.TILT, i] < min(buf[R.TILT_LIMIT, i], buf[R.NO_RETURN, i]) else 0.0
    buf[R.H, i] = ahead
    buf[R.AIMED, i] = 1.0


def approach_event(buf: Table, i: int, table: Table, pieces: Table) -> int:
    """Make another step towards the targeted event, or handle the event if it is reached."""
    further = remaining_step(buf, i)
    short = abs(further) < SHORT_AIM * min(1.0, buf[R.LONGEST_STEP, i])
    if not short and buf[R.AIMED, i] < MOST_AIMS:
        buf[R.H, i] = further
        buf[R.AIMED, i] += 1.0
        return Status.WAITING
    advance_briefly(buf, i, further)
    buf[R.AIMED, i] = 0.0
    if buf[R.TILT, i] > buf[R.PEAK_TILT, i]:
        buf[R.PEAK_TILT, i] = buf[R.TILT, i]
        buf[R.PEAK_AT, i] = buf[R.TIME, i]
    if meets_vertical(buf, i):
        return cross_vertical(buf, i, table, pieces)
    if CAN_LOSE and buf[R.BY_TILT, i] < 0.0:
        return apply_impact(buf, i, table, pieces)
    return Status.LIMIT if buf[R.TILT_LIMIT, i] <= buf[R.NO_RETURN, i] else Status.OVERTURNED


def handle_near_vertical(buf: Table, i: int, table: Table) -> float:
    """Handle a three-dimensional passage near the vertical; return the time at which the column rests, or NaN."""
    if CAN_LOSE and loses_energy(buf, i):
        aim(buf, i, -max(closest_within(buf, i), SHORTEST_AIM * buf[R.MADE, i]))
        buf[R.BY_TILT, i] = -1.0
        return math.nan
    if CAN_REST and buf[R.REST_ENERGY, i] > 0.0 and buf[R.LOW, i] < buf[R.SLOW, i] * buf[R.REST_TILT, i]:
        rest = rest_within_step(buf, i)
        if not math.isnan(rest):
            return rest
    if CAN_PASS and nears_vertical(buf, i):
        pass_analytically(buf, i, table)
    return math.nan


def handle(buf: Table, i: int, table: Table, pieces: Table) -> int:
    """Handle the event of a lane; return the final status if the run ends, else WAITING."""
    if buf[R.HELD, i] > 0.0:
        return handle_held_step(buf, i, table, pieces)
    if buf[R.GO, i] == 0.0:
        return Status.STEP_TOO_SMALL
    if buf[R.PEAK, i] > 0.0:
        ahead = measure_peak(buf, i)
        if ahead > 0.0 and buf[R.AIMED, i] == 0.0:  # only the peak within the step exceeds the limit
            undo_step(buf, i)
            remove_trace_entry(buf, i)
            aim(buf, i, ahead)
            return Status.WAITING
    if buf[R.AIMED, i] > 0.0:
        return approach_event(buf, i, table, pieces)
    if buf[R.STEPS, i] >= buf[R.MOST_STEPS, i]:
        return Status.STEP_LIMIT
    if not PLANAR:
        rest = handle_near_vertical(buf, i, table)
        if not math.isnan(rest):
            return settle(buf, i, table, pieces, rest)
        if buf[R.AIMED, i] > 0.0:
            return Status.WAITING
    t = buf[R.TIME, i]
    if t >= buf[R.STOP, i]:
        status = meet_stop(buf, i, table, pieces, t)
        if status != Status.WAITING:
            return status
    set_next_stop(buf, i)
    return Status.WAITING
