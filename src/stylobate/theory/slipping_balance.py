"""Balances of steady rolling with slip on a circularly moving base, and all their solutions.

In the frame that turns with the lean the motion is steady. So the contact bears the weight, and the moments about the
centre of mass give T_d, T_n and the moment about the vertical from tilt and spin. The friction law and the circular
motion of the centre of mass determine tilt and slip.
"""

from dataclasses import dataclass

import numpy as np

from stylobate.theory.arguments import BoolArray, FloatArray
from stylobate.theory.finite_tilt import tilt_grid
from stylobate.theory.rigid_body import Numbers, RigidBody
from stylobate.theory.slipping_pairs import common_zeros
from stylobate.theory.slipping_rolling_rates import EASED, EXPONENT, SLOWED, TWISTING, Resistances
from stylobate.theory.zeros import Rows, zeros

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
