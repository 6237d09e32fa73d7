"""Peak tilt rate of a run, from samples of its history."""

import numpy as np

from stylobate.studies.sweeps.quantities import Floats


def peak_tilt_rate(time: Floats, tilt: Floats, tilt_rate: Floats) -> Floats:
    """Compute the peak of |d(tilt)/dt| of each run, to second order in the step between samples.

    The tilt rate of a rocking column peaks just before or after it passes the vertical, and has a corner there. So the
    rate is extrapolated to a passage from the samples on both sides of it.

    Parameters
    ----------
    time
        Times of the samples, shape (..., s) [s].
    tilt, tilt_rate
        Shape (..., s, 2) [rad], [rad/s]; NaN outside the run.

    Returns
    -------
    numpy.ndarray
        Shape (...,) [rad/s]; NaN if a run has no samples.
    """
    before = _largest(time, tilt, tilt_rate)
    after = _largest(-time[..., ::-1], tilt[..., ::-1, :], -tilt_rate[..., ::-1, :])
    return np.fmax(before, after)


def _largest(time: Floats, tilt: Floats, tilt_rate: Floats) -> Floats:
    """Return the largest rate of the samples and of the extrapolations from samples before a passage to the passage.

    The square of the rate is extrapolated linearly in the tilt, because the potential energy depends on the tilt.
    """
    square, angle = (tilt_rate**2).sum(axis=-1), np.linalg.norm(tilt, axis=-1)
    with np.errstate(divide="ignore", invalid="ignore"):
        until = -(tilt * tilt_rate).sum(axis=-1) / square
        across = tilt[..., 0] * tilt_rate[..., 1] - tilt[..., 1] * tilt_rate[..., 0]
        nearest = np.abs(across) / np.sqrt(square)  # smallest tilt on the tangent of the path
        passed = (until[..., 1:-1] > 0.0) & (until[..., 1:-1] < np.diff(time)[..., 1:])
        passed &= np.diff(angle)[..., :-1] < 0.0
        slope = np.diff(square)[..., :-1] / np.diff(angle)[..., :-1]
        continued = square[..., 1:-1] + slope * (nearest - angle)[..., 1:-1]
    continued = np.where(passed, np.fmax(continued, 0.0), np.nan)
    return np.asarray(np.sqrt(np.fmax.reduce(np.concatenate([square, continued], axis=-1), axis=-1)))
