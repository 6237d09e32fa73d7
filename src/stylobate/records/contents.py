"""The bytes of files: reading and unpacking within limits, and what first bytes show of their kind.

The limits hold for a file with everything in it: a file that unpacks to more than the memory of a machine, or that
holds files in files without end, is refused after a fraction of a second.
"""

import gzip
import io
import os
import stat
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol
from xml.parsers import expat

from stylobate.errors import FileError
from stylobate.text import plural

GZIP = b"\x1f\x8b"
"""First bytes of files that gzip has packed."""

_UTF_16 = (b"\xff\xfe", b"\xfe\xff")
# First bytes of archives and documents that may hold records, but that are not opened.
_PACKED = {
    b"Rar!": "a rar archive. Unpack it and read the files in it",
    b"7z\xbc\xaf": "a 7z archive. Unpack it and read the files in it",
    b"BZh": "packed with bzip2. Unpack it and read the files in it",
    b"\xfd7zXZ\x00": "packed with xz. Unpack it and read the files in it",
    b"\x28\xb5\x2f\xfd": "packed with zstd. Unpack it and read the files in it",
    b"\x1f\x9d": "packed with compress. Unpack it and read the files in it",
    b"\xd0\xcf\x11\xe0": "an Excel workbook of the old form. Save it as xlsx, or its sheet as CSV, and read that",
    b"%PDF": "a PDF document. Save its numbers as text and read that",
}

LARGEST = 1 << 30
"""Bytes to which a file may unpack, counted at each level of nesting: more than the records of any study have."""
LONGEST_TEXT = 1 << 27
"""Bytes of a text file: five million rows of four numbers, which take seconds and a gigabyte to convert."""
LONGEST_LINE = 1 << 16
"""Bytes of a line of text; no format has lines of more than a few hundred characters, and tables of a few thousand."""
MOST_FILES = 20_000
"""Files that an archive may hold, with those of the archives in it."""
DEEPEST = 8
"""Archives that may lie in each other."""

_PIECE, _HEAD = 1 << 20, 1 << 12


class NoRecordError(FileError):
    """A file that holds no record of accelerations; in a folder it is left out."""


class Stream(Protocol):
    """A stream of bytes: a file, a file in an archive, or what gzip unpacks."""

    def read(self, size: int, /) -> bytes:
        """Return at most `size` bytes; none at the end."""


@dataclass(slots=True)
class Allowance:
    """What a file may still unpack to: one for each file that is read, handed to everything in it.

    Parameters
    ----------
    size
        Bytes that may still be unpacked.
    files
        Files that may still be listed.
    depth
        Archives that may still lie in each other.
    """

    size: int = LARGEST
    files: int = MOST_FILES
    depth: int = DEEPEST

    def take(self, path: Path, size: int) -> None:
        """Count `size` bytes that are about to be unpacked.

        Raises
        ------
        FileError
            If these are too many.
        """
        if size > self.size:
            raise FileError(
                f"{path}: unpacks to more than {LARGEST >> 30} GiB, with all that lies in it. "
                "Unpack the files that are needed into a folder"
            )
        self.size -= size

    def take_files(self, path: Path, number: int) -> None:
        """Count the files in an archive.

        Raises
        ------
        FileError
            If these are too many.
        """
        if number > self.files:
            raise FileError(
                f"{path}: more than {plural(MOST_FILES, 'file')}, with those of archives in it. "
                "Unpack the files that are needed into a folder"
            )
        self.files -= number

    @contextmanager
    def inside(self, path: Path) -> Iterator[None]:
        """Count an archive as open while the files in it are read.

        Raises
        ------
        FileError
            If too many archives lie in each other.
        """
        if self.depth == 0:
            raise FileError(f"{path}: more than {plural(DEEPEST, 'archive')} in each other. Unpack the outer ones")
        self.depth -= 1
        try:
            yield
        finally:
            self.depth += 1

    def read(self, path: Path, stream: Stream) -> bytes:
        """Read a stream of unpacked bytes piece by piece and count them.

        Raises
        ------
        FileError
            If there are too many, or too many for a text; the rest is not unpacked.
        """
        content = _read(path, stream, self.size)
        self.take(path, len(content))
        return content


