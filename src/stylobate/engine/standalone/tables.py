"""Tables of base motions in the language of the compiler: the polynomials of records and of smooth motions.

The polynomials are those of `ensembles.polynomials`, to rounding.
"""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from stylobate.base_motions.base import ACCELERATION, DISPLACEMENT, VELOCITY
from stylobate.base_motions.record import Record
from stylobate.engine.ensembles.polynomials import (
    ACCURACY,
    ASIDE,
    HALVINGS,
    NO_JUMP,
    NODE_POINTS,
    POWERS_OF_SERIES,
    SERIES_OF_VALUES,
    TEST_POINTS,
    TESTS_OF_SERIES,
)
from stylobate.engine.forcing import least_rest_energy
from stylobate.engine.kernel.columns import Piece
from stylobate.engine.standalone.bases import AXES, COURSE, integrate, value_of

Rows = npt.NDArray[np.float64]

_TERMS = len(NODE_POINTS)
_ON_LINE = 8.0 * float(np.finfo(float).eps)
_REFINEMENTS = 6
"""Steps of Newton's method to an extreme of a polynomial."""


class Span:
    """Columns of the array in which `spanned` looks for two directions."""

    SIZE, X, Y, ASIDE, OTHER_X, OTHER_Y = range(6)


def record_table(samples: Rows, step: Any, scale: Any, rotation: Any, rows: Rows, out: Rows) -> Any:
    """Set the polynomials of a record that begins at t = 0, and the numbers of `Table`; return their number.

    Parameters
    ----------
    samples
        Accelerations, shape (n, 3) [m/s²]; scaled and rotated in place.
    step
        Time between samples [s].
    scale, rotation
        Factor, and rotation about the vertical [rad].
    rows
        Polynomials of degree 1, at least n.
    out
        Numbers of `Table`.
    """
    count, last = 0, len(samples) - 1
    begun = 0
    squares: Any = 0.0
    changes: Any = 0.0
    cos, sin = math.cos(rotation), math.sin(rotation)
    for k in range(len(samples)):
        x, y = scale * samples[k, 0], scale * samples[k, 1]
        samples[k, 0], samples[k, 1], samples[k, 2] = cos * x - sin * y, sin * x + cos * y, scale * samples[k, 2]
    for k in range(last):
        for axis in range(AXES):
            left, right = samples[k, axis], samples[k + 1, axis]
            squares += (left * left + left * right + right * right) / 3.0
            changes += (right - left) * (right - left)
        if k + 1 == last or _bends(samples, k + 1):
            _set_line(rows[count], begun * step, (k + 1) * step, samples[begun], samples[k + 1])
            begun, count = k + 1, count + 1
    end = last * step
    _set_line(rows[count], end, end + 1.0, np.zeros(AXES), np.zeros(AXES))
    count += 1
    _set_continued(rows, count)
    _set_later_bounds(rows, count)
    spanning = np.zeros(6)
    for _ in range(2):
        for k in range(len(samples)):
            _span(spanning, samples[k, 0], samples[k, 1])
    moves = squares > 0.0
    mean = math.sqrt(changes / squares) / step if moves else 0.0
    highest = 2.0 / step if moves else 0.0
    _set_numbers(out, rows, count, spanning, (end, 0.0, highest, mean, _LEAST_OF_RECORDS), _AT_REST)
    return count


_AT_REST = (0.0,) * (2 * AXES)
"""Velocity and displacement."""

_LEAST_OF_RECORDS = least_rest_energy(Record(samples=np.array([0.0, 1.0]), step=1.0))


def _bends(samples: Rows, k: Any) -> Any:
    """Return whether the slope of the acceleration changes at a sample."""
    bent = False
    for axis in range(AXES):
        before, after = samples[k, axis] - samples[k - 1, axis], samples[k + 1, axis] - samples[k, axis]
        bent = bent or after - before != 0.0
    return bent


def _set_line(row: Rows, start: Any, end: Any, first: Rows, last: Rows) -> None:
    """Set a linear piece, its bounds those of its own ends."""
    horizontal = max(np.hypot(first[0], first[1]), np.hypot(last[0], last[1]))
    _set_head(row, start, end, horizontal, min(first[2], last[2]), max(first[2], last[2]))
    for axis in range(AXES):
        row[len(Piece) + 2 * axis] = 0.5 * (first[axis] + last[axis])
        row[len(Piece) + 2 * axis + 1] = 0.5 * (last[axis] - first[axis])


def _set_head(row: Rows, start: Any, end: Any, horizontal: Any, low: Any, high: Any) -> None:
    row[Piece.START], row[Piece.END], row[Piece.PER_HALF] = start, end, 2.0 / (end - start)
    row[Piece.LARGEST_HORIZONTAL] = horizontal
    row[Piece.MINIMUM_VERTICAL], row[Piece.MAXIMUM_VERTICAL] = low, high


