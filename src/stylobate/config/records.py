"""Records in descriptions: their files, the steps of their processing, and the motion that they describe."""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, cast

from pydantic import Field

from stylobate.base_motions import Record
from stylobate.base_motions.record import RecordOrigin
from stylobate.config.description import Config, Hertz, MetresPerSquareSecond, Radians, Seconds
from stylobate.config.profile_table import is_table
from stylobate.errors import FileError, ParameterError
from stylobate.files import file_of, sha256_of

if TYPE_CHECKING:
    from stylobate.records import RecordFormat
    from stylobate.records.events import EventFiles
    from stylobate.records.sources import RecordSource


def relocated(values: Any, folder: Path) -> Any:
    """Return the plain values of a saved result with the new paths of missing record files.

    The search uses the name of the file and the last parts of its old path, below `folder` and the folders above it. A
    file must have the SHA-256 of the file with which the result was made.

    Parameters
    ----------
    values
        Values of a provenance or a description: tables, lists and plain values.
    folder
        Folder of the result.
    """
    if isinstance(values, list):
        return [relocated(value, folder) for value in values]
    if not isinstance(values, Mapping):
        return values
    digests = values.get("file_sha256")
    if values.get("kind") != "record" or not isinstance(digests, Mapping):
        return {name: relocated(value, folder) for name, value in values.items()}
    places = {path: _place(path, digest, folder) for path, digest in digests.items()}
    path = values.get("path")
    moved = [_moved(one, places) for one in path] if isinstance(path, list) else _moved(path, places)
    return {**values, "path": moved, "file_sha256": {places[name]: digest for name, digest in digests.items()}}


def _moved(path: Any, places: Mapping[str, str]) -> Any:
    """Return the new path of a file, or of a part of a file."""
    for old, new in places.items():
        if path == old or str(path).startswith((f"{old}/", f"{old}\\")):
            return new + str(path)[len(old) :]
    return path


def _place(path: str, digest: str, folder: Path) -> str:
    """Return the present path of a file; its old path if it is there, or if it is not found."""
    old = Path(path)
    if old.is_file():
        return path
    here = folder.absolute()
    for above in (here, *here.parents):
        for count in range(1, len(old.parts)):
            found = above.joinpath(*old.parts[-count:])
            if found.is_file() and sha256_of(found) == digest:
                return str(found)
    return path


class _Step(Config):
    def apply(self, record: Record) -> Record:
        """Apply the method of `Record` with the name of this step."""
        values = self.model_dump(exclude_none=True)
        return cast("Record", getattr(record, values.pop("method"))(**values))


class ScaledStep(_Step):
    """Scale by `factor`; the vertical component by `vertical`, if given."""

    method: Literal["scaled"] = "scaled"
    factor: float
    vertical: float | None = None


class ScaledToStep(_Step):
    """Scale to the peak horizontal acceleration `peak` [m/s²]."""

    method: Literal["scaled_to"]
    peak: MetresPerSquareSecond


class RotatedStep(_Step):
    """Rotate by `angle` [rad] about the vertical, anticlockwise seen from above."""

    method: Literal["rotated"] = "rotated"
    angle: Radians


class DelayedStep(_Step):
    """Delay by `delay` [s]."""

    method: Literal["delayed"] = "delayed"
    delay: Seconds


class InvertedStep(_Step):
    """Reverse the horizontal components."""

    method: Literal["inverted"] = "inverted"


class TrimmedStep(_Step):
    """Keep the samples from `begin` to `end` [s]."""

    method: Literal["trimmed"] = "trimmed"
    begin: Seconds | None = None
    end: Seconds | None = None


class PaddedStep(_Step):
    """Add zeros `before` and `after` [s]."""

    method: Literal["padded"] = "padded"
    before: Seconds = 0.0
    after: Seconds = 0.0


class TailStep(_Step):
    """Add a tail of zeros of this `length` [s]."""

    method: Literal["with_tail"] = "with_tail"
    length: Seconds


class ResampledStep(_Step):
    """Resample to another time `step` [s]."""

    method: Literal["resampled"] = "resampled"
    step: Seconds


class FilteredStep(_Step):
    """Apply a Butterworth filter with corners `highpass` and `lowpass` [Hz]."""

    method: Literal["filtered"] = "filtered"
    highpass: Hertz | None = None
    lowpass: Hertz | None = None
    order: int = 4
    causal: bool = False


class FloorStep(_Step):
    """Take the motion of a floor of natural `period` [s] and `damping` ratio on this ground."""

    method: Literal["floor_motion"] = "floor_motion"
    period: Seconds
    damping: float = 0.05


class BaselineStep(_Step):
    """Subtract the derivative of a polynomial of this `degree` fitted to the velocity."""

    method: Literal["baseline_corrected"] = "baseline_corrected"
    degree: int = 1


