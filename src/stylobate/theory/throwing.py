"""Throw number, flight duration and bouncing of a body on a base that vibrates along its normal."""

import numpy as np

from stylobate.errors import ParameterError
from stylobate.theory.arguments import FloatArray, Real, Values, not_negative, plain_results, positive
from stylobate.theory.starting import steepness

# Below this angle 2πn the quotient of the throw number comes from its series, since both terms vanish as x³.
_SMALL_ANGLE = 0.3
_TERMS = 8


@plain_results
def throw_number(normal: Real, *, incline: Real = 0.0) -> Values:
    """Compute the throw number Γ of a base motion: a body on the base leaves it if Γ > 1.

    Parameters
    ----------
    normal
        Peak base acceleration along the normal of the plane [g].
    incline
        Angle ι of the plane [rad], between −π/2 and π/2.

    Returns
    -------
    numpy.ndarray
        Γ = normal/cos ι, of the broadcast shape.

    Raises
    ------
    ParameterError
        If `normal` is negative or the plane is as steep as a wall.

    Examples
    --------
    >>> print(throw_number(2.0 * np.sin(np.radians(30.0)), incline=np.radians([0.0, 60.0])).round(12))
    [1. 2.]
    """
    return np.asarray(not_negative("normal", normal) / np.cos(steepness(incline)))


@plain_results
def flight_throw_number(duration: Real) -> Values:
    """Compute the throw number at which a flight that begins in contact lasts a given fraction of the period.

    Parameters
    ----------
    duration
        Duration n of the flight over the period of the base motion, at most 1.

    Returns
    -------
    numpy.ndarray
        Γ, of the broadcast shape: from 1 at n = 0 to √(1 + π²) at n = 1.

    Raises
    ------
    ParameterError
        If `duration` is not between 0 and 1.

    Notes
    -----
    The block leaves the base when the normal force cos ι (1 + Γ cos Ωt) falls through zero. A phase x later its
    distance from the base is cos ι/Ω² times √(Γ² − 1)(x − sin x) − (½x² + cos x − 1). It lands at x = 2πn:

        Γ² = 1 + [(½x² + cos x − 1)/(x − sin x)]².

    Exact. With e = 0 this is the only flight per period for Γ below √(1 + π²) = 3.297. From there to √(4 + π²) = 3.724
    each flight lasts exactly one period, since the block leaves where it lands; above, motions of more periods follow.
    With e > 0 it is the first flight of a throw, if the bouncing after the last throw has ended.

    Examples
    --------
    >>> print(flight_throw_number([0.0, 0.5, 1.0]).round(4))
    [1.     1.3685 3.2969]
    """
    part = not_negative("duration", duration)
    if np.any(part > 1.0):
        message = f"duration must be at most 1 period of the base motion, got {float(np.max(part))!r}"
        raise ParameterError(message)
    x = 2.0 * np.pi * part
    small = x < _SMALL_ANGLE
    far = np.where(small, 1.0, x)
    closed = (0.5 * far**2 - 2.0 * np.sin(0.5 * far) ** 2) / (far - np.sin(far))
    return np.asarray(np.hypot(1.0, np.where(small, _small_quotient(x), closed)))


@plain_results
def bounce_time(speed: Real, *, normal_restitution: Real, weight: Real = 1.0) -> Values:
    """Compute the total time of the bounces that follow a landing under a constant normal acceleration.

    Parameters
    ----------
    speed
        Normal speed v of the landing relative to the base [g/Ω], or [m/s] with `weight` in m/s².
    normal_restitution
        Normal restitution e, below 1.
    weight
        Acceleration N of the block towards its base: cos ι plus the base acceleration along the normal [g].

    Returns
    -------
    numpy.ndarray
        Duration 2ev/(N(1 − e)) [1/Ω], of the broadcast shape.

    Raises
    ------
    ParameterError
        If `speed` or `normal_restitution` is negative, `normal_restitution` is 1 or more or `weight` is not positive.

    Notes
    -----
    The bounces last 2eᵏv/N, a geometric series. Exact only for constant N: on a vibrating base this is the limit of
    small v, in which N is constant during the bouncing.

    Examples
    --------
    >>> print(bounce_time(0.1, normal_restitution=[0.0, 0.5, 0.9]))
    [0.  0.2 1.8]
    """
    e = below_elastic(normal_restitution)
    return np.asarray(2.0 * e * not_negative("speed", speed) / (positive("weight", weight) * (1.0 - e)))


def below_elastic(normal_restitution: Real) -> FloatArray:
    """Return `normal_restitution` as an array of floats, or raise ParameterError unless all lie in [0, 1)."""
    e = not_negative("normal_restitution", normal_restitution)
    if np.any(e >= 1.0):
        message = f"normal_restitution must be below 1, got {float(np.max(e))!r}: elastic bouncing does not end"
        raise ParameterError(message)
    return e


def _small_quotient(x: FloatArray) -> FloatArray:
    """Return (½x² + cos x − 1)/(x − sin x) from the series of both, x⁴/4! − x⁶/6! … and x³/3! − x⁵/5! …."""
    above, below = np.ones_like(x), np.ones_like(x)
    for k in range(_TERMS, 0, -1):
        above = 1.0 - above * x**2 / ((2.0 * k + 3.0) * (2.0 * k + 4.0))
        below = 1.0 - below * x**2 / ((2.0 * k + 2.0) * (2.0 * k + 3.0))
    return 0.25 * x * above / below
