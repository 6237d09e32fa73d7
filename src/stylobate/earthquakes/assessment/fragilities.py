"""Fragility of a column over the peak ground acceleration of the records."""

import numpy as np
import xarray as xr

from stylobate.earthquakes.fragility import fit_fragility
from stylobate.earthquakes.fragility.observations import LIMIT_STATE
from stylobate.earthquakes.intensities import Intensity, IntensityMeasure

_RESAMPLES = 200
_SEED = 0


def fragility_of(reached: xr.DataArray, peak_acceleration: xr.DataArray) -> xr.Dataset:
    """Fit the fragility of one column over the peak ground acceleration.

    Parameters
    ----------
    reached
        Over `record`, `limit_state` and `margin_scale`: 1 reached, 0 not reached, −1 undecided.
    peak_acceleration
        Peak acceleration over `record` [m/s²]: RotD50, or the peak of the only component.
    """
    about = IntensityMeasure(Intensity.PEAK_ACCELERATION).attributes
    names = reached["record"].to_numpy()
    scales = reached["margin_scale"].to_numpy()
    values = np.multiply.outer(peak_acceleration.sel(record=names).to_numpy(), scales)
    intensity = xr.DataArray(values, dims=("record", "scale"), attrs=about)
    states = xr.DataArray(
        reached.transpose(LIMIT_STATE, "record", "margin_scale").to_numpy(),
        dims=(LIMIT_STATE, "record", "scale"),
        coords={LIMIT_STATE: reached[LIMIT_STATE].to_numpy()},
    )
    return fit_fragility(
        intensity,
        states,
        record=xr.DataArray(names, dims="record"),
        resamples=_RESAMPLES,
        rng=np.random.default_rng(_SEED),
    )
