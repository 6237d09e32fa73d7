"""Start, events and changes of lanes whose model changes between kinds of contact."""

import math

import numpy as np

from stylobate.engine.dop853 import LEAST_ERROR, LEAST_FACTOR, SAFETY
from stylobate.engine.elementary import NewtonRoom, nearest_turn, turning_point, turns_of, winding
from stylobate.engine.kernel.bound import (
    CHANGES,
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
    SLIP_X,
    SLIP_Y,
    SLIPPING,
    R,
    Table,
)
from stylobate.engine.kernel.driver.equations import accelerations, held_for_good, lean_of_new, row_state
from stylobate.engine.kernel.driver.events import STATUSES_AT_LIMITS, RunStatus, TraceKind, limit_passed
from stylobate.engine.kernel.driver.guards import (
    broken_now,
    first_broken_guard,
    guards_at,
    model_project,
    model_reset,
    moves_in_plane,
    nearly_broken,
)
from stylobate.engine.kernel.driver.implicit_step import (
    MOST_ITERATIONS,
    damped_error,
    error_of_changes,
    fastest_rate,
    guess_changes,
    set_cubic,
    set_jacobian,
    solve_step,
)
from stylobate.engine.kernel.driver.motion import (
    azimuth_now,
    first_step,
    measure_peak,
    record_loss,
    set_lean,
    set_rates,
    set_state,
)
from stylobate.engine.kernel.driver.records import (
    leg_end,
    meet_stop,
    next_stop,
    observe,
    resume,
    set_next_stop,
    stand_to_the_end,
    trace_analytical_step,
    trace_entry,
    trace_part,
    trace_stand,
)
from stylobate.engine.kernel.driver.rest import RELEASE_MARGIN, next_release, search_end
from stylobate.engine.kernel.driver.stages import dense_state, set_dense, set_within, stability
from stylobate.engine.tolerances import DEPARTURE, SLIP_SHARE, SLIP_SHORTER, SLIP_TURNS


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
    if status != RunStatus.WAITING:
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
        return apply_resets(buf, i, table, pieces, number) if number >= 0 else RunStatus.STEP_TOO_SMALL
    record_peak_tilt(buf, i)
    if buf[R.PEAK, i] > 0.0:
        beyond = measure_peak(buf, i)
        if beyond > 0.0:
            return end_at_limit(buf, i, beyond)
    if buf[R.STEPS, i] >= buf[R.MOST_STEPS, i]:
        return RunStatus.STEP_LIMIT
    stiff = detect_stiffness(buf, i)
    buf[R.AIMED, i] = 0.0
    status, number = meet_reached_stop(buf, i, table, pieces)
    if status != RunStatus.WAITING:
        return status
    if number >= 0:
        return apply_resets(buf, i, table, pieces, number)
    set_next_stop(buf, i)
    return follow_implicitly(buf, i, table, pieces) if stiff else RunStatus.WAITING


def handle_held_step(buf: Table, i: int, table: Table, pieces: Table) -> int:
    """Find the broken guard in the step that was held back, and continue from there."""
    set_dense(buf, i, R.STATE, R.SLOPE, buf[R.TIME, i], buf[R.TRIED, i])
    elapsed, number = first_broken_guard(buf, i)
    if number < 0:  # only the cubics broke the guard: the step is repeated and accepted
        buf[R.H, i] = buf[R.TRIED, i]
        buf[R.AIMED, i] = 1.0
        return RunStatus.WAITING
    if number == FRICTION and slip_turns(buf, i, elapsed):
        buf[R.H, i] = SLIP_SHORTER * elapsed
        buf[R.REJECTED, i] = 1.0
        return RunStatus.WAITING
    return end_contact(buf, i, table, pieces, elapsed, number)


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
        return RunStatus.STEP_LIMIT
    return apply_resets(buf, i, table, pieces, number)


def end_at_limit(buf: Table, i: int, beyond: float) -> int:
    """End the run at the time `beyond` in the step just made, at which the tilt passes its limit."""
    set_within(buf, i, beyond)
    set_state(buf, i, row_state(buf, i, R.NEW))
    buf[R.TIME, i] += beyond - buf[R.MADE, i]
    set_lean(buf, i)
    record_peak_tilt(buf, i)
    return RunStatus.LIMIT


