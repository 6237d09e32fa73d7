"""First motion of a column that stands on a moving, possibly inclined plane: sliding, rocking, lift-off, throws.

The plane rises by `incline` = ι along x. With the base acceleration ax uphill along the plane and az along its normal,
in g, a column at rest on the plane needs the friction T and the normal force N, in units of its weight,

    T = sin ι + ax,    N = cos ι + az.

The column does not slide while |T| ≤ μN. It does not rock while the line of T and N through the centre of mass meets
the base inside its rim, |T| ≤ cN. Both limits scale with N, so their order does not depend on N, the vertical
acceleration or the incline: the column rocks if c < μ and slides if μ < c. Lift-off cannot come first, since at N = 0
both limits are T = 0. The only exception is a base motion that needs no friction.
"""

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
import numpy.typing as npt

from stylobate.errors import Named, ParameterError
from stylobate.quantities import degrees_meant
from stylobate.theory.arguments import (
    ComplexArray,
    FloatArray,
    Real,
    Values,
    finite,
    not_negative,
    plain_results,
    positive,
)

# Relative difference, a few roundings, below which lift-off and leaving the friction cone coincide.
_SAME = 8.0 * float(np.finfo(float).eps)


class FirstMotion(Named, IntEnum):
    """The first motion of a standing column."""

    NONE = 0
    """The column stays at rest."""
    SLIDE = 1
    """The base slips."""
    ROCK = 2
    """The column tilts about its rim."""
    LIFT_OFF = 3
    """The column lifts off without slip or tilt."""


@dataclass(frozen=True, slots=True, kw_only=True)
class StartOfMotion:
    """The minimum base motion that moves a standing column, arrays of one shape.

    Parameters
    ----------
    amplitude
        Factor on the base motion above which the column moves: the minimum of the three factors below. 0 if the column
        does not stay on the plane at rest, infinite if it always stays.
    first
        First motion, values of `FirstMotion`.
    phase
        Ωt of the onset, in [0, 2π); NaN where `amplitude` is 0 or infinite. If uphill and downhill are alike, the onset
        while the base accelerates uphill.
    slide
        Factor above which abs(T) ≤ μN fails.
    rock
        Factor above which abs(T) ≤ cN fails.
    lift_off
        Factor above which N ≥ 0 fails.
    """

    amplitude: Values
    first: npt.NDArray[np.int64]
    phase: Values
    slide: Values
    rock: Values
    lift_off: Values


@plain_results
def start_of_motion(
    along: Real = 1.0, normal: Real = 0.0, *, c: Real, friction: Real, phase: Real = 0.0, incline: Real = 0.0
) -> StartOfMotion:
    """Compute the minimum harmonic base motion that makes a standing column slide, rock or lift off.

    Parameters
    ----------
    along, normal
        Shape of the base motion: its acceleration is s·along·cos Ωt uphill along the plane and
        s·normal·cos(Ωt + phase) along its normal. The result is the factor s; for a shape of unit size s is the
        amplitude [g]. With along = 1, `normal` is the ratio of vertical to horizontal.
    c
        Slenderness r/h.
    friction
        Static friction μ.
    phase
        Phase of the normal component [rad].
    incline
        Angle ι of the plane [rad], between −π/2 and π/2.

    Returns
    -------
    StartOfMotion
        Arrays of the broadcast shape.

    Raises
    ------
    ParameterError
        If `c` is not positive, `friction` is negative, or the plane is as steep as a wall.

    Notes
    -----
    With k = μ or c, abs(T) ≤ kN is a bound on the peak of two harmonic functions, one for each sense of T. It holds up
    to

        s = min over ± of (k cos ι ∓ sin ι)/√(along² ∓ 2k along normal cos(phase) + k² normal²).

    For k ≤ abs(tan ι) the column does not stay on the plane at rest. N ≥ 0 holds up to cos ι/normal. For c = μ sliding
    and rocking begin together; the result is ROCK.

    A vertical acceleration in phase with the horizontal acceleration subtracts k·normal from `along` for one sense of T
    and adds it for the other; so with an incline it may stabilise the column.

    Examples
    --------
    >>> start = start_of_motion(1.0, [0.0, 0.5, 1.0], c=0.1, friction=[0.3, 0.3, 0.05])
    >>> print(start.amplitude.round(5), [FirstMotion(first).name for first in start.first])
    [0.1     0.09524 0.04762] ['ROCK', 'ROCK', 'SLIDE']
    """
    shape = np.broadcast_arrays(
        finite("along", along),
        finite("normal", normal) * np.exp(1j * finite("phase", phase)),
        positive("c", c),
        not_negative("friction", friction),
        steepness(incline),
    )
    x, z, slender, mu, psi = shape
    slide, slide_phase = _leaves_cone(x, z, mu, psi)
    rock, rock_phase = _leaves_cone(x, z, slender, psi)
    with np.errstate(divide="ignore", over="ignore"):
        lift = np.asarray(np.cos(psi) / np.abs(z))
    held = np.minimum(slide, rock)
    lifts = np.isfinite(lift) & (lift <= held * (1.0 + _SAME))
    amplitude = np.where(lifts, lift, held)
    moves = np.isfinite(amplitude)
    first = np.where(lifts, FirstMotion.LIFT_OFF, np.where(slender <= mu, FirstMotion.ROCK, FirstMotion.SLIDE))
    onset = np.where(lifts, np.mod(-np.angle(-z), 2.0 * np.pi), np.where(slender <= mu, rock_phase, slide_phase))
    return StartOfMotion(
        amplitude=amplitude,
        first=np.where(moves, first, FirstMotion.NONE).astype(np.int64),
        phase=np.where(moves & (amplitude > 0.0), onset, np.nan),
        slide=slide,
        rock=rock,
        lift_off=lift,
    )


