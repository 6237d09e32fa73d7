"""Runs, columns and records as answers, with the warnings about unlikely input."""

import warnings
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from stylobate import config
from stylobate.base_motions import Record
from stylobate.config.snippets import as_python, as_toml
from stylobate.errors import UnlikelyInputWarning
from stylobate.files import file_of
from stylobate.lab.answers import OF_ANY_COLUMN, ColumnNumbers, Described, Measures, Peaks, Run, RunEvent, Series
from stylobate.lab.extremes import Floats, Histories, extremes
from stylobate.lab.requests import Description
from stylobate.models import Model
from stylobate.plots.animation.motion import drawn_motion
from stylobate.results import Run as FinishedRun
from stylobate.results.run_rows import column_rows, damping_rows, measure_rows

if TYPE_CHECKING:
    import xarray as xr

_HISTORIES = (
    *("time", "base_acceleration", "amplitude", "azimuth", "rolling_rate", "spin"),
    *("friction_demand", "pivoting_demand", "contact", "clearance"),
)


def answered_run(
    run: FinishedRun, model: Model, given: Description, remarked: Iterable[str] = (), *, frequency: float
) -> Run:
    """Convert a run to the answer: outcome, histories and motion to draw.

    `frequency` is the highest angular frequency of the motion [rad/s], by which extremes between samples are found.
    """
    return Run(
        **snippets(given),
        column=column_numbers(model),
        outcome=run.outcome.name,
        label=run.outcome.label,
        reason=run.reason,
        decided_at=run.decided_at,
        uncertain=run.uncertain,
        planar=run.planar,
        warnings=[*remarked, *run.warnings],
        events=[RunEvent(kind=event.kind, time=event.time) for event in run.events],
        measures=Measures(dict(run.measures)),
        summary=[
            *column_rows(model.column, model.rest_capacity),
            *damping_rows(model.column, getattr(model, "damping", None)),
            *measure_rows(run),
        ],
        thresholds=dict(run.thresholds),
        drawn=drawn_motion(run),
        series=_series(run, model, frequency),
    )


def snippets(given: Description) -> dict[str, str]:
    """Return the description as a TOML file and as a Python program."""
    return {
        "toml": as_toml(given.shown),
        "python": as_python(config.SimulationConfig.parse(given.shown)),
    }


def described_case(given: Description) -> Described:
    """Describe a case without a run."""
    model = config.SimulationConfig.parse(given.values).build().model
    return Described(**snippets(given), column=column_numbers(model))


def column_numbers(model: Model) -> ColumnNumbers:
    """Return the decisive numbers of the column."""
    column = model.column
    found = {name: float(getattr(column, name)) for name in OF_ANY_COLUMN}
    return ColumnNumbers({**found, "uplift_acceleration": column.slenderness * column.gravity})


def _series(run: FinishedRun, model: Model, frequency: float) -> Series:
    """Return the histories for the page: numbers over time, and displacements along the plane from the start."""
    first = run.data["footprint"][0].to_numpy() if "footprint" in run.data else None
    found = _histories(run.data, model, first)

    def between(time: Floats) -> Histories:
        return _components(_histories(run.sample(time), model, first))

    return Series(**found, extremes=extremes(between, found["time"], frequency))


def _histories(data: "xr.Dataset", model: Model, first: Floats | None) -> dict[str, Any]:
    histories: dict[str, Any] = {name: data[name].to_numpy() for name in _HISTORIES if name in data}
    if "normal_force" in data:
        histories["normal_force"] = data["normal_force"].to_numpy() / (model.column.mass * model.column.gravity)
    if first is not None:
        histories["displacement"] = data["footprint"].to_numpy() - first
    if "slip_velocity" in data:
        histories["slip_speed"] = np.hypot(*data["slip_velocity"].transpose("axis", "time").to_numpy())
    return histories


_NOT_CHARTED = ("time", "azimuth", "contact")


def _components(histories: Histories) -> dict[str, Floats]:
    """Return each history that a chart shows; one of vectors has a component for each axis."""
    return {
        name if column is None else f"{name}_{'xyz'[column]}": values if column is None else values[:, column]
        for name, values in histories.items()
        if name not in _NOT_CHARTED
        for column in ([None] if values.ndim == 1 else range(values.shape[1]))
    }


def record_contents(record: Record) -> dict[str, Any]:
    """Return the contents of a record by the names of `UploadedRecord`."""
    peaks = {axis: float(abs(record.samples[:, index]).max()) for index, axis in enumerate("xyz")}
    return {
        "name": record.name,
        "samples": len(record.samples),
        "step": record.step,
        "duration": record.duration,
        "peaks": Peaks(**{axis: peak for axis, peak in peaks.items() if peak > 0.0}),
        "provenance": list(record.provenance),
    }


@contextmanager
def remarks(values: Mapping[str, Any]) -> Iterator[list[str]]:
    """Collect each `UnlikelyInputWarning` issued in the context, once, as a line; issue other warnings afterwards.

    Users of the page do not see the terminal of the server.

    The lines contain the names of files in `values` without the server's folder. The filters of warnings apply to the
    whole process: use this context only if no other thread computes.
    """
    lines: list[str] = []
    with warnings.catch_warnings(record=True) as issued:
        warnings.simplefilter("always", UnlikelyInputWarning)
        yield lines
    folders = set(_folders(values))
    for one in issued:
        if not issubclass(one.category, UnlikelyInputWarning):
            warnings.warn_explicit(one.message, one.category, one.filename, one.lineno)
            continue
        line = str(one.message)
        for folder in folders:
            line = line.replace(folder, "")
        if line not in lines:
            lines.append(line)


def _folders(values: Any) -> Iterator[str]:
    """Yield the folders of all files named as `path`, at any depth."""
    if isinstance(values, list | tuple):
        for one in values:
            yield from _folders(one)
    elif isinstance(values, Mapping):
        for name, value in values.items():
            if name == "path":
                for path in [value] if isinstance(value, str) else value or ():
                    yield f"{file_of(Path(path)).parent}/"  # of the archive, for a file in one
            else:
                yield from _folders(value)
