"""What files of records hold: the components, in their formats; conversion to SI units, and writing."""

import os
import warnings
import zlib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from pathlib import Path
from typing import Any

import numpy as np

from stylobate.base_motions.record import AXES, Record
from stylobate.base_motions.signal_processing import Floats
from stylobate.column.numbers import STANDARD_GRAVITY
from stylobate.errors import FileError, ParameterError, StylobateError, UnlikelyInputWarning, require_positive
from stylobate.files import file_of, write_whole
from stylobate.records.agencies import (
    Channel,
    is_cosmos,
    is_csmip,
    is_geonet,
    read_cosmos,
    read_csmip,
    read_geonet,
)
from stylobate.records.containers import is_container, members
from stylobate.records.contents import (
    Allowance,
    NoRecordError,
    as_utf8,
    is_binary,
    read_bytes,
    require_readable,
    unpacked,
)
from stylobate.records.databases import is_asc, is_at2, is_wrapped, read_asc, read_at2
from stylobate.records.directions import Component, is_one_set, stem_of
from stylobate.records.sources import accelerations_among, require_path
from stylobate.records.tables import TextTable, has_rows_of_numbers, read_named_columns, read_table
from stylobate.records.text_files import KNOWN, REMARKS, Text, in_si, require_unit
from stylobate.records.waveforms import read_waveform, waveform_format

# Horizontal and vertical peaks of earthquakes are below, except a few close to the fault [g].
_LARGEST_PEAK = 3.0
# Longest step and duration of an accelerogram that are likely [s].
_LONGEST_STEP, _LONGEST_DURATION = 0.5, 7200.0
# Range of steps of readable records [s], and a bound on accelerations in any unit.
_STEPS = (1e-9, 1e6)
_BEYOND_ALL = 1e30
# Parts of a file that a message names.
_LISTED = 12


class RecordFormat(Enum):
    """Format of a record file."""

    AT2 = "PEER AT2"
    ASC = "ESM and ITACA ASC, with the header of DYNA 1.x"
    COSMOS = "COSMOS, version 1.20"
    CSMIP = "CSMIP, volumes 1 and 2"
    GEONET = "GeoNet, volumes 1 and 2"
    TABLE = "one column of accelerations, or time and up to three accelerations"
    CSV = "named columns"
    WAVEFORM = "a format of waveforms: miniSEED, SAC, K-NET and KiK-net, GSE, SLIST, TSPAIR, Kinemetrics EVT"


@dataclass(frozen=True, slots=True)
class FileReading:
    """Arguments by which files are read, as of `read_records`."""

    step: float | None = None
    columns: Mapping[str, str] | None = None
    format: RecordFormat | None = None
    response: str | None = None

    @classmethod
    def of(
        cls,
        step: float | None,
        columns: Mapping[str, str] | None,
        format: RecordFormat | None,  # noqa: A002
        response: str | os.PathLike[str] | None,
    ) -> "FileReading":
        """Check the arguments.

        Raises
        ------
        ParameterError
            If the step is not positive.
        """
        step = None if step is None else require_positive("step", step, "s")
        return cls(step, columns, format, None if response is None else str(require_path("response", response)))

    @property
    def plain(self) -> dict[str, Any]:
        """The arguments as plain values for the origin of a record."""
        return {
            "step": self.step,
            "columns": None if self.columns is None else dict(self.columns),
            "format": None if self.format is None else self.format.name.lower(),
            "response": self.response,
        }


@dataclass(frozen=True, slots=True)
class Part:
    """A component in a file, or the error raised while it was read.

    Parameters
    ----------
    path
        The file; in a file of several components, a path below it, as in `quakes.zip/CLS000.AT2`.
    content
        The component, or the error.
    event
        Name of the record to which it belongs, if the file states it: the components of a station are one record.
    found
        Whether the part was found in an archive and not named.
    """

    path: Path
    content: Component | StylobateError
    event: str | None = None
    found: bool = False


def read_parts(path: Path, how: FileReading) -> list[Part]:
    """Read the components in a file, in the units of the file; archives and files of stations have several.

    Parameters
    ----------
    path
        The file, or a part of it, such as `quakes.zip/CLS000.AT2` or `event.mseed/IU.ANMO.00.HNE`.
    how
        Arguments of the reading.

    Raises
    ------
    FileError
        If the file cannot be read, or has no such part.
    """
    file = file_of(path)
    allowance = Allowance()
    parts = list(_parts(file, read_bytes(file, allowance), how, path, allowance))
    named = [part for part in parts if part.path == path or path in part.path.parents]
    if not named:
        raise _no_part(path, file, [part.path for part in parts])
    return named


def _no_part(wanted: Path, file: Path, parts: Sequence[Path]) -> FileError:
    names = [part.relative_to(file).as_posix() for part in parts[:_LISTED]]
    listed = ", ".join(names) + f" and {len(parts) - _LISTED} more" * (len(parts) > _LISTED)
    return FileError(f"{wanted}: {file.name} has no such part. It has {listed or 'nothing to read'}")


