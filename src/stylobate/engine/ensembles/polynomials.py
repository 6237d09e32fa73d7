"""Base motions as polynomials in the table of kernels."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from numpy.polynomial import chebyshev

from stylobate.base_motions import BaseMotion
from stylobate.base_motions.base import ACCELERATION
from stylobate.engine.kernel.columns import Piece
from stylobate.errors import UnsupportedError

Floats = npt.NDArray[np.float64]

DEGREE = 15
# Pieces are at most half the shortest period long. They are halved until the error is below this fraction of the peak
# acceleration; the second number is the maximum number of halvings.
ACCURACY, HALVINGS = 1e-11, 12
_MOST_PIECES = 2_000_000
# A piece is continued by the next one if the jump of the acceleration is below this fraction of its maximum.
NO_JUMP = 1e-10
# Relative distance in time from a break at which the acceleration is evaluated.
ASIDE = 4.0 * float(np.finfo(float).eps)
# The Chebyshev points of one kind determine a polynomial on −1 … 1, the points of the other kind test it.
_POINTS = np.cos(math.pi * np.arange(2 * (DEGREE + 1) + 1) / (2 * (DEGREE + 1)))[::-1].copy()
NODE_POINTS, TEST_POINTS = _POINTS[1::2].copy(), _POINTS[::2].copy()
SERIES_OF_VALUES = (
    np.append(1.0, np.full(DEGREE, 2.0))[:, np.newaxis]
    / (DEGREE + 1)
    * chebyshev.chebvander(NODE_POINTS, DEGREE).T.copy()
)
TESTS_OF_SERIES = chebyshev.chebvander(TEST_POINTS, DEGREE)
POWERS_OF_SERIES = np.stack(
    [np.pad(chebyshev.cheb2poly(one), (0, DEGREE + 1))[: DEGREE + 1] for one in np.eye(DEGREE + 1)], axis=1
)
"""Chebyshev series from values at the nodes, its values at the test points, and its coefficients of powers."""


@dataclass(frozen=True, slots=True)
class PolynomialTable:
    """Pieces of polynomials, a row each with the columns of `Piece`."""

    rows: Floats
    degree: int

    @classmethod
    def of(cls, spans: Floats, bounds: Floats, coefficients: Floats) -> "PolynomialTable":
        """Return the table of pieces with these starts and ends (n, 2), bounds (n, 3), coefficients (n, 3, powers)."""
        powers = coefficients.shape[-1]
        starts, ends = coefficients @ (-1.0) ** np.arange(powers), coefficients.sum(axis=-1)
        jumps = np.abs(starts[1:] - ends[:-1]).max(axis=-1, initial=0.0)
        continued = np.append(jumps <= NO_JUMP * np.abs(coefficients).max(initial=0.0), 0.0)
        per_half = 2.0 / np.diff(spans)
        rows = np.column_stack([spans, bounds, continued, per_half, coefficients.reshape(len(spans), -1)])
        return cls(rows, powers - 1)

    @property
    def coefficients(self) -> Floats:
        """Coefficients of all pieces, shape (pieces, 3, degree + 1)."""
        return self.rows[:, len(Piece) :].reshape(len(self.rows), 3, -1)

    def raised(self, degree: int) -> "PolynomialTable":
        """Return the same pieces as polynomials of a higher `degree`."""
        count = len(self.rows)
        coefficients = np.zeros((count, 3, degree + 1))
        coefficients[:, :, : self.degree + 1] = self.coefficients
        return PolynomialTable(np.column_stack([self.rows[:, : len(Piece)], coefficients.reshape(count, -1)]), degree)


def one_after_another(tables: Sequence[PolynomialTable]) -> PolynomialTable:
    """Join the pieces of all `tables` in one table with the highest of their degrees."""
    degree = max(table.degree for table in tables)
    return PolynomialTable(np.concatenate([table.raised(degree).rows for table in tables]), degree)


def tabulated(motion: BaseMotion, end: float) -> PolynomialTable:
    """Return the table of `motion` from t = 0 to `end` [s].

    Raises
    ------
    UnsupportedError
        If the motion is not smooth between its breaks.
    """
    if motion.degree is not None and motion.degree <= 1:
        return _linear(motion)
    frequency = motion.highest_frequency
    longest = math.pi / frequency if frequency > 0.0 else math.inf
    edges = [0.0, *(time for time in motion.breaks if 0.0 < time < end)]
    if len(edges) + end / longest > _MOST_PIECES:
        raise UnsupportedError(
            f"motion is too long to tabulate: {end!r} s in pieces of {longest!r} s; shorten the duration"
        )
    size = max(motion.peak_horizontal(0.0), *map(abs, motion.vertical_range(0.0)))
    pieces: list[tuple[float, float, Floats]] = []
    after = next((time for time in motion.breaks if time >= end), math.inf)
    for low, high in zip(edges, [*edges[1:], math.inf], strict=True):
        cuts = np.minimum(_cuts(low, high, longest, end), after)  # no piece crosses a break
        for a, b in zip(cuts[:-1].tolist(), cuts[1:].tolist(), strict=True):
            pieces += _fitted(motion, a, b, size, HALVINGS)
    starts, ends, coefficients = zip(*pieces, strict=True)
    bounds = np.array([(motion.peak_horizontal(time), *motion.vertical_range(time)) for time in starts])
    return PolynomialTable.of(np.column_stack([starts, ends]), bounds, np.stack(coefficients))


def _linear(motion: BaseMotion) -> PolynomialTable:
    """Return the exact table of a motion that is linear between its breaks; the last piece has no end."""
    edges = _edges(motion)
    edges = np.append(edges, edges[-1] + 1.0)
    middle, quarter = 0.5 * (edges[:-1] + edges[1:]), 0.25 * np.diff(edges)
    first = np.stack(motion.derivative(middle - quarter, ACCELERATION))
    second = np.stack(motion.derivative(middle + quarter, ACCELERATION))
    coefficients = np.stack([0.5 * (first + second), second - first], axis=-1).transpose(1, 0, 2)
    # A line has its extremes at its ends.
    ends = np.stack([coefficients[..., 0] - coefficients[..., 1], coefficients[..., 0] + coefficients[..., 1]])
    horizontal, vertical = np.hypot(ends[..., 0], ends[..., 1]).max(axis=0), ends[..., 2]
    bounds = np.stack([horizontal, -vertical.min(axis=0), vertical.max(axis=0)])
    bounds = np.maximum.accumulate(bounds[:, ::-1], axis=1)[:, ::-1] * [[1.0], [-1.0], [1.0]]
    return PolynomialTable.of(np.column_stack([edges[:-1], edges[1:]]), bounds.T, coefficients)


def _cuts(low: float, high: float, longest: float, end: float) -> Floats:
    """Return the cuts between two breaks; `end` determines only their number."""
    if math.isfinite(high):
        return np.linspace(low, high, max(1, math.ceil((high - low) / longest)) + 1)
    if math.isinf(longest):
        return np.array([low, end])
    return np.asarray(low + longest * np.arange(max(1, math.ceil((end - low) / longest)) + 1), dtype=float)


def _fitted(
    motion: BaseMotion, start: float, end: float, size: float, halvings: int
) -> list[tuple[float, float, Floats]]:
    middle, half = 0.5 * (start + end), 0.5 * (end - start)
    inside = np.clip(middle + half * _POINTS, start * (1.0 + ASIDE), end * (1.0 - ASIDE))
    values = np.stack(motion.derivative(inside, ACCELERATION))
    series = SERIES_OF_VALUES @ values[:, 1::2].T
    error = np.abs(TESTS_OF_SERIES @ series - values[:, ::2].T).max()
    if error <= ACCURACY * size or size == 0.0:
        series[np.abs(series) < 0.01 * ACCURACY * size] = 0.0
        return [(start, end, (POWERS_OF_SERIES @ series).T)]
    if halvings == 0:
        raise UnsupportedError(
            f"motion must be smooth between its breaks, but is not near t = {middle!r} s; list the time in breaks"
        )
    first = _fitted(motion, start, middle, size, halvings - 1)
    return first + _fitted(motion, middle, end, size, halvings - 1)


# Maximum error of a stretched table as a fraction of the peak acceleration, at the middle and the quarters of each
# piece; it is no worse than the error of a fit.
_FIT_ERROR = 1e-10
_BEYOND = 1.0 + 1e-9
_QUARTERS = np.array([-0.5, 0.0, 0.5])


def tabulated_alike(motions: Sequence[BaseMotion], end: float) -> list[PolynomialTable]:
    """Return the tables of `motions` from t = 0 to `end` [s]; motions that stretch the first one are not fitted.

    Raises
    ------
    UnsupportedError
        If a motion is not smooth between its breaks.
    """
    first = motions[0]
    table = tabulated(first, max(end, _edges(first)[-1] * _BEYOND))  # to its end, which others may reach earlier
    return [table, *(_stretched(table, first, motion, end) or tabulated(motion, end) for motion in motions[1:])]


def _edges(motion: BaseMotion) -> Floats:
    breaks = np.asarray(motion.breaks, dtype=float)
    return np.append(0.0, breaks[breaks > 0.0])


def _stretched(table: PolynomialTable, of: BaseMotion, motion: BaseMotion, end: float) -> PolynomialTable | None:
    """Return the table of `motion` if it is `of` stretched between its breaks, else None."""
    before, after = _edges(of), _edges(motion)
    size = of.peak_horizontal(0.0)
    if len(before) != len(after) or len(before) == 1 or not size > 0.0:
        return None
    going = table.rows[:, Piece.END] <= before[-1]
    if np.any(table.coefficients[~going]):
        return None  # it never ends
    strength = motion.peak_horizontal(0.0) / size
    spans = np.interp(table.rows[going][:, [Piece.START, Piece.END]], before, after)
    rest = (after[-1], max(end, after[-1] + 1.0))
    coefficients = np.append(strength * table.coefficients[going], np.zeros((1, *table.coefficients.shape[1:])), axis=0)
    bounds = np.append(
        strength * table.rows[going, Piece.LARGEST_HORIZONTAL : Piece.CONTINUED], np.zeros((1, 3)), axis=0
    )
    found = PolynomialTable.of(np.vstack([spans, rest]), bounds, coefficients)
    return found if _fits(found, motion, size * strength) else None


def _fits(table: PolynomialTable, motion: BaseMotion, size: float) -> bool:
    starts, ends = table.rows[:, Piece.START], table.rows[:, Piece.END]
    middle, half = 0.5 * (starts + ends), 0.5 * (ends - starts)
    times = middle[:, np.newaxis] + half[:, np.newaxis] * _QUARTERS
    powers = _QUARTERS ** np.arange(table.degree + 1)[:, np.newaxis]
    tabulated_values = table.coefficients @ powers  # piece, axis, time
    wanted = np.stack(motion.derivative(times.ravel(), ACCELERATION)).reshape(3, *times.shape).transpose(1, 0, 2)
    return bool(np.abs(tabulated_values - wanted).max() <= _FIT_ERROR * size)
