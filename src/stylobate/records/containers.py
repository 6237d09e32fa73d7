"""Files that hold files: zip and tar archives, and workbooks, of which each sheet is a table of text."""

import io
import re
import tarfile
import warnings
import zipfile
import zlib
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import IO, Any, NamedTuple

from stylobate.errors import FileError, require_extra
from stylobate.records.contents import DECLARES_TYPES, LONGEST_TEXT, Allowance, xml_root
from stylobate.text import shortened

Member = tuple[Path, bytes]
"""A file in a container: its path, below that of the container, and its content."""

Choice = Callable[[Iterable[Path]], Iterable[Path]]
"""Chooses among the paths of the files in a container."""

ZIP = b"PK\x03\x04"
"""First bytes of zip archives and workbooks."""

_ENTRY = b"PK\x01\x02"
"""First bytes of the entry of a file in the list at the end of a zip archive."""

_WORKBOOK, _TYPES = "xl/workbook.xml", "[Content_Types].xml"
_TYPE_OF_WORKBOOK = re.compile(rb'"application/vnd\.(?:openxmlformats-[^"]*|ms-excel[^"]*)\.main\+xml"')
_FORMULA = re.compile(rb"<(\w+:)?f[\s/>]")
_TAR, _TAR_AT = b"ustar", 257
# Zip archives of records are stored or deflated. The other methods may ask for gigabytes before they unpack a byte.
_METHODS = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)

_LONGEST_NAME = 100
_UNFIT = re.compile(r"[\x00-\x1f\x7f-\x9f\u2028\u2029\ud800-\udfff]")

MOST_ROWS, MOST_CELLS = 1 << 20, 1 << 24
"""Rows of a sheet in Excel; cells of a sheet, the empty ones before the last of a row included."""
LARGEST_WORKBOOK = 2 * LONGEST_TEXT
"""Bytes of all parts of a workbook; a million rows of four numbers have 190 MiB."""


def is_container(content: bytes) -> bool:
    """Return whether a file holds files."""
    return content.startswith(ZIP) or content[_TAR_AT : _TAR_AT + len(_TAR)] == _TAR


def members(path: Path, content: bytes, chosen: Choice, allowance: Allowance | None = None) -> Iterator[Member]:
    """Yield the files in an archive, in the order of their names, or the sheets of a workbook.

    Parameters
    ----------
    path, content
        The container.
    chosen
        Function that chooses among the paths of the files; only these are unpacked.
    allowance
        What the container may unpack to; it counts as open until the last file has been taken. None is the whole.

    Raises
    ------
    FileError
        If the container is damaged, needs a password, or holds more than allowed.
    UnsupportedError
        If it is a workbook, and openpyxl is not installed.
    """
    allowance = Allowance() if allowance is None else allowance
    with allowance.inside(path):
        try:
            if not content.startswith(ZIP):
                yield from _in_tar(path, content, chosen, allowance)
                return
            allowance.take_files(path, content.count(_ENTRY))
            with zipfile.ZipFile(io.BytesIO(content)) as archive:
                entries = archive.infolist()
                if _states_workbook(archive):
                    _require_plain_workbook(path, archive, allowance)
                    yield from _sheets(path, content, chosen)
                else:
                    files = [_Packed(one.filename, one.file_size, one) for one in entries if not one.is_dir()]
                    yield from _unpacked(path, files, lambda one: _open(archive, one), chosen, allowance)
        except _DAMAGED as error:
            reason = (
                "it needs a password" if "encrypted" in str(error) else "it is damaged, or packed in an unknown way"
            )
            message = f"{path}: cannot be unpacked: {reason}. Unpack it by its own program, and read the folder"
            raise FileError(message) from error


class _Packed(NamedTuple):
    name: str
    size: int
    entry: Any


_DAMAGED = (
    zipfile.BadZipFile,
    tarfile.TarError,
    zlib.error,
    EOFError,
    OSError,
    RuntimeError,
    NotImplementedError,
    ValueError,
    OverflowError,
)
"""Errors of Python's readers of archives; that of tar raises a ValueError for some headers."""


def _in_tar(path: Path, content: bytes, chosen: Choice, allowance: Allowance) -> Iterator[Member]:
    with tarfile.open(fileobj=io.BytesIO(content), mode="r:") as tar:
        files = []
        for one in tar:
            allowance.take_files(path, 1)
            if one.isfile():
                files.append(_Packed(one.name, one.size, one))
        yield from _unpacked(path, files, tar.extractfile, chosen, allowance)


def _open(archive: zipfile.ZipFile, entry: zipfile.ZipInfo) -> IO[bytes]:
    if entry.compress_type not in _METHODS:
        raise NotImplementedError(f"method {entry.compress_type}")
    return archive.open(entry)


