"""Onset of sliding, rocking or lift-off of a column that stands on a moving, possibly inclined plane.

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
        message = f"incline must lie between -π/2 and π/2, got {worst!r} rad. {degrees_meant(worst)}".rstrip()
        raise ParameterError(message)
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
