"""Changes between kinds of contact: reset maps, and standing until uplift."""

import math

from stylobate.engine.kernel.bound import (
    FALLEN,
    FLYING,
    FRICTION,
    JAM,
    JAMMED,
    LAST,
    LIMIT,
    ORDER,
    RESTING,
    ROLLING,
    SLIDING,
    SLIPPING,
    R,
)
from stylobate.engine.kernel.driver.base_motion import held_for_good
from stylobate.engine.kernel.driver.contact_ends import broken_now
from stylobate.engine.kernel.driver.equations import lean_of_new, row_state
from stylobate.engine.kernel.driver.events import STATUSES_AT_LIMITS, Status, TraceKind
from stylobate.engine.kernel.driver.guards import guards_at, model_reset, moves_in_plane
from stylobate.engine.kernel.driver.moving import azimuth_now, first_step, set_lean, set_rates, set_state
from stylobate.engine.kernel.driver.observation import observe
from stylobate.engine.kernel.driver.push import accelerations
from stylobate.engine.kernel.driver.release import RELEASE_MARGIN
from stylobate.engine.kernel.driver.release_search import next_release, search_end
from stylobate.engine.kernel.driver.stops import leg_end, meet_stop, next_stop, resume, stand_to_the_end
from stylobate.engine.kernel.driver.tracing import trace_analytical_step, trace_entry, trace_stand
from stylobate.engine.kernel.layout import Table
from stylobate.engine.kernel.roots import nearest_turn, turns_of
from stylobate.engine.tolerances import DEPARTURE

# Maximum number of contact changes at one time, and the time difference that counts as one time [units of the larger
# of 1 and the time].
MOST_AT_ONCE, ONE_MOMENT = 100, 1e-12
# Not a guard: the reset map at the start of a motion.
BEGINS = -1


def apply_resets(buf: Table, i: int, table: Table, pieces: Table, number: int) -> int:
    """Apply the reset map of a broken guard and of each guard broken after it; return WAITING or the final status."""
    while True:
        if number == FALLEN:
            return Status.OVERTURNED
        if number >= LIMIT:
            return STATUSES_AT_LIMITS[number - LIMIT]
        if endless(buf, i):
            return Status.ENDLESS
        apply_reset(buf, i, table, number)
        if buf[R.CONTACT, i] == JAMMED:
            return Status.JAMMED
        if buf[R.CONTACT, i] == RESTING:
            status, number = stand(buf, i, table, pieces)
            if status != Status.WAITING:
                return status
        else:
            number = broken_now(buf, i)
            if number < 0:
                return set_moving(buf, i, table, pieces)


def endless(buf: Table, i: int) -> bool:
    """Return whether the contact has changed too often at this time; count the next change."""
    t = buf[R.TIME, i]
    again = t - buf[R.CHANGED_AT, i] <= ONE_MOMENT * max(1.0, abs(t))
    buf[R.AT_ONCE, i] = buf[R.AT_ONCE, i] + 1.0 if again else 0.0
    buf[R.CHANGED_AT, i] = t
    return buf[R.AT_ONCE, i] > MOST_AT_ONCE


def apply_reset(buf: Table, i: int, table: Table, number: int) -> None:
    """Apply the reset map of the model for a broken guard to the state, and record the change."""
    t, before = buf[R.TIME, i], int(buf[R.CONTACT, i])
    if buf[R.TILT, i] > 0.0:
        buf[R.LAST_AZIMUTH, i] = azimuth_now(buf, i)
    ahead = DEPARTURE / (1.0 + buf[R.FREQUENCY, i])
    now, later = accelerations(buf, i, t), accelerations(buf, i, t + ahead)
    elapsed, state = model_reset(buf, i, float(number), now, later, ahead)
    lapses = elapsed > 0.0 and t + elapsed < buf[R.END, i]
    if buf[R.TRACES, i] > 0.0:
        trace_change(buf, i, table, number, elapsed, state)
        if lapses:
            trace_lapse(buf, i, table, elapsed, state)
    for j in range(ORDER):
        buf[R.LAST_STATE + j, i] = buf[R.STATE + j, i]
    set_state(buf, i, state)
    buf[R.TIME_RESTING + before, i] += t - buf[R.SINCE, i]
    buf[R.SINCE, i] = t
    if number >= 0:
        count(buf, i, number, before, int(buf[R.CONTACT, i]), elapsed)
    buf[R.STANDS, i] = 0.0
    if lapses:
        pass_lapse(buf, i, elapsed)
    set_lean(buf, i)


def trace_change(buf: Table, i: int, table: Table, number: int, elapsed: float, state: tuple[float, ...]) -> None:
    """Add the event to the trace that changes the present state into `state` within the time `elapsed`."""
    before, after = int(buf[R.CONTACT, i]), int(state[ORDER - 1])
    if number >= 0 and not slip_continues(number, before, after, elapsed):
        at = trace_entry(buf, i, table, TraceKind.CONTACT, buf[R.TIME, i], 0.0)
        run = int(buf[R.RUN, i])
        table[run, at] = number
        table[run, at + 1] = before
        table[run, at + 2] = after