def _set_later_bounds(rows: Rows, count: Any) -> None:
    """Extend the bounds of each piece to all later ones, and to 0."""
    horizontal: Any = 0.0
    low: Any = 0.0
    high: Any = 0.0
    for back in range(count):
        k = count - 1 - back
        horizontal = max(horizontal, rows[k, Piece.LARGEST_HORIZONTAL])
        low, high = min(low, rows[k, Piece.MINIMUM_VERTICAL]), max(high, rows[k, Piece.MAXIMUM_VERTICAL])
        rows[k, Piece.LARGEST_HORIZONTAL] = horizontal
        rows[k, Piece.MINIMUM_VERTICAL], rows[k, Piece.MAXIMUM_VERTICAL] = low, high


def _set_continued(rows: Rows, count: Any) -> None:
    """Mark the pieces that the next one continues without a jump."""
    largest: Any = 0.0
    for k in range(count):
        for column in range(len(Piece), len(rows[0])):
            largest = max(largest, abs(rows[k, column]))
    degree = (len(rows[0]) - len(Piece)) // AXES - 1
    for k in range(count):
        rows[k, Piece.CONTINUED] = 0.0
        if k + 1 < count:
            jump: Any = 0.0
            for axis in range(AXES):
                first = len(Piece) + axis * (degree + 1)
                jump = max(
                    jump, abs(value_of(rows[k + 1], first, degree, -1.0) - value_of(rows[k], first, degree, 1.0))
                )
            rows[k, Piece.CONTINUED] = 1.0 if jump <= NO_JUMP * largest else 0.0


def _slope(row: Rows, first: int, degree: int, u: Any) -> Any:
    total: Any = 0.0
    for k in range(degree):
        total = total * u + (degree - k) * row[first + degree - k]
    return total


def _bend(row: Rows, first: int, degree: int, u: Any) -> Any:
    total: Any = 0.0
    for k in range(degree - 1):
        total = total * u + (degree - k) * (degree - k - 1) * row[first + degree - k]
    return total


def _span(spanning: Rows, x: Any, y: Any) -> None:
    """Keep the longest of horizontal vectors; and of a second round the one that lies farthest from its line."""
    size = np.hypot(x, y)
    if size > spanning[Span.SIZE]:
        spanning[Span.SIZE], spanning[Span.X], spanning[Span.Y] = size, x, y
        spanning[Span.ASIDE] = 0.0
    aside = abs(spanning[Span.X] * y - spanning[Span.Y] * x)
    if aside > max(spanning[Span.ASIDE], _ON_LINE * spanning[Span.SIZE] * spanning[Span.SIZE]):
        spanning[Span.ASIDE], spanning[Span.OTHER_X], spanning[Span.OTHER_Y] = aside, x, y


def _set_numbers(
    out: Rows, rows: Rows, count: Any, spanning: Rows, numbers: tuple[Any, ...], begun: tuple[Any, ...]
) -> None:
    bounds = rows[0, Piece.LARGEST_HORIZONTAL], rows[0, Piece.MINIMUM_VERTICAL], rows[0, Piece.MAXIMUM_VERTICAL]
    aside = 1.0 if spanning[Span.ASIDE] > 0.0 else 0.0
    other = aside * spanning[Span.OTHER_X], aside * spanning[Span.OTHER_Y]
    table = (0.0, count, *numbers, *bounds, spanning[Span.X], spanning[Span.Y], *other, *begun)
    for k in range(len(table)):
        out[k] = table[k]


def smooth_table(motion: Any, breaks: tuple[Any, ...], steady: tuple[Any, ...], end: Any, rows: Rows, out: Rows) -> Any:
    """Set the polynomials of a motion that is smooth between its breaks, and the numbers of `Table`.

    Parameters
    ----------
    motion, breaks
        Base motion, and its breaks [s]; those before t = 0 have no effect.
    steady
        A time with velocity and displacement of the base along x, y and z at it; the table reaches it.
    end
        Time up to which it is tabulated at least [s]; a motion that ends is tabulated to its end.
    rows
        Polynomials of degree 15.
    out
        Numbers of `Table`.

    Returns
    -------
    int
        Number of polynomials; if it is larger than that of the rows, only the first ones are set. −1 if the motion is
        not smooth.
    """
    frequency = motion.highest_frequency
    period = 0.0 if motion.period is None else motion.period
    numbers = (motion.duration, period, frequency, motion.mean_frequency, least_rest_energy(motion))
    end = max(end, steady[0])
    if motion.duration < math.inf:  # its bounds are those of the whole motion
        end = max(end, motion.duration)
    spanning = np.zeros(6)
    # The first turn finds the largest acceleration, by which accuracy is measured.
    _, size = _turn(motion, breaks, end, 0.0, rows, spanning, fits=False)
    count, _ = _turn(motion, breaks, end, size, rows, spanning, fits=True)
    if 0 <= count <= len(rows):
        _set_continued(rows, count)
        _set_later_bounds(rows, count)
        _set_numbers(out, rows, count, spanning, numbers, _begun(rows, count, steady))
    return count


