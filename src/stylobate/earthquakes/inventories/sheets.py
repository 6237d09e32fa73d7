"""What a workbook holds beside the cells of one sheet: merged cells, and other sheets."""

import io
import warnings
from typing import NamedTuple


class Merged(NamedTuple):
    """Merged cells of a sheet, such as "C2:C3", and the numbers of their rows."""

    cells: str
    rows: range


class Beside(NamedTuple):
    """Merged cells of a sheet, and the names of the other sheets that are not empty."""

    merged: tuple[Merged, ...]
    others: tuple[str, ...]


def beside(content: bytes, title: str | None) -> Beside:
    """List merged cells of the sheet of this title, by default the first, and the other sheets of the workbook."""
    import openpyxl

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # about parts that hold no cells
        book = openpyxl.load_workbook(io.BytesIO(content))
    read = book.worksheets[0] if title is None else book[title]
    merged = [Merged(one.coord, range(one.min_row, one.max_row + 1)) for one in read.merged_cells.ranges]
    others = [
        one.title for one in book.worksheets if one is not read and any(map(any, one.iter_rows(values_only=True)))
    ]
    return Beside(tuple(sorted(merged, key=lambda one: one.rows.start)), tuple(others))
