"""Integration of the variational equations of a motion over periods of the base motion."""

import math
from enum import IntEnum
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from stylobate.compiler.marks import fast, lanes
from stylobate.engine.dop853 import E3, E5, LARGEST_FACTOR, LEAST_ERROR, LEAST_FACTOR, SAFETY, STAGES, A, B, C
from stylobate.engine.elementary import turning_point, weighted, winding
from stylobate.engine.flow.bound import (
    ACCELERATIONS,
    COLUMNS,
    LOSES,
    NUMBERS,
    ORDER,
    PLANAR,
    from_plane,
    impact_map,
    jacobian,
    rates,
    tilt_of,
)


class FlowStatus(IntEnum):
    """Status of a flow at its end."""

    DONE = 0
    LOST = 1
    """The motion came to the vertical, where the derivatives do not exist."""
    GONE = 2
    """The motion exceeded the peak tilt."""
    FAILED = 3
    """There were too many steps, or a step was too short."""


class FlowLog(IntEnum):
    """Places of the record of a flow."""

    LEAST_TILT = 0
    PEAK_TILT = 1
    """Minimum and maximum tilt so far."""
    STEPS = 2
    """Number of steps."""
    SIDE = 3
    """Side of the vertical in planar motion."""
    TURNS = 4
    """Turns of the tilt vector."""


Table = npt.NDArray[np.float64]
Vector = npt.NDArray[np.float64]

# Steps in turns of the base motion.
FIRST_STEP, LONGEST_STEP, SHORTEST_STEP = 0.01, 0.125, 1e-13
MOST_STEPS = 200_000
# Tolerance of the tilt at a passage through the vertical [rad], and maximum number of iterations.
MET, MOST_TRIES = 1e-15, 60
# Difference steps for the derivatives of the loss at a passage, as fractions of the change of the parameters and of the
# speed.
LOSS_STEP, SPEED_STEP = 1e-6, 1e-3

STAGE_NUMBERS = tuple(range(1, STAGES + 1))
WEIGHTS, NODES = (*A, B), (*C, 1.0)
"""Weights of the slopes in each stage, and its time in steps; the last stage is the end of the step."""


class System(NamedTuple):
    """Numbers of the equations, and their derivatives with respect to one parameter of the system.

    Parameters
    ----------
    period
        Period of the base motion.
    terms
        Harmonic terms of the base motion, see `set_accelerations`.
    numbers
        Parameters of the model.
    change
        Derivatives of the period and of `numbers`.
    term_change
        Derivatives of the `terms`.
    """

    period: float
    terms: Table
    numbers: Vector
    change: Vector
    term_change: Table


class Room(NamedTuple):
    """Arrays for intermediate results: of an evaluation of the equations, and of the error of a step."""

    push: Vector
    push_change: Vector
    rates: Vector
    jacobian: Table
    error5: Table
    error3: Table


# Equations of the model


def arguments_of(state: Vector, push: Vector, side: float, numbers: Vector) -> tuple[float, ...]:
    """Return the arguments of the rates and of their derivatives."""
    states = tuple(state[j] for j in range(ORDER))
    accelerations = tuple(push[k] for k in range(ACCELERATIONS))
    if PLANAR:
        return (*states, side, *accelerations, *parameters_of(numbers))
    return (*states, *accelerations, *parameters_of(numbers))


def parameters_of(numbers: Vector) -> tuple[float, ...]:
    """Return the parameters of the model."""
    return tuple(numbers[j] for j in range(NUMBERS))


def rates_into(state: Vector, push: Vector, side: float, numbers: Vector, out: Vector) -> None:
    """Set the rates of a state."""
    for j, rate in enumerate(rates(*arguments_of(state, push, side, numbers))):
        out[j] = rate


def jacobian_into(state: Vector, push: Vector, side: float, numbers: Vector, out: Table) -> None:
    """Set the derivatives of the rates; the columns are those of states, accelerations and parameters."""
    for i, row in enumerate(jacobian(*arguments_of(state, push, side, numbers))):
        for j, derivative in enumerate(row):
            out[i, j] = derivative


def lean_of(state: Vector, numbers: Vector) -> tuple[float, float, float, float]:
    """Return the tilt vector and its rate; along x if planar."""
    if PLANAR:
        return state[0], 0.0, state[1], 0.0
    return tilt_of(*tuple(state[j] for j in range(ORDER)), *parameters_of(numbers))