def trace_lapse(buf: Table, i: int, table: Table, elapsed: float, state: tuple[float, ...]) -> None:
    """Add the analytical step to the trace that changes the present state into `state` within the time `elapsed`."""
    for j in range(ORDER):
        buf[R.NEW + j, i] = state[j]
    x, y, _, _ = lean_of_new(buf, i)
    last = buf[R.LAST_AZIMUTH, i]
    azimuth = nearest_turn(turns_of(x, y), last) if x != 0.0 or y != 0.0 else last
    buf[R.TRACE_AZIMUTH, i] = last if buf[R.TILT, i] > 0.0 else azimuth
    trace_analytical_step(buf, i, table, elapsed, state, azimuth)


def pass_lapse(buf: Table, i: int, elapsed: float) -> None:
    """Advance the time by the duration of a reset, and observe it."""
    buf[R.TIME, i] += elapsed
    if buf[R.WATCHED, i] > 0.0:
        set_lean(buf, i)
        buf[R.MADE, i] = elapsed
        buf[R.LOW, i] = buf[R.TILT, i]
        observe(buf, i)


def slip_continues(number: int, before: int, after: int, elapsed: float) -> bool:
    """Return whether a slip continues at once in another direction, so that it has not ended."""
    return number == FRICTION and before == after and elapsed == 0.0


def count(buf: Table, i: int, number: int, before: int, after: int, elapsed: float) -> None:
    """Count impacts, starts of slip, rests and uplifts."""
    gives_way = (before == RESTING and after == SLIDING) or (before == ROLLING and after == SLIPPING)
    reverses = after in (SLIDING, SLIPPING) and before == after and not slip_continues(number, before, after, elapsed)
    if before == FLYING or number == LAST:
        buf[R.IMPACTS, i] += 1.0
    if number not in (JAM, LAST) and (gives_way or reverses):
        buf[R.SLIPS, i] += 1.0
    if after == RESTING and before != RESTING:
        buf[R.RESTS, i] += 1.0
    if before == RESTING and after != RESTING:
        buf[R.RELEASES, i] += 1.0
        if buf[R.RESTS, i] > 0.0:
            buf[R.RELEASED_FROM_REST, i] = 1.0


def set_moving(buf: Table, i: int, table: Table, pieces: Table) -> int:
    """Start the integration from the state and tilt vector in the buffer, with the previous step if there is one.

    Return as `resume` does.
    """
    x, y, tilt, t = buf[R.X, i], buf[R.Y, i], buf[R.TILT, i], buf[R.TIME, i]
    last = buf[R.LAST_AZIMUTH, i]
    if tilt > 0.0:
        here = turns_of(x, y)
        azimuth = nearest_turn(here, last)
        buf[R.TURNS, i] = azimuth - here
        if math.isnan(buf[R.FIRST_AZIMUTH, i]):
            buf[R.FIRST_AZIMUTH, i] = azimuth
    else:
        buf[R.TURNS, i] = 0.0 if math.isnan(last) else last
        buf[R.REACHED_VERTICAL, i] = 1.0
    buf[R.TRACE_AZIMUTH, i] = azimuth_now(buf, i)
    if tilt > buf[R.PEAK_TILT, i]:
        buf[R.PEAK_TILT, i] = tilt
        buf[R.PEAK_AT, i] = t
    if not moves_in_plane(buf, i):
        buf[R.THREE_DIMENSIONAL, i] = 1.0
    buf[R.ATOL_NOW, i] = buf[R.ATOL, i]
    set_rates(buf, i, t)
    buf[R.AIMED, i] = 0.0
    buf[R.REJECTED, i] = 0.0
    if buf[R.WANTED, i] <= 0.0:
        buf[R.WANTED, i] = first_step(buf, i, t)
    return resume(buf, i, table, pieces)


def stand(buf: Table, i: int, table: Table, pieces: Table) -> tuple[int, int]:
    """Stand until uplift or slip; return WAITING and the broken guard, or the final status."""
    buf[R.STANDS, i] = 1.0
    buf[R.REACHED_VERTICAL, i] = 1.0
    buf[R.WANTED, i] = 0.0
    t = buf[R.TIME, i]
    trace_stand(buf, i, table, t)
    searched, release = False, math.inf
    while True:
        while next_stop(buf, i) <= t:
            searched = searched and t < leg_end(buf, i)
            status = meet_stop(buf, i, table, pieces, next_stop(buf, i))
            if status != Status.WAITING:
                return status, BEGINS
        if held_for_good(buf, i):
            buf[R.DECIDED, i] = t
            return stand_to_the_end(buf, i, table, pieces, t), BEGINS
        # Stops within a leg do not cut the search, so that samples do not change a run.
        if not searched:
            release = next_release(buf, i, t)
            searched = True
        if math.isnan(release):
            buf[R.TIME, i] = search_end(buf, i, t)
            return Status.UNSEEN, BEGINS
        t = min(release, next_stop(buf, i))
        buf[R.TIME, i] = t
        if release <= t:
            return Status.WAITING, broken_at_release(buf, i)


def broken_at_release(buf: Table, i: int) -> int:
    """Return the guard that ends standing; by rounding it may not be broken yet."""
    guards = guards_at(buf, i, buf[R.TIME, i], row_state(buf, i, R.STATE))
    number = 0
    if guards[0] > RELEASE_MARGIN:
        number = 1
        for k in range(2, LAST):
            if guards[k] < guards[number]:
                number = k
    return number