@plain_results
def first_motion(
    along: Real, normal: Real = 0.0, *, c: Real, friction: Real, incline: Real = 0.0
) -> npt.NDArray[np.int64]:
    """Determine whether a base acceleration makes a standing column slide, rock or lift off.

    Parameters
    ----------
    along, normal
        Base acceleration uphill along the plane and along its normal [g].
    c
        Slenderness r/h.
    friction
        Static friction μ.
    incline
        Angle ι of the plane [rad], between −π/2 and π/2.

    Returns
    -------
    numpy.ndarray
        Values of `FirstMotion`, of the broadcast shape.

    Raises
    ------
    ParameterError
        As for `start_of_motion`.

    Notes
    -----
    NONE while abs(T) ≤ min(μ, c) N; LIFT_OFF if N < 0, or if N = 0 and T ≠ 0, since no contact remains. Otherwise the
    result is the limit that a growing acceleration reaches first. A sudden acceleration well above both limits may make
    the column slide and rock together.

    Examples
    --------
    >>> first_motion([0.05, 0.2, -0.2], [0.0, 0.0, -1.1], c=0.1, friction=0.3).tolist()
    [0, 2, 3]
    """
    x, z, slender, mu, psi = np.broadcast_arrays(
        finite("along", along),
        finite("normal", normal),
        positive("c", c),
        not_negative("friction", friction),
        steepness(incline),
    )
    force, load = np.abs(np.sin(psi) + x), np.cos(psi) + z
    moves = np.where(slender <= mu, FirstMotion.ROCK, FirstMotion.SLIDE)
    stays = (load >= 0.0) & (force <= np.minimum(mu, slender) * load)
    return np.where(stays, FirstMotion.NONE, np.where(load > 0.0, moves, FirstMotion.LIFT_OFF)).astype(np.int64)


def steepness(incline: Real) -> FloatArray:
    """Return `incline` as an array of floats, or raise ParameterError unless all lie between −π/2 and π/2."""
    angle = finite("incline", incline)
    bad = angle[np.abs(angle) >= 0.5 * np.pi]
    if bad.size:
        worst = float(bad[0])
        raise ParameterError(
            f"incline must lie between -π/2 and π/2, got {worst!r} rad. {degrees_meant(worst)}".rstrip()
        )
    return angle