def speed_after_passage(rate: float, numbers: Vector) -> float:
    """Return the tilt rate after a planar passage through the vertical."""
    if not LOSES:
        return rate
    parameters = parameters_of(numbers)
    state = impact_map(*from_plane(0.0, rate, 1.0, 0.0, *parameters), *parameters)
    _, _, vx, _ = tilt_of(*state, *parameters)
    return vx


def loss_slope(rate: float, numbers: Vector) -> float:
    """Return the derivative of `speed_after_passage` by the tilt rate before, by five points."""
    if not LOSES:
        return 1.0
    h = SPEED_STEP * rate
    near = speed_after_passage(rate + h, numbers) - speed_after_passage(rate - h, numbers)
    far = speed_after_passage(rate + 2.0 * h, numbers) - speed_after_passage(rate - 2.0 * h, numbers)
    return (8.0 * near - far) / (12.0 * h)


# Steps


def set_accelerations(s: float, system: System, room: Room) -> None:
    """Set the accelerations at `s` turns, and their derivatives with respect to the parameter.

    A row of the terms has a multiple of the frequency, then pairs of coefficients of cosine and sine.
    """
    terms, term_change = system.terms, system.term_change
    for k in range(ACCELERATIONS):
        room.push[k] = room.push_change[k] = 0.0
    for term in range(len(terms)):
        angle = 2.0 * math.pi * terms[term, 0] * s
        cos, sin = math.cos(angle), math.sin(angle)
        for k in range(ACCELERATIONS):
            room.push[k] += terms[term, 1 + 2 * k] * cos + terms[term, 2 + 2 * k] * sin
            room.push_change[k] += term_change[term, 1 + 2 * k] * cos + term_change[term, 2 + 2 * k] * sin


@fast
def slopes_into(y: Table, s: float, side: float, system: System, room: Room, out: Table) -> None:
    """Set the rates of state and derivatives per turn of the base motion."""
    set_accelerations(s, system, room)
    rates_into(y[:, 0], room.push, side, system.numbers, room.rates)
    jacobian_into(y[:, 0], room.push, side, system.numbers, room.jacobian)
    for i in range(ORDER):
        for column in lanes(COLUMNS):
            total = sum(room.jacobian[i, j] * y[j, column] for j in range(ORDER))
            out[i, column] = system.period * total
        out[i, 0] = system.period * room.rates[i]
        change = 0.0
        for k in range(ACCELERATIONS):
            change += room.jacobian[i, ORDER + k] * room.push_change[k]
        for k in range(NUMBERS):
            change += room.jacobian[i, ORDER + ACCELERATIONS + k] * system.change[1 + k]
        out[i, ORDER + 1] += system.period * change + system.change[0] * room.rates[i]


def make_step(
    y: Table, s: float, h: float, side: float, system: System, room: Room, k: npt.NDArray[np.float64], new: Table
) -> None:
    """Make a step of length `h` to `new`; `k[0]` holds the slopes at its start, `k[-1]` gets those at its end."""
    for stage in STAGE_NUMBERS:
        set_stage(y, h, stage, k, new)
        slopes_into(new, s + NODES[stage] * h, side, system, room, k[stage])


@fast
def set_stage(y: Table, h: float, stage: int, k: npt.NDArray[np.float64], new: Table) -> None:
    """Set the state at a stage from the slopes of the earlier ones."""
    for i in range(ORDER):
        for column in lanes(COLUMNS):
            slopes = tuple(k[earlier, i, column] for earlier in range(stage))
            new[i, column] = y[i, column] + h * weighted(WEIGHTS[stage], slopes)


@fast
def error_of(y: Table, new: Table, h: float, k: npt.NDArray[np.float64], room: Room, rtol: float, atol: float) -> float:
    """Return the error of a step over its tolerance; the derivative with respect to a parameter is not included."""
    for i in range(ORDER):
        for column in lanes(COLUMNS):
            slopes = tuple(k[stage, i, column] for stage in range(STAGES + 1))
            room.error5[i, column] = weighted(E5, slopes)
            room.error3[i, column] = weighted(E3, slopes)
    e5 = e3 = 0.0
    for i in range(ORDER):
        for column in range(ORDER + 1):
            floor = atol if column == 0 else rtol
            scale = 1.0 / (floor + rtol * max(abs(y[i, column]), abs(new[i, column])))
            e5 += (room.error5[i, column] * scale) ** 2
            e3 += (room.error3[i, column] * scale) ** 2
    spread = e5 + 0.01 * e3
    # NaN is kept, so that the step is rejected.
    return 0.0 if spread == 0.0 else abs(h) * e5 / math.sqrt(spread * ORDER * (ORDER + 1))


