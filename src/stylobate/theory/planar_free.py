"""Free planar rocking without damping: (2) and its period."""

import numpy as np

from stylobate.theory.arguments import Real, Values, finite, plain_results, positive


@plain_results
def planar_free_period(amplitude: Real, c: Real) -> Values:
    """Compute the period of free planar rocking: two passages of the vertical.

    Parameters
    ----------
    amplitude
        Peak tilt angle θ0 [rad], positive.
    c
        Slenderness.

    Returns
    -------
    numpy.ndarray
        Period in the time τ, of the broadcast shape; NaN where θ0 ≥ c: the column does not return.

    Raises
    ------
    ParameterError
        If an argument is not positive.

    Notes
    -----
    The inverse of the backbone (3): period = 4 arcosh[c / (c − θ0)] = 8 artanh √[θ0 / (2c − θ0)].

    Examples
    --------
    >>> print(planar_free_period([0.05, 0.1], c=0.1).round(4))
    [5.2678    nan]
    """
    amplitude, c = positive("amplitude", amplitude), positive("c", c)
    ratio = amplitude / c
    inside = ratio < 1.0
    ratio = np.where(inside, ratio, 0.0)
    return np.where(inside, 8.0 * np.arctanh(np.sqrt(ratio / (2.0 - ratio))), np.nan)


@plain_results
def planar_free_motion(tau: Real, amplitude: Real, c: Real) -> tuple[Values, Values]:
    """Compute free planar rocking at any time, from its peak tilt on the positive side at τ = 0.

    Parameters
    ----------
    tau
        Time τ.
    amplitude
        Peak tilt angle θ0 [rad], positive.
    c
        Slenderness.

    Returns
    -------
    tuple of numpy.ndarray
        Signed tilt angle θ [rad] and its rate dθ/dτ, of the broadcast shape; NaN where θ0 ≥ c.

    Raises
    ------
    ParameterError
        If `tau` is not finite or another argument is not positive.

    Notes
    -----
    (2): θ = c − (c − θ0) cosh τ for a quarter period on both sides of the peak tilt. The next half period has the same
    arc with the opposite sign (the printed formula lacks that sign), and so on.

    Examples
    --------
    >>> period = planar_free_period(0.05, c=0.1)
    >>> alpha, rate = planar_free_motion([0.0, 0.5 * period, period], 0.05, c=0.1)
    >>> print(alpha.round(12))
    [ 0.05 -0.05  0.05]
    """
    tau = finite("tau", tau)
    half_period = 0.5 * planar_free_period(amplitude, c)
    amplitude, c = positive("amplitude", amplitude), positive("c", c)
    turn = np.round(tau / half_period)
    side = np.where(np.mod(turn, 2.0) == 0.0, 1.0, -1.0)
    since_turn = tau - turn * half_period
    alpha = side * (c - (c - amplitude) * np.cosh(since_turn))  # (2)
    rate = -side * (c - amplitude) * np.sinh(since_turn)
    return alpha, rate
