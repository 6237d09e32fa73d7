"""Integration of a model's motion, with its derivatives, over a part of the period of the base motion.

The state of order n is the first column of a matrix of n rows. The next columns are its derivatives with respect to the
initial state and to one parameter of the system. `flows` binds the open names to a model.

DOP853: E. Hairer, S. P. Nørsett, G. Wanner, "Solving Ordinary Differential Equations I", 2nd ed., section II.5.
"""

import math

import numpy as np
import numpy.typing as npt

from stylobate.engine.elementary import turning_point, winding
from stylobate.engine.flow.bound import (
    ACCELERATIONS,
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
from stylobate.engine.flow.tableau import DOP_A, DOP_C, DOP_E3, DOP_E5, Status

Table = npt.NDArray[np.float64]
Vector = npt.NDArray[np.float64]

# Step control as in SciPy: safety factor, bounds of the step ratio, and lower bound of the error.
SAFETY, LEAST_FACTOR, LARGEST_FACTOR, LEAST_ERROR = 0.9, 0.2, 10.0, 1e-12
# Steps in turns of the base motion.
FIRST_STEP, LONGEST_STEP, SHORTEST_STEP = 0.01, 0.125, 1e-13
MOST_STEPS = 200_000
# Tolerance of the tilt at a passage through the vertical [units of c], and maximum number of iterations.
MET, MOST_TRIES = 1e-15, 60
# Difference step for the derivative of the loss at a passage, as a fraction of the change of the parameters.
LOSS_STEP = 1e-6


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
    found = rates(*arguments_of(state, push, side, numbers))
    for j in range(ORDER):
        out[j] = found[j]


def jacobian_into(state: Vector, push: Vector, side: float, numbers: Vector, out: Table) -> None:
    """Set the derivatives of the rates; the columns are those of states, accelerations and parameters."""
    rows = jacobian(*arguments_of(state, push, side, numbers))
    for i in range(ORDER):
        for j in range(ORDER + ACCELERATIONS + NUMBERS):
            out[i, j] = rows[i][j]


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


# Steps


def accelerations_into(s: float, terms: Table, out: Vector) -> None:
    """Set the accelerations at `s` turns; a row of `terms` has a multiple of the frequency, then pairs cos, sin."""
    for k in range(ACCELERATIONS):
        out[k] = 0.0
    for term in range(len(terms)):
        angle = 2.0 * math.pi * terms[term, 0] * s
        cos, sin = math.cos(angle), math.sin(angle)
        for k in range(ACCELERATIONS):
            out[k] += terms[term, 1 + 2 * k] * cos + terms[term, 2 + 2 * k] * sin


def slopes_into(
    y: Table,
    s: float,
    side: float,
    period: float,
    terms: Table,
    numbers: Vector,
    change: Vector,
    term_change: Table,
    work: Table,
    out: Table,
) -> None:
    """Set the rates of state and derivatives per turn of the base motion.

    `change` holds the changes of the period and of the model parameters, `term_change` the changes of the terms.
    """
    push, push_change, rates = work[0], work[1], work[2]
    jacobian = work[3:]
    accelerations_into(s, terms, push)
    accelerations_into(s, term_change, push_change)
    rates_into(y[:, 0], push, side, numbers, rates)
    jacobian_into(y[:, 0], push, side, numbers, jacobian)
    for i in range(ORDER):
        out[i, 0] = period * rates[i]
        for column in range(1, ORDER + 2):
            total = 0.0
            for j in range(ORDER):
                total += jacobian[i, j] * y[j, column]
            out[i, column] = period * total
        total = 0.0
        for k in range(ACCELERATIONS):
            total += jacobian[i, ORDER + k] * push_change[k]
        for k in range(NUMBERS):
            total += jacobian[i, ORDER + ACCELERATIONS + k] * change[1 + k]
        out[i, ORDER + 1] += period * total + change[0] * rates[i]


def stages_into(
    y: Table,
    s: float,
    h: float,
    side: float,
    period: float,
    terms: Table,
    numbers: Vector,
    change: Vector,
    term_change: Table,
    work: Table,
    k: npt.NDArray[np.float64],
    new: Table,
) -> None:
    """Make a step of length `h` to `new`; `k[0]` holds the slopes at its start, `k[12]` receives those at its end."""
    for stage in range(1, 13):
        for i in range(ORDER):
            for column in range(ORDER + 2):
                total = 0.0
                for before in range(stage):
                    total += DOP_A[stage, before] * k[before, i, column]
                new[i, column] = y[i, column] + h * total
        slopes_into(new, s + DOP_C[stage] * h, side, period, terms, numbers, change, term_change, work, k[stage])


def error_of(y: Table, new: Table, h: float, k: npt.NDArray[np.float64], rtol: float, atol: float) -> float:
    """Return the error of a step over its tolerance; the derivative with respect to a parameter is not included."""
    e5 = e3 = 0.0
    for i in range(ORDER):
        for column in range(ORDER + 1):
            q5 = q3 = 0.0
            for stage in range(13):
                q5 += DOP_E5[stage] * k[stage, i, column]
                q3 += DOP_E3[stage] * k[stage, i, column]
            floor = atol if column == 0 else rtol
            scale = floor + rtol * max(abs(y[i, column]), abs(new[i, column]))
            e5 += (q5 / scale) ** 2
            e3 += (q3 / scale) ** 2
    spread = e5 + 0.01 * e3
    return abs(h) * e5 / math.sqrt(spread * ORDER * (ORDER + 1)) if spread > 0.0 else 0.0


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
    record[0] = min(record[0], math.sqrt(max(least, 0.0)))
    record[1] = max(record[1], math.sqrt(largest))
    return at


def count_turns(y: Table, new: Table, numbers: Vector, record: Vector) -> None:
    """Count the passages of the tilt vector across the negative x axis, anticlockwise minus clockwise."""
    x0, y0, vx0, vy0 = lean_of(y[:, 0], numbers)
    x1, y1, vx1, vy1 = lean_of(new[:, 0], numbers)
    record[4] += winding(x0, y0, x1, y1, x0 * vy0 - y0 * vx0 + x1 * vy1 - y1 * vx1)


def record_extremes(
    y: Table,
    s: float,
    h: float,
    side: float,
    period: float,
    terms: Table,
    numbers: Vector,
    change: Vector,
    term_change: Table,
    work: Table,
    k: npt.NDArray[np.float64],
    new: Table,
    near: npt.NDArray[np.float64],
    middle: Table,
    record: Vector,
) -> None:
    """Record the extremes of the tilt within a step; `near` and `middle` are work arrays for another step.

    A cubic over the whole step has an accuracy of only 1e-4, so that an extreme is computed again from a state near it.
    """
    least, largest = record[0], record[1]
    at = record_tilt(y, new, period * h, numbers, record)
    if 0.0 < at < 1.0:
        record[0], record[1] = least, largest
        near[0] = k[0]
        stages_into(y, s, at * h, side, period, terms, numbers, change, term_change, work, near, middle)
        record_tilt(y, middle, period * at * h, numbers, record)
        record_tilt(middle, new, period * (1.0 - at) * h, numbers, record)


def step_to_vertical(
    y: Table,
    s: float,
    h: float,
    side: float,
    period: float,
    terms: Table,
    numbers: Vector,
    change: Vector,
    term_change: Table,
    work: Table,
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
        speed = side * k[12, 0, 0]
        h = h - aside / speed if speed < 0.0 else low
        h = h if low < h < high else 0.5 * (low + high)
        stages_into(y, s, h, side, period, terms, numbers, change, term_change, work, k, new)
    return h


def cross_vertical(y: Table, s: float, side: float, terms: Table, numbers: Vector, change: Vector, work: Table) -> bool:
    """Pass the vertical in planar motion: speed, acceleration and derivatives jump; return False at a grazing passage.

    With the loss v⁺ = e v⁻ the derivatives are multiplied by the saltation matrix ((e, 0), ((a⁺ − e a⁻)/v⁻, e)).
    """
    push, before, after = work[0], work[1], work[2]
    y[0, 0] = 0.0
    speed = y[1, 0]
    if speed * side >= 0.0:
        return False
    accelerations_into(s, terms, push)
    rates_into(y[:, 0], push, side, numbers, before)
    left = speed_after_passage(speed, numbers)
    kept_part = left / speed
    y[1, 0] = left
    rates_into(y[:, 0], push, -side, numbers, after)
    jump = (after[1] - kept_part * before[1]) / speed
    for column in range(1, ORDER + 2):
        y[1, column] = kept_part * y[1, column] + jump * y[0, column]
        y[0, column] *= kept_part
    # Derivative of the loss itself with respect to the parameter.
    larger, smaller = np.zeros(NUMBERS), np.zeros(NUMBERS)
    for j in range(NUMBERS):
        larger[j] = numbers[j] + LOSS_STEP * change[1 + j]
        smaller[j] = numbers[j] - LOSS_STEP * change[1 + j]
    y[1, ORDER + 1] += (speed_after_passage(speed, larger) - speed_after_passage(speed, smaller)) / (2.0 * LOSS_STEP)
    return True


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
    """Integrate `y` from `begin` to `end` [turns of the base motion]; return the `Status`.

    `limits`: relative and absolute tolerance, minimum and maximum tilt. `record`: minimum and maximum tilt so far,
    number of steps, side of the vertical (planar motion only), and passages across the negative x axis.
    """
    rtol, atol, least, largest = limits
    k = np.zeros((13, ORDER, ORDER + 2))
    work = np.zeros((3 + ORDER, ORDER + ACCELERATIONS + NUMBERS))
    new = np.zeros((ORDER, ORDER + 2))
    near, middle = np.zeros((13, ORDER, ORDER + 2)), np.zeros((ORDER, ORDER + 2))
    side = record[3]
    s, h = begin, min(FIRST_STEP, end - begin)
    rejected = False
    slopes_into(y, s, side, period, terms, numbers, change, term_change, work, k[0])
    while s < end:
        too_short = h < SHORTEST_STEP * max(1.0, abs(s)) and end - s > h
        if too_short or record[2] >= MOST_STEPS:
            return Status.FAILED
        last = h >= end - s
        h = end - s if last else h
        stages_into(y, s, h, side, period, terms, numbers, change, term_change, work, k, new)
        error = error_of(y, new, h, k, rtol, atol)
        if not error < 1.0:
            h *= max(LEAST_FACTOR, SAFETY / error**0.125) if error < math.inf else LEAST_FACTOR
            rejected = True
            continue
        passed = PLANAR and side * new[0, 0] < 0.0
        if passed:
            h = step_to_vertical(y, s, h, side, period, terms, numbers, change, term_change, work, k, new)
        record_extremes(y, s, h, side, period, terms, numbers, change, term_change, work, k, new, near, middle, record)
        if passed:
            record[0] = 0.0
            record[2] += 1
            s += h
            y[:, :] = new
            if not cross_vertical(y, s, side, terms, numbers, change, work):
                return Status.LOST
            side = record[3] = -side
            slopes_into(y, s, side, period, terms, numbers, change, term_change, work, k[0])
            h = FIRST_STEP
            continue
        if not PLANAR:
            count_turns(y, new, numbers, record)
        s = end if last else s + h
        record[2] += 1
        y[:, :] = new
        k[0] = k[12]
        factor = min(LARGEST_FACTOR, max(LEAST_FACTOR, SAFETY / max(error, LEAST_ERROR) ** 0.125))
        h = min(h * (min(factor, 1.0) if rejected else factor), LONGEST_STEP)
        rejected = False
        if record[1] > largest:
            return Status.GONE
        if record[0] < least and not PLANAR:
            return Status.LOST
    return Status.DONE
