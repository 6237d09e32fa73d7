"""Events of lanes whose model changes between kinds of contact."""

import math

from stylobate.engine.kernel.bound import FLYING, FRICTION, R
from stylobate.engine.kernel.driver.contact_changes import BEGINS, apply_resets, set_moving
from stylobate.engine.kernel.driver.contact_ends import broken_now, first_broken_guard, nearly_broken
from stylobate.engine.kernel.driver.contact_implicit import follow_implicitly
from stylobate.engine.kernel.driver.contact_steps import (
    end_at_limit,
    end_contact,
    meet_reached_stop,
    record_peak_tilt,
    slip_turns,
)
from stylobate.engine.kernel.driver.contact_stiffness import LOOK_EVERY, detect_stiffness
from stylobate.engine.kernel.driver.events import Status, limit_passed
from stylobate.engine.kernel.driver.moving import set_lean
from stylobate.engine.kernel.driver.peaks import measure_peak
from stylobate.engine.kernel.driver.stages import set_dense
from stylobate.engine.kernel.driver.stops import set_next_stop
from stylobate.engine.kernel.layout import Table
from stylobate.engine.tolerances import SLIP_SHORTER


def begin(buf: Table, i: int, table: Table, pieces: Table) -> int:
    """Start the run of a lane; return WAITING if the column moves, else the status with which the run ends at once."""
    buf[R.LIFTS_AT, i] = math.inf
    buf[R.CHANGED_AT, i] = -math.inf
    buf[R.SINCE, i] = buf[R.TIME, i]
    buf[R.WANTED, i] = 0.0
    buf[R.STIFF_LOOKS, i] = 0.0
    buf[R.STIFF_LOOK_AT, i] = LOOK_EVERY
    buf[R.STIFF_WAIT, i] = LOOK_EVERY
    set_lean(buf, i)
    status = limit_passed(buf, i)
    if status != Status.WAITING:
        return status
    if buf[R.CONTACT, i] != FLYING:
        return apply_resets(buf, i, table, pieces, BEGINS)
    buf[R.STANDS, i] = 0.0
    number = broken_now(buf, i)
    return set_moving(buf, i, table, pieces) if number < 0 else apply_resets(buf, i, table, pieces, number)


def handle(buf: Table, i: int, table: Table, pieces: Table) -> int:
    """Handle the event of a lane; return the final status if the run ends, else WAITING."""
    if buf[R.HELD, i] > 0.0:
        return handle_held_step(buf, i, table, pieces)
    if buf[R.GO, i] == 0.0:
        number = nearly_broken(buf, i)
        return apply_resets(buf, i, table, pieces, number) if number >= 0 else Status.STEP_TOO_SMALL
    record_peak_tilt(buf, i)
    if buf[R.PEAK, i] > 0.0:
        beyond = measure_peak(buf, i)
        if beyond > 0.0:
            return end_at_limit(buf, i, beyond)
    if buf[R.STEPS, i] >= buf[R.MOST_STEPS, i]:
        return Status.STEP_LIMIT
    stiff = detect_stiffness(buf, i)
    buf[R.AIMED, i] = 0.0
    status, number = meet_reached_stop(buf, i, table, pieces)
    if status != Status.WAITING:
        return status
    if number >= 0:
        return apply_resets(buf, i, table, pieces, number)
    set_next_stop(buf, i)
    return follow_implicitly(buf, i, table, pieces) if stiff else Status.WAITING


def handle_held_step(buf: Table, i: int, table: Table, pieces: Table) -> int:
    """Find the broken guard in the step that was held back, and continue from there."""
    set_dense(buf, i, R.STATE, R.SLOPE, buf[R.TIME, i], buf[R.TRIED, i])
    elapsed, number = first_broken_guard(buf, i)
    if number < 0:  # only the cubics broke the guard: the step is repeated and accepted
        buf[R.H, i] = buf[R.TRIED, i]
        buf[R.AIMED, i] = 1.0
        return Status.WAITING
    if number == FRICTION and slip_turns(buf, i, elapsed):
        buf[R.H, i] = SLIP_SHORTER * elapsed
        buf[R.REJECTED, i] = 1.0
        return Status.WAITING
    return end_contact(buf, i, table, pieces, elapsed, number)
