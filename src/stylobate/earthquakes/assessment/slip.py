"""Smallest scale of a record at which a column slides before it rocks."""

import math

import numpy as np
import xarray as xr

from stylobate.base_motions import BaseMotion
from stylobate.column import Column
from stylobate.earthquakes.assessment.inputs import CENTRAL, NO_VERTICAL, Inputs
from stylobate.earthquakes.incremental import without_vertical
from stylobate.studies.sweeps.designs import Floats

# Samples in the shortest period of a motion that is not linear between its breaks: sup |a| is 5e-4 low at most.
_SAMPLES = 100


def least_slip_scale(motion: BaseMotion, friction: float, column: Column) -> float:
    """Compute the smallest scale of `motion` at which a standing `column` exceeds the `friction`; infinite if none.

    The smallest scale s with s |a_h| > μ (g + s a_z) is s = μ g / max(|a_h| − μ a_z).
    """
    horizontal, vertical = _accelerations(motion)
    strongest = float((horizontal - friction * vertical).max())
    return friction * column.gravity / strongest if strongest > 0.0 else math.inf


def _accelerations(motion: BaseMotion) -> tuple[Floats, Floats]:
    """Return |a_h| and a_z [m/s²] at the breaks of a motion; densely if it is not linear between them."""
    end = motion.duration
    times = np.unique([0.0, *(time for time in motion.breaks if 0.0 < time < end), end])
    if motion.degree is None or motion.degree > 1:
        count = math.ceil(_SAMPLES * (1.0 + end * motion.highest_frequency / (2.0 * math.pi)))
        times = np.union1d(times, np.linspace(0.0, end, count))
    x, y, z = motion.acceleration(times).T
    return np.hypot(x, y), z


def standing_slip(inputs: Inputs, column: str, cases: list[str]) -> xr.DataArray:
    """Compute `least_slip_scale` of one column over `case` and `record`; NaN if it rocks before it slides."""
    body, friction = inputs.columns[column][CENTRAL].column, inputs.friction[column]
    slides = column in inputs.sliding_first
    values = [
        [
            least_slip_scale(without_vertical(one) if case == NO_VERTICAL else one, friction, body)
            if slides
            else math.nan
            for one in inputs.records.values()
        ]
        for case in cases
    ]
    about = {"units": "1", "long_name": "smallest scale at which it slides before it rocks"}
    return xr.DataArray(values, dims=("case", "record"), attrs=about)
