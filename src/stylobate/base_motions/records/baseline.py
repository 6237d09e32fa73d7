"""Baseline correction: removal of spurious drift of the velocity."""

import numpy as np
import numpy.typing as npt

from stylobate.base_motions.records.knots import integrals
from stylobate.errors import require_whole

Floats = npt.NDArray[np.float64]


def baseline_corrected(samples: Floats, step: float, degree: int = 1) -> tuple[Floats, str]:
    """Subtract the derivative of a polynomial fitted to the velocity; return samples and a log line.

    Parameters
    ----------
    samples
        Accelerations, shape (n, 3) [m/s²].
    step
        Time step [s].
    degree
        Degree of the polynomial, 1 or more. The polynomial and the velocity are zero at the first sample; degree 1
        subtracts a constant from the acceleration.

    Notes
    -----
    Least squares over the velocities at the samples, for each component separately. The remaining velocity is small but
    not zero; a high-pass filter (`Record.filtered`) removes drift that is no polynomial.
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
