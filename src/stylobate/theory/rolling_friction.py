"""Friction required for steady rolling without slip on a circularly moving base."""

from dataclasses import dataclass

import numpy as np

from stylobate.theory.arguments import FloatArray, Real, Values, plain_results
from stylobate.theory.free_twist import checked_numbers
from stylobate.theory.rolling import rolling_amplitudes


@dataclass(frozen=True, slots=True, kw_only=True)
class RollingFriction:
    """Required friction coefficient on each branch of steady rolling, arrays of one shape; NaN where no branch exists.

    Parameters
    ----------
    upper
        On the branch of the larger tilt.
    lower
        On the branch of the smaller tilt.
    """

    upper: Values
    lower: Values


@plain_results
def rolling_required_friction(
    nu: Real,
    a0: Real,
    *,
    c: Real,
    eta: Real,
    zeta: Real = np.inf,
    inertia_ratio: Real = 0.75,
    axial_ratio: Real = 0.5,
) -> RollingFriction:
    """Compute the friction coefficient below which the contact of a slender column in steady rolling slips.

    Parameters
    ----------
    nu
        Frequency ratio ν = Ω/ω0 of the base motion, positive.
    a0
        Acceleration amplitude of the base [g].
    c
        Slenderness.
    eta
        Damping η, a couple against the rate of tilt.
    zeta
        Spin damping ζ. An infinite ζ, the default, excludes rotation about the vertical, as the paper does.
    inertia_ratio
        κ = m h²/J0; ¾ for a solid cylinder, as by default.
    axial_ratio
        i_a = I_a/(m r²); ½ for a solid cylinder. No effect if ζ is infinite.

    Returns
    -------
    RollingFriction
        To leading order in c.

    Raises
    ------
    ParameterError
        If `nu`, `c`, `inertia_ratio` or `axial_ratio` is not positive, `inertia_ratio` is 1 or more, or another is
        negative.

    See Also
    --------
    full_rolling : `friction_demand` is the same quantity at any tilt.
    slipping_rolling : steady rolling with slip.
    required_friction : required friction near the vertical, on a base at rest.

    Notes
    -----
    The moments about the centre of mass, not the motion of the base, determine the force. Over m g it is

        T_d = θ(1 + (1 − κ)ν²) − c,   T_n = −ηνθ

    along the lean and across it, with or without spin; the spin enters only by the tilt θ of `steady_rolling` or
    `free_twist_rolling`. Without damping T_d on the upper branch decreases from a0 at low frequency to (1 − κ)a0 − κc
    at high frequency. T_d and the required friction vanish at ν² = a0/(κc − (1 − κ)a0); no such frequency exists for a0
    ≥ κc/(1 − κ). Rolling without slip at all high frequencies requires μ ≥ κc − (1 − κ)a0, which decreases with a0. For
    a smaller μ rolling without slip ends at

        ν² = (a0 + μ)/(κ(a0 + c) − a0 − μ).

    Examples
    --------
    >>> needed = rolling_required_friction([1.2, 1.5, 3.0], 0.065, c=0.1, eta=0.1)
    >>> print(needed.upper.round(4), needed.lower.round(4))
    [0.0116 0.0222 0.0467] [0.0805 0.0832 0.0886]
    """
    numbers = checked_numbers(nu, a0, c, eta, zeta, inertia_ratio, axial_ratio)
    nu, a0, c, eta, zeta, kappa, axial = numbers
    with np.errstate(divide="ignore", invalid="ignore"):
        lag = np.where(eta > 0.0, eta / (zeta * (1.0 + axial - kappa)), 0.0)
    possible = np.isfinite(lag)
    k = 1.0 + nu**2 * (1.0 + np.where(possible, lag, 0.0))
    upper, lower, _ = rolling_amplitudes(k, eta * nu, a0 / c)

    def needed(tilt: FloatArray) -> FloatArray:  # tilt in units of c
        along = tilt * (1.0 + (1.0 - kappa) * nu**2) - 1.0
        return np.where(possible, c * np.hypot(along, eta * nu * tilt), np.nan)

    return RollingFriction(upper=needed(upper), lower=needed(lower))
