"""Text files of records: decoding, numbers and units; error messages name file and line."""

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from stylobate.column.numbers import STANDARD_GRAVITY
from stylobate.errors import FileError, ParameterError
from stylobate.records.contents import as_utf8, read_bytes, require_lines, require_readable

Floats = npt.NDArray[np.float64]

REMARKS = ("#", "%", "!", "//")
"""Prefixes of comment lines."""

# Characters of a message beside the place: more than any of ours has without words of the file.
_LONGEST_FAULT = 400
_WHOLE = re.compile(r"[0-9]{1,12}")
_DECIMAL_COMMA = re.compile(r"[-+]?\d*[.,]?\d*,\d+([EeDd][-+]?\d+)?")


def is_number(token: str) -> bool:
    """Return whether a token is a number, finite or not."""
    try:
        float(token)
    except ValueError:
        return False
    return True


def begins_with_a_number(line: str) -> bool:
    """Return whether a line without leading blanks is neither a comment nor column names."""
    return line[:1].isdigit() or line.startswith(("+", "-", "."))


@dataclass(frozen=True, slots=True)
class Text:
    """Lines of a text file without line ends; line numbers in messages begin at 1."""

    path: Path
    lines: tuple[str, ...]

    @classmethod
    def read(cls, path: Path) -> "Text":
        """Read the lines of a text file, unpacked if it is packed with gzip.

        Raises
        ------
        FileError
            If it cannot be read, or is empty, or an archive or a document.
        """
        content = read_bytes(path)
        require_readable(path, content)
        return cls.of(path, content)

    @classmethod
    def of(cls, path: Path, content: bytes) -> "Text":
        """Decode `content` to lines: UTF-8, UTF-16 with its mark, otherwise Latin-1, with any line ends.

        Raises
        ------
        FileError
            If a line is longer than those of any table.
        """
        content = as_utf8(content)
        require_lines(path, content)
        try:
            text = content.decode("utf-8-sig")
        except UnicodeDecodeError:
            text = content.decode("latin-1")
        return cls(path, tuple(text.rstrip("\x1a\x00").replace("\r\n", "\n").replace("\r", "\n").split("\n")))

    def fault(self, index: int, what: str, kind: type[FileError] = FileError) -> FileError:
        """Return a FileError that names the file and the line at `index`, the last one if the file ends before.

        Words of the file in the middle of `what` may be long: the message keeps its problem and its remedy.
        """
        if len(what) > _LONGEST_FAULT:
            half = _LONGEST_FAULT // 2
            what = f"{what[:half]} … {what[-half:]}"
        return kind(f"{self.path}, line {min(index + 1, len(self.lines))}: {what}")

    def number(self, index: int, token: str) -> float:
        """Parse a token of the line at `index` as a finite number."""
        try:
            value = float(token)
        except ValueError:
            remedy = "Write decimal points" if _DECIMAL_COMMA.fullmatch(token) else "Correct or remove it"
            raise self.fault(index, f"not a number: {token!r}. {remedy}") from None
        if not math.isfinite(value):
            raise self.fault(
                index,
                f"not a finite number: {token!r}. Replace it by a number, or trim the file to the samples without gaps",
            )
        return value

    def count(self, index: int, name: str, token: str) -> int:
        """Parse a token of the line at `index` as a number of samples, at least two."""
        if not _WHOLE.fullmatch(token):
            raise self.fault(index, f"{name} must be a whole number, got {token!r}. Correct the header")
        if int(token) < 2:  # noqa: PLR2004  a step has two ends
            raise self.fault(index, f"{name} must be at least 2 samples, got {token}. Correct the header")
        return int(token)

    def rows(self, tokens: Sequence[tuple[int, list[str]]]) -> Floats:
        """Parse rows of equally many tokens, each with its line index, to numbers of shape (rows, columns)."""
        try:
            values = np.array([row for _, row in tokens], dtype=float)
        except ValueError:
            values = np.array([np.nan])
        if not np.all(np.isfinite(values)):
            for index, row in tokens:
                for token in row:
                    self.number(index, token)
        return values

    def series(self, after: int, count: int | None) -> Floats:
        """Parse all numbers below the line at index `after`, `count` of them if given.

        Raises
        ------
        FileError
            If a token is no finite number, or the count differs.
        """
        tokens = [(at, line.split()) for at, line in enumerate(self.lines[after + 1 :], start=after + 1)]
        tokens = [(at, row) for at, row in tokens if row]
        found = sum(len(row) for _, row in tokens)
        values = self.rows([(at, [token]) for at, row in tokens for token in row]) if found else np.empty((0, 1))
        if count is not None and found != count:
            last = tokens[-1][0] if tokens else after
            remedy = "Download the file again, or correct the count in the header"
            raise self.fault(last, f"the header states {count} samples, the file has {found}. {remedy}")
        return values[:, 0]


