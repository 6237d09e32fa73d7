"""Uploaded records: files in a folder of the laboratory, identified by their digest."""

import base64
import binascii
import gzip
import hashlib
import io
import shutil
import zlib
from collections import OrderedDict
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path, PurePosixPath, PureWindowsPath
from typing import Any

from stylobate.lab.refusals import RefusedError

_MOST_FILES = 3  # components of one event
_LONGEST_NAME = 120
_GZIP = b"\x1f\x8b"
_PIECE = 1 << 16


@dataclass(frozen=True, slots=True)
class Upload:
    """The files of one event on disk, the options for reading them, and the resulting number of samples."""

    digest: str
    paths: tuple[Path, ...]
    reading: Mapping[str, Any]
    samples: int = 0
    step: float = 0.0

    @property
    def size(self) -> int:
        """Size of the files [bytes]."""
        return sum(path.stat().st_size for path in self.paths)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the files."""
        return tuple(path.name for path in self.paths)

    def motion(self) -> dict[str, Any]:
        """Return the plain values of the record, with the paths of its files."""
        return {**self.as_read(), "one_component": True}  # the warning about one component belongs to the upload

    def as_read(self) -> dict[str, Any]:
        """Return the plain values for the first reading of the files, which issues all warnings."""
        return self._motion([str(path) for path in self.paths])

    def as_json(self) -> dict[str, Any]:
        """Return the plain values of the record, with the names of its files."""
        return {**self._motion(list(self.names)), "one_component": True}

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
        files, reading = _files(body), _reading(body)
        for name, content in files.items():
            _require_unpacked_size(name, content, self.unpacked)
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

    def measured(self, upload: Upload, samples: int, step: float) -> None:
        """Record the number of samples of an upload, and the `step` between them [s]."""
        self._known[upload.digest] = replace(upload, samples=samples, step=step)

    def drop(self, upload: Upload) -> None:
        """Remove an upload and its files."""
        self._known.pop(upload.digest, None)
        shutil.rmtree(self.folder / upload.digest, ignore_errors=True)

    def _make_room(self) -> None:
        while len(self._known) > 1 and sum(upload.size for upload in self._known.values()) > self.limit:
            self.drop(next(iter(self._known.values())))


def _files(body: Mapping[str, Any]) -> dict[str, bytes]:
    files = body.get("files")
    if not isinstance(files, Sequence) or isinstance(files, str) or not 1 <= len(files) <= _MOST_FILES:
        raise RefusedError(422, ["files must be a list of one to three files of one event"])
    found = dict(_file(index, file) for index, file in enumerate(files))
    if len(found) < len(files):
        raise RefusedError(422, ["files must have different names"])
    return found


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


def _file(index: int, file: object) -> tuple[str, bytes]:
    name, content = (file.get("name"), file.get("content")) if isinstance(file, Mapping) else (None, None)
    if not isinstance(name, str) or not _is_plain(name):
        raise RefusedError(422, [f"files.{index}.name must be the name of a file without a folder, got {name!r}"])
    if not isinstance(content, str):
        raise RefusedError(422, [f"files.{index}.content must be the file in base64"])
    try:
        return name, base64.b64decode(content, validate=True)
    except (binascii.Error, ValueError) as error:
        raise RefusedError(422, [f"files.{index}.content is not base64: {error}"]) from None


def _is_plain(name: str) -> bool:
    """Return whether `name` is a valid file name on any system, without a folder."""
    alone = PurePosixPath(name).name == name == PureWindowsPath(name).name
    return alone and 0 < len(name.encode(errors="replace")) <= _LONGEST_NAME and name.isprintable() and name[0] != "."


def _reading(body: Mapping[str, Any]) -> dict[str, Any]:
    known: dict[str, tuple[type, ...]] = {"units": (str,), "step": (int, float)}
    unknown = sorted(set(body) - {"files", *known})
    if unknown:
        raise RefusedError(422, [f"{unknown[0]} is unknown. Remove it."])
    reading = {name: body[name] for name in known if body.get(name) is not None}
    for name, value in reading.items():
        if not isinstance(value, known[name]) or isinstance(value, bool):
            raise RefusedError(422, [f"{name} must be a {'text' if name == 'units' else 'number'}, got {value!r}"])
    return reading
