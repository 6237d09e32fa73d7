"""Answers: runs, columns and records as plain values for JSON."""

from typing import Any

import numpy as np

from stylobate import config
from stylobate.base_motions import Record
from stylobate.lab.json_values import numbers, table
from stylobate.lab.parameter_info import OF_ANY_COLUMN
from stylobate.lab.requests import Described
from stylobate.models import Model
from stylobate.plots.animation import drawn_motion
from stylobate.results import Response
from stylobate.results.summary import column_rows, damping_rows, measure_rows


def plain_run(run: Response, model: Model) -> dict[str, Any]:
    """Convert a run to plain values: outcome, histories and motion to draw."""
    return {
        "outcome": run.outcome.name,
        "label": run.outcome.label,
        "reason": run.reason,
        "decided_at": run.decided_at,
        "uncertain": run.uncertain,
        "planar": run.planar,
        "warnings": list(run.warnings),
        "events": [{"kind": event.kind, "time": event.time} for event in run.events],
        "measures": table(run.measures),
        "summary": [
            *column_rows(model.column, model.rest_capacity),
            *damping_rows(model.column, getattr(model, "damping", None)),
            *measure_rows(run),
        ],
        "thresholds": table(run.thresholds),
        "column": plain_column(model),
        "drawn": drawn_motion(run),
        "series": _series(run, model),
    }


def snippets(given: Described) -> dict[str, str]:
    """Return the description as a TOML file and as a Python program."""
    description = config.SimulationConfig.parse(given.shown)
    return {"toml": config.as_toml(given.shown), "python": config.as_python(description)}


def plain_column(model: Model) -> dict[str, float]:
    """Return the decisive numbers of the column."""
    column = model.column
    return {
        **{name: float(getattr(column, name)) for name in OF_ANY_COLUMN},
        "uplift_acceleration": column.slenderness * column.gravity,
    }


def _series(run: Response, model: Model) -> dict[str, Any]:
    """Return the histories for the page: numbers over time, and displacements along the plane from the start."""
    data = run.data
    histories = {name: numbers(data[name]) for name in _HISTORIES if name in data}
    if "normal_force" in data:
        histories["normal_force"] = numbers(data["normal_force"] / (model.column.mass * model.column.gravity))
    if "footprint" in data:
        histories["displacement"] = numbers(data["footprint"] - data["footprint"][0])
    if "slip_velocity" in data:
        histories["slip_speed"] = numbers(np.hypot(*data["slip_velocity"].transpose("axis", "time").to_numpy()))
    return histories


_HISTORIES = (
    *("time", "base_acceleration", "amplitude", "azimuth", "rolling_rate", "spin"),
    *("friction_demand", "pivoting_demand", "contact", "clearance"),
)


def plain_record(record: Record) -> dict[str, Any]:
    """Describe an uploaded record."""
    peaks = {axis: float(abs(record.samples[:, index]).max()) for index, axis in enumerate("xyz")}
    return {
        "name": record.name,
        "samples": len(record.samples),
        "step": record.step,
        "duration": record.duration,
        "peaks": table({axis: peak for axis, peak in peaks.items() if peak > 0.0}),
        "provenance": list(record.provenance),
    }
