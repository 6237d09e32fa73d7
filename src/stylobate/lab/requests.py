"""Requests: JSON objects of limited size, descriptions without files of this machine, and uploaded records."""

import base64
import binascii
import gzip
import hashlib
import io
import json
import shutil
import zlib
from collections import OrderedDict
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from math import isnan, prod
from pathlib import Path, PurePosixPath, PureWindowsPath
from typing import Annotated, Any, NoReturn

from pydantic import AfterValidator, BaseModel, BeforeValidator, Field, ValidationError, WithJsonSchema
from starlette.requests import ClientDisconnect, Request

from stylobate import config, studies
from stylobate.config.description import Config
from stylobate.config.study import study_of
from stylobate.errors import LARGEST, SMALLEST
from stylobate.lab.limits import Limits, RefusedError
from stylobate.records.containers import is_container
from stylobate.units import size_of, split


async def json_body(request: Request, limit: int) -> dict[str, Any]:
    """Return the JSON object in the body of `request`, at most `limit` bytes long.

    Raises
    ------
    RefusedError
        If the body has another type, is too large, is not JSON, or is not an object.
    """
    kind = request.headers.get("content-type", "").partition(";")[0].strip().lower()
    if kind != "application/json":
        raise RefusedError(415, [f"content-type must be application/json, got {kind or 'none'}"])
    body = bytearray()
    try:
        async for part in request.stream():
            body += part
            if len(body) > limit:
                raise RefusedError(413, [f"a request may have at most {limit} bytes"])
        found = json.loads(body, parse_constant=_refuse_constant)
    except ClientDisconnect:
        raise RefusedError(400, ["the body ended early"]) from None
    except (ValueError, RecursionError) as error:
        raise RefusedError(400, [f"the body is not JSON: {error}"]) from None
    if not isinstance(found, dict):
        raise RefusedError(422, [f"the body must be a JSON object, got {type(found).__name__}"])
    return found


def _refuse_constant(name: str) -> NoReturn:
    raise ValueError(f"{name} is not a JSON number")


# Uploaded records: files in a folder of the laboratory, identified by their digest

_LONGEST_NAME = 120
_GZIP = b"\x1f\x8b"
_PIECE = 1 << 16


def _plain_name(name: str) -> str:
    """Return the name of a file if it is valid on any system, without a folder."""
    alone = PurePosixPath(name).name == name == PureWindowsPath(name).name
    short = 0 < len(name.encode(errors="replace")) <= _LONGEST_NAME
    if alone and short and name.isprintable() and name[0] != ".":
        return name
    raise ValueError(f"must be the name of a file without a folder (got {name!r})")


def _decoded(content: object) -> bytes:
    if not isinstance(content, str):
        raise ValueError("must be the file in base64")  # noqa: TRY004  pydantic reports it
    try:
        return base64.b64decode(content, validate=True)
    except (binascii.Error, ValueError) as error:
        raise ValueError(f"must be the file in base64 ({error})") from None


_NAME = {"type": "string", "pattern": r"^[A-Za-z0-9_-][A-Za-z0-9_. -]*$", "maxLength": _LONGEST_NAME}
_BASE64 = "^(?:[A-Za-z0-9+/]{4})*(?:[A-Za-z0-9+/]{2}==|[A-Za-z0-9+/]{3}=)?$"
_CONTENT = {"type": "string", "contentEncoding": "base64", "pattern": _BASE64}


class RecordFile(BaseModel, extra="forbid", frozen=True):
    """A file of a record."""

    name: Annotated[str, AfterValidator(_plain_name), WithJsonSchema(_NAME)] = Field(
        description="file name without a folder"
    )
    content: Annotated[bytes, BeforeValidator(_decoded), WithJsonSchema(_CONTENT)] = Field(
        description="content of the file"
    )


