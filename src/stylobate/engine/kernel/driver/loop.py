"""Loop over a batch of runs: fill the lanes, make steps, handle events, and end runs that converge to a known orbit."""

import math

import numpy as np
import numpy.typing as npt

from stylobate.engine.dop853 import STAGES
from stylobate.engine.kernel.bound import (
    GRAIN,
    GROUP_KINDS,
    GROUP_MOVING,
    GROUPS,
    KEPT,
    ORBITS,
    ORBITS_AT,
    ORDER,
    PARAMETERS,
    PARAMETERS_AT,
    PLANAR,
    ROWS,
    SPIN,
    SWITCHING,
    WIDTH,
    R,
    Table,
    begin,
    handle,
)
from stylobate.engine.kernel.columns import EVENTS_AT, LOG, ORBIT, SLACK, STATE, Orbit
from stylobate.engine.kernel.driver.equations import lean_of_new, set_bounds, set_leg
from stylobate.engine.kernel.driver.events import RunStatus
from stylobate.engine.kernel.driver.motion import azimuth_now, square_of_speed
from stylobate.engine.kernel.driver.records import (
    observe,
    passes_knot,
    set_break,
    set_look,
    set_pair,
    set_sample,
    set_strobe,
    trace_steps,
)
from stylobate.engine.kernel.driver.rest import repeats_to_the_end
from stylobate.engine.kernel.driver.stages import set_dense_output, set_within, set_within_closely
from stylobate.engine.kernel.driver.step import step


def advance(table: Table, pieces: Table, halt: npt.NDArray[np.uint8], buf: Table) -> bool:
    """Run a batch to its end; return whether it has ended.

    The batch stops early if another thread sets `halt[0]` to 1, or if a trace is full. After the caller has emptied the
    trace, a call with the same buffer continues. `table` has a row for each run, see `columns`; a new `buf` is NaN.
    """
    waiting = 0
    for group in GROUPS:
        waiting = max(waiting, begin_or_continue(buf[group * ROWS : (group + 1) * ROWS], table))
    while True:
        live = 0
        for group in GROUPS:
            goes_on, waiting = follow(buf, table, pieces, halt, waiting, group)
            if not goes_on:
                for other in GROUPS:
                    pause(buf[other * ROWS : (other + 1) * ROWS], table)
                return False
        for group in GROUPS:
            live += gather(buf[group * ROWS : (group + 1) * ROWS])
        if live == 0:
            return True


def begin_or_continue(buf: Table, table: Table) -> int:
    """Prepare the lanes of a new buffer, or continue those of a paused batch; return the run after the last of them."""
    waiting = 0
    begins = math.isnan(buf[R.RUN, 0])
    for i in range(WIDTH):
        if begins:
            set_idle(buf, i)
        run = int(buf[R.RUN, i])
        waiting = max(waiting, run + 1)
        if run >= 0:
            buf[R.NEXT_TRACE, i] = table[run, R.NEXT_TRACE]
    return waiting


def follow(
    groups: Table, table: Table, pieces: Table, halt: npt.NDArray[np.uint8], waiting: int, group: int
) -> tuple[bool, int]:
    """Make steps in a group of lanes until none of its runs can go on before another group has.

    Return whether the batch goes on, and the next waiting run. It does not go on if a trace is full, or on a signal.
    """
    buf = groups[group * ROWS : (group + 1) * ROWS]
    traced = table[0, R.TRACES] > 0.0
    while True:
        ready, waiting = assign(groups, table, pieces, waiting, group)
        width = gather(buf)
        if width == 0 or not ready:
            return True, waiting
        met = full = False
        while not met:
            step(buf, width, group)
            full = traced and trace_steps(buf, table)
            met = full
            for i in range(width):
                met = is_due(buf, i, table, pieces) or met
            if halt[0] != 0:
                return False, waiting
        for i in range(width):
            if buf[R.FLAG, i] > 0.0 and buf[R.RUN, i] >= 0.0:
                status = status_of(buf, i, table, pieces)
                if status != RunStatus.WAITING:
                    leave(buf, i, table, status)
                    set_idle(buf, i)
        if full:
            return False, waiting


