"""Describe the records of a study: folders, patterns, files, and files of one event."""

from collections.abc import Callable, Iterable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from pydantic import Field

from stylobate.base_motions import Record
from stylobate.config.description import Config
from stylobate.config.records import Reading, RecordMotion
from stylobate.errors import ConfigError, FileError, ParameterError
from stylobate.records.events import EventFiles
from stylobate.records.sources import find_files


class EventConfig(Config):
    """Files of one event.

    Parameters
    ----------
    files
        Paths or patterns of the files of one event.
    directions
        Direction of each file, in the same order or by its name: an azimuth [degrees] or a name such as "up".
    name
        Name of the record.
    scale
        Factor of the record.
    """

    files: str | tuple[str, ...]
    directions: dict[str, float | str] | tuple[float | str, ...] = ()
    name: str | None = None
    scale: float | None = None


class RecordsConfig(Reading):
    """Records for a study: those in a folder, of the files that match a pattern, or of a list of these.

    The components of an event are joined as in `read_records`.

    Parameters
    ----------
    source
        Folder, pattern such as `quakes/*.AT2`, file, or a list of these.
    event
        Files of one event, if their names do not show it; a list of tables.
    samples
        Names of records that come with the package.
    only
        Names of the records to use; all by default.
    directions
        Direction of a file, by its name: an azimuth [degrees] or a name such as "up".
    """

    source: str | tuple[str, ...] = ()
    event: tuple[EventConfig, ...] = ()
    samples: tuple[str, ...] = ()
    only: tuple[str, ...] = ()
    directions: dict[str, float | str] = Field(default_factory=dict)

    def build(self) -> dict[str, Record]:
        """Read the records, sorted by name; each keeps its description.

        Raises
        ------
        ConfigError
            With one line for each event that cannot be read; if no record is found, or two have one name.
        """
        problems: list[str] = []
        built = [_collected(build, problems) for build in self._builders(problems)]
        found = sorted((record for record in built if record is not None), key=lambda record: record.name)
        names = [record.name for record in found]
        problems += [
            f"records: two of them are called {name!r}" for name in sorted({n for n in names if names.count(n) > 1})
        ]
        problems += [
            f"records.only: no record has this name (got {name!r}). Choose from {', '.join(names)}"
            for name in self.only
            if name not in names and not problems
        ]
        if not (problems or found):
            problems.append("records: none were given; source is a folder, a pattern such as quakes/*.AT2, or files")
        if problems:
            raise ConfigError(problems)
        return {record.name: record for record in found if not self.only or record.name in self.only}

    def _builders(self, problems: list[str]) -> list[Callable[[], Record]]:
        """Return a function for each record that builds it; add a line to `problems` for files that are not found."""
        samples = [RecordMotion(sample=name, processing=self.processing).build for name in self.samples]
        files = [(one, _collected(partial(_files_of, one), problems)) for one in self.event]
        listed = [(one, paths) for one, paths in files if paths]
        stated = [partial(self._stated, one, paths) for one, paths in listed]
        events = partial(self._events, [paths for _, paths in listed])
        found = _collected(events, problems) if self.source else ()
        return [*samples, *stated, *(partial(self._found, event) for event in found or ())]

    def _events(self, listed: Sequence[tuple[Path, ...]]) -> list[EventFiles]:
        """Return the events in `source` without those that are listed."""
        source = (self.source,) if isinstance(self.source, str) else self.source
        events = self.find((*source, *listed), self.directions)
        return [event for event in events if event.paths not in listed]

    def _stated(self, event: EventConfig, paths: tuple[Path, ...]) -> Record:
        directions = event.directions or self._own(paths)
        return self._motion(paths, name=event.name, directions=directions, scale=event.scale).build()

    def _found(self, event: EventFiles) -> Record:
        record = self.join(event)
        return self._motion(event.paths, directions=self._own(event.paths)).describe(record)

    def _own(self, paths: Iterable[Path]) -> dict[str, float | str] | tuple[()]:
        names = {path.name for path in paths}
        return {name: way for name, way in self.directions.items() if name in names} or ()

    def _motion(self, paths: Iterable[Path], **more: Any) -> RecordMotion:
        common = {name: getattr(self, name) for name in Reading.model_fields}
        return RecordMotion(path=tuple(str(path) for path in paths), **common, **more)


def _files_of(event: EventConfig) -> tuple[Path, ...]:
    return find_files([event.files if isinstance(event.files, tuple) else (event.files,)]).stated[0].files


def _collected(build: Callable[[], Any], problems: list[str]) -> Any:
    try:
        return build()
    except (ParameterError, FileError) as error:
        problems.append(str(error))
        return None
