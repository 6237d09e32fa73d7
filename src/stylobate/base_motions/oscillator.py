"""A linear oscillator on a base whose acceleration is linear between samples; the motion of a floor.

The response is exact (N. C. Nigam and P. C. Jennings, "Calculation of response spectra from strong-motion earthquake
records", BSSA 59, 1969). With displacement d relative to the base, natural frequency ω and damping ratio ζ::

    d̈ + 2ζω ḋ + ω² d = −a(t)                                                       (1)

Over a step, the next state is linear in the state (d, ḋ) and the accelerations (a0, a1), by one matrix exponential.
"""

import math

import numpy as np

from stylobate.base_motions.signal_processing import Floats, samples_within_limit
from stylobate.errors import ParameterError, require_positive

# Minimum number of samples in a period of the floor, and the share of its motion that is left at the end.
_PER_PERIOD, _LEFT = 40, 1e-3


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
    from scipy.linalg import expm

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
    from scipy.signal import lfilter

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


def floor_motion(samples: Floats, step: float, period: float, damping: float) -> tuple[Floats, float, str]:
    """Compute the absolute accelerations of a floor that is an oscillator on a moving base; return step and log line.

    Parameters
    ----------
    samples
        Accelerations of the base, shape (n, axes) [m/s²].
    step
        Time step [s].
    period
        Natural period of the floor [s].
    damping
        Damping ratio, positive and below 1.

    Returns
    -------
    tuple
        Accelerations a + d̈ = −2ζω ḋ − ω² d, until the floor is at rest within a thousandth; their step [s], finer than
        that of the base if the period has fewer than 40 of these; and a line for the provenance.

    Raises
    ------
    ParameterError
        If a number is out of range, or the result has more than 10 million samples.
    """
    period, damping = require_positive("period", period, "s"), require_positive("damping", damping)
    if damping >= 1.0:
        raise ParameterError(f"damping must be below 1, got {damping!r}")
    omega = 2.0 * math.pi / period
    parts = max(1, math.ceil(_PER_PERIOD * step / period))
    rest = -math.log(_LEFT) / (damping * omega)
    what = f"{period!r} s with {damping!r} of damping"
    count = (len(samples) * step + rest) * parts / step
    samples_within_limit("period", what, count, "State a longer period, or more damping")
    fine, coarse = np.arange((len(samples) - 1) * parts + 1) / parts, np.arange(len(samples))
    base = np.stack([np.interp(fine, coarse, column) for column in samples.T], axis=-1) if parts > 1 else samples
    own = step / parts
    base = np.pad(base, ((0, math.ceil(rest / own)), (0, 0)))
    d, v = oscillator_response(base, own, period, damping)
    note = f"motion of a floor of period {period!r} s and damping ratio {damping!r}"
    return -2.0 * damping * omega * v - omega**2 * d, own, note