def _unpacked(
    path: Path,
    files: list[_Packed],
    open_file: Callable[[Any], IO[bytes] | None],
    chosen: Choice,
    allowance: Allowance,
) -> Iterator[Member]:
    places = {_place(path, one.name): one for one in sorted(files, key=lambda one: one.name)}
    wanted = [place for place in chosen(list(places)) if "__MACOSX" not in place.parts]
    # Too much is refused before anything is unpacked; whether the sizes are true shows when it is.
    Allowance(allowance.size).take(path, sum(places[place].size for place in wanted))
    for place in wanted:
        stream = open_file(places[place].entry)
        if stream is not None:
            with stream:
                content = allowance.read(place, stream)
            yield place, content


def _place(path: Path, name: str) -> Path:
    """Return the path of a file in a container, which lies below the container whatever the name is."""
    parts = [_UNFIT.sub("_", part).strip()[:_LONGEST_NAME] for part in re.split(r"[/\\]", name)]
    return path.joinpath(*([part for part in parts if part not in ("", ".", "..")] or ["_"]))


def is_workbook(content: bytes) -> bool:
    """Return whether a container is a workbook: an archive with its parts that states that it is one."""
    if not content.startswith(ZIP):
        return False
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            return _states_workbook(archive)
    except _DAMAGED:
        return False


def _states_workbook(archive: zipfile.ZipFile) -> bool:
    if not {_WORKBOOK, _TYPES} <= set(archive.namelist()):
        return False
    with _open(archive, archive.getinfo(_TYPES)) as stated:
        return _TYPE_OF_WORKBOOK.search(stated.read(1 << 20)) is not None


def _require_plain_workbook(path: Path, archive: zipfile.ZipFile, allowance: Allowance) -> None:
    """Refuse a workbook that is too large, or whose parts declare types of their own, as no program writes them."""
    size = sum(one.file_size for one in archive.infolist())
    if size > LARGEST_WORKBOOK:
        raise FileError(
            f"{path}: a workbook of more than {LARGEST_WORKBOOK >> 20} MiB when unpacked. Save the sheet that is "
            "needed as CSV"
        )
    allowance.take(path, size)
    for one in archive.infolist():
        with _open(archive, one) as part:
            if one.filename.endswith((".xml", ".rels")) and xml_root(part) == DECLARES_TYPES:
                raise FileError(f"{path}: {one.filename!r} declares types of its own. Save the workbook again in Excel")


def _sheets(path: Path, content: bytes, chosen: Choice) -> Iterator[Member]:
    """Yield the sheets of a workbook as text, one line for each row, fields between semicolons."""
    openpyxl = require_extra(
        "openpyxl",
        f'{path}: an Excel workbook. To read it, install openpyxl: pip install "stylobate[excel]"; or save its '
        "sheet as CSV",
    )
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # about parts that hold no cells
            book = openpyxl.load_workbook(io.BytesIO(content), read_only=True, data_only=True, keep_links=False)
            named = {path / sheet_name(sheet.title): sheet for sheet in book.worksheets}
            sheets = [(one, _rows(one, named[one])) for one in chosen(named)]
            formulas = [(one, _uncomputed(content, named[one])) for one, _ in sheets]
    except FileError:
        raise
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
        lines = [";".join(_written(value) for value in row[margin:]) for row in rows]
        yield place, "\n".join(lines).encode(errors="replace")


def sheet_name(title: str) -> str:
    """Return the title of a sheet as one part of a path, which is not that of a hidden file."""
    return _place(Path(), re.sub(r"[/\\]", "_", title)).name.lstrip(".") or "_"


def _rows(place: Path, sheet: Any) -> list[list[Any]]:
    """Return the rows of a sheet without the empty cells at their ends."""
    rows: list[list[Any]] = []
    cells = 0
    sheet.reset_dimensions()  # stated by the program that wrote it, perhaps before the last rows were added
    for row in sheet.iter_rows(values_only=True):
        cells += len(row)
        if len(rows) == MOST_ROWS or cells > MOST_CELLS:
            raise FileError(
                f"{place}: more than {MOST_ROWS} rows, or {MOST_CELLS} cells. Save the rows that are needed as CSV"
            )
        rows.append(_shown(row))
    return rows


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


def _shown(row: Iterable[Any]) -> list[Any]:
    """Return a row without empty cells at its end."""
    cells = list(row)
    while cells and cells[-1] is None:
        cells.pop()
    return cells


def _written(value: Any) -> str:
    if value is None:
        return ""
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return repr(float(value))
    return " ".join(str(value).replace(";", ",").split())
