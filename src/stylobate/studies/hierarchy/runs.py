"""One run of the model hierarchy: its history at given times and its final state."""

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate.base_motions import BaseMotion
from stylobate.errors import Outcome
from stylobate.results import Response

Floats = npt.NDArray[np.float64]

# Late part of the run, as a fraction; for a periodic base motion, the whole periods that it contains.
_LATE = 0.2

# Number of times for means.
_TIMES = 400


@dataclass(frozen=True, slots=True)
class Course:
    """A run and its requested duration [s]; a run that came to rest early stands until the end."""

    run: Response
    duration: float

    def history(self, time: Floats) -> tuple[Floats, Floats]:
        """Return tilt vectors [rad], shape (n, 2), and spin [rad/s] at `time`; NaN after the end or without a spin."""
        end = float(self.run.data["time"][-1])
        known = time <= end
        tilt, spin = np.full((time.size, 2), np.nan), np.full(time.size, np.nan)
        sampled = self.run.sample(time[known])
        tilt[known] = sampled["tilt"]
        if "spin" in sampled:
            spin[known] = sampled["spin"]
        if self.run.outcome is Outcome.AT_REST:
            tilt[~known] = 0.0
            spin[~known] = spin[known][-1] if known.any() else np.nan
        return tilt, spin

    def late_means(self, motion: BaseMotion) -> dict[str, float]:
        """Return the mean tilt angle [rad] and spin [rad/s] late in the run; NaN if it ended before."""
        window = _LATE * self.duration
        if motion.period is not None and motion.period <= window:
            window = motion.period * math.floor(window / motion.period)
        start = self.duration - window
        tilt, spin = self.history(start + window * np.arange(_TIMES) / _TIMES)
        return {"mean_late_tilt": float(np.hypot(*tilt.T).mean()), "mean_late_spin": float(spin.mean())}


def largest_distance(first: xr.DataArray, second: xr.DataArray) -> float:
    """Return the maximum distance of two histories of the tilt vector while both are known [rad]."""
    return float(np.nanmax(np.hypot(*(first.to_numpy() - second.to_numpy()).T)))
