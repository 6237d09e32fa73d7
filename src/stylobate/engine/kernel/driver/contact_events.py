"""What a lane is stopped for whose model changes between kinds of contact, and dealing with it."""

import math

from stylobate.engine.kernel.bound import FLYING, FRICTION, R
from stylobate.engine.kernel.columns import Status
from stylobate.engine.kernel.driver.contact_changes import BEGINS, go_through, set_moving
from stylobate.engine.kernel.driver.contact_ends import broken_now, first_end, nearly_broken
from stylobate.engine.kernel.driver.contact_implicit import follow_implicitly
from stylobate.engine.kernel.driver.contact_steps import (
    end_at_limit,
    end_contact,
    meet_reached_stop,
    note_tilt,
    turns,
)
from stylobate.engine.kernel.driver.contact_stiffness import LOOK_EVERY, found_stiff
from stylobate.engine.kernel.driver.moving import set_lean
from stylobate.engine.kernel.driver.peaks import measure_peak
from stylobate.engine.kernel.driver.stages import set_dense
from stylobate.engine.kernel.driver.stops import go_on
from stylobate.engine.kernel.layout import Table
from stylobate.engine.tolerances import SLIP_SHORTER


def begin(buf: Table, i: int, table: Table, pieces: Table) -> int:
    """Set the run of a lane going; return WAITING when it moves, else the status with which it ends at once."""
    buf[R.LIFTS_AT, i] = math.inf
    buf[R.CHANGED_AT, i] = -math.inf
    buf[R.SINCE, i] = buf[R.TIME, i]
    buf[R.WANTED, i] = 0.0
    buf[R.STIFF_LOOKS, i] = 0.0
    buf[R.STIFF_LOOK_AT, i] = LOOK_EVERY
    buf[R.STIFF_WAIT, i] = LOOK_EVERY
    set_lean(buf, i)
    if buf[R.TILT, i] > buf[R.TILT_LIMIT, i]:
        return Status.LIMIT
    if buf[R.CONTACT, i] != FLYING:
        return go_through(buf, i, table, pieces, BEGINS)
    buf[R.STANDS, i] = 0.0
    number = broken_now(buf, i)
    return set_moving(buf, i, table, pieces) if number < 0 else go_through(buf, i, table, pieces, number)


def handle(buf: Table, i: int, table: Table, pieces: Table) -> int:
    """Deal with a lane that needs it; return the status of a run that ends, or WAITING."""
    if buf[R.HELD, i] > 0.0:
        return held_back(buf, i, table, pieces)
    if buf[R.GO, i] == 0.0:
        number = nearly_broken(buf, i)
        return go_through(buf, i, table, pieces, number) if number >= 0 else Status.STEP_TOO_SMALL
    note_tilt(buf, i)
    if buf[R.PEAK, i] > 0.0:
        beyond = measure_peak(buf, i)
        if beyond > 0.0:
            return end_at_limit(buf, i, beyond)
    if buf[R.STEPS, i] >= buf[R.MOST_STEPS, i]:
        return Status.STEP_LIMIT
    stiff = found_stiff(buf, i)
    buf[R.AIMED, i] = 0.0
    status, number = meet_reached_stop(buf, i, table, pieces)
    if status != Status.WAITING:
        return status
    if number >= 0:
        return go_through(buf, i, table, pieces, number)
    go_on(buf, i)
    return follow_implicitly(buf, i, table, pieces) if stiff else Status.WAITING


def held_back(buf: Table, i: int, table: Table, pieces: Table) -> int:
    """Find what ended the kind of contact in the step that was held back, and go on from there."""
    set_dense(buf, i, R.STATE, R.SLOPE, buf[R.TIME, i], buf[R.TRIED, i])
    elapsed, number = first_end(buf, i)
    if number < 0:  # it only seemed so on the cubics: the step is made again, and taken
        buf[R.H, i] = buf[R.TRIED, i]
        buf[R.AIMED, i] = 1.0
        return Status.WAITING
    if number == FRICTION and turns(buf, i, elapsed):
        buf[R.H, i] = SLIP_SHORTER * elapsed
        buf[R.REJECTED, i] = 1.0
        return Status.WAITING
    return end_contact(buf, i, table, pieces, elapsed, number)
