"""All zeros of a function of one variable for many sets of parameters: scan and bisection."""

from collections.abc import Callable
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from stylobate.theory.arguments import FloatArray

Rows: TypeAlias = npt.NDArray[np.intp]
Function: TypeAlias = Callable[[FloatArray, Rows], FloatArray]

# Halvings that reduce a cell to neighbouring floats, and trisection steps that find a minimum to rounding of its value.
_HALVINGS = 64
_CUTS = 60


def zeros(function: Function, grid: FloatArray) -> tuple[Rows, FloatArray]:
    """Find the zeros of a function between the points of a grid.

    Parameters
    ----------
    function
        Values from points x and the rows of the parameters, both arrays that broadcast.
    grid
        Increasing points, one row for each set of parameters, shape (rows, points).

    Returns
    -------
    tuple of numpy.ndarray
        Row and position of each zero, in increasing order within each row.

    Notes
    -----
    Pairs of zeros between two grid points are found if the function bends towards zero on the grid: the search
    minimises the distance to zero near each point that is closer to zero than its neighbours.
    """
    row = np.arange(len(grid))
    values = function(grid, row[:, np.newaxis])
    above = values > 0.0
    at, i = np.nonzero(above[:, 1:] != above[:, :-1])
    brackets = [(at, grid[at, i], grid[at, i + 1])]
    brackets += _around_dips(function, grid, values)
    rows, left, right = (np.concatenate(part) for part in zip(*brackets, strict=True))
    places = _bisect(function, rows, left, right)
    order = np.lexsort((places, rows))
    return rows[order], places[order]


def _around_dips(function: Function, grid: FloatArray, values: FloatArray) -> list[tuple[Rows, FloatArray, FloatArray]]:
    """Return the two brackets of each pair of zeros between grid points."""
    size, above = np.abs(values), values > 0.0
    same = (above[:, 1:-1] == above[:, :-2]) & (above[:, 1:-1] == above[:, 2:])
    at, i = np.nonzero(same & (size[:, 1:-1] <= size[:, :-2]) & (size[:, 1:-1] <= size[:, 2:]))
    sign = np.where(above[at, i], 1.0, -1.0)
    low, high = grid[at, i], grid[at, i + 2]
    left, right = low, high
    for _ in range(_CUTS):
        third = (right - left) / 3.0
        rises = sign * function(left + third, at) < sign * function(right - third, at)
        left, right = np.where(rises, left, left + third), np.where(rises, right - third, right)
    bottom = 0.5 * (left + right)
    through = (function(bottom, at) > 0.0) != (sign > 0.0)
    at, low, bottom, high = at[through], low[through], bottom[through], high[through]
    return [(at, low, bottom), (at, bottom, high)]


def _bisect(function: Function, rows: Rows, left: FloatArray, right: FloatArray) -> FloatArray:
    above = function(left, rows) > 0.0
    for _ in range(_HALVINGS):
        middle = 0.5 * (left + right)
        stays = (function(middle, rows) > 0.0) == above
        left, right = np.where(stays, middle, left), np.where(stays, right, middle)
    return 0.5 * (left + right)
