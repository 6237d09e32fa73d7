"""Exact response of a linear oscillator to piecewise linear base acceleration (Nigam and Jennings 1969).

With displacement d relative to the base, natural frequency ω and damping ratio ζ::

    d̈ + 2ζω ḋ + ω² d = −a(t)                                                       (1)

Over a step, the next state is linear in the state (d, ḋ) and the accelerations (a0, a1), by one matrix exponential.
"""

import math

import numpy as np
from scipy.linalg import expm
from scipy.signal import lfilter

from stylobate.base_motions.records.record import Floats


def oscillator_response(acceleration: Floats, step: float, period: float, damping: float) -> tuple[Floats, Floats]:
    """Compute relative displacement and velocity of an oscillator at the samples, from rest.

    Parameters
    ----------
    acceleration
        Base acceleration at the samples, shape (n,) or (n, axes) [m/s²].
    step
        Time between samples [s].
    period
        Natural period 2π/ω [s].
    damping
        Damping ratio ζ, zero or above.

    Returns
    -------
    tuple
        Displacements [m] and velocities [m/s], shape of `acceleration`.
    """
    a, b0, b1 = _transition(2.0 * math.pi / period, damping, step)
    denominator = [1.0, -np.trace(a), np.linalg.det(a)]
    displacement = _filtered(a, b0, b1, denominator, 0, acceleration)
    velocity = _filtered(a, b0, b1, denominator, 1, acceleration)
    return displacement, velocity


def _transition(omega: float, damping: float, step: float) -> tuple[Floats, Floats, Floats]:
    """Return A, B0, B1 of (d, ḋ)_{i+1} = A (d, ḋ)_i + B0 a_i + B1 a_{i+1}."""
    # one linear system of d, ḋ, a and the slope of a: its exponential is exact for a linear acceleration
    system = np.array(
        [
            [0.0, 1.0, 0.0, 0.0],
            [-(omega**2), -2.0 * damping * omega, -1.0, 0.0],
            [0.0, 0.0, 0.0, 1.0],
            [0.0, 0.0, 0.0, 0.0],
        ]
    )
    moved = expm(step * system)
    b1 = moved[:2, 3] / step
    return moved[:2, :2], moved[:2, 2] - b1, b1


def _filtered(a: Floats, b0: Floats, b1: Floats, denominator: list[float], row: int, acceleration: Floats) -> Floats:
    """Compute one row of the state, from rest, by the recursion of second order (z − A)⁻¹ (B0 + B1 z)."""
    other = 1 - row
    numerator = [
        b1[row],
        b0[row] - a[other, other] * b1[row] + a[row, other] * b1[other],
        a[row, other] * b0[other] - a[other, other] * b0[row],
    ]
    # filter state that makes output 0 zero and output 1 equal to B0 a0 + B1 a1
    first = acceleration[0]
    memory = np.stack([-b1[row] * first, (b0[row] - numerator[1]) * first])
    response, _ = lfilter(numerator, denominator, acceleration, axis=0, zi=memory)
    return np.asarray(response)


def free_vibration(
    displacement: Floats, velocity: Floats, times: Floats, period: float, damping: float
) -> tuple[Floats, Floats]:
    """Compute displacement and velocity at `times`, shape (n, …), from initial values on a base at rest."""
    omega = 2.0 * math.pi / period
    damped = omega * math.sqrt(1.0 - damping**2)
    t = times.reshape(-1, *(1 for _ in np.shape(displacement)))
    decay, cos, sin = np.exp(-damping * omega * t), np.cos(damped * t), np.sin(damped * t)
    swing = (velocity + damping * omega * displacement) / damped
    d = decay * (displacement * cos + swing * sin)
    v = decay * (velocity * cos - (damping * omega * velocity + omega**2 * displacement) / damped * sin)
    return d, v
