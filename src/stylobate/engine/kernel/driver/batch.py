"""Loop over a batch of runs: fill the lanes, make steps, handle events, and store the results."""

import math

import numpy as np
import numpy.typing as npt

from stylobate.engine.kernel.bound import (
    GRAIN,
    KEPT,
    ORBITS,
    PARAMETERS,
    PARAMETERS_AT,
    PLANAR,
    WIDTH,
    R,
    begin,
    handle,
)
from stylobate.engine.kernel.columns import EVENTS_AT, LOG, STATE
from stylobate.engine.kernel.driver.base_motion import set_bounds, set_leg
from stylobate.engine.kernel.driver.convergence import start_watching, watch
from stylobate.engine.kernel.driver.events import Status
from stylobate.engine.kernel.driver.looks import set_look, set_pair
from stylobate.engine.kernel.driver.moving import azimuth_now, square_of_speed
from stylobate.engine.kernel.driver.observation import observe
from stylobate.engine.kernel.driver.step import step
from stylobate.engine.kernel.driver.stops import passes_knot, set_break, set_sample, set_strobe
from stylobate.engine.kernel.driver.tracing import trace_steps
from stylobate.engine.kernel.layout import Table

# A motion that begins has a finer tolerance up to this tilt [units of c].
GROWN = 1e-3


def enter(buf: Table, i: int, table: Table, pieces: Table, run: int) -> int:
    """Load a run into lane `i`; return WAITING if the column moves, else the status with which the run ends at once."""
    for column in range(STATE):
        buf[column, i] = table[run, column]
    for j in range(KEPT):
        buf[R.STATE + j, i] = table[run, STATE + j]
    for j in range(PARAMETERS):
        buf[R.PARAMETER + j, i] = table[run, PARAMETERS_AT + j]
    buf[R.RUN, i] = run
    buf[R.PIECE, i] = 0.0
    c, t = buf[R.SLENDERNESS, i], buf[R.TIME, i]
    buf[R.GROWN, i] = GROWN * c
    most = max(buf[R.REST_ENERGY, i], buf[R.REST_ENERGY_FOR_GOOD, i])
    buf[R.REST_TILT, i] = most * c
    buf[R.SLOW_SQUARE, i] = square_of_speed(buf, i, most)
    buf[R.REST_SQUARE, i] = square_of_speed(buf, i, buf[R.REST_ENERGY, i])
    buf[R.PER_TURN, i] = 1.0 / buf[R.PERIOD, i] if buf[R.PERIOD, i] > 0.0 else 0.0
    set_look(buf, i)
    set_pair(buf, i)
    set_sample(buf, i)
    set_strobe(buf, i)
    set_break(buf, i, table)
    if ORBITS:
        start_watching(buf, i, table)
    set_bounds(buf, i)
    set_leg(buf, i, table, pieces, t)
    return begin(buf, i, table, pieces)


def leave(buf: Table, i: int, table: Table, status: int) -> None:
    """Write the present state of the run of lane `i` to the table."""
    run = int(buf[R.RUN, i])
    buf[R.STATUS, i] = status
    if status not in (Status.RESTED, Status.TO_PLANE):
        buf[R.DECIDED, i] = buf[R.TIME, i]
    if not PLANAR and buf[R.STANDS, i] == 0.0 and status != Status.TO_PLANE:
        buf[R.LAST_AZIMUTH, i] = azimuth_now(buf, i)
    for column in range(R.STATUS, STATE):
        table[run, column] = buf[column, i]
    for j in range(KEPT):
        table[run, STATE + j] = buf[R.STATE + j, i]


def set_idle(buf: Table, i: int) -> None:
    """Fill an idle lane with harmless numbers."""
    for row in range(len(buf)):
        buf[row, i] = 0.0
    for row in (R.STATE, R.TILT, R.X, R.SLENDERNESS, R.SIDE, R.ATOL, R.ATOL_NOW):
        buf[row, i] = 1.0
    for row in (*range(EVENTS_AT, LOG), R.STOP, R.NO_RETURN, R.PEAK_TILT, R.MOST_STEPS):
        buf[row, i] = 1e300
    if ORBITS:
        buf[R.PHASE_ZERO_AT, i] = math.inf
    for j in range(PARAMETERS):
        buf[R.PARAMETER + j, i] = 0.1
    buf[R.RUN, i] = -1.0


