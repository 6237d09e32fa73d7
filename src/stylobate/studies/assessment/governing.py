"""Which record governs a column, and the history of that run."""

import math
from typing import Any

import numpy as np
import xarray as xr

from stylobate.engine import simulate_ensemble
from stylobate.errors import Outcome
from stylobate.motions import BaseMotion
from stylobate.results.outcomes import code_of
from stylobate.studies.assessment.inputs import CENTRAL, Inputs
from stylobate.studies.assessment.parts import Parts
from stylobate.studies.shaking.following import tail_of
from stylobate.studies.sweeps.computing import Progress

_SAMPLES = 2001
_OF_RUNS = ("strobes", "demands", "samples")
_DEMANDS = {
    "largest_friction_demand": "friction_demand",
    "largest_pivoting_demand": "pivoting_demand",
    "least_normal_force": "least_normal_force",
}


def governing_record(verdicts: xr.Dataset, margins: xr.Dataset, scale: int) -> str:
    """Return the record that overturns one column at the least scale; where none does, that of the largest tilt.

    Parameters
    ----------
    verdicts, margins
        Of one column.
    scale
        The place of the scale at which tilts are compared.
    """
    least = margins["least_overturning"].sel(case=CENTRAL).to_numpy()
    tilt = verdicts["tilt_ratio"].sel(dissipation=CENTRAL, vertical="with").isel(scale=scale).to_numpy()
    # Records are sorted by name: the first of equals is the same whatever order they came in.
    if np.isfinite(least).any():
        place = int(np.nanargmin(least))
    else:
        place = int(np.argmax(np.where(np.isnan(tilt), -1.0, tilt)))
    return str(verdicts["record"].to_numpy()[place])


def history_of(inputs: Inputs, column: str, record: str, parts: Parts, *, contact: bool) -> xr.Dataset:
    """Return the run of a column under its governing record, at the central dissipation.

    Returns
    -------
    xarray.Dataset
        Over `sample`: `time` [s], NaN beyond the end of the run; `tilt_x`, `tilt_y` and `amplitude` in units of α;
        `base_x`, `base_y` [m/s²]. Without: `largest_tilt_ratio`, its `azimuth` [rad] and `time_of_largest_tilt` [s];
        `overturned`; `friction_demand`, `pivoting_demand`, `least_normal_force`, NaN without `contact`.
    """
    scale = float(inputs.scales[inputs.as_recorded])
    model = inputs.columns[column][CENTRAL]
    motion = inputs.records[record].scaled(scale)

    def compute(progress: Progress) -> xr.Dataset:
        progress(0, 1)
        options: dict[str, Any] = {name: value for name, value in inputs.options.items() if name not in _OF_RUNS}
        duration = motion.duration + tail_of(model.column, inputs.tail)
        runs = simulate_ensemble(model, motion, duration=[duration], samples=_SAMPLES, demands=contact, **options)
        return _told(runs.isel(run=0), motion, model.column.tipping_angle)

    identity = {
        **inputs.with_records([record]).identity(column, CENTRAL),
        "scale": scale,
        "contact": contact,
    }
    return parts.get(f"{column}: history under {record}", 1, identity, compute)


def _told(run: xr.Dataset, motion: BaseMotion, alpha: float) -> xr.Dataset:
    times, tilt = run["sample_time"].to_numpy(), run["sampled_tilt"].to_numpy() / alpha
    size = np.hypot(tilt[:, 0], tilt[:, 1])
    largest = int(np.nanargmax(size))
    base = motion.acceleration(np.nan_to_num(times)) + 0.0 * times[:, np.newaxis]
    fallen = run["outcome"].item() == code_of(Outcome.OVERTURNED)
    about = {"units": "1", "long_name": "tilt over α"}
    curves = {
        "time": (times, {"units": "s", "long_name": "time"}),
        "tilt_x": (tilt[:, 0], about),
        "tilt_y": (tilt[:, 1], about),
        "amplitude": (size, about),
        "base_x": (base[:, 0], {"units": "m s-2", "long_name": "base acceleration along x"}),
        "base_y": (base[:, 1], {"units": "m s-2", "long_name": "base acceleration along y"}),
    }
    numbers = {
        "largest_tilt_ratio": np.inf if fallen else float(run["largest_tilt"]) / alpha,
        "azimuth": float(run["direction"]) if fallen else math.atan2(tilt[largest, 1], tilt[largest, 0]),
        "time_of_largest_tilt": float(run["time_of_largest_tilt"]),
        "overturned": float(fallen),
        **{own: float(run[name]) if name in run else math.nan for name, own in _DEMANDS.items()},
    }
    return xr.Dataset(
        {
            **{name: ("sample", values, attributes) for name, (values, attributes) in curves.items()},
            **{name: ((), value) for name, value in numbers.items()},
        }
    )
