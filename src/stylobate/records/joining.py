"""Records from the files of an event: two horizontal components and a vertical one, and the samples of the package."""

import re
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from functools import cache
from importlib.resources import as_file, files
from pathlib import Path

import numpy as np

from stylobate.base_motions.record import Record, RecordOrigin
from stylobate.base_motions.signal_processing import energy
from stylobate.errors import FileError, ParameterError, StylobateError, UnlikelyInputWarning
from stylobate.records.directions import Component, Directed, Direction, along_axes
from stylobate.records.events import EventFile, EventFiles, find_events
from stylobate.records.reading import FileReading, RecordFormat, as_record, read_parts
from stylobate.records.sources import OnePath, RecordSource, require_path
from stylobate.text import did_you_mean

_SAME_STEP = 1e-9
# Lost fraction of the Arias intensity that triggers a warning; the tail of a record is usually below.
_REMARKABLE = 0.01


class Lengths(Enum):
    """Handling of components of unequal length."""

    TRIM = "all end with the shortest"
    PAD = "the shorter ones go on with zeros"


class Steps(Enum):
    """Handling of components of unequal time step."""

    REFUSE = "an error"
    RESAMPLE = "all are resampled to the finest step"


@dataclass(frozen=True, slots=True)
class _Part:
    path: Path
    direction: Direction | None
    record: Record  # along x, in the sense of its direction; or of all axes, if its file has several


def read_record(
    path: OnePath,
    units: str | None = None,
    *,
    step: float | None = None,
    columns: Mapping[str, str] | None = None,
    axis: str | None = None,
    format: RecordFormat | None = None,  # noqa: A002  the word of the field
    response: OnePath | None = None,
) -> Record:
    """Read a record from one file.

    Parameters
    ----------
    path
        The file; gzip is unpacked. A file in an archive, a sheet of a workbook or a channel of a waveform file has a
        path below it: `quakes.zip/CLS000.AT2`, `book.xlsx/Sheet1`, `event.mseed/IU.ANMO.00.HNE`.
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
    response
        StationXML, which converts the counts of a waveform file to accelerations and states the directions of its
        channels.

    Raises
    ------
    FileError
        If the file is missing, empty, cut short, holds something that is not a number, unequal steps, a gap, or several
        records, or does not state its unit; with the number of the line.
    ParameterError
        If units are unknown or contradict the file.
    UnsupportedError
        If only ObsPy or openpyxl reads the format and it is not installed.

    Warns
    -----
    UnlikelyInputWarning
        If the peak exceeds 3 g, for example because a file in cm/s² is read in g. If a file that states no unit of time
        has steps of more than 0.5 s or lasts more than 2 h, for example because its times are in ms.
    """
    path, how = require_path("path", path), FileReading.of(step, columns, format, response)
    parts = read_parts(path, how)
    if len(parts) == 1 and parts[0].event is None:
        content = parts[0].content
        if isinstance(content, StylobateError):
            raise content
        record = as_record(content, parts[0].path, units, axis)
    else:
        record = _only_event(path, how, units, axis)
    origin = RecordOrigin.of_files(path, axis=axis, one_component=True, units=units, **how.plain)
    return replace(record, origin=origin)


def _only_event(path: Path, how: FileReading, units: str | None, axis: str | None) -> Record:
    """Return the record of the only event in a file of several components."""
    events = find_events(path, lambda one: read_parts(one, how))
    if len(events) > 1:
        names = ", ".join(event.name for event in events)
        remedy = f"Read them by read_records, or name a part, such as {events[0].paths[0]}"
        raise FileError(f"{path}: the file must hold one record, got {len(events)}: {names}. {remedy}")
    if axis is not None:
        raise ParameterError(f"axis must be left out for a file of several components, got {axis!r}")
    return join_event(events[0], units)


