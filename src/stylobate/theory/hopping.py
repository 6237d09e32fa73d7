"""A block that bounces once in each period of a vibrating plane, in closed form.

The bouncing ball's simplest motion: it is thrown with the absolute normal velocity π cos ψ in g/Ω, flies for one period
and lands with −π cos ψ on the plane whose velocity w then obeys π cos ψ − w = e(π cos ψ + w). With the throw number Γ,

    sin θ = π(1 − e)/((1 + e)Γ),  cos θ < 0,

where θ is the phase at which it lands of the base acceleration cos ψ Γ cos θ. A landing disturbed by δt and δv is
followed by one with the determinant e² and the trace 1 + e² + (1 + e)²Γ cos θ. So it is stable from where it begins,
at cos θ = 0, to where the period doubles, at −Γ cos θ = 2(1 + e²)/(1 + e)² (Holmes 1982).
"""

import numpy as np

from stylobate.theory.arguments import BoolArray, FloatArray, Real, finite, not_negative
from stylobate.theory.starting import steepness
from stylobate.theory.throwing import below_elastic

# Nodes at which the flight is looked at for a contact in between: it comes early, if at all.
_NODES, _FIRST = 1024, 1e-4


def hopping_speed(
    along: Real,
    normal: Real,
    *,
    normal_restitution: Real,
    kinetic_friction: Real,
    phase: Real = 0.0,
    incline: Real = 0.0,
) -> FloatArray:
    """Compute the mean transport velocity of a block that bounces once in each period of the base motion.

    Parameters
    ----------
    along, normal, normal_restitution, kinetic_friction, phase, incline
        As for `block_cycle`.

    Returns
    -------
    numpy.ndarray
        Mean velocity along the plane [g/Ω], of the broadcast shape, uphill positive; NaN where this motion does not
        exist or is not stable, or friction does not hold the block on the incline.

    Raises
    ------
    ParameterError
        If `normal`, `normal_restitution` or `kinetic_friction` is negative, `normal_restitution` is 1 or more or the
        plane is as steep as a wall.

    See Also
    --------
    block_cycle : the motion reached from a given start, which often is another.

    Notes
    -----
    A landing has the normal impulse 2π cos ψ. It can stop a slip of 2π sin ψ, what gravity gives in a flight, if
    μk ≥ abs(tan ψ): the block is thrown without slip and, whatever the friction, moves at

        along sin(θ − phase) − π sin ψ

    on average, on a horizontal plane in line with its vibration π(1 − e)/(1 + e) along/normal.

    Exact. That the block does not touch the plane between its landings is looked at on 1024 nodes: it matters for small
    e. With e = 0 this motion begins only at Γ = √(1 + π²).

    Examples
    --------
    >>> print(hopping_speed(1.0, [1.0, 1.3, 1.6], normal_restitution=0.5, kinetic_friction=0.4).round(6))
    [     nan 0.805537      nan]
    """
    x, z, e, mu, phi, psi = np.broadcast_arrays(
        finite("along", along),
        not_negative("normal", normal),
        below_elastic(normal_restitution),
        not_negative("kinetic_friction", kinetic_friction),
        finite("phase", phase),
        steepness(incline),
    )
    gamma = z / np.cos(psi)
    rising = np.pi * (1.0 - e) / (1.0 + e)  # Γ sin θ
    falling = np.sqrt(np.maximum((gamma - rising) * (gamma + rising), 0.0))  # −Γ cos θ
    stable = (gamma > rising) & (falling * (1.0 + e) ** 2 < 2.0 * (1.0 + e**2))
    holds = mu * np.cos(psi) >= np.abs(np.sin(psi))
    speed = x * np.sin(np.arctan2(rising, -falling) - phi) - np.pi * np.sin(psi)
    return np.where(stable & holds & _clear(e, rising, falling), speed, np.nan)


def _clear(e: FloatArray, rising: FloatArray, falling: FloatArray) -> BoolArray:
    """Whether a flight of one period stays above the plane."""
    e, rising, falling = (number[..., np.newaxis] for number in (e, rising, falling))
    x = np.geomspace(_FIRST, 2.0 * np.pi, _NODES, endpoint=False)
    thrown = 2.0 * np.pi * e / (1.0 + e)
    gap = thrown * x - 0.5 * x**2 + 2.0 * falling * np.sin(0.5 * x) ** 2 + rising * (x - np.sin(x))
    lifted = (e[..., 0] > 0.0) | (falling[..., 0] >= 1.0)
    return np.asarray(lifted & (gap > 0.0).all(axis=-1))
