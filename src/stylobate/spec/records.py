"""Descriptions of records: which files, in which unit, and what is done to them."""

import hashlib
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

from pydantic import Field

from stylobate.errors import DescriptionError, FileError, ParameterError
from stylobate.motions import Record
from stylobate.motions.records import Lengths, RecordFormat, Steps, read_record, read_records, sample_record
from stylobate.motions.records.component import split_name
from stylobate.motions.records.reading import name_of
from stylobate.spec.description import Description
from stylobate.spec.record_steps import (
    AnyStep,
    BaselineStep,
    DelayedStep,
    FilteredStep,
    InvertedStep,
    PaddedStep,
    RecordStep,
    ResampledStep,
    RotatedStep,
    ScaledStep,
    TailStep,
    TrimmedStep,
    processed,
)

_LONGEST_EVENT = 3  # two horizontal components and a vertical one


class _Reading(Description):
    units: str | None = None
    step: float | None = None
    directions: dict[str, float | str] = Field(default_factory=dict)
    lengths: Literal["trim", "pad"] = "trim"
    steps: Literal["refuse", "resample"] = "refuse"
    format: Literal["at2", "table", "csv", "waveform"] | None = None
    processing: tuple[RecordStep, ...] = ()

    def _together(self, paths: Sequence[str]) -> tuple[Record, ...]:
        return read_records(
            paths,
            self.units,
            step=self.step,
            directions=self.directions or None,
            lengths=Lengths[self.lengths.upper()],
            steps=Steps[self.steps.upper()],
            format=self._format(),
        )

    def _format(self) -> RecordFormat | None:
        return None if self.format is None else RecordFormat[self.format.upper()]


