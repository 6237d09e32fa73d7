"""Records of the tilt vector: samples, and the looks and pairs that decide the outcome under a periodic base motion."""

import math

from stylobate.engine.elementary import length
from stylobate.engine.kernel.bound import BREAKS_AT, PLANAR, SWITCHING, WINDOW_ENDS, R
from stylobate.engine.kernel.columns import EARLIER, LAGS, NOTE, PAIRS, SLACK, Pair, pair_begins
from stylobate.engine.kernel.driver.guards import record_window
from stylobate.engine.kernel.driver.moving import azimuth_now
from stylobate.engine.kernel.layout import Table


def lean_now(buf: Table, i: int) -> tuple[float, float, float, float]:
    if buf[R.STANDS, i] > 0.0:
        return 0.0, 0.0, 0.0, 0.0
    return buf[R.X, i], buf[R.Y, i], buf[R.VX, i], buf[R.VY, i]


def record_lean(buf: Table, i: int, table: Table, index: int, last: float) -> None:
    """Record the tilt vector as the note of this index: samples, then stroboscopic samples, looks and pairs."""
    x, y, vx, vy = lean_now(buf, i)
    if PLANAR:
        ux, uy = buf[R.LINE_X, i], buf[R.LINE_Y, i]
        x, y, vx, vy = x * ux, x * uy, vx * ux, vx * uy
    run = int(buf[R.RUN, i])
    column = note_column(buf, i, index)
    table[run, column] = x
    table[run, column + 1] = y
    table[run, column + 2] = vx
    table[run, column + 3] = vy
    table[run, column + 4] = last


def record_place(buf: Table, i: int, table: Table, strobe: int) -> None:
    """Record the footprint and twist at a stroboscopic sample, for a model that changes between contacts.

    These notes follow all others, one for each stroboscopic sample.
    """
    if SWITCHING:
        run = int(buf[R.RUN, i])
        column = note_column(buf, i, int(buf[R.NOTES, i] - buf[R.STROBES, i]) + strobe)
        x, y, twist = WINDOW_ENDS
        table[run, column] = buf[R.STATE + x, i]
        table[run, column + 1] = buf[R.STATE + y, i]
        table[run, column + 2] = buf[R.STATE + twist, i]


def note_column(buf: Table, i: int, index: int) -> int:
    """Return the first column of a note."""
    return BREAKS_AT + int(buf[R.BREAKS, i]) + NOTE * index


def first_look(buf: Table, i: int) -> int:
    """Return the index of the first look among the notes."""
    return int(buf[R.SAMPLES, i] + buf[R.STROBES, i])


def set_look(buf: Table, i: int) -> None:
    """Set the time of the next look: in the earlier group, or in the last periods."""
    end, period, index = buf[R.END, i], buf[R.PERIOD, i], buf[R.NEXT_LOOK, i]
    buf[R.LOOKS_AT, i] = math.inf
    if buf[R.LOOKS, i] == 0.0 or period <= 0.0:
        return
    held, last = math.floor(end * (1.0 + SLACK) / period), buf[R.LOOKS, i] - 1.0
    if held < buf[R.PERIODS, i] + 1.0:
        return
    if buf[R.LOOKED_BACK, i] == 0.0:
        index = max(index, float(EARLIER))
    if index >= EARLIER:  # looks before the start of the run are left out
        index = max(index, last - held)
    buf[R.NEXT_LOOK, i] = index
    if index <= last:
        periods = last - index if index >= EARLIER else buf[R.LOOKED_BACK, i] + (EARLIER - 1.0 - index)
        buf[R.LOOKS_AT, i] = end - periods * period


def take_look(buf: Table, i: int, table: Table, t: float) -> None:
    """Record a look; the observation of the last periods begins with one of them."""
    index = int(buf[R.NEXT_LOOK, i])
    record_lean(buf, i, table, first_look(buf, i) + index, azimuth_now(buf, i))
    if index == EARLIER + LAGS:
        x, y, _, _ = lean_now(buf, i)
        buf[R.WATCHED, i] = 1.0
        buf[R.LATE_MINIMUM_TILT, i] = length(x, y)
        record_window(buf, i, t)


def set_pair(buf: Table, i: int) -> None:
    """Set the time of the next state of a pair; pairs that would begin before the run are left out."""
    period, spacing = buf[R.PERIOD, i], buf[R.PAIR_SPACING, i]
    buf[R.PAIRS_AT, i] = math.inf
    if spacing == 0.0:
        return
    held, index = buf[R.END, i] / period, buf[R.NEXT_PAIR, i]
    while pair_begins(0.5 * index, spacing) > held:
        index += 2.0
    buf[R.NEXT_PAIR, i] = index
    if index < 2 * PAIRS:
        pair = math.floor(0.5 * index)
        periods = pair_begins(pair, spacing) - (0.0 if index == 2.0 * pair else 1.0)
        buf[R.PAIRS_AT, i] = buf[R.END, i] - periods * period


def take_pair(buf: Table, i: int, table: Table) -> None:
    """Record the first state of a pair, or compare it with the second one."""
    index, run = int(buf[R.NEXT_PAIR, i]), int(buf[R.RUN, i])
    note = first_look(buf, i) + int(buf[R.LOOKS, i]) + index // 2
    column = note_column(buf, i, note)
    if index % 2 == 0:
        record_lean(buf, i, table, note, azimuth_now(buf, i))
    else:
        x0, y0, vx0, vy0 = table[run, column], table[run, column + 1], table[run, column + 2], table[run, column + 3]
        record_lean(buf, i, table, note, table[run, column + Pair.AZIMUTH])
        x, y, vx, vy = table[run, column], table[run, column + 1], table[run, column + 2], table[run, column + 3]
        table[run, column + Pair.TILT_CHANGE] = length(x - x0, y - y0)
        table[run, column + Pair.RATE_CHANGE] = length(vx - vx0, vy - vy0)
        table[run, column + Pair.TILT] = length(x, y)
        table[run, column + Pair.RATE] = length(vx, vy)
