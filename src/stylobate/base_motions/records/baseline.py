"""Correction of the baseline: drift of the velocity that no ground has."""

import numpy as np
import numpy.typing as npt

from stylobate.base_motions.records.knots import integrals
from stylobate.errors import require_whole

Floats = npt.NDArray[np.float64]


def baseline_corrected(samples: Floats, step: float, degree: int = 1) -> tuple[Floats, str]:
    """Return `samples` less the derivative of a polynomial fitted to their velocity, and a note about it.

    Parameters
    ----------
    samples
        Accelerations, shape (n, 3) [m/s²].
    step
        Time step [s].
    degree
        Degree of the polynomial, 1 or more. It is zero at the first sample, where the velocity is; degree 1 takes a
        constant off the acceleration.

    Notes
    -----
    Least squares over the velocities at the samples, each component for itself. The remaining velocity is small but not
    zero; a high-pass filter (`Record.filtered`) removes drift that is no polynomial.
    """
    degree = require_whole("degree", degree, least=1)
    time = np.linspace(0.0, 1.0, len(samples))[:, np.newaxis]
    powers = np.arange(1, degree + 1)
    velocity, _ = integrals(samples, step)
    fit, *_ = np.linalg.lstsq(time**powers, velocity, rcond=None)
    length = step * (len(samples) - 1)
    slope = (powers * time ** (powers - 1)) @ fit / length
    note = f"baseline: derivative of a polynomial of degree {degree} fitted to the velocity taken off"
    return samples - slope, note
