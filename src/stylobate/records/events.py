"""Files that form one event: grouped by lists, names and headers."""

import re
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import takewhile
from pathlib import Path
from typing import Self

from stylobate.errors import ParameterError, StylobateError, UnlikelyInputWarning
from stylobate.records.contents import NoRecordError
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
from stylobate.records.reading import Part
from stylobate.records.sources import RecordSource, find_files, is_list_of_files

_LONGEST = 3
# Maximum length of a common part of names that is too short for a name.
_SHORTEST_NAME = 3
_DATE = re.compile(r"\d{1,4}[-/.]\d{1,2}[-/.]\d{1,4}|\b(?:19|20)\d\d\b")

Read = Callable[[Path], Sequence[Part]]


@dataclass(frozen=True, slots=True)
class EventFile:
    """A file of an event, or a part of a file: its component or reading error, and the data in its name and header.

    Parameters
    ----------
    path
        The file, or the part of a file.
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
    of_station
        Whether the file states the event: a file of the channels of stations.
    """

    path: Path
    content: Component | StylobateError
    event: str
    direction: Direction | None
    number: int | None
    title: str
    remark: str = ""
    guessed: bool = False
    of_station: bool = False

    @classmethod
    def of(cls, part: Part, given: Direction | None) -> Self:
        """Describe a part of a file by its name and its content."""
        path, content = part.path, part.content
        if part.event is not None and isinstance(content, Component):
            return cls(path, content, part.event, given or content.direction, None, "", of_station=True)
        stem = stem_of(path)
        number = record_number(stem)
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
        return (
            self
            if self.direction or self.of_station or not direction
            else replace(self, event=event, direction=direction)
        )

    @property
    def key(self) -> tuple[object, ...]:
        """Key that all files of one event share: number and suffix, otherwise title and name, or folder and name."""
        if self.of_station:
            return ("station", self.path.parent, self.event)
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
        Function that reads the components of a file.
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
        If only the digits at the end of two names, such as 000 and 090, show that the files belong together. If files
        in a folder or an archive hold no record: they are left out.
    """
    sources = find_files(source)
    if not isinstance(directions, Mapping | None):
        raise ParameterError(
            f'directions: must be by name of a file (got {directions!r}). Give such as {{"q_1.csv": 90.0}}.'
        )
    given = {name: Direction.of(direction) for name, direction in (directions or {}).items()}
    listed = [(_parts_of(event.files, read), event.name) for event in sources.stated]
    loose = _with_records(_parts_of(sources.loose, read), sources.found)
    if unknown := given.keys() - {
        part.path.name for parts in (*(parts for parts, _ in listed), loose) for part in parts
    }:
        raise ParameterError(f"directions must name files that are read, got {', '.join(sorted(unknown))}")

    def files_of(parts: Iterable[Part]) -> list[EventFile]:
        return [EventFile.of(part, given.get(part.path.name)) for part in parts]

    events = [EventFiles.of(files_of(parts), name, stated=True) for parts, name in listed]
    if not listed and is_list_of_files(source) and _are_one_event([part.path for part in loose], given):
        events.append(EventFiles.of(files_of(loose), stated=True))
    else:
        events += [EventFiles.of(files) for files in _grouped(files_of(loose))]
    return tuple(sorted(events, key=lambda event: event.name))


def _parts_of(paths: Iterable[Path], read: Read) -> list[Part]:
    """Return the parts of files; an error of a file stands for its parts."""
    parts: list[Part] = []
    for path in paths:
        try:
            parts += read(path)
        except StylobateError as error:
            parts.append(Part(path, error))
    return parts


def _with_records(parts: Sequence[Part], found: Iterable[Path]) -> list[Part]:
    """Return the parts without those that were found beside the others and hold no record; a warning lists these.

    Raises
    ------
    NoRecordError
        If no part holds a record.
    """
    folder = {*found}
    others = [part for part in parts if (part.found or part.path in folder) and isinstance(part.content, NoRecordError)]
    if not others:
        return [*parts]
    if len(others) == len(parts):
        assert isinstance(others[0].content, NoRecordError)
        raise others[0].content
    names = ", ".join(part.path.name for part in others)
    several = len(others) > 1
    message = (
        f"{others[0].path.parent}: {len(others)} {'files hold' if several else 'file holds'} no record and "
        f"{'are' if several else 'is'} left out: {names}"
    )
    warnings.warn(message, UnlikelyInputWarning, stacklevel=3)
    return [part for part in parts if part not in others]


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
