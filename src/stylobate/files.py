"""Atomic writing of files, and checksums that detect damage."""

import csv
import datetime as dt
import hashlib
import math
import os
import platform
import re
import secrets
import shutil
import stat
import zipfile
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from functools import lru_cache
from io import BytesIO, StringIO
from pathlib import Path
from typing import Any

from stylobate.errors import FileError, require_extra
from stylobate.text import printable

# Parts are named after the beginning of the file's name, the machine, the process, and a number drawn at random.
_STEM = 40
_MACHINE = hashlib.sha256(platform.node().encode()).hexdigest()[:6]

_LABEL = b"\n#stylobate sha256 "
_SEAL_LENGTH = len(_LABEL) + hashlib.sha256().digest_size * 2 + 1
# A label with at least so many intact bytes marks a seal.
_LABEL_BYTES_SEEN = len(_LABEL) // 2
_RESTORE = "Restore it from a copy, or compute it again"


def file_of(path: str | os.PathLike[str]) -> Path:
    """Return the file that holds a path: the path itself, or the archive above it, as in quakes.zip/CLS000.AT2."""
    path = Path(path)
    with suppress(OSError, ValueError):  # a part of an archive may have a name that no file can have
        if path.exists():
            return path
    for one in path.parents:
        with suppress(OSError, ValueError):
            if one.is_file():
                return one
    return path


def sha256_of(path: str | os.PathLike[str]) -> str:
    """Return the SHA-256 of a file in hexadecimal digits; a file is read once until it changes.

    Raises
    ------
    OSError
        If it cannot be read.
    """
    found = Path(path).stat()
    return _sha256(str(path), found.st_mtime_ns, found.st_size)


@lru_cache(maxsize=4096)
def _sha256(path: str, _time: int, _size: int) -> str:
    with Path(path).open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def write_whole(path: str | Path, content: bytes | str) -> Path:
    """Write `content` to the file `path`, text in UTF-8; an older file stays until the new one is complete.

    Raises
    ------
    FileError
        If the file cannot be written; no part of it remains.
    """
    # File names that are not UTF-8 are written unchanged.
    data = content.encode("utf-8", "surrogateescape") if isinstance(content, str) else content
    with written_aside(path) as beside, beside.open("wb") as file:
        file.write(data)
        file.flush()
        if beside.is_file():
            os.fsync(file.fileno())
    return Path(path)


@contextmanager
def written_aside(path: str | Path) -> Iterator[Path]:
    """Yield a path beside `path` for a new file or folder; it moves to `path` at the end, or is removed after an error.

    A file replaces an older file and takes its permissions; a folder replaces nothing. A link stays, and its target is
    replaced. A device or pipe is written directly. Parts that a killed process left of the same file are removed.

    Raises
    ------
    FileError
        If the file cannot be written.
    """
    target = _target(path)
    if target.exists() and not (target.is_file() or target.is_dir()):
        beside = target
    else:
        token = f"{_MACHINE}-{os.getpid()}-{secrets.token_hex(3)}"
        beside = target.with_name(f".{target.stem[:_STEM]}.{token}.part{target.suffix}")
        _remove_left_behind(target)
    try:
        try:
            yield beside
            if beside != target:
                if target.is_file():
                    beside.chmod(stat.S_IMODE(target.stat().st_mode))
                beside.replace(target)
        finally:
            if beside != target:
                _remove(beside)
    except OSError as error:
        raise FileError(f"cannot write {path}: {error.strerror or error}") from None


def _target(path: str | Path) -> Path:
    try:
        target = Path(os.path.realpath(path))
    except (OSError, ValueError) as error:  # a ValueError: a name with a null character
        raise FileError(f"cannot write {path}: {getattr(error, 'strerror', None) or error}") from None
    if not target.name:
        raise FileError(f"cannot write {path}: it is a folder")
    return target


def _remove(path: Path) -> None:
    if path.is_dir():
        shutil.rmtree(path)
    else:
        path.unlink(missing_ok=True)


def _remove_left_behind(target: Path) -> None:
    """Remove the parts of the file `target` whose writers, on this machine, are no longer alive."""
    stem, suffix = re.escape(target.stem[:_STEM]), re.escape(target.suffix)
    name = re.compile(rf"\.{stem}\.{_MACHINE}-(\d+)-[0-9a-f]+\.part{suffix}")
    with suppress(OSError):  # the folder cannot be listed, or a part belongs to another user
        for other in target.parent.iterdir():
            if (match := name.fullmatch(other.name)) and not _is_alive(int(match[1])):
                _remove(other)


def _is_alive(process: int) -> bool:
    if process == os.getpid() or os.name == "nt":  # on Windows os.kill would end the process
        return True
    with suppress(ProcessLookupError, OverflowError):
        with suppress(PermissionError):
            os.kill(process, 0)
        return True
    return False


# Text from which spreadsheet programs read a formula, behind any number of marks: one of these signs, of normal or full
# width, also after blanks, or a tab or line end.
_FORMULA = re.compile("(?P<marks>'*)(?:\\s*[-=+@\uff0d\uff1d\uff0b\uff20]|[\\t\\n])")
_NUMBER = re.compile(r"[-+]?(?:\d+(?:[.,]\d+)*|[.,]\d+)(?:[eE][-+]?\d+)?(?:\s?%)?|[-+]?inf|-")
_MARK = "'"


