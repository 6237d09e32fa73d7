"""When a column that stands on a moving, possibly inclined plane begins to slide, to rock or to lift off.

The plane rises by `incline` = ψ along x. With the base acceleration ax uphill along the plane and az along its normal,
in g, a column that stays is held by the friction T and the normal force N, in units of its weight,

    T = sin ψ + ax,    N = cos ψ + az.

It does not slide while |T| ≤ μN, and it does not rock while the line of T and N, drawn from the mass centre, meets the
base inside its rim, |T| ≤ cN. Both limits scale with N. So which one is met first does not depend on N, the vertical
acceleration or the incline: the column rocks if c < μ and slides if μ < c. It cannot lift off before it does either:
at N = 0 the cone has shrunk to T = 0. The only exception is a base motion that never loads the friction.
"""

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
import numpy.typing as npt

from stylobate.errors import ParameterError
from stylobate.theory.arguments import ComplexArray, FloatArray, Real, finite, not_negative, positive

# Relative difference, a few roundings, below which lifting off and leaving the friction cone are the same instant.
_SAME = 8.0 * float(np.finfo(float).eps)


class FirstMotion(IntEnum):
    """The first motion of a standing column."""

    NONE = 0
    """It stays."""
    SLIDE = 1
    """Its base slips."""
    ROCK = 2
    """It tilts over its rim."""
    LIFT_OFF = 3
    """It is thrown without either."""


@dataclass(frozen=True, slots=True, kw_only=True)
class StartOfMotion:
    """The least base motion that moves a standing column, arrays of one shape.

    Parameters
    ----------
    amplitude
        Factor on the base motion above which the column does not stay: the least of the three below. 0 where it does
        not stay on the plane at rest, infinite where it always stays.
    first
        What it then does, values of `FirstMotion`.
    phase
        Ωt at which it begins, in [0, 2π); NaN where `amplitude` is 0 or infinite. If it may begin at two instants
        because uphill and downhill are alike, the one at which the base accelerates uphill.
    slide
        Factor above which abs(T) ≤ μN fails.
    rock
        Factor above which abs(T) ≤ cN fails.
    lift_off
        Factor above which N ≥ 0 fails.
    """

    amplitude: FloatArray
    first: npt.NDArray[np.int64]
    phase: FloatArray
    slide: FloatArray
    rock: FloatArray
    lift_off: FloatArray


def start_of_motion(
    along: Real = 1.0, normal: Real = 0.0, *, c: Real, friction: Real, phase: Real = 0.0, incline: Real = 0.0
) -> StartOfMotion:
    """Compute the minimum harmonic base motion at which a standing column slides, rocks or lifts off.

    Parameters
    ----------
    along, normal
        Shape of the base motion: its acceleration is s·along·cos Ωt uphill along the plane and
        s·normal·cos(Ωt + phase) along its normal. Sought is the factor s; for a shape of unit size it is the amplitude
        [g]. So `normal` is the ratio of vertical to horizontal if `along` is left at 1.
    c
        Slenderness r/h.
    friction
        Static friction μ.
    phase
        Phase of the normal component [rad].
    incline
        Angle ψ of the plane [rad], between −π/2 and π/2.

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

        s = min over ± of (k cos ψ ∓ sin ψ)/√(along² ∓ 2k along normal cos(phase) + k² normal²).

    Where k ≤ abs(tan ψ) the numerator says that the column does not stay on the plane at rest. N ≥ 0 holds up to
    cos ψ/normal. For c = μ sliding and rocking begin together; ROCK is named.

    The vertical acceleration in phase with the horizontal one takes k·normal from `along` in one sense of T and adds it
    in the other; so with an incline it may help.

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
        Angle ψ of the plane [rad], between −π/2 and π/2.

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
    NONE while abs(T) ≤ min(μ, c) N; LIFT_OFF where N < 0, or N = 0 and T is not: there is no contact to slide or rock
    on. Between them it depends on which limit is met first if the acceleration grows to its value. An acceleration put
    on at once, well above both limits, may make the column slide and rock together.

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
        message = f"incline must lie between -π/2 and π/2 rad, got {float(bad[0])!r}: nothing stands on a wall"
        raise ParameterError(message)
    return angle


def _leaves_cone(x: FloatArray, z: ComplexArray, k: FloatArray, psi: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the factor above which |T| ≤ kN fails, and Ωt at which it does."""
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
