"""Equations of motion in the frame that turns with a circling base, for plain numbers; one set of its own."""

import numpy as np

from stylobate.theory import finite_tilt as full
from stylobate.theory import slipping_balance as slipping
from stylobate.theory import wobbling
from stylobate.theory.rigid_body import RigidBody


def body_of(c, inertia_ratio=0.75, axial_ratio=0.5):
    return RigidBody(c=np.asarray(c), kappa=np.asarray(inertia_ratio), axial_ratio=np.asarray(axial_ratio))


def full_rolling_rates(state, nu, a0, *, c, eta, zeta, **shape):
    return full.rates(np.asarray(state), nu, a0, eta, np.asarray(zeta), body_of(c, **shape))


def wobbling_rates(state, nu, a0, *, c, eta, **shape):
    return wobbling.rates(np.asarray(state), nu, a0, eta, body_of(c, **shape))


def slipping_rolling_rates(state, nu, a0, *, mu, c, eta, zeta, patch=0.0, **shape):
    frictions = slipping.Resistances(eta=eta, zeta=np.asarray(zeta), mu=mu, patch=patch * np.asarray(c))
    return slipping.rates(np.asarray(state), nu, a0, frictions, body_of(c, **shape))


def free_twist_rates(state, nu, a0, *, c, eta, zeta, inertia_ratio=0.75, axial_ratio=0.5):
    """Return the rates of which `free_twist_jacobian` has the derivatives."""
    (mu, omega, tilt, psi, spin), kappa, i_a = state, inertia_ratio, axial_ratio
    push, drive, freedom = a0 * np.cos(psi), a0 * np.sin(psi), 1.0 + i_a - kappa
    gyroscopic, decay = c * kappa * spin, c * kappa * zeta * spin
    across = -2.0 * mu * omega + (drive * i_a - eta * (1.0 + i_a) * tilt * omega) / freedom - decay
    spin_rate = -(drive * (1.0 - kappa) / kappa + eta * tilt * omega) / (c * freedom) - zeta * spin
    tilting = tilt * (1.0 + omega**2) - c - eta * mu - push - gyroscopic * omega
    return np.stack(np.broadcast_arrays(tilting, across / tilt, mu, omega - nu, spin_rate))