def read_records(
    source: RecordSource,
    units: str | None = None,
    *,
    step: float | None = None,
    columns: Mapping[str, str] | None = None,
    directions: Mapping[str, float | str] | None = None,
    lengths: Lengths = Lengths.TRIM,
    steps: Steps = Steps.REFUSE,
    format: RecordFormat | None = None,  # noqa: A002  the word of the field
    response: OnePath | None = None,
    one_component: bool = False,
) -> tuple[Record, ...]:
    """Read records and join the components of each event.

    Files are joined by the first rule that applies: the user lists them as one event; they have one PEER record number
    (`RSN143_…`) and one folder or one title in their headers; their headers name one event, date and station and their
    names differ by the direction only; they are in one folder and their names differ by the direction only: `CLS000`,
    `CLS090`, `CLS-UP`; `site_NS`, `site_EW`; `TAB-L1`, `TAB-T1`; `q_HNE`, `q_HNN`. In a file of channels, those of one
    station and instrument are one event. The direction of a component comes
    from `directions`, else from the header, else from the name. Files with a suffix such as `_scaled` are not joined
    with files without it.

    Parameters
    ----------
    source
        A folder, a pattern such as `quakes/*.AT2`, or a file; or a list of these. A list in this list, or each value of
        a mapping from names, holds the files of one event. A folder or an archive stands for all its files, except
        hidden files, files whose names denote velocities, displacements or the search results of a PEER download, and
        files that hold no record, which a warning lists.
    units, step, columns, format, response
        As in `read_record`, for all files.
    directions
        Directions by file name with suffix: the azimuth, clockwise from north [degrees], "up", "down", or another name
        of a direction, such as "N10E" or "L". Two or three listed files with given directions that fit together are one
        event.
    lengths
        Treatment of components of different lengths.
    steps
        Whether components of different steps are resampled.
    one_component
        Whether single components are intended; otherwise a warning is issued.

    Returns
    -------
    tuple
        Records in the order of their names.

    Raises
    ------
    FileError
        If a file is wrong, or the components of an event cannot be joined.
    ParameterError
        If `directions` names no file that is read.

    Warns
    -----
    UnlikelyInputWarning
        If a record has one horizontal component, only a vertical component, or no acceleration, unless
        `one_component`; if files are listed as one event but their headers name several; if two files are joined only
        because the numbers at the end of their names look like perpendicular azimuths; if trimming to the shortest
        component removes more than 1 % of the Arias intensity of a component.

    Notes
    -----
    Azimuths run clockwise seen from above, x to y anticlockwise. x points along the lower azimuth θ1 of two, y 90°
    anticlockwise from x, z up. With Δ = θ2 − θ1 the components a1 and a2 give::

        x = a1,    y = (a1 cos Δ − a2)/sin Δ

    so that azimuths 0° and 90° make x point north and y west; 90° and 360° make x point east and y north. Perpendicular
    components of unknown azimuth (L and T, H1 and H2, X and Y) are x and y, in this order. A single horizontal
    component acts along x.
    """
    how = FileReading.of(step, columns, format, response)
    reading = {
        "one_component": True,
        "lengths": lengths.name.lower(),
        "steps": steps.name.lower(),
        "units": units,
        **how.plain,
    }
    records = []
    for event in find_events(source, lambda path: read_parts(path, how), directions):
        record = join_event(event, units, lengths, steps)
        stated = {path.name: directions[path.name] for path in event.paths if directions and path.name in directions}
        name = event.name if isinstance(source, Mapping) else None
        origin = RecordOrigin.of_files(event.paths, name=name, directions=stated or None, **reading)
        records.append(replace(record, origin=origin))
    for record in () if one_component else records:
        remark_on_missing_components(record)
    return tuple(records)


