"""Where records come from: folders, patterns, files, and lists of the files of one event."""

import os
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

from stylobate.errors import FileError, ParameterError
from stylobate.files import file_of

# Other files of a download: velocities, displacements and search results.
_OTHER = re.compile(r".*\.[VD]T2|.*\.(?:VEL|DIS)\.(?:.*\.)?(?:ASC|V2c?)|_SearchResults\.csv", re.IGNORECASE)


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


@dataclass(frozen=True, slots=True)
class Sources:
    """Files of records: those of listed events, and the others, of which some are named and some found in folders."""

    stated: tuple[StatedEvent, ...] = ()
    loose: tuple[Path, ...] = ()
    found: frozenset[Path] = frozenset()


def find_files(source: RecordSource) -> Sources:
    """Find the listed events and the other files, each once.

    Raises
    ------
    FileError
        If there are no files, or a pattern or a folder has none.
    ParameterError
        If something in `source` is no path.
    """
    if isinstance(source, Mapping):
        return Sources(tuple(StatedEvent(_all_of(files), name) for name, files in source.items()))
    stated: list[StatedEvent] = []
    loose: list[Path] = []
    found: set[Path] = set()
    for one in [source] if isinstance(source, (str, os.PathLike)) else _each(source):
        if isinstance(one, (str, os.PathLike)):
            paths = _expanded(one)
            loose += paths
            found |= {path for path in paths if path != Path(one)}
        else:
            stated.append(StatedEvent(_all_of(one)))
    if not (stated or loose):
        raise FileError("no files were given")
    taken = {path.absolute() for event in stated for path in event.files}
    rest = tuple(path for path in dict.fromkeys(loose) if path.absolute() not in taken)
    return Sources(tuple(stated), rest, frozenset(found))


def require_path(name: str, value: object) -> Path:
    """Convert `value` to a path, or raise ParameterError."""
    if isinstance(value, (str, os.PathLike)):
        return Path(value)
    raise ParameterError(f"{name}: must be a path (got {value!r}). Give a string or a pathlib.Path.")


def is_list_of_files(source: RecordSource) -> bool:
    """Return whether a source names each of its files: no folder, no pattern."""
    if isinstance(source, (str, os.PathLike, Mapping)) or not isinstance(source, (list, tuple)):
        return False
    return all(isinstance(one, (str, os.PathLike)) and file_of(one).is_file() for one in source)


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
