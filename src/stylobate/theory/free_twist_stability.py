"""Stability of steady rolling with free spin from the characteristic polynomial of its five states.

With b = η/(ζΛ), Λ = 1 + i_a − κ, k = 1 + ν²(1 + b), ξ = c/θ, f = a0 cos ψ/θ = k − ξ, κ' = κ/Λ and i' = i_a/Λ, small
deviations from steady rolling grow as e^{λτ} where λ⁵ + p1 λ⁴ + p2 λ³ + p3 λ² + p4 λ + p5 = 0,

    p1 = ζ + η(2 + κ')
    p2 = ν²(3 + 2b) − 1 + η²(1 + κ') + 2ηζ − i'f
    p3 = ζ(3ν² − 1 + 2bν² + η²) + η(3ν² − 1 + bν²) + κ'η(2ν² − 1 + bν²) − f(ζ + ηi')
    p4 = η²ν²(1 + κ') + ηζ(3ν² − 1 + bν²) + f(2ν² + i'(1 − ν²) − ηζ)
    p5 = ζ(η²ν² + fk).

On the upper branch p5 = ζξ√((a0/c)²(k² + η²ν²) − η²ν²) > 0: a real eigenvalue changes its sign only at a fold. So
stability is lost by a pair ±iω_H, where the fourth Hurwitz determinant vanishes,

    (p1p2 − p3)(p3p4 − p2p5) = (p1p4 − p5)²,    ω_H² = (p1p4 − p5)/(p1p2 − p3).

At given ν this is a cubic in ξ.
"""

from typing import NamedTuple

from stylobate.theory.arguments import BoolArray, FloatArray


class DampedColumn(NamedTuple):
    """Damping and shape of the column: η, ζ, κ and i_a, arrays that broadcast."""

    eta: FloatArray
    zeta: FloatArray
    kappa: FloatArray
    axial: FloatArray

    @property
    def freedom(self) -> FloatArray:
        """Λ = 1 + i_a − κ."""
        return 1.0 + self.axial - self.kappa

    @property
    def lag(self) -> FloatArray:
        """b = η/(ζΛ)."""
        return self.eta / (self.zeta * self.freedom)


def characteristic(nu: FloatArray, x: FloatArray, column: DampedColumn) -> tuple[FloatArray, ...]:
    """Return p1 to p5 at ξ = c/θ; ν, θ and the damping determine a0."""
    eta, zeta = column.eta, column.zeta
    epsilon, axial_share, lag = column.kappa / column.freedom, column.axial / column.freedom, column.lag
    square = nu**2
    k = 1.0 + square * (1.0 + lag)
    m = k - x
    three = 3.0 * square - 1.0 + lag * square
    return (
        zeta + eta * (2.0 + epsilon),
        three + lag * square + eta**2 * (1.0 + epsilon) + 2.0 * eta * zeta - axial_share * m,
        zeta * (three + lag * square + eta**2)
        + eta * three
        + epsilon * eta * (three - square)
        - m * (zeta + eta * axial_share),
        eta**2 * square * (1.0 + epsilon)
        + eta * zeta * three
        + m * (2.0 * square + axial_share * (1.0 - square) - eta * zeta),
        zeta * (eta**2 * square + m * k),
    )


def deviations_decay(nu: FloatArray, x: FloatArray, column: DampedColumn) -> BoolArray:
    """Return whether steady rolling of the upper branch, where p5 > 0, is stable (Liénard–Chipart)."""
    p1, p2, p3, p4, p5 = characteristic(nu, x, column)
    second = p1 * p2 - p3
    fourth = second * (p3 * p4 - p2 * p5) - (p1 * p4 - p5) ** 2
    return (p3 > 0.0) & (second > 0.0) & (fourth > 0.0)