def join_event(
    event: EventFiles, units: str | None = None, lengths: Lengths = Lengths.TRIM, steps: Steps = Steps.REFUSE
) -> Record:
    """Join the components of an event into one record.

    Raises
    ------
    FileError
        If a file is wrong, or its direction is unknown, or the components do not fit together.
    """
    _require_one_title(event)
    files = sorted(event.files, key=_order)
    parts = [_part(file, units) for file in files]
    if len(parts) == 1 and parts[0].direction is None:
        return replace(parts[0].record, name=event.name)
    for file, part in zip(files, parts, strict=True):
        if part.direction is None:
            if isinstance(file.content, Component) and file.content.samples.ndim > 1:
                raise FileError(f"{part.path}: it has the components of an event already. List it alone")
            raise FileError(
                f"{part.path}: its direction is unknown. State directions, its azimuth in degrees or up, or end its "
                "name with it, such as _NS, _090 or _UP"
            )
    records, notes = _alike(event.name, parts, lengths, steps)
    directed = [
        Directed(part.path.name, part.direction, record.samples[:, 0])
        for part, record in zip(parts, records, strict=True)
        if part.direction is not None
    ]
    axes, origin = along_axes(event.name, directed)
    provenance = (*(line for record in records for line in record.provenance), *notes, origin)
    first = records[0]
    return Record.from_components(**axes, step=first.step, start=first.start, name=event.name, provenance=provenance)


def remark_on_missing_components(record: Record) -> None:
    """Issue an UnlikelyInputWarning for a record without acceleration or without two horizontal components."""
    flat = [axis for axis in record.axes if axis != "z"]
    if len(flat) > 1:
        return
    files = ", ".join(re.findall(r"read from (.*?), in ", "\n".join(record.provenance))) or "no file"
    if not record.axes:
        message = f"{record.name}: all accelerations are zero ({files}). Check the files"
    else:
        what = "one horizontal component" if flat else "a vertical component and no horizontal one"
        message = (
            f"{record.name}: {what} ({files}). List the files of the event together, or set one_component if one is "
            "meant"
        )
    warnings.warn(message, UnlikelyInputWarning, stacklevel=3)


def _order(file: EventFile) -> tuple[bool, float, str]:
    """Return the sort key of a file of an event: azimuths, x before y, the vertical last."""
    way = file.direction or Direction()
    return way.vertical != 0, way.azimuth or 0.0, way.axis or ""


def _part(file: EventFile, units: str | None) -> _Part:
    if isinstance(file.content, StylobateError):
        raise file.content
    if file.content.samples.ndim > 1:
        return _Part(file.path, None, as_record(file.content, file.path, units, None))
    record = as_record(replace(file.content, direction=None), file.path, units, "x")
    return _Part(file.path, file.direction, record)


def _require_one_title(event: EventFiles) -> None:
    """Raise FileError if headers name several events; warn if the user lists such files as one."""
    titles = {file.title: file.path.name for file in event.files if file.title}
    if len(titles) < 2:  # noqa: PLR2004
        return
    headers = ", ".join(f"{name} ({title})" for title, name in titles.items())
    message = (
        f"{event.name}: the headers name different events or stations: {headers}. List the files of each event together"
    )
    if not event.stated:
        raise FileError(message)
    warnings.warn(message, UnlikelyInputWarning, stacklevel=3)


def _alike(event: str, parts: list[_Part], lengths: Lengths, steps: Steps) -> tuple[list[Record], list[str]]:
    """Convert the records of the parts to one step, start and length; return them and log lines."""
    records = [part.record for part in parts]
    finest = min(record.step for record in records)
    if any(abs(record.step / finest - 1.0) > _SAME_STEP for record in records):
        if steps is Steps.REFUSE:
            listed = ", ".join(f"{part.path.name} {part.record.step:g} s" for part in parts)
            raise FileError(f"{event}: time steps differ ({listed}); state steps to be resampled, or make them alike")
        records = [record.resampled(finest) for record in records]
    if len({record.start for record in records}) > 1:
        listed = ", ".join(f"{part.path.name} {part.record.start:g} s" for part in parts)
        raise FileError(f"{event}: components begin at different times ({listed}); trim or pad them one by one")
    counts = [len(record.samples) for record in records]
    if len(set(counts)) == 1:
        return records, []
    target = min(counts) if lengths is Lengths.TRIM else max(counts)
    listed = ", ".join(f"{part.path.name} {count}" for part, count in zip(parts, counts, strict=True))
    notes = [f"{'trimmed' if lengths is Lengths.TRIM else 'padded with zeros'} to {target} samples: {listed}"]
    if lengths is Lengths.TRIM:
        warn_of_lost_shaking(event, [part.path.name for part in parts], records, target)
    fitted = [
        np.pad(record.samples[:target], ((0, max(0, target - len(record.samples))), (0, 0))) for record in records
    ]
    return [replace(record, samples=samples) for record, samples in zip(records, fitted, strict=True)], notes


