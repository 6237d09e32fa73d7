"""Taking a step of a kind of contact, or what of it comes before the end of that kind, and stops."""

import math

from stylobate.engine.elementary import turning_point, winding
from stylobate.engine.kernel.bound import FLYING, LAST, ORDER, SLIDING, SLIP_X, SLIP_Y, SLIPPING, R
from stylobate.engine.kernel.columns import Status
from stylobate.engine.kernel.driver.contact_changes import ONE_MOMENT, go_through
from stylobate.engine.kernel.driver.contact_ends import broken_now
from stylobate.engine.kernel.driver.equations import row_state
from stylobate.engine.kernel.driver.moving import set_lean, set_rates, set_state
from stylobate.engine.kernel.driver.observation import observe
from stylobate.engine.kernel.driver.peaks import measure_peak
from stylobate.engine.kernel.driver.stages import dense_state
from stylobate.engine.kernel.driver.stops import leg_end, meet_stop
from stylobate.engine.kernel.driver.tracing import trace_part
from stylobate.engine.kernel.driver.within import set_within
from stylobate.engine.kernel.layout import Table
from stylobate.engine.tolerances import SLIP_SHARE, SLIP_TURNS


def turns(buf: Table, i: int, elapsed: float) -> bool:
    """Return whether a slip that has ended along its heading, so long into the step held back, goes on across it."""
    if buf[R.CONTACT, i] not in (SLIDING, SLIPPING) or elapsed <= ONE_MOMENT * max(1.0, buf[R.TIME, i]):
        return False
    state = dense_state(buf, i, elapsed / buf[R.TRIED, i])
    before = math.hypot(buf[R.STATE + SLIP_X, i], buf[R.STATE + SLIP_Y, i])
    tolerance = SLIP_SHARE * buf[R.ATOL_NOW, i] + buf[R.RTOL, i] * before
    return math.hypot(state[SLIP_X], state[SLIP_Y]) > SLIP_TURNS * tolerance


def come_to(buf: Table, i: int, table: Table, elapsed: float) -> float:
    """Take the step of the dense output up to this time, and note what happened in it; return as `measure_peak`."""
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
    trace_part(buf, i, table)
    note_tilt(buf, i)
    low, beyond = min(tilt0, tilt1), 0.0
    slope0, slope1 = 2.0 * elapsed * radial, 2.0 * elapsed * buf[R.RADIAL, i]
    if slope0 < 0.0 < slope1:
        low = math.sqrt(max(turning_point(tilt0 * tilt0, tilt1 * tilt1, slope0, slope1, -1.0)[1], 0.0))
        buf[R.MINIMUM_TILT, i] = min(buf[R.MINIMUM_TILT, i], low)
    if slope0 > 0.0 > slope1:
        set_rates(buf, i, buf[R.TIME, i])
        beyond = measure_peak(buf, i)
    if buf[R.WATCHED, i] > 0.0:
        buf[R.LOW, i] = low
        observe(buf, i)
    return beyond


def note_tilt(buf: Table, i: int) -> None:
    if buf[R.TILT, i] > buf[R.PEAK_TILT, i]:
        buf[R.PEAK_TILT, i] = buf[R.TILT, i]
        buf[R.LARGEST_AT, i] = buf[R.TIME, i]


def end_contact(buf: Table, i: int, table: Table, pieces: Table, elapsed: float, number: int) -> int:
    """Go on from where the step breaks this margin, so long after its start; return as `go_through` does."""
    if elapsed > 0.0:
        come_to(buf, i, table, elapsed)
    if number == LAST:
        buf[R.MINIMUM_TILT, i] = min(buf[R.MINIMUM_TILT, i], buf[R.TILT, i])
    if number == LAST or buf[R.CONTACT, i] == FLYING:
        buf[R.WANTED, i] = 0.0
    if buf[R.STEPS, i] >= buf[R.MOST_STEPS, i]:
        return Status.STEP_LIMIT
    return go_through(buf, i, table, pieces, number)


def end_at_limit(buf: Table, i: int, beyond: float) -> int:
    """End the run where the tilt passes its limit between two looks at it, so long into the step just made."""
    set_within(buf, i, beyond)
    set_state(buf, i, row_state(buf, i, R.NEW))
    buf[R.TIME, i] += beyond - buf[R.MADE, i]
    set_lean(buf, i)
    note_tilt(buf, i)
    return Status.LIMIT


def meet_reached_stop(buf: Table, i: int, table: Table, pieces: Table) -> tuple[int, int]:
    """Do what is due where a step has come to a stop; return WAITING and the margin broken there, or the final status.

    What jumps there is the base motion. The margin is −1 where there is none.
    """
    t = buf[R.TIME, i]
    if t < buf[R.STOP, i]:
        return Status.WAITING, -1
    jumps = t >= leg_end(buf, i)
    status = meet_stop(buf, i, table, pieces, t)
    return status, broken_now(buf, i) if jumps and status == Status.WAITING else -1
