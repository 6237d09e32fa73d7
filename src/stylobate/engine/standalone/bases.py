"""Base motions of a single run in the language of the compiler: at rest, harmonic, or tabulated by polynomials.

They have the same members: `duration`, `bounds`, `directions`, `fill`, `begin`, `set_sample` and
`acceleration`.
"""

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from stylobate.base_motions import BASE_AT_REST
from stylobate.base_motions.base import ACCELERATION, DISPLACEMENT
from stylobate.base_motions.harmonic import Harmonic
from stylobate.engine.ensembles.beginnings import Bounds, Vector
from stylobate.engine.ensembles.run_columns import term_of
from stylobate.engine.forcing import least_rest_energy
from stylobate.engine.kernel.columns import Piece, Tabulated

Row = npt.NDArray[np.float64]

AXES = 3

_LEAST_AT_REST = least_rest_energy(BASE_AT_REST)


@dataclass(frozen=True, slots=True)
class AtRest:
    """A base at rest."""

    @property
    def duration(self) -> float:
        """0 s."""
        return 0.0

    def bounds(self, _scale: Any, _gravity: Any) -> Bounds:
        """Return the numbers on which rest depends."""
        return Bounds(0.0, 0.0, _LEAST_AT_REST, 0.0, 0.0, 0.0, 0.0, 0.0)

    def directions(self) -> tuple[Vector, ...]:
        """Return a zero vector, which is parallel to any line."""
        return ((0.0, 0.0),)

    def fill(self, row: Row, at: int, scale: Any, gravity: Any) -> None:
        """Set no column."""

    def begin(self, course: Row) -> None:
        """Leave the course of the base as it is."""

    def set_sample(self, _time: Any, _course: Row, place: Row, acceleration: Row) -> None:
        """Set displacement and acceleration to 0."""
        for k in range(AXES):
            place[k], acceleration[k] = 0.0, 0.0

    def acceleration(self, _time: Any) -> tuple[Any, Any, Any]:
        """Return 0."""
        return 0.0, 0.0, 0.0


@dataclass(frozen=True, slots=True)
class Waves:
    """A harmonic motion without a ramp."""

    motion: Harmonic

    @property
    def duration(self) -> float:
        """It never ends."""
        return math.inf

    def bounds(self, scale: Any, gravity: Any) -> Bounds:
        """Return the numbers on which rest depends, in the units of the model."""
        motion, per_gravity = self.motion, 1.0 / gravity
        low, high = motion.vertical_range(0.0)
        frequency, phase = motion.angular_frequency * scale, motion.start_phase / (2.0 * math.pi)
        largest = abs(per_gravity) * motion.peak_horizontal(0.0)
        least = least_rest_energy(motion)
        up, down = per_gravity * low, per_gravity * high
        return Bounds(frequency, frequency, least, motion.period / scale, phase, largest, up, down)

    def directions(self) -> tuple[Vector, ...]:
        """Return the horizontal vectors that span the motion [m/s²]."""
        return self.motion.directions()

    def fill(self, row: Row, at: int, scale: Any, gravity: Any) -> None:
        """Set the columns of the motion."""
        wave = term_of(self.motion).wave(scale, gravity, windowed=False)
        for k in range(len(wave)):
            row[at + k] = wave[k]

    def begin(self, course: Row) -> None:
        """Leave the course of the base as it is."""

    def set_sample(self, time: Any, _course: Row, place: Row, acceleration: Row) -> None:
        """Set displacement [m] and acceleration [m/s²] at a time [s]."""
        there, pushed = self.motion.derivative(time, DISPLACEMENT), self.motion.derivative(time, ACCELERATION)
        for k in range(AXES):
            place[k], acceleration[k] = there[k], pushed[k]

    def acceleration(self, time: Any) -> tuple[Any, Any, Any]:
        """Return the acceleration at a time [m/s²]."""
        x, y, z = self.motion.derivative(time, ACCELERATION)
        return x, y, z


class Table(NamedTuple):
    """Numbers of a tabulated motion, in SI units.

    Parameters
    ----------
    first, pieces
        Row of its first polynomial, and their number.
    lasts, period
        Time after which the base stands still, and period [s]; 0 without a period.
    highest_frequency, mean_frequency, least_rest_energy
        See `BaseMotion`, and `least_rest_energy`.
    largest, minimum_vertical, maximum_vertical
        sup |a_h|, inf a_z and sup a_z.
    first_x, first_y, other_x, other_y
        Two vectors that span the horizontal accelerations.
    velocity_x_0, velocity_y_0, velocity_z_0, place_x_0, place_y_0, place_z_0
        Velocity and displacement of the base at t = 0.
    """

    first: Any
    pieces: Any
    lasts: Any
    period: Any
    highest_frequency: Any
    mean_frequency: Any
    least_rest_energy: Any
    largest: Any
    minimum_vertical: Any
    maximum_vertical: Any
    first_x: Any
    first_y: Any
    other_x: Any
    other_y: Any
    velocity_x_0: Any
    velocity_y_0: Any
    velocity_z_0: Any
    place_x_0: Any
    place_y_0: Any
    place_z_0: Any