def _turn(
    motion: Any, breaks: tuple[Any, ...], end: Any, size: Any, rows: Rows, spanning: Rows, *, fits: bool
) -> tuple[Any, Any]:
    """Return the number of polynomials and the largest acceleration; with `fits` set the polynomials.

    Breaks divide the time, and each stretch has pieces of half the shortest period.
    """
    frequency = motion.highest_frequency
    longest = math.pi / frequency if frequency > 0.0 else math.inf
    count: Any = 0
    low: Any = 0.0
    after: Any = math.inf
    for time in breaks:
        if low < time < end:
            parts = max(1, math.ceil((time - low) / longest))
            for k in range(parts):
                begun = low + k * ((time - low) / parts)
                high = time if k + 1 == parts else low + (k + 1) * ((time - low) / parts)
                count, size = _one(motion, begun, high, size, rows, count, spanning, fits=fits)
            low = time
        if time >= end:
            after = min(after, time)
    parts = max(1, math.ceil((end - low) / longest)) if longest < math.inf else 1
    for k in range(parts):
        begun = low + k * longest if k > 0 else low
        high = low + (k + 1) * longest if longest < math.inf else end
        count, size = _one(motion, min(begun, after), min(high, after), size, rows, count, spanning, fits=fits)
    return count, size


def _one(
    motion: Any, start: Any, end: Any, size: Any, rows: Rows, count: Any, spanning: Rows, *, fits: bool
) -> tuple[Any, Any]:
    """Go on by one piece: return the number of polynomials, −1 without success, and the largest acceleration."""
    if not fits:
        size = max(size, _largest(motion, start, end, spanning))
    elif count >= 0 and start < end:
        count = _fit(motion, start, end, size, rows, count)
    return count, size


def _begun(rows: Rows, count: Any, steady: tuple[Any, ...]) -> tuple[Any, ...]:
    """Return velocity and displacement at t = 0, which lead to those of `steady` at its time."""
    course, place, acceleration, time = np.zeros(COURSE), np.zeros(AXES), np.zeros(AXES), steady[0]
    at: Any = 0
    while at + 1 < count and rows[at, Piece.END] <= time:
        integrate(rows[at], rows[at, Piece.END], course, place, acceleration, course)
        at = at + 1
    integrate(rows[at], time, course, place, acceleration, course)
    vx, vy, vz = steady[1] - course[1], steady[2] - course[2], steady[3] - course[3]
    x, y, z = steady[4] - course[4], steady[5] - course[5], steady[6] - course[6]
    return vx, vy, vz, x - vx * time, y - vy * time, z - vz * time


def steady_of_pulse(_motion: Any) -> tuple[Any, ...]:
    """Return a time [s], and velocity and displacement of the base along x, y and z at it: at rest at t = 0."""
    return (0.0, *_AT_REST)


def steady_of_wave(motion: Any) -> tuple[Any, ...]:
    """Return the end of the ramp of a harmonic motion, and velocity and displacement of the steady motion at it."""
    whole, time = replace(motion, ramp=0.0), motion.ramp
    return (time, *whole.derivative(time, VELOCITY), *whole.derivative(time, DISPLACEMENT))


def steady_of_sweep(motion: Any) -> tuple[Any, ...]:
    """Return the start of a sweep, and velocity and displacement of the base along x, y and z at it."""
    velocity, place = motion.course_at_start()
    x, y, z = math.cos(motion.direction), math.sin(motion.direction), motion.vertical
    return motion.start, x * velocity, y * velocity, z * velocity, x * place, y * place, z * place


def _acceleration(motion: Any, start: Any, end: Any, point: Any) -> tuple[Any, Any, Any]:
    """Return the acceleration at a point from −1 to 1 of an interval, inside of its ends."""
    time = 0.5 * (start + end) + 0.5 * (end - start) * point
    x, y, z = motion.derivative(min(max(time, start * (1.0 + ASIDE)), end * (1.0 - ASIDE)), ACCELERATION)
    return x, y, z


def _largest(motion: Any, start: Any, end: Any, spanning: Rows) -> Any:
    """Return the largest component of the acceleration at the points of an interval."""
    size: Any = 0.0
    for k in range(len(TEST_POINTS)):
        x, y, z = _acceleration(motion, start, end, TEST_POINTS[k])
        size = max(size, np.hypot(x, y), abs(z))
        _span(spanning, x, y)
    return size


