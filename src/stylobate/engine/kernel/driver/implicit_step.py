"""Implicit step of a lane by Radau IIA."""

import math

import numpy as np

from stylobate.engine.elementary import NewtonRoom, factor, solve
from stylobate.engine.kernel.bound import CHANGES, ORDER, SLIP_X, SLIP_Y, R, Row, Table
from stylobate.engine.kernel.driver.equations import rates_at, row_state
from stylobate.engine.kernel.driver.stages import dense_state
from stylobate.engine.kernel.shape import DENSE_TERMS
from stylobate.engine.tolerances import SLIP_SHARE

_ROOT = math.sqrt(6.0)

STAGES = 3

NODES = np.array([(4.0 - _ROOT) / 10.0, (4.0 + _ROOT) / 10.0, 1.0])
"""Fractions of a step at which the equations hold."""


def _slopes() -> tuple[tuple[float, ...], ...]:
    """Return the slopes at the nodes of cubics that are 0 at the start and 1 at one node (barycentric formula)."""
    places = [0.0, *NODES.tolist()]
    weights = [1.0 / math.prod(x - other for other in places if other != x) for x in places]
    return tuple(
        tuple(
            sum(1.0 / (x - other) for other in places if other != x) if j == i else weights[j] / weights[i] / (x - y)
            for j, y in enumerate(places[1:], 1)
        )
        for i, x in enumerate(places[1:], 1)
    )


SLOPES = np.array(_slopes())
"""A⁻¹: maps the changes from the start to the nodes to the slopes of their cubic at the nodes, in units of 1/h."""

REAL = 3.0 + 3.0 ** (2.0 / 3.0) - 3.0 ** (1.0 / 3.0)
TURNED_REAL = 0.5 * (9.0 - REAL)
TURNED_IMAGINARY = math.sqrt(60.0 / REAL - TURNED_REAL * TURNED_REAL)
"""γ, α and β: the eigenvalues γ and α ± iβ of A⁻¹, the roots of s³ − 9s² + 36s − 60."""


def _eigenvector(value: complex) -> list[complex]:
    """Return the eigenvector of A⁻¹ for an eigenvalue; its last component is 1."""
    first, second = SLOPES[:2, :2] - value * np.eye(2)
    one, two = -SLOPES[:2, 2]
    per = 1.0 / (first[0] * second[1] - first[1] * second[0])
    return [(one * second[1] - two * first[1]) * per, (two * first[0] - one * second[0]) * per, 1.0]


_TURNED = np.array(_eigenvector(complex(TURNED_REAL, TURNED_IMAGINARY)))
MODES = np.array([_eigenvector(REAL), _TURNED.real, _TURNED.imag]).T
"""Columns v, u and w: the eigenvectors v of γ and u + iw of α + iβ. Changes at the nodes are sums of these."""

TO_MODES, WEIGHTS = np.linalg.inv(MODES), np.linalg.inv(SLOPES)
"""Inverse of `MODES`, and A."""

ERROR = np.array([-(13.0 + 7.0 * _ROOT) / 3.0, -(13.0 - 7.0 * _ROOT) / 3.0, -1.0 / 3.0])
"""Weights of the changes at the nodes in the error estimate of order 3."""


# Difference step of a state as a fraction of the slip velocity, with whose direction the rates rotate; its maximum;
# and its minimum for states that are not slip velocities, whose rounding makes rates jump.
PART_OF_SLIP, LARGEST_DIFFERENCE, LEAST_DIFFERENCE = 1e-3, 1e-7, 1e-12
# Maximum number of Newton iterations; they end below this fraction of the tolerance, or below the root of the relative
# tolerance if that is smaller, but not below the last number over the relative tolerance.
MOST_ITERATIONS, WELL_SOLVED, SOLVED_ROUNDINGS = 7, 0.03, 2e-15
# Products with the Jacobian before four more that measure the growth; slower components have faded by then.
FADING = 4


def set_jacobian(buf: Table, i: int, number: int, room: NewtonRoom) -> int:
    """Set the Jacobian of the rates by differences from the slopes at the state; return the number of coupled states.

    Column k belongs to the state `room.coupled[k]`. With `number` 0 the coupled states are found again: those on which
    rates depend. The kind of contact is constant.
    """
    jacobian, coupled = room.jacobian, room.coupled
    t = buf[R.TIME, i]
    slip = max(math.hypot(buf[R.STATE + SLIP_X, i], buf[R.STATE + SLIP_Y, i]), SLIP_SHARE * buf[R.ATOL_NOW, i])
    small = min(PART_OF_SLIP * slip, LARGEST_DIFFERENCE)
    for j in range(ORDER):
        buf[R.NEW + j, i] = buf[R.STATE + j, i]
    found = 0
    for k in range(number if number > 0 else ORDER - 1):
        column = int(coupled[k]) if number > 0 else k
        here = buf[R.STATE + column, i]
        least = 0.0 if column in (SLIP_X, SLIP_Y) else LEAST_DIFFERENCE * (1.0 + abs(here))
        buf[R.NEW + column, i] = here + max(small, least)
        per = 1.0 / (buf[R.NEW + column, i] - here)
        rates = rates_at(buf, i, t, row_state(buf, i, R.NEW))
        size = 0.0
        for j in range(ORDER):
            jacobian[j, found] = (rates[j] - buf[R.SLOPE + j, i]) * per
            size += abs(jacobian[j, found])
        if number > 0 or size != 0.0:  # NaN counts too
            coupled[found] = column
            found += 1
        buf[R.NEW + column, i] = here
    return found


