"""Steady rolling on a circularly moving base, the exact solution (8) of (7): branches, stability, critical frequency.

With ξ = c/θ, k = 1 + ν² and D = k² + η²ν², small deviations from steady rolling grow as e^{λτ} where

    (λ² + ηλ)² + q (λ² + ηλ) + p0 = 0,    q = 2ν² − 2 + ξ,    p0 = D − kξ.

The quartic of the Jacobian of (7) is thus a quadratic in λ² + ηλ. Routh–Hurwitz requires η > 0, q > 0, p0 > 0 and q² +
2η²q > 4p0. The last difference is ξ² + 2wξ − 4w with w = 4ν² + η², so the condition is

    ξ > ξ* = 4 / (1 + √(1 + 4/w)),    that is    θ < c/ξ*.

On the branches of (8) p0 = ±ξ√(a0²D/c² − η²ν²): positive on the upper branch, negative on the lower. The lower branch
is therefore always a saddle with exactly one positive eigenvalue: for p0 < 0 the two roots λ² + ηλ are real and of
opposite sign, and only the positive root gives a positive λ.

Without damping an equilibrium can at best be neutrally stable. The same inequalities then mean that all four
eigenvalues are imaginary and distinct: deviations neither grow nor decay in the linear approximation.

The boundary θ = c/ξ*, put into (8), gives the critical amplitude in closed form,

    a0*/c = √[(1 + ν² − ξ*)² + η²ν²] / ξ*,    ξ* = 4 / (1 + √(1 + 4/(4ν² + η²))).

On it a pair of eigenvalues ±iω_H crosses the imaginary axis, ω_H² = q/2. The curve begins at q = p0 = 0, on the fold at
the lower end of the band without rolling (a Bogdanov–Takens point), where 3ν⁴ + (2 + η²)ν² = 1. From there a0* rises
with ν without bound: observed on a fine grid for η from 0 to 100, not proved. So ν* exists and is unique for every
amplitude above the amplitude at that point. For a smaller amplitude no ν* exists: rolling is unstable at all
frequencies below the band without rolling and stable at all frequencies above it.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from stylobate.theory.arguments import (
    ComplexArray,
    FloatArray,
    Real,
    Truths,
    Values,
    finite,
    not_negative,
    plain_results,
    positive,
)


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

    Stability is known in closed form without eigenvalues, see the module's notes.

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
    ahead, behind = _pushes(k, drag, root)
    return SteadyRolling(
        upper=_branch(nu, c, eta, upper, root, ahead),
        lower=_branch(nu, c, eta, lower, -root, behind),
        azimuth_offset=np.zeros_like(a),
    )


def rolling_amplitudes(k: Any, drag: Any, a: Any) -> tuple[Any, Any, Any]:
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


def _pushes(k: Any, drag: Any, root: Any) -> tuple[Any, Any]:
    """Return a0 cos ψ of the upper and the lower branch, in units of c."""
    d = k**2 + drag**2
    return (k * root - drag**2) / d, -(k * root + drag**2) / d


def rolling_point(nu: Any, a: Any, eta: Any, *, upper: Any) -> tuple[Any, Any, Any]:
    """Return θ/c, ψ and stability of the upper or lower branch of (8), for a = a0/c; NaN without it.

    It is in the language of the compiler too.
    """
    k, drag = 1.0 + nu**2, eta * nu
    high, low, root = rolling_amplitudes(k, drag, a)
    ahead, behind = _pushes(k, drag, root)
    ratio, push = np.where(upper, high, low), np.where(upper, ahead, behind)
    stable, _, _ = _stability(nu, eta, ratio, np.where(upper, root, -root))
    return ratio, np.arctan2(eta * nu * ratio, push), stable


def _stability(nu: Any, eta: Any, ratio: Any, root: Any) -> tuple[Any, Any, Any]:
    """Return whether rolling with θ = c · ratio is stable, and q and p0, see the module's notes."""
    x = 1.0 / ratio
    q, p0 = 2.0 * nu**2 - 2.0 + x, x * root
    return (q > 0.0) & (p0 > 0.0) & (x > _critical_ratio(nu, eta)), q, p0  # Routh–Hurwitz