class RecordRequest(BaseModel, extra="forbid", frozen=True):
    """The files of a record: its components."""

    files: list[RecordFile] = Field(min_length=1, max_length=3, description="files of one event, or an archive")
    units: str | None = Field(
        None, description="unit of the acceleration, such as g or cm/s²; null if the file states the unit"
    )
    step: Annotated[float, Field(strict=True)] | None = Field(
        None, description="time step [s]; null if the file states the step"
    )
    record: Annotated[str, Field(max_length=_LONGEST_NAME)] | None = Field(
        None, description="name of a record in an archive or workbook; null for the first"
    )


@dataclass(frozen=True, slots=True)
class Archive:
    """The records in an archive.

    Attributes
    ----------
    records
        The files of each record, with paths below the archive, by its name.
    warnings
        Possible mistakes in its files, one line each.
    """

    records: Mapping[str, tuple[Path, ...]]
    warnings: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Upload:
    """The files of one event on disk, and the options for reading them; files in an archive have paths below it."""

    digest: str
    paths: tuple[Path, ...]
    reading: Mapping[str, Any]
    parts: tuple[Path, ...] = ()

    @property
    def folder(self) -> Path:
        """Folder of the files."""
        return self.paths[0].parent

    @property
    def is_archive(self) -> bool:
        """Whether the file holds files."""
        with self.paths[0].open("rb") as file:
            return is_container(file.read(_PIECE))

    def first_read(self) -> dict[str, Any]:
        """Return the plain values for the first reading of the files, which issues all warnings."""
        paths = [str(path) for path in self.parts or self.paths]
        return {"kind": "record", "path": paths[0] if len(paths) == 1 else paths, **self.reading}

    def motion(self) -> dict[str, Any]:
        """Return the plain values of the record, with the paths of its files."""
        return {**self.first_read(), "one_component": True}  # the warning about one component belongs to the upload

    def shown(self) -> dict[str, Any]:
        """Return the plain values of the record, with the names of its files."""
        names = [path.relative_to(self.folder).as_posix() for path in self.parts or self.paths]
        return {**self.motion(), "path": names[0] if len(names) == 1 else names}


@dataclass(slots=True)
class Uploads:
    """All uploads, in `folder`, of at most `limit` bytes together; the least recently used are removed first.

    A packed file may have at most `unpacked` bytes when unpacked.
    """

    folder: Path
    limit: int
    unpacked: int
    _known: "OrderedDict[str, Upload]" = field(default_factory=OrderedDict)

    def __getitem__(self, digest: object) -> Upload:
        found = self._known.get(digest) if isinstance(digest, str) else None
        if found is None:
            problem = f"motion.upload: record {str(digest)[:12]!r} is not stored (any more). Upload its files again."
            raise RefusedError(422, [problem])
        self._known.move_to_end(found.digest)
        return found

    def add(self, body: Mapping[str, Any]) -> Upload:
        """Store the files in the `body` of a request and return them.

        Raises
        ------
        RefusedError
            If a name, a content or a unit is invalid.
        """
        try:
            given = RecordRequest.model_validate(body)
        except ValidationError as error:
            raise RefusedError(422, [_line(one) for one in error.errors(include_input=False)]) from None
        files = {file.name: file.content for file in given.files}
        if len(files) < len(given.files):
            raise RefusedError(422, ["files: the names must be different. Rename a file."])
        for name, content in files.items():
            _require_unpacked_size(name, content, self.unpacked)
            if len(files) > 1 and is_container(content):
                raise RefusedError(422, [f"{name}: an archive beside other files. Upload it alone."])
        reading = given.model_dump(include={"units", "step"}, exclude_none=True)
        digest = hashlib.sha256(repr([*sorted(reading.items()), given.record or ""]).encode())
        for name, content in files.items():
            digest.update(name.encode() + b"\0" + hashlib.sha256(content).digest())
        known = digest.hexdigest()
        if known not in self._known:
            place = self.folder / known
            place.mkdir(parents=True, exist_ok=True)
            for name, content in files.items():
                (place / name).write_bytes(content)
            self._known[known] = Upload(known, tuple(place / name for name in files), reading)
        self._known.move_to_end(known)
        self._make_room()
        return self._known[known]

    def choose(self, upload: Upload, archive: Archive, name: str | None) -> Upload:
        """Return the upload of a record in an archive, the first one if `name` is None.

        Raises
        ------
        RefusedError
            If the archive has no such record.
        """
        if name is not None and name not in archive.records:
            listed = ", ".join(archive.records)
            raise RefusedError(422, [f"record: not in {upload.paths[0].name} (got {name!r}). Use one of {listed}."])
        chosen = replace(upload, parts=archive.records[name or next(iter(archive.records))])
        self._known[upload.digest] = chosen
        return chosen

    def drop(self, upload: Upload) -> None:
        """Remove an upload and its files."""
        self._known.pop(upload.digest, None)
        shutil.rmtree(self.folder / upload.digest, ignore_errors=True)

    def _make_room(self) -> None:
        def size() -> int:
            return sum(path.stat().st_size for upload in self._known.values() for path in upload.paths)

        while len(self._known) > 1 and size() > self.limit:
            self.drop(next(iter(self._known.values())))


