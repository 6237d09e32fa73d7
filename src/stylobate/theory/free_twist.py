"""Steady rolling of a slender column with free spin: its stability, the limits of its frequency and its friction.

The paper excludes rotation about the vertical. Damping makes a column with free spin lag behind the base. The lag
leaves a component of the base acceleration across the lean, which spins the column up until the spin damping ζ balances
it. The equations describe rolling without slip in the limit of small tilts, in the frame that turns with the base.

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

The critical frequencies are roots in one variable, ν, bracketed on a grid and bisected to rounding. Observed for 30 000
random columns (a0/c from 0.001 to 1000, η from 1e-4 to 5, ζ from 1e-4 to 1e4, κ from 0.05 to 0.99, i_a up to 4):
outside the band without rolling, stability is gained at no more than one frequency ν*, with 1/(3 + η²/(1+b)) ≤ (1+b)ν*²
and ν*² ≤ 1 + 2a0/c. Stability is lost at no more than one higher frequency, and only for i_a < 2κ − 1. For two of the
columns, with the smallest amplitudes and damping, rolling was also stable in a strip next to that band.

That last bound follows from the limit ν → ∞, in which the determinant is a positive factor times a cubic in b = η/(ζΛ).
Its coefficients are all positive for i_a ≥ 2κ − 1. For i_a < 2κ − 1 they change their sign once: rolling at high
frequency is then unstable above some b.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from stylobate.errors import ParameterError
from stylobate.theory.arguments import (
    BoolArray,
    ComplexArray,
    FloatArray,
    Real,
    Truths,
    Values,
    not_negative,
    not_negative_or_infinite,
    plain_results,
    positive,
)
from stylobate.theory.averaging import rotating_frame_jacobian
from stylobate.theory.finite_tilt import no_deviation_grows
from stylobate.theory.rolling import critical_frequency, rolling_amplitudes

_STATES = 5


@dataclass(frozen=True, slots=True, kw_only=True)
class FreeTwistRolling:
    """Steady rolling with free spin, arrays of one shape; NaN (and False) where there is none.

    Parameters
    ----------
    amplitude
        Tilt angle θ [rad].
    phase
        Phase ψ by which the contact point leads the base acceleration [rad].
    spin
        Axial angular velocity σ, in units of ω0.
    friction_moment
        Moment of the spin damping about the vertical, over m g r; with infinite `zeta` the moment that excludes
        rotation.
    exists
        Whether there is such a solution.
    stable
        Whether all deviations decay; without damping, whether none grows.
    eigenvalues
        The five eigenvalues of the Jacobian, complex, along a last axis of length 5. For infinite `zeta` the spin
        follows at once: the four eigenvalues of the paper's column, and −∞.
    """

    amplitude: Values
    phase: Values
    spin: Values
    friction_moment: Values
    exists: Truths
    stable: Truths
    eigenvalues: ComplexArray


@plain_results
def free_twist_rolling(
    nu: Real,
    a0: Real,
    *,
    c: Real,
    eta: Real,
    zeta: Real,
    inertia_ratio: Real = 0.75,
    axial_ratio: Real = 0.5,
) -> FreeTwistRolling:
    """Compute steady rolling with free spin on a base that moves in a circle, upper branch.

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
        Spin damping ζ, a moment about the vertical by which a free spin decays at the rate ζω0. An infinite ζ excludes
        the rotation, as the paper does. ζ = 0 with damping η allows no steady rolling.
    inertia_ratio
        κ = m h²/J0; ¾ for a solid cylinder, as by default.
    axial_ratio
        i_a = I_a/(m r²); ½ for a solid cylinder.

    Returns
    -------
    FreeTwistRolling
        Arrays of the broadcast shape, for the base acceleration a0 (cos ντ, sin ντ).

    Raises
    ------
    ParameterError
        If `nu`, `c`, `inertia_ratio` or `axial_ratio` is not positive, `inertia_ratio` is 1 or more, or another is
        negative.

    See Also
    --------
    steady_rolling : the same without spin.

    Notes
    -----
    With Λ = 1 + i_a − κ, the three balances, along the lean, across it and about the axis, give

        a0 cos ψ = θ(1 + ν²(1 + η/(ζΛ))) − c,   a0 sin ψ = ηνθ,   σ = −ηνθ/(cζκΛ):

    the paper's solution (8) with ν² replaced by ν²(1 + η/(ζΛ)) in the first balance. The column rolls at a smaller tilt
    and spins against its rolling. The contact bears the moment m r a_n about the vertical, where a_n = g ηνθ is the
    base acceleration across the lean. At η = ζ = 0 the spin is arbitrary and set to 0.

    Examples
    --------
    >>> rolling = free_twist_rolling(3.0, 0.065, c=0.1, eta=0.1, zeta=[0.1, 1.0, float("inf")])
    >>> print(rolling.amplitude.round(7), rolling.spin.round(5))
    [0.0074982 0.0147187 0.0164812] [-0.39991 -0.0785   0.     ]
    """
    numbers = _checked_numbers(nu, a0, c, eta, zeta, inertia_ratio, axial_ratio)
    nu, a0, c, eta, zeta, ratio, axial = numbers
    freedom = 1.0 + axial - ratio  # Λ
    with np.errstate(divide="ignore", invalid="ignore"):
        lag = np.where(eta > 0.0, eta / (zeta * freedom), 0.0)
    exists = np.isfinite(lag)
    k, drag = 1.0 + nu**2 * (1.0 + np.where(exists, lag, 0.0)), eta * nu
    scaled, _, _ = rolling_amplitudes(k, drag, a0 / c)
    scaled = np.where(exists, scaled, np.nan)
    exists = np.isfinite(scaled)
    phase = np.arctan2(drag * scaled, k * scaled - 1.0)
    spin = np.where(exists, -lag * nu * scaled / ratio + 0.0, np.nan)
    state = np.stack([np.zeros_like(scaled), nu, c * scaled, phase, spin])
    eigenvalues = _eigenvalues(state, exists, numbers)
    with np.errstate(invalid="ignore"):  # NaN, where there is no rolling, passes through
        stable = no_deviation_grows(eigenvalues, eta)
    return FreeTwistRolling(
        amplitude=c * scaled,
        phase=phase,
        spin=spin,
        friction_moment=c * drag * scaled,
        exists=exists,
        stable=stable & exists,
        eigenvalues=eigenvalues,
    )


def free_twist_jacobian(
    state: Real, a0: Real, *, c: Real, eta: Real, zeta: Real, inertia_ratio: Real = 0.75, axial_ratio: Real = 0.5
) -> FloatArray:
    """Evaluate the Jacobian of rolling with free spin at any state, in the frame that turns with the base motion.

    Parameters
    ----------
    state
        Tilt rate θ̇, rolling rate β̇, tilt angle θ > 0 [rad], phase ψ = β − ντ and spin σ [ω0], along the first axis:
        shape (5, ...).
    a0, c, eta, zeta, inertia_ratio, axial_ratio
        As for `free_twist_rolling`; `zeta` finite.

    Returns
    -------
    numpy.ndarray
        Matrices along the last two axes, shape (..., 5, 5). ν does not enter.

    Raises
    ------
    ParameterError
        If the first axis of `state` does not have five entries.

    Notes
    -----
    With Λ = 1 + i_a − κ:

        θ̈ = θ(1 + β̇²) − c − ηθ̇ − a0 cos ψ − cκσβ̇
        θβ̈ = −2θ̇β̇ − η(1 + i_a)θβ̇/Λ + a0 sin ψ i_a/Λ − cκζσ
        σ̇ = −a0 sin ψ (1 − κ)/(cκΛ) − ηθβ̇/(cΛ) − ζσ
    """
    mu, omega, tilt, psi, spin = _components(state)
    numbers = (a0, c, eta, zeta, inertia_ratio, axial_ratio)
    a, slender, friction, decay, kappa, i_a = (np.asarray(number, dtype=np.float64) for number in numbers)
    push, drive = a * np.cos(psi), a * np.sin(psi)
    freedom = 1.0 + i_a - kappa
    drag = friction * (1.0 + i_a) / freedom
    by_tilt = (2.0 * mu * omega - drive * i_a / freedom + slender * kappa * decay * spin) / tilt**2
    rows = (
        (-friction, 2.0 * tilt * omega - slender * kappa * spin, 1.0 + omega**2, drive, -slender * kappa * omega),
        (
            -2.0 * omega / tilt,
            -2.0 * mu / tilt - drag,
            by_tilt,
            push * i_a / (freedom * tilt),
            -slender * kappa * decay / tilt,
        ),
        (1.0, 0.0, 0.0, 0.0, 0.0),
        (0.0, 1.0, 0.0, 0.0, 0.0),
        (
            0.0,
            -friction * tilt / (slender * freedom),
            -friction * omega / (slender * freedom),
            -push * (1.0 - kappa) / (slender * kappa * freedom),
            -decay,
        ),
    )
    entries = np.broadcast_arrays(*(entry for row in rows for entry in row))
    matrices = np.stack(entries, axis=-1)
    return matrices.reshape(*matrices.shape[:-1], _STATES, _STATES)


def _checked_numbers(
    nu: Real, a0: Real, c: Real, eta: Real, zeta: Real, ratio: Real, axial: Real
) -> tuple[FloatArray, ...]:
    """Return the arguments of `free_twist_rolling` as arrays of one shape, or raise ParameterError."""
    kappa = positive("inertia_ratio", ratio)
    if np.any(kappa >= 1.0):
        raise ParameterError(f"inertia_ratio = m h²/J0 must be below 1, got {np.max(kappa)!r}")
    arrays = (
        positive("nu", nu),
        not_negative("a0", a0),
        positive("c", c),
        not_negative("eta", eta),
        not_negative_or_infinite("zeta", zeta),
        kappa,
        positive("axial_ratio", axial),
    )
    return tuple(np.broadcast_arrays(*arrays))


def _eigenvalues(state: FloatArray, exists: BoolArray, numbers: tuple[FloatArray, ...]) -> ComplexArray:
    """Return the eigenvalues of each solution, NaN elsewhere; −∞ for a spin that follows at once."""
    _, a0, c, eta, zeta, ratio, axial = numbers
    out = np.full((*exists.shape, _STATES), np.nan, dtype=np.complex128)
    held = np.isinf(zeta)
    free = exists & ~held
    if free.any():
        same = {"c": c, "eta": eta, "zeta": zeta, "inertia_ratio": ratio, "axial_ratio": axial}
        chosen = {name: values[free] for name, values in same.items()}
        out[free] = np.linalg.eigvals(free_twist_jacobian(state[:, free], a0[free], **chosen))
    fixed = exists & held
    if fixed.any():
        mu, omega, tilt, psi, _ = (part[fixed] for part in state)
        from_paper = rotating_frame_jacobian(np.stack([mu, omega, tilt, psi]), a0[fixed], eta=eta[fixed])
        out[fixed, : _STATES - 1] = np.linalg.eigvals(from_paper)
        out[fixed, _STATES - 1] = -np.inf
    return out


def _components(state: Real) -> tuple[FloatArray, ...]:
    array = np.asarray(state, dtype=np.float64)
    if array.ndim == 0 or len(array) != _STATES:
        raise ParameterError(
            f"state must have the five entries (θ̇, β̇, θ, ψ, σ) along its first axis, got the shape {array.shape}"
        )
    return tuple(array)


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


def _deviations_decay(nu: FloatArray, x: FloatArray, column: DampedColumn) -> BoolArray:
    """Return whether steady rolling of the upper branch, where p5 > 0, is stable (Liénard–Chipart)."""
    p1, p2, p3, p4, p5 = characteristic(nu, x, column)
    second = p1 * p2 - p3
    fourth = second * (p3 * p4 - p2 * p5) - (p1 * p4 - p5) ** 2
    return (p3 > 0.0) & (second > 0.0) & (fourth > 0.0)


# The grid begins at this fraction of the lower bound of ν* and ends at this multiple of √(1 + a0/c).
_LOWEST, _HIGHEST = 0.9, 1e4
_BELOW, _ABOVE = 40, 240  # nodes below and above the band without rolling
_BISECTIONS = 60


@plain_results
def free_twist_critical_frequency(
    a0: Real, *, c: Real, eta: Real, zeta: Real, inertia_ratio: Real = 0.75, axial_ratio: Real = 0.5
) -> Values:
    """Compute the critical frequency ratio ν* above which steady rolling with free spin is stable.

    Parameters
    ----------
    a0
        Acceleration amplitude of the base [g].
    c
        Slenderness.
    eta
        Damping η.
    zeta
        Spin damping ζ. An infinite ζ excludes the rotation, as the paper does.
    inertia_ratio
        κ = m h²/J0; ¾ for a solid cylinder, as by default.
    axial_ratio
        i_a = I_a/(m r²); ½ for a solid cylinder.

    Returns
    -------
    numpy.ndarray
        Critical frequency, of the broadcast shape. NaN if rolling changes its stability only across the band without
        rolling, as for `critical_frequency`, and without spin damping or base motion. Rolling is stable from ν* to
        `free_twist_upper_frequency`, which is infinite for most columns.

    Raises
    ------
    ParameterError
        If `c`, `inertia_ratio` or `axial_ratio` is not positive, `inertia_ratio` is 1 or more, or another is negative.

    See Also
    --------
    critical_frequency : the same without spin.

    Notes
    -----
    A pair of eigenvalues ±iω_H crosses the imaginary axis at ν*. At a finite ζ

        ν*² = 1 + 2a − η[(1+a)ζ/(a(1+2a)(1−i')) + (1+a)(1+i')(1+a−i'a)/((1+2a)(1−i')ζ) + a/(Λζ)] + O(η²),

    with a = a0/c, Λ = 1 + i_a − κ, i' = i_a/Λ: as η → 0, ν* tends to √(1 + 2a0/c), more than the
    `undamped_critical_frequency` of a column without spin. As ζ → 0, ν* decreases as √ζ.

    Examples
    --------
    >>> print(free_twist_critical_frequency(0.065, c=0.1, eta=0.1, zeta=[0.1, 1.0, float("inf")]).round(4))
    [1.0344 1.3674 1.3971]
    >>> print(free_twist_critical_frequency(0.065, c=0.1, eta=0.01, zeta=[0.1, 1.0, float("inf")]).round(4))
    [1.3972 1.4908 1.4004]
    """
    return _crossing(a0, c, eta, zeta, inertia_ratio, axial_ratio, gained=True)


@plain_results
def free_twist_upper_frequency(
    a0: Real, *, c: Real, eta: Real, zeta: Real, inertia_ratio: Real = 0.75, axial_ratio: Real = 0.5
) -> Values:
    """Compute the upper frequency ratio ν** up to which steady rolling with free spin is stable.

    Parameters
    ----------
    a0, c, eta, zeta, inertia_ratio, axial_ratio
        As for `free_twist_critical_frequency`.

    Returns
    -------
    numpy.ndarray
        Upper frequency, of the broadcast shape; infinite where stability is not lost again below 10⁴ √(1 + a0/c), and
        NaN without spin damping or base motion.

    Raises
    ------
    ParameterError
        As for `free_twist_critical_frequency`.

    Notes
    -----
    ν** is finite only for i_a < 2κ − 1 and weak spin damping. As ζ → 0 it tends to

        ν** → √((1 + a0/c + i_a)/(2κ − 1 − i_a)).

    A solid cylinder lies on the border, i_a = 2κ − 1 = ½, where ν** is infinite.

    Examples
    --------
    >>> column = {"c": 0.1, "eta": 0.1, "axial_ratio": 0.1}
    >>> print(free_twist_upper_frequency(0.065, zeta=[0.003, 0.01, 0.03], **column).round(4))
    [2.3674 6.2357    inf]
    """
    return _crossing(a0, c, eta, zeta, inertia_ratio, axial_ratio, gained=False)


def _crossing(
    a0: Real, c: Real, eta: Real, zeta: Real, inertia_ratio: Real, axial_ratio: Real, *, gained: bool
) -> FloatArray:
    """Return the frequency at which stability is gained or, otherwise, finally lost."""
    _, a0, c, *rest = _checked_numbers(1.0, a0, c, eta, zeta, inertia_ratio, axial_ratio)
    column = DampedColumn(*rest)
    rolls, held = (column.zeta > 0.0) & (a0 > 0.0), np.isinf(column.zeta)
    found = np.full(a0.shape, np.nan)
    chosen = rolls & held
    found[chosen] = critical_frequency(a0[chosen], c=c[chosen], eta=column.eta[chosen]) if gained else np.inf
    chosen = rolls & ~held
    found[chosen] = _bisected(a0[chosen] / c[chosen], DampedColumn(*(part[chosen] for part in column)), gained=gained)
    return found


def _bisected(a: FloatArray, column: DampedColumn, *, gained: bool) -> FloatArray:
    """Return the crossing frequency of each column of a list, `a` being a0/c."""
    # Rows are columns, places in a row are nodes of the grid.
    wide = DampedColumn(*(part[:, np.newaxis] for part in column))
    nodes, joined = _grid(a, column)
    stable = _stable(nodes, a[:, np.newaxis], wide)
    before, after = stable[:, :-1], stable[:, 1:]
    crosses = (~before & after if gained else before & ~after) & joined
    known = crosses.any(axis=1) & (gained | ~stable[:, -1])
    index = crosses.shape[1] - 1 - np.argmax(crosses[:, ::-1], axis=1)  # the highest
    rows = np.arange(a.size)
    low, high = nodes[rows, index], nodes[rows, index + 1]
    for _ in range(_BISECTIONS):
        middle = 0.5 * (low + high)
        below = _stable(middle, a, column) != gained
        low, high = np.where(below, middle, low), np.where(below, high, middle)
    return np.where(known, 0.5 * (low + high), np.nan if gained else np.inf)


def _grid(a: FloatArray, column: DampedColumn) -> tuple[FloatArray, BoolArray]:
    """Return frequencies on both sides of the band without rolling, and whether neighbours share a side."""
    unit = 1.0 / np.sqrt(1.0 + column.lag)
    low, high = _gap(a, column.eta * unit)
    least = np.minimum(low, _LOWEST / np.sqrt(3.0 + (column.eta * unit) ** 2))
    most = high * np.maximum(_HIGHEST * np.sqrt(1.0 + a) / unit, 1.0)
    nodes = np.concatenate([np.geomspace(least, low, _BELOW), np.geomspace(high, most, _ABOVE)])
    joined = np.arange(1, len(nodes)) != _BELOW
    return (unit * nodes).T, joined


def _gap(a: FloatArray, drag: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the ends of the band without rolling in units of 1/√(1 + λ), reciprocal; both 1 if there is none.

    The ends solve z + 1/z = η√(1 − a²)/(a√(1 + λ)), where the root of the amplitude vanishes.
    """
    total = np.maximum(drag * np.sqrt(np.maximum((1.0 - a) * (1.0 + a), 0.0)) / a, 2.0)
    high = 0.5 * (total + np.sqrt((total - 2.0) * (total + 2.0)))
    return 1.0 / high, high


def _stable(nu: FloatArray, a: FloatArray, column: DampedColumn) -> BoolArray:
    """Return whether the upper branch is stable; on its fold, whether the other conditions hold."""
    k, drag = 1.0 + nu**2 * (1.0 + column.lag), column.eta * nu
    square = k**2 + drag**2
    root = np.sqrt(np.maximum((a * np.sqrt(square) - drag) * (a * np.sqrt(square) + drag), 0.0))
    return _deviations_decay(nu, square / (k + root), column)


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
    numbers = _checked_numbers(nu, a0, c, eta, zeta, inertia_ratio, axial_ratio)
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
