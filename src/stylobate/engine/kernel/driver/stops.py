"""Stops of a lane: looks in the last periods, samples, stroboscopic samples, and legs of the base motion."""

import math

from stylobate.engine.elementary import length
from stylobate.engine.kernel.bound import BREAKS_AT, DEGREE, PLANAR, R
from stylobate.engine.kernel.columns import LOOKS, NOTE, SLACK, Status, Window
from stylobate.engine.kernel.driver.base_motion import continues_in_next_piece, set_leg
from stylobate.engine.kernel.driver.guards import record_window
from stylobate.engine.kernel.driver.moving import azimuth_now, set_rates
from stylobate.engine.kernel.driver.standing_loads import record_standing_loads
from stylobate.engine.kernel.layout import Table


def look_count(buf: Table, i: int) -> float:
    """Return the index of the last look: of two windows and one period, else of one window and one period, or −1."""
    end, period, periods = buf[R.END, i], buf[R.PERIOD, i], buf[R.PERIODS, i]
    end *= 1.0 + SLACK
    if period <= 0.0 or end < (periods + 1) * period:
        return -1.0
    return LOOKS * (2 * periods + 1 if end >= (2 * periods + 1) * period else periods + 1)


def set_look(buf: Table, i: int) -> None:
    """Set the time of the next look."""
    last, index = look_count(buf, i), buf[R.NEXT_LOOK, i]
    buf[R.LOOKS_AT, i] = math.inf
    if index <= last:
        buf[R.LOOKS_AT, i] = buf[R.END, i] - (last - index) * (buf[R.PERIOD, i] / LOOKS)


def set_sample(buf: Table, i: int) -> None:
    """Set the time of the next sample."""
    index, end, samples = buf[R.NEXT_SAMPLE, i], buf[R.END, i], buf[R.SAMPLES, i]
    buf[R.SAMPLES_AT, i] = math.inf
    if index < samples:
        buf[R.SAMPLES_AT, i] = end if index == samples - 1 else index * (end / (samples - 1))


def set_strobe(buf: Table, i: int) -> None:
    """Set the time of the next stroboscopic sample; the last ones before the end are recorded."""
    buf[R.STROBES_AT, i] = math.inf
    period, end, strobes = buf[R.PERIOD, i], buf[R.END, i], buf[R.STROBES, i]
    if buf[R.NEXT_STROBE, i] >= strobes or period <= 0.0:
        return
    last = math.floor((end * (1.0 + SLACK) - buf[R.STROBE, i]) / period)
    # Columns of samples before the start of the run remain empty.
    buf[R.NEXT_STROBE, i] = max(buf[R.NEXT_STROBE, i], strobes - 1.0 - last)
    if buf[R.NEXT_STROBE, i] < strobes:
        number = last + 1.0 - strobes + buf[R.NEXT_STROBE, i]
        buf[R.STROBES_AT, i] = min(buf[R.STROBE, i] + number * period, end)


def set_break(buf: Table, i: int, table: Table) -> None:
    index = int(buf[R.NEXT_BREAK, i])
    buf[R.BREAKS_AT, i] = math.inf
    if index < buf[R.BREAKS, i]:
        buf[R.BREAKS_AT, i] = table[int(buf[R.RUN, i]), BREAKS_AT + index]


def leg_end(buf: Table, i: int) -> float:
    """Return the end of the present leg of the base motion."""
    return min(buf[R.END, i], buf[R.LIFTS_AT, i], buf[R.LEG_ENDS, i], buf[R.BREAKS_AT, i])


def next_stop(buf: Table, i: int) -> float:
    return min(leg_end(buf, i), buf[R.LOOKS_AT, i], buf[R.SAMPLES_AT, i], buf[R.STROBES_AT, i])


def set_next_stop(buf: Table, i: int) -> None:
    """Set the next stop, and limit the next step to it."""
    within = min(buf[R.LOOKS_AT, i], buf[R.SAMPLES_AT, i], buf[R.STROBES_AT, i])
    buf[R.OTHER_STOP, i] = min(buf[R.END, i], buf[R.LIFTS_AT, i], buf[R.BREAKS_AT, i], within)
    limit_step(buf, i)


def limit_step(buf: Table, i: int) -> None:
    stop = min(buf[R.LEG_ENDS, i], buf[R.OTHER_STOP, i])
    buf[R.STOP, i] = stop
    buf[R.H, i] = min(buf[R.WANTED, i], stop - buf[R.TIME, i])


def passes_knot(buf: Table, i: int, table: Table, pieces: Table) -> bool:
    """Continue with the next piece of the base motion if that is the only task of this stop; return whether it is."""
    # A flag of 1 with a stop reached has no other cause.
    if DEGREE < 0 or buf[R.FLAG, i] != 1.0 or buf[R.REACHED, i] != 1.0 or buf[R.RUN, i] < 0.0:
        return False
    t = buf[R.TIME, i]
    if t != buf[R.LEG_ENDS, i] or t >= buf[R.OTHER_STOP, i] or not continues_in_next_piece(buf, i, table, pieces):
        return False
    buf[R.FLAG, i] = 0.0
    limit_step(buf, i)
    return True


