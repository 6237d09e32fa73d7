"""Events of a lane: overturning, tilt limit, passage through the vertical, rest, and stops."""

import math

from stylobate.engine.kernel.bound import CAN_LOSE, CAN_PASS, CAN_REST, ORDER, PLANAR, SERIES, R
from stylobate.engine.kernel.driver.equations import lean_of, lean_of_new, row_state
from stylobate.engine.kernel.driver.events import Status, Target, first_event, lean, status_at_target, time_left
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

# Maximum number of steps aimed at an event. A remaining step below the second number, in units of the longest step, is
# made by a Taylor polynomial, whose error is of third order.
MOST_AIMS, SHORT_AIM = 6, 1e-6
# Minimum step back to an event, as a fraction of the step that passed it.
SHORTEST_AIM = 1e-9


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
    target, ahead = first_event(buf, i, h, lean(*lean_of_new(buf, i)))
    if ahead <= 0.0:  # a swing too short to be resolved within the step
        buf[R.STATE, i] = 0.0
        return settle(buf, i, table, pieces, buf[R.TIME, i])
    aim(buf, i, target, ahead)
    return Status.WAITING


def aim(buf: Table, i: int, target: int, ahead: float) -> None:
    """Let the next step end at the target, at the time `ahead`."""
    buf[R.TARGET, i] = target
    buf[R.H, i] = ahead
    buf[R.AIMED, i] = 1.0


def approach_target(buf: Table, i: int, table: Table, pieces: Table) -> int:
    """Make another step towards the target, or handle the event if it is reached."""
    further = time_left(buf, i, lean(*lean_of(buf, i, row_state(buf, i, R.LAST_STATE))))
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
    if PLANAR and buf[R.TARGET, i] == Target.VERTICAL:
        return cross_vertical(buf, i, table, pieces)
    if CAN_LOSE and buf[R.TARGET, i] == Target.IMPACT:
        return apply_impact(buf, i, table, pieces)
    return status_at_target(buf, i)


def handle_near_vertical(buf: Table, i: int, table: Table) -> float:
    """Handle a three-dimensional passage near the vertical; return the time at which the column rests, or NaN."""
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
            aim(buf, i, Target.LIMIT, ahead)
            return Status.WAITING
    if buf[R.AIMED, i] > 0.0:
        return approach_target(buf, i, table, pieces)
    if buf[R.STEPS, i] >= buf[R.MOST_STEPS, i]:
        return Status.STEP_LIMIT
    if not PLANAR:
        if CAN_LOSE and loses_energy(buf, i):
            aim(buf, i, Target.IMPACT, -max(closest_within(buf, i), SHORTEST_AIM * buf[R.MADE, i]))
            return Status.WAITING
        rest = handle_near_vertical(buf, i, table)
        if not math.isnan(rest):
            return settle(buf, i, table, pieces, rest)
    t = buf[R.TIME, i]
    if t >= buf[R.STOP, i]:
        status = meet_stop(buf, i, table, pieces, t)
        if status != Status.WAITING:
            return status
    set_next_stop(buf, i)
    return Status.WAITING
