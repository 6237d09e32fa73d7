"""The governing record of a column, and its runs at the stated scale and on both sides of the margin."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from stylobate.base_motions import BaseMotion
from stylobate.earthquakes.assessment.inputs import CENTRAL, NO_VERTICAL, Inputs
from stylobate.earthquakes.assessment.parts import Parts
from stylobate.earthquakes.following import tail_of
from stylobate.earthquakes.incremental import without_vertical
from stylobate.engine import simulate_ensemble
from stylobate.errors import Outcome
from stylobate.progress import Report
from stylobate.results.outcomes import outcome_attributes

STATED, STANDS, OVERTURNS = "stated", "stands", "overturns"
"""The runs under a governing record: at the stated scale nearest to 1; the last survival below the margin, and the
first overturning."""

_HISTORY_SAMPLES = 2001
_OF_RUNS = ("strobes", "demands", "samples")
_DEMANDS = {
    "peak_friction_demand": "friction_demand",
    "peak_pivoting_demand": "pivoting_demand",
    "minimum_normal_force": "minimum_normal_force",
}


def governing_record(verdicts: xr.Dataset, margins: xr.Dataset, scale: int) -> str:
    """Return the name of the governing record of one column.

    A record that overturns the column at the stated scale precedes a record that does not; a record that overturns it
    in the central case precedes a record that does so in another case. Among equal records the smallest overturning
    scale decides (central case, then any case), then the largest peak tilt (stated scale, then any scale).

    Parameters
    ----------
    verdicts, margins
        Verdicts and margins of one column.
    scale
        Index of the stated scale.
    """
    stated = verdicts.isel(scale=scale)
    fallen = stated["overturned"] == 1
    central = {"dissipation": CENTRAL, "vertical": "with"}
    least = margins["least_overturning"].transpose("case", "record")
    tilts = margins["tilt_ratio"].sel(case=CENTRAL).transpose("record", "margin_scale")
    keys = [
        -fallen.sel(central).to_numpy().astype(int),
        -fallen.any(("dissipation", "vertical")).to_numpy().astype(int),
        least.sel(case=CENTRAL).fillna(np.inf).to_numpy(),
        least.min("case").fillna(np.inf).to_numpy(),
        -stated["tilt_ratio"].sel(central).fillna(0.0).to_numpy(),
        -tilts.where(np.isfinite(tilts)).max("margin_scale").fillna(0.0).to_numpy(),
    ]
    # Records are sorted by name, so the choice among equal records does not depend on their order in the input.
    return str(verdicts["record"].to_numpy()[np.lexsort(keys[::-1])[0]])


@dataclass(frozen=True, slots=True)
class _Shown:
    """A run to show: its name, scale and case; the scale is NaN if there is no such run."""

    run: str
    scale: float
    case: str


def _shown(inputs: Inputs, record: str, margins: xr.Dataset) -> list[_Shown]:
    """List the runs under a governing record; the margin is that of the central case, else the smallest of any case."""
    own = margins.sel(record=record)
    least = own["least_overturning"]
    case = CENTRAL
    if not np.isfinite(float(least.sel(case=CENTRAL))) and np.isfinite(least).any():
        case = str(least["case"].to_numpy()[int(least.argmin("case"))])
    own = own.sel(case=case)
    overturns, stands = float(own["least_overturning"]), float(own["largest_below"])
    if math.isnan(overturns):  # show the largest decided scale
        tilt = own["tilt_ratio"].to_numpy()
        known = own["margin_scale"].to_numpy()[np.isfinite(tilt)]
        stands = float(known[-1]) if known.size else math.nan
    return [
        _Shown(STATED, float(inputs.scales[inputs.as_recorded]), CENTRAL),
        _Shown(STANDS, stands, case),
        _Shown(OVERTURNS, overturns, case),
    ]


def histories_of(
    inputs: Inputs, column: str, record: str, margins: xr.Dataset, parts: Parts, *, contact: bool
) -> xr.Dataset:
    """Compute the runs of a column under its governing record: at the stated scale, and beside the margin.

    Returns
    -------
    xarray.Dataset
        Over `run`: "stated", at the stated scale nearest to 1 and the central dissipation; "overturns", at the smallest
        overturning scale of the central case, or of all cases if the central case has none; "stands", the last
        survival below it. If no run overturned the column, "stands" is at the largest decided scale.
        Each run has its `scale`, NaN if there is no such run, and its `case`. Over `sample` too: `time` [s], NaN beyond
        the end of the run; `tilt_x`, `tilt_y` and `amplitude` in units of α_c; `base_x`, `base_y` [m/s²]. Over `run`
        only: `peak_tilt_ratio`, its `azimuth` [rad] and `time_of_peak_tilt` [s]; `overturned`; `outcome`;
        `friction_demand`, `pivoting_demand`, `minimum_normal_force`, NaN without `contact`.
    """
    shown = _shown(inputs, record, margins)
    known = [one for one in shown if math.isfinite(one.scale)]

    def compute(progress: Report) -> xr.Dataset:
        found = []
        for place, one in enumerate(known):
            progress(place, len(known))
            found.append(_history(inputs, column, record, one, contact=contact))
        return xr.concat(found, dim="run", data_vars="all")

    identity = {
        **inputs.with_records([record]).identity(column),
        "runs": [(one.scale, one.case) for one in known],
        "contact": contact,
    }
    found = parts.get(f"{column}: histories under {record}", len(known), identity, compute)
    return (
        found.assign_coords(run=[one.run for one in known])
        .reindex(run=[one.run for one in shown])
        .assign(
            scale=("run", [one.scale for one in shown], {"units": "1", "long_name": "scale factor of the record"}),
            case=("run", [one.case for one in shown]),
        )
    )


def _history(inputs: Inputs, column: str, record: str, shown: _Shown, *, contact: bool) -> xr.Dataset:
    model = inputs.model_of(column, shown.case)
    recorded = inputs.records[record]
    motion = (without_vertical(recorded) if shown.case == NO_VERTICAL else recorded).scaled(shown.scale)
    options: dict[str, Any] = {name: value for name, value in inputs.options.items() if name not in _OF_RUNS}
    duration = motion.duration + tail_of(model.column, inputs.tail)
    runs = simulate_ensemble(model, motion, duration=[duration], samples=_HISTORY_SAMPLES, demands=contact, **options)
    return _table_of_histories(runs.isel(run=0), motion, model.column.tipping_angle)


def _table_of_histories(run: xr.Dataset, motion: BaseMotion, alpha: float) -> xr.Dataset:
    times, tilt = run["sample_time"].to_numpy(), run["sampled_tilt"].to_numpy() / alpha
    size = np.hypot(tilt[:, 0], tilt[:, 1])
    largest = int(np.nanargmax(size))
    base = motion.acceleration(np.nan_to_num(times)) + 0.0 * times[:, np.newaxis]
    fallen = run["outcome"].item() == Outcome.OVERTURNED
    about = {"units": "1", "long_name": "tilt / α_c"}
    curves = {
        "time": (times, {"units": "s", "long_name": "time"}),
        "tilt_x": (tilt[:, 0], about),
        "tilt_y": (tilt[:, 1], about),
        "amplitude": (size, about),
        "base_x": (base[:, 0], {"units": "m s-2", "long_name": "base acceleration along x"}),
        "base_y": (base[:, 1], {"units": "m s-2", "long_name": "base acceleration along y"}),
    }
    numbers = {
        "peak_tilt_ratio": np.inf if fallen else float(run["peak_tilt"]) / alpha,
        "azimuth": float(run["direction"]) if fallen else math.atan2(tilt[largest, 1], tilt[largest, 0]),
        "time_of_peak_tilt": float(run["time_of_peak_tilt"]),
        "overturned": float(fallen),
        **{own: float(run[name]) if name in run else math.nan for name, own in _DEMANDS.items()},
    }
    return xr.Dataset(
        {
            **{name: ("sample", values, attributes) for name, (values, attributes) in curves.items()},
            **{name: ((), value) for name, value in numbers.items()},
            "outcome": ((), float(run["outcome"]), outcome_attributes()),
        }
    )
