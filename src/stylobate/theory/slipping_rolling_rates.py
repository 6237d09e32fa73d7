"""Rates of a rigid column with slip, at any tilt on a circling base, in the frame that turns with the lean."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from stylobate.theory.arguments import FloatArray
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