def _line(problem: Any) -> str:
    place = ".".join(str(part) for part in problem["loc"])
    return f"{place}: {problem['msg'].removeprefix('Value error, ')}"


def _require_unpacked_size(name: str, content: bytes, most: int) -> None:
    """Refuse a gzip file of more than `most` bytes when unpacked, without unpacking more than these."""
    if not content.startswith(_GZIP):
        return
    size = 0
    with suppress(OSError, EOFError, zlib.error), gzip.open(io.BytesIO(content)) as unpacked:  # reported later
        while size <= most and (piece := unpacked.read(_PIECE)):
            size += len(piece)
    if size > most:
        raise RefusedError(
            422, [f"{name}: more than {most} bytes when unpacked. Cut the record, or read it in Python."]
        )


# Jobs

GRIDS: Mapping[str, Callable[..., Any]] = {
    study_of(one).name: one for one in (getattr(studies, name) for name in studies.GRIDS)
}
"""The studies whose result is a grid of classes, by name."""

JOBS: Mapping[str, type[Config]] = {
    **{name: config.study_config(one) for name, one in GRIDS.items()},
    "exact": config.study_config(studies.response_curves),
    "animation": config.SimulationConfig,
}
"""The description of each kind of job; `stylobate.lab.answers.Job` has its kind and its result."""

BRANCHES = ("upper", "lower")
"""Branches of steady rolling on which the runs of a map can start, each on that of its own motion."""


def may_start_on_branch(kind: str) -> bool:
    """Return whether the runs of a kind of job can start on a branch: those whose initial conditions do not vary."""
    return kind in GRIDS and not study_of(GRIDS[kind]).starts


# Descriptions

_DEEPEST = 24
"""Maximum depth of nested values; a copy of a sum of motions takes three."""

_MOST_LINES, _LONGEST_KEY = 4, 40


@dataclass(frozen=True, slots=True)
class Description:
    """Plain values of a description: `values` to compute with, `shown` for users, with the file names of uploads."""

    values: dict[str, Any]
    shown: dict[str, Any]


def described(body: Mapping[str, Any], uploads: Uploads, limits: Limits) -> Description:
    """Parse the description in the `body` of a request.

    Raises
    ------
    RefusedError
        If the description names files of this machine or a missing upload, or exceeds a limit.
    """
    found = Description(
        _with_uploads(body, lambda digest: uploads[digest].motion()),
        _with_uploads(body, lambda digest: uploads[digest].shown()),
    )
    problems = [*problems_of_numbers(body, limits), *_problems_of_grids(body, limits)]
    if problems:
        raise RefusedError(422, problems)
    return found


