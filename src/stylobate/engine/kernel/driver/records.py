"""Records of a run at its stops: trace, looks, samples, last periods and loads of a standing column."""

import math

import numpy as np

from stylobate.compiler.marks import fast, lanes
from stylobate.engine.elementary import cos_turns, length, polynomial, turns_of
from stylobate.engine.kernel.bound import (
    BREAKS_AT,
    DEGREE,
    DEMANDS,
    KEPT_STATES,
    ORDER,
    PLANAR,
    SERIES,
    SWITCHING,
    TRACE_ROOM,
    TRACE_STATES,
    TRACE_WIDTH,
    WIDTH,
    WINDOW_ENDS,
    R,
    Table,
)
from stylobate.engine.kernel.columns import EARLIER, LAGS, NOTE, PAIRS, SLACK, TRACE_TERMS, Pair, Trace, pair_begins
from stylobate.engine.kernel.driver.equations import (
    LEAST_NORMAL,
    accelerations,
    continues_in_next_piece,
    lean_of,
    row_state,
    set_leg,
)
from stylobate.engine.kernel.driver.events import RunStatus, TraceKind
from stylobate.engine.kernel.driver.guards import record_window
from stylobate.engine.kernel.driver.motion import azimuth_now, set_rates
from stylobate.engine.kernel.driver.stages import series_terms, set_dense
from stylobate.engine.kernel.shape import NODES
from stylobate.engine.tolerances import SAMPLES_PER_PERIOD


def trace_steps(buf: Table, table: Table) -> bool:
    """Add the steps just made; return whether a trace is full."""
    full = False
    for i in range(WIDTH):
        if buf[R.TRACES, i] > 0.0 and buf[R.GO, i] > 0.0:
            trace_step(buf, i, table)
        full = full or (buf[R.TRACES, i] > 0.0 and buf[R.NEXT_TRACE, i] + TRACE_ROOM >= buf[R.TRACES, i])
    return full


def trace_step(buf: Table, i: int, table: Table) -> None:
    """Add the step just made; a step back to an event only shortens the previous entry."""
    h = buf[R.MADE, i]
    if h > 0.0 and not SERIES:
        start = buf[R.TIME, i] - h
        set_dense(buf, i, R.LAST_STATE, R.LAST_SLOPE, start, h)
        trace_dense(buf, i, table, start, h)
    buf[R.TRACE_AZIMUTH, i] = azimuth_of(buf, i)


def trace_dense(buf: Table, i: int, table: Table, start: float, length: float) -> None:
    """Add a step of this length, with its start state and dense output."""
    at = trace_entry(buf, i, table, TraceKind.PLANE_STEP if PLANAR else TraceKind.STEP, start, length)
    run = int(buf[R.RUN, i])
    for j in range(ORDER):
        table[run, at + j] = buf[R.LAST_STATE + j, i]
        for k in range(1, TRACE_TERMS):
            table[run, at + k * TRACE_STATES + j] = buf[R.DENSE + (k - 1) * ORDER + j, i]


def trace_part(buf: Table, i: int, table: Table) -> None:
    """Add the accepted part of a step up to an event, or an implicit step."""
    if buf[R.TRACES, i] > 0.0:
        trace_dense(buf, i, table, buf[R.TIME, i] - buf[R.MADE, i], buf[R.TRIED, i])
        buf[R.TRACE_AZIMUTH, i] = azimuth_of(buf, i)


def trace_analytical_step(
    buf: Table, i: int, table: Table, elapsed: float, state: tuple[float, ...], azimuth: float
) -> None:
    """Add an analytical step from the present state to `state` with the azimuth `azimuth`."""
    if buf[R.TRACES, i] == 0.0:
        return
    at = trace_entry(buf, i, table, TraceKind.ANALYTICAL_STEP, buf[R.TIME, i], elapsed)
    run = int(buf[R.RUN, i])
    for j in range(ORDER):
        table[run, at + j] = buf[R.STATE + j, i]
        table[run, at + TRACE_STATES + j] = state[j] - buf[R.STATE + j, i]
        for k in range(2, TRACE_TERMS):
            table[run, at + k * TRACE_STATES + j] = 0.0
    for j in KEPT_STATES:
        table[run, at + TRACE_STATES + j] = 0.0
    table[run, at - len(Trace) + Trace.END_AZIMUTH] = azimuth


def trace_stand(buf: Table, i: int, table: Table, t: float) -> None:
    """Add an entry for standing from `t` on."""
    if buf[R.TRACES, i] == 0.0:
        return
    at = trace_entry(buf, i, table, TraceKind.STAND, t, 1.0)
    run = int(buf[R.RUN, i])
    for j in range(TRACE_STATES * TRACE_TERMS):
        table[run, at + j] = 0.0
    for j in range(ORDER):
        table[run, at + j] = buf[R.STATE + j, i]


