"""Files of one event put together: two horizontal components and a vertical one."""

import math
import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from enum import Enum
from pathlib import Path

import numpy as np

from stylobate.errors import FileError, ParameterError, require_positive
from stylobate.motions.records.component import Direction, split_name
from stylobate.motions.records.reading import RecordFormat, as_record, name_of, read_component
from stylobate.motions.records.record import Floats, Record

# Horizontal components nearer to one line than this cannot be told apart.
_LEAST_SINE = 0.5
_SAME_STEP = 1e-9


class Lengths(Enum):
    """What becomes of components that differ in length."""

    TRIM = "all end with the shortest"
    PAD = "the shorter ones go on with zeros"


class Steps(Enum):
    """What becomes of components that differ in their time step."""

    REFUSE = "an error"
    RESAMPLE = "all are resampled to the finest step"


@dataclass(frozen=True, slots=True)
class _Part:
    path: Path
    event: str
    direction: Direction | None
    record: Record  # along x, in the sense of its direction


def read_records(
    source: str | os.PathLike[str] | Iterable[str | os.PathLike[str]],
    units: str | None = None,
    *,
    step: float | None = None,
    directions: Mapping[str, float | str] | None = None,
    lengths: Lengths = Lengths.TRIM,
    steps: Steps = Steps.REFUSE,
    format: RecordFormat | None = None,  # noqa: A002  the word of the field
) -> tuple[Record, ...]:
    """Return the records in a folder or in some files, the components of each event put together.

    Files belong together if their names differ in the component only: `RSN753_LOMAP_CLS000.AT2`,
    `RSN753_LOMAP_CLS090.AT2`, `RSN753_LOMAP_CLS-UP.AT2`; `site_NS.dat`, `site_EW.dat`, `site_UP.dat`. Which way a
    component points is told by `directions`, else by the file, else by its name.

    Parameters
    ----------
    source
        A folder, of which all files are read that are not hidden, or paths, such as `folder.glob("*.AT2")` of a folder
        that holds velocities and displacements too.
    units, step, format
        As in `read_record`, of all files.
    directions
        By name of a file, with its ending: the azimuth, clockwise from north [degrees], or "up" or "down".
    lengths
        What becomes of components of different lengths.
    steps
        What becomes of components of different steps.

    Returns
    -------
    tuple
        Records in the order of their names.

    Raises
    ------
    FileError
        If a file is wrong, or the components of an event cannot be put together.
    ParameterError
        If `directions` names no file that is read.

    Notes
    -----
    Azimuths run clockwise seen from above, x to y anticlockwise. x points along the lower azimuth θ1 of two, y 90°
    anticlockwise from it, z up. With Δ = θ2 − θ1 the components a1 and a2 give::

        x = a1,    y = (a1 cos Δ − a2)/sin Δ

    so that azimuths 0° and 90° make x point north and y west; 90° and 360° make x point east and y north. A single
    horizontal component acts along x.
    """
    paths = _paths(source)
    given = {name: Direction.of(direction) for name, direction in (directions or {}).items()}
    if unknown := given.keys() - {path.name for path in paths}:
        message = f"directions must name files that are read, got {', '.join(sorted(unknown))}"
        raise ParameterError(message)
    step = None if step is None else require_positive("step", step, "s")
    events: dict[str, list[_Part]] = {}
    for path in paths:
        part = _part(path, units, step, given.get(path.name), format)
        events.setdefault(part.event, []).append(part)
    return tuple(_together(event, parts, lengths, steps) for event, parts in sorted(events.items()))


def _paths(source: str | os.PathLike[str] | Iterable[str | os.PathLike[str]]) -> list[Path]:
    if not isinstance(source, (str, os.PathLike)):
        paths = [Path(path) for path in source]
        if not paths:
            message = "no files were given"
            raise FileError(message)
        return paths
    folder = Path(source)
    if not folder.is_dir():
        return [folder]
    paths = sorted(path for path in folder.iterdir() if path.is_file() and not path.name.startswith("."))
    if not paths:
        message = f"{folder}: the folder has no files"
        raise FileError(message)
    return paths


def _part(
    path: Path,
    units: str | None,
    step: float | None,
    given: Direction | None,
    format: RecordFormat | None,  # noqa: A002
) -> _Part:
    component = read_component(path, step, None, format)
    event, named = split_name(name_of(path))
    direction = given or component.direction or named
    if component.samples.ndim > 1:  # x, y and z in one file
        return _Part(path, name_of(path), None, as_record(component, path, units, None))
    return _Part(path, event, direction, as_record(replace(component, direction=None), path, units, "x"))


