"""Grouping of record files into events."""

import re
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import takewhile
from pathlib import Path
from typing import Self

from stylobate.base_motions.records.axes import are_perpendicular, is_one_set
from stylobate.base_motions.records.component import Component, Direction
from stylobate.base_motions.records.naming import is_numbered, record_number, remark_of, split_name, stem_of
from stylobate.base_motions.records.sources import RecordSource, find_files, is_list_of_files
from stylobate.errors import ParameterError, StylobateError, UnlikelyInputWarning

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
class Event:
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
) -> tuple[Event, ...]:
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
        message = f'directions: must be by name of a file (got {directions!r}). Give such as {{"q_1.csv": 90.0}}.'
        raise ParameterError(message)
    given = {name: Direction.of(direction) for name, direction in (directions or {}).items()}
    names = {path.name for path in [*loose, *(path for event in stated for path in event.files)]}
    if unknown := given.keys() - names:
        message = f"directions must name files that are read, got {', '.join(sorted(unknown))}"
        raise ParameterError(message)

    def files_of(paths: Iterable[Path]) -> list[EventFile]:
        return [EventFile.of(path, read, given.get(path.name)) for path in paths]

    events = [Event.of(files_of(event.files), event.name, stated=True) for event in stated]
    if not stated and is_list_of_files(source) and _are_one_event(loose, given):
        events.append(Event.of(files_of(loose), stated=True))
    else:
        events += [Event.of(files) for files in _grouped(files_of(loose))]
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