def trace_event(buf: Table, i: int, table: Table, kind: int, t: float) -> None:
    """Add an event."""
    if buf[R.TRACES, i] > 0.0:
        trace_entry(buf, i, table, kind, t, 0.0)


def trace_entry(buf: Table, i: int, table: Table, kind: int, start: float, length: float) -> int:
    """Begin an entry; return the column of its state."""
    notes = buf[R.BREAKS, i] + NOTE * buf[R.NOTES, i]
    run, at = int(buf[R.RUN, i]), BREAKS_AT + int(notes) + TRACE_WIDTH * int(buf[R.NEXT_TRACE, i])
    buf[R.NEXT_TRACE, i] += 1.0
    table[run, at + Trace.KIND] = kind
    table[run, at + Trace.START] = start
    table[run, at + Trace.LENGTH] = length
    table[run, at + Trace.AZIMUTH] = buf[R.TRACE_AZIMUTH, i]
    table[run, at + Trace.END_AZIMUTH] = azimuth_of(buf, i)
    return at + len(Trace)


def azimuth_of(buf: Table, i: int) -> float:
    """Return the azimuth of the tilt vector [turns]."""
    return 0.0 if PLANAR else buf[R.TURNS, i] + turns_of(buf[R.X, i], buf[R.Y, i])


def remove_trace_entry(buf: Table, i: int) -> None:
    """Remove the last entry, after its step was undone."""
    if buf[R.TRACES, i] > 0.0 and not SERIES:
        buf[R.NEXT_TRACE, i] -= 1.0
        buf[R.TRACE_AZIMUTH, i] = azimuth_of(buf, i)


_GAUSS = np.polynomial.legendre.leggauss(NODES)  # on −1 … 1
PLACES, WEIGHTS = 0.5 + 0.5 * _GAUSS[0], 0.5 * _GAUSS[1]
OBSERVED = 5
"""Rows of the integrals: mean tilt, forward along the cosine and the sine, backward along both."""
TINY = 1e-300

Observed = tuple[float, float, float, float, float]


@fast
def observe(buf: Table, i: int) -> None:
    """Add the integrals over the step just made of the tilt, and of the tilt vector times e^{∓2πi t/T}; T: period."""
    if SERIES:
        observe_by_nodes(buf, i)
    else:
        observe_by_ends(buf, i)
    buf[R.LATE_MINIMUM_TILT, i] = min(buf[R.LATE_MINIMUM_TILT, i], buf[R.LOW, i])


def observe_by_nodes(buf: Table, i: int) -> None:
    """Integrate by Gauss's rule, with the states at its nodes from the series of the step."""
    h, w = buf[R.MADE, i], buf[R.PER_TURN, i]
    start = w * (buf[R.TIME, i] - h)
    terms = tuple(series_terms(buf, i, j) for j in range(ORDER))
    # A sum in this loop would prevent vectorisation: the products are stored and added afterwards.
    for node in lanes(NODES):
        u = PLACES[node]
        x, y, _, _ = lean_of(buf, i, tuple(polynomial(one, u * h) for one in terms))
        turns = start + w * (u * h)
        cos, sin = cos_turns(turns), cos_turns(turns - 0.25)
        weight = h * WEIGHTS[node]
        values = (math.sqrt(x * x + y * y), *rotating_components(x, y, cos, sin))
        for k in range(OBSERVED):
            buf[R.NODE_MEAN_TILT + k, node] = weight * values[k]
    for node in range(NODES):
        for k in range(OBSERVED):
            buf[R.MEAN_TILT + k, i] += buf[R.NODE_MEAN_TILT + k, node]


def rotating_components(x: float, y: float, cos: float, sin: float) -> tuple[float, float, float, float]:
    """Return the components of a vector in frames that rotate with and against the forcing."""
    return x * cos + y * sin, y * cos - x * sin, x * cos - y * sin, y * cos + x * sin


def observe_by_ends(buf: Table, i: int) -> None:
    """Integrate by the trapezoidal rule with its end correction, exact for cubics.

    The frames rotate with and against the forcing, because steady rolling is constant in one of them.
    """
    h, w = buf[R.MADE, i], buf[R.PER_TURN, i]
    start = w * (buf[R.TIME, i] - h)
    weight, correction = 0.5 * h, h * h * (1.0 / 12.0)
    values0, slopes0 = observed_at(buf, i, R.LAST_STATE, start, w)
    values1, slopes1 = observed_at(buf, i, R.STATE, start + w * h, w)
    for k in tuple(range(OBSERVED)):
        whole = weight * (values0[k] + values1[k]) + correction * (slopes0[k] - slopes1[k])
        buf[R.MEAN_TILT + k, i] += whole