AnyStep = (
    ScaledStep
    | ScaledToStep
    | RotatedStep
    | DelayedStep
    | InvertedStep
    | TrimmedStep
    | PaddedStep
    | TailStep
    | ResampledStep
    | FilteredStep
    | FloorStep
    | BaselineStep
)

RecordStep = Annotated[AnyStep, Field(discriminator="method")]


def processed(record: Record, steps: Iterable[AnyStep]) -> Record:
    """Apply these steps to the record in order."""
    for step in steps:
        record = step.apply(record)
    return record


_LAST = ("scale", "rotation", "tail")
_LONGEST_EVENT = 3  # two horizontal components and a vertical one


class Reading(Config):
    """Arguments of `read_records`, and processing: shared by `RecordMotion` and `RecordsConfig`.

    Parameters
    ----------
    units
        Unit of files that do not state it: "g", "m/s2" or "cm/s2".
    step
        Time step of files that do not state it [s].
    columns
        Component of each column of a table, by the name of the column.
    lengths
        Handling of components of unequal length.
    steps
        Handling of components of unequal time step.
    format
        Format of the files; detected by default.
    response
        StationXML that converts counts of waveform files to accelerations.
    one_component
        Whether to accept records of one component without a warning.
    processing
        Steps of processing in their order: tables with the `method` of `Record` and its arguments.
    """

    units: str | None = None
    step: Seconds | None = None
    columns: dict[str, str] | None = None
    lengths: Literal["trim", "pad"] = "trim"
    steps: Literal["refuse", "resample"] = "refuse"
    format: Literal["at2", "asc", "cosmos", "csmip", "geonet", "table", "csv", "waveform"] | None = None
    response: str | None = None
    one_component: bool = False
    processing: tuple[RecordStep, ...] = ()

    def find(self, source: "RecordSource", directions: Mapping[str, float | str]) -> "tuple[EventFiles, ...]":
        """Return the events in these files; see `find_events`."""
        from stylobate.records.events import find_events
        from stylobate.records.reading import FileReading, read_parts

        how = FileReading.of(self.step, self.columns, self._format(), self.response)
        return find_events(source, lambda path: read_parts(path, how), directions)

    def join(self, event: "EventFiles") -> Record:
        """Return the record of an event; see `join_event`."""
        from stylobate.records.joining import Lengths, Steps, join_event

        return join_event(event, self.units, Lengths[self.lengths.upper()], Steps[self.steps.upper()])

    def _format(self) -> "RecordFormat | None":
        from stylobate.records import RecordFormat

        return None if self.format is None else RecordFormat[self.format.upper()]


