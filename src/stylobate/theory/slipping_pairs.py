"""Common zeros of two functions of two variables for many sets of parameters: scan and Newton's method."""

from collections.abc import Callable
from typing import TypeAlias

import numpy as np

from stylobate.theory.arguments import BoolArray, FloatArray
from stylobate.theory.rigid_body import Numbers
from stylobate.theory.zeros import Rows

Functions: TypeAlias = Callable[[Numbers, Numbers, Rows], tuple[Numbers, Numbers]]

# Steps of Newton's method; maximum length of a step, and of the last step, in cells.
_STEPS, _LONGEST, _SETTLED = 40, 3.0, 1e-10

# Fractions of a step; the fraction with the smallest residual is taken.
_PARTS = np.array([1.0, 0.3, 0.1, 0.01])

# Zeros closer than this fraction of a cell count as one.
_SAME = 1e-6

# A complex step subtracts nothing, so a step this small leaves only rounding error.
_STEP = 1e-30


def common_zeros(functions: Functions, first: FloatArray, second: FloatArray) -> tuple[Rows, FloatArray, FloatArray]:
    """Find the common zeros of two functions.

    Parameters
    ----------
    functions
        Both values, from the two variables and the rows of the parameters: arrays that broadcast, real or complex; NaN
        where undefined.
    first, second
        Evenly spaced values of the variables, one row for each set of parameters, shape (rows, points).

    Returns
    -------
    tuple of numpy.ndarray
        Row and both variables of each zero, by rows.

    Notes
    -----
    Newton's method starts in each grid cell if both functions change their sign in the cell or its neighbours. So a
    pair of zeros near a fold is found, unless their distance is a small fraction of a cell.
    """
    found = [(np.zeros(0, dtype=np.intp), np.zeros(0), np.zeros(0))]
    for row in range(len(first)):
        u, v = _starts(functions, row, first[row], second[row])
        cells = (first[row, 1] - first[row, 0], second[row, 1] - second[row, 0])
        u, v = _distinct(*_newton(functions, row, u, v, cells), cells)
        inside = (u > first[row, 0]) & (u < first[row, -1]) & (v > second[row, 0]) & (v < second[row, -1])
        found.append((np.full(int(inside.sum()), row, dtype=np.intp), u[inside], v[inside]))
    rows, u, v = (np.concatenate(part) for part in zip(*found, strict=True))
    return rows, u, v


def _starts(functions: Functions, row: int, first: FloatArray, second: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the centres of the cells in or next to which both functions may vanish."""
    every = np.full((len(first), len(second)), row, dtype=np.intp)
    near = np.ones((len(first) - 1, len(second) - 1), dtype=np.bool_)
    for values in functions(first[:, np.newaxis], second[np.newaxis, :], every):
        corners = np.stack([values[1:, 1:], values[:-1, 1:], values[1:, :-1], values[:-1, :-1]])
        near &= _with_neighbours(np.any(corners > 0.0, axis=0) & np.any(corners < 0.0, axis=0))
    i, j = np.nonzero(near)
    return 0.5 * (first[i] + first[i + 1]), 0.5 * (second[j] + second[j + 1])


def _with_neighbours(cells: BoolArray) -> BoolArray:
    wide = np.pad(cells, 1)
    wide = wide[2:] | wide[1:-1] | wide[:-2]
    return np.asarray(wide[:, 2:] | wide[:, 1:-1] | wide[:, :-2])


def _newton(
    functions: Functions, row: int, u: FloatArray, v: FloatArray, cells: tuple[float, float]
) -> tuple[FloatArray, FloatArray]:
    """Return the points at which Newton's method has converged."""
    rows = np.full(u.shape, row, dtype=np.intp)
    longest = np.full(u.shape, np.inf)
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        for _ in range(_STEPS):
            f, g = functions(u, v, rows)
            f_u, g_u = (value.imag / _STEP for value in functions(u + 1.0j * _STEP, v, rows))
            f_v, g_v = (value.imag / _STEP for value in functions(u, v + 1.0j * _STEP, rows))
            determinant = f_u * g_v - f_v * g_u
            du, dv = (f_v * g - g_v * f) / determinant, (g_u * f - f_u * g) / determinant
            longest = np.maximum(np.abs(du / cells[0]), np.abs(dv / cells[1]))
            parts = _PARTS[:, np.newaxis] * np.minimum(1.0, _LONGEST / longest)
            left = np.hypot(*functions(u + parts * du, v + parts * dv, np.broadcast_to(rows, parts.shape)))
            part = parts[np.argmin(np.where(np.isnan(left), np.inf, left), axis=0), np.arange(len(u))]
            u, v = u + part * du, v + part * dv
    settled = longest < _SETTLED
    return u[settled], v[settled]


def _distinct(u: FloatArray, v: FloatArray, cells: tuple[float, float]) -> tuple[FloatArray, FloatArray]:
    """Return each zero once."""
    kept: list[int] = []
    for i in range(len(u)):
        away = [max(abs(u[i] - u[k]) / cells[0], abs(v[i] - v[k]) / cells[1]) for k in kept]
        if all(distance > _SAME for distance in away):
            kept.append(i)
    return u[kept], v[kept]
