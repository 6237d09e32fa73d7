"""Block that bounces once per period of a vibrating plane, in closed form.

In the simplest motion of a bouncing ball the block leaves with the absolute normal velocity π cos ι in g/Ω, flies for
one period and lands with −π cos ι. The velocity w of the plane then obeys π cos ι − w = e(π cos ι + w). With the throw
number Γ,

    sin s = π(1 − e)/((1 + e)Γ),  cos s < 0,

where s is the phase of the base acceleration cos ι Γ cos s at the landing. The map of deviations δt and δv from one
landing to the next has the determinant e² and the trace 1 + e² + (1 + e)²Γ cos s. So the motion is stable between its
onset at cos s = 0 and the period doubling at −Γ cos s = 2(1 + e²)/(1 + e)² (Holmes 1982).
"""

import numpy as np

from stylobate.theory.arguments import BoolArray, FloatArray, Real, Values, finite, not_negative, plain_results
from stylobate.theory.starting import steepness
from stylobate.theory.throwing import below_elastic

# Nodes that check the flight for an intermediate contact, which comes early.
_NODES, _FIRST = 1024, 1e-4


@plain_results
def hopping_speed(
    along: Real,
    normal: Real,
    *,
    normal_restitution: Real,
    kinetic_friction: Real,
    phase: Real = 0.0,
    incline: Real = 0.0,
) -> Values:
    """Compute the mean transport velocity of a block that bounces once per period of the base motion.

    Parameters
    ----------
    along, normal, normal_restitution, kinetic_friction, phase, incline
        As for `block_cycle`.

    Returns
    -------
    numpy.ndarray
        Mean velocity along the plane [g/Ω], of the broadcast shape, uphill positive; NaN if this motion does not exist
        or is unstable, or if friction does not hold the block on the incline.

    Raises
    ------
    ParameterError
        If `normal`, `normal_restitution` or `kinetic_friction` is negative, `normal_restitution` is 1 or more or the
        plane is as steep as a wall.

    See Also
    --------
    block_cycle : the motion from given initial conditions, often a different one.

    Notes
    -----
    A landing has the normal impulse 2π cos ι. It can stop the slip 2π sin ι, which gravity adds in a flight, if μk ≥
    abs(tan ι). Then the block is thrown without slip and moves, for any friction, at

        along sin(s − phase) − π sin ι

    on average. On a horizontal plane that vibrates along a line this is π(1 − e)/(1 + e) along/normal.

    Exact. An intermediate contact, possible for small e, is checked on 1024 nodes. With e = 0 this motion exists only
    from Γ = √(1 + π²).

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
    rising = np.pi * (1.0 - e) / (1.0 + e)  # Γ sin s
    falling = np.sqrt(np.maximum((gamma - rising) * (gamma + rising), 0.0))  # −Γ cos s
    stable = (gamma > rising) & (falling * (1.0 + e) ** 2 < 2.0 * (1.0 + e**2))
    holds = mu * np.cos(psi) >= np.abs(np.sin(psi))
    speed = x * np.sin(np.arctan2(rising, -falling) - phi) - np.pi * np.sin(psi)
    return np.where(stable & holds & _clear(e, rising, falling), speed, np.nan)


def _clear(e: FloatArray, rising: FloatArray, falling: FloatArray) -> BoolArray:
    """Return whether a flight of one period stays above the plane."""
    e, rising, falling = (number[..., np.newaxis] for number in (e, rising, falling))
    x = np.geomspace(_FIRST, 2.0 * np.pi, _NODES, endpoint=False)
    thrown = 2.0 * np.pi * e / (1.0 + e)
    gap = thrown * x - 0.5 * x**2 + 2.0 * falling * np.sin(0.5 * x) ** 2 + rising * (x - np.sin(x))
    lifted = (e[..., 0] > 0.0) | (falling[..., 0] >= 1.0)
    return np.asarray(lifted & (gap > 0.0).all(axis=-1))