def record_tilt(y: Table, new: Table, duration: float, numbers: Vector, record: Vector) -> float:
    """Record the minimum and maximum tilt of a step, by a cubic through the squares at its ends.

    Return the fraction of the step at which the cubic has an extreme, or 0 if it has none.
    """
    x, z, vx, vz = lean_of(y[:, 0], numbers)
    start, slope = x * x + z * z, 2.0 * duration * (x * vx + z * vz)
    x, z, vx, vz = lean_of(new[:, 0], numbers)
    end, end_slope = x * x + z * z, 2.0 * duration * (x * vx + z * vz)
    least, largest, at = min(start, end), max(start, end), 0.0
    if slope * end_slope < 0.0:
        at, extreme = turning_point(start, end, slope, end_slope, 1.0 if slope > 0.0 else -1.0)
        least, largest = min(least, extreme), max(largest, extreme)
    record[FlowLog.LEAST_TILT] = min(record[FlowLog.LEAST_TILT], math.sqrt(max(least, 0.0)))
    record[FlowLog.PEAK_TILT] = max(record[FlowLog.PEAK_TILT], math.sqrt(largest))
    return at


def count_turns(y: Table, new: Table, numbers: Vector, record: Vector) -> None:
    """Count the passages of the tilt vector across the negative x axis, anticlockwise minus clockwise."""
    x0, y0, vx0, vy0 = lean_of(y[:, 0], numbers)
    x1, y1, vx1, vy1 = lean_of(new[:, 0], numbers)
    record[FlowLog.TURNS] += winding(x0, y0, x1, y1, x0 * vy0 - y0 * vx0 + x1 * vy1 - y1 * vx1)


def record_extremes(
    y: Table,
    s: float,
    h: float,
    side: float,
    system: System,
    room: Room,
    k: npt.NDArray[np.float64],
    new: Table,
    near: npt.NDArray[np.float64],
    middle: Table,
    record: Vector,
) -> None:
    """Record the extremes of the tilt within a step; `near` and `middle` are arrays for another step.

    A cubic over the whole step has an accuracy of only 1e-4, so that an extreme is computed again from a state near it.
    """
    least, largest = record[FlowLog.LEAST_TILT], record[FlowLog.PEAK_TILT]
    at = record_tilt(y, new, system.period * h, system.numbers, record)
    if 0.0 < at < 1.0:
        record[FlowLog.LEAST_TILT], record[FlowLog.PEAK_TILT] = least, largest
        near[0] = k[0]
        make_step(y, s, at * h, side, system, room, near, middle)
        record_tilt(y, middle, system.period * at * h, system.numbers, record)
        record_tilt(middle, new, system.period * (1.0 - at) * h, system.numbers, record)


def step_to_vertical(
    y: Table,
    s: float,
    h: float,
    side: float,
    system: System,
    room: Room,
    k: npt.NDArray[np.float64],
    new: Table,
) -> float:
    """Shorten a step that has passed the vertical until it ends there; return its length."""
    low, high = 0.0, h
    for _ in range(MOST_TRIES):
        aside = side * new[0, 0]
        if abs(aside) < MET or high - low <= 1e-16 * high:
            break
        if aside >= 0.0:
            low = h
        else:
            high = h
        # Newton's step, or the midpoint if Newton's step leaves the bracket.
        speed = side * k[STAGES, 0, 0]
        h = h - aside / speed if speed < 0.0 else low
        h = h if low < h < high else 0.5 * (low + high)
        make_step(y, s, h, side, system, room, k, new)
    return h


def cross_vertical_of_flow(y: Table, s: float, side: float, system: System, room: Room) -> bool:
    """Pass the vertical in planar motion: speed, acceleration and derivatives jump; return False at a grazing passage.

    With the loss v⁺ = f(v⁻) the derivatives are multiplied by the saltation matrix
    ((v⁺/v⁻, 0), ((a⁺ − f' a⁻)/v⁻, f')).
    """
    numbers, push = system.numbers, room.push
    before, after = np.zeros(ORDER), np.zeros(ORDER)
    y[0, 0] = 0.0
    speed = y[1, 0]
    if speed * side >= 0.0:
        return False
    set_accelerations(s, system, room)
    rates_into(y[:, 0], push, side, numbers, before)
    left = speed_after_passage(speed, numbers)
    kept_part, slope = left / speed, loss_slope(speed, numbers)
    y[1, 0] = left
    rates_into(y[:, 0], push, -side, numbers, after)
    jump = (after[1] - slope * before[1]) / speed
    for column in range(1, ORDER + 2):
        y[1, column] = slope * y[1, column] + jump * y[0, column]
        y[0, column] *= kept_part
    # Derivative of the loss itself with respect to the parameter.
    larger, smaller = np.zeros(NUMBERS), np.zeros(NUMBERS)
    for j in range(NUMBERS):
        larger[j] = numbers[j] + LOSS_STEP * system.change[1 + j]
        smaller[j] = numbers[j] - LOSS_STEP * system.change[1 + j]
    y[1, ORDER + 1] += (speed_after_passage(speed, larger) - speed_after_passage(speed, smaller)) / (2.0 * LOSS_STEP)
    return True