def meet_reached_stop(buf: Table, i: int, table: Table, pieces: Table) -> tuple[int, int]:
    """Handle a stop that a step has reached; return WAITING and the guard broken there, or the final status.

    A guard can break there because the base motion can jump; −1 means none.
    """
    t = buf[R.TIME, i]
    if t < buf[R.STOP, i]:
        return RunStatus.WAITING, -1
    jumps = t >= leg_end(buf, i)
    status = meet_stop(buf, i, table, pieces, t)
    return status, broken_now(buf, i) if jumps and status == RunStatus.WAITING else -1


# Steps between checks for stiffness, the same in runs that have been stiff, and from the start of a slip to its first
# check; number of successive steps near the stability boundary (hλ = 6) that show stiffness (one could be near it by
# chance), and the hλ that counts as near.
LOOK_EVERY, LOOK_AGAIN, LOOK_FIRST, STIFF_STEPS, NEAR_BOUNDARY = 500.0, 50.0, 20.0, 8.0, 3.0


def detect_stiffness(buf: Table, i: int) -> bool:
    """Return whether stability limits the steps of a slipping contact; check the step just made if a check is due."""
    if buf[R.STEPS, i] < buf[R.STIFF_LOOK_AT, i]:
        return False
    near = buf[R.CONTACT, i] in (SLIDING, SLIPPING) and stability(buf, i) > NEAR_BOUNDARY
    buf[R.STIFF_LOOKS, i] = buf[R.STIFF_LOOKS, i] + 1.0 if near else 0.0
    buf[R.STIFF_LOOK_AT, i] = buf[R.STEPS, i] + (1.0 if near else buf[R.STIFF_WAIT, i])
    return buf[R.STIFF_LOOKS, i] >= STIFF_STEPS


# Maximum number of contact changes at one time, and the time difference that counts as one time [units of the larger
# of 1 and the time].
MOST_AT_ONCE, ONE_MOMENT = 100, 1e-12
# Not a guard: the reset map at the start of a motion.
BEGINS = -1


def apply_resets(buf: Table, i: int, table: Table, pieces: Table, number: int) -> int:
    """Apply the reset map of a broken guard and of each guard broken after it; return WAITING or the final status."""
    while True:
        if number == FALLEN:
            return RunStatus.OVERTURNED
        if number >= LIMIT:
            return STATUSES_AT_LIMITS[number - LIMIT]
        if endless(buf, i):
            return RunStatus.ENDLESS
        apply_reset(buf, i, table, number)
        if buf[R.CONTACT, i] == JAMMED:
            return RunStatus.JAMMED
        if buf[R.CONTACT, i] == RESTING:
            status, number = stand(buf, i, table, pieces)
            if status != RunStatus.WAITING:
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
    if buf[R.CONTACT, i] in (SLIDING, SLIPPING) and buf[R.CONTACT, i] != before:
        buf[R.STIFF_LOOKS, i] = 0.0
        buf[R.STIFF_LOOK_AT, i] = buf[R.STEPS, i] + LOOK_FIRST
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
            if status != RunStatus.WAITING:
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
            return RunStatus.UNSEEN, BEGINS
        t = min(release, next_stop(buf, i))
        buf[R.TIME, i] = t
        if release <= t:
            return RunStatus.WAITING, broken_at_release(buf, i)


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


# An implicit step costs as much as explicit steps over this hλ; a shorter one does not pay. After so many such steps in
# sequence the explicit method continues, with the interval between stiffness checks of a run that has not been stiff.
PAYS, MOST_UNPAID = 40.0, 5
# Maximum number of implicit steps in one call, so that other lanes and a halt signal are served.
STRETCH = 1000
# Largest ratio of successive implicit steps, as in RADAU5 of Hairer and Wanner, and the ratio after a failed solution.
LARGEST_IMPLICIT_FACTOR, UNSOLVED_FACTOR = 8.0, 0.5


