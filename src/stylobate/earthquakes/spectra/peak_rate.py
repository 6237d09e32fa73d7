"""The largest rate of tilt of a run, from samples of its history."""

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]


def peak_tilt_rate(time: Floats, tilt: Floats, tilt_rate: Floats) -> Floats:
    """Return the largest |d(tilt)/dt| of each run, to second order in the step between samples.

    The rate of a rocking column is largest just before or after it passes the upright, with a corner there. So between
    two samples that have it in between, the rate is continued from either side to the passage.

    Parameters
    ----------
    time
        Of the samples, shape (..., s) [s].
    tilt, tilt_rate
        Shape (..., s, 2) [rad], [rad/s]; NaN outside the run.

    Returns
    -------
    numpy.ndarray
        Shape (...,) [rad/s]; NaN where a run has no samples.
    """
    before = _largest(time, tilt, tilt_rate)
    after = _largest(-time[..., ::-1], tilt[..., ::-1, :], -tilt_rate[..., ::-1, :])
    return np.fmax(before, after)


def _largest(time: Floats, tilt: Floats, tilt_rate: Floats) -> Floats:
    """Return the largest rate at the samples, and continued from those before a passage to the passage.

    The square of the rate is continued linearly in the tilt, on which the energy of gravity depends.
    """
    square, angle = (tilt_rate**2).sum(axis=-1), np.linalg.norm(tilt, axis=-1)
    with np.errstate(divide="ignore", invalid="ignore"):
        until = -(tilt * tilt_rate).sum(axis=-1) / square
        across = tilt[..., 0] * tilt_rate[..., 1] - tilt[..., 1] * tilt_rate[..., 0]
        nearest = np.abs(across) / np.sqrt(square)  # to the upright, on the straight way on
        passed = (until[..., 1:-1] > 0.0) & (until[..., 1:-1] < np.diff(time)[..., 1:])
        passed &= np.diff(angle)[..., :-1] < 0.0
        slope = np.diff(square)[..., :-1] / np.diff(angle)[..., :-1]
        continued = square[..., 1:-1] + slope * (nearest - angle)[..., 1:-1]
    continued = np.where(passed, np.fmax(continued, 0.0), np.nan)
    return np.asarray(np.sqrt(np.fmax.reduce(np.concatenate([square, continued], axis=-1), axis=-1)))
