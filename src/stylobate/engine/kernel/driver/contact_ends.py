"""Location of the end of a kind of contact within a step."""

import math

from stylobate.engine.kernel.bound import LAST, LIMIT, R
from stylobate.engine.kernel.driver.equations import row_state
from stylobate.engine.kernel.driver.events import LIMITS
from stylobate.engine.kernel.driver.guards import guards_at
from stylobate.engine.kernel.driver.stages import dense_state
from stylobate.engine.kernel.layout import Table
from stylobate.engine.kernel.shape import GUARD_PLACES

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
    for place in range(1, GUARD_PLACES + 1):
        now = h if place == GUARD_PLACES else h * place / GUARD_PLACES
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
