"""Sources of records: folders, patterns, files, and lists of the files of one event."""

import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

from stylobate.base_motions.records.selection import accelerations_among
from stylobate.errors import FileError, ParameterError

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
        message = "no files were given"
        raise FileError(message)
    taken = {path.absolute() for event in stated for path in event.files}
    return stated, [path for path in dict.fromkeys(loose) if path.absolute() not in taken]


def require_path(name: str, value: object) -> Path:
    """Convert `value` to a path, or raise ParameterError."""
    if isinstance(value, (str, os.PathLike)):
        return Path(value)
    message = f"{name}: must be a path (got {value!r}). Give a string or a pathlib.Path."
    raise ParameterError(message)


def is_list_of_files(source: RecordSource) -> bool:
    """Return whether a source names each of its files: no folder, no pattern."""
    if isinstance(source, (str, os.PathLike, Mapping)) or not isinstance(source, (list, tuple)):
        return False
    return all(isinstance(one, (str, os.PathLike)) and Path(one).is_file() for one in source)


def _all_of(files: OnePath | Iterable[OnePath]) -> tuple[Path, ...]:
    each = [files] if isinstance(files, (str, os.PathLike)) else _each(files)
    found = tuple(path for one in each for path in _expanded(one))
    if not found:
        message = "no files were given for an event"
        raise FileError(message)
    return found


def _each(source: Iterable[_T]) -> Iterable[_T]:
    if isinstance(source, Iterable):
        return source
    message = f'source: must be a path, or lists of the files of each event (got {source!r}). Give such as "quakes".'
    raise ParameterError(message)


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
        message = f"{source}: no file has such a name"
        raise FileError(message)
    return found


def _in_folder(folder: Path) -> list[Path]:
    """Return the acceleration files of a folder."""
    files = sorted(accelerations_among(path for path in folder.iterdir() if path.is_file()))
    if not files:
        message = f"{folder}: the folder has no files"
        raise FileError(message)
    return files
