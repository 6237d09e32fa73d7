"""Text files of records: opened, decoded, and read as numbers; what is wrong is told by file and line."""

import gzip
import math
import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from stylobate.errors import FileError

Floats = npt.NDArray[np.float64]

_GZIP = b"\x1f\x8b"


def read_bytes(path: Path) -> bytes:
    """Return what the file holds, unpacked if it is gzip.

    Raises
    ------
    FileError
        If it cannot be read or is empty.
    """
    try:
        content = path.read_bytes()
        content = gzip.decompress(content) if content.startswith(_GZIP) else content
    except (OSError, EOFError, zlib.error) as error:
        reason = getattr(error, "strerror", None) or str(error)
        message = f"{path}: cannot be read: {reason}"
        raise FileError(message) from error
    if not content.strip():
        message = f"{path}: the file is empty"
        raise FileError(message)
    return content


def is_binary(content: bytes) -> bool:
    """Return whether this is no text: bytes that no text file holds."""
    return any(byte < 0x20 and byte not in b"\t\n\r\f\x1a" for byte in content[:4096])  # noqa: PLR2004  a space


@dataclass(frozen=True, slots=True)
class Text:
    """The lines of a text file, without their ends; line numbers in messages begin at 1."""

    path: Path
    lines: tuple[str, ...]

    @classmethod
    def of(cls, path: Path, content: bytes) -> "Text":
        """Return the lines of `content`: UTF-8, else Latin-1, ends of any system."""
        try:
            text = content.decode("utf-8-sig")
        except UnicodeDecodeError:
            text = content.decode("latin-1")
        return cls(path, tuple(text.rstrip("\x1a\x00").replace("\r\n", "\n").replace("\r", "\n").split("\n")))

    def fault(self, index: int, what: str) -> FileError:
        """Return the error that the line at `index` deserves."""
        return FileError(f"{self.path}, line {index + 1}: {what}")

    def number(self, index: int, token: str) -> float:
        """Return the finite number that a token of the line at `index` spells."""
        try:
            value = float(token)
        except ValueError:
            raise self.fault(index, f"not a number: {token!r}") from None
        if not math.isfinite(value):
            raise self.fault(index, f"not a finite number: {token!r}")
        return value

    def rows(self, tokens: Sequence[tuple[int, list[str]]]) -> Floats:
        """Return rows of equally many tokens, each with the index of its line, as numbers of shape (rows, columns)."""
        try:
            values = np.array([row for _, row in tokens], dtype=float)
        except ValueError:
            values = np.array([np.nan])
        if not np.all(np.isfinite(values)):
            for index, row in tokens:
                for token in row:
                    self.number(index, token)
        return values