COURSE = 1 + 2 * AXES
"""Index of a polynomial, and velocity and displacement of the base at its start."""


@dataclass(frozen=True, slots=True)
class Polynomials:
    """A motion that is tabulated by polynomials; `rows` are these, with the columns of `Piece`."""

    numbers: Table
    rows: Row

    @property
    def duration(self) -> Any:
        """Time after which the base stands still [s]."""
        return self.numbers.lasts

    def bounds(self, scale: Any, gravity: Any) -> Bounds:
        """Return the numbers on which rest depends, in the units of the model."""
        of = self.numbers
        return Bounds(
            of.highest_frequency * scale,
            of.mean_frequency * scale,
            of.least_rest_energy,
            of.period / scale,
            0.0,
            of.largest / gravity,
            of.minimum_vertical / gravity,
            of.maximum_vertical / gravity,
        )

    def directions(self) -> tuple[Vector, ...]:
        """Return the horizontal vectors that span the motion [m/s²]."""
        of = self.numbers
        return (of.first_x, of.first_y), (of.other_x, of.other_y)

    def fill(self, row: Row, at: int, _scale: Any, gravity: Any) -> None:
        """Set the columns of the motion."""
        row[at + Tabulated.FACTOR] = row[at + Tabulated.VERTICAL] = 1.0 / gravity
        row[at + Tabulated.COS] = 1.0
        row[at + Tabulated.FIRST], row[at + Tabulated.COUNT] = self.numbers.first, self.numbers.pieces

    def begin(self, course: Row) -> None:
        """Set the course of the base at t = 0."""
        of = self.numbers
        course[1], course[2], course[3] = of.velocity_x_0, of.velocity_y_0, of.velocity_z_0
        course[4], course[5], course[6] = of.place_x_0, of.place_y_0, of.place_z_0

    def set_sample(self, time: Any, course: Row, place: Row, acceleration: Row) -> None:
        """Set displacement [m] and acceleration [m/s²] at a time [s], which never decreases."""
        of, rows, at = self.numbers, self.rows, int(self.numbers.first + course[0])
        while course[0] < of.pieces - 1.0 and rows[at, Piece.END] <= time:
            integrate(rows[at], rows[at, Piece.END], course, place, acceleration, course)
            course[0] += 1.0
            at = at + 1
        integrate(rows[at], time, course, place, acceleration, None)

    def acceleration(self, time: Any) -> tuple[Any, Any, Any]:
        """Return the acceleration at a time [m/s²]."""
        first = int(self.numbers.first)
        piece = self.rows[last_begun(self.rows, Piece.START, first, first + int(self.numbers.pieces) - 1, time)]
        u, degree = (time - piece[Piece.START]) * piece[Piece.PER_HALF] - 1.0, (len(piece) - len(Piece)) // AXES - 1
        x, y, z = (value_of(piece, len(Piece) + axis * (degree + 1), degree, u) for axis in range(AXES))
        return x, y, z


def last_begun(rows: Row, column: int, first: Any, last: Any, time: Any) -> Any:
    """Return the last of some rows whose start, in a column, is not after a time; the first if all are."""
    low: Any = first
    high: Any = last
    while low < high:
        middle = (low + high + 1) // 2
        if rows[middle, column] <= time:
            low = middle
        else:
            high = middle - 1
    return low


def value_of(piece: Row, first: int, degree: int, u: Any) -> Any:
    """Return the value of a polynomial whose coefficients begin at a column, lowest power first."""
    total: Any = 0.0
    for k in range(degree + 1):
        total = total * u + piece[first + degree - k]
    return total


def integrate(piece: Row, time: Any, course: Row, place: Row, acceleration: Row, carried: Row | None) -> None:
    """Set displacement and acceleration at a time in a piece; if given, velocity and displacement of `carried`.

    After its last piece the base moves uniformly.
    """
    start, half = piece[Piece.START], 1.0 / piece[Piece.PER_HALF]
    u, degree = (time - start) / half - 1.0, (len(piece) - len(Piece)) // AXES - 1
    for axis in range(AXES):
        first = len(Piece) + axis * (degree + 1)
        value, gained, moved, power, odd = 0.0, 0.0, 0.0, 1.0, -1.0
        for k in range(degree + 1):
            coefficient = piece[first + k]
            value += coefficient * power
            gained += coefficient * (power * u - odd) / (k + 1)
            moved += coefficient * ((power * u * u + odd) / (k + 2) - odd * (u + 1.0)) / (k + 1)
            power, odd = power * u, -odd
        velocity, there = course[1 + axis], course[1 + AXES + axis]
        acceleration[axis] = value
        place[axis] = there + velocity * (time - start) + half * half * moved
        if carried is not None:
            carried[1 + axis] = velocity + half * gained
            carried[1 + AXES + axis] = place[axis]