def azimuth(y: Table, numbers: Vector) -> float:
    """Return the azimuth of the tilt vector [turns], −½ to ½; 0 if planar."""
    if PLANAR:
        return 0.0
    x, z, _, _ = lean_of(y[:, 0], numbers)
    return math.atan2(z, x) / (2.0 * math.pi)


def flow(
    y: Table,
    begin: float,
    end: float,
    period: float,
    terms: Table,
    numbers: Vector,
    change: Vector,
    term_change: Table,
    limits: Vector,
    record: Vector,
) -> int:
    """Integrate `y` from `begin` to `end` [turns of the base motion]; return the `FlowStatus`.

    `limits` are the relative and absolute tolerance, and the minimum and maximum tilt. `record` has the places of
    `FlowLog`.
    """
    before = azimuth(y, numbers)
    status = follow(y, begin, end, System(period, terms, numbers, change, term_change), limits, record)
    record[FlowLog.TURNS] += azimuth(y, numbers) - before
    return status


def follow(y: Table, begin: float, end: float, system: System, limits: Vector, record: Vector) -> int:
    """Integrate `y` as `flow` does; of the turns only passages across the negative x axis are counted."""
    rtol, atol, least, largest = limits
    room = Room(
        push=np.zeros(ACCELERATIONS),
        push_change=np.zeros(ACCELERATIONS),
        rates=np.zeros(ORDER),
        jacobian=np.zeros((ORDER, ORDER + ACCELERATIONS + NUMBERS)),
        error5=np.zeros((ORDER, COLUMNS)),
        error3=np.zeros((ORDER, COLUMNS)),
    )
    k, new = np.zeros((STAGES + 1, ORDER, COLUMNS)), np.zeros((ORDER, COLUMNS))
    near, middle = np.zeros((STAGES + 1, ORDER, COLUMNS)), np.zeros((ORDER, COLUMNS))
    side = record[FlowLog.SIDE]
    s, h = begin, min(FIRST_STEP, end - begin)
    rejected = False
    slopes_into(y, s, side, system, room, k[0])
    while s < end:
        too_short = h < SHORTEST_STEP * max(1.0, abs(s)) and end - s > h
        if too_short or record[FlowLog.STEPS] >= MOST_STEPS:
            return FlowStatus.FAILED
        last = h >= end - s
        h = end - s if last else h
        make_step(y, s, h, side, system, room, k, new)
        error = error_of(y, new, h, k, room, rtol, atol)
        if not error < 1.0:
            h *= max(LEAST_FACTOR, SAFETY / error**0.125) if error < math.inf else LEAST_FACTOR
            rejected = True
            continue
        passed = PLANAR and side * new[0, 0] < 0.0
        if passed:
            h = step_to_vertical(y, s, h, side, system, room, k, new)
        record_extremes(y, s, h, side, system, room, k, new, near, middle, record)
        if passed:
            record[FlowLog.LEAST_TILT] = 0.0
            record[FlowLog.STEPS] += 1
            s += h
            y[:, :] = new
            if not cross_vertical_of_flow(y, s, side, system, room):
                return FlowStatus.LOST
            side = record[FlowLog.SIDE] = -side
            slopes_into(y, s, side, system, room, k[0])
            h, rejected = FIRST_STEP, False
            continue
        if not PLANAR:
            count_turns(y, new, system.numbers, record)
        s = end if last else s + h
        record[FlowLog.STEPS] += 1
        y[:, :] = new
        k[0] = k[STAGES]
        factor = min(LARGEST_FACTOR, max(LEAST_FACTOR, SAFETY / max(error, LEAST_ERROR) ** 0.125))
        h = min(h * (min(factor, 1.0) if rejected else factor), LONGEST_STEP)
        rejected = False
        if record[FlowLog.PEAK_TILT] > largest:
            return FlowStatus.GONE
        if record[FlowLog.LEAST_TILT] < least and not PLANAR:
            return FlowStatus.LOST
    return FlowStatus.DONE