def _together(event: str, parts: list[_Part], lengths: Lengths, steps: Steps) -> Record:
    if len(parts) == 1 and parts[0].direction is None:
        return replace(parts[0].record, name=event)
    for part in parts:
        if part.direction is None:
            message = (
                f"{part.path}: which way it points is not told: state directions, its azimuth in degrees or up, or end "
                "its name with that, such as _NS, _090 or _UP"
            )
            raise FileError(message)
    up = [part for part in parts if part.direction is not None and part.direction.vertical]
    flat = sorted((part for part in parts if part not in up), key=_azimuth)
    if len(up) > 1 or len(flat) > 2:  # noqa: PLR2004
        all_of_it = ", ".join(f"{part.path.name} ({part.direction})" for part in parts)
        message = f"{event}: two horizontal components and a vertical one at most, got {all_of_it}"
        raise FileError(message)
    records, notes = _alike(event, [*flat, *up], lengths, steps)
    axes, told = _axes(event, flat, records[: len(flat)])
    if up:
        assert up[0].direction is not None
        axes["z"] = up[0].direction.vertical * records[-1].samples[:, 0]
        told.append(f"z up, from {up[0].path.name} ({up[0].direction})")
    provenance = (*(line for record in records for line in record.provenance), *notes, "; ".join(told))
    first = records[0]
    return Record.from_components(**axes, step=first.step, start=first.start, name=event, provenance=provenance)


def _azimuth(part: _Part) -> float:
    assert part.direction is not None
    assert part.direction.azimuth is not None
    return part.direction.azimuth


def _axes(event: str, flat: list[_Part], records: list[Record]) -> tuple[dict[str, Floats], list[str]]:
    if not flat:
        return {}, []
    first = records[0].samples[:, 0]
    told = [f"x at azimuth {_azimuth(flat[0]):g}°, from {flat[0].path.name}"]
    if len(flat) == 1:
        return {"x": first}, told
    turn = math.radians(_azimuth(flat[1]) - _azimuth(flat[0]))
    if abs(math.sin(turn)) < _LEAST_SINE:
        message = f"{event}: horizontal components must stand across, got {' and '.join(p.path.name for p in flat)}"
        raise FileError(message)
    # right angles exactly: cos 90° is not to mix 1e-17 of one component into the other
    across = abs(math.cos(turn)) < 1e-12  # noqa: PLR2004
    cos, sin = (0.0, math.copysign(1.0, math.sin(turn))) if across else (math.cos(turn), math.sin(turn))
    told.append(f"y at azimuth {(_azimuth(flat[0]) - 90.0) % 360.0:g}°, from {flat[1].path.name} ({flat[1].direction})")
    return {"x": first, "y": (first * cos - records[1].samples[:, 0]) / sin}, told


def _alike(event: str, parts: list[_Part], lengths: Lengths, steps: Steps) -> tuple[list[Record], list[str]]:
    """Return the records of the parts with one step, start and length, and what was done for it."""
    records = [part.record for part in parts]
    finest = min(record.step for record in records)
    if any(abs(record.step / finest - 1.0) > _SAME_STEP for record in records):
        if steps is Steps.REFUSE:
            told = ", ".join(f"{part.path.name} {part.record.step:g} s" for part in parts)
            message = f"{event}: time steps differ ({told}); state steps to be resampled, or make them alike"
            raise FileError(message)
        records = [record.resampled(finest) for record in records]
    if len({record.start for record in records}) > 1:
        told = ", ".join(f"{part.path.name} {part.record.start:g} s" for part in parts)
        message = f"{event}: components begin at different times ({told}); trim or pad them one by one"
        raise FileError(message)
    counts = [len(record.samples) for record in records]
    if len(set(counts)) == 1:
        return records, []
    target = min(counts) if lengths is Lengths.TRIM else max(counts)
    told = ", ".join(f"{part.path.name} {count}" for part, count in zip(parts, counts, strict=True))
    notes = [f"{'trimmed' if lengths is Lengths.TRIM else 'padded with zeros'} to {target} samples: {told}"]
    fitted = [
        np.pad(record.samples[:target], ((0, max(0, target - len(record.samples))), (0, 0))) for record in records
    ]
    return [replace(record, samples=samples) for record, samples in zip(records, fitted, strict=True)], notes
