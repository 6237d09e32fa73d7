"""Balances of steady rolling with slip on a circularly moving base, and all their solutions.

In the frame that turns with the lean the motion is steady. So the contact bears the weight, and the moments about the
centre of mass give T_d, T_n and the moment about the vertical from tilt and spin. The friction law and the circular
motion of the centre of mass determine tilt and slip.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np

from stylobate.theory.arguments import BoolArray, FloatArray
from stylobate.theory.finite_tilt import Rows, tilt_grid, zeros
from stylobate.theory.rigid_body import Numbers, RigidBody

STATES = 7

# Friction on a patch (Coulomb–Contensou) after Zhuravlev: exponent p, and coefficients of Hertz pressure.
EXPONENT, SLOWED, TWISTING, EASED = 3, 8.0 / (3.0 * np.pi), 3.0 * np.pi / 16.0, 15.0 * np.pi / 16.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Resistances:
    """Resistances to the motion, arrays of one shape: η, ζ, μ and the radius ε of the contact over h."""

    eta: FloatArray
    zeta: FloatArray
    mu: FloatArray
    patch: FloatArray

    def __getitem__(self, cells: Any) -> "Resistances":
        return Resistances(eta=self.eta[cells], zeta=self.zeta[cells], mu=self.mu[cells], patch=self.patch[cells])


def rates(state: Numbers, nu: FloatArray, a0: FloatArray, friction: Resistances, body: RigidBody) -> Numbers:
    """Evaluate the right-hand side of a column that slips on its base, in the frame of the circular base motion.

    Parameters
    ----------
    state
        Tilt rate θ̇, rolling rate β̇, tilt angle θ > 0 [rad], phase ψ = β − ντ, axial angular velocity σ [ω0], and
        the slip of the contact point along and across the lean, v_d and v_n [hω0], real or complex, along the first
        axis: shape (7, ...).
    nu
        Frequency ratio ν = Ω/ω0 of the base motion.
    a0
        Acceleration amplitude of the base [g].
    friction
        Damping and friction. An infinite ζ excludes rotation about the vertical; the state must then have
        σ cos θ + β̇ sin²θ = 0.
    body
        The column.

    Returns
    -------
    numpy.ndarray
        Rates of the state in the same order, shape (7, ...). Not defined at θ = 0, nor without slip.

    Notes
    -----
    Over J0, with s = sin θ, p = cos θ + cs, z' = c cos θ − s, w1 = −β̇s, T = −μN v/|v| over m g and G2 = I_t β̇²s cos θ −
    I_aβ̇sσ − ηθ̇:

        N = [1 + κ(z'G2/I_t − pθ̇²)]/[1 + (κ/I_t) z'(z' + pT_d/N)]
        I_t θ̈ = G2 − N z' − p T_d,   ẇ1 = β̇θ̇ cos θ − (I_a/I_t)θ̇σ + (T_n + M1)/I_t,   σ̇ = (c T_n + M3)/I_a

    M1 = −ηw1 − Ms, M3 = M cos θ, and M is the moment about the vertical: −ζκc²Λω_z of the spin damping plus the moment
    of the patch. The centre of mass has the velocity V = (v_d + pθ̇, v_n − cσ − w1) and the acceleration T/κ − a.
    """
    w2, omega, tilt, psi, w3, along, across = state
    s, cosine, p = np.sin(tilt), np.cos(tilt), body.height(tilt)
    slope = -body.overhang(tilt)  # z'
    w1 = -omega * s
    g2 = body.transverse * omega**2 * s * cosine - body.axial * omega * s * w3 - friction.eta * w2
    per_d, per_n, per_z = contact(along, across, w3 * cosine - w1 * s, friction)
    painleve = 1.0 + body.kappa / body.transverse * slope * (slope + p * per_d)
    normal = (1.0 + body.kappa * (slope * g2 / body.transverse - p * w2**2)) / painleve
    t_d, t_n = per_d * normal, per_n * normal
    w2_rate = (g2 - normal * slope - p * t_d) / body.transverse

    def turning(moment: Numbers) -> tuple[Numbers, Numbers]:
        gyroscopic = omega * w2 * cosine - body.axial / body.transverse * w2 * w3
        w1_rate = gyroscopic + (t_n - friction.eta * w1 - moment * s) / body.transverse
        return w1_rate, (body.c * t_n + moment * cosine) / body.axial

    def vertical(moment: Numbers) -> Numbers:  # (ω·Z)˙, linear in the moment
        w1_rate, w3_rate = turning(moment)
        return np.asarray(w3_rate * cosine - w1_rate * s - w2 * (w3 * s + w1 * cosine))

    held = np.isinf(friction.zeta)
    pivoting = np.where(held, 0.0, friction.zeta) * body.kappa * body.c**2 * body.freedom
    moment = per_z * normal - pivoting * (w3 * cosine - w1 * s)
    if held.any():
        without = vertical(np.zeros_like(moment))
        moment = np.where(held, without / (without - vertical(np.ones_like(moment))), moment)
    w1_rate, w3_rate = turning(moment)
    v_d, v_n = along + p * w2, across - body.c * w3 - w1  # of the centre of mass
    v_d_rate = omega * v_n + (t_d - a0 * np.cos(psi)) / body.kappa
    v_n_rate = -omega * v_d + (t_n + a0 * np.sin(psi)) / body.kappa
    return np.stack(
        np.broadcast_arrays(
            w2_rate,
            -(w1_rate + omega * w2 * cosine) / s,
            w2,
            omega - nu,
            w3_rate,
            v_d_rate - p * w2_rate - slope * w2**2,
            v_n_rate + body.c * w3_rate + w1_rate,
        )
    )


def contact(along: Numbers, across: Numbers, turn: Numbers, friction: Resistances) -> tuple[Numbers, Numbers, Numbers]:
    """Return T_d, T_n and M_z over N, the moment also over h, of a contact that slips and turns at ω_z = `turn`."""
    speed = np.sqrt(along**2 + across**2)
    pivot = np.sqrt((friction.patch * turn) ** 2)
    # T = −μN v/(|v|^p + (8s/3π)^p)^{1/p};  M_z = −(3π/16) μNε (εω_z)/(s^p + (15π|v|/16)^p)^{1/p},  s = ε|ω_z|
    drag = friction.mu / (speed**EXPONENT + (SLOWED * pivot) ** EXPONENT) ** (1.0 / EXPONENT)
    twist = friction.mu / (pivot**EXPONENT + (EASED * speed) ** EXPONENT) ** (1.0 / EXPONENT)
    return -drag * along, -drag * across, -TWISTING * twist * friction.patch**2 * turn


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


# Points of the scan over the tilt.
_POINTS = 512


@dataclass(frozen=True, slots=True)
class Forced:
    """Columns that roll and slip on circularly moving bases: arrays of one length.

    Parameters
    ----------
    nu, a0
        Frequency ν and acceleration amplitude of the base [g].
    spin
        w3 [ω0], used if the spin is arbitrary.
    friction
        Damping and friction.
    body
        The columns.
    """

    nu: FloatArray
    a0: FloatArray
    spin: FloatArray
    friction: Resistances
    body: RigidBody

    def __getitem__(self, rows: Rows) -> "Forced":
        return Forced(self.nu[rows], self.a0[rows], self.spin[rows], self.friction[rows], self.body[rows])

    @property
    def undecided(self) -> BoolArray:
        """Whether the spin is arbitrary."""
        free = (self.friction.eta == 0.0) & (self.friction.zeta == 0.0) & (self.friction.patch == 0.0)
        return np.asarray(free)

    @property
    def pivots(self) -> BoolArray:
        """Whether a patch turns on the base at an unknown rate."""
        turns = (self.friction.eta > 0.0) & np.isfinite(self.friction.zeta) & (self.friction.patch > 0.0)
        return np.asarray(turns)

    @property
    def resistance(self) -> FloatArray:
        """Moment of a finite spin damping per rate of turn, ζκc²D."""
        body = self.body
        return self.friction.zeta * body.kappa * body.c**2 * body.freedom

    def moment(self, tilt: Numbers) -> Numbers:
        """Compute the moment about the vertical of rolling at a tilt."""
        return np.asarray(self.friction.eta * self.nu * self.body.c * np.sin(tilt) / self.body.height(tilt))

    def turn(self, tilt: FloatArray) -> FloatArray:
        """Compute ω_z without the patch."""
        s, cosine = np.sin(tilt), np.cos(tilt)
        with np.errstate(divide="ignore", invalid="ignore"):
            needed = np.where(self.friction.eta > 0.0, self.moment(tilt) / self.resistance, 0.0)
        return np.where(self.undecided, self.spin * cosine + self.nu * s**2, -needed)

    def axial_spin(self, tilt: Numbers, turn: Numbers) -> Numbers:
        """Compute w3 from ω_z = w3 cos θ + ν sin²θ."""
        return np.asarray((turn - self.nu * np.sin(tilt) ** 2) / np.cos(tilt))

    def force(self, tilt: Numbers, turn: Numbers) -> tuple[Numbers, Numbers]:
        """Compute T_d and T_n over m g of steady tilt and rolling."""
        s, cosine, p = np.sin(tilt), np.cos(tilt), self.body.height(tilt)
        gyration = self.nu * s * (
            self.body.transverse * self.nu * cosine - self.body.axial * self.axial_spin(tilt, turn)
        )  # fmt: skip
        return (self.body.overhang(tilt) + gyration) / p, -self.friction.eta * self.nu * s * cosine / p

    def carried(self, tilt: Numbers, turn: Numbers) -> Numbers:
        """Compute κνw, the acceleration of the centre of mass over g in its circle without slip."""
        w = self.body.c * self.axial_spin(tilt, turn) - self.nu * np.sin(tilt)
        return np.asarray(self.body.kappa * self.nu * w)


def solutions(forced: Forced) -> tuple[Rows, FloatArray, FloatArray, FloatArray]:
    """Return row, tilt, ω_z and speed of slip of all solutions, by rows, then tilt, then speed."""
    found = [_known_turn(forced), _pivoting(forced)]
    rows, tilt, turn, speed = (np.concatenate(part) for part in zip(*found, strict=True))
    order = np.lexsort((speed, tilt, rows))
    return rows[order], tilt[order], turn[order], speed[order]


def _known_turn(forced: Forced) -> tuple[Rows, FloatArray, FloatArray, FloatArray]:
    """Return the solutions if ω_z follows from the tilt: one equation for the tilt, a quadratic for the slip."""
    possible = np.flatnonzero(~forced.pivots & ((forced.friction.eta == 0.0) | (forced.friction.zeta > 0.0)))

    def excess(tilt: FloatArray, at: Rows) -> FloatArray:  # |T|² − μ²
        here = forced[possible[at]]
        along, across = here.force(tilt, here.turn(tilt))
        return np.asarray((along - here.friction.mu) * (along + here.friction.mu) + across**2)

    some = forced[possible]
    at, tilt = zeros(excess, tilt_grid(some.body.c / (1.0 + some.body.transverse * some.nu**2), _POINTS))
    here = some[at]
    turn = here.turn(tilt)
    along, across = here.force(tilt, turn)
    carried = here.carried(tilt, turn)
    # U = κν|v|:  U² + 2UκνwT_n/μ = a0² − (T_d − κνw)² − T_n²,  wT_n ≥ 0
    half = carried * across / here.friction.mu
    needed = np.hypot(along - carried, across)
    left = (here.a0 - needed) * (here.a0 + needed)
    slips = left > 0.0
    half, left, here = half[slips], left[slips], here[np.flatnonzero(slips)]
    speed = left / (half + np.sqrt(half**2 + left)) / (here.body.kappa * here.nu)
    return possible[at[slips]], tilt[slips], turn[slips], speed


# Scan of a patch that turns: points of ln |ω_z| and of ln |v|, and their range below and above their scales.
_TURNS, _SPEEDS = 120, 120
_LEAST_TURN, _MOST_TURN, _LEAST_SPEED, _MOST_SPEED = 1e-7, 1e4, 1e-7, 1e2


def _pivoting(forced: Forced) -> tuple[Rows, FloatArray, FloatArray, FloatArray]:
    """Return the solutions of a patch that slips and turns: the moments give the tilt, two equations remain."""
    possible = np.flatnonzero(forced.pivots)
    some = forced[possible]
    across = (some.a0 + some.friction.mu + some.body.c) / (some.body.kappa * some.nu)

    def balance(turn: Numbers, speed: Numbers, at: Rows) -> tuple[Numbers, Numbers]:
        return _two_balances(some[at], np.exp(turn), np.exp(speed))

    at, turn, speed = common_zeros(
        balance,
        np.log(some.nu)[:, np.newaxis] + np.linspace(np.log(_LEAST_TURN), np.log(_MOST_TURN), _TURNS),
        np.log(across)[:, np.newaxis] + np.linspace(np.log(_LEAST_SPEED), np.log(_MOST_SPEED), _SPEEDS),
    )
    turn, speed = np.exp(turn), np.exp(speed)
    tilt, _ = _pivoted(some[at], turn, speed)
    return possible[at], np.asarray(tilt, dtype=np.float64), -turn, speed


def _pivoted(here: Forced, turn: Numbers, speed: Numbers) -> tuple[Numbers, Numbers]:
    """Return the tilt at which the moments balance with ω_z = −`turn`, NaN without solution, and |T|/N."""
    pivot = here.friction.patch * turn
    drag = here.friction.mu * speed / (speed**EXPONENT + (SLOWED * pivot) ** EXPONENT) ** (1.0 / EXPONENT)
    twist = here.friction.mu * pivot / (pivot**EXPONENT + (EASED * speed) ** EXPONENT) ** (1.0 / EXPONENT)
    moment = here.resistance * turn + TWISTING * here.friction.patch * twist
    # M = ηνc tan θ/(1 + c tan θ)
    left = here.body.c * (here.friction.eta * here.nu - moment)
    with np.errstate(invalid="ignore", divide="ignore"):
        tilt = np.arctan(np.where(left.real > 0.0, moment / left, np.nan))
    return tilt, drag


def _two_balances(here: Forced, turn: Numbers, speed: Numbers) -> tuple[Numbers, Numbers]:
    """Return the residuals of the force across the lean and of the base acceleration."""
    tilt, drag = _pivoted(here, turn, speed)
    along, across = here.force(tilt, -turn)
    fling = here.body.kappa * here.nu * speed / drag  # κνv = −fling T
    push = along - here.carried(tilt, -turn) - fling * across
    drive = fling * along + across
    scale = (here.a0 + here.friction.mu) ** 2
    return (along**2 + across**2) / drag**2 - 1.0, (push**2 + drive**2 - here.a0**2) / scale
