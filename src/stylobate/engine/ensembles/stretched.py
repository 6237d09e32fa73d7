"""Tables of one pulse at many frequencies: the first is fitted, the others are stretched in time."""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from stylobate.base_motions import BaseMotion
from stylobate.base_motions.base import ACCELERATION
from stylobate.engine.ensembles.polynomials import Table, tabulated
from stylobate.engine.kernel.columns import Piece

Floats = npt.NDArray[np.float64]

# Maximum error of a stretched table as a fraction of the peak acceleration, at the middle and the quarters of each
# piece; it is no worse than the error of a fit.
_FIT_ERROR = 1e-10
_BEYOND = 1.0 + 1e-9
_TEST_POINTS = np.array([-0.5, 0.0, 0.5])


def tabulated_alike(motions: Sequence[BaseMotion], end: float) -> list[Table]:
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
    return np.array([0.0, *(time for time in motion.breaks if time > 0.0)])


def _stretched(table: Table, of: BaseMotion, motion: BaseMotion, end: float) -> Table | None:
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
    found = Table.of(np.vstack([spans, rest]), bounds, coefficients)
    return found if _fits(found, motion, size * strength) else None


def _fits(table: Table, motion: BaseMotion, size: float) -> bool:
    starts, ends = table.rows[:, Piece.START], table.rows[:, Piece.END]
    middle, half = 0.5 * (starts + ends), 0.5 * (ends - starts)
    times = middle[:, np.newaxis] + half[:, np.newaxis] * _TEST_POINTS
    powers = _TEST_POINTS ** np.arange(table.degree + 1)[:, np.newaxis]
    tabulated_values = table.coefficients @ powers  # piece, axis, time
    wanted = np.stack(motion.derivative(times.ravel(), ACCELERATION)).reshape(3, *times.shape).transpose(1, 0, 2)
    return bool(np.abs(tabulated_values - wanted).max() <= _FIT_ERROR * size)