def lost_intensity(record: Record, kept: int) -> float:
    """Return the fraction of the Arias intensity after the first `kept` samples, over all components."""
    grown = energy(record.samples, record.step).sum(axis=1)
    return float(1.0 - grown[kept - 1] / grown[-1]) if grown[-1] > 0.0 else 0.0


def warn_of_lost_shaking(event: str, names: Sequence[str], records: Sequence[Record], kept: int) -> None:
    """Issue an UnlikelyInputWarning for each component that loses more than 1 % of its Arias intensity.

    Parameters
    ----------
    event
        Name of the event.
    names
        Names of the files, one per record.
    records
        The components, with one time step.
    kept
        Number of kept samples.
    """
    for name, record in zip(names, records, strict=True):
        if (lost := lost_intensity(record, kept)) > _REMARKABLE:
            message = (
                f"{event}: {name} is trimmed from {record.step * (len(record.samples) - 1):g} s to "
                f"{record.step * (kept - 1):g} s and loses {100.0 * lost:.3g} % of its Arias intensity. Set lengths to "
                "pad, or check that the files are of one event"
            )
            warnings.warn(message, UnlikelyInputWarning, stacklevel=2)


_FILES = ("elcentro_1940_NS.dat.gz", "elcentro_1940_EW.dat.gz", "elcentro_1940_UP.dat.gz")
_SOURCE = (
    "Imperial Valley earthquake, 18 May 1940, El Centro terminal substation, corrected data (vibrationdata.com, "
    "after the U.S. strong-motion archives; public domain)"
)
_EL_CENTRO, _WITHOUT_DRIFT = "el centro 1940", "el centro 1940 corrected"
# Rest before and after [s] for the transients of the filter; corner [Hz] and order of the filter.
_REST, _CORNER, _ORDER = 20.0, 0.1, 2


def sample_names() -> tuple[str, ...]:
    """Return the names of the sample records of the package."""
    return _EL_CENTRO, _WITHOUT_DRIFT


def sample_record(name: str = "el centro 1940") -> Record:
    """Load a sample record of the package.

    Parameters
    ----------
    name
        "el centro 1940": the three components of the Imperial Valley earthquake of 18 May 1940 at El Centro, x north,
        y west, z up, 53.46 s at 0.02 s. "el centro 1940 corrected": the same without its drift, between 20 s of rest.

    Raises
    ------
    ParameterError
        If the name is unknown.

    Notes
    -----
    Several digitizations of this record exist. The peaks of this version are 0.3487 g (north-south), 0.2141 g
    (east-west) and 0.2101 g (up); textbooks use another version with 0.319 g.

    The published record drifts: integration moves the ground by 6.3 m along y and leaves a velocity of 0.11 m/s. The
    drift does not affect the column, but PGV, PGD and figures. The corrected record is the published record after
    `padded(before=20.0, after=20.0).filtered(highpass=0.1, order=2)`; its peak accelerations differ by less than 0.5 %.

    Examples
    --------
    >>> sample_record("el centro 1940")
    Record('el centro 1940', 2674 samples every 0.02 s, x y z, peak 3.42 m/s², ...)
    """
    key = " ".join(name.lower().split()) if isinstance(name, str) else name
    if key not in sample_names():
        question = did_you_mean(str(key), sample_names())
        message = f"name must be one of {', '.join(map(repr, sample_names()))}, got {name!r}"
        message += f"; {question}" if question else ""
        raise ParameterError(message)
    return _read(key)


@cache
def _read(key: str) -> Record:
    folder = files("stylobate.records") / "data"
    with as_file(folder) as here:
        (record,) = read_records([here / file for file in _FILES], units="g")
    record = replace(record, name=key, provenance=(_SOURCE, *record.provenance))
    if key == _WITHOUT_DRIFT:
        record = record.padded(before=_REST, after=_REST).filtered(highpass=_CORNER, order=_ORDER)
    return replace(record, origin=RecordOrigin({"sample": key}))
