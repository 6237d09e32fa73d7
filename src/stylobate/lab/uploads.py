"""Uploaded records: files in a folder of the laboratory, identified by their digest."""

import base64
import binascii
import gzip
import hashlib
import io
import shutil
import zlib
from collections import OrderedDict
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath, PureWindowsPath
from typing import Annotated, Any

from pydantic import AfterValidator, BaseModel, BeforeValidator, Field, ValidationError, WithJsonSchema

from stylobate.lab.limits import RefusedError

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

    files: list[RecordFile] = Field(min_length=1, max_length=3, description="files of one event")
    units: str | None = Field(
        None, description="unit of the acceleration, such as g or cm/s²; null if the file states the unit"
    )
    step: Annotated[float, Field(strict=True)] | None = Field(
        None, description="time step [s]; null if the file states the step"
    )


@dataclass(frozen=True, slots=True)
class Upload:
    """The files of one event on disk, and the options for reading them."""

    digest: str
    paths: tuple[Path, ...]
    reading: Mapping[str, Any]

    def motion(self) -> dict[str, Any]:
        """Return the plain values of the record, with the paths of its files."""
        return {**self.as_read(), "one_component": True}  # the warning about one component belongs to the upload

    def as_read(self) -> dict[str, Any]:
        """Return the plain values for the first reading of the files, which issues all warnings."""
        return self._motion([str(path) for path in self.paths])

    def as_json(self) -> dict[str, Any]:
        """Return the plain values of the record, with the names of its files."""
        return {**self._motion([path.name for path in self.paths]), "one_component": True}

    def _motion(self, paths: list[str]) -> dict[str, Any]:
        return {"kind": "record", "path": paths[0] if len(paths) == 1 else paths, **self.reading}


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
        reading = given.model_dump(include={"units", "step"}, exclude_none=True)
        digest = hashlib.sha256(repr(sorted(reading.items())).encode())
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
