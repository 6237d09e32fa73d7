"""The slender column or block that stands, and the least pulse of the base that overturns it without an impact."""

from collections.abc import Callable

import numpy as np

from stylobate.theory.arguments import FloatArray, Real, positive

_HALVINGS = 60


def half_sine_overturning(theta: Real, c: Real) -> FloatArray:
    """Least half sine of acceleration that overturns a column at rest, without friction.

    Parameters
    ----------
    theta
        Angular frequency ω of the pulse, a0 sin ωt over half a period, over ω0; for a block over p = √(mgR/K).
    c
        Slenderness; for a block the angle α or its tangent, equal to the order of this theory.

    Returns
    -------
    numpy.ndarray
        Least acceleration a0 in g, of the broadcast shape. A weaker pulse never overturns, whatever the restitution.

    Raises
    ------
    ParameterError
        If an argument is not positive.

    See Also
    --------
    one_sine_overturning : the same for a whole sine.

    Notes
    -----
    For small tilt and slenderness, in the plane. The column is released where a0 sin θτ = c. With u the tilt over c and
    a = a0/c, the growing part z = u − 1 + u̇ of its motion obeys ż = z + a sin θτ from z = −1. It overturns if z > 0 at
    the end of the pulse, from where z grows by itself, and with s = √(a² − 1) z vanishes there for

        s + √(1 + s²) exp[−(π/2 + arctan s)/θ] = θ,

    whose left side grows with s. G. W. Housner (Bulletin of the Seismological Society of America 53, 1963) asked for
    it; J. Zhang and N. Makris, "Rocking response of free-standing blocks under cycloidal pulses", Journal of
    Engineering Mechanics 127 (2001), answer for a block.

    Examples
    --------
    >>> print(half_sine_overturning([2.0, 5.0, 10.0], c=1.0).round(4))
    [1.8007 3.2891 5.7865]
    """
    theta, c = np.broadcast_arrays(positive("theta", theta), positive("c", c))
    return c * _least(theta, lambda s: s + _left(s, 0.5, theta), theta)


def one_sine_overturning(theta: Real, c: Real) -> FloatArray:
    """Least whole sine of acceleration that overturns a column at rest without an impact, and without friction.

    Parameters
    ----------
    theta
        Angular frequency ω of the pulse, a0 sin ωt over one period, over ω0; for a block over p = √(mgR/K).
    c
        Slenderness; for a block the angle α or its tangent, equal to the order of this theory.

    Returns
    -------
    numpy.ndarray
        Least acceleration a0 in g, of the broadcast shape. Weaker pulses may overturn the column on its other side,
        after an impact; how strong these are depends on the restitution, and a gap may lie between the two.

    Raises
    ------
    ParameterError
        If an argument is not positive.

    See Also
    --------
    half_sine_overturning : the first half of the pulse alone.

    Notes
    -----
    As there, now with a whole sine behind which z vanishes:

        s − √(1 + s²) exp[−(3π/2 + arctan s)/θ] = θ.

    The column overturns the way that the first half pushes it (Zhang and Makris 2001, mode 2).

    Examples
    --------
    >>> print(one_sine_overturning(5.0, c=1.0).round(4))
    7.1681
    """
    theta, c = np.broadcast_arrays(positive("theta", theta), positive("c", c))
    longest = np.exp(-1.5 * np.pi / theta)  # √(1 + s²) ≤ 1 + s
    return c * _least(theta, lambda s: s - _left(s, 1.5, theta), (theta + longest) / (1.0 - longest))


def _left(s: FloatArray, turns: float, theta: FloatArray) -> FloatArray:
    """Return √(1 + s²) exp(−Δτ), Δτ from the release at θτ = arctan(1/s) to the end at θτ = (`turns` + ½)π."""
    return np.asarray(np.sqrt(1.0 + s**2) * np.exp(-(turns * np.pi + np.arctan(s)) / theta))


def _least(theta: FloatArray, growing: Callable[[FloatArray], FloatArray], high: FloatArray) -> FloatArray:
    """Return √(1 + s²) where a function of s that grows from below θ at 0 to above it at `high` is θ."""
    low = np.zeros_like(theta)
    for _ in range(_HALVINGS):
        s = 0.5 * (low + high)
        short = growing(s) < theta
        low, high = np.where(short, s, low), np.where(short, high, s)
    return np.asarray(np.sqrt(1.0 + (0.5 * (low + high)) ** 2))
