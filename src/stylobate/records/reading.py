"""Reading of a record from one file, and writing."""

import os
import warnings
from collections.abc import Mapping
from dataclasses import replace
from enum import Enum
from pathlib import Path
from typing import Any

import numpy as np

from stylobate.base_motions.record import AXES, Record, RecordOrigin
from stylobate.base_motions.signal_processing import Floats
from stylobate.column import STANDARD_GRAVITY
from stylobate.errors import FileError, ParameterError, UnlikelyInputWarning, require_positive
from stylobate.files import write_whole
from stylobate.records.databases import is_asc, is_at2, is_wrapped, read_asc, read_at2, read_waveform
from stylobate.records.directions import Component
from stylobate.records.events import require_path
from stylobate.records.tables import TextTable, read_named_columns, read_table
from stylobate.records.text_files import KNOWN, REMARKS, Text, in_si, is_binary, read_bytes, require_unit

# Horizontal and vertical peaks of earthquakes are below, except a few close to the fault [g].
_LARGEST_PEAK = 3.0
# Longest step and duration of an accelerogram that are likely [s].
_LONGEST_STEP, _LONGEST_DURATION = 0.5, 7200.0
# Range of steps of readable records [s], and a bound on accelerations in any unit.
_STEPS = (1e-9, 1e6)
_BEYOND_ALL = 1e30


class RecordFormat(Enum):
    """Format of a record file."""

    AT2 = "PEER AT2"
    ASC = "ESM and ITACA ASC, with the header of DYNA 1.x"
    TABLE = "one column of accelerations, or time and acceleration"
    CSV = "named columns"
    WAVEFORM = "whatever ObsPy reads"


def read_record(
    path: str | os.PathLike[str],
    units: str | None = None,
    *,
    step: float | None = None,
    columns: Mapping[str, str] | None = None,
    axis: str | None = None,
    format: RecordFormat | None = None,  # noqa: A002  the word of the field
) -> Record:
    """Read a record from one file.

    Parameters
    ----------
    path
        The file; gzip is unpacked.
    units
        Unit of the accelerations: "g", "m/s²" (m/s2), "cm/s²" (cm/s2, gal) or "mm/s²". Optional only if the file states
        the unit, which is never guessed.
    step
        Time step [s], for a file without step: a single column, or an AT2 file without the line of NPTS and DT.
    columns
        Names of the columns "time", "x", "y" and "z" of a CSV file.
    axis
        Axis of the record along which a single component acts: "x", "y" or "z". None is z if the file states up or down
        (for down with reversed sign), otherwise x.
    format
        Format of the file; None detects it.

    Raises
    ------
    FileError
        If the file is missing, empty, cut short, holds something that is not a number or unequal steps, or does not
        state its unit; with the number of the line.
    ParameterError
        If units are unknown or contradict the file.
    UnsupportedError
        If only ObsPy reads the format and it is not installed.

    Warns
    -----
    UnlikelyInputWarning
        If the peak exceeds 3 g, for example because a file in cm/s² is read in g. If a file that states no unit of time
        has steps of more than 0.5 s or lasts more than 2 h, for example because its times are in ms.
    """
    path = require_path("path", path)
    step = None if step is None else require_positive("step", step, "s")
    record = as_record(read_component(path, step, columns, format), path, units, axis)
    origin = RecordOrigin.of_files(path, axis=axis, one_component=True, **plain_reading(units, step, columns, format))
    return replace(record, origin=origin)


def plain_reading(
    units: str | None,
    step: float | None,
    columns: Mapping[str, str] | None,
    format: RecordFormat | None,  # noqa: A002
) -> dict[str, Any]:
    """Convert the arguments of the reading to plain values for the origin of a record."""
    return {
        "units": units,
        "step": step,
        "columns": None if columns is None else dict(columns),
        "format": None if format is None else format.name.lower(),
    }


def read_component(
    path: Path,
    step: float | None,
    columns: Mapping[str, str] | None,
    format: RecordFormat | None,  # noqa: A002
) -> Component:
    """Read the component of a file in the units of the file."""
    content = read_bytes(path)
    if is_binary(content) and format in (None, RecordFormat.AT2) and _is_called_at2(path):
        raise FileError(f"{path}: no AT2 file: it is no text, and has no header with NPTS and DT. Download it again")
    if format is RecordFormat.WAVEFORM or (
        format is None and (is_binary(content) or content.startswith(b"Origin Time"))
    ):
        return read_waveform(path, content)
    if is_binary(content):
        remedy = "Leave format out, or export the record as text"
        raise FileError(f"{path}: a binary file, not {format.value if format else 'text'}. {remedy}")
    return _read_text(Text.of(path, content), step, columns, format)


def _read_text(
    text: Text,
    step: float | None,
    columns: Mapping[str, str] | None,
    format: RecordFormat | None,  # noqa: A002
) -> Component:
    if all(not line.strip() or line.lstrip().startswith(REMARKS[0]) for line in text.lines):
        raise text.fault(len(text.lines) - 1, "the file has no numbers. Export it again")
    without_header = _is_called_at2(text.path) and is_wrapped(text)
    if format is RecordFormat.AT2 or (format is None and (is_at2(text) or without_header)):
        return read_at2(text, step)
    if format is RecordFormat.ASC or (format is None and is_asc(text)):
        return read_asc(text)
    table = TextTable.of(text, named=columns is not None)
    if format is RecordFormat.CSV or (format is None and table.names is not None):
        return read_named_columns(table, columns, step)
    return read_table(table, step)