def follow_implicitly(buf: Table, i: int, table: Table, pieces: Table) -> int:
    """Make implicit steps while they pay; return the final status if the run ends, else WAITING."""
    room = NewtonRoom(
        change=np.zeros(CHANGES),
        correction=np.zeros(CHANGES),
        jacobian=np.zeros((ORDER, ORDER)),
        coupled=np.zeros(ORDER),
        single=np.zeros((ORDER, ORDER)),
        single_pivots=np.zeros(ORDER),
        double=np.zeros((2 * ORDER, 2 * ORDER)),
        double_pivots=np.zeros(2 * ORDER),
        real=np.zeros(ORDER),
        turned=np.zeros(2 * ORDER),
    )
    buf[R.STIFF_LOOKS, i] = 0.0
    buf[R.STIFF_WAIT, i] = LOOK_AGAIN
    set_rates(buf, i, buf[R.TIME, i])  # in lanes they have other roundings, which differences would show
    before, unpaid, coupled, rate, begins, pays = 0.0, 0, 0, 0.0, True, True
    for _ in range(STRETCH):
        if begins:
            coupled = set_jacobian(buf, i, coupled, room)
            rate = fastest_rate(coupled, room)
        h = attempt(buf, i, before, rate, coupled, room)
        unpaid = 0 if h * rate > PAYS else unpaid + 1
        pays = h > 0.0 and unpaid <= MOST_UNPAID
        if not pays:
            break
        elapsed, number = first_broken_guard(buf, i)
        begins = number != FRICTION or not slip_turns(buf, i, elapsed)
        if not begins:  # repeated with a shorter step
            buf[R.WANTED, i] = SLIP_SHORTER * elapsed
            before = 0.0
            continue
        if number >= 0:
            return end_contact(buf, i, table, pieces, elapsed, number)
        before = h
        status, number = take_step(buf, i, table, pieces)
        if status != RunStatus.WAITING:
            return status
        if number >= 0:
            return apply_resets(buf, i, table, pieces, number)
    return go_on_explicitly(buf, i, table, pieces, rate, pays=pays)


def attempt(buf: Table, i: int, before: float, rate: float, coupled: int, room: NewtonRoom) -> float:
    """Compute a step whose error is acceptable; return its length, or 0 if no step pays.

    `before` is the length of the step whose dense output is stored, or 0; `rate` is the fastest rate of the equations,
    and `coupled` the number of coupled states.
    """
    h = min(buf[R.WANTED, i], buf[R.LONGEST_STEP, i], buf[R.STOP, i] - buf[R.TIME, i])
    slopes = row_state(buf, i, R.SLOPE)
    rejected = False
    while True:
        guess_changes(buf, i, h / before if before > 0.0 else 0.0, room.change)
        iterations = solve_step(buf, i, h, coupled, room)
        error = error_of_changes(buf, i, h, slopes, coupled, room) if iterations > 0 else math.inf
        if rejected and 1.0 < error < math.inf:
            error = damped_error(buf, i, h, coupled, room)
        factor = factor_of(error, iterations)
        if error <= 1.0:
            break
        h *= factor
        rejected = True
        if not h * rate > NEAR_BOUNDARY:
            return 0.0
    buf[R.WANTED, i] = h * (min(factor, 1.0) if rejected else factor)
    buf[R.TRIED, i] = h
    set_cubic(buf, i, room.change)
    return h


def factor_of(error: float, iterations: int) -> float:
    """Return the ratio of the next step to one with this error in tolerances."""
    if not error < math.inf:
        return UNSOLVED_FACTOR
    safety = SAFETY * (2 * MOST_ITERATIONS + 1) / (2 * MOST_ITERATIONS + iterations)
    return min(max(safety / math.sqrt(math.sqrt(max(error, LEAST_ERROR))), LEAST_FACTOR), LARGEST_IMPLICIT_FACTOR)


def take_step(buf: Table, i: int, table: Table, pieces: Table) -> tuple[int, int]:
    """Accept the computed step; return WAITING and the guard broken at its end, or −1, or the final status."""
    h, stop = buf[R.TRIED, i], buf[R.STOP, i]
    reached = h >= stop - buf[R.TIME, i]
    beyond = step_to(buf, i, table, h)
    if beyond > 0.0:
        return end_at_limit(buf, i, beyond), -1
    if reached:
        buf[R.TIME, i] = stop
    set_state(buf, i, model_project(buf, i))
    set_rates(buf, i, buf[R.TIME, i])
    if buf[R.STEPS, i] >= buf[R.MOST_STEPS, i]:
        return RunStatus.STEP_LIMIT, -1
    return meet_reached_stop(buf, i, table, pieces)


def go_on_explicitly(buf: Table, i: int, table: Table, pieces: Table, rate: float, *, pays: bool) -> int:
    """Return the lane to explicit steps; check for stiffness soon if implicit steps paid, else later."""
    buf[R.STIFF_LOOK_AT, i] = buf[R.STEPS, i] + (1.0 if pays else LOOK_EVERY)
    buf[R.REJECTED, i] = 0.0
    buf[R.AIMED, i] = 0.0
    if 0.0 < rate < math.inf:
        buf[R.WANTED, i] = min(buf[R.WANTED, i], NEAR_BOUNDARY / rate)
    number = broken_now(buf, i)
    if number >= 0:
        return apply_resets(buf, i, table, pieces, number)
    set_next_stop(buf, i)
    return RunStatus.WAITING