def _read(path: Path, stream: Stream, most: int) -> bytes:
    """Read a stream, up to a little more than `most` bytes; refuse a text that is too long."""
    content = io.BytesIO()
    size, longest = 0, most
    while size <= longest and (piece := stream.read(_PIECE)):
        if not size and not is_binary(piece):
            longest = min(most, LONGEST_TEXT)
        size += content.write(piece)
    if most >= size > longest:
        raise FileError(
            f"{path}: a text of more than {LONGEST_TEXT >> 20} MiB. Cut it to the record, or save it in a binary "
            "format such as miniSEED"
        )
    return content.getvalue()


def read_bytes(path: Path, allowance: Allowance | None = None) -> bytes:
    """Read the bytes of a file; decompress gzip.

    Raises
    ------
    FileError
        If it cannot be read, or is too long.
    """
    allowance = Allowance() if allowance is None else allowance
    try:
        with path.open("rb") as file:
            own = os.fstat(file.fileno())
            if stat.S_ISREG(own.st_mode):
                is_short = own.st_size <= LONGEST_TEXT
                content = file.read() if is_short else _read(path, file, own.st_size)
            else:  # a pipe or a device, whose end is not known
                content = _read(path, file, LARGEST)
            if file.read(1):
                raise FileError(f"{path}: more than {LARGEST >> 20} MiB, and no end. Save it as a file")
        return unpacked(path, content, allowance)
    except (OSError, ValueError, EOFError, zlib.error) as error:  # a ValueError: a name with a null character
        reason = getattr(error, "strerror", None) or str(error)
        several = "*" in path.name or path.is_dir()
        damaged = isinstance(error, (EOFError, zlib.error, gzip.BadGzipFile))
        remedy = ". Read folders and patterns with read_records" if several else ". Download the file again" * damaged
        raise FileError(f"{path}: cannot be read: {reason}{remedy}") from error


def unpacked(path: Path, content: bytes, allowance: Allowance) -> bytes:
    """Return the content of a file, decompressed if it is packed with gzip.

    Raises
    ------
    FileError
        If it is too long.
    OSError, EOFError, zlib.error
        If it is damaged.
    """
    if not content.startswith(GZIP):
        return content
    with gzip.open(io.BytesIO(content)) as stream:
        return allowance.read(path, stream)


def as_utf8(content: bytes) -> bytes:
    """Return UTF-16 with its mark as UTF-8, and other content unchanged."""
    return content.decode("utf-16", errors="replace").encode() if content.startswith(_UTF_16) else content


def require_readable(path: Path, content: bytes) -> None:
    """Refuse a file that no reader opens.

    Raises
    ------
    NoRecordError
        If it is empty, or an archive or document that cannot be opened.
    """
    if not content or content.isspace():
        raise NoRecordError(f"{path}: the file is empty. Download or export it again")
    for begin, what in _PACKED.items():
        if content.startswith(begin):
            raise NoRecordError(f"{path}: {what}")


def require_lines(path: Path, content: bytes) -> None:
    """Refuse a text with a line that is longer than those of any table, before anything looks at its words.

    Raises
    ------
    FileError
        If there is such a line.
    """
    begin = 0
    while len(content) - begin > LONGEST_LINE:
        piece = content[begin : begin + LONGEST_LINE]
        end = max(piece.rfind(b"\n"), piece.rfind(b"\r"))
        if end < 0:
            raise FileError(
                f"{path}: a line of more than {LONGEST_LINE >> 10} KiB. Write one sample, or a few, on each line"
            )
        begin += end + 1


def is_binary(content: bytes) -> bool:
    """Return whether the content has bytes that no text file holds."""
    head = as_utf8(content[:_HEAD])
    return any(byte < 0x20 and byte not in b"\t\n\r\f\x1a" for byte in head)  # noqa: PLR2004  a space


DECLARES_TYPES = "<!DOCTYPE"
"""Found by `xml_root` instead of a name, where a document declares types or entities."""


class _FoundError(Exception):
    """The name of the first element, or `DECLARES_TYPES`; ends the parsing."""


def xml_root(stream: Stream) -> str:
    """Return the namespace and name of the first element of an XML document; empty if it is not one.

    Nothing behind the beginning of the first element is read, and no declared entity is expanded.
    """

    def found(name: str, *_: object) -> None:
        raise _FoundError(name)

    parser = expat.ParserCreate(namespace_separator=" ")
    parser.StartElementHandler = found
    parser.StartDoctypeDeclHandler = lambda *_: found(DECLARES_TYPES)
    try:
        while piece := stream.read(_HEAD):
            parser.Parse(piece)
    except _FoundError as name:
        return str(name)
    except (expat.ExpatError, LookupError, ValueError):  # also of encodings that are unknown
        pass
    return ""
