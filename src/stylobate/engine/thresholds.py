"""Thresholds of rest: the energy below which a column counts as standing, and initial conditions at rest."""

import math

import numpy as np
import numpy.typing as npt

from stylobate.base_motions import BaseMotion
from stylobate.engine.forcing import Floats
from stylobate.errors import SMALLEST

Bools = npt.NDArray[np.bool_]

# The energy of steady rolling at frequency ν is 1.5 c²/ν²; rest begins below a hundredth of it at most.
_REST_ENERGY, _REST_ENERGY_ROLLING = 1e-4, 0.015
# If the base motion can uplift the column again, rest begins below a hundredth of the energy after uplift. The lower
# bounds are the second number, which limits the number of swings to integrate, and the third number for sampled
# motions and for motions shorter than the last number of mean periods, in which small swings cannot grow.
_UPLIFT_SHARE, _LEAST_REST_ENERGY, _LEAST_IF_BRIEF, _BRIEF = 0.01, 1e-8, 1e-5, 100.0

# Initial conditions nearer to rest than this, tilt and rate in units of c, are rounding errors of rest.
_ROUNDED_REST = 1e-14


def without_dust(tilt: Floats) -> Floats:
    """Return initial tilts [rad] with zero for components whose squares would underflow."""
    return np.where(np.abs(tilt) < SMALLEST, 0.0, tilt)


def is_rest(tilt: Floats, tilt_rate: Floats, slenderness: npt.ArrayLike, time_scale: npt.ArrayLike) -> Bools:
    """Return whether these initial conditions, shape (..., 2) [rad] and [rad/s], are at rest up to rounding."""
    size = np.hypot(tilt[..., 0], tilt[..., 1])
    speed = np.hypot(tilt_rate[..., 0], tilt_rate[..., 1]) * time_scale
    return np.asarray(np.maximum(size, speed) <= _ROUNDED_REST * np.asarray(slenderness, dtype=float))


def least_rest_energy(motion: BaseMotion) -> float:
    """Return the minimum ε for a column that `motion` may uplift again."""
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
    """Return the default rest energy ε; all arguments have the same shape.

    Parameters
    ----------
    frequency
        Mean dimensionless frequency of the base motion; 0 for a base at rest.
    largest, minimum_vertical
        sup |a_h| and inf a_z [g].
    capacity
        Maximum |a_h|/(1 + a_z) under which the column stands still.
    least
        Lower bound, see `least_rest_energy`.
    """
    energy = rest_energy_for_good(frequency)
    uplifted = uplift_energy(frequency, largest, minimum_vertical, capacity)
    finest = np.maximum(least, _UPLIFT_SHARE * uplifted)
    return np.where(np.isnan(uplifted), energy, np.minimum(energy, finest))


def rest_energy_for_good(frequency: npt.ArrayLike) -> Floats:
    """Return the default ε if uplift is not possible, at this mean dimensionless frequency."""
    with np.errstate(divide="ignore"):
        return np.asarray(np.minimum(_REST_ENERGY, _REST_ENERGY_ROLLING / np.asarray(frequency, dtype=float) ** 2))


def coarse(
    rest_energy: npt.ArrayLike,
    frequency: npt.ArrayLike,
    largest: npt.ArrayLike,
    minimum_vertical: npt.ArrayLike,
    capacity: npt.ArrayLike,
) -> npt.NDArray[np.bool_]:
    """Return whether `rest_energy` is above a hundredth of the energy of a column after uplift."""
    uplifted = uplift_energy(frequency, largest, minimum_vertical, capacity)
    return ~np.isnan(uplifted) & (_UPLIFT_SHARE * uplifted < np.asarray(rest_energy, dtype=float))


def uplift_energy(
    frequency: npt.ArrayLike, largest: npt.ArrayLike, minimum_vertical: npt.ArrayLike, capacity: npt.ArrayLike
) -> Floats:
    """Return the energy [c²] of a column that a harmonic peak has uplifted; NaN if the peak cannot uplift it.

    With |a_h| = c(1 + δ) at the peak the excess lasts 2√(2δ)/ν and leaves the speed (4/3)√2 c δ^{3/2}/ν.
    """
    weight = 1.0 + np.asarray(minimum_vertical, dtype=float)
    with np.errstate(divide="ignore", invalid="ignore"):
        excess = np.asarray(largest) / (np.asarray(capacity) * weight) - 1.0
        energy = 16.0 / 9.0 * excess**3 / np.square(frequency)
    return np.where(weight <= 0.0, np.inf, np.where(excess > 0.0, energy, np.nan))