def fastest_rate(number: int, room: NewtonRoom) -> float:
    """Estimate the largest modulus of the eigenvalues of the Jacobian by power iteration."""
    vector, product = np.zeros(ORDER), np.zeros(ORDER)
    for row in range(number):
        vector[row] = 1.0
    growth = 1.0
    for power in range(FADING + 4):
        square = 0.0
        for row in range(number):
            j, total = int(room.coupled[row]), 0.0
            for column in range(number):
                total += room.jacobian[j, column] * vector[column]
            product[row] = total
            square += total * total
        size = math.sqrt(square)
        if not 0.0 < size < math.inf:
            return size
        for row in range(number):
            vector[row] = product[row] / size
        if power >= FADING:
            growth *= math.sqrt(math.sqrt(size))
    return growth


# Newton's equations (A⁻¹/h ⊗ I − I ⊗ J) δ = r fall apart in the modes of A⁻¹: (γ/h − J) δ₀ = r₀ and, with the complex
# eigenvalue α + iβ, (α/h − J) δ₁ + β/h δ₂ = r₁ and −β/h δ₁ + (α/h − J) δ₂ = r₂. They are solved for the coupled states;
# the others follow from these at the end.


def solve_step(buf: Table, i: int, h: float, number: int, room: NewtonRoom) -> int:
    """Solve the equations of a step from a guess of its changes; return the number of iterations, or 0 on failure."""
    change, correction = room.change, room.correction
    if not factor_matrices(h, number, room):
        return 0
    rtol = buf[R.RTOL, i]
    tolerance = max(SOLVED_ROUNDINGS / rtol, min(WELL_SOLVED, math.sqrt(rtol)))
    before = math.inf
    for iteration in range(1, MOST_ITERATIONS + 1):
        set_defect(buf, i, h, change, correction)
        correct(number, room)
        size = size_of_correction(buf, i, number, room)
        ratio = size / before
        ahead = size if iteration == 1 else size * ratio / (1.0 - ratio)
        if not ratio < 1.0 or ahead * ratio ** float(MOST_ITERATIONS - iteration) > tolerance:
            return 0
        done = ahead < tolerance and (iteration > 1 or size == 0.0)
        if done:
            correct_others(h, number, room)
        for row in range(ORDER if done else number):
            j = row if done else int(room.coupled[row])
            for stage in range(STAGES):
                change[stage * ORDER + j] += correction[stage * ORDER + j]
        if done:
            return iteration
        before = size
    return 0


def factor_matrices(h: float, number: int, room: NewtonRoom) -> bool:
    """Factor the matrices of Newton's method for the coupled states; return False if one is singular."""
    single, double = room.single, room.double
    turn = TURNED_IMAGINARY / h
    for row in range(number):
        j = int(room.coupled[row])
        for column in range(number):
            rate = room.jacobian[j, column]
            diagonal = 1.0 if row == column else 0.0
            single[row, column] = diagonal * (REAL / h) - rate
            double[row, column] = diagonal * (TURNED_REAL / h) - rate
            double[number + row, number + column] = double[row, column]
            double[row, number + column] = diagonal * turn
            double[number + row, column] = -diagonal * turn
    return factor(single, room.single_pivots, number) and factor(double, room.double_pivots, 2 * number)


def correct(number: int, room: NewtonRoom) -> None:
    """Replace the defects r of the coupled states at the nodes, in `room.correction`, by the corrections δ."""
    correction, real, turned = room.correction, room.real, room.turned
    for row in range(number):
        j = int(room.coupled[row])
        one, two, three = correction[j], correction[ORDER + j], correction[2 * ORDER + j]
        real[row] = TO_MODES[0, 0] * one + TO_MODES[0, 1] * two + TO_MODES[0, 2] * three
        turned[row] = TO_MODES[1, 0] * one + TO_MODES[1, 1] * two + TO_MODES[1, 2] * three
        turned[number + row] = TO_MODES[2, 0] * one + TO_MODES[2, 1] * two + TO_MODES[2, 2] * three
    solve(room.single, room.single_pivots, real, number)
    solve(room.double, room.double_pivots, turned, 2 * number)
    for row in range(number):
        j = int(room.coupled[row])
        for stage in range(STAGES):
            parts = MODES[stage, 1] * turned[row] + MODES[stage, 2] * turned[number + row]
            correction[stage * ORDER + j] = MODES[stage, 0] * real[row] + parts