_FACTORS = {"g": STANDARD_GRAVITY, "m/s²": 1.0, "cm/s²": 0.01, "mm/s²": 0.001}
KNOWN = '"g", "m/s²" (m/s2), "cm/s²" (cm/s2, gal) or "mm/s²"'
"""List of the units for messages."""

_SPELLINGS = {
    "g": "g",
    "m/s2": "m/s²",
    "m/s/s": "m/s²",
    "ms-2": "m/s²",
    "cm/s2": "cm/s²",
    "cm/s/s": "cm/s²",
    "cms-2": "cm/s²",
    "gal": "cm/s²",
    "gals": "cm/s²",
    "mm/s2": "mm/s²",
    "mm/s/s": "mm/s²",
}


class TimeUnit(NamedTuple):
    """Unit of the times in a file: its symbol, and its length [s]."""

    symbol: str
    seconds: float

    def in_seconds(self, time: float) -> float:
        """Convert a time in this unit to s, without the last digits of the product: 35 ms are 0.035 s."""
        return time if self.seconds == 1.0 else float(f"{time * self.seconds:.14g}")


SECOND = TimeUnit("s", 1.0)
_TIME_SPELLINGS = {
    SECOND: "s sec secs second seconds sek sekunde sekunden seconde secondes secondi seg segundo segundos",
    TimeUnit("ms", 1e-3): "ms msec msecs millisecond milliseconds",
    TimeUnit("µs", 1e-6): "µs us µsec usec microsecond microseconds",
    TimeUnit("min", 60.0): "min mins minute minutes",
}
_TIME_UNITS = {spelling: unit for unit, spellings in _TIME_SPELLINGS.items() for spelling in spellings.split()}
_GREEK_MU, _MICRO_SIGN = "μ", "µ"


def unit_of(text: str) -> str | None:
    """Parse a unit to "g", "m/s²", "cm/s²" or "mm/s²", or None.

    >>> unit_of("CM/SEC**2"), unit_of("gal"), unit_of("volt")
    ('cm/s²', 'cm/s²', None)
    """
    plain = text.strip().lower().replace(" ", "").replace("sec", "s").replace("²", "2").replace("⁻", "-")
    return _SPELLINGS.get(plain.replace("**", "").replace("^", ""))


def time_unit_of(text: str) -> TimeUnit | None:
    """Parse a unit of time: s, ms, µs or min; None for other units.

    >>> time_unit_of("Sec."), time_unit_of("ms"), time_unit_of("samples")
    (TimeUnit(symbol='s', seconds=1.0), TimeUnit(symbol='ms', seconds=0.001), None)
    """
    return _TIME_UNITS.get(text.strip().lower().replace(_GREEK_MU, _MICRO_SIGN).rstrip("."))


def unknown_unit(text: str) -> str:
    """Describe, for a message, a unit in a file that `unit_of` does not know."""
    return f"unknown unit {text!r}. Give accelerations in {KNOWN}, and state that unit"


def require_unit(text: str) -> str:
    """Parse a unit, or raise ParameterError.

    Raises
    ------
    ParameterError
        If the unit is unknown.
    """
    unit = unit_of(text) if isinstance(text, str) else None
    if unit is None:
        raise ParameterError(f"units must be {KNOWN}, got {text!r}")
    return unit


def in_si(unit: str) -> float:
    """Return the factor from a `unit` of `unit_of` to m/s²; g is standard gravity, 9.80665 m/s²."""
    return _FACTORS[unit]