def assign(groups: Table, table: Table, pieces: Table, waiting: int, group: int) -> tuple[bool, int]:
    """Fill the idle lanes of a group, and move runs whose kind of contact belongs to another group.

    Return False if such a run remains, because its group has no lane for it, and the next waiting run.
    """
    buf = groups[group * ROWS : (group + 1) * ROWS]
    ready = True
    for i in range(WIDTH):
        if buf[R.RUN, i] < 0.0:
            waiting = fill(buf, i, table, pieces, waiting)
        if SWITCHING:
            target = group_of(groups, group, i)
            while ready and target != group:
                k = lane_for(groups, target)
                ready = k >= 0
                if ready:
                    exchange(groups, group, i, target, k)
                    if buf[R.RUN, i] < 0.0:
                        waiting = fill(buf, i, table, pieces, waiting)
                    target = group_of(groups, group, i)
    return ready, waiting


def group_of(groups: Table, group: int, i: int) -> int:
    """Return the group to which the run in a lane belongs; the present one for an idle lane."""
    if groups[group * ROWS + R.RUN, i] < 0.0:
        return group
    kind = groups[group * ROWS + R.CONTACT, i]
    for other in GROUPS[:-1]:
        if kind == GROUP_KINDS[other]:
            return other
    return GROUPS[-1]


def lane_for(groups: Table, target: int) -> int:
    """Return a lane of a group for another run: an idle one, or one whose run belongs to another group, or −1."""
    found = -1
    for k in range(WIDTH):
        if groups[target * ROWS + R.RUN, k] < 0.0:
            return k
        if group_of(groups, target, k) != target:
            found = k
    return found


def exchange(groups: Table, one: int, i: int, other: int, k: int) -> None:
    """Exchange the contents of lane `i` of a group and lane `k` of another."""
    first, second = one * ROWS, other * ROWS
    for row in range(ROWS):
        groups[first + row, i], groups[second + row, k] = groups[second + row, k], groups[first + row, i]
    for stage in range(STAGES + 1):  # the slopes of states that do not change in a group are not written there
        row = R.SLOPE + stage * ORDER
        for j in range(ORDER):
            if j >= GROUP_MOVING[one]:
                groups[first + row + j, i] = 0.0
            if j >= GROUP_MOVING[other]:
                groups[second + row + j, k] = 0.0


def fill(buf: Table, i: int, table: Table, pieces: Table, waiting: int) -> int:
    """Load the first run from `waiting` on that does not end at once into lane `i`; return the next waiting run."""
    while waiting < len(table):
        run = waiting
        waiting += 1
        if table[run, R.STATUS] == RunStatus.WAITING:
            status = enter(buf, i, table, pieces, run)
            if status == RunStatus.WAITING:
                break
            leave(buf, i, table, status)
            set_idle(buf, i)
    return waiting


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
    if status not in (RunStatus.RESTED, RunStatus.TO_PLANE):
        buf[R.DECIDED, i] = buf[R.TIME, i]
    if not PLANAR and buf[R.STANDS, i] == 0.0 and status != RunStatus.TO_PLANE:
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


def is_due(buf: Table, i: int, table: Table, pieces: Table) -> bool:
    """Observe the step just made in a lane; return whether the lane has an event for the driver."""
    if buf[R.WATCHED, i] > 0.0 and buf[R.GO, i] > 0.0:
        observe(buf, i)
    if ORBITS and passes_phase_zero(buf, i):
        watch(buf, i, table)
    return buf[R.FLAG, i] > 0.0 and not passes_knot(buf, i, table, pieces)


def status_of(buf: Table, i: int, table: Table, pieces: Table) -> int:
    """Handle the event of a flagged lane; return its status."""
    if ORBITS and buf[R.CONVERGED, i] > 0.0:
        return RunStatus.CONVERGED
    return handle(buf, i, table, pieces)


