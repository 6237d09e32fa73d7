"""Spectral differentiation and interpolation of periodic functions on an odd number of equally spaced points."""

import numpy as np

from stylobate.theory.arguments import FloatArray


def differentiation_matrix(points: int) -> FloatArray:
    """Return the matrix that differentiates the trigonometric interpolant of a function of period 1 given at j/points.

    Parameters
    ----------
    points
        Number of points, odd.

    Returns
    -------
    numpy.ndarray
        Matrix D of shape (points, points), antisymmetric; the derivative is D @ values.

    References
    ----------
    L. N. Trefethen, Spectral Methods in MATLAB, SIAM 2000, chapter 3.
    """
    index = np.arange(points)
    apart = index[:, np.newaxis] - index
    sine = np.sin(np.pi * apart / points)
    np.fill_diagonal(sine, np.inf)
    return np.pi * np.where(apart % 2 == 0, 1.0, -1.0) / sine


def interpolated(values: FloatArray, fraction: FloatArray) -> FloatArray:
    """Evaluate the trigonometric interpolant at any fraction of the period.

    Parameters
    ----------
    values
        Values at j/points along the last axis, an odd number of them, shape (m, points).
    fraction
        Fractions of the period, shape (n,).

    Returns
    -------
    numpy.ndarray
        Values of shape (m, n).
    """
    coefficients = 2.0 * np.fft.rfft(values, axis=-1) / values.shape[-1]
    coefficients[..., 0] *= 0.5
    waves = np.exp(2.0j * np.pi * np.outer(np.arange(coefficients.shape[-1]), fraction))
    return np.real(coefficients @ waves)


def unresolved(values: FloatArray) -> float:
    """Return the highest harmonics over the largest harmonic, an estimate of the truncation error."""
    size = np.abs(np.fft.rfft(values, axis=-1)).max(axis=0)
    return float(size[-3:].max() / size.max())
