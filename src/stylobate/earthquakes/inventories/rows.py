"""Rows of tables of objects as text: CSV files as spreadsheets write them, workbooks, and GeoPackages."""

import csv
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple, Self

from stylobate.earthquakes.inventories.geopackages import read_layer
from stylobate.errors import FileError
from stylobate.files import file_of, unmarked
from stylobate.records.containers import is_container, members
from stylobate.records.contents import Allowance, read_bytes, require_readable
from stylobate.records.text_files import Text

_GEOPACKAGE = ".gpkg"
_SEPARATORS = ";\t,"
_WHOLE = re.compile(r"-?\d+\.0")


class Row(NamedTuple):
    """A row of a table: its place, its cells by heading, and its geometry as well-known binary."""

    place: str
    cells: Mapping[str, str]
    geometry: bytes = b""


@dataclass(frozen=True, slots=True)
class ObjectTable:
    """The rows of a table of objects as text.

    Parameters
    ----------
    path
        The file, for messages.
    headings
        Headings of the columns.
    rows
        The rows that are not empty.
    problems
        A line for each row that does not fit the headings.
    crs
        Coordinate reference system of the geometries; empty without one.
    """

    path: Path
    headings: tuple[str, ...]
    rows: tuple[Row, ...]
    problems: tuple[str, ...] = ()
    crs: str = ""

    @classmethod
    def read(cls, path: Path) -> Self:
        """Read a CSV file, a workbook (its first sheet, or FILE.xlsx/SHEET), or a GeoPackage.

        Raises
        ------
        FileError
            If the file cannot be read, or has no heading or no row.
        UnsupportedError
            If it is a workbook, and openpyxl is not installed.
        """
        file = file_of(path)
        if file.suffix.lower() == _GEOPACKAGE:
            found = cls._of_geopackage(path)
        else:
            allowance = Allowance()
            content = read_bytes(file, allowance)
            require_readable(file, content)
            if is_container(content):
                found = cls._of_text(_first(path, file, content, allowance), whole=_WHOLE)
            else:
                found = cls._of_text(Text.of(path, content))
        if not found.rows and not found.problems:
            raise FileError(f"{path}: the table has no rows. Write one object in each row, below the headings.")
        return found

    @classmethod
    def _of_text(cls, text: Text, whole: re.Pattern[str] | None = None) -> Self:
        """Read separated values; of a workbook `whole` numbers lose their decimals."""
        lines = [line if line.strip() else "" for line in text.lines]
        begin = next((at for at, line in enumerate(lines) if line and not line.startswith("#")), None)
        if begin is None:
            raise FileError(f"{text.path}: no headings. Write the names of the columns in the first line.")
        separator = max(_SEPARATORS, key=lines[begin].count)
        reader = csv.reader([f"{line}\n" for line in lines[begin:]], delimiter=separator)
        read = unmarked if whole is None else str
        headings = [read(heading.strip()) for heading in next(reader)]
        while headings and not headings[-1]:
            headings.pop()
        rows: list[Row] = []
        problems: list[str] = []
        for cells in reader:
            place = f"{text.path.name}, row {begin + reader.line_num}"
            plain = [read(one.replace("\N{NO-BREAK SPACE}", " ").strip()) for one in cells]
            if whole is not None:
                plain = [one.removesuffix(".0") if whole.fullmatch(one) else one for one in plain]
            if not any(plain):
                continue
            if any(plain[len(headings) :]):
                remedy = "Write decimal points, or put semicolons between the columns." if separator == "," else ""
                problems.append(
                    f"{place}: {len(plain)} cells, but {len(headings)} headings. {remedy or 'Correct the row.'}"
                )
                continue
            plain += [""] * (len(headings) - len(plain))
            rows.append(Row(place, dict(zip(headings, plain, strict=False))))
        _require_distinct(text.path, headings)
        return cls(text.path, tuple(headings), tuple(rows), tuple(problems))

    @classmethod
    def _of_geopackage(cls, path: Path) -> Self:
        layer = read_layer(path)
        rows = tuple(
            Row(f"{path.name}, row {place}", dict(zip(layer.headings, cells, strict=True)), shape)
            for place, (shape, cells) in enumerate(layer.rows, start=1)
        )
        _require_distinct(path, layer.headings)
        return cls(path, layer.headings, rows, crs=layer.crs)


def _first(path: Path, file: Path, content: bytes, allowance: Allowance) -> Text:
    """Return the named sheet of a workbook, or file of an archive, or the first one."""
    listed: list[Path] = []

    def chosen(places: Iterable[Path]) -> list[Path]:
        listed.extend(places)
        return listed[:1] if path == file else [one for one in listed if one == path]

    found = next(members(file, content, chosen, allowance), None)
    if found is None:
        raise FileError(f"{path}: no such sheet. Choose from {', '.join(one.name for one in listed)}.")
    place, text = found
    return Text.of(file if path == file else place, text)


def _require_distinct(path: Path, headings: Sequence[str]) -> None:
    for place, heading in enumerate(headings):
        if heading in headings[:place]:
            raise FileError(f"{path}: two columns have the heading {heading!r}. Rename or remove one.")
