"""Acceptance of a step, or of its part before the end of the kind of contact, and stops."""

import math

from stylobate.engine.elementary import turning_point, winding
from stylobate.engine.kernel.bound import FLYING, LAST, ORDER, SLIDING, SLIP_X, SLIP_Y, SLIPPING, R
from stylobate.engine.kernel.driver.contact_changes import ONE_MOMENT, apply_resets
from stylobate.engine.kernel.driver.contact_ends import broken_now
from stylobate.engine.kernel.driver.equations import row_state
from stylobate.engine.kernel.driver.events import Status
from stylobate.engine.kernel.driver.moving import set_lean, set_rates, set_state
from stylobate.engine.kernel.driver.observation import observe
from stylobate.engine.kernel.driver.peaks import measure_peak, record_loss
from stylobate.engine.kernel.driver.stages import dense_state
from stylobate.engine.kernel.driver.stops import leg_end, meet_stop
from stylobate.engine.kernel.driver.tracing import trace_part
from stylobate.engine.kernel.driver.within import set_within
from stylobate.engine.kernel.layout import Table
from stylobate.engine.tolerances import SLIP_SHARE, SLIP_TURNS


def slip_turns(buf: Table, i: int, elapsed: float) -> bool:
    """Return whether a slip that has ended in its direction, `elapsed` into the step held back, continues across it."""
    if buf[R.CONTACT, i] not in (SLIDING, SLIPPING) or elapsed <= ONE_MOMENT * max(1.0, buf[R.TIME, i]):
        return False
    state = dense_state(buf, i, elapsed / buf[R.TRIED, i])
    before = math.hypot(buf[R.STATE + SLIP_X, i], buf[R.STATE + SLIP_Y, i])
    tolerance = SLIP_SHARE * buf[R.ATOL_NOW, i] + buf[R.RTOL, i] * before
    return math.hypot(state[SLIP_X], state[SLIP_Y]) > SLIP_TURNS * tolerance


def step_to(buf: Table, i: int, table: Table, elapsed: float) -> float:
    """Advance to this time on the dense output, and record extremes; return as `measure_peak` does."""
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
    record_peak_tilt(buf, i)
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


def record_peak_tilt(buf: Table, i: int) -> None:
    if buf[R.TILT, i] > buf[R.PEAK_TILT, i]:
        buf[R.PEAK_TILT, i] = buf[R.TILT, i]
        buf[R.PEAK_AT, i] = buf[R.TIME, i]


def end_contact(buf: Table, i: int, table: Table, pieces: Table, elapsed: float, number: int) -> int:
    """Continue from the time `elapsed` in the step at which this guard breaks; return as `apply_resets` does."""
    if elapsed > 0.0:
        step_to(buf, i, table, elapsed)
    if number == LAST:
        buf[R.MINIMUM_TILT, i] = min(buf[R.MINIMUM_TILT, i], buf[R.TILT, i])
        record_loss(buf, i)
    if number == LAST or buf[R.CONTACT, i] == FLYING:
        buf[R.WANTED, i] = 0.0
    if buf[R.STEPS, i] >= buf[R.MOST_STEPS, i]:
        return Status.STEP_LIMIT
    return apply_resets(buf, i, table, pieces, number)


def end_at_limit(buf: Table, i: int, beyond: float) -> int:
    """End the run at the time `beyond` in the step just made, at which the tilt passes its limit."""
    set_within(buf, i, beyond)
    set_state(buf, i, row_state(buf, i, R.NEW))
    buf[R.TIME, i] += beyond - buf[R.MADE, i]
    set_lean(buf, i)
    record_peak_tilt(buf, i)
    return Status.LIMIT


def meet_reached_stop(buf: Table, i: int, table: Table, pieces: Table) -> tuple[int, int]:
    """Handle a stop that a step has reached; return WAITING and the guard broken there, or the final status.

    A guard can break there because the base motion can jump; −1 means none.
    """
    t = buf[R.TIME, i]
    if t < buf[R.STOP, i]:
        return Status.WAITING, -1
    jumps = t >= leg_end(buf, i)
    status = meet_stop(buf, i, table, pieces, t)
    return status, broken_now(buf, i) if jumps and status == Status.WAITING else -1