def meet_stop(buf: Table, i: int, table: Table, pieces: Table, t: float) -> int:
    """Handle the stop at `t`; return the final status if the run ends there, else WAITING."""
    while buf[R.LOOKS_AT, i] <= t:
        take_look(buf, i, t)
        buf[R.NEXT_LOOK, i] += 1.0
        set_look(buf, i)
    while buf[R.SAMPLES_AT, i] <= t:
        record_lean(buf, i, table, t, int(buf[R.NEXT_SAMPLE, i]))
        buf[R.NEXT_SAMPLE, i] += 1.0
        set_sample(buf, i)
    while buf[R.STROBES_AT, i] <= t:
        record_lean(buf, i, table, t, int(buf[R.SAMPLES, i] + buf[R.NEXT_STROBE, i]))
        buf[R.NEXT_STROBE, i] += 1.0
        set_strobe(buf, i)
    if t >= buf[R.LIFTS_AT, i]:
        return Status.LIFTED
    if t >= buf[R.END, i]:
        return Status.STOPPED
    if t >= buf[R.LEG_ENDS, i] or t >= buf[R.BREAKS_AT, i]:
        while buf[R.BREAKS_AT, i] <= t:
            buf[R.NEXT_BREAK, i] += 1.0
            set_break(buf, i, table)
        set_leg(buf, i, table, pieces, t)
        if buf[R.STANDS, i] == 0.0:
            set_rates(buf, i, t)
    return Status.WAITING


def resume(buf: Table, i: int, table: Table, pieces: Table) -> int:
    """Continue after an event, which may be beyond a stop by rounding; return as `meet_stop` does."""
    while next_stop(buf, i) <= buf[R.TIME, i]:
        status = meet_stop(buf, i, table, pieces, next_stop(buf, i))
        if status != Status.WAITING:
            return status
    set_next_stop(buf, i)
    return Status.WAITING


def stand_to_the_end(buf: Table, i: int, table: Table, pieces: Table, t: float) -> int:
    """Complete the record of a run that stands to its end, with the contact loads of the remaining legs."""
    while t < buf[R.END, i]:
        leg_ends = leg_end(buf, i)
        t = next_stop(buf, i)
        meet_stop(buf, i, table, pieces, t)
        if t >= leg_ends:
            record_standing_loads(buf, i, t, leg_end(buf, i))
    buf[R.TIME, i] = t
    return Status.RESTED


def lean_now(buf: Table, i: int) -> tuple[float, float, float, float]:
    if buf[R.STANDS, i] > 0.0:
        return 0.0, 0.0, 0.0, 0.0
    return buf[R.X, i], buf[R.Y, i], buf[R.VX, i], buf[R.VY, i]


def record_lean(buf: Table, i: int, table: Table, t: float, index: int) -> None:
    """Record the tilt vector as the sample of this index; stroboscopic samples follow the samples."""
    x, y, vx, vy = lean_now(buf, i)
    if PLANAR:
        ux, uy = buf[R.LINE_X, i], buf[R.LINE_Y, i]
        x, y, vx, vy = x * ux, x * uy, vx * ux, vx * uy
    run = int(buf[R.RUN, i])
    column = BREAKS_AT + int(buf[R.BREAKS, i]) + NOTE * index
    table[run, column] = x
    table[run, column + 1] = y
    table[run, column + 2] = vx
    table[run, column + 3] = vy
    table[run, column + 4] = t


def take_look(buf: Table, i: int, t: float) -> None:
    """Record the tilt vector at one of the looks in the last periods, and its change within one period."""
    index, last, span = int(buf[R.NEXT_LOOK, i]), int(look_count(buf, i)), int(buf[R.PERIODS, i]) * LOOKS
    x, y, vx, vy = lean_now(buf, i)
    azimuth = azimuth_now(buf, i)
    place = R.LOOK + 4 * (index % LOOKS)
    change = length(x - buf[place, i], y - buf[place + 1, i])
    rate_change = length(vx - buf[place + 2, i], vy - buf[place + 3, i])
    buf[place, i] = x
    buf[place + 1, i] = y
    buf[place + 2, i] = vx
    buf[place + 3, i] = vy
    middle = last - span
    for late in range(2):
        first = R.LATE if late == 1 else R.BEFORE
        begin = middle if late == 1 else middle - span
        end = begin + span
        if begin < LOOKS or index < begin or index > end:
            continue
        if index == begin:
            buf[first + Window.FIRST_AZIMUTH, i] = azimuth
        buf[first + Window.LAST_AZIMUTH, i] = azimuth
        for column, value in (
            (Window.TILT_CHANGE, change),
            (Window.RATE_CHANGE, rate_change),
            (Window.TILT_SIZE, length(x, y)),
            (Window.RATE_SIZE, length(vx, vy)),
        ):
            buf[first + column, i] = max(buf[first + column, i], value)
        weight = 0.5 if index in (begin, end) else 1.0
        forced = t / buf[R.PERIOD, i]
        buf[first + Window.LAG_FORWARD, i] += weight * (azimuth - forced)
        buf[first + Window.LAG_BACKWARD, i] += weight * (azimuth + forced)
    if index == middle:
        buf[R.WATCHED, i] = 1.0
        buf[R.LATE_MINIMUM_TILT, i] = length(x, y)
        record_window(buf, i, t)