def _leaves_cone(x: FloatArray, z: ComplexArray, k: FloatArray, psi: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the factor above which |T| ≤ kN fails, and Ωt of the failure."""
    factor, phase = [], []
    for sense in (1.0, -1.0):
        swing = sense * x - k * z  # sense T − kN = Re(swing exp iΩt) − room
        room = k * np.cos(psi) - sense * np.sin(psi)
        with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
            ratio = room / np.abs(swing)
        factor.append(np.where(room < 0.0, 0.0, np.where(swing == 0.0, np.inf, ratio)))
        phase.append(np.mod(-np.angle(swing), 2.0 * np.pi))
    downhill = factor[0] <= factor[1]
    return np.where(downhill, factor[0], factor[1]), np.where(downhill, phase[0], phase[1])


# Below this angle 2πn the quotient of the throw number comes from its series, since both terms vanish as x³.
_SMALL_ANGLE = 0.3
_TERMS = 8


@plain_results
def throw_number(normal: Real, *, incline: Real = 0.0) -> Values:
    """Compute the throw number Γ of a base motion: a body on the base leaves it if Γ > 1.

    Parameters
    ----------
    normal
        Peak base acceleration along the normal of the plane [g].
    incline
        Angle ι of the plane [rad], between −π/2 and π/2.

    Returns
    -------
    numpy.ndarray
        Γ = normal/cos ι, of the broadcast shape.

    Raises
    ------
    ParameterError
        If `normal` is negative or the plane is as steep as a wall.

    Examples
    --------
    >>> print(throw_number(2.0 * np.sin(np.radians(30.0)), incline=np.radians([0.0, 60.0])).round(12))
    [1. 2.]
    """
    return np.asarray(not_negative("normal", normal) / np.cos(steepness(incline)))


@plain_results
def flight_throw_number(duration: Real) -> Values:
    """Compute the throw number at which a flight that begins in contact lasts a given fraction of the period.

    Parameters
    ----------
    duration
        Duration n of the flight over the period of the base motion, at most 1.

    Returns
    -------
    numpy.ndarray
        Γ, of the broadcast shape: from 1 at n = 0 to √(1 + π²) at n = 1.

    Raises
    ------
    ParameterError
        If `duration` is not between 0 and 1.

    Notes
    -----
    The block leaves the base when the normal force cos ι (1 + Γ cos Ωt) falls through zero. A phase x later its
    distance from the base is cos ι/Ω² times √(Γ² − 1)(x − sin x) − (½x² + cos x − 1). It lands at x = 2πn:

        Γ² = 1 + [(½x² + cos x − 1)/(x − sin x)]².

    Exact. With e = 0 this is the only flight per period for Γ below √(1 + π²) = 3.297. From there to √(4 + π²) = 3.724
    each flight lasts exactly one period, since the block leaves where it lands; above, motions of more periods follow.
    With e > 0 it is the first flight of a throw, if the bouncing after the last throw has ended.

    Examples
    --------
    >>> print(flight_throw_number([0.0, 0.5, 1.0]).round(4))
    [1.     1.3685 3.2969]
    """
    part = not_negative("duration", duration)
    if np.any(part > 1.0):
        raise ParameterError(f"duration must be at most 1 period of the base motion, got {float(np.max(part))!r}")
    x = 2.0 * np.pi * part
    small = x < _SMALL_ANGLE
    far = np.where(small, 1.0, x)
    closed = (0.5 * far**2 - 2.0 * np.sin(0.5 * far) ** 2) / (far - np.sin(far))
    return np.asarray(np.hypot(1.0, np.where(small, _small_quotient(x), closed)))


@plain_results
def bounce_time(speed: Real, *, normal_restitution: Real, weight: Real = 1.0) -> Values:
    """Compute the total time of the bounces that follow a landing under a constant normal acceleration.

    Parameters
    ----------
    speed
        Normal speed v of the landing relative to the base [g/Ω], or [m/s] with `weight` in m/s².
    normal_restitution
        Normal restitution e, below 1.
    weight
        Acceleration N of the block towards its base: cos ι plus the base acceleration along the normal [g].

    Returns
    -------
    numpy.ndarray
        Duration 2ev/(N(1 − e)) [1/Ω], of the broadcast shape.

    Raises
    ------
    ParameterError
        If `speed` or `normal_restitution` is negative, `normal_restitution` is 1 or more or `weight` is not positive.

    Notes
    -----
    The bounces last 2eᵏv/N, a geometric series. Exact only for constant N: on a vibrating base this is the limit of
    small v, in which N is constant during the bouncing.

    Examples
    --------
    >>> print(bounce_time(0.1, normal_restitution=[0.0, 0.5, 0.9]))
    [0.  0.2 1.8]
    """
    e = below_elastic(normal_restitution)
    return np.asarray(2.0 * e * not_negative("speed", speed) / (positive("weight", weight) * (1.0 - e)))


def below_elastic(normal_restitution: Real) -> FloatArray:
    """Return `normal_restitution` as an array of floats, or raise ParameterError unless all lie in [0, 1)."""
    e = not_negative("normal_restitution", normal_restitution)
    if np.any(e >= 1.0):
        raise ParameterError(
            f"normal_restitution must be below 1, got {float(np.max(e))!r}: elastic bouncing does not end"
        )
    return e


def _small_quotient(x: FloatArray) -> FloatArray:
    """Return (½x² + cos x − 1)/(x − sin x) from the series of both, x⁴/4! − x⁶/6! … and x³/3! − x⁵/5! …."""
    above, below = np.ones_like(x), np.ones_like(x)
    for k in range(_TERMS, 0, -1):
        above = 1.0 - above * x**2 / ((2.0 * k + 3.0) * (2.0 * k + 4.0))
        below = 1.0 - below * x**2 / ((2.0 * k + 2.0) * (2.0 * k + 3.0))
    return 0.25 * x * above / below
