"""What a workbook holds beside the cells of one sheet: merged cells, and other sheets."""

import io
import re
import warnings
import zipfile
from typing import NamedTuple

from stylobate.records.containers import sheet_name

_MERGED = re.compile(rb"<(?:\w+:)?mergeCell\b[^>]*\bref=\"([A-Z]+(\d+):[A-Z]+(\d+))\"")


class Merged(NamedTuple):
    """Merged cells of a sheet, such as "C2:C3", and the numbers of their rows."""

    cells: str
    rows: range


class Beside(NamedTuple):
    """Merged cells of a sheet, and the names of the other sheets that are not empty."""

    merged: tuple[Merged, ...]
    others: tuple[str, ...]


def beside(content: bytes, name: str | None) -> Beside:
    """List merged cells of the sheet of this name, by default the first, and the other sheets of the workbook.

    The content is that of a workbook whose sheets have been read, so that its size and parts are known to be harmless.
    """
    import openpyxl

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # about parts that hold no cells
        book = openpyxl.load_workbook(io.BytesIO(content), read_only=True, keep_links=False)
    named = {sheet_name(one.title): one for one in book.worksheets}
    read = next(iter(named)) if name is None else name
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        # openpyxl lists merged cells only where it keeps all cells in memory, and has no name for the file of a sheet.
        text = archive.read(named[read]._worksheet_path)  # noqa: SLF001
    merged = [Merged(cells.decode(), range(int(first), int(last) + 1)) for cells, first, last in _MERGED.findall(text)]
    others = [one for one, sheet in named.items() if one != read and any(map(any, sheet.iter_rows(values_only=True)))]
    return Beside(tuple(sorted(merged, key=lambda one: one.rows.start)), tuple(others))
