"""The paths of orbits, followed once from a strobed state."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import xarray as xr

from stylobate.base_motions import BaseMotion, Harmonic
from stylobate.engine import simulate_ensemble
from stylobate.models import Model
from stylobate.studies.maps.attractor_search import Attractor
from stylobate.studies.maps.stroboscopic import Floats, OrbitScales

# Turn from one sample to the next up to which it is certain to which side it went.
_LARGEST_TURN = np.pi / 2.0
# Times along a path, and the forcing periods for which a motion that does not repeat is followed.
_SAMPLES, _PERIODS_UNREPEATED = 1025, 20


def orbit_paths(
    model: Model, motion: BaseMotion | None, attractors: Sequence[Attractor], scales: OrbitScales
) -> xr.Dataset:
    """Return the tilt along each attractor, and its mean and peak tilt.

    Parameters
    ----------
    model, motion
        The column and its base motion. Paths are followed under a harmonic motion only, whose steady part is known.
    attractors
        What was found.
    scales
        Units of the attractors' states.

    Returns
    -------
    xarray.Dataset
        `orbit_tilt` (attractor_index, orbit_sample, axis) [rad], at equal times over the period (20 forcing periods
        for one that does not repeat); `attractor_mean_tilt` and `attractor_peak_tilt` (attractor_index) [rad]. NaN
        where the attractor ends a run, has not been reached, or its path is not known.
    """
    tilt = np.full((len(attractors), _SAMPLES, 2), np.nan)
    mean = np.array([attractor.mean_tilt for attractor in attractors])
    standing = np.array([attractor.mean_tilt == 0.0 for attractor in attractors], dtype=bool)
    tilt[standing] = 0.0
    steady = _steady(motion)
    moving = [i for i, found in enumerate(attractors) if len(found.states) and not standing[i]]
    if steady is not None and moving:
        tilt[moving] = _followed(model, steady, [attractors[i] for i in moving], scales)
        amplitude = np.hypot(tilt[moving, :, 0], tilt[moving, :, 1])
        mean[moving] = np.trapezoid(amplitude, axis=1) / (_SAMPLES - 1)
    largest = np.hypot(tilt[..., 0], tilt[..., 1]).max(axis=1, initial=0.0)
    return xr.Dataset(
        {
            "attractor_mean_tilt": ("attractor_index", mean, {"units": "rad", "long_name": "mean tilt"}),
            "attractor_peak_tilt": ("attractor_index", largest, {"units": "rad", "long_name": "peak tilt"}),
            "orbit_tilt": (
                ("attractor_index", "orbit_sample", "axis"),
                tilt,
                {"units": "rad", "long_name": "tilt along the orbit"},
            ),
        }
    )


def turns_of_paths(paths: xr.Dataset, attractors: Sequence[Attractor]) -> Floats:
    """Return how often each orbit turns round the upright in a forcing period, anticlockwise, counted along its path.

    NaN where the attractor has no period or no path, or where the path leads past the upright so closely that its
    azimuth cannot be followed from sample to sample.
    """
    x, y = np.moveaxis(paths["orbit_tilt"].to_numpy(), -1, 0)
    steps = np.angle((x[:, 1:] + 1j * y[:, 1:]) * (x[:, :-1] - 1j * y[:, :-1]))
    period = np.array([attractor.period for attractor in attractors], dtype=float)
    followed = (period > 0.0) & (np.abs(steps).max(axis=1, initial=0.0) < _LARGEST_TURN)
    turns = np.full(len(attractors), np.nan)
    turns[followed] = np.round(steps[followed].sum(axis=1) / (2.0 * np.pi)) / period[followed]
    return turns


def _followed(
    model: Model, steady: Harmonic, attractors: Sequence[Attractor], scales: OrbitScales
) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    tilt, tilt_rate = scales.vectors(np.stack([attractor.states[0] for attractor in attractors]))
    periods = np.array([attractor.period or _PERIODS_UNREPEATED for attractor in attractors])
    runs = simulate_ensemble(
        model, steady, tilt=tilt, tilt_rate=tilt_rate, duration=periods * steady.period, samples=_SAMPLES
    )
    return runs["sampled_tilt"].transpose("run", "sample", "axis").to_numpy()


def _steady(motion: BaseMotion | None) -> Harmonic | None:
    """Return the motion from its phase zero on, its ramp long past."""
    return replace(motion, start_phase=0.0, ramp=0.0) if isinstance(motion, Harmonic) else None
