"""Stops of a lane: looks, pairs, samples, stroboscopic samples, and legs of the base motion."""

import math

from stylobate.engine.kernel.bound import BREAKS_AT, DEGREE, R
from stylobate.engine.kernel.columns import SLACK
from stylobate.engine.kernel.driver.base_motion import continues_in_next_piece, set_leg
from stylobate.engine.kernel.driver.events import Status
from stylobate.engine.kernel.driver.looks import record_lean, record_place, set_look, set_pair, take_look, take_pair
from stylobate.engine.kernel.driver.moving import set_rates
from stylobate.engine.kernel.driver.standing_loads import record_standing_loads
from stylobate.engine.kernel.layout import Table


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


def stop_within(buf: Table, i: int) -> float:
    """Return the next time at which the state is recorded."""
    return min(buf[R.LOOKS_AT, i], buf[R.PAIRS_AT, i], buf[R.SAMPLES_AT, i], buf[R.STROBES_AT, i])


def next_stop(buf: Table, i: int) -> float:
    return min(leg_end(buf, i), stop_within(buf, i))


def set_next_stop(buf: Table, i: int) -> None:
    """Set the next stop, and limit the next step to it."""
    buf[R.OTHER_STOP, i] = min(buf[R.END, i], buf[R.LIFTS_AT, i], buf[R.BREAKS_AT, i], stop_within(buf, i))
    limit_step(buf, i)


def limit_step(buf: Table, i: int) -> None:
    stop = min(buf[R.LEG_ENDS, i], buf[R.OTHER_STOP, i])
    buf[R.STOP, i] = stop
    buf[R.H, i] = min(buf[R.WANTED, i], stop - buf[R.TIME, i])


def passes_knot(buf: Table, i: int, table: Table, pieces: Table) -> bool:
    """Continue with the next piece of the base motion if that is the only task of this stop; return whether it is."""
    only_stop = buf[R.FLAG, i] == 1.0 and buf[R.REACHED, i] == 1.0
    if DEGREE < 0 or not only_stop or buf[R.RUN, i] < 0.0:
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
        take_look(buf, i, table, t)
        buf[R.NEXT_LOOK, i] += 1.0
        set_look(buf, i)
    while buf[R.PAIRS_AT, i] <= t:
        take_pair(buf, i, table)
        buf[R.NEXT_PAIR, i] += 1.0
        set_pair(buf, i)
    while buf[R.SAMPLES_AT, i] <= t:
        record_lean(buf, i, table, int(buf[R.NEXT_SAMPLE, i]), t)
        buf[R.NEXT_SAMPLE, i] += 1.0
        set_sample(buf, i)
    while buf[R.STROBES_AT, i] <= t:
        record_lean(buf, i, table, int(buf[R.SAMPLES, i] + buf[R.NEXT_STROBE, i]), t)
        record_place(buf, i, table, int(buf[R.NEXT_STROBE, i]))
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
