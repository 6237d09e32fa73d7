"""Files that form one event: found in folders and lists, grouped by names and headers."""

import os
import re
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import takewhile
from pathlib import Path
from typing import Self, TypeVar

from stylobate.errors import FileError, ParameterError, StylobateError, UnlikelyInputWarning
from stylobate.records.directions import (
    Component,
    Direction,
    are_perpendicular,
    is_numbered,
    is_one_set,
    record_number,
    remark_of,
    split_name,
    stem_of,
)

# Other files of a download: velocities, displacements and search results.
_OTHER = re.compile(r".*\.[VD]T2|.*\.(?:VEL|DIS)\.(?:.*\.)?ASC|_SearchResults\.csv", re.IGNORECASE)


def accelerations_among(files: Iterable[Path]) -> list[Path]:
    """Return the files of a folder except files whose names denote other data than accelerations.

    The result excludes velocities, displacements and search results of a PEER download (`.VT2`, `.DT2`,
    `_SearchResults.csv`), velocities and displacements of ESM and ITACA (`….VEL.MP.ASC`, `….DIS.MP.ASC`), and hidden
    files. If nothing else remains, all files that are not hidden are returned.

    >>> names = ["RSN1_A000.AT2", "RSN1_A000.VT2", "RSN1_A000.DT2.gz", "_SearchResults.csv", ".DS_Store"]
    >>> [path.name for path in accelerations_among(map(Path, names))]
    ['RSN1_A000.AT2']
    """
    shown = [path for path in files if not path.name.startswith(".")]
    return [path for path in shown if not _OTHER.fullmatch(path.name.removesuffix(".gz"))] or shown


OnePath = str | os.PathLike[str]
RecordSource = OnePath | Iterable[OnePath | Iterable[OnePath]] | Mapping[str, OnePath | Iterable[OnePath]]
"""A folder, a pattern or a file; a list of these and of lists, each of one event; or such lists by name."""

_T = TypeVar("_T")
_SIGNS = "*?["


@dataclass(frozen=True, slots=True)
class StatedEvent:
    """Files that the user lists as one event, and the optional name of the event."""

    files: tuple[Path, ...]
    name: str | None = None


def find_files(source: RecordSource) -> tuple[list[StatedEvent], list[Path]]:
    """Find the listed events and the other files, each once.

    Raises
    ------
    FileError
        If there are no files, or a pattern or a folder has none.
    ParameterError
        If something in `source` is no path.
    """
    if isinstance(source, Mapping):
        return [StatedEvent(_all_of(files), name) for name, files in source.items()], []
    if isinstance(source, (str, os.PathLike)):
        return [], _expanded(source)
    stated: list[StatedEvent] = []
    loose: list[Path] = []
    for one in _each(source):
        if isinstance(one, (str, os.PathLike)):
            loose += _expanded(one)
        else:
            stated.append(StatedEvent(_all_of(one)))
    if not (stated or loose):
        raise FileError("no files were given")
    taken = {path.absolute() for event in stated for path in event.files}
    return stated, [path for path in dict.fromkeys(loose) if path.absolute() not in taken]


def require_path(name: str, value: object) -> Path:
    """Convert `value` to a path, or raise ParameterError."""
    if isinstance(value, (str, os.PathLike)):
        return Path(value)
    raise ParameterError(f"{name}: must be a path (got {value!r}). Give a string or a pathlib.Path.")


def is_list_of_files(source: RecordSource) -> bool:
    """Return whether a source names each of its files: no folder, no pattern."""
    if isinstance(source, (str, os.PathLike, Mapping)) or not isinstance(source, (list, tuple)):
        return False
    return all(isinstance(one, (str, os.PathLike)) and Path(one).is_file() for one in source)


def _all_of(files: OnePath | Iterable[OnePath]) -> tuple[Path, ...]:
    each = [files] if isinstance(files, (str, os.PathLike)) else _each(files)
    found = tuple(path for one in each for path in _expanded(one))
    if not found:
        raise FileError("no files were given for an event")
    return found


def _each(source: Iterable[_T]) -> Iterable[_T]:
    if isinstance(source, Iterable):
        return source
    raise ParameterError(
        f'source: must be a path, or lists of the files of each event (got {source!r}). Give such as "quakes".'
    )


def _expanded(source: OnePath) -> list[Path]:
    """Return the sorted acceleration files of a folder or pattern; any other path unchanged."""
    path = require_path("source", source)
    if path.is_dir():
        return _in_folder(path)
    if path.exists() or not any(sign in str(path) for sign in _SIGNS):
        return [path]
    start = Path(path.anchor) if path.is_absolute() else Path()
    found = sorted(accelerations_among(one for one in start.glob(str(path.relative_to(start))) if one.is_file()))
    if not found:
        raise FileError(f"{source}: no file has such a name")
    return found


