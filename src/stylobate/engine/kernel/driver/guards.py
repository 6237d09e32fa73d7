"""Guards and reset maps of models that change between kinds of contact, and the end of a contact within a step."""

import math

import numpy as np

from stylobate.compiler.marks import fast, lanes
from stylobate.engine.dop853 import STAGES, C
from stylobate.engine.kernel.bound import (
    FLYING,
    GROUP_KINDS,
    LAST,
    LIMIT,
    ORDER,
    ROLLING,
    SLIDING,
    SLIP_X,
    SLIPPING,
    SPIN,
    SWITCHING,
    WIDTH,
    WINDOW_ENDS,
    R,
    Table,
    project,
    reset_map,
)
from stylobate.engine.kernel.driver.equations import (
    Accelerations,
    State,
    accelerations,
    guards_under,
    lean_of,
    numbers,
    row_state,
)
from stylobate.engine.kernel.driver.events import LIMITS, lean, margins_of_limits
from stylobate.engine.kernel.driver.stages import GUARD_STAGES, dense_state

PLACES = np.array([1.0 if stage == STAGES else C[stage] for stage in GUARD_STAGES])
"""Fractions of a step at which its guards are evaluated."""
# First states of the tilt vector and of its rate.
TILT, TILT_RATE = 0, 2


def guards_at(buf: Table, i: int, t: float, state: State) -> tuple[float, ...]:
    """Return the guards of the model, followed by the margins of the limits."""
    guards = guards_under(buf, i, state, accelerations(buf, i, t))
    return *guards, *margins_of_limits(buf, i, lean(*lean_of(buf, i, state)))


def model_reset(
    buf: Table, i: int, number: float, now: Accelerations, later: Accelerations, ahead: float
) -> tuple[float, State]:
    """Return the duration and the final state of the reset map of a broken guard."""
    state = row_state(buf, i, R.STATE)
    elapsed, after = reset_map(*state, number, *now, *later, ahead, buf[R.REST_ENERGY, i], *numbers(buf, i))
    for j in range(ORDER):
        buf[R.NEW + j, i] = after[j]
    if moves_in_plane(buf, i):
        keep_in_plane(buf, i)
    return elapsed, row_state(buf, i, R.NEW)


def moves_in_plane(buf: Table, i: int) -> bool:
    """Return whether initial state and base motion lie in one vertical plane, which symmetry does not let go."""
    return buf[R.LINE_X, i] != 0.0 or buf[R.LINE_Y, i] != 0.0


def keep_in_plane(buf: Table, i: int) -> None:
    """Remove the rounding errors out of the plane of the motion from the new state, because they grow."""
    ux, uy = buf[R.LINE_X, i], buf[R.LINE_Y, i]
    for j in (TILT, TILT_RATE, SLIP_X):
        along = buf[R.NEW + j, i] * ux + buf[R.NEW + j + 1, i] * uy
        buf[R.NEW + j, i] = along * ux
        buf[R.NEW + j + 1, i] = along * uy
    buf[R.NEW + SPIN, i] = 0.0


def model_project(buf: Table, i: int) -> State:
    return project(*row_state(buf, i, R.STATE), *numbers(buf, i))


def record_window(buf: Table, i: int, t: float) -> None:
    """Record the state of the column at the start of the last periods, for a model that changes between contacts."""
    if SWITCHING:
        kind, present = buf[R.CONTACT, i], t - buf[R.SINCE, i]
        buf[R.WINDOW_AT, i] = t
        x, y, twist = WINDOW_ENDS
        buf[R.WINDOW_X, i] = buf[R.STATE + x, i]
        buf[R.WINDOW_Y, i] = buf[R.STATE + y, i]
        buf[R.WINDOW_TWIST, i] = buf[R.STATE + twist, i]
        buf[R.WINDOW_SLIDING, i] = buf[R.TIME_SLIDING, i] + (present if kind == SLIDING else 0.0)
        rolls = buf[R.TIME_ROLLING, i] + (present if kind == ROLLING else 0.0)
        buf[R.WINDOW_RIM, i] = rolls + (buf[R.TIME_SLIPPING, i] + (present if kind == SLIPPING else 0.0))
        buf[R.WINDOW_FLYING, i] = buf[R.TIME_FLYING, i] + (present if kind == FLYING else 0.0)


# Within a step, in all lanes


