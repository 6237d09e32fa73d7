"""Lower and upper frequency limit of stable steady rolling with free spin.

The tilt follows from ν in closed form and the stability from a determinant, `stylobate.theory.free_twist_stability`. A
root in one variable remains, bracketed on a grid and bisected to rounding. Observed for 30 000 random columns (a0/c
from 0.001 to 1000, η from 1e-4 to 5, ζ from 1e-4 to 1e4, κ from 0.05 to 0.99, i_a up to 4): outside the band without
rolling, stability is gained at no more than one frequency ν*, with 1/(3 + η²/(1+b)) ≤ (1+b)ν*² and ν*² ≤ 1 + 2a0/c.
Stability is lost at no more than one higher frequency, and only for i_a < 2κ − 1. For two of the columns, with the
smallest amplitudes and damping, rolling was also stable in a strip next to that band.

That last bound follows from the limit ν → ∞, in which the determinant is a positive factor times a cubic in b = η/(ζΛ).
Its coefficients are all positive for i_a ≥ 2κ − 1. For i_a < 2κ − 1 they change their sign once: rolling at high
frequency is then unstable above some b.
"""

import numpy as np

from stylobate.theory.arguments import BoolArray, FloatArray, Real, Values, plain_results
from stylobate.theory.critical import critical_frequency
from stylobate.theory.free_twist import checked_numbers
from stylobate.theory.free_twist_stability import DampedColumn, deviations_decay

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
    _, a0, c, *rest = checked_numbers(1.0, a0, c, eta, zeta, inertia_ratio, axial_ratio)
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
    return deviations_decay(nu, square / (k + root), column)