class RecordMotion(Reading):
    """A record from files of one event, or a record that comes with the package.

    The steps of `processing` come first, then `scale`, `rotation` and `tail`. A saved result also holds
    `file_sha256`, the SHA-256 of each file by its path.

    Parameters
    ----------
    path
        File of the record, or a list of the files of one event. Give `path` or `sample`.
    sample
        Name of a record that comes with the package, such as "el centro 1940".
    name
        Name of the record; from the files by default.
    directions
        Direction of each file: by its name, or a list in the order of the files.
    axis
        Axis of a file of one component.
    scale
        Factor of the record.
    rotation
        Rotation of the record about the vertical [rad].
    tail
        Free-vibration time after the record [s].
    """

    make: ClassVar = Record

    kind: Literal["record"] = "record"
    path: str | tuple[str, ...] | None = None
    sample: str | None = None
    name: str | None = None
    directions: dict[str, float | str] | tuple[float | str, ...] = ()
    axis: Literal["x", "y", "z"] | None = None
    scale: float | None = None
    rotation: Radians | None = None
    tail: Seconds | None = None
    file_sha256: dict[str, str] = Field(default_factory=dict)

    @property
    def paths(self) -> tuple[str, ...]:
        """The files."""
        if self.path is None:
            return ()
        return (self.path,) if isinstance(self.path, str) else self.path

    def build(self) -> Record:
        """Read the record; its origin has this description and the SHA-256 of its files.

        Raises
        ------
        ParameterError
            If both or neither of path and sample are given, the files are not those of one event, or a file has
            changed since its SHA-256 was saved.
        FileError
            If a file cannot be read, or neither the file nor `units` states a unit.
        """
        self._checked_files()
        return self.describe(self._read())

    def describe(self, record: Record) -> Record:
        """Process the `record` that was read from the files, and state its origin.

        Warns
        -----
        UnlikelyInputWarning
            If the record lacks a component, unless `one_component` is true, or an axis or columns of one file are
            chosen.
        """
        from stylobate.records.joining import remark_on_missing_components

        if not (self.one_component or self.axis or (self.columns and isinstance(self.path, str))):
            remark_on_missing_components(record)
        steps = (*self.processing, *self._last())
        reading = self.model_dump(exclude_defaults=True, exclude={"path", "file_sha256", "processing", *_LAST})
        if self.path is None:
            origin = RecordOrigin(reading)
        else:
            paths = [Path(path) for path in self.paths]
            origin = RecordOrigin.of_files(paths[0] if isinstance(self.path, str) else paths, **reading)
        done = replace(origin, processing=tuple(step.values() for step in steps))
        return replace(processed(record, steps), origin=done)

    def _last(self) -> list[AnyStep]:
        """Return scale, rotation and tail as steps."""
        last: list[AnyStep] = []
        if self.scale is not None:
            last.append(ScaledStep(factor=self.scale))
        if self.rotation is not None:
            last.append(RotatedStep(angle=self.rotation))
        if self.tail is not None:
            last.append(TailStep(length=self.tail))
        return last

    def _checked_files(self) -> None:
        """Raise ParameterError if no files are named, or a file has changed."""
        if (self.path is None) == (self.sample is None):
            raise ParameterError("either path (one file, or the files of one event) or sample must be given")
        if self.path is not None and not 1 <= len(self.paths) <= _LONGEST_EVENT:
            raise ParameterError(f"path must name one to three files of one event, got {len(self.paths)}")
        for path in dict.fromkeys(str(file_of(path)) for path in self.paths):
            found = self._sha256(path)
            was = self.file_sha256.get(path, found)
            if was != found:
                raise ParameterError(
                    f"{path} has changed since the result was saved: its SHA-256 was {was[:12]}…, is {found[:12]}…; "
                    "put the old file back, or describe the run again"
                )

    def _sha256(self, path: str) -> str:
        try:
            return sha256_of(path)
        except OSError as error:
            remedy = "; the result was made with it: put it there or beside the result" if self.file_sha256 else ""
            raise FileError(f"cannot read {path}: {error.strerror or error}{remedy}") from None

    def _read(self) -> Record:
        from stylobate.records import read_record, sample_record

        if self.sample is not None:
            self._refuse(("units", "step", "columns", "axis", "directions", "format", "name"), "a sample")
            return sample_record(self.sample)
        if isinstance(self.path, str) and not (self.directions or self.name):
            return read_record(
                self.path,
                self.units,
                step=self.step,
                columns=self.columns,
                axis=self.axis,
                format=self._format(),
                response=self.response,
            )
        self._refuse(("axis",), "files that are joined")
        (event,) = self.find({self.name: self.paths} if self.name else [self.paths], self._directions())
        return self.join(event)

    def _directions(self) -> Mapping[str, float | str]:
        if isinstance(self.directions, dict):
            return self.directions
        if self.directions and len(self.directions) != len(self.paths):
            raise ParameterError(
                f"directions: one for each file is needed (got {len(self.directions)} for {len(self.paths)} files). "
                'List azimuths [degrees] or names such as "up", in the order of the files'
            )
        return {Path(path).name: way for path, way in zip(self.paths, self.directions, strict=False)}

    def _refuse(self, names: Iterable[str], what: str) -> None:
        for name in names:
            if getattr(self, name):
                raise ParameterError(f"{name} does not belong to {what}; leave it out")


def anchored(values: Any, folder: Path) -> Any:
    """Make the paths of records, hazard curves, profiles and tables in plain values relative to `folder`.

    Parameters
    ----------
    values
        Values from a file: tables, lists and plain values.
    folder
        Folder of that file.
    """
    if isinstance(values, list):
        return [anchored(value, folder) for value in values]
    if not isinstance(values, Mapping):
        return values
    of_files = {"path", "response"} if values.get("kind") == "record" else set()
    found = {
        name: _from(value, folder) if name in of_files else anchored(value, folder) for name, value in values.items()
    }
    if isinstance(profile := values.get("profile"), str) and is_table(profile):
        found["profile"] = _from(profile, folder)
    if "records" in values:
        found["records"] = _source_from(values["records"], folder)
    for name in ("objects", "columns"):  # a table of objects
        if isinstance(values.get(name), str):
            found[name] = _from(values[name], folder)
    for name in ("design_spectrum", "hazard"):
        if isinstance(values.get(name), Mapping):
            found[name] = _file_from(values[name], "file", folder)
    return found


def _source_from(records: Any, folder: Path) -> Any:
    if not isinstance(records, Mapping):
        return _from(records, folder)
    found = {name: _from(value, folder) if name in ("source", "response") else value for name, value in records.items()}
    if isinstance(events := records.get("event"), list):
        found["event"] = [_source_of_event(one, folder) for one in events]
    return found


def _source_of_event(event: Any, folder: Path) -> Any:
    return {**event, "files": _from(event.get("files"), folder)} if isinstance(event, Mapping) else event


def _file_from(values: Any, key: str, folder: Path) -> Any:
    if isinstance(values, Mapping):
        return {name: _from(value, folder) if name == key else value for name, value in values.items()}
    return _from(values, folder)


def _from(value: Any, folder: Path) -> Any:
    if isinstance(value, list):
        return [_from(one, folder) for one in value]
    return str(folder / value) if isinstance(value, str) else value
