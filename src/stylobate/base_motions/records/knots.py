"""Accelerations that are linear between equally spaced knots: values, exact integrals, what follows a time."""

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]


def integrals(samples: Floats, step: float) -> tuple[Floats, Floats]:
    """Return velocity [m/s] and displacement [m] at the knots, both zero at the first.

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
    """Return ∫ a² dt of each component up to each knot, shape (n, axes) [m²/s³]."""
    left, right = samples[:-1], samples[1:]
    grown = np.zeros_like(samples)
    np.cumsum(step / 3.0 * (left**2 + left * right + right**2), axis=0, out=grown[1:])
    return grown


def largest_from_each(values: Floats) -> Floats:
    """Return the largest of each value and all that follow it."""
    return np.asarray(np.maximum.accumulate(values[::-1])[::-1])


def corners(samples: Floats) -> npt.NDArray[np.bool_]:
    """Return at which knots the acceleration is not smooth, where it is zero before the first and after the last."""
    slopes = np.diff(samples, axis=0, prepend=samples[:1], append=samples[-1:])
    bent = np.any(np.diff(slopes, axis=0) != 0.0, axis=1)
    bent[[0, -1]] |= np.any(samples[[0, -1]] != 0.0, axis=1)
    return np.asarray(bent)


def mean_frequency(samples: Floats, step: float) -> float:
    """Return the root mean square of the slope over that of the acceleration [rad/s], 0 where there is none."""
    left, right = samples[:-1], samples[1:]
    square = np.sum(left * left + left * right + right * right) / 3.0
    return float(np.sqrt(np.sum((right - left) ** 2) / square) / step) if square > 0.0 else 0.0