def fill(buf: Table, i: int, table: Table, pieces: Table, waiting: int) -> int:
    """Load the first run from `waiting` on that does not end at once into lane `i`; return the next waiting run."""
    while waiting < len(table):
        run = waiting
        waiting += 1
        if table[run, R.STATUS] == Status.WAITING:
            status = enter(buf, i, table, pieces, run)
            if status == Status.WAITING:
                break
            leave(buf, i, table, status)
            set_idle(buf, i)
    return waiting


def begin_or_continue(buf: Table, table: Table, pieces: Table) -> int:
    """Fill the lanes of a new buffer, or continue a paused batch; return the next waiting run."""
    waiting = 0
    if math.isnan(buf[R.RUN, 0]):
        for i in range(WIDTH):
            set_idle(buf, i)
            waiting = fill(buf, i, table, pieces, waiting)
        return waiting
    for i in range(WIDTH):
        run = int(buf[R.RUN, i])
        waiting = max(waiting, run + 1)
        if run >= 0:
            buf[R.NEXT_TRACE, i] = table[run, R.NEXT_TRACE]
    return waiting


def gather(buf: Table) -> int:
    """Move the runs to the first lanes; return the number of lanes for a step in whole vectors, 0 without a run."""
    live = 0
    for i in range(WIDTH):
        if buf[R.RUN, i] >= 0.0:
            if i > live:
                for row in range(len(buf)):
                    buf[row, live] = buf[row, i]
                set_idle(buf, i)
            live += 1
    return GRAIN * ((live + GRAIN - 1) // GRAIN)


def pause(buf: Table, table: Table) -> bool:
    """Prepare the table so that the caller can empty the traces; return False, since the batch has not ended."""
    for i in range(WIDTH):
        if buf[R.RUN, i] >= 0.0:
            table[int(buf[R.RUN, i]), R.NEXT_TRACE] = buf[R.NEXT_TRACE, i]
    return False


def is_due(buf: Table, i: int, table: Table, pieces: Table) -> bool:
    """Observe the step just made in a lane; return whether the lane has an event for the driver."""
    if buf[R.WATCHED, i] > 0.0 and buf[R.GO, i] > 0.0:
        observe(buf, i)
    if ORBITS and passes_phase_zero(buf, i):
        watch(buf, i, table)
    return buf[R.FLAG, i] > 0.0 and not passes_knot(buf, i, table, pieces)


def passes_phase_zero(buf: Table, i: int) -> bool:
    """Return whether the step just made is final and reached phase zero of the base motion."""
    return buf[R.TIME, i] >= buf[R.PHASE_ZERO_AT, i] and buf[R.GO, i] > 0.0 and buf[R.AIMED, i] == 0.0


def status_of(buf: Table, i: int, table: Table, pieces: Table) -> int:
    """Handle the event of a flagged lane; return its status."""
    if ORBITS and buf[R.CONVERGED, i] > 0.0:
        return Status.CONVERGED
    return handle(buf, i, table, pieces)


def advance(table: Table, pieces: Table, halt: npt.NDArray[np.uint8], buf: Table) -> bool:
    """Run a batch to its end; return whether it has ended.

    The batch stops early if another thread sets `halt[0]` to 1, or if a trace is full. After the caller has emptied the
    trace, a call with the same buffer continues. `table` has a row for each run, see `columns`; a new `buf` is NaN.
    """
    waiting = begin_or_continue(buf, table, pieces)
    traced = table[0, R.TRACES] > 0.0
    while True:
        width = gather(buf)
        if width == 0:
            return True
        met = full = False
        while not met:
            step(buf, width)
            full = traced and trace_steps(buf, table)
            met = full
            for i in range(width):
                met = is_due(buf, i, table, pieces) or met
            if halt[0] != 0:
                return False
        for i in range(width):
            if buf[R.FLAG, i] > 0.0 and buf[R.RUN, i] >= 0.0:
                status = status_of(buf, i, table, pieces)
                if status != Status.WAITING:
                    leave(buf, i, table, status)
                    set_idle(buf, i)
                    waiting = fill(buf, i, table, pieces, waiting)
        if full:
            return pause(buf, table)
