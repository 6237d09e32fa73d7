"""Where within a step a kind of contact ends."""

import math

from stylobate.engine.kernel.bound import LAST, LIMIT, R
from stylobate.engine.kernel.driver.equations import row_state
from stylobate.engine.kernel.driver.guards import margins_at
from stylobate.engine.kernel.driver.stages import dense_state
from stylobate.engine.kernel.layout import Table
from stylobate.engine.kernel.shape import MARGIN_PLACES

# Two times closer than this are one [units of the larger of 1 and the time].
ROUNDING = 4e-15
# A margin counts as broken below this: what follows from it is found by other arithmetic, with roundings of its own.
BROKEN = -1e-14
# So many secants at most lead to an end before the interval is halved instead, and so many steps in all.
SECANTS, MOST_LOOKS = 20, 100
# A margin below this is all but broken.
NEARLY_BROKEN = 1e-8


def margins_within(buf: Table, i: int, elapsed: float) -> tuple[float, ...]:
    """Return the guards at a time within the step that was held back, on its dense output."""
    return margins_at(buf, i, buf[R.TIME, i] + elapsed, dense_state(buf, i, elapsed / buf[R.TRIED, i]))


def first_end(buf: Table, i: int) -> tuple[float, int]:
    """Return how long into the step that was held back a margin is first broken, and which; or −1 for none."""
    h = buf[R.TRIED, i]
    past, before = 0.0, margins_within(buf, i, 0.0)
    for place in range(1, MARGIN_PLACES + 1):
        now = h if place == MARGIN_PLACES else h * place / MARGIN_PLACES
        guards = margins_within(buf, i, now)
        first, number = math.inf, -1
        for k in range(LIMIT + 1):
            if guards[k] < BROKEN and (before[k] >= BROKEN or k != LAST):
                end = (
                    past
                    if before[k] <= BROKEN
                    else crossing_of(buf, i, k, past, now, before[k] - BROKEN, guards[k] - BROKEN)
                )
                if end < first:
                    first, number = end, k
        if number >= 0:
            return first, number
        past, before = now, guards
    return h, -1


def crossing_of(buf: Table, i: int, number: int, low: float, high: float, at_low: float, at_high: float) -> float:
    """Return a time at which a margin is broken, within rounding of where it begins to be: by the Illinois rule.

    `at_low` and `at_high` are the margin above BROKEN at both ends.
    """
    rounding = ROUNDING * max(1.0, buf[R.TIME, i] + high)
    side = 0
    for look in range(MOST_LOOKS):
        if high - low <= 2.0 * rounding:
            break
        guess = (low * at_high - high * at_low) / (at_high - at_low) if look < SECANTS else 0.5 * (low + high)
        guess = min(max(guess, low + rounding), high - rounding)
        value = margins_within(buf, i, guess)[number] - BROKEN
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
    """Return the first margin that the state breaks with which a kind of contact begins, or −1; note the last one."""
    guards = margins_at(buf, i, buf[R.TIME, i], row_state(buf, i, R.STATE))
    buf[R.LAST_MARGIN, i] = guards[LAST]
    buf[R.MARGIN_NOW, i] = guards[LAST]
    buf[R.BROKEN, i] = 0.0
    for k in range(LIMIT + 1):
        if guards[k] < BROKEN and k != LAST:
            return k
    return -1


def nearly_broken(buf: Table, i: int) -> int:
    """Return the margin next to whose end no step can be made, as where slip is all but gone, or −1."""
    guards = margins_at(buf, i, buf[R.TIME, i], row_state(buf, i, R.STATE))
    least = 0
    for k in range(1, LAST):
        if guards[k] < guards[least]:
            least = k
    return least if guards[least] < NEARLY_BROKEN else -1
