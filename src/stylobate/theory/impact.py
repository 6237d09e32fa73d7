"""Impacts and pulses: restitution, equivalent damping, and pulses that overturn a column or block at rest."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Self

import numpy as np

from stylobate.errors import ParameterError
from stylobate.theory.arguments import BoolArray, FloatArray, Real, Values, not_negative, plain_results, positive
from stylobate.theory.rigid_body import below_one


@plain_results
def housner_restitution(c: Real, *, inertia_ratio: Real = 0.75) -> Values:
    """Compute the restitution of an impact that neither bounces nor slips (Housner).

    Parameters
    ----------
    c
        Slenderness.
    inertia_ratio
        κ = m h²/J0; ¾ for a slender solid cylinder, as by default, and 1/(4/3 + c²/4) for one of slenderness c.

    Returns
    -------
    numpy.ndarray
        e, of the broadcast shape, between 0 and 1: the energy of the motion falls by the factor e².

    Raises
    ------
    ParameterError
        If `c` is not positive or `inertia_ratio` not between 0 and 1.

    See Also
    --------
    block_restitution : the same for a rectangular block.
    required_friction : friction below which the contact slips in the impact.

    Notes
    -----
    The moment of momentum about the new contact point is conserved (Housner 1963): with J0 − m r² before and K = J0 + m
    r² after the impact,

        e = 1 − 2 m r²/K = (1 − κc²)/(1 + κc²).

    A body with κc² ≥ 1 is so flat that it does not rebound: e = 0. Measured losses of columns were larger or smaller.

    Examples
    --------
    >>> c = np.array([0.1, 0.2])
    >>> print(housner_restitution(c, inertia_ratio=1.0 / (4.0 / 3.0 + c**2 / 4.0)).round(6))
    [0.985139 0.942169]
    """
    flatness = below_one("inertia_ratio", inertia_ratio) * positive("c", c) ** 2  # m r²/J0
    return np.asarray(np.maximum((1.0 - flatness) / (1.0 + flatness), 0.0))


@plain_results
def block_restitution(c: Real) -> Values:
    """Compute the restitution of an impact of a uniform rectangular block.

    Parameters
    ----------
    c
        Slenderness, width over height.

    Returns
    -------
    numpy.ndarray
        e = 1 − (3/2) sin²α_c with tan α_c = c; 0 for c ≥ √2, blocks so flat that they do not rebound.

    Raises
    ------
    ParameterError
        If `c` is not positive.

    See Also
    --------
    housner_restitution : the same for a body of revolution.

    Notes
    -----
    Housner (1963): the moment of momentum about the new edge is conserved, and J0 = m h² (4 + c²)/3.

    Examples
    --------
    >>> print(block_restitution([0.1, 0.2]).round(6))
    [0.985149 0.942308]
    """
    square = positive("c", c) ** 2
    return np.asarray(np.maximum(1.0 - 1.5 * square / (1.0 + square), 0.0))


@plain_results
def equivalent_viscous_damping(amplitude: Real, *, c: Real, restitution: Real) -> Values:
    """Compute the damping that dissipates as much energy per cycle of planar rocking as impacts do.

    Parameters
    ----------
    amplitude
        Peak tilt angle θ [rad].
    c
        Slenderness.
    restitution
        Ratio e of the rocking rates after and before an impact, at most 1.

    Returns
    -------
    numpy.ndarray
        Damping η, of the broadcast shape; NaN where θ ≥ c: the column does not return.

    Raises
    ------
    ParameterError
        If `amplitude` or `c` is not positive, or `restitution` not between 0 and 1.

    Notes
    -----
    For the slender column. Its free motion (2), φ = θ/c, hits the base at the rate cv with v² = 2φ − φ² and loses (1 −
    e²) of its energy; damping dissipates 2ηc²S in the same half cycle, S = ∫₀^φ √(v² − 2x + x²) dx:

        η = (1 − e²) v²/(4S),   S = ½[v − (1 − v²) artanh v].

    η decreases with the amplitude, from ¾(1 − e²)/v at small amplitudes to ½(1 − e²) at θ = c: no single η fits a
    decay.

    Examples
    --------
    >>> print(equivalent_viscous_damping([0.01, 0.05, 0.09, 0.1], c=0.1, restitution=0.985).round(5))
    [0.04919 0.0208  0.01527     nan]
    """
    amplitude, c, e = np.broadcast_arrays(
        positive("amplitude", amplitude), positive("c", c), not_negative("restitution", restitution)
    )
    if np.any(e > 1.0):
        raise ParameterError(f"restitution must be at most 1, got {float(np.max(e))!r}: an impact adds no energy")
    ratio = amplitude / c
    inside = ratio < 1.0
    ratio = np.where(inside, ratio, 0.5)
    speed = np.sqrt(ratio * (2.0 - ratio))  # v
    return np.where(inside, (1.0 - e) * (1.0 + e) * speed**2 / (4.0 * _action(speed, 1.0 - ratio)), np.nan)


# Below this limit the terms of S nearly cancel; its series has the relative error v^(2 · terms) = 1e-16.
_SMALL_SPEED = 0.1
_TERMS = 8


def _action(speed: FloatArray, left: FloatArray) -> FloatArray:
    """Return S = ½[v − (1 − v²) artanh v] = Σ v^(2k + 1)/(4k² − 1), with √(1 − v²) = 1 − φ."""
    series = np.zeros_like(speed)
    for k in range(_TERMS, 0, -1):
        series = (series + 1.0 / (4.0 * k**2 - 1.0)) * speed**2
    closed = 0.5 * (speed - left**2 * np.log((1.0 + speed) / left))
    return np.where(speed < _SMALL_SPEED, series * speed, closed)


_HALVINGS = 60
# A golden section shrinks its bracket by 0.618 per step: to 2e-16 after 75 steps.
_GOLDEN, _SECTIONS = 0.5 * (np.sqrt(5.0) - 1.0), 75
# Below this frequency the growth exp(3π/2ν) of rounding errors exceeds the terms that define the interval.
_LEAST_FREQUENCY = 0.1


@plain_results
def half_sine_overturning(nu: Real, c: Real) -> Values:
    """Compute the minimum half-sine pulse that overturns a column at rest, without damping.

    Parameters
    ----------
    nu
        Angular frequency ω of the pulse, a0 sin ωt over half a period, over ω0; for a block over p = √(mgR/K).
    c
        Slenderness; for a block the tipping angle α_c or its tangent, equal to the order of this theory.

    Returns
    -------
    numpy.ndarray
        Minimum acceleration a0 in g, of the broadcast shape. A weaker pulse never overturns, whatever the restitution.

    Raises
    ------
    ParameterError
        If an argument is not positive.

    See Also
    --------
    one_sine_overturning_without_impact : the same for a whole sine.

    Notes
    -----
    For small tilt and slenderness and planar motion. Uplift occurs when a0 sin ντ = c. With u the tilt over c and
    a = a0/c, the growing part z = u − 1 + u̇ of its motion obeys ż = z + a sin ντ from z = −1. The column overturns if
    z > 0 at the end of the pulse, after which z grows by itself. With s = √(a² − 1), z vanishes at the end for

        s + √(1 + s²) exp[−(π/2 + arctan s)/ν] = ν,

    whose left side grows with s. G. W. Housner (Bulletin of the Seismological Society of America 53, 1963) gives
    √(1 + ν²), 5.10 at ν = 5, if the column reaches its unstable balance when the pulse ends. A column with a smaller
    tilt that still moves outwards also overturns, from 3.289: J. Zhang and N. Makris, "Rocking response of
    free-standing blocks under cycloidal pulses", Journal of Engineering Mechanics 127 (2001).

    Examples
    --------
    >>> print(half_sine_overturning([2.0, 5.0, 10.0], c=1.0).round(4))
    [1.8007 3.2891 5.7865]
    """
    nu, c = np.broadcast_arrays(positive("nu", nu), positive("c", c))
    return c * _least(nu, lambda s: s + _left(s, 0.5, nu), nu)


@plain_results
def one_sine_overturning_without_impact(nu: Real, c: Real) -> Values:
    """Compute the minimum one-sine pulse that overturns a column at rest without an impact and without damping.

    This is mode 2 of Zhang and Makris (2001), often not the minimum overturning amplitude: weaker pulses may overturn
    the column on its other side, after an impact.

    Parameters
    ----------
    nu
        Angular frequency ω of the pulse, a0 sin ωt over one period, over ω0; for a block over p = √(mgR/K).
    c
        Slenderness; for a block the tipping angle α_c or its tangent, equal to the order of this theory.

    Returns
    -------
    numpy.ndarray
        Minimum acceleration a0 in g, of the broadcast shape.

    Raises
    ------
    ParameterError
        If an argument is not positive.

    See Also
    --------
    one_sine_overturning_after_impact : mode 1, the weaker pulses.
    half_sine_overturning : the first half of the pulse alone.

    Notes
    -----
    As for half a sine, with z = 0 at the end of a whole sine:

        s − √(1 + s²) exp[−(3π/2 + arctan s)/ν] = ν.

    The column overturns in the direction of the push of the first half.

    Examples
    --------
    >>> print(round(one_sine_overturning_without_impact(5.0, c=1.0), 4))
    7.1681
    """
    nu, c = np.broadcast_arrays(positive("nu", nu), positive("c", c))
    return c * _without_impact(nu)


@plain_results
def one_sine_overturning_after_impact(nu: Real, c: Real, *, restitution: Real) -> tuple[Values, Values]:
    """Compute the interval of one-sine amplitudes that overturn a column at rest after one impact.

    This is mode 1 of Zhang and Makris (2001). If the interval is not empty, its lower end is the minimum overturning
    amplitude. Between its upper end and `one_sine_overturning_without_impact` the column survives.

    Parameters
    ----------
    nu
        Angular frequency ω of the pulse, a0 sin ωt over one period, over ω0; for a block over p = √(mgR/K).
    c
        Slenderness; for a block the tipping angle α_c or its tangent, equal to the order of this theory.
    restitution
        Ratio e of the tilt rates after and before the impact, above 0 and at most 1.

    Returns
    -------
    lowest, highest : numpy.ndarray
        Ends of the interval of a0 in g, of the broadcast shape; NaN if no pulse overturns after one impact. Also NaN
        below ν = 0.1, where the interval is narrower than 1e-7 of its amplitude and below the rounding error.

    Raises
    ------
    ParameterError
        If an argument is not positive, or the restitution above 1.

    See Also
    --------
    one_sine_overturning_without_impact : mode 2, the stronger pulses.

    Notes
    -----
    As for half a sine until the impact at τ1, with u = 0 and u̇ = −v. After the impact the column leans to the other
    side, ü = u + 1 + a sin ντ, and its growing part y = u + 1 + u̇ obeys ẏ = y + a sin ντ from y = 1 − ev. The column
    overturns if y < 0 when the pulse ends, at ντ2 = 2π, that is if

        ev > 1 + a [sin ντ1 + ν cos ντ1 − ν exp(τ1 − τ2)]/(1 + ν²),

    and, for an impact after the pulse, if ev > 1. With increasing amplitude the minimum e of overturning decreases and
    then rises to 1, so the overturning pulses form one interval. At its ends the column takes infinite time to reach
    its unstable balance. See also E. G. Dimitrakopoulos and M. J. DeJong, "Revisiting the rocking block: closed-form
    solutions and similarity laws", Proceedings of the Royal Society A 468 (2012).

    Examples
    --------
    >>> lowest, highest = one_sine_overturning_after_impact(5.0, c=1.0, restitution=0.9)
    >>> print(round(lowest, 4), round(highest, 4))
    3.0186 6.3181
    """
    nu, c, e = np.broadcast_arrays(positive("nu", nu), positive("c", c), positive("restitution", restitution))
    if np.any(e > 1.0):
        raise ParameterError(
            f"restitution: at most 1 (got {float(e[e > 1.0].flat[0])!r}). State the ratio of tilt rates."
        )
    resolved = np.asarray(np.maximum(nu, _LEAST_FREQUENCY))
    top, bottom = _without_impact(resolved), np.ones(nu.shape)

    def needed(a: FloatArray) -> FloatArray:
        return _least_restitution(a, resolved)

    easiest = _least_of(needed, bottom, top)
    empty = (needed(easiest) >= e) | (nu < _LEAST_FREQUENCY)
    lowest, highest = (_edge(lambda a: needed(a) < e, end, easiest) for end in (bottom, top))
    return np.where(empty, np.nan, c * lowest), np.where(empty, np.nan, c * highest)


def _least_restitution(a: FloatArray, nu: FloatArray) -> FloatArray:
    """Return the minimum e of overturning after one impact, for a pulse too weak to overturn without an impact."""
    motion = _Arc.of(a, nu)
    end = 2.0 * np.pi / nu
    before, after = motion.start, end
    for _ in range(_HALVINGS):  # below zero it stays below zero
        middle = 0.5 * (before + after)
        stands = motion.tilt(middle) > 0.0
        before, after = np.where(stands, middle, before), np.where(stands, after, middle)
    angle, left = nu * after, nu * np.exp(after - end)
    needed = 1.0 + a * (np.sin(angle) + nu * np.cos(angle) - left) / (1.0 + nu**2)
    u, rate = motion.tilt(end), motion.rate(end)
    with np.errstate(invalid="ignore", divide="ignore"):  # of the case that does not apply
        return np.asarray(np.where(u > 0.0, 1.0 / np.sqrt(rate**2 + 2.0 * u - u**2), needed / -motion.rate(after)))


@dataclass(frozen=True, slots=True)
class _Arc:
    """The tilt u over c after uplift at `start`: u = 1 − A cosh s − B sinh s − C sin ντ, s = τ − start."""

    nu: FloatArray
    start: FloatArray
    coefficients: tuple[FloatArray, FloatArray, FloatArray]

    @classmethod
    def of(cls, a: FloatArray, nu: FloatArray) -> Self:
        """Return the motion after uplift at a sin ντ = 1 under a pulse of amplitude a over c."""
        angle = np.arcsin(1.0 / a)
        share = a / (1.0 + nu**2)
        return cls(nu, angle / nu, (1.0 - share / a, -nu * share * np.cos(angle), share))

    def tilt(self, tau: FloatArray) -> FloatArray:
        """Return u."""
        (first, second, share), s = self.coefficients, tau - self.start
        return np.asarray(1.0 - first * np.cosh(s) - second * np.sinh(s) - share * np.sin(self.nu * tau))

    def rate(self, tau: FloatArray) -> FloatArray:
        """Return u̇."""
        (first, second, share), s = self.coefficients, tau - self.start
        forced = share * self.nu * np.cos(self.nu * tau)
        return np.asarray(-first * np.sinh(s) - second * np.cosh(s) - forced)


def _without_impact(nu: FloatArray) -> FloatArray:
    """Return the minimum amplitude over c of a whole sine that overturns without an impact."""
    longest = np.exp(-1.5 * np.pi / nu)  # √(1 + s²) ≤ 1 + s
    return _least(nu, lambda s: s - _left(s, 1.5, nu), (nu + longest) / (1.0 - longest))


def _least_of(valley: Callable[[FloatArray], FloatArray], low: FloatArray, high: FloatArray) -> FloatArray:
    """Return the minimiser of a function that falls and then rises between `low` and `high`, by golden sections."""
    for _ in range(_SECTIONS):
        left, right = high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)
        falls = valley(right) < valley(left)
        low, high = np.where(falls, left, low), np.where(falls, high, right)
    return np.asarray(0.5 * (low + high))


def _edge(inside: Callable[[FloatArray], BoolArray], beyond: FloatArray, within: FloatArray) -> FloatArray:
    """Bisect to the end of an interval between a value `beyond` and a value `within` the interval."""
    for _ in range(_HALVINGS):
        middle = 0.5 * (beyond + within)
        hit = inside(middle)
        beyond, within = np.where(hit, beyond, middle), np.where(hit, middle, within)
    return np.asarray(within)


def _left(s: FloatArray, turns: float, nu: FloatArray) -> FloatArray:
    """Return √(1 + s²) exp(−Δτ), Δτ from the uplift at ντ = arctan(1/s) to the end at ντ = (`turns` + ½)π."""
    return np.asarray(np.sqrt(1.0 + s**2) * np.exp(-(turns * np.pi + np.arctan(s)) / nu))


def _least(nu: FloatArray, growing: Callable[[FloatArray], FloatArray], high: FloatArray) -> FloatArray:
    """Return √(1 + s²) at the s where a growing function, below ν at 0 and above ν at `high`, equals ν."""
    low = np.zeros_like(nu)
    for _ in range(_HALVINGS):
        s = 0.5 * (low + high)
        short = growing(s) < nu
        low, high = np.where(short, s, low), np.where(short, high, s)
    return np.asarray(np.sqrt(1.0 + (0.5 * (low + high)) ** 2))
