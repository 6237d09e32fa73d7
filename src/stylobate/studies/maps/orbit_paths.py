"""Paths of orbits, each integrated once from a stroboscopic sample."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import xarray as xr

from stylobate.base_motions import BaseMotion, Harmonic
from stylobate.engine import simulate_ensemble
from stylobate.models import Model
from stylobate.studies.maps.attractor_search import Attractor
from stylobate.studies.maps.stroboscopic import Floats, OrbitScales

# Maximum turn between samples for which its sense is certain.
_LARGEST_TURN = np.pi / 2.0
# Number of times along a path, and of forcing periods for a motion that does not repeat.
_SAMPLES, _PERIODS_UNREPEATED = 1025, 20


def orbit_paths(
    model: Model, motion: BaseMotion | None, attractors: Sequence[Attractor], scales: OrbitScales
) -> xr.Dataset:
    """Return the tilt along each attractor, and its mean and peak tilt.

    Parameters
    ----------
    model, motion
        The column and its base motion. Only a harmonic motion has paths, because its steady part is known.
    attractors
        The attractors.
    scales
        Units of the attractors' states.

    Returns
    -------
    xarray.Dataset
        `orbit_tilt` (attractor_index, orbit_sample, axis) [rad], at equal times over the period (20 forcing periods for
        an attractor that does not repeat); `attractor_mean_tilt` and `attractor_peak_tilt` (attractor_index) [rad]. NaN
        if the attractor ends a run, has not been reached, or its path is unknown.
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
    """Count the turns of each orbit round the vertical per forcing period along its path, anticlockwise positive.

    NaN if the attractor has no period or no path, or if the path passes so close to the vertical that the change of its
    azimuth between samples is ambiguous.
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
    """Return the harmonic motion from phase zero, without ramp."""
    return replace(motion, start_phase=0.0, ramp=0.0) if isinstance(motion, Harmonic) else None