class RecordMotion(_Reading):
    """A record: the file `path`, or a list of those of one event, or the `sample` that comes with the package.

    `units`, `step`, `columns`, `axis`, `directions`, `lengths`, `steps` and `format` are arguments of `read_record` and
    `read_records`. Then come the steps of `processing`, in their order, each with the name of a method of `Record`; at
    last `scale`, `rotation` [rad] and `tail` [s of rest]. A saved result has `file_sha256` of its files, by path.
    """

    kind: Literal["record"] = "record"
    path: str | tuple[str, ...] | None = None
    sample: str | None = None
    columns: dict[str, str] | None = None
    axis: Literal["x", "y", "z"] | None = None
    scale: float | None = None
    rotation: float | None = None
    tail: float | None = None
    file_sha256: dict[str, str] = Field(default_factory=dict)

    @property
    def paths(self) -> tuple[str, ...]:
        """The files."""
        if self.path is None:
            return ()
        return (self.path,) if isinstance(self.path, str) else self.path

    def build(self) -> "DescribedRecord":
        """Return the record, which remembers this description and the SHA-256 of its files.

        Raises
        ------
        ParameterError
            If files and sample are contrary, the files are not those of one event, or one of them has changed since
            its SHA-256 was kept.
        FileError
            If a file cannot be read, or does not tell its unit where `units` is not given.
        """
        digests = self._checked_files()
        steps = (*self.processing, *self._last())
        paths = tuple(str(Path(path).absolute()) for path in self.paths)
        kept = self.model_copy(
            update={
                "path": paths[0] if isinstance(self.path, str) else paths or None,
                "file_sha256": dict(zip(paths, digests, strict=True)),
                "processing": steps,
                **dict.fromkeys(("scale", "rotation", "tail")),
            }
        )
        return DescribedRecord.of(processed(self._read(), steps), kept)

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

    def _checked_files(self) -> list[str]:
        """Return the SHA-256 of each file; a line where one is not what it was."""
        if (self.path is None) == (self.sample is None):
            message = "path (one file, or those of one event) or sample must be given, one of them"
            raise ParameterError(message)
        if self.path is not None and not 1 <= len(self.paths) <= _LONGEST_EVENT:
            message = f"path must name one to three files of one event, got {len(self.paths)}"
            raise ParameterError(message)
        digests = [self._sha256(path) for path in self.paths]
        for path, found in zip(self.paths, digests, strict=True):
            was = self.file_sha256.get(path, found)
            if was != found:
                message = (
                    f"{path} has changed since the result was saved: its SHA-256 was {was[:12]}…, is {found[:12]}…; "
                    "put the old file back, or describe the run anew"
                )
                raise ParameterError(message)
        return digests

    def _sha256(self, path: str) -> str:
        try:
            return hashlib.sha256(Path(path).read_bytes()).hexdigest()
        except OSError as error:
            remedy = "; the result was made with it: put it there or beside the result" if self.file_sha256 else ""
            message = f"cannot read {path}: {error.strerror or error}{remedy}"
            raise FileError(message) from None

    def _read(self) -> Record:
        if self.sample is not None:
            self._refuse(("units", "step", "columns", "axis", "directions", "format"), "a sample")
            return sample_record(self.sample)
        if isinstance(self.path, str) and not self.directions:
            return read_record(
                self.path, self.units, step=self.step, columns=self.columns, axis=self.axis, format=self._format()
            )
        self._refuse(("columns", "axis"), "files that are put together")
        found = self._together(self.paths)
        if len(found) > 1:
            message = f"path must name files of one event, got {', '.join(record.name for record in found)}"
            raise ParameterError(message)
        return found[0]

    def _refuse(self, names: Iterable[str], what: str) -> None:
        for name in names:
            if getattr(self, name):
                message = f"{name} does not belong to {what}; leave it out"
                raise ParameterError(message)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class DescribedRecord(Record):
    """A record that knows the `description` from which it can be built again, after processing too."""

    description: RecordMotion

    @classmethod
    def of(cls, record: Record, description: RecordMotion) -> "DescribedRecord":
        """Return `record` with its description."""
        return cls(
            samples=record.samples,
            step=record.step,
            start=record.start,
            name=record.name,
            provenance=record.provenance,
            description=description,
        )

    def _after(self, step: AnyStep, record: Record) -> "DescribedRecord":
        more = {"processing": (*self.description.processing, step)}
        return DescribedRecord.of(record, self.description.model_copy(update=more))

    def changed(self, told: str, **changes: Any) -> Record:
        """Return a record with other fields, without a description: what was done is told in words only."""
        fields = {name: getattr(self, name) for name in ("samples", "step", "start", "name")} | changes
        return Record(**fields, provenance=(*self.provenance, told))

    # Methods of slotted classes cannot say super().

    def scaled(self, factor: float, *, vertical: float | None = None) -> "DescribedRecord":  # type: ignore[override]
        """Return this record times `factor`; its vertical component times `vertical` where that is given."""
        return self._after(ScaledStep(factor=factor, vertical=vertical), Record.scaled(self, factor, vertical=vertical))

    def rotated(self, angle: float) -> "DescribedRecord":  # type: ignore[override]
        """Return this record turned by `angle` [rad] about the vertical, anticlockwise seen from above."""
        return self._after(RotatedStep(angle=angle), Record.rotated(self, angle))

    def delayed(self, delay: float) -> "DescribedRecord":  # type: ignore[override]
        """Return this record begun `delay` [s] later."""
        return self._after(DelayedStep(delay=delay), Record.delayed(self, delay))

    def inverted(self) -> "DescribedRecord":
        """Return this record with its horizontal components in the opposite sense, the vertical as it is."""
        return self._after(InvertedStep(), Record.inverted(self))

    def trimmed(self, begin: float | None = None, end: float | None = None) -> "DescribedRecord":
        """Return the samples from time `begin` to `end` [s]; the first of them comes at `start`."""
        return self._after(TrimmedStep(begin=begin, end=end), Record.trimmed(self, begin, end))

    def padded(self, *, before: float = 0.0, after: float = 0.0) -> "DescribedRecord":
        """Return this record with `before` and `after` [s] of zeros, in whole steps, none shorter than asked."""
        return self._after(PaddedStep(before=before, after=after), Record.padded(self, before=before, after=after))

    def with_tail(self, length: float) -> "DescribedRecord":
        """Return this record with `length` [s] of rest appended."""
        return self._after(TailStep(length=length), Record.with_tail(self, length))

    def resampled(self, step: float) -> "DescribedRecord":
        """Return this record at another `step` [s], band-limited (see `records.resampling`)."""
        return self._after(ResampledStep(step=step), Record.resampled(self, step))

    def filtered(
        self, *, highpass: float | None = None, lowpass: float | None = None, order: int = 4, causal: bool = False
    ) -> "DescribedRecord":
        """Return this record through a Butterworth filter with corners in Hz (see `records.filtering`)."""
        step = FilteredStep(highpass=highpass, lowpass=lowpass, order=order, causal=causal)
        found = Record.filtered(self, highpass=highpass, lowpass=lowpass, order=order, causal=causal)
        return self._after(step, found)

    def baseline_corrected(self, degree: int = 1) -> "DescribedRecord":
        """Return this record less the derivative of a polynomial fitted to its velocity (see `records.baseline`)."""
        return self._after(BaselineStep(degree=degree), Record.baseline_corrected(self, degree))


