"""Rates of rolling without slip of a rigid column, at any tilt and with free spin, in the rotating frame."""

import numpy as np

from stylobate.theory.arguments import FloatArray
from stylobate.theory.rigid_body import Numbers, RigidBody

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
