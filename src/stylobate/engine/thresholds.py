"""The numbers by which a run is judged while it goes on, and how small an energy counts as rest."""

import math

import numpy as np
import numpy.typing as npt

from stylobate.base_motions import BaseMotion
from stylobate.engine.forcing import Floats
from stylobate.errors import SMALLEST

Bools = npt.NDArray[np.bool_]

# The energy of steady rolling at frequency ν is 1.5 c²/ν²; rest is entered below a hundredth of it at most.
_REST_ENERGY, _REST_ENERGY_ROLLING = 1e-4, 0.015
# Where the base motion can release the column again, at most a hundredth of the energy it releases it with; not below
# the next number, which bounds the number of hops to follow, or the last for a motion that is over before small hops
# could grow, within so many of its mean periods, or is known at samples only, and so no better.
_REST_ENERGY_HOP, _LEAST_REST_ENERGY, _LEAST_IF_BRIEF, _BRIEF = 0.01, 1e-8, 1e-5, 100.0

# A start nearer to rest than this, tilt and rate in units of c, is the rounding of one at rest.
_ROUNDED_REST = 1e-14


def without_dust(tilt: Floats) -> Floats:
    """Return the tilts of starts [rad], zero for components too small to be squared and divided by."""
    return np.where(np.abs(tilt) < SMALLEST, 0.0, tilt)


def is_rest(tilt: Floats, tilt_rate: Floats, slenderness: npt.ArrayLike, time_scale: npt.ArrayLike) -> Bools:
    """Return whether these starts, shape (..., 2) [rad] and [rad/s], are at rest but for rounding."""
    size = np.hypot(tilt[..., 0], tilt[..., 1])
    speed = np.hypot(tilt_rate[..., 0], tilt_rate[..., 1]) * time_scale
    return np.asarray(np.maximum(size, speed) <= _ROUNDED_REST * np.asarray(slenderness, dtype=float))


def least_rest_energy(motion: BaseMotion) -> float:
    """Return the least ε for a column that `motion` may release again."""
    sampled = motion.degree is not None and motion.degree <= 1
    brief = motion.duration * motion.mean_frequency < _BRIEF * 2.0 * math.pi
    return _LEAST_IF_BRIEF if sampled or brief else _LEAST_REST_ENERGY


def usual_rest_energy(
    frequency: npt.ArrayLike,
    largest: npt.ArrayLike,
    minimum_vertical: npt.ArrayLike,
    capacity: npt.ArrayLike,
    *,
    least: npt.ArrayLike,
) -> Floats:
    """Return the ε at which rest is entered where nobody asks for another; arguments of any one shape.

    Parameters
    ----------
    frequency
        The mean dimensionless frequency of the base motion; 0 for a base at rest.
    largest, minimum_vertical
        sup |a_h| and inf a_z [g].
    capacity
        |a_h|/(1 + a_z) up to which the column stays.
    least
        See `least_rest_energy`.
    """
    energy = rest_energy_for_good(frequency)
    hop = hop_energy(frequency, largest, minimum_vertical, capacity)
    finest = np.maximum(least, _REST_ENERGY_HOP * hop)
    return np.where(np.isnan(hop), energy, np.minimum(energy, finest))


def rest_energy_for_good(frequency: npt.ArrayLike) -> Floats:
    """Return the usual ε where nothing can release the column, at this mean dimensionless frequency."""
    with np.errstate(divide="ignore"):
        return np.asarray(np.minimum(_REST_ENERGY, _REST_ENERGY_ROLLING / np.asarray(frequency, dtype=float) ** 2))


def coarse(
    rest_energy: npt.ArrayLike,
    frequency: npt.ArrayLike,
    largest: npt.ArrayLike,
    minimum_vertical: npt.ArrayLike,
    capacity: npt.ArrayLike,
) -> npt.NDArray[np.bool_]:
    """Return whether `rest_energy` is above a hundredth of what a column has that was just released."""
    hop = hop_energy(frequency, largest, minimum_vertical, capacity)
    return ~np.isnan(hop) & (_REST_ENERGY_HOP * hop < np.asarray(rest_energy, dtype=float))


def hop_energy(
    frequency: npt.ArrayLike, largest: npt.ArrayLike, minimum_vertical: npt.ArrayLike, capacity: npt.ArrayLike
) -> Floats:
    """Return the energy [c²] that a harmonic peak gives a column it has just released; NaN if it cannot uplift it.

    With |a_h| = c(1 + δ) at the peak the excess lasts 2√(2δ)/ν and leaves the speed (4/3)√2 c δ^{3/2}/ν.
    """
    weight = 1.0 + np.asarray(minimum_vertical, dtype=float)
    with np.errstate(divide="ignore", invalid="ignore"):
        excess = np.asarray(largest) / (np.asarray(capacity) * weight) - 1.0
        energy = 16.0 / 9.0 * excess**3 / np.square(frequency)
    return np.where(weight <= 0.0, np.inf, np.where(excess > 0.0, energy, np.nan))