def _is_called_at2(path: Path) -> bool:
    return path.name.lower().removesuffix(".gz").endswith(".at2")


def as_record(component: Component, path: Path, units: str | None, axis: str | None) -> Record:
    """Convert the component of a file to a record in SI units."""
    factor, unit_text = _scale(component, path, units)
    _require_possible(component, path)
    provenance: tuple[str, ...] = (
        f"read from {path.name}, {unit_text}" + (f": {component.title}" if component.title else ""),
    )
    _remark_on_the_peak(factor * component.samples, path, unit_text)
    _remark_on_the_times(component, path)
    direction = component.direction
    if component.samples.ndim > 1:
        samples = factor * component.samples
        return Record(
            samples=samples, step=component.step, start=component.start, name=name_of(path), provenance=provenance
        )
    up = direction.vertical if direction else 0
    axis = ("z" if up else "x") if axis is None else axis
    if axis not in AXES:
        raise ParameterError(f'axis must be "x", "y" or "z", got {axis!r}')
    if direction is not None:
        provenance += (f"{direction} along {axis}" + (" with its sign turned" if up < 0 and axis == "z" else ""),)
    sign = -1.0 if up < 0 and axis == "z" else 1.0
    along = {axis: sign * factor * component.samples}
    return Record.from_components(
        **along, step=component.step, start=component.start, name=name_of(path), provenance=provenance
    )


def _require_possible(component: Component, path: Path) -> None:
    """Raise FileError at numbers that overflow in floating-point arithmetic; no record has such numbers."""
    for what, value, least, most in (
        ("a time step [s]", component.step, *_STEPS),
        ("a peak", float(np.abs(component.samples).max()), 0.0, _BEYOND_ALL),
    ):
        if not least <= value <= most:
            raise FileError(f"{path}: {what} must be between {least:g} and {most:g}, got {value:g}. Check the numbers")


def _remark_on_the_peak(samples: Floats, path: Path, unit_text: str) -> None:
    peak = float(np.abs(samples).max()) / STANDARD_GRAVITY
    if peak > _LARGEST_PEAK:
        message = (
            f"{path}: its peak is {peak:.3g} g, read {unit_text}; hardly any earthquake shakes the ground beyond "
            f"{_LARGEST_PEAK:g} g: if the file is in another unit, such as cm/s², name that (units)"
        )
        warnings.warn(message, UnlikelyInputWarning, stacklevel=2)


def _remark_on_the_times(component: Component, path: Path) -> None:
    duration = component.step * (len(component.samples) - 1)
    if component.states_time_unit or (component.step <= _LONGEST_STEP and duration <= _LONGEST_DURATION):
        return
    message = (
        f"{path}: check the unit of time: the step read in s is {component.step:g} s, the duration {duration:.5g} s. "
        "State the unit beside the name of the times, such as time [ms] or time [s], or give times and step in s"
    )
    warnings.warn(message, UnlikelyInputWarning, stacklevel=2)


def name_of(path: Path) -> str:
    """Return the name of a file without folder and suffixes."""
    name = path.name.removesuffix(".gz")
    return name.rpartition(".")[0] or name


def _scale(component: Component, path: Path, units: str | None) -> tuple[float, str]:
    given = None if units is None else require_unit(units)
    if component.unit is None and given is None:
        raise FileError(f"{path}: the file names no unit: state units, {KNOWN}")
    if component.unit is not None and given is not None and component.unit != given:
        raise ParameterError(
            f"{path}: units must be left out or {component.unit!r}, which the file states, got {units!r}"
        )
    unit = component.unit or given
    assert unit is not None
    return in_si(unit), f"in {unit}" + (" as the file states" if component.unit else " as given")


_ON_A_LINE = 5


def write_csv(record: Record, path: str | os.PathLike[str]) -> Path:
    """Write time [s] and the accelerations along x, y and z [m/s²] and return the path; reading restores each number.

    Raises
    ------
    FileError
        If the file cannot be written.
    """
    rows = zip(record.times.tolist(), *record.samples.T.tolist(), strict=True)
    header = ",".join(["time [s]", *(f"{axis} [m/s²]" for axis in AXES)])
    return _write_lines(path, [header, *(",".join(map(repr, row)) for row in rows)])


def write_at2(record: Record, path: str | os.PathLike[str], *, axis: str) -> Path:
    """Write the accelerations along one `axis` as a PEER AT2 file, in g with eight digits, and return the path.

    Raises
    ------
    FileError
        If the file cannot be written.
    ParameterError
        If the axis is not "x", "y" or "z".
    """
    if axis not in AXES:
        raise ParameterError(f'axis must be "x", "y" or "z", got {axis!r}')
    values = [f"{value:15.7E}" for value in (record.samples[:, AXES.index(axis)] / STANDARD_GRAVITY).tolist()]
    header = [
        "PEER format, written by stylobate",
        f"{record.name}, {'UP' if axis == 'z' else axis}",
        "ACCELERATION TIME SERIES IN UNITS OF G",
        f"NPTS= {len(values):6d}, DT= {record.step!r} SEC",
    ]
    lines = ["".join(values[at : at + _ON_A_LINE]) for at in range(0, len(values), _ON_A_LINE)]
    return _write_lines(path, [*header, *lines])


def _write_lines(path: str | os.PathLike[str], lines: list[str]) -> Path:
    return write_whole(Path(path), "\n".join(lines) + "\n")
