"""Steady rolling on a circularly moving base: exact solution (8) of (7), and its frequency gap."""

from dataclasses import dataclass

import numpy as np

from stylobate.theory.arguments import (
    ComplexArray,
    FloatArray,
    Real,
    Truths,
    Values,
    not_negative,
    plain_results,
    positive,
)
from stylobate.theory.stability import rolling_eigenvalues, satisfies_routh_hurwitz


@dataclass(frozen=True, slots=True, kw_only=True)
class RollingBranch:
    """One branch of steady rolling, arrays of one shape; NaN (and False) where it does not exist.

    Parameters
    ----------
    amplitude
        Tilt angle θ [rad].
    phase
        Phase ψ by which the contact point leads the base acceleration [rad], in (−π, π].
    exists
        Whether there is such a solution.
    stable
        Whether no deviation grows (Routh–Hurwitz). Without damping True means neutrally stable: all eigenvalues are
        imaginary and distinct, and no deviation decays.
    eigenvalues
        The four eigenvalues of the Jacobian of (7), complex, along a last axis of length 4.
    """

    amplitude: Values
    phase: Values
    exists: Truths
    stable: Truths
    eigenvalues: ComplexArray


@dataclass(frozen=True, slots=True, kw_only=True)
class SteadyRolling:
    """Steady rolling in one sense: the azimuth of the contact point is β = sense · (ντ + ψ) + azimuth_offset.

    Parameters
    ----------
    upper
        Branch θ+, phase near 0 away from the folds. Stable above the critical frequency.
    lower
        Branch θ−, phase near ±π away from the folds. Always a saddle.
    sense
        +1 anticlockwise, −1 clockwise.
    azimuth_offset
        Direction of the driving circular motion at τ = 0 [rad].
    """

    upper: RollingBranch
    lower: RollingBranch
    sense: int = 1
    azimuth_offset: Values


@plain_results
def steady_rolling(nu: Real, a0: Real, *, c: Real, eta: Real) -> SteadyRolling:
    """Compute steady rolling of a column round its rim on a circularly moving base.

    Parameters
    ----------
    nu
        Frequency ratio ν = Ω/ω0 of the base motion, positive.
    a0
        Acceleration amplitude of the base [g].
    c
        Slenderness.
    eta
        Damping η.

    Returns
    -------
    SteadyRolling
        Both branches, arrays of the broadcast shape, for the base acceleration a0 (cos ντ, sin ντ).

    Raises
    ------
    ParameterError
        If `nu` or `c` is not positive, or `a0` or `eta` is negative.

    See Also
    --------
    rolling_gap : frequencies at which neither branch exists.
    critical_frequency : frequency above which the upper branch is stable.

    Notes
    -----
    (8): with D = (1+ν²)² + η²ν² the amplitudes are the roots of D θ² − 2c(1+ν²) θ + c² − a0² = 0, the lower from their
    product, since it is a small difference if a0 is near c. The lower branch exists for a0 < c only. The phase follows
    from a0 cos ψ = θ(1+ν²) − c and a0 sin ψ = ηνθ; it is arbitrary (returned as 0 and π) at a0 = 0, where both branches
    are the backbone (5) and exist only without damping.

    Stability is known in closed form, see `stylobate.theory.stability`, without eigenvalues.

    Examples
    --------
    >>> rolling = steady_rolling([1.3, 1.5], 0.065, c=0.1, eta=0.1)
    >>> print(rolling.upper.amplitude.round(6), rolling.upper.stable)
    [0.061157 0.050632] [False  True]
    """
    nu, a, c, eta = np.broadcast_arrays(
        positive("nu", nu), not_negative("a0", a0) / positive("c", c), positive("c", c), not_negative("eta", eta)
    )
    k, drag = 1.0 + nu**2, eta * nu
    upper, lower, root = rolling_amplitudes(k, drag, a)
    d = k**2 + drag**2
    return SteadyRolling(
        upper=_branch(nu, c, eta, upper, root, (k * root - drag**2) / d),
        lower=_branch(nu, c, eta, lower, -root, -(k * root + drag**2) / d),
        azimuth_offset=np.zeros_like(a),
    )


def rolling_amplitudes(k: FloatArray, drag: FloatArray, a: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the roots θ of (kθ − 1)² + (drag θ)² = a², upper and lower, and √(a²D − drag²) with D = k² + drag².

    Roots that are not positive are NaN. All values are in units of c.
    """
    d = k**2 + drag**2
    # a²D − η²ν² as a product keeps the folds accurate
    square = (a * np.sqrt(d) - drag) * (a * np.sqrt(d) + drag)
    root = np.sqrt(np.where(square >= 0.0, square, np.nan))
    upper = (k + root) / d  # (8)
    lower = (1.0 - a) * (1.0 + a) / (d * upper)
    return upper, np.where(lower > 0.0, lower, np.nan), root


def _branch(
    nu: FloatArray, c: FloatArray, eta: FloatArray, ratio: FloatArray, root: FloatArray, push: FloatArray
) -> RollingBranch:
    """Describe the branch θ = c · ratio, where a0 cos ψ = c · push and p0 = root/ratio."""
    exists = np.isfinite(ratio)
    x = 1.0 / ratio
    q = 2.0 * nu**2 - 2.0 + x
    p0 = x * root
    return RollingBranch(
        amplitude=c * ratio,
        phase=np.arctan2(eta * nu * ratio, push),
        exists=exists,
        stable=satisfies_routh_hurwitz(nu, x, eta, q, p0),
        eigenvalues=rolling_eigenvalues(eta, q, p0),
    )


@plain_results
def rolling_gap(a0: Real, *, c: Real, eta: Real) -> tuple[Values, Values]:
    """Compute the band of frequency ratios in which damping excludes steady rolling.

    Parameters
    ----------
    a0
        Acceleration amplitude of the base [g].
    c
        Slenderness.
    eta
        Damping η.

    Returns
    -------
    tuple of numpy.ndarray
        Lower and upper end of the band, the folds at which both branches meet; NaN where rolling exists at every
        frequency, a0 ≥ ηc/√(4 + η²). With damping and no base motion the band is (0, ∞).

    Raises
    ------
    ParameterError
        If `c` is not positive, or `a0` or `eta` is negative.

    Notes
    -----
    The root in (8) vanishes where ν + 1/ν = η√(c² − a0²)/a0: the ends are reciprocal.

    Examples
    --------
    >>> low, high = rolling_gap(0.01, c=0.1, eta=0.3)
    >>> print(round(low, 4), round(high, 4))
    0.3846 2.6004
    """
    a, eta = np.broadcast_arrays(not_negative("a0", a0) / positive("c", c), not_negative("eta", eta))
    inside = a < eta / np.sqrt(4.0 + eta**2)
    still = inside & (a == 0.0)
    ratio = np.where(inside & ~still, a, 1.0)
    total = np.where(still, np.inf, eta * np.sqrt(np.maximum((1.0 - ratio) * (1.0 + ratio), 0.0)) / ratio)
    total = np.where(inside, np.maximum(total, 2.0), np.nan)
    high = 0.5 * (total + np.sqrt((total - 2.0) * (total + 2.0)))
    return 1.0 / high, high
