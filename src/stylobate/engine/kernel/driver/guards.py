"""The guards of a kind of contact, and how the model goes on from one that is broken."""

import math

from stylobate.compiler.marks import fast, flat, lanes
from stylobate.engine.dop853 import STAGES
from stylobate.engine.kernel.bound import (
    FLYING,
    GUARDS,
    ORDER,
    ROLLING,
    SLIDING,
    SLIPPING,
    SWITCHING,
    WIDTH,
    WINDOW_ENDS,
    R,
    guards,
    project,
    reset_map,
)
from stylobate.engine.kernel.driver.equations import State, lean_of, numbers, row_state
from stylobate.engine.kernel.driver.push import Accelerations, accelerations
from stylobate.engine.kernel.layout import Table
from stylobate.engine.kernel.shape import MARGIN_PLACES

PLACES = tuple(range(1, MARGIN_PLACES + 1))


def guards_under(buf: Table, i: int, state: State, push: Accelerations) -> tuple[float, ...]:
    """Return the model's guards of a state, under these accelerations."""
    return guards(*state, *push, buf[R.REST_ENERGY, i], *numbers(buf, i))


def limit_margin(buf: Table, i: int, state: State) -> float:
    """Return how far the tilt of a state is below its limit."""
    x, y, _, _ = lean_of(buf, i, state)
    return buf[R.TILT_LIMIT, i] - math.sqrt(x * x + y * y)


def margins_at(buf: Table, i: int, t: float, state: State) -> tuple[float, ...]:
    """Return the guards, and behind them that of the tilt limit."""
    return *guards_under(buf, i, state, accelerations(buf, i, t)), limit_margin(buf, i, state)


def model_react(
    buf: Table, i: int, number: float, now: Accelerations, later: Accelerations, ahead: float
) -> tuple[float, State]:
    """Return elapsed time and state behind a broken margin."""
    state = row_state(buf, i, R.STATE)
    elapsed, after = reset_map(*state, number, *now, *later, ahead, buf[R.REST_ENERGY, i], *numbers(buf, i))
    return elapsed, tuple(after[j] for j in range(ORDER))


def model_project(buf: Table, i: int) -> State:
    return project(*row_state(buf, i, R.STATE), *numbers(buf, i))


def note_window(buf: Table, i: int, t: float) -> None:
    """Note how the column is as the last periods begin, of a model that changes between kinds of contact."""
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
def look_at_guards(buf: Table) -> None:
    """Mark the lanes in which a guard is broken within the step, on cubics through its ends."""
    for place in PLACES:
        look_at_guards_within(buf, place / MARGIN_PLACES)


@fast
def look_at_guards_within(buf: Table, share: float) -> None:
    """Look at the guards at a part of the step."""
    block = flat(buf)
    rest = 1.0 - share
    of_start, of_end = rest * rest * (1.0 + 2.0 * share), share * share * (3.0 - 2.0 * share)
    for n in lanes(ORDER * WIDTH):
        end = block[R.NEW * WIDTH + n]
        if share == 1.0:
            block[R.STAGE * WIDTH + n] = of_end * end
        else:
            change = share * rest * rest * block[R.SLOPE * WIDTH + n]
            change = change + -share * share * rest * block[(R.SLOPE + STAGES * ORDER) * WIDTH + n]
            value = of_start * block[R.STATE * WIDTH + n] + of_end * end
            block[R.STAGE * WIDTH + n] = value + block[R.STEP * WIDTH + n] * change
    guard(buf, share)


@fast
def guard(buf: Table, share: float) -> None:
    """Mark the lanes in which a guard is broken, or the tilt beyond its limit, at a part of the step."""
    for i in lanes(WIDTH):
        state = row_state(buf, i, R.STAGE)
        margins = guards_under(buf, i, state, accelerations(buf, i, buf[R.TIME, i] + share * buf[R.H, i]))
        least = limit_margin(buf, i, state)
        for k in range(GUARDS - 1):
            least = min(least, margins[k])
        # The last one counts only where it was above before.
        last, before = margins[GUARDS - 1], buf[R.MARGIN_NOW, i]
        buf[R.MARGIN_NOW, i] = last
        crossed = (1.0 if last < 0.0 else 0.0) * (0.0 if before < 0.0 else 1.0)
        buf[R.BROKEN, i] = max(buf[R.BROKEN, i], crossed, 1.0 if least < 0.0 else 0.0)


@fast
def bring_up_to_date(buf: Table) -> None:
    """Bring up to date what a state keeps from step to step, where one was made."""
    for i in lanes(WIDTH):
        go = buf[R.GO, i]
        projected = model_project(buf, i)
        for j in range(ORDER):
            old = buf[R.STATE + j, i]
            buf[R.STATE + j, i] = projected[j] if go > 0.0 else old
        now, old = buf[R.MARGIN_NOW, i], buf[R.LAST_MARGIN, i]
        kept = now if go > 0.0 else old
        buf[R.LAST_MARGIN, i] = kept
        buf[R.MARGIN_NOW, i] = kept
        buf[R.BROKEN, i] = 0.0
