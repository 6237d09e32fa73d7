"""Steady rolling without slip at finite tilt and with free spin, on a base that moves in a circle.

The components of the base acceleration along and across the lean, a0 cos ψ and a0 sin ψ, follow from the tilt in closed
form. One equation for the tilt remains; its solutions are sought between 0 and π/2.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from stylobate.theory.arguments import (
    BoolArray,
    ComplexArray,
    FloatArray,
    Real,
    finite,
    not_negative,
    not_negative_or_infinite,
    plain_results,
    positive,
)
from stylobate.theory.rigid_body import Numbers, RigidBody

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


STATES = 5


def rates(
    state: Numbers, nu: FloatArray, a0: FloatArray, eta: FloatArray, zeta: FloatArray, body: RigidBody
) -> Numbers:
    """Evaluate the right-hand side of rolling without slip at finite tilt, in the frame of the circular base motion.

    Parameters
    ----------
    state
        Tilt rate θ̇, rolling rate β̇, tilt angle θ > 0 [rad], phase ψ = β − ντ and axial angular velocity σ [ω0],
        real or complex, along the first axis: shape (5, ...).
    nu
        Frequency ratio ν = Ω/ω0 of the base motion.
    a0
        Acceleration amplitude of the base [g].
    eta
        Damping η, a couple against the rate of tilt.
    zeta
        Spin damping ζ, a moment against rotation about the vertical. An infinite ζ excludes this rotation; the state
        must then have σ cos θ + β̇ sin²θ = 0.
    body
        The column.

    Returns
    -------
    numpy.ndarray
        Rates of the state in the same order, shape (5, ...). Not defined at θ = 0.

    Notes
    -----
    Over J0, with s = sin θ, w1 = −β̇s, p = cos θ + cs, Λ = 1 + i_a − κ, and the couples M1 = −ηw1 − Ms and M3 = M cos θ,
    M = −ζκc²Λ(σ cos θ − w1 s) being the moment of the spin damping:

        T = [κθ̇((I_a/I_t)σ − cw1) − a0 sin ψ − (κ/I_t)M1 − (κc/I_a)M3] I_t i_a/Λ
        ẇ1 = β̇θ̇ cos θ − (I_a/I_t)θ̇σ + (T + M1)/I_t
        σ̇ = (cT + M3)/I_a
        K θ̈ = s − c cos θ − p a0 cos ψ − κpβ̇(cσ + w1) + I_t β̇²s cos θ − I_a β̇sσ − ηθ̇

    T is the contact force across the lean, over m g.
    """
    mu, omega, tilt, psi, spin = state
    s, cosine, height = np.sin(tilt), np.cos(tilt), body.height(tilt)
    w1 = -omega * s
    push, drive = a0 * np.cos(psi), a0 * np.sin(psi)
    moment = _vertical_moment(mu, w1, spin, tilt, drive, eta, zeta, body)
    w1_rate, spin_rate = _turning(mu, w1, spin, tilt, drive, eta, moment, body)
    tilting = (
        body.overhang(tilt)
        - height * push
        - body.kappa * height * omega * (body.c * spin + w1)
        + body.transverse * omega**2 * s * cosine
        - body.axial * omega * s * spin
        - eta * mu
    ) / body.rim
    rolling = -(w1_rate + omega * mu * cosine) / s
    return np.stack(np.broadcast_arrays(tilting, rolling, mu, omega - nu, spin_rate))


def _turning(
    mu: Numbers, w1: Numbers, spin: Numbers, tilt: Numbers, drive: Numbers, eta: FloatArray, moment: Numbers,
    body: RigidBody,
) -> tuple[Numbers, Numbers]:  # fmt: skip
    """Return ẇ1 and σ̇ under a moment about the vertical."""
    s, cosine = np.sin(tilt), np.cos(tilt)
    m1, m3 = -eta * w1 - moment * s, moment * cosine
    inertia = body.axial / body.transverse
    gyroscopic = body.kappa * mu * (inertia * spin - body.c * w1)
    couples = body.kappa * (m1 / body.transverse + body.c * m3 / body.axial)
    force = (gyroscopic - drive - couples) * body.transverse * body.axial_ratio / body.freedom  # T
    w1_rate = -w1 * mu * cosine / s - inertia * mu * spin + (force + m1) / body.transverse
    return w1_rate, (body.c * force + m3) / body.axial


def _vertical_moment(
    mu: Numbers, w1: Numbers, spin: Numbers, tilt: Numbers, drive: Numbers, eta: FloatArray, zeta: FloatArray,
    body: RigidBody,
) -> Numbers:  # fmt: skip
    """Return the moment of the spin damping or, if ζ is infinite, the moment that keeps ω·Z constant."""
    s, cosine = np.sin(tilt), np.cos(tilt)
    held = np.isinf(zeta)
    coefficient = np.where(held, 0.0, zeta) * body.kappa * body.c**2 * body.freedom
    moment: Numbers = -coefficient * (spin * cosine - w1 * s)
    if not held.any():
        return moment

    def vertical(trial: Numbers) -> Numbers:  # (ω·Z)˙, linear in the moment
        w1_rate, spin_rate = _turning(mu, w1, spin, tilt, drive, eta, trial, body)
        return np.asarray(spin_rate * cosine - w1_rate * s - mu * (spin * s + w1 * cosine))

    without = vertical(np.zeros_like(moment))
    return np.asarray(np.where(held, without / (without - vertical(np.ones_like(moment))), moment))


@plain_results
def full_rolling(
    nu: Real,
    a0: Real,
    *,
    c: Real,
    eta: Real,
    zeta: Real,
    spin: Real = 0.0,
    inertia_ratio: Real = 0.75,
    axial_ratio: Real = 0.5,
) -> FiniteTiltRolling:
    """Compute all branches of steady rolling without slip of a rigid column on a circling base, at any tilt.

    Parameters
    ----------
    nu
        Frequency ratio ν = Ω/ω0 of the base motion, positive.
    a0
        Acceleration amplitude of the base [g].
    c
        Slenderness.
    eta
        Damping η, a couple against the rate of tilt.
    zeta
        Spin damping ζ, a moment against rotation about the vertical. An infinite ζ excludes this rotation. ζ = 0 with
        damping η allows no steady rolling.
    spin
        Axial angular velocity [ω0], used only without any damping, when the spin is arbitrary.
    inertia_ratio
        κ = m h²/J0; ¾ for a slender solid cylinder, as by default.
    axial_ratio
        i_a = I_a/(m r²); ½ for a solid cylinder.

    Returns
    -------
    FiniteTiltRolling
        All branches with a tilt below π/2, for the base acceleration a0 (cos ντ, sin ντ), five eigenvalues each; for
        infinite `zeta` four, and −∞.

    Raises
    ------
    ParameterError
        If `nu` or a number of the body is not positive, no body can have these numbers, `spin` is not finite, or
        another argument is negative.

    See Also
    --------
    free_twist_rolling : the limit of small tilts.
    wobbling_rolling : the same for pure tilting, without rotation about the vertical.

    Notes
    -----
    In steady rolling the balances of the couples about the lean and about the axis give contact force and spin,

        a0 sin ψ = ην sin θ cos θ/p,   w3 = −ν sin θ (sin θ + η/(ζκcΛp))/cos θ,   p = cos θ + c sin θ

    with Λ = 1 + i_a − κ, and the balance of tilting is

        p a0 cos ψ = sin θ − c cos θ + ν² sin θ (κp + (1 − κ) cos θ) − νκc w3 (p + c i_a sin θ).

    The amplitudes are the zeros of (a0 cos ψ)² + (a0 sin ψ)² − a0²: with damping, 100 000 random columns had at most
    two, and one for a0 > c. They differ from the amplitudes of the slender column by a relative amount of order c². A
    column that rolls against its spin may lean beyond its tipping angle and be stable. Infinite spin damping gives the
    spin w3 = −ν sin θ tan θ, since it excludes rotation about the vertical, not about the axis.

    Stability follows from the exact Jacobian of all five states. Without damping and base motion the phase is
    arbitrary.

    Examples
    --------
    >>> rolling = full_rolling(3.0, 0.065, c=0.1, eta=0.1, zeta=0.1)
    >>> print(rolling.amplitude.round(7), rolling.phase.round(4), rolling.spin.round(5), rolling.stable)
    [0.0015903 0.0074953] [3.1343 0.0346] [-0.08481 -0.39964] [False  True]
    """
    body = RigidBody.checked(c, inertia_ratio, axial_ratio)
    numbers = np.broadcast_arrays(
        positive("nu", nu),
        not_negative("a0", a0),
        not_negative("eta", eta),
        not_negative_or_infinite("zeta", zeta),
        finite("spin", spin),
        body.c,
        body.kappa,
        body.axial_ratio,
    )
    shape = numbers[0].shape
    return _branches(shape, *(number.ravel() for number in numbers))


def _branches(
    shape: tuple[int, ...],
    nu: FloatArray,
    a0: FloatArray,
    eta: FloatArray,
    zeta: FloatArray,
    spin: FloatArray,
    c: FloatArray,
    kappa: FloatArray,
    axial_ratio: FloatArray,
) -> FiniteTiltRolling:
    bodies = RigidBody(c=c, kappa=kappa, axial_ratio=axial_ratio)
    with np.errstate(divide="ignore", invalid="ignore"):
        lag = np.where(eta > 0.0, eta / (zeta * bodies.freedom), 0.0)
    undecided = (eta == 0.0) & (zeta == 0.0)

    def spin_at(tilt: FloatArray, rows: Rows) -> FloatArray:
        body = bodies[rows]
        slide = lag[rows] / (body.kappa * body.c * body.height(tilt))
        settled = -nu[rows] * np.sin(tilt) * (np.sin(tilt) + slide) / np.cos(tilt)
        return np.where(undecided[rows], spin[rows], settled)

    def balance(tilt: FloatArray, rows: Rows) -> tuple[FloatArray, FloatArray]:
        body, rate = bodies[rows], nu[rows]
        s, cosine, height = np.sin(tilt), np.cos(tilt), body.height(tilt)
        turning = body.kappa * body.c * spin_at(tilt, rows) * (height + body.c * body.axial_ratio * s)
        fling = rate**2 * s * (body.kappa * height + body.transverse * cosine)
        along = (body.overhang(tilt) + fling - rate * turning) / height
        return along, eta[rows] * rate * s * cosine / height

    scale = np.where(np.isfinite(lag), c / (1.0 + nu**2 * (1.0 + lag)), np.nan)
    tilts = steady_tilts(balance, a0, scale, eta == 0.0)
    exists = np.isfinite(tilts)
    rows, tilt = np.nonzero(exists)[0], tilts[exists]
    along, across = balance(tilt, rows)
    phase, w3, body = np.arctan2(across, along), spin_at(tilt, rows), bodies[rows]
    moved = kappa[rows] * nu[rows] * (body.c * w3 - nu[rows] * np.sin(tilt))
    state = np.stack([np.zeros_like(tilt), nu[rows], tilt, phase, w3])
    growth = _eigenvalues(state, nu[rows], a0[rows], eta[rows], zeta[rows], body)
    stable = np.zeros(exists.shape, dtype=np.bool_)
    stable[exists] = no_deviation_grows(growth, eta[rows])
    return FiniteTiltRolling(
        amplitude=on_branches(shape, exists, tilt),
        phase=on_branches(shape, exists, phase),
        spin=on_branches(shape, exists, w3),
        friction_demand=on_branches(shape, exists, np.hypot(along + moved, across)),
        friction_moment=on_branches(shape, exists, across / np.cos(tilt)),
        exists=exists.reshape(*shape, -1),
        stable=stable.reshape(*shape, -1),
        eigenvalues=on_branches(shape, exists, growth),
    )


def _eigenvalues(
    state: FloatArray, nu: FloatArray, a0: FloatArray, eta: FloatArray, zeta: FloatArray, body: RigidBody
) -> ComplexArray:
    """Return the five eigenvalues of each state; four, and −∞ for the spin, where it follows the rolling at once."""

    def rates_of(chosen: BoolArray) -> Callable[[Numbers], Numbers]:
        some, of = body[chosen], tuple(number[chosen] for number in (nu, a0, eta, zeta))
        return lambda x: rates(x, of[0], of[1], of[2], of[3], some)

    out = np.full((state.shape[1], STATES), -np.inf, dtype=np.complex128)
    held = np.isinf(zeta)
    if not held.all():
        out[~held] = eigenvalues(rates_of(~held), state[:, ~held])
    if held.any():
        with_spin = rates_of(held)

        def without_spin(reduced: Numbers) -> Numbers:
            _, omega, tilt, _ = reduced
            spin = -omega * np.sin(tilt) * np.tan(tilt)  # ω·Z = 0
            return with_spin(np.concatenate([reduced, spin[np.newaxis]]))[:-1]

        out[held, :-1] = eigenvalues(without_spin, state[:-1, held])
    return out
