"""Stability of steady rolling with a free twist, from the characteristic polynomial of its five states.

With K = 1 + θ²(1 + λ), λ = η/(ζD), D = 1 + i_a − κ, x = c/A, m = a0 cos ψ/A = K − x, ε = κ/D and ν = i_a/D, small
deviations from steady rolling grow as e^{sτ} where s⁵ + p1 s⁴ + p2 s³ + p3 s² + p4 s + p5 = 0,

    p1 = ζ + η(2 + ε)
    p2 = θ²(3 + 2λ) − 1 + η²(1 + ε) + 2ηζ − νm
    p3 = ζ(3θ² − 1 + 2λθ² + η²) + η(3θ² − 1 + λθ²) + εη(2θ² − 1 + λθ²) − m(ζ + ην)
    p4 = η²θ²(1 + ε) + ηζ(3θ² − 1 + λθ²) + m(2θ² + ν(1 − θ²) − ηζ)
    p5 = ζ(η²θ² + mK).

On the upper branch p5 = ζx√((a0/c)²(K² + η²θ²) − η²θ²) > 0: no real eigenvalue changes its sign there but at a fold. So
stability is lost by a pair ±iΩ, where the fourth Hurwitz determinant vanishes,

    (p1p2 − p3)(p3p4 − p2p5) = (p1p4 − p5)²,    Ω² = (p1p4 − p5)/(p1p2 − p3).

At given θ this is a cubic in c/A.
"""

from typing import NamedTuple

from stylobate.theory.arguments import BoolArray, FloatArray


class Frictions(NamedTuple):
    """Frictions and shape of the column: η, ζ, κ and i_a, arrays that broadcast."""

    eta: FloatArray
    zeta: FloatArray
    kappa: FloatArray
    axial: FloatArray

    @property
    def freedom(self) -> FloatArray:
        """D = 1 + i_a − κ."""
        return 1.0 + self.axial - self.kappa

    @property
    def lag(self) -> FloatArray:
        """λ = η/(ζD)."""
        return self.eta / (self.zeta * self.freedom)


def characteristic(theta: FloatArray, x: FloatArray, column: Frictions) -> tuple[FloatArray, ...]:
    """Return p1 to p5 at the slenderness ratio x = c/A; a0 does not enter, since θ, A and the frictions fix it."""
    eta, zeta = column.eta, column.zeta
    epsilon, nu, lag = column.kappa / column.freedom, column.axial / column.freedom, column.lag
    square = theta**2
    k = 1.0 + square * (1.0 + lag)
    m = k - x
    three = 3.0 * square - 1.0 + lag * square
    return (
        zeta + eta * (2.0 + epsilon),
        three + lag * square + eta**2 * (1.0 + epsilon) + 2.0 * eta * zeta - nu * m,
        zeta * (three + lag * square + eta**2) + eta * three + epsilon * eta * (three - square) - m * (zeta + eta * nu),
        eta**2 * square * (1.0 + epsilon) + eta * zeta * three + m * (2.0 * square + nu * (1.0 - square) - eta * zeta),
        zeta * (eta**2 * square + m * k),
    )


def deviations_decay(theta: FloatArray, x: FloatArray, column: Frictions) -> BoolArray:
    """Whether steady rolling of the upper branch, where p5 > 0, is stable (Liénard–Chipart)."""
    p1, p2, p3, p4, p5 = characteristic(theta, x, column)
    second = p1 * p2 - p3
    fourth = second * (p3 * p4 - p2 * p5) - (p1 * p4 - p5) ** 2
    return (p3 > 0.0) & (second > 0.0) & (fourth > 0.0)