def observed_at(buf: Table, i: int, row: int, turns: float, w: float) -> tuple[Observed, Observed]:
    """Return the integrands and their rates at an end of the step, whose state begins at this row."""
    x, y, vx, vy = lean_of(buf, i, row_state(buf, i, row))
    cos, sin = cos_turns(turns), cos_turns(turns - 0.25)
    turning = 6.283185307179586 * w
    tilt = math.sqrt(x * x + y * y)
    # Planar motion passes tilt zero with a nonzero rate.
    rate = buf[R.SIDE, i] * vx if PLANAR else (x * vx + y * vy) / (tilt + TINY)
    along, across, against, other = rotating_components(x, y, cos, sin)
    forward = rotating_components(vx + turning * y, vy - turning * x, cos, sin)
    backward = rotating_components(vx - turning * y, vy + turning * x, cos, sin)
    return (tilt, along, across, against, other), (rate, forward[0], forward[1], backward[2], backward[3])


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


def record_standing_loads(buf: Table, i: int, start: float, end: float) -> None:
    """Record the peak friction demand |a_h|/(1 + a_z) and the minimum normal force while standing from start to end.

    If the acceleration is linear in time, both occur at an end, because the demand is quasi-convex. Otherwise they are
    extremes of parabolas through three samples, spaced as in the search for uplift.
    """
    if not DEMANDS or end <= start:
        return
    parts = 1
    if DEGREE != 1:
        frequency = buf[R.FREQUENCY, i]
        spacing = 2.0 * math.pi / (frequency * SAMPLES_PER_PERIOD) if frequency > 0.0 else end - start
        parts = max(2, math.ceil((end - start) / spacing))
    d0, n0 = standing_load(buf, i, start)
    d1, n1 = d0, n0
    most, least = d0, n0
    for k in range(1, parts + 1):
        d2, n2 = standing_load(buf, i, end if k == parts else start + (end - start) * (k / parts))
        most = max(most, d2)
        least = min(least, n2)
        if k > 1:
            most = max(most, crest(d0, d1, d2))
            least = min(least, -crest(-n0, -n1, -n2))
        d0, n0, d1, n1 = d1, n1, d2, n2
    buf[R.FRICTION, i] = max(buf[R.FRICTION, i], most)
    buf[R.NORMAL, i] = min(buf[R.NORMAL, i], least)


def standing_load(buf: Table, i: int, t: float) -> tuple[float, float]:
    """Return the friction demand and the normal force over the weight of a column that stands at `t`."""
    ax, ay, az = accelerations(buf, i, t)
    return math.hypot(ax, ay) / max(1.0 + az, LEAST_NORMAL), 1.0 + az


def crest(before: float, here: float, after: float) -> float:
    """Return the maximum of the parabola through three equidistant values, or the middle value if it has none there."""
    bend = before - 2.0 * here + after
    slant = after - before
    return here - slant * slant / (8.0 * bend) if abs(slant) < -2.0 * bend else here


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
        return RunStatus.LIFTED
    if t >= buf[R.END, i]:
        return RunStatus.STOPPED
    if t >= buf[R.LEG_ENDS, i] or t >= buf[R.BREAKS_AT, i]:
        while buf[R.BREAKS_AT, i] <= t:
            buf[R.NEXT_BREAK, i] += 1.0
            set_break(buf, i, table)
        set_leg(buf, i, table, pieces, t)
        if buf[R.STANDS, i] == 0.0:
            set_rates(buf, i, t)
    return RunStatus.WAITING


def resume(buf: Table, i: int, table: Table, pieces: Table) -> int:
    """Continue after an event, which may be beyond a stop by rounding; return as `meet_stop` does."""
    while next_stop(buf, i) <= buf[R.TIME, i]:
        status = meet_stop(buf, i, table, pieces, next_stop(buf, i))
        if status != RunStatus.WAITING:
            return status
    set_next_stop(buf, i)
    return RunStatus.WAITING


def stand_to_the_end(buf: Table, i: int, table: Table, pieces: Table, t: float) -> int:
    """Complete the record of a run that stands to its end, with the contact loads of the remaining legs."""
    while t < buf[R.END, i]:
        leg_ends = leg_end(buf, i)
        t = next_stop(buf, i)
        meet_stop(buf, i, table, pieces, t)
        if t >= leg_ends:
            record_standing_loads(buf, i, t, leg_end(buf, i))
    buf[R.TIME, i] = t
    return RunStatus.RESTED
