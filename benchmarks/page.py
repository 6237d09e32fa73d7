"""Put the measured tables into the page "Benchmarks" of the documentation; `make bench` ends with it.

Run as `python -m benchmarks.page`.

Each table stands on the page between the comments "table: NAME" and "end of table"; docs/_static/benchmarks/NAME.txt is
its source.
"""

import re
from pathlib import Path

PAGE = Path(__file__).parents[1] / "docs" / "results" / "benchmarks.md"
TABLES = PAGE.parents[1] / "_static" / "benchmarks"
_PLACE = re.compile(r"<!-- table: ([\w-]+) -->\n.*?<!-- end of table -->", re.DOTALL)


def names(page: str) -> list[str]:
    """Return the names of the tables of a page, in their order."""
    return _PLACE.findall(page)


def with_tables(page: str) -> str:
    """Return the page with each table as it was last measured."""
    return _PLACE.sub(_table, page)


def _table(place: re.Match[str]) -> str:
    text = (TABLES / f"{place[1]}.txt").read_text(encoding="utf-8").strip()
    return f"<!-- table: {place[1]} -->\n\n{text}\n\n<!-- end of table -->"


if __name__ == "__main__":
    PAGE.write_text(with_tables(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
    print(f"written: {PAGE}")