def pause(buf: Table, table: Table) -> None:
    """Prepare the table so that the caller can empty the traces and report progress."""
    for i in range(WIDTH):
        if buf[R.RUN, i] >= 0.0:
            for column in (R.NEXT_TRACE, R.TIME, R.STEPS):
                table[int(buf[R.RUN, i]), column] = buf[column, i]


# Convergence to a known orbit


def passes_phase_zero(buf: Table, i: int) -> bool:
    """Return whether the step just made is final and reached phase zero of the base motion."""
    return buf[R.TIME, i] >= buf[R.PHASE_ZERO_AT, i] and buf[R.GO, i] > 0.0 and buf[R.AIMED, i] == 0.0


def start_watching(buf: Table, i: int, table: Table) -> None:
    """Start the comparison of the run of a lane with its known orbits."""
    run = int(buf[R.RUN, i])
    for k in range(ORBITS):
        first = R.ORBIT + k * ORBIT
        for column in range(ORBIT):
            buf[first + column, i] = table[run, ORBITS_AT + k * ORBIT + column]
        reset_approach(buf, i, k)
    buf[R.CONVERGED, i] = 0.0
    buf[R.PHASE_ZERO_AT, i] = math.inf
    if latest(buf, i) > buf[R.TIME, i]:
        set_phase_zero(buf, i)


def set_phase_zero(buf: Table, i: int) -> None:
    """Set the next time at which the base motion has phase zero; none if it is too late for a run to end early."""
    t, period, first = buf[R.TIME, i], buf[R.PERIOD, i], buf[R.STROBE, i]
    following = first + (math.floor((t - first) / period + SLACK) + 1.0) * period
    buf[R.PHASE_ZERO_AT, i] = following if following < judged_from(buf, i) else math.inf


def judged_from(buf: Table, i: int) -> float:
    """Return the start of the last periods, which decide the outcome."""
    return buf[R.END, i] - (buf[R.PERIODS, i] + 1.0) * buf[R.PERIOD, i]


def latest(buf: Table, i: int) -> float:
    """Return the last time at which a run far from its orbits can still converge before its outcome is decided."""
    last = -math.inf
    for k in range(ORBITS):
        last = max(last, buf[R.ORBIT + k * ORBIT + Orbit.LATEST, i])
    return last


def watch(buf: Table, i: int, table: Table) -> None:
    """Measure the distances from the known orbits after a step past phase zero; flag a run that has converged."""
    end, h = buf[R.TIME, i], buf[R.MADE, i]
    elapsed = buf[R.PHASE_ZERO_AT, i] - (end - h)
    set_phase_zero(buf, i)
    if elapsed < 0.0:  # the column stood, or made an analytical step past the vertical
        for k in range(ORBITS):
            reset_approach(buf, i, k)
        return
    set_within(buf, i, elapsed)
    closest = math.inf
    for k in range(ORBITS):
        closest = min(closest, distance_of_new(buf, i, k))
    if end > latest(buf, i) and closest > NEAR + OF_CUBICS:
        buf[R.PHASE_ZERO_AT, i] = math.inf
        return
    near = closest < FAR + OF_CUBICS
    if near:
        set_dense_output(buf, i)
        set_within_closely(buf, i, elapsed)
    for k in range(ORBITS):
        distance = distance_of_new(buf, i, k) if near else math.inf
        if distance < FAR:
            if approaches(buf, i, k, distance):
                table[int(buf[R.RUN, i]), ORBITS_AT + k * ORBIT + Orbit.REACHED] = 1.0
                buf[R.CONVERGED, i] = 1.0
                buf[R.FLAG, i] += 1.0
        else:
            reset_approach(buf, i, k)


