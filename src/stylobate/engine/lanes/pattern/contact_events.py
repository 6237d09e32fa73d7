"""What a lane is stopped for whose model changes between kinds of contact, and dealing with it."""

import math
from typing import TYPE_CHECKING

from stylobate.engine.compiler.marks import flat
from stylobate.engine.elementary import turning_point, winding
from stylobate.engine.lanes.columns import Status
from stylobate.engine.lanes.layout import Table
from stylobate.engine.lanes.pattern.contact_changes import BEGINS, ONE_MOMENT, go_through
from stylobate.engine.lanes.pattern.contact_ends import broken_now, first_end, nearly_broken
from stylobate.engine.lanes.pattern.contact_stiffness import (
    LOOK_EVERY,
    look_whether_stiff,
    out_of_steps,
    stiff_for_long,
)
from stylobate.engine.lanes.pattern.moving import set_lean, set_rates, set_state
from stylobate.engine.lanes.pattern.peaks import measure_peak
from stylobate.engine.lanes.pattern.stops import go_on, leg_end, meet_stop
from stylobate.engine.lanes.pattern.within import set_within

if TYPE_CHECKING:
    from stylobate.engine.lanes.pattern.head import (
        FLYING,
        FRICTION,
        LAST,
        ORDER,
        SLIDING,
        SLIP_SHARE,
        SLIP_SHORTER,
        SLIP_TURNS,
        SLIP_X,
        SLIP_Y,
        SLIPPING,
        R,
        dense_state,
        observe,
        row_state,
        set_dense,
    )

# --- the kernel's text begins here ---


def begin(buf: Table, i: int, table: Table, pieces: Table) -> int:
    """Set the run of a lane going; return WAITING when it moves, else the status with which it ends at once."""
    buf[R.LIFTS_AT, i] = math.inf
    buf[R.CHANGED_AT, i] = -math.inf
    buf[R.SINCE, i] = buf[R.TIME, i]
    buf[R.WANTED, i] = 0.0
    buf[R.STIFF_LOOKS, i] = 0.0
    buf[R.STIFF_LOOK_AT, i] = LOOK_EVERY
    set_lean(buf, i)
    if buf[R.TILT, i] > buf[R.TILT_LIMIT, i]:
        return Status.LIMIT
    return go_through(buf, i, table, pieces, BEGINS)


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
        if beyond > 0.0:  # the limit lies between two looks at it
            set_within(buf, i, beyond)
            set_state(buf, i, row_state(buf, i, R.NEW))
            buf[R.TIME, i] += beyond - buf[R.MADE, i]
            set_lean(buf, i)
            note_tilt(buf, i)
            return Status.LIMIT
    look_whether_stiff(buf, i)
    if stiff_for_long(buf, i):
        return Status.STIFF
    if buf[R.STEPS, i] >= buf[R.MOST_STEPS, i]:
        return out_of_steps(buf, i)
    t = buf[R.TIME, i]
    buf[R.AIMED, i] = 0.0
    if t >= buf[R.STOP, i]:
        jumps = t >= leg_end(buf, i)
        status = meet_stop(buf, i, table, pieces, t)
        if status != Status.WAITING:
            return status
        number = broken_now(buf, i) if jumps else -1
        if number >= 0:
            return go_through(buf, i, table, pieces, number)
    go_on(buf, i)
    return Status.WAITING


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
    if elapsed > 0.0:
        come_to(buf, i, elapsed)
    if number == LAST:
        buf[R.LEAST_TILT, i] = min(buf[R.LEAST_TILT, i], buf[R.TILT, i])
    if number == LAST or buf[R.CONTACT, i] == FLYING:
        buf[R.WANTED, i] = 0.0
    if buf[R.STEPS, i] >= buf[R.MOST_STEPS, i]:
        return out_of_steps(buf, i)
    return go_through(buf, i, table, pieces, number)


def turns(buf: Table, i: int, elapsed: float) -> bool:
    """Return whether a slip that has ended along its heading, so long into the step held back, goes on across it."""
    if buf[R.CONTACT, i] not in (SLIDING, SLIPPING) or elapsed <= ONE_MOMENT * max(1.0, buf[R.TIME, i]):
        return False
    state = dense_state(buf, i, elapsed / buf[R.TRIED, i])
    before = math.hypot(buf[R.STATE + SLIP_X, i], buf[R.STATE + SLIP_Y, i])
    tolerance = SLIP_SHARE * buf[R.ATOL_NOW, i] + buf[R.RTOL, i] * before
    return math.hypot(state[SLIP_X], state[SLIP_Y]) > SLIP_TURNS * tolerance


def come_to(buf: Table, i: int, elapsed: float) -> None:
    """Take the step that was held back up to this time, and note what happened in it."""
    x0, y0, tilt0 = buf[R.X, i], buf[R.Y, i], buf[R.TILT, i]
    momentum, radial = buf[R.MOMENTUM, i], buf[R.RADIAL, i]
    state = dense_state(buf, i, elapsed / buf[R.TRIED, i])
    for j in range(ORDER):
        buf[R.LAST_STATE + j, i] = buf[R.STATE + j, i]
        buf[R.LAST_SLOPE + j, i] = buf[R.SLOPE + j, i]
    set_state(buf, i, state)
    buf[R.TIME, i] += elapsed
    buf[R.MADE, i] = elapsed
    buf[R.STEPS, i] += 1.0
    set_lean(buf, i)
    x1, y1, tilt1 = buf[R.X, i], buf[R.Y, i], buf[R.TILT, i]
    buf[R.TURNS, i] += winding(x0, y0, x1, y1, momentum + buf[R.MOMENTUM, i])
    note_tilt(buf, i)
    low = min(tilt0, tilt1)
    slope0, slope1 = 2.0 * elapsed * radial, 2.0 * elapsed * buf[R.RADIAL, i]
    if slope0 < 0.0 < slope1:
        low = math.sqrt(max(turning_point(tilt0 * tilt0, tilt1 * tilt1, slope0, slope1, -1.0)[1], 0.0))
        buf[R.LEAST_TILT, i] = min(buf[R.LEAST_TILT, i], low)
    if slope0 > 0.0 > slope1:
        set_rates(buf, i, buf[R.TIME, i])
        measure_peak(buf, i)
    if buf[R.WATCHED, i] > 0.0:
        buf[R.LOW, i] = low
        observe(flat(buf), i)


def note_tilt(buf: Table, i: int) -> None:
    if buf[R.TILT, i] > buf[R.LARGEST_TILT, i]:
        buf[R.LARGEST_TILT, i] = buf[R.TILT, i]
        buf[R.LARGEST_AT, i] = buf[R.TIME, i]