def _in_folder(folder: Path) -> list[Path]:
    """Return the acceleration files of a folder."""
    files = sorted(accelerations_among(path for path in folder.iterdir() if path.is_file()))
    if not files:
        raise FileError(f"{folder}: the folder has no files")
    return files


_LONGEST = 3
# Maximum length of a common part of names that is too short for a name.
_SHORTEST_NAME = 3
_DATE = re.compile(r"\d{1,4}[-/.]\d{1,2}[-/.]\d{1,4}|\b(?:19|20)\d\d\b")

Read = Callable[[Path], Component]


@dataclass(frozen=True, slots=True)
class EventFile:
    """A file of an event: its component or reading error, and the data in its name and header.

    Parameters
    ----------
    path
        The file.
    content
        The component, or the error raised while reading.
    event
        The name without format and direction.
    direction
        The direction from the user, otherwise from the header or the name; None if unknown.
    number
        Number of the record in a PEER database.
    title
        Event, date and station in the header; empty if missing.
    remark
        Suffix of the name that marks a processed copy, such as "_scaled".
    guessed
        Whether only three digits at the end of the name state the direction; the digits may be a serial number.
    """

    path: Path
    content: Component | StylobateError
    event: str
    direction: Direction | None
    number: int | None
    title: str
    remark: str = ""
    guessed: bool = False

    @classmethod
    def of(cls, path: Path, read: Read, given: Direction | None) -> Self:
        """Describe a file by its name and header and by the component that `read` returns."""
        stem = stem_of(path)
        number = record_number(stem)
        try:
            content: Component | StylobateError = read(path)
        except StylobateError as error:
            content = error
        header = content.direction if isinstance(content, Component) else None
        title = _title(content.title) if isinstance(content, Component) else ""
        event, named = _named(path, stem, header)
        if isinstance(content, Component) and content.samples.ndim > 1:  # x, y and z in one file
            return cls(path, content, stem, None, None, "")
        guessed = not (given or header) and number is None and named is not None and is_numbered(stem)
        return cls(path, content, event, given or header or named, number, title, remark_of(stem), guessed)

    def among_others(self) -> "EventFile":
        """Return this file as one of several of one event: a weak sign in its name suffices for its direction."""
        event, direction = split_name(stem_of(self.path), unsure=True)
        return self if self.direction or not direction else replace(self, event=event, direction=direction)

    @property
    def key(self) -> tuple[object, ...]:
        """Key that all files of one event share: number and suffix, otherwise title and name, or folder and name."""
        if self.number is not None:
            return ("number", self.number, self.remark)
        return ("title", self.title, self.event) if self.title else ("name", self.path.parent, self.event)


@dataclass(frozen=True, slots=True)
class EventFiles:
    """Files of one event, and the name of the event; `stated` if the user lists the files together."""

    name: str
    files: tuple[EventFile, ...]
    stated: bool = False

    @property
    def paths(self) -> tuple[Path, ...]:
        """Paths of the files."""
        return tuple(file.path for file in self.files)

    @classmethod
    def of(cls, files: Sequence[EventFile], name: str | None = None, *, stated: bool = False) -> Self:
        """Return the event of these files, named by the common part of their names."""
        if len(files) > 1:
            files = [file.among_others() for file in files]
        elif files[0].guessed:
            files = [replace(files[0], event=stem_of(files[0].path), direction=None)]
        return cls(name or _name([file.event for file in files]), tuple(files), stated)