def _with_uploads(
    values: Mapping[str, Any], recorded: Callable[[object], dict[str, Any]], depth: int = 0
) -> dict[str, Any]:
    """Return `values` with the motion `upload` replaced by its record, at any depth."""
    if values.get("kind") == "record" or (set(values) & {"path", "upload", "file_sha256"}):
        for name in ("path", "file_sha256", "source"):
            if name in values:
                problem = f"{name}: the laboratory does not read files of this machine. Upload the record."
                raise RefusedError(422, [problem])
        if "upload" in values:
            rest = {name: value for name, value in values.items() if name not in ("kind", "upload")}
            values = {**recorded(values["upload"]), **rest}

    def inside(value: object, depth: int) -> object:
        if depth > _DEEPEST:
            raise RefusedError(422, [f"values may be nested to a depth of at most {_DEEPEST}"])
        if isinstance(value, Mapping):
            return _with_uploads(value, recorded, depth)
        return [inside(one, depth + 1) for one in value] if isinstance(value, list) else value

    return {name: inside(value, depth + 1) for name, value in values.items()}


def problems_of_numbers(body: Mapping[str, Any], limits: Limits) -> list[str]:
    """Return one line for each of the first numbers, at any depth, of unreasonable size, with a unit, or too large."""
    bounds = limits.of_numbers()
    found = []
    for place, value in _values(body):
        number, bound = _number_of(value), bounds.get(place.rpartition(".")[2])
        unit = split(value)[1] if isinstance(value, str) else ""
        if unit and size_of(unit) is not None:
            found.append(f"{place}: the laboratory takes numbers in SI units (got {value!r}). Leave out the unit.")
        elif not (number == 0.0 or SMALLEST <= abs(number) <= LARGEST or isnan(number)):  # NaN is refused later
            found.append(f"{place} must be zero or between {SMALLEST:g} and {LARGEST:g} in size, got {number!r}")
        elif bound is not None and number > bound[0]:
            most = f"{bound[0]:g} {bound[1]}".rstrip()
            found.append(f"{place} may be at most {most} in the laboratory, got {value!r}. Use Python for more.")
    return found[:_MOST_LINES]


def _values(body: Mapping[str, Any]) -> Iterator[tuple[str, object]]:
    """Yield all values that are no tables and lists with their places, at any depth."""
    waiting: list[tuple[str, object]] = [("", body)]
    while waiting:
        place, value = waiting.pop()
        within = f"{place}." if place else ""
        if isinstance(value, Mapping):
            waiting += [(within + repr(str(name)[:_LONGEST_KEY])[1:-1], one) for name, one in value.items()]
        elif isinstance(value, list):
            waiting += [(f"{within}{index}", one) for index, one in enumerate(value)]
        else:
            yield place, value


def _number_of(value: object) -> float:
    """Return a plain value as a number if it is or spells one; else zero."""
    try:
        return float(value) if isinstance(value, (int, float, str)) else 0.0
    except ValueError:
        return 0.0
    except OverflowError:
        return LARGEST * 2.0


def _problems_of_grids(body: Mapping[str, Any], limits: Limits) -> list[str]:
    """Return a line for each grid with too many runs."""
    grids = {name: grid for name in GRIDS if isinstance(grid := body.get(name), Mapping)}
    cells = {
        name: max(_number_of(grid.get("random")), prod(_length(grid.get(place)) for place in "xy"))
        for name, grid in grids.items()
    }
    return [
        f"a {name} may have {limits.cells} runs in the laboratory, got {size:g}. Use stylobate {name}."
        for name, size in cells.items()
        if size > limits.cells
    ]


def _length(axis: object) -> float:
    if not isinstance(axis, Mapping):
        return 1.0
    listed = axis.get("values")
    return len(listed) if isinstance(listed, list) else max(_number_of(axis.get("number")), 1.0)
