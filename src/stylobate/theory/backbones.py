"""Backbone curves of a free-standing column: amplitude of free motion versus frequency.

The curve of a rolling column (5) resembles the curve of planar rocking (3) but differs from it.
"""

import numpy as np

from stylobate.theory.arguments import Real, Values, finite, plain_results, positive


@plain_results
def rolling_backbone(omega: Real, c: Real) -> Values:
    """Compute the tilt of free steady rolling round the rim at a rolling rate.

    Parameters
    ----------
    omega
        Rolling rate ω = β̇ of the contact point, either sense.
    c
        Slenderness.

    Returns
    -------
    numpy.ndarray
        Tilt angle [rad], of the broadcast shape.

    Raises
    ------
    ParameterError
        If `omega` is not finite or `c` is not positive.

    Notes
    -----
    (5): θ = c / (1 + ω²). It exists for every ω; without damping it is stable where ω² > 1/3.

    Examples
    --------
    >>> print(rolling_backbone([0.0, 1.0, 3.0], c=0.1))
    [0.1  0.05 0.01]
    """
    omega, c = finite("omega", omega), positive("c", c)
    return c / (1.0 + omega**2)  # (5)


@plain_results
def planar_backbone(omega: Real, c: Real) -> Values:
    """Compute the amplitude of free planar rocking at the frequency ω.

    Parameters
    ----------
    omega
        Frequency ω = 2π / period of the rocking, positive.
    c
        Slenderness.

    Returns
    -------
    numpy.ndarray
        Peak tilt angle [rad], of the broadcast shape.

    Raises
    ------
    ParameterError
        If an argument is not positive.

    Notes
    -----
    (3): θ0 = c [1 − 1/cosh(π/2ω)], written as c tanh x tanh(x/2) with x = π/2ω, which keeps its relative accuracy at
    every frequency. Valid without damping and for motion confined to one plane; out of the plane this motion is
    unstable.

    Examples
    --------
    >>> print(planar_backbone([0.5, 1.0, 3.0], c=0.1).round(4))
    [0.0914 0.0601 0.0123]
    """
    omega, c = positive("omega", omega), positive("c", c)
    quarter_period = 0.5 * np.pi / omega
    return c * np.tanh(quarter_period) * np.tanh(0.5 * quarter_period)  # (3)
