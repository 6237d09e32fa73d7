"""Stick and slip of a block on a horizontally vibrating plane, in closed form.

The base acceleration is a0 cos τ in g, τ = Ωt, velocities are in g/Ω, and the slip velocity u of the block obeys u̇ =
−a0 cos τ ∓ μk. Both half cycles are alike.

Up to a0 = μs the block sticks. Above, slip begins at cos τ1 = −μs/a0. A slip that begins at τ0 and lasts for the whole
half cycle ends with u = 2a0 sin τ0 − πμk = 0. At that instant the plane pulls the block back with a0 abs(cos τ0); the
block does not stick if this exceeds μs. So the block never sticks for

    a0 > a* = √(μs² + (πμk/2)²),

with μs = μk = μ for μ/a0 < 2/√(4 + π²) = 0.5370. This is the condition of motion without stops under dry friction (Den
Hartog 1931), for a mass without a spring. In stick–slip motion all quantities except the end of the slip are explicit.
"""

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
import numpy.typing as npt

from stylobate.errors import Named, ParameterError
from stylobate.theory.arguments import FloatArray, Real, Values, not_negative, plain_results

_BISECTIONS = 60  # from an interval shorter than π down to rounding


class SlidingRegime(Named, IntEnum):
    """Regime of a block on a horizontally vibrating plane."""

    STICKS = 0
    """The block moves with the plane."""
    STICK_SLIP = 1
    """The block slips, stops and sticks twice per period."""
    SLIDES = 2
    """The block slips to and fro without sticking."""


@dataclass(frozen=True, slots=True, kw_only=True)
class HorizontalSliding:
    """The periodic motion of a block on a horizontally vibrating plane, arrays of one shape.

    Parameters
    ----------
    regime
        Values of `SlidingRegime`.
    onset
        Ωt at which the block begins to slip forward, in (π/2, π); NaN if the block sticks.
    slip_duration
        Duration of each of the two slips per period [1/Ω], at most π; 0 if the block sticks.
    peak_velocity
        Peak velocity of the block relative to the plane [g/Ω].
    stroke
        Distance of each slip on the plane [g/Ω²].
    dissipation
        Energy loss per period, over the mass of the block [g²/Ω²].
    """

    regime: npt.NDArray[np.int64]
    onset: Values
    slip_duration: Values
    peak_velocity: Values
    stroke: Values
    dissipation: Values


