"""Rows of tables of objects as text: CSV files as spreadsheets write them, workbooks, and GeoPackages."""

import csv
import re
import warnings
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import NamedTuple, Self

from stylobate.earthquakes.inventories.geopackages import read_layer
from stylobate.earthquakes.inventories.headings import count_of_known
from stylobate.earthquakes.inventories.sheets import Merged, beside
from stylobate.errors import FileError, UnlikelyInputWarning
from stylobate.files import file_of, unmarked
from stylobate.records.containers import is_container, is_workbook, members
from stylobate.records.contents import Allowance, read_bytes, require_readable
from stylobate.records.text_files import Text
from stylobate.text import shortened

_GEOPACKAGE = ".gpkg"
_SEPARATORS = ";\t,"
_WHOLE = re.compile(r"-?\d+\.0")
# Titles above the headings have fewer lines.
_DEEPEST = 30
# Two names in a row are not by chance.
_FEWEST_NAMES = 2


class Row(NamedTuple):
    """A row of a table: its number, its cells by heading, and its geometry as well-known binary."""

    number: int
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
        Faults of the whole table, such as merged cells, each with its remedy.
    row_problems
        The fault of each row that does not fit the headings.
    of_merged
        Numbers of the rows with merged cells, some of which are therefore empty.
    crs
        Coordinate reference system of the geometries; empty without one.
    """

    path: Path
    headings: tuple[str, ...]
    rows: tuple[Row, ...]
    problems: tuple[str, ...] = ()
    row_problems: tuple[tuple[int, str], ...] = ()
    of_merged: frozenset[int] = frozenset()
    crs: str = ""

    @classmethod
    def read(cls, path: Path) -> Self:
        """Read a CSV file, a workbook (its first sheet, or FILE.xlsx/SHEET), or a GeoPackage.

        Lines above the headings, such as titles, are left out with a warning, and so are other sheets of a workbook.

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
                found = cls._of_sheet(path, file, content, allowance)
            else:
                found = cls._of_text(Text.of(path, content))
        if not found.rows and not found.row_problems:
            raise FileError(f"{path}: the table has no rows. Write one object in each row, below the headings.")
        return found

    @classmethod
    def _of_sheet(cls, path: Path, file: Path, content: bytes, allowance: Allowance) -> Self:
        """Read a sheet of a workbook, or a file of an archive."""
        text = _first(path, file, content, allowance)
        if not is_workbook(content):
            return cls._of_text(text)
        sheet = beside(content, None if path == file else path.name)
        if path == file and sheet.others:
            _warn(
                f"{path}: only its first sheet is read (others are {', '.join(map(repr, sheet.others))}). "
                f"Name another one, such as {path / sheet.others[0]}."
            )
        return cls._of_text(text, sheet.merged)

    @classmethod
    def _of_text(cls, text: Text, merged: Sequence[Merged] | None = None) -> Self:
        """Read separated values; those of a sheet have no quotation marks, and whole numbers lose their decimals."""
        lines = [f"{line}\n" if line.strip() else "\n" for line in text.lines]
        start = next((at for at, line in enumerate(lines) if line.strip() and not line.startswith("#")), None)
        if start is None:
            raise FileError(f"{text.path}: no headings. Write the names of the columns in the first line.")
        of_sheet = merged is not None
        separator, at = _layout(text.path, lines, start, of_sheet=of_sheet)
        records = list(_records(text.path, lines, start, separator, of_sheet=of_sheet))
        headings = [" ".join(one.split()) for one in next(cells for number, cells in records if number == at)]
        while headings and not headings[-1]:
            headings.pop()
        _warn_of_titles(text.path, [(number, cells) for number, cells in records if number < at])
        below = [(number, cells) for number, cells in records if number > at and any(cells)]
        remedy = "Write decimal points, or put semicolons between the columns." if separator == "," else ""
        ill = [
            (number, f"{len(cells)} cells, but {len(headings)} headings. {remedy or 'Correct the row.'}")
            for number, cells in below
            if any(cells[len(headings) :])
        ]
        bad = {number for number, _ in ill}
        rows = [
            Row(number, dict(zip(headings, [*cells, *[""] * (len(headings) - len(cells))], strict=False)))
            for number, cells in below
            if number not in bad
        ]
        problems = [*_unmerged(merged or (), at), *_ill_headed(headings, below)]
        of_merged = frozenset(number for one in merged or () for number in one.rows)
        return cls(text.path, tuple(headings), tuple(rows), tuple(problems), tuple(ill), of_merged)

    @classmethod
    def _of_geopackage(cls, path: Path) -> Self:
        layer = read_layer(path)
        rows = tuple(
            Row(number, dict(zip(layer.headings, cells, strict=True)), shape)
            for number, (shape, cells) in enumerate(layer.rows, start=1)
        )
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


