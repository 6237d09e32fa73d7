"""Columns that slide before they rock, with the model `Sliding`: outcome and slip."""

from typing import Any

import numpy as np
import xarray as xr

from stylobate.earthquakes.assessment.inputs import CENTRAL, Inputs
from stylobate.earthquakes.assessment.parts import Parts
from stylobate.earthquakes.following import tail_of
from stylobate.engine import simulate
from stylobate.errors import Outcome
from stylobate.models import Model, Sliding
from stylobate.models.declared import dissipation_of
from stylobate.progress import Report
from stylobate.results.outcomes import NOT_COMPUTED, NUMERICALLY_UNCERTAIN, outcome_attributes
from stylobate.run_arguments import Accuracy, numbers_of

_OPTIONS = tuple(name for name in numbers_of(Accuracy) if name != "tilt_limit")
_NUMBERS = {
    "tilt_ratio": ("1", "peak tilt / α_c"),
    "residual_slip": ("m", "distance of the footprint from its start at the end"),
    "peak_slip": ("m", "peak distance of the footprint from its start"),
    "slip_path": ("m", "length of the path of slip"),
    "time_sliding": ("s", "time of sliding on the base"),
}
Run = dict[str, float]


def sliding_of(inputs: Inputs, column: str, parts: Parts) -> xr.Dataset:
    """Run a column with `Sliding`, at its stated friction and the central dissipation.

    Returns
    -------
    xarray.Dataset
        Over `record` and `scale`: `outcome`; `overturned` (1, 0, −1 not decided); `uncertain` (1 if rounding or the
        rest threshold could alter the outcome); `tilt_ratio`, infinite if the column overturned; `residual_slip`,
        `peak_slip` and `slip_path` [m]; `time_sliding` [s]. A column that rocks before it slides is not run: `outcome`
        and `overturned` are −1, the rest is NaN.
    """
    followed = column in inputs.sliding_first
    rows = [
        [_run(inputs, column, record, scale, parts) if followed else _NOT_FOLLOWED for scale in inputs.scales.tolist()]
        for record in inputs.records
    ]

    def over(name: str, dtype: type, **attributes: Any) -> xr.Variable:
        return xr.Variable(
            ("record", "scale"), np.array([[run[name] for run in row] for row in rows], dtype), attributes
        )

    return xr.Dataset(
        {
            "outcome": over("outcome", np.int8, **outcome_attributes()),
            "overturned": over("overturned", np.int8, long_name="overturned"),
            "uncertain": over("uncertain", np.int8, long_name=NUMERICALLY_UNCERTAIN),
            **{
                name: over(name, float, units=unit, long_name=long_name) for name, (unit, long_name) in _NUMBERS.items()
            },
        },
        coords={"record": list(inputs.records), "scale": inputs.scales},
    )


def sliding_runs(inputs: Inputs) -> int:
    """Return the number of runs for the columns that slide."""
    return len(inputs.sliding_first) * len(inputs.records) * inputs.scales.size


_NOT_FOLLOWED: Run = {"outcome": NOT_COMPUTED, "overturned": -1.0, "uncertain": 0.0, **dict.fromkeys(_NUMBERS, np.nan)}


def sliding_model(given: Model, friction: float) -> Sliding:
    """Return `Sliding` with the column of a model and those dissipation parameters that both models have."""
    losses = {name: getattr(given, name) for name in dissipation_of(Sliding) if name in dissipation_of(type(given))}
    return Sliding(given.column, friction_coefficient=friction, **losses)


def _run(inputs: Inputs, column: str, record: str, scale: float, parts: Parts) -> Run:
    given = inputs.columns[column][CENTRAL]
    model = sliding_model(given, inputs.friction[column])
    motion = inputs.records[record].scaled(scale)
    options: dict[str, Any] = {name: value for name, value in inputs.options.items() if name in _OPTIONS}

    def compute(progress: Report) -> xr.Dataset:
        progress(0, 1)
        duration = motion.duration + tail_of(given.column, inputs.tail)
        run = simulate(model, motion, duration=duration, **options)
        fallen, undecided = run.outcome is Outcome.OVERTURNED, run.outcome is Outcome.FAILED
        places = run.data["footprint"].transpose("axis", "time").to_numpy()
        tilt = run.measures["peak_tilt"] / given.column.tipping_angle
        return xr.Dataset(
            {
                "outcome": int(run.outcome),
                "overturned": -1.0 if undecided else float(fallen),
                "uncertain": float(run.uncertain),
                "tilt_ratio": np.inf if fallen else np.nan if undecided else tilt,
                "residual_slip": run.measures["residual_displacement"],
                "peak_slip": float(np.hypot(*places).max()),
                "slip_path": run.measures["slip_distance"],
                "time_sliding": run.measures["time_sliding"],
            }
        )

    identity = {
        **inputs.with_records([record]).identity(column, inputs.columns[column][CENTRAL]),
        "scale": scale,
        "sliding": inputs.friction[column],
    }
    found = parts.get(f"{column}: sliding under {record}, scale {scale:g}", 1, identity, compute)
    return {str(name): float(value) for name, value in found.data_vars.items()}