@plain_results
def horizontal_sliding(a0: Real, *, static_friction: Real, kinetic_friction: Real | None = None) -> HorizontalSliding:
    """Compute the stick and slip of a block on a horizontal plane with harmonic base motion.

    Parameters
    ----------
    a0
        Acceleration amplitude of the base [g].
    static_friction
        μs.
    kinetic_friction
        μk, at most μs and equal to it by default.

    Returns
    -------
    HorizontalSliding
        Arrays of the broadcast shape.

    Raises
    ------
    ParameterError
        If an argument is negative, or the kinetic friction above the static one.

    Notes
    -----
    Peak velocity and onset are closed forms in both regimes with slip,

        slides:      √(a0² − μk²) + μk [arcsin(μk/a0) − arcsin(πμk/2a0)],              sin τ0 = πμk/2a0,
        stick–slip:  √(a0² − μk²) + √(a0² − μs²) − μk [arccos(μk/a0) + arccos(μs/a0)],  cos τ1 = −μs/a0.

    A sliding block slips for π; in stick–slip motion the slip ends at the root of sin τ1 − sin τ = (μk/a0)(τ − τ1),
    bisected to rounding. The stroke of a sliding block is √(4a0² − π²μk²); the dissipation is 2μk times the stroke in
    both regimes.

    Examples
    --------
    >>> motion = horizontal_sliding([0.2, 0.4, 0.8], static_friction=0.3)
    >>> print([SlidingRegime(regime).name for regime in motion.regime], motion.peak_velocity.round(5))
    ['STICKS', 'STICK_SLIP', 'SLIDES'] [0.      0.09551 0.66797]
    """
    kinetic_friction = static_friction if kinetic_friction is None else kinetic_friction
    a, mu_s, mu_k = np.broadcast_arrays(
        not_negative("a0", a0),
        not_negative("static_friction", static_friction),
        not_negative("kinetic_friction", kinetic_friction),
    )
    _require_ordered(mu_s, mu_k)
    slips, slides = a > mu_s, a > _never_sticks(mu_s, mu_k)
    a, mu_s, mu_k = (np.where(slips, number, blank) for number, blank in ((a, 1.0), (mu_s, 1.0), (mu_k, 1.0)))
    static, kinetic = np.minimum(mu_s / a, 1.0), mu_k / a
    onset = np.pi - np.where(slides, np.arcsin(0.5 * np.pi * np.minimum(kinetic, 2.0 / np.pi)), np.arccos(static))
    lasts = np.where(slides, np.pi, _slip_duration(onset, kinetic))
    peak_after = np.pi + np.arccos(kinetic) - onset
    peak = a * (np.sin(onset) + np.sqrt((1.0 - kinetic) * (1.0 + kinetic)) - kinetic * peak_after)
    stroke = a * (np.cos(onset + lasts) - np.cos(onset) + np.sin(onset) * lasts - 0.5 * kinetic * lasts**2)
    return HorizontalSliding(
        regime=np.where(slides, SlidingRegime.SLIDES, np.where(slips, SlidingRegime.STICK_SLIP, SlidingRegime.STICKS)),
        onset=np.where(slips, onset, np.nan),
        slip_duration=np.where(slips, lasts, 0.0),
        peak_velocity=np.where(slips, peak, 0.0),
        stroke=np.where(slips, stroke, 0.0),
        dissipation=np.where(slips, 2.0 * mu_k * stroke, 0.0),
    )


@plain_results
def sliding_amplitude(*, static_friction: Real, kinetic_friction: Real | None = None) -> Values:
    """Compute the acceleration amplitude of a horizontal plane above which a block on it never sticks.

    Parameters
    ----------
    static_friction
        μs.
    kinetic_friction
        μk, at most μs and equal to it by default.

    Returns
    -------
    numpy.ndarray
        a* = √(μs² + (πμk/2)²) [g], of the broadcast shape.

    Raises
    ------
    ParameterError
        If a friction is negative, or the kinetic one above the static one.

    Examples
    --------
    >>> print(sliding_amplitude(static_friction=0.5370, kinetic_friction=[0.0, 0.3, 0.5370]).round(4))
    [0.537  0.7144 0.9999]
    """
    kinetic_friction = static_friction if kinetic_friction is None else kinetic_friction
    mu_s, mu_k = not_negative("static_friction", static_friction), not_negative("kinetic_friction", kinetic_friction)
    _require_ordered(mu_s, mu_k)
    return np.asarray(_never_sticks(mu_s, mu_k))


def _never_sticks(mu_s: FloatArray, mu_k: FloatArray) -> FloatArray:
    return np.hypot(mu_s, 0.5 * np.pi * mu_k)


def _require_ordered(mu_s: FloatArray, mu_k: FloatArray) -> None:
    if np.any(mu_k > mu_s):
        raise ParameterError(
            f"kinetic_friction must be at most static_friction, got up to {float(np.max(mu_k - mu_s))!r} more"
        )


def _slip_duration(onset: FloatArray, kinetic: FloatArray) -> FloatArray:
    """Return the duration of a slip from rest: the root between its peak velocity and half a period."""
    low, high = np.pi + np.arccos(kinetic) - onset, np.full_like(onset, np.pi)
    for _ in range(_BISECTIONS):
        middle = 0.5 * (low + high)
        goes = np.sin(onset) - np.sin(onset + middle) > kinetic * middle
        low, high = np.where(goes, middle, low), np.where(goes, high, middle)
    return 0.5 * (low + high)