class RecordsDescription(_Reading):
    """Records for a study: those in a folder, of the files that match a pattern, or of some files.

    The components of an event are put together by `read_records`; `units`, `step`, `directions`, `lengths`, `steps`,
    `format` and `processing` are for all of them. `samples` names records that come with the package. `only` chooses
    some by name.
    """

    source: str | tuple[str, ...] = ()
    samples: tuple[str, ...] = ()
    only: tuple[str, ...] = ()

    def build(self) -> dict[str, Record]:
        """Return the records by name, in the order of their names; each can be described.

        Raises
        ------
        DescriptionError
            With one line for each event that cannot be read, and where nothing is found or two have one name.
        """
        problems: list[str] = []
        wanted = self._described(problems)
        built = [_collected(one.build, problems) for one in wanted]
        found = sorted((record for record in built if record is not None), key=lambda record: record.name)
        names = [record.name for record in found]
        problems += [
            f"records: two of them are called {name!r}" for name in sorted({n for n in names if names.count(n) > 1})
        ]
        problems += [
            f"records.only: {name!r} is none of the records; they are {', '.join(names)}"
            for name in self.only
            if name not in names and not problems
        ]
        if not (problems or found):
            problems.append("records: none were given; source is a folder, a pattern such as quakes/*.AT2, or files")
        if problems:
            raise DescriptionError(problems)
        return {record.name: record for record in found if not self.only or record.name in self.only}

    def _described(self, problems: list[str]) -> list[RecordMotion]:
        samples = [RecordMotion(sample=name, processing=self.processing) for name in self.samples]
        events = _collected(lambda: _events(_files(self.source)), problems) or []
        return [*samples, *(self._event(paths) for paths in events)]

    def _event(self, paths: Sequence[Path]) -> RecordMotion:
        names = {path.name for path in paths}
        common = self.model_dump(include=set(_Reading.model_fields), exclude={"directions", "processing"})
        own = {name: way for name, way in self.directions.items() if name in names}
        return RecordMotion(
            path=tuple(str(path) for path in paths), directions=own, processing=self.processing, **common
        )


def _collected(build: Callable[[], Any], problems: list[str]) -> Any:
    try:
        return build()
    except (ParameterError, FileError) as error:
        problems.append(str(error))
        return None


def _files(source: str | tuple[str, ...]) -> list[Path]:
    if isinstance(source, tuple):
        return [Path(path) for path in source]
    folder = Path(source)
    if folder.is_dir():
        files = [path for path in folder.iterdir() if path.is_file() and not path.name.startswith(".")]
        what = "the folder has no files"
    elif any(sign in source for sign in "*?["):
        start = Path(folder.anchor) if folder.is_absolute() else Path()
        files = list(start.glob(str(folder.relative_to(start))))
        what = "no file has such a name"
    else:
        return [folder]
    if not files:
        message = f"{source}: {what}"
        raise FileError(message)
    return sorted(files)


def _events(paths: Iterable[Path]) -> list[list[Path]]:
    """Return the files of each event together, by their names; see `read_records`."""
    events: dict[tuple[Path, str], list[Path]] = {}
    for path in paths:
        events.setdefault((path.parent, split_name(name_of(path))[0]), []).append(path)
    return list(events.values())


def anchored(values: Any, folder: Path) -> Any:
    """Return the plain values of a description with the files of its records told from `folder` on.

    Parameters
    ----------
    values
        As read from a file: tables, lists and plain values.
    folder
        Where that file lies.
    """
    if isinstance(values, list):
        return [anchored(value, folder) for value in values]
    if not isinstance(values, Mapping):
        return values
    of_files = {"path"} if values.get("kind") == "record" else set()
    found = {
        name: _from(value, folder) if name in of_files else anchored(value, folder) for name, value in values.items()
    }
    if "records" in values:
        found["records"] = _source_from(values["records"], folder)
    return found


def _source_from(records: Any, folder: Path) -> Any:
    if isinstance(records, Mapping):
        return {name: _from(value, folder) if name == "source" else value for name, value in records.items()}
    return _from(records, folder)


def _from(value: Any, folder: Path) -> Any:
    if isinstance(value, list):
        return [_from(one, folder) for one in value]
    return str(folder / value) if isinstance(value, str) else value