def find_events(
    source: RecordSource, read: Read, directions: Mapping[str, float | str] | None = None
) -> tuple[EventFiles, ...]:
    """Group files into events.

    Parameters
    ----------
    source
        Folders, patterns, files; lists of the files of one event.
    read
        Function that reads the component of a file.
    directions
        Directions by file name: azimuth [degrees], "up", or another name of a direction.

    Returns
    -------
    tuple
        Events in the order of their names. Listed files are joined if the user lists them as one event or states all
        directions. The others are joined by record number, in one folder or under one title; else by event, date and
        station in the headers; else by folder. In the last two cases the names differ by the direction only. A
        processed copy, such as `_scaled`, is not joined with an original.

    Raises
    ------
    FileError
        If there are no files. Errors in a file are raised when the event is assembled.
    ParameterError
        If `directions` names no file.

    Warns
    -----
    UnlikelyInputWarning
        If only the digits at the end of two names, such as 000 and 090, show that the files belong together.
    """
    stated, loose = find_files(source)
    if not isinstance(directions, Mapping | None):
        raise ParameterError(
            f'directions: must be by name of a file (got {directions!r}). Give such as {{"q_1.csv": 90.0}}.'
        )
    given = {name: Direction.of(direction) for name, direction in (directions or {}).items()}
    names = {path.name for path in [*loose, *(path for event in stated for path in event.files)]}
    if unknown := given.keys() - names:
        raise ParameterError(f"directions must name files that are read, got {', '.join(sorted(unknown))}")

    def files_of(paths: Iterable[Path]) -> list[EventFile]:
        return [EventFile.of(path, read, given.get(path.name)) for path in paths]

    events = [EventFiles.of(files_of(event.files), event.name, stated=True) for event in stated]
    if not stated and is_list_of_files(source) and _are_one_event(loose, given):
        events.append(EventFiles.of(files_of(loose), stated=True))
    else:
        events += [EventFiles.of(files) for files in _grouped(files_of(loose))]
    return tuple(sorted(events, key=lambda event: event.name))


def _are_one_event(paths: Sequence[Path], given: Mapping[str, Direction]) -> bool:
    """Return whether the stated directions of files fit one event."""
    ways = [given[path.name] for path in paths if path.name in given]
    return 1 < len(paths) <= _LONGEST and len(ways) == len(paths) and is_one_set(ways)


def _grouped(files: Iterable[EventFile]) -> Iterable[list[EventFile]]:
    for group in _by(lambda file: file.key, files):
        places = _by(lambda file: file.path.parent, group)
        titles = {file.title for file in group}
        # the same number in two databases: only headers with one title join files across folders
        apart = places if len(titles) > 1 or "" in titles else [group]
        for one in apart:
            for copy in _copies([file.among_others() for file in one] if len(one) > 1 else one):
                yield from _confirmed(copy)


def _by(sign: Callable[[EventFile], object], files: Iterable[EventFile]) -> list[list[EventFile]]:
    """Group the files by a key, in the order of first appearance."""
    groups: dict[object, list[EventFile]] = {}
    for file in files:
        groups.setdefault(sign(file), []).append(file)
    return list(groups.values())


def _confirmed(group: list[EventFile]) -> Iterable[list[EventFile]]:
    """Yield a group; if only digits join it, a perpendicular pair with a warning, and other files separately."""
    if len(group) == 1 or not all(file.guessed for file in group):
        return [group]
    ways = [file.direction for file in group if file.direction]
    if len(group) > 2 or not are_perpendicular(*ways):  # noqa: PLR2004
        return [[file] for file in group]
    names = " and ".join(f"{file.path.name} ({file.direction})" for file in group)
    message = (
        f"{group[0].event}: two files are joined only because the numbers in their names look like perpendicular "
        f"azimuths (got {names}). State their directions, or list the files of each event together"
    )
    warnings.warn(message, UnlikelyInputWarning, stacklevel=2)
    return [group]


def _copies(group: list[EventFile]) -> Iterable[list[EventFile]]:
    """Yield a group; if it holds copies of one set, in other folders or with other names, each set."""
    for copies in (_by(lambda file: file.path.parent, group), _by(lambda file: file.event, group)):
        ways = {tuple(sorted(str(file.direction) for file in copy)) for copy in copies}
        if len(copies) > 1 and len(ways) == 1 and all(file.direction for file in group):
            return [found for copy in copies for found in _copies(copy)]
    return [group]


def _named(path: Path, stem: str, header: Direction | None) -> tuple[str, Direction | None]:
    """Return event and direction of a name; if the header contradicts, the ending is no direction."""
    if (whole := Direction.parse(stem)) and not stem[0].isdigit():  # NS.txt, in a folder of the event
        return path.absolute().parent.name or stem, whole
    event, named = split_name(stem)
    if named is None and header is not None:
        event, named = split_name(stem, unsure=True)
    if named is not None and header is not None and not named.agrees_with(header):
        return stem, None
    return event, named


def _title(header: str) -> str:
    """Return event, date and station of a title such as "Loma Prieta, 10/18/1989, Corralitos, 90"."""
    title, _, component = header.rpartition(",")
    if Direction.parse(component) is None or not _DATE.search(title):
        return ""
    return " ".join(title.casefold().split())


def _name(events: Sequence[str]) -> str:
    alike = takewhile(lambda letters: len(set(letters)) == 1, zip(*events, strict=False))
    common = "".join(letters[0] for letters in alike).rstrip("-_. ")
    return events[0] if len(set(events)) == 1 or len(common) < _SHORTEST_NAME else common
