"""Critical frequency ν* below which steady rolling on a circularly moving base is unstable, for any damping.

The boundary θ = c/ξ* of `stylobate.theory.stability`, put into (8), gives the critical amplitude in closed form,

    a0*/c = √[(1 + ν² − ξ*)² + η²ν²] / ξ*,    ξ* = 4 / (1 + √(1 + 4/(4ν² + η²))).

On it a pair of eigenvalues ±iω_H crosses the imaginary axis, ω_H² = q/2. The curve begins at q = p0 = 0, on the fold at
the lower end of the band without rolling (a Bogdanov–Takens point), where 3ν⁴ + (2 + η²)ν² = 1. From there a0* rises
with ν without bound: observed on a fine grid for η from 0 to 100, not proved. So ν* exists and is unique for every
amplitude above the amplitude at that point. For a smaller amplitude no ν* exists: rolling is unstable at all
frequencies below the band without rolling and stable at all frequencies above it.
"""

import numpy as np

from stylobate.theory.arguments import FloatArray, Real, Values, not_negative, plain_results, positive
from stylobate.theory.stability import critical_ratio

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
    ratio, eta = np.broadcast_arrays(not_negative("a0", a0) / positive("c", c), not_negative("eta", eta))
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
    return np.sqrt(np.maximum(nu**2 - 1.0 + 0.5 * critical_ratio(nu, eta), 0.0))


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


def _least_frequency(eta: FloatArray) -> FloatArray:
    """Return ν at which the critical curve begins, from 3ν⁴ + (2 + η²)ν² = 1."""
    half = 2.0 + eta**2
    return np.sqrt(2.0 / (half + np.sqrt(half**2 + 12.0)))


def _amplitude_ratio(nu: FloatArray, eta: FloatArray) -> FloatArray:
    """Return a0*/c."""
    x = critical_ratio(nu, eta)
    return np.hypot(1.0 + nu**2 - x, eta * nu) / x