def correct_others(h: float, number: int, room: NewtonRoom) -> None:
    """Replace the defects r of the states on which no rate depends by their corrections δ = h A (r + J δ)."""
    correction, real = room.correction, room.real
    coupled = 0
    for j in range(ORDER):
        if coupled < number and room.coupled[coupled] == j:
            coupled += 1
            continue
        for stage in range(STAGES):
            real[stage] = correction[stage * ORDER + j]
            for row in range(number):
                real[stage] += room.jacobian[j, row] * correction[stage * ORDER + int(room.coupled[row])]
        for stage in range(STAGES):
            parts = WEIGHTS[stage, 1] * real[1] + WEIGHTS[stage, 2] * real[2]
            correction[stage * ORDER + j] = h * (WEIGHTS[stage, 0] * real[0] + parts)


def set_defect(buf: Table, i: int, h: float, change: Row, defect: Row) -> None:
    """Set the differences between the rates at the nodes and the slopes of the cubic through these changes."""
    t = buf[R.TIME, i]
    for stage in range(STAGES):
        first = stage * ORDER
        for j in range(ORDER):
            buf[R.NEW + j, i] = buf[R.STATE + j, i] + change[first + j]
        rates = rates_at(buf, i, t + NODES[stage] * h, row_state(buf, i, R.NEW))
        for j in range(ORDER):
            slope = 0.0
            for other in range(STAGES):
                slope += SLOPES[stage, other] * change[other * ORDER + j]
            defect[first + j] = rates[j] - slope / h


def absolute_tolerance(buf: Table, i: int, j: int) -> float:
    """Return the absolute tolerance of a state while a contact slips."""
    return buf[R.ATOL_NOW, i] * (SLIP_SHARE if j in (SLIP_X, SLIP_Y) else 1.0)


def size_of_correction(buf: Table, i: int, number: int, room: NewtonRoom) -> float:
    """Return the mean size of the corrections of the coupled states, in tolerances."""
    correction, total = room.correction, 0.0
    for row in range(number):
        j = int(room.coupled[row])
        scale = absolute_tolerance(buf, i, j) + buf[R.RTOL, i] * abs(buf[R.STATE + j, i])
        for stage in range(STAGES):
            part = correction[stage * ORDER + j] / scale
            total += part * part
    return math.sqrt(total / CHANGES)


def error_of_changes(buf: Table, i: int, h: float, slopes: tuple[float, ...], number: int, room: NewtonRoom) -> float:
    """Return the error of a step in tolerances, and store its components in the first third of `room.correction`.

    `slopes` are the rates at the start. The error is (γ/h − J)⁻¹ times a combination of these and of the changes.
    """
    change, error, real = room.change, room.correction, room.real
    for j in range(ORDER):
        defect = slopes[j]
        for stage in range(STAGES):
            defect += ERROR[stage] * change[stage * ORDER + j] / h
        error[j] = defect
    for row in range(number):
        real[row] = error[int(room.coupled[row])]
    solve(room.single, room.single_pivots, real, number)
    total, last, coupled = 0.0, CHANGES - ORDER, 0
    for j in range(ORDER):
        if coupled < number and room.coupled[coupled] == j:
            error[j] = real[coupled]
            coupled += 1
        else:
            for row in range(number):
                error[j] += room.jacobian[j, row] * real[row]
            error[j] *= h / REAL
        here = buf[R.STATE + j, i]
        size = max(abs(here), abs(here + change[last + j]))
        part = error[j] / (absolute_tolerance(buf, i, j) + buf[R.RTOL, i] * size)
        total += part * part
    return math.sqrt(total / ORDER)


def damped_error(buf: Table, i: int, h: float, number: int, room: NewtonRoom) -> float:
    """Return the error estimate with rates at the corrected start, for an estimate that is stiff itself."""
    for j in range(ORDER):
        buf[R.NEW + j, i] = buf[R.STATE + j, i] + room.correction[j]
    slopes = rates_at(buf, i, buf[R.TIME, i], row_state(buf, i, R.NEW))
    return error_of_changes(buf, i, h, slopes, number, room)


def set_cubic(buf: Table, i: int, change: Row) -> None:
    """Set the dense output of a step to the cubic through its changes; see `dense_state` for the form."""
    c0, c1 = NODES[0], NODES[1]
    for j in range(ORDER):
        whole = change[2 * ORDER + j]
        first = (change[j] / c0 - whole) / (1.0 - c0)
        second = (change[ORDER + j] / c1 - whole) / (1.0 - c1)
        bend = (first - second) / (c0 - c1)
        buf[R.DENSE + j, i] = whole
        buf[R.DENSE + ORDER + j, i] = first - c0 * bend
        buf[R.DENSE + 2 * ORDER + j, i] = bend
        for power in range(3, DENSE_TERMS):
            buf[R.DENSE + power * ORDER + j, i] = 0.0


def guess_changes(buf: Table, i: int, ratio: float, change: Row) -> None:
    """Extrapolate the changes from the cubic of the previous step, by the `ratio` of the lengths; 0 means no step."""
    for n in range(CHANGES):
        change[n] = 0.0
    for stage in range(STAGES if ratio > 0.0 else 0):
        ahead = dense_state(buf, i, 1.0 + NODES[stage] * ratio)
        for j in range(ORDER):
            change[stage * ORDER + j] = ahead[j] - (buf[R.STATE + j, i] + buf[R.DENSE + j, i])
