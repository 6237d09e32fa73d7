"""Accelerations that are linear between equally spaced knots: exact integrals, peaks and slopes."""

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]


def integrals(samples: Floats, step: float) -> tuple[Floats, Floats]:
    """Compute velocity [m/s] and displacement [m] at the knots, both zero at the first knot.

    Parameters
    ----------
    samples
        Accelerations at the knots, shape (n, axes) [m/s²].
    step
        Time between knots [s].
    """
    left, right = samples[:-1], samples[1:]
    gain = 0.5 * step * (left + right)
    velocity = np.zeros_like(samples)
    np.cumsum(gain, axis=0, out=velocity[1:])
    displacement = np.zeros_like(samples)
    np.cumsum(step * velocity[:-1] + step**2 * (2.0 * left + right) / 6.0, axis=0, out=displacement[1:])
    return velocity, displacement


def energy(samples: Floats, step: float) -> Floats:
    """Compute ∫ a² dt of each component up to each knot, shape (n, axes) [m²/s³]."""
    left, right = samples[:-1], samples[1:]
    grown = np.zeros_like(samples)
    np.cumsum(step / 3.0 * (left**2 + left * right + right**2), axis=0, out=grown[1:])
    return grown


def largest_from_each(values: Floats) -> Floats:
    """Return the maximum of each value and all later values."""
    return np.asarray(np.maximum.accumulate(values[::-1])[::-1])


def corners(samples: Floats) -> npt.NDArray[np.bool_]:
    """Return a mask of the knots with a change of slope or a jump from or to the zero acceleration outside."""
    slopes = np.diff(samples, axis=0, prepend=samples[:1], append=samples[-1:])
    bent = np.any(np.diff(slopes, axis=0) != 0.0, axis=1)
    bent[[0, -1]] |= np.any(samples[[0, -1]] != 0.0, axis=1)
    return np.asarray(bent)


def mean_frequency(samples: Floats, step: float) -> float:
    """Return the ratio of root mean squares of slope and acceleration [rad/s], 0 without acceleration."""
    left, right = samples[:-1], samples[1:]
    square = np.sum(left * left + left * right + right * right) / 3.0
    return float(np.sqrt(np.sum((right - left) ** 2) / square) / step) if square > 0.0 else 0.0
