"""Observed fractions of runs that reached a limit state at each intensity, or near it."""

import numpy as np
import xarray as xr

from stylobate.earthquakes.fragility.observations import LIMIT_STATE, Floats, Integers, Observations
from stylobate.studies.proportions import wilson_interval

# Maximum number of separate intensities; more are grouped into bins with equal numbers of runs.
_MOST_STRIPES = 25
_BINS = 10


def observed_shares(seen: Observations, confidence: float) -> xr.Dataset:
    """Compute fractions over `stripe`: runs of one intensity, or bins with equal numbers of runs.

    Each stripe has the geometric mean `stripe_intensity` of its intensities, and their range.
    """
    bins = _bins(seen.intensity)
    count = int(bins.max()) + 1
    logs = np.log(seen.intensity)
    mean = np.exp(np.bincount(bins, weights=logs) / np.bincount(bins))
    ends = np.array([[part.min(), part.max()] for part in (seen.intensity[bins == one] for one in range(count))])
    hits, decided = (
        np.array([np.bincount(bins, weights=state, minlength=count) for state in chosen])
        for chosen in (seen.reached == 1, seen.reached >= 0)
    )
    low, high = wilson_interval(hits, decided, confidence=confidence)
    dims = (LIMIT_STATE, "stripe")
    share = np.where(decided > 0.0, hits / np.maximum(decided, 1.0), np.nan)
    return xr.Dataset(
        {
            "stripe_runs": (dims, decided.astype(np.int64), {"units": "1", "long_name": "runs"}),
            "stripe_reached": (dims, hits.astype(np.int64), {"units": "1", "long_name": "runs that reached it"}),
            "stripe_share": (dims, share, {"units": "1", "long_name": "share of runs that reached it"}),
            "stripe_share_low": (dims, low, {"units": "1", "long_name": "lower end of its interval"}),
            "stripe_share_high": (dims, high, {"units": "1", "long_name": "upper end of its interval"}),
            "stripe_from": ("stripe", ends[:, 0], {**seen.attributes, "long_name": "least intensity"}),
            "stripe_to": ("stripe", ends[:, 1], {**seen.attributes, "long_name": "largest intensity"}),
        },
        coords={"stripe_intensity": ("stripe", mean, seen.attributes), LIMIT_STATE: list(seen.names)},
    )


def _bins(intensity: Floats) -> Integers:
    different, place = np.unique(intensity, return_inverse=True)
    if different.size <= _MOST_STRIPES:
        return np.asarray(place, dtype=np.int64)
    # Runs of one intensity stay together.
    first = np.searchsorted(np.sort(intensity), intensity)
    return np.asarray(np.unique(_BINS * first // intensity.size, return_inverse=True)[1], dtype=np.int64)
