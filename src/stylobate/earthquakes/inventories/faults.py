"""Faults of a table of objects: one pass collects all, and each has one line with row, column, value and remedy."""

from dataclasses import dataclass, field

from stylobate.text import shortened

# More lines on one column say nothing new.
_MOST_OF_COLUMN = 12


@dataclass(slots=True)
class Faults:
    """Faults of a table, collected in one pass.

    Parameters
    ----------
    table
        Name of the table, for messages.
    """

    table: str
    _of_table: dict[str, None] = field(default_factory=dict)
    _of_rows: dict[tuple[str, str], list[int]] = field(default_factory=dict)

    def __len__(self) -> int:
        return len(self._of_table) + sum(map(len, self._of_rows.values()))

    def add(self, text: str) -> None:
        """Add a fault of the whole table."""
        self._of_table[f"{self.table}: {text}"] = None

    def add_heading(self, heading: str, text: str) -> None:
        """Add a fault of a heading."""
        self._of_table[f"{self.table}, heading {heading!r}: {text}"] = None

    def add_line(self, line: str) -> None:
        """Add a fault of something else, such as the defaults."""
        self._of_table[line] = None

    def add_cell(self, row: int, column: str, text: str) -> None:
        """Add a fault of a cell, or of a row for the column ""; rows with the same fault have one line."""
        rows = self._of_rows.setdefault((column, text), [])
        if row not in rows[-1:]:
            rows.append(row)

    def lines(self) -> list[str]:
        """Return a line for each fault: those of the table first, then by row; long lists are cut with their count."""
        lines = list(self._of_table)
        by_column: dict[str, list[tuple[int, str]]] = {}
        for (column, text), rows in self._of_rows.items():
            where = f"{self.table}, {'row' if len(rows) == 1 else 'rows'} {shortened(rows)}"
            by_column.setdefault(column, []).append((rows[0], f"{where}{column and f', {column}'}: {text}"))
        shown = [one for own in by_column.values() for one in sorted(own)[:_MOST_OF_COLUMN]]
        lines += [line for _, line in sorted(shown)]
        for column, own in by_column.items():
            more = len(own) - _MOST_OF_COLUMN
            if more > 0:
                lines.append(f"{self.table}{column and f', {column}'}: and {more} more lines on this column.")
        return lines