def csv_text(header: Iterable[str], rows: Iterable[Iterable[Any]]) -> str:
    """Format a table as the text of a CSV file.

    Text that spreadsheet programs would read as a formula is marked with an apostrophe in front; numbers such as -0.5,
    also as text, are not. `unmarked` takes the mark off again. Characters that cannot be printed are replaced.
    """
    text = StringIO(newline="")
    writer = csv.writer(text)
    writer.writerow(map(_marked, header))
    writer.writerows(map(_marked, row) for row in rows)
    return text.getvalue()


def _marked(value: Any) -> Any:
    """Return a cell of a CSV file: text with a mark in front of what begins a formula."""
    if isinstance(value, (int, float)) or value is None:
        return value
    text = printable(str(value))
    return _MARK + text if _FORMULA.match(text) and not _NUMBER.fullmatch(text) else text


def unmarked(cell: str) -> str:
    """Return a cell of a CSV file without the mark that `csv_text` set.

    >>> unmarked("'=2+2"), unmarked("'s-Hertogenbosch"), unmarked("-0.5")
    ('=2+2', "'s-Hertogenbosch", '-0.5')
    """
    found = _FORMULA.match(cell)
    return cell.removeprefix(_MARK) if found and found["marks"] else cell


def require_workbooks(path: str | Path) -> None:
    """Raise UnsupportedError if openpyxl, which writes Excel workbooks, is not installed."""
    remedy = 'install openpyxl: pip install "stylobate[excel]"; or write CSV'
    require_extra("openpyxl", f"{path}: to write an Excel workbook, {remedy}")


def write_workbook(path: str | Path, tables: Mapping[str, Iterable[Iterable[Any]]]) -> Path:
    """Write an Excel workbook with one sheet for each table of rows, the first of which is bold and stays in sight.

    Text is stored as text, also if it begins like a formula. The same tables give the same bytes.

    Raises
    ------
    UnsupportedError
        If openpyxl is not installed.
    FileError
        If the file cannot be written.
    """
    require_workbooks(path)
    from openpyxl import Workbook
    from openpyxl.cell import WriteOnlyCell
    from openpyxl.styles import Font
    from openpyxl.writer.excel import ExcelWriter

    book = Workbook(write_only=True)
    book.properties.created = book.properties.modified = _WRITTEN
    for title, rows in tables.items():
        sheet = book.create_sheet(title)
        sheet.freeze_panes = "A2"
        for place, row in enumerate(rows):
            cells = [WriteOnlyCell(sheet, value=_in_cell(value)) for value in row]
            for cell in cells:
                if isinstance(cell.value, str):  # openpyxl takes "=…" for a formula and "#N/A" for an error
                    cell.data_type = "s"
                    cell.quotePrefix = bool(_FORMULA.match(cell.value))
            for cell in cells if place == 0 else ():
                cell.font = Font(bold=True)
            sheet.append(cells)
    content = BytesIO()
    ExcelWriter(book, _Undated(content, "w", zipfile.ZIP_DEFLATED)).save()  # Workbook.save states the time
    return write_whole(path, content.getvalue())


_WRITTEN = dt.datetime(1980, 1, 1)  # noqa: DTZ001  the first date of a zip archive, which has no zone
"""The date that workbooks state, so that the same tables give the same bytes."""


class _Undated(zipfile.ZipFile):
    """A zip archive whose members have no date of their own."""

    def writestr(self, zinfo_or_arcname: Any, data: Any, *rest: Any, **more: Any) -> None:
        """Write a member."""
        del rest, more
        undated = zipfile.ZipInfo(str(zinfo_or_arcname), _WRITTEN.timetuple()[:6])
        super().writestr(undated, data, zipfile.ZIP_DEFLATED)

    def write(self, filename: Any, arcname: Any = None, *rest: Any, **more: Any) -> None:
        """Write a file as a member."""
        del rest, more
        self.writestr(arcname or filename, Path(filename).read_bytes())


def _in_cell(value: Any) -> Any:
    """Return a value as a cell holds it: a number that is not finite as an empty cell."""
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value if isinstance(value, (int, float, bool)) or value is None else printable(str(value))


def sealed(content: bytes | memoryview) -> bytes:
    """Return `content` followed by a line with its SHA-256."""
    return b"".join((content, _LABEL, hashlib.sha256(content).hexdigest().encode(), b"\n"))


def read_sealed(path: str | Path) -> tuple[bytes, bool]:
    """Read the file `path`; return its content without a seal, and whether it had a seal, which is checked.

    Raises
    ------
    FileError
        If the file cannot be read, or its checksum differs.
    """
    path = Path(path)
    try:
        if not path.is_file():
            raise FileError(f"cannot read {path}: {'it is a folder' if path.is_dir() else 'there is no such file'}")
        whole = path.read_bytes()
    except (OSError, ValueError) as error:  # a ValueError: a name with a null character
        raise FileError(f"cannot read {path}: {getattr(error, 'strerror', None) or error}") from error
    content, seal = whole[:-_SEAL_LENGTH], whole[-_SEAL_LENGTH:]
    if not _looks_like_a_seal(seal):
        if _LABEL in whole:
            raise FileError(f"{path} is damaged: bytes follow its checksum, or are missing. {_RESTORE}")
        return whole, False
    if sealed(content)[-_SEAL_LENGTH:] != seal:
        raise FileError(f"{path} is damaged: its checksum differs. {_RESTORE}")
    return content, True


def _looks_like_a_seal(end: bytes) -> bool:
    same = sum(one == other for one, other in zip(end, _LABEL, strict=False))
    return same >= _LABEL_BYTES_SEEN