def _branch(
    nu: FloatArray, c: FloatArray, eta: FloatArray, ratio: FloatArray, root: FloatArray, push: FloatArray
) -> RollingBranch:
    """Describe the branch θ = c · ratio, where a0 cos ψ = c · push and p0 = root/ratio."""
    exists = np.isfinite(ratio)
    stable, q, p0 = _stability(nu, eta, ratio, root)
    return RollingBranch(
        amplitude=c * ratio,
        phase=np.arctan2(eta * nu * ratio, push),
        exists=exists,
        stable=stable,
        eigenvalues=_eigenvalues(eta.astype(np.complex128), q.astype(np.complex128), p0.astype(np.complex128)),
    )


def _critical_ratio(nu: Any, eta: Any) -> Any:
    """Return ξ* = c/θ above which the Hopf condition of stability holds, the positive root of ξ² + 2wξ − 4w."""
    return 4.0 / (1.0 + np.sqrt(1.0 + 4.0 / (4.0 * nu**2 + eta**2)))


def _eigenvalues(eta: ComplexArray, q: ComplexArray, p0: ComplexArray) -> ComplexArray:
    """Return the four roots λ along the last axis; roots that would cancel follow from the products."""
    with np.errstate(invalid="ignore"):  # NaN, where there is no rolling, passes through
        discriminant = np.sqrt(q**2 - 4.0 * p0)
        larger = -0.5 * (q + np.where(q.real < 0.0, -discriminant, discriminant))
        smaller = _divide(p0, larger)
        pairs = []
        for u in (larger, smaller):
            fast = -0.5 * eta - np.sqrt(0.25 * eta**2 + u)
            pairs += [fast, _divide(-u, fast)]
    return np.stack(pairs, axis=-1)


def _divide(numerator: ComplexArray, denominator: ComplexArray) -> ComplexArray:
    """Divide, with 0/0 = 0: both roots of s² + bs vanish when b does."""
    zero = denominator == 0.0
    return np.where(zero, 0.0, numerator / np.where(zero, 1.0, denominator))


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


_BISECTIONS = 64  # from an interval as long as the root is large to rounding


@plain_results
def critical_amplitude(nu: Real, *, c: Real, eta: Real) -> Values:
    """Compute the base acceleration at which a frequency ratio ν is the critical one.

    Parameters
    ----------
    nu
        Frequency ratio ν = ω_H/ω0 of the base motion, positive.
    c
        Slenderness.
    eta
        Damping η.

    Returns
    -------
    numpy.ndarray
        Amplitude a0* [g], of the broadcast shape: the upper branch of steady rolling is stable for a0 < a0*. NaN below
        the frequency at which the curve begins, where rolling is unstable at every amplitude.

    Raises
    ------
    ParameterError
        If `nu` or `c` is not positive or `eta` is negative.

    Notes
    -----
    From (7), (8) and Routh–Hurwitz; see the module's notes.

    Examples
    --------
    >>> print(critical_amplitude([0.5, 1.0, 1.3971075892], c=0.1, eta=0.1).round(9))
    [       nan 0.02152925 0.065     ]
    """
    nu, c, eta = positive("nu", nu), positive("c", c), not_negative("eta", eta)
    begins = _least_frequency(eta)
    return np.where(nu >= begins, c * _amplitude_ratio(nu, eta), np.nan)