def _fit(motion: Any, start: Any, end: Any, size: Any, rows: Rows, count: Any) -> Any:
    """Set the polynomials of an interval from row `count` on; return the row after them, −1 without success.

    The interval is halved until each part is accurate.
    """
    series, row = np.zeros((AXES, _TERMS)), np.zeros(len(Piece) + AXES * _TERMS)
    part, parts = 0, 1
    depth = 0
    while part < parts and count >= 0:
        low, high = start + part * ((end - start) / parts), start + (part + 1) * ((end - start) / parts)
        if part + 1 == parts:
            high = end
        if size > 0.0 and _misfit(motion, low, high, series) > ACCURACY * size:
            part, parts, depth = 2 * part, 2 * parts, depth + 1
            if depth > HALVINGS:
                count = -1
        else:
            if count < len(rows):
                _set_smooth(row, low, high, size, series)
                for k in range(len(row)):
                    rows[count, k] = row[k]
            count, part = count + 1, part + 1
            while parts > 1 and part % 2 == 0:
                part, parts, depth = part // 2, parts // 2, depth - 1
    return count


def _misfit(motion: Any, start: Any, end: Any, series: Rows) -> Any:
    """Set the Chebyshev series through the nodes of an interval; return its largest error at the test points."""
    values = np.zeros((AXES, _TERMS))
    for node in range(_TERMS):
        x, y, z = _acceleration(motion, start, end, NODE_POINTS[node])
        values[0, node], values[1, node], values[2, node] = x, y, z
    for axis in range(AXES):
        for term in range(_TERMS):
            total: Any = 0.0
            for node in range(_TERMS):
                total += SERIES_OF_VALUES[term, node] * values[axis, node]
            series[axis, term] = total
    error: Any = 0.0
    for place in range(len(TEST_POINTS)):
        wanted = _acceleration(motion, start, end, TEST_POINTS[place])
        for axis in range(AXES):
            found: Any = 0.0
            for term in range(_TERMS):
                found += TESTS_OF_SERIES[place, term] * series[axis, term]
            error = max(error, abs(found - wanted[axis]))
    return error


def _set_smooth(row: Rows, start: Any, end: Any, size: Any, series: Rows) -> None:
    """Set the polynomial of a series, with bounds of its own."""
    for axis in range(AXES):
        for power in range(_TERMS):
            total: Any = 0.0
            for term in range(_TERMS):
                one = series[axis, term]
                total += POWERS_OF_SERIES[power, term] * (one if abs(one) >= 0.01 * ACCURACY * size else 0.0)
            row[len(Piece) + axis * _TERMS + power] = total
    low, high = _extremes(row)
    _set_head(row, start, end, _largest_horizontal(row), low, high)


def _largest_horizontal(row: Rows) -> Any:
    """Return sup |a_h| of a polynomial."""
    first, second, degree = len(Piece), len(Piece) + _TERMS, _TERMS - 1
    largest: Any = -1.0
    u: Any = 0.0
    for k in range(len(TEST_POINTS)):
        x, y = value_of(row, first, degree, TEST_POINTS[k]), value_of(row, second, degree, TEST_POINTS[k])
        if x * x + y * y > largest:
            largest, u = x * x + y * y, TEST_POINTS[k]
    for _ in range(_REFINEMENTS):
        x, y = value_of(row, first, degree, u), value_of(row, second, degree, u)
        vx, vy = _slope(row, first, degree, u), _slope(row, second, degree, u)
        bend = vx * vx + vy * vy + x * _bend(row, first, degree, u) + y * _bend(row, second, degree, u)
        if bend < 0.0:
            u = min(max(u - (x * vx + y * vy) / bend, -1.0), 1.0)
        x, y = value_of(row, first, degree, u), value_of(row, second, degree, u)
        largest = max(largest, x * x + y * y)
    return math.sqrt(largest)


def _extremes(row: Rows) -> tuple[Any, Any]:
    """Return inf a_z and sup a_z of a polynomial."""
    low = -_largest_along(row, -1.0)
    high = _largest_along(row, 1.0)
    return low, high


def _largest_along(row: Rows, sign: Any) -> Any:
    first, degree = len(Piece) + 2 * _TERMS, _TERMS - 1
    largest: Any = -math.inf
    u: Any = 0.0
    for k in range(len(TEST_POINTS)):
        value = sign * value_of(row, first, degree, TEST_POINTS[k])
        if value > largest:
            largest, u = value, TEST_POINTS[k]
    for _ in range(_REFINEMENTS):
        bend = sign * _bend(row, first, degree, u)
        if bend < 0.0:
            u = min(max(u - sign * _slope(row, first, degree, u) / bend, -1.0), 1.0)
        largest = max(largest, sign * value_of(row, first, degree, u))
    return largest
