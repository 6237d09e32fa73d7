"""Steady rolling of a rigid column at any tilt on a circularly moving base: shared equations and root search.

The components of the base acceleration along and across the lean, a0 cos ψ and a0 sin ψ, follow from the tilt in closed
form. One equation for the tilt remains; its solutions are sought between 0 and π/2.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from stylobate.theory.arguments import BoolArray, ComplexArray, FloatArray
from stylobate.theory.rigid_body import Numbers
from stylobate.theory.zeros import Rows, zeros

Balance: TypeAlias = Callable[[FloatArray, Rows], tuple[FloatArray, FloatArray]]


@dataclass(frozen=True, slots=True, kw_only=True)
class FiniteTiltRolling:
    """All steady rolling at finite tilt: arrays of the broadcast shape and a last axis for the branches.

    The branches are in the order of increasing tilt. The axis has the maximum number of branches, at least 1; NaN (and
    False) where there are fewer.

    Parameters
    ----------
    amplitude
        Tilt angle θ [rad], between 0 and π/2.
    phase
        Phase ψ by which the contact point leads the base acceleration [rad], in (−π, π].
    spin
        Axial angular velocity w3, in units of ω0.
    friction_demand
        Horizontal over vertical force of the contact: the coefficient of friction below which the contact slips.
    friction_moment
        Moment about the vertical, over m g r, of the spin damping or of the constraint that excludes rotation.
    exists
        Whether there is such a solution.
    stable
        Whether all deviations decay; without damping, whether none grows.
    eigenvalues
        Eigenvalues of the Jacobian, complex, along one more axis after that of the branches.
    """

    amplitude: FloatArray
    phase: FloatArray
    spin: FloatArray
    friction_demand: FloatArray
    friction_moment: FloatArray
    exists: BoolArray
    stable: BoolArray
    eigenvalues: ComplexArray


# Points of the scan over the tilt; a zero is missed only if the balance oscillates between two points.
_POINTS = 256

# The scan begins at this fraction of the minimum relevant tilt and ends this far [rad] below π/2.
_LEAST, _MARGIN = 1e-9, 1e-9

# Sets of parameters scanned at once; limits the memory.
_AT_ONCE = 4096


def steady_tilts(balance: Balance, a0: FloatArray, scale: FloatArray, lossless: BoolArray) -> FloatArray:
    """Find the tilts at which steady rolling is possible.

    Parameters
    ----------
    balance
        Required base acceleration along and across the lean, from a tilt and the rows of the parameters.
    a0
        Acceleration amplitude of the base [g], shape (rows,).
    scale
        Tilt at which the balance bends, shape (rows,); NaN where there is no solution.
    lossless
        Whether no acceleration is required across the lean, shape (rows,).

    Returns
    -------
    numpy.ndarray
        Tilts [rad], increasing, shape (rows, branches), padded with NaN.
    """
    # Without damping X² = a0² is factored; otherwise its double zeros at a0 = 0 would be missed.
    possible = np.isfinite(scale)
    rows, sides = [], []
    for chosen, side in ((~lossless, 0.0), (lossless, 1.0), (lossless & (a0 > 0.0), -1.0)):
        found = np.flatnonzero(chosen & possible)
        rows.append(found)
        sides.append(np.full(found.shape, side))
    return _by_row(*_scan(balance, a0, scale, np.concatenate(rows), np.concatenate(sides)), len(a0))


def _scan(
    balance: Balance, a0: FloatArray, scale: FloatArray, rows: Rows, sides: FloatArray
) -> tuple[Rows, FloatArray]:
    """Return row and tilt of all zeros of X² + Y² − a0² (side 0) or X ∓ a0 (sides ±1)."""
    found = [(np.zeros(0, dtype=np.intp), np.zeros(0))]
    for start in range(0, len(rows), _AT_ONCE):
        part = slice(start, start + _AT_ONCE)

        def excess(tilt: FloatArray, at: Rows, part: slice = part) -> FloatArray:
            row, side = rows[part][at], sides[part][at]
            along, across = balance(tilt, row)
            square = (along - a0[row]) * (along + a0[row]) + across**2
            return np.where(side == 0.0, square, along - side * a0[row])

        at, tilts = zeros(excess, tilt_grid(scale[rows[part]], _POINTS))
        found.append((rows[part][at], tilts))
    every, tilts = (np.concatenate(part) for part in zip(*found, strict=True))
    return every, tilts


def tilt_grid(scale: FloatArray, points: int) -> FloatArray:
    """Return tilts that are evenly spaced below `scale` and by equal ratios above it."""
    start, reach = np.arcsinh(_LEAST), np.arcsinh((0.5 * np.pi - _MARGIN) / scale)
    steps = np.linspace(0.0, 1.0, points)
    return np.asarray(scale[:, np.newaxis] * np.sinh(start + (reach[:, np.newaxis] - start) * steps))


def _by_row(rows: Rows, tilts: FloatArray, count: int) -> FloatArray:
    order = np.lexsort((tilts, rows))
    rows, tilts = rows[order], tilts[order]
    many = np.bincount(rows, minlength=count)
    rank = np.arange(len(rows)) - (np.cumsum(many) - many)[rows]
    out = np.full((count, max(1, int(many.max(initial=0)))), np.nan)
    out[rows, rank] = tilts
    return out


# Without damping, eigenvalues with a real part below this fraction of the largest eigenvalue count as imaginary: the
# double eigenvalue of the free spin is accurate to the root of the rounding error only.
_NEUTRAL = 1e-7


def no_deviation_grows(eigenvalues: ComplexArray, eta: FloatArray) -> BoolArray:
    """Return whether all deviations along the last axis decay or, without damping, none grows."""
    growth = eigenvalues.real.max(axis=-1)
    size = np.abs(np.where(np.isfinite(eigenvalues), eigenvalues, 0.0)).max(axis=-1)
    return np.asarray(np.where(eta > 0.0, growth < 0.0, growth <= _NEUTRAL * size))


# A complex step subtracts nothing, so a step this small leaves only rounding error.
_STEP = 1e-30


def eigenvalues(rates: Callable[[Numbers], Numbers], state: FloatArray) -> ComplexArray:
    """Return the eigenvalues, along the last axis, of the Jacobian of `rates` at states along the first axis."""
    count = len(state)
    offsets = (1.0j * _STEP * np.eye(count)).reshape(count, count, *(1 for _ in state.shape[1:]))
    columns = rates(state[:, np.newaxis] + offsets).imag / _STEP
    values: ComplexArray = np.linalg.eigvals(np.moveaxis(columns, (0, 1), (-2, -1))).astype(np.complex128)
    return values


def on_branches(shape: tuple[int, ...], found: BoolArray, values: Numbers) -> Numbers:
    """Spread values of the solutions found, shape (solutions, …), to the shape of all, NaN elsewhere."""
    out = np.full((*found.shape, *values.shape[1:]), np.nan, dtype=values.dtype)
    out[found] = values
    return out.reshape(*shape, *out.shape[1:])