@fast
def project_states(buf: Table, group: int) -> None:
    """Apply the projection of the model to the states of lanes whose step was accepted; none if all roll."""
    for i in lanes(WIDTH):
        go = buf[R.GO, i]
        if GROUP_KINDS[group] != ROLLING:
            projected = model_project(buf, i)
            for j in range(ORDER):
                old = buf[R.STATE + j, i]
                buf[R.STATE + j, i] = projected[j] if go > 0.0 else old
        now, old = buf[R.GUARD_NOW, i], buf[R.LAST_GUARD, i]
        kept = now if go > 0.0 else old
        buf[R.LAST_GUARD, i] = kept
        buf[R.GUARD_NOW, i] = kept
        buf[R.BROKEN, i] = 0.0


# Times closer than this are equal [units of the larger of 1 and the time].
ROUNDING = 4e-15
# A guard counts as broken below this value, because reset maps have their own rounding errors.
LEAST_MARGIN = -1e-14
# Maximum number of secant steps before bisection, and of all steps.
SECANTS, MOST_LOOKS = 20, 100
# A guard below this value is nearly broken.
NEARLY_BROKEN = 1e-8


def guards_within(buf: Table, i: int, elapsed: float) -> tuple[float, ...]:
    """Return the guards at a time within the step that was held back, from its dense output."""
    return guards_at(buf, i, buf[R.TIME, i] + elapsed, dense_state(buf, i, elapsed / buf[R.TRIED, i]))


def first_broken_guard(buf: Table, i: int) -> tuple[float, int]:
    """Return the time into the step held back at which a guard first breaks, and its index; −1 for none."""
    h = buf[R.TRIED, i]
    past, before = 0.0, guards_within(buf, i, 0.0)
    for place in range(len(PLACES)):
        now = PLACES[place] * h
        guards = guards_within(buf, i, now)
        first, number = math.inf, -1
        for k in range(LIMIT + len(LIMITS)):
            if guards[k] < LEAST_MARGIN and (before[k] >= LEAST_MARGIN or k != LAST):
                end = (
                    past
                    if before[k] <= LEAST_MARGIN
                    else crossing_of(buf, i, k, past, now, before[k] - LEAST_MARGIN, guards[k] - LEAST_MARGIN)
                )
                if end < first:
                    first, number = end, k
        if number >= 0:
            return first, number
        past, before = now, guards
    return h, -1


def crossing_of(buf: Table, i: int, number: int, low: float, high: float, at_low: float, at_high: float) -> float:
    """Return the earliest time, up to rounding, at which a guard is broken, by the Illinois method.

    `at_low` and `at_high` are the guard minus LEAST_MARGIN at both ends.
    """
    rounding = ROUNDING * max(1.0, buf[R.TIME, i] + high)
    side = 0
    for look in range(MOST_LOOKS):
        if high - low <= 2.0 * rounding:
            break
        guess = (low * at_high - high * at_low) / (at_high - at_low) if look < SECANTS else 0.5 * (low + high)
        guess = min(max(guess, low + rounding), high - rounding)
        value = guards_within(buf, i, guess)[number] - LEAST_MARGIN
        if value < 0.0:
            high, at_high = guess, value
            at_low = 0.5 * at_low if side < 0 else at_low
            side = -1
        else:
            low, at_low = guess, value
            at_high = 0.5 * at_high if side > 0 else at_high
            side = 1
    return high


def broken_now(buf: Table, i: int) -> int:
    """Return the first guard that is broken at the start of a kind of contact, or −1; store the last guard."""
    guards = guards_at(buf, i, buf[R.TIME, i], row_state(buf, i, R.STATE))
    buf[R.LAST_GUARD, i] = guards[LAST]
    buf[R.GUARD_NOW, i] = guards[LAST]
    buf[R.BROKEN, i] = 0.0
    for k in range(LIMIT + len(LIMITS)):
        if guards[k] < LEAST_MARGIN and k != LAST:
            return k
    return -1


def nearly_broken(buf: Table, i: int) -> int:
    """Return the guard that is too close to zero for any step, as when slip has nearly ended, or −1."""
    guards = guards_at(buf, i, buf[R.TIME, i], row_state(buf, i, R.STATE))
    least = 0
    for k in range(1, LAST):
        if guards[k] < guards[least]:
            least = k
    return least if guards[least] < NEARLY_BROKEN else -1