def _parts(path: Path, content: bytes, how: FileReading, wanted: Path, allowance: Allowance) -> Iterator[Part]:
    """Yield the parts of a file; of an archive, those that contain `wanted` or lie below it."""
    content = as_utf8(content)
    if is_container(content):

        def chosen(paths: Iterable[Path]) -> list[Path]:
            listed = accelerations_among(paths)
            found = [one for one in listed if one == wanted or _share_a_line(one, wanted)]
            if not found:
                raise _no_part(wanted, path, listed)
            return found

        for place, packed in members(path, content, chosen, allowance):
            try:
                inner = unpacked(place, packed, allowance)
                yield from (
                    replace(part, found=part.path != wanted) for part in _parts(place, inner, how, wanted, allowance)
                )
            except (StylobateError, OSError, EOFError, zlib.error) as error:
                fault = error if isinstance(error, StylobateError) else FileError(f"{place}: cannot be read: {error}")
                yield Part(place, fault, found=place != wanted)
        return
    channels = _channels(path, content, how)
    if isinstance(channels, Component):
        yield Part(path, channels)
    elif len(channels) == 1:
        yield Part(path, channels[0].component)
    else:
        events = _events(path, channels)
        yield from (Part(path / one.name, one.component, event) for one, event in zip(channels, events, strict=True))


def _share_a_line(one: Path, other: Path) -> bool:
    return one in other.parents or other in one.parents


def _events(path: Path, channels: Sequence[Channel]) -> list[str]:
    """Return the name of the record of each channel: those of a station are one, unless it has many instruments."""
    stem = stem_of(path) + (" uncorrected" if path.suffix.lower() in _UNCORRECTED else "")
    stations: dict[str, list[Channel]] = {}
    for one in channels:
        stations.setdefault(one.station, []).append(one)
    names = []
    for one in channels:
        station = stations[one.station]
        name = stem if len(stations) == 1 else f"{stem} {one.station}"
        ways = [other.component.direction for other in station]
        known = [way for way in ways if way is not None]
        names.append(name if len(known) == len(ways) and is_one_set(known) else f"{name} {one.name}")
    return names


_UNCORRECTED = (".v1", ".v1a", ".raw")


def _channels(path: Path, content: bytes, how: FileReading) -> Component | list[Channel]:
    """Read the component of a file, or its channels."""
    require_readable(path, content)
    if is_binary(content) and how.format in (None, RecordFormat.AT2) and _is_called_at2(path):
        raise FileError(f"{path}: no AT2 file: it is no text, and has no header with NPTS and DT. Download it again")
    if how.format is RecordFormat.WAVEFORM or (how.format is None and (is_binary(content) or waveform_format(content))):
        return read_waveform(path, content, None if how.response is None else Path(how.response))
    if is_binary(content):
        remedy = "Leave format out, or export the record as text"
        raise FileError(f"{path}: a binary file, not {how.format.value if how.format else 'text'}. {remedy}")
    text = Text.of(path, content)
    for agency, (is_its, read) in _AGENCIES.items():
        if how.format is agency or (how.format is None and is_its(text)):
            return read(text)
    return _read_text(text, how)


_AGENCIES: Mapping[RecordFormat, tuple[Callable[[Text], bool], Callable[[Text], list[Channel]]]] = {
    RecordFormat.COSMOS: (is_cosmos, read_cosmos),
    RecordFormat.CSMIP: (is_csmip, read_csmip),
    RecordFormat.GEONET: (is_geonet, read_geonet),
}


def _read_text(text: Text, how: FileReading) -> Component:
    if all(not line.strip() or line.lstrip().startswith(REMARKS[0]) for line in text.lines):
        raise text.fault(len(text.lines) - 1, "the file has no numbers. Export it again", NoRecordError)
    without_header = _is_called_at2(text.path) and is_wrapped(text)
    if how.format is RecordFormat.AT2 or (how.format is None and (is_at2(text) or without_header)):
        return read_at2(text, how.step)
    if how.format is RecordFormat.ASC or (how.format is None and is_asc(text)):
        return read_asc(text)
    try:
        table = TextTable.of(text, named=how.columns is not None)
        if how.format is RecordFormat.CSV or (how.format is None and table.names is not None):
            return read_named_columns(table, how.columns, how.step)
        return read_table(table, how.step)
    except FileError as error:
        if how.format is None and not has_rows_of_numbers(text):
            raise NoRecordError(str(error)) from None
        raise


def _is_called_at2(path: Path) -> bool:
    return path.name.lower().removesuffix(".gz").endswith(".at2")


def as_record(component: Component, path: Path, units: str | None, axis: str | None) -> Record:
    """Convert the component of a file to a record in SI units."""
    factor, unit_text = _scale(component, path, units)
    _require_possible(component, path)
    provenance: tuple[str, ...] = (
        f"read from {shown_name(path)}, {unit_text}" + (f": {component.title}" if component.title else ""),
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


def shown_name(path: Path) -> str:
    """Return the name of a file, or of a part of a file with the name of the file before it."""
    return path.relative_to(file_of(path).parent).as_posix()


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
