"""Trace of a run: the dense output of its steps, and its events. Steps by series have no dense output in the trace."""

from stylobate.engine.kernel.bound import (
    BREAKS_AT,
    KEPT_STATES,
    ORDER,
    PLANAR,
    SERIES,
    TRACE_ROOM,
    TRACE_STATES,
    TRACE_WIDTH,
    WIDTH,
    R,
)
from stylobate.engine.kernel.columns import NOTE, TRACE_TERMS, Trace
from stylobate.engine.kernel.driver.events import TraceKind
from stylobate.engine.kernel.driver.stages import set_dense
from stylobate.engine.kernel.layout import Table
from stylobate.engine.kernel.roots import turns_of


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