@plain_results
def critical_frequency(a0: Real, *, c: Real, eta: Real) -> Values:
    """Compute the critical frequency ratio ν* above which steady rolling on a circling base is stable.

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
    numpy.ndarray
        Critical frequency, of the broadcast shape. NaN where a0 lies below the minimum critical amplitude: rolling then
        changes its stability only across the band of `rolling_gap`. Slightly above the minimum amplitude that band
        still exists and interrupts the stable range.

    Raises
    ------
    ParameterError
        If `c` is not positive, or `a0` or `eta` is negative.

    Notes
    -----
    The inverse of `critical_amplitude`, bisected to rounding between the start of the curve and √(1 + 2a0/c). For
    straight-line base motion a0 = a1/2 gives the value of averaging, which approximates the exact motion only roughly.

    Examples
    --------
    >>> print(critical_frequency([0.001, 0.02, 0.065], c=0.1, eta=0.1).round(10))
    [       nan 0.98130802 1.39710759]
    """
    return critical_of(*np.broadcast_arrays(not_negative("a0", a0) / positive("c", c), not_negative("eta", eta)))


def critical_of(ratio: Any, eta: Any) -> Any:
    """Return ν* for a = a0/c, the `ratio`, see `critical_frequency`; in the language of the compiler too."""
    low, high = _least_frequency(eta), np.sqrt(1.0 + 2.0 * ratio)  # ξ* < 2 bounds ν*
    exists = ratio >= _amplitude_ratio(low, eta)
    for _ in range(_BISECTIONS):
        middle = 0.5 * (low + high)
        beyond = _amplitude_ratio(middle, eta) > ratio
        low, high = np.where(beyond, low, middle), np.where(beyond, middle, high)
    return np.where(exists, 0.5 * (low + high), np.nan)


@plain_results
def crossing_frequency(a0: Real, *, c: Real, eta: Real) -> Values:
    """Compute the frequency ω_H of the modulation that begins at the critical frequency.

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
    numpy.ndarray
        Imaginary part ω_H of the pair of eigenvalues that crosses at ν*, in the frame that turns with the base motion;
        NaN where there is no ν*.

    Raises
    ------
    ParameterError
        If `c` is not positive, or `a0` or `eta` is negative.

    Notes
    -----
    ω_H² = q/2 = ν*² − 1 + ξ*/2, from the odd part of the characteristic polynomial.

    Examples
    --------
    >>> print(crossing_frequency([0.02, 0.065], c=0.1, eta=0.1).round(4))
    [0.8872 1.3598]
    """
    nu = critical_frequency(a0, c=c, eta=eta)
    eta = not_negative("eta", eta)
    return np.sqrt(np.maximum(nu**2 - 1.0 + 0.5 * _critical_ratio(nu, eta), 0.0))


@plain_results
def undamped_critical_frequency(a0: Real, *, c: Real) -> Values:
    """Compute the critical frequency ratio ν* of the undamped column in closed form.

    Parameters
    ----------
    a0
        Acceleration amplitude of the base [g].
    c
        Slenderness.

    Returns
    -------
    numpy.ndarray
        Critical frequency, of the broadcast shape: 1/√3 as a0 → 0, unbounded for large a0.

    Raises
    ------
    ParameterError
        If `c` is not positive or `a0` is negative.

    Notes
    -----
    ν* = (1+√σ)/√(4 − (1+√σ)²) with σ = a0/(a0 + c): two imaginary pairs of eigenvalues of (7) meet (Krein). Above ν*
    rolling is neutrally stable. Weak damping changes ν* little: at c = η = 0.1 by a quarter to one per cent.

    Examples
    --------
    >>> print(undamped_critical_frequency([0.02, 0.065], c=0.1).round(5))
    [0.99162 1.40046]
    """
    amplitude, c = not_negative("a0", a0), positive("c", c)
    root = np.sqrt(amplitude / (amplitude + c))
    below_two = c / (amplitude + c) / (1.0 + root)  # 1 − √σ without cancellation
    return (1.0 + root) / np.sqrt(below_two * (3.0 + root))


def _least_frequency(eta: Any) -> Any:
    """Return ν at which the critical curve begins, from 3ν⁴ + (2 + η²)ν² = 1."""
    half = 2.0 + eta**2
    return np.sqrt(2.0 / (half + np.sqrt(half**2 + 12.0)))


def _amplitude_ratio(nu: Any, eta: Any) -> Any:
    """Return a0*/c."""
    x = _critical_ratio(nu, eta)
    return np.hypot(1.0 + nu**2 - x, eta * nu) / x