def _layout(path: Path, lines: Sequence[str], start: int, *, of_sheet: bool) -> tuple[str, int]:
    """Return the separator, and the number of the row of headings: that with the most known names near the top."""
    separators = ";" if of_sheet else _SEPARATORS
    known, before, separator = max(
        (count_of_known(cells), -number, separator)
        for separator in separators
        for number, cells in islice(_records(path, lines, start, separator, of_sheet=of_sheet), _DEEPEST)
    )
    if known >= _FEWEST_NAMES:
        return separator, -before
    separator = max(separators, key=lines[start].count)
    return separator, next(_records(path, lines, start, separator, of_sheet=of_sheet))[0]


def _records(
    path: Path, lines: Sequence[str], start: int, separator: str, *, of_sheet: bool
) -> Iterator[tuple[int, list[str]]]:
    """Yield the number and the cells of each row."""
    below = lines[start:]
    reader = (
        csv.reader(below, delimiter=separator, quoting=csv.QUOTE_NONE)
        if of_sheet
        else csv.reader(below, delimiter=separator)
    )
    try:
        for cells in reader:
            plain = [one.replace("\N{NO-BREAK SPACE}", " ").strip() for one in cells]
            plain = plain if of_sheet else list(map(unmarked, plain))
            if of_sheet:
                plain = [one.removesuffix(".0") if _WHOLE.fullmatch(one) else one for one in plain]
            yield start + reader.line_num, plain
    except csv.Error as error:
        raise FileError(f"{path}, row {start + reader.line_num}: {error}. Close the quotation marks.") from None


def _warn_of_titles(path: Path, rows: Iterable[tuple[int, list[str]]]) -> None:
    left_out = {number: " ".join(filter(None, cells)) for number, cells in rows if any(cells)}
    titles = {number: words for number, words in left_out.items() if not words.startswith("#")}
    if titles:
        got = ", ".join(f"row {number}: {words!r}" for number, words in titles.items())
        _warn(f"{path.name}: what stands above the headings is left out ({got}).")


def _unmerged(merged: Iterable[Merged], at: int) -> list[str]:
    ranges = [one.cells for one in merged if one.rows[-1] >= at]
    if not ranges:
        return []
    return [f"merged cells (got {shortened(ranges)}). Unmerge them, and fill each cell."]


def _ill_headed(headings: Sequence[str], rows: Sequence[tuple[int, list[str]]]) -> list[str]:
    """Return a line for each heading that stands twice, and for each column of cells without a heading."""
    twice = dict.fromkeys(one for one in headings if one and headings.count(one) > 1)
    problems = [f"two columns have the heading {heading!r}. Rename or remove one." for heading in twice]
    for place, heading in enumerate(headings):
        lost = [(number, cells[place]) for number, cells in rows if len(cells) > place and cells[place]]
        if not heading and lost:
            number, cell = lost[0]
            problems.append(
                f"column {place + 1} has no heading (got {cell!r} in row {number}). Write one, or empty its cells."
            )
    return problems


def _warn(message: str) -> None:
    warnings.warn(message, UnlikelyInputWarning, stacklevel=2)