def distance_of_new(buf: Table, i: int, k: int) -> float:
    """Return the distance of the new state from an orbit; NaN if the run has no such orbit."""
    first = R.ORBIT + k * ORBIT
    x, y, vx, vy = lean_of_new(buf, i)
    size, rate = buf[first + Orbit.SIZE, i], buf[first + Orbit.RATE, i]
    x, y = (x - buf[first + Orbit.X, i]) / size, (y - buf[first + Orbit.Y, i]) / size
    vx, vy = (vx - buf[first + Orbit.VX, i]) / rate, (vy - buf[first + Orbit.VY, i]) / rate
    square = x * x + y * y + vx * vx + vy * vy
    if SPIN >= 0:
        square += ((buf[R.NEW + SPIN, i] - buf[first + Orbit.SPIN, i]) / rate) ** 2
    return math.sqrt(square)


def approaches(buf: Table, i: int, k: int, distance: float) -> bool:
    """Record the distance from an orbit; return whether the run has converged to the orbit."""
    first = R.ORBIT + k * ORBIT
    before = first + Orbit.BEFORE
    approach = buf[before, i], buf[before + 1, i], buf[before + 2, i], buf[before + 3, i]
    approach = approach_after(approach, distance, buf[first + Orbit.WINDOW, i], buf[first + Orbit.FALL, i])
    set_approach(buf, i, k, approach)
    left = judged_from(buf, i) - buf[R.TIME, i]
    fall = math.exp(-buf[first + Orbit.DECAY, i] * left)
    return left >= 0.0 and is_certain(approach, fall, buf[first + Orbit.REPEATS, i]) and repeats_to_the_end(buf, i)


Approach = tuple[float, float, float, float]
"""Largest distances in the previous and in the present window, periods of the present window so far, and number of
successive windows that fell as the multipliers demand."""


# Distance from an orbit within which perturbations are assumed to follow its multipliers.
NEAR = 0.03
# A run is not compared with an orbit above this distance.
FAR = 0.2
# Maximum error of the first estimates of distances, by cubics through the ends of a step.
OF_CUBICS = 0.1
# The largest distance of a window agrees with ρ^m times the previous one within this factor.
MARGIN = 1.6
# Number of successive windows that must fall as the multipliers demand.
WINDOWS = 3.0
# A run is on the orbit below this distance: rounding and tolerance prevent smaller distances.
ON_ORBIT = 1e-6
# States one period apart must differ by less than this fraction of the tolerance that decides the outcome.
CERTAIN = 0.05


def approach_after(approach: Approach, distance: float, window: float, fall: float) -> Approach:
    """Update the record of an approach with the distance one period later.

    Parameters
    ----------
    approach
        The record.
    distance
        Distance from the orbit.
    window
        Number m of periods in a window.
    fall
        ρ^m.
    """
    before, largest, periods, falls = approach
    largest, periods = max(largest, distance), periods + 1.0
    if periods < window:
        return before, largest, periods, falls
    demanded = fall * before
    follows = before <= NEAR and demanded <= MARGIN * largest and largest <= MARGIN * demanded
    stays = largest <= ON_ORBIT and before <= NEAR
    return largest, 0.0, 0.0, falls + 1.0 if follows or stays else 0.0


def is_certain(approach: Approach, fall_to_judgement: float, repeats: float) -> bool:
    """Return whether a run has converged and will repeat when its outcome is decided.

    Parameters
    ----------
    approach
        The record.
    fall_to_judgement
        Factor by which the distance falls before the last periods, which decide the outcome.
    repeats
        Maximum difference of states one period apart of a repeating motion, in units of the largest state.
    """
    largest, _, periods, falls = approach
    return periods == 0.0 and falls >= WINDOWS and largest * fall_to_judgement <= CERTAIN * repeats


def reset_approach(buf: Table, i: int, k: int) -> None:
    """Reset the record of the approach to an orbit."""
    set_approach(buf, i, k, (math.inf, 0.0, 0.0, 0.0))


def set_approach(buf: Table, i: int, k: int, approach: Approach) -> None:
    first = R.ORBIT + k * ORBIT + Orbit.BEFORE
    for column in range(4):
        buf[first + column, i] = approach[column]
