"""Stability of steady rolling on a circularly moving base, in closed form.

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
"""

import numpy as np

from stylobate.theory.arguments import BoolArray, ComplexArray, FloatArray


def critical_ratio(nu: FloatArray, eta: FloatArray) -> FloatArray:
    """Return ξ* = c/θ above which the Hopf condition of stability holds, the positive root of ξ² + 2wξ − 4w."""
    return 4.0 / (1.0 + np.sqrt(1.0 + 4.0 / (4.0 * nu**2 + eta**2)))


def satisfies_routh_hurwitz(nu: FloatArray, x: FloatArray, eta: FloatArray, q: FloatArray, p0: FloatArray) -> BoolArray:
    """Return whether no deviation grows; without damping, whether all eigenvalues are imaginary and distinct."""
    return (q > 0.0) & (p0 > 0.0) & (x > critical_ratio(nu, eta))


def rolling_eigenvalues(eta: FloatArray, q: FloatArray, p0: FloatArray) -> ComplexArray:
    """Return the four roots λ along the last axis; roots that would cancel follow from the products."""
    with np.errstate(invalid="ignore"):  # NaN, where there is no rolling, passes through
        return _roots(eta.astype(np.complex128), q.astype(np.complex128), p0.astype(np.complex128))


def _roots(eta: ComplexArray, q: ComplexArray, p0: ComplexArray) -> ComplexArray:
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
