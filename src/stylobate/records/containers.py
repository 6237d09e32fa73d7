"""Files that hold files: zip and tar archives, and workbooks, of which each sheet is a table of text."""

import io
import re
import tarfile
import zipfile
import zlib
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path, PurePosixPath
from typing import Any, NamedTuple

from stylobate.errors import FileError, UnsupportedError
from stylobate.text import shortened

Member = tuple[Path, bytes]
"""A file in a container: its path, below that of the container, and its content."""

Choice = Callable[[Iterable[Path]], Iterable[Path]]
"""Chooses among the paths of the files in a container."""

ZIP = b"PK\x03\x04"
"""First bytes of zip archives and workbooks."""

_WORKBOOK = "xl/workbook.xml"
_FORMULA = re.compile(rb"<(\w+:)?f[\s/>]")
_TAR, _TAR_AT = b"ustar", 257
# More than any record has: an archive that unpacks to more is refused before it is unpacked [bytes].
_LARGEST = 1 << 30


def is_container(content: bytes) -> bool:
    """Return whether a file holds files."""
    return content.startswith(ZIP) or content[_TAR_AT : _TAR_AT + len(_TAR)] == _TAR


def members(path: Path, content: bytes, chosen: Choice) -> Iterator[Member]:
    """Yield the files in an archive, in the order of their names, or the sheets of a workbook.

    Parameters
    ----------
    path, content
        The container.
    chosen
        Function that chooses among the paths of the files; only these are unpacked.

    Raises
    ------
    FileError
        If the container is damaged, or needs a password, or unpacks to more than 1 GiB.
    UnsupportedError
        If it is a workbook, and openpyxl is not installed.
    """
    try:
        if is_workbook(content):
            yield from _sheets(path, content, chosen)
        elif content.startswith(ZIP):
            with zipfile.ZipFile(io.BytesIO(content)) as archive:
                files = [_Packed(one.filename, one.file_size, one) for one in archive.infolist() if not one.is_dir()]
                yield from _unpacked(path, files, archive.read, chosen)
        else:
            with tarfile.open(fileobj=io.BytesIO(content)) as tar:
                files = [_Packed(one.name, one.size, one) for one in tar.getmembers() if one.isfile()]
                yield from _unpacked(path, files, lambda one: _read(tar, one), chosen)
    except FileError:
        raise
    except _DAMAGED as error:
        reason = "it needs a password" if "encrypted" in str(error) else "it is damaged, or packed in an unknown way"
        message = f"{path}: cannot be unpacked: {reason}. Unpack it by its own program, and read the folder"
        raise FileError(message) from error


class _Packed(NamedTuple):
    name: str
    size: int
    entry: Any


_DAMAGED = (zipfile.BadZipFile, tarfile.TarError, zlib.error, EOFError, OSError, RuntimeError, NotImplementedError)


def _unpacked(path: Path, files: list[_Packed], read: Callable[[Any], bytes], chosen: Choice) -> Iterator[Member]:
    places = {_place(path, one.name): one for one in sorted(files, key=lambda one: one.name)}
    wanted = [place for place in chosen(list(places)) if "__MACOSX" not in place.parts]
    size = sum(places[place].size for place in wanted)
    if size > _LARGEST:
        raise FileError(f"{path}: unpacks to {size / 2**30:.1f} GiB. Unpack the files that are needed into a folder")
    for place in wanted:
        yield place, read(places[place].entry)


def _place(path: Path, name: str) -> Path:
    return path.joinpath(*(part for part in PurePosixPath(name.replace("\\", "/")).parts if part not in ("/", "..")))


def _read(archive: tarfile.TarFile, member: tarfile.TarInfo) -> bytes:
    file = archive.extractfile(member)
    return b"" if file is None else file.read()


def is_workbook(content: bytes) -> bool:
    """Return whether a container is an Excel workbook."""
    if not content.startswith(ZIP):
        return False
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            return _WORKBOOK in archive.namelist()
    except zipfile.BadZipFile:
        return False


def _sheets(path: Path, content: bytes, chosen: Choice) -> Iterator[Member]:
    """Yield the sheets of a workbook as text, one line for each row, fields between semicolons."""
    try:
        import openpyxl
    except ImportError:
        raise UnsupportedError(
            f'{path}: an Excel workbook. To read it, install openpyxl: pip install "stylobate[excel]"; or save its '
            "sheet as CSV"
        ) from None
    try:
        book = openpyxl.load_workbook(io.BytesIO(content), read_only=True, data_only=True)
        named = {path / sheet.title: sheet for sheet in book.worksheets}
        sheets = [(one, _rows(named[one])) for one in chosen(named)]
        formulas = [(one, _uncomputed(content, named[one])) for one, _ in sheets]
    except Exception as error:  # openpyxl's reader raises exceptions of any type for damaged workbooks
        raise FileError(f"{path}: openpyxl cannot read it: its content is damaged. Save it again in Excel") from error
    for place, cells in formulas:
        if cells:
            raise FileError(
                f"{place}: formulas were never computed (got {shortened(cells)}). "
                "Open the workbook in a spreadsheet program, and save it again"
            )
    for place, rows in sheets:
        margin = min((_first(row) for row in rows if _first(row) < len(row)), default=0)
        lines = [";".join(_written(value) for value in _shown(row[margin:])) for row in rows]
        yield place, "\n".join(lines).encode()


def _rows(sheet: Any) -> list[list[Any]]:
    """Return the values of a sheet; its stated size may be out of date."""
    sheet.reset_dimensions()
    return [list(row) for row in sheet.iter_rows(values_only=True)]


def _uncomputed(content: bytes, sheet: Any) -> list[str]:
    """Return the cells whose formula has no value: programs other than spreadsheets write such cells."""
    from openpyxl.xml.functions import iterparse

    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        text = archive.read(sheet._worksheet_path)  # noqa: SLF001  openpyxl has no name for the file of a sheet
    found = []
    for _, element in iterparse(io.BytesIO(text)) if _FORMULA.search(text) else ():
        kind = element.tag.rpartition("}")[2]
        if kind == "c":
            parts = {one.tag.rpartition("}")[2]: one.text for one in element}
            # Of a formula that gives the empty text, the value is empty too.
            empty = "f" in parts and not parts.get("v") and element.get("t") != "str"
            found += [element.get("r", "?")] if empty else []
        if kind == "row":
            element.clear()  # a large sheet would take memory
    return found


def _first(row: list[Any]) -> int:
    """Return the place of the first cell that is not empty."""
    return next((place for place, value in enumerate(row) if value is not None), len(row))


def _shown(row: list[Any]) -> list[Any]:
    """Return a row without empty cells at its end."""
    return row[: max((place for place, value in enumerate(row, start=1) if value is not None), default=0)]


def _written(value: Any) -> str:
    if value is None:
        return ""
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return repr(float(value))
    return " ".join(str(value).replace(";", ",").split())
