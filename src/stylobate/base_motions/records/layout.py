"""Layout of a text table: decimal sign, column separator and header lines."""

import csv
import io
import itertools
import re
from dataclasses import dataclass, replace

from stylobate.base_motions.records.lines import REMARKS, Text, is_number
from stylobate.base_motions.records.units import unit_of

_BETWEEN = re.compile(r"[;,\s]+")
_LEADING_ZERO = re.compile(r"[-+]?0\d")
_WITHOUT_POINT = re.compile(r"[-+]?\d*,\d+(?:[EeDd][-+]?\d+)?|[-+]?\d+(?:[EeDd][-+]?\d+)?")
_BRACKETED = re.compile(r"[\[(][^\])]*[\])]")
_WORD = re.compile(r"[^\s\[(]+(?:\s*[\[(][^\])]*[\])])?|[\[(][^\])]*[\])]")
_DIGITS = re.compile(r"[-+]?\.?\d")
_HAS_LETTER = re.compile(r"[^\W\d_]")
_WIDE_SPACE = re.compile(r"\s{2,}")
_RULE = re.compile(r"[-=_+|\s]+")
TIMES = ("time", "t", "zeit", "temps", "tempo", "tiempo")
"""Names of a column of times, in small letters."""
_WRITE_POINTS = "Write decimal points, or put semicolons between the columns"

Rows = list[tuple[int, str]]


@dataclass(frozen=True, slots=True)
class PlainTable:
    """A table with decimal points; the line of names, if any, is the first line that is no comment."""

    text: Text
    named: bool


def plain_table(text: Text, *, named: bool = False) -> PlainTable:
    """Rewrite a text table with decimal points and without lines above its names; line numbers stay.

    Parameters
    ----------
    text
        The file. Commas are decimal if no number has a point and semicolons, tabs or spaces separate the columns. Lines
        of words above the first line of numbers are a header: titles, names, units in brackets.
    named
        Whether the last line of the header must hold names, one for each column.

    Raises
    ------
    FileError
        If commas may be decimal signs or column separators.
    """
    lines = [(at, line) for at, line in enumerate(text.lines) if line.strip() and not line.lstrip().startswith(REMARKS)]
    begin = next((place for place, (_, line) in enumerate(lines) if _is_row(line)), None)
    if begin is None:
        return PlainTable(text, named=False)
    header, body = lines[:begin], lines[begin:]
    if has_decimal_commas(text, body):
        body = [(at, line.replace(",", ".")) for at, line in body]
    separator = next((sign for sign in ";," if sign in body[0][1]), None)
    width = len(_fields(body[0][1], separator))
    words = [(at, line) for at, line in header if not _RULE.fullmatch(line)]
    names = _names([line for _, line in words], width, separator, named=named) if words else None
    unnamed_csv = names is None and separator is not None and any(separator in line for _, line in words)
    if unnamed_csv or not all(_is_header(line, width) for _, line in words):
        return PlainTable(text, named=False)
    changed = dict(body)
    if names is not None:
        changed = {at: ",".join(_fields(line, separator)) for at, line in body}
        changed[words[-1][0]] = _csv_line(names)
    above = range(body[0][0])
    lines_now = tuple(changed.get(at, "" if at in above else line) for at, line in enumerate(text.lines))
    return PlainTable(replace(text, lines=lines_now), named=names is not None)


def has_decimal_commas(text: Text, rows: Rows) -> bool:
    """Return whether the commas in rows of numbers, each with the index of its line, are decimal.

    Raises
    ------
    FileError
        If commas may be decimal signs or column separators, or some numbers have points.
    """
    with_commas = [(at, line) for at, line in rows if "," in line]
    if not with_commas:
        return False
    at, first = with_commas[0]
    if any("." in line and _is_row(line) for _, line in rows):
        if ";" in first:
            raise text.fault(at, f"a decimal comma beside decimal points, or commas beside semicolons. {_WRITE_POINTS}")
        return False
    rows = [(at, line) for at, line in with_commas if _is_row(line)]
    if not rows:
        return False
    at, first = rows[0]
    tokens = [token for _, line in rows for token in re.split(r"[;\s]+", line.strip()) if token]
    if (";" in first or len(first.split()) > 1) and all(map(_WITHOUT_POINT.fullmatch, tokens)):
        return True
    pieces = [_pieces(line) for _, line in rows]
    times = [float(row[0]) for row in pieces]
    running = all(before < after for before, after in itertools.pairwise(times))
    zeros = any(_LEADING_ZERO.match(piece) for row in pieces for piece in row[1:])
    single = len(tokens) == len(rows) and all(map(_WITHOUT_POINT.fullmatch, tokens))
    if single and zeros and not running:  # two columns of whole numbers never look like this
        return True
    if zeros or (single and not running):
        raise text.fault(at, f"a decimal comma, or a comma between columns: {first.strip()[:40]!r}. {_WRITE_POINTS}")
    return False


def _pieces(line: str) -> list[str]:
    return [piece for piece in _BETWEEN.split(line.strip()) if piece]


def _is_row(line: str) -> bool:
    pieces = _pieces(line)
    return bool(pieces) and all(map(is_number, pieces))


def _is_header(line: str, width: int) -> bool:
    """Return whether a line above the numbers is a header and not a faulty row of numbers."""
    pieces = _pieces(line)
    spoilt = len(pieces) == width and any(map(_DIGITS.match, pieces))
    return bool(_HAS_LETTER.search(line)) and not spoilt


def _fields(line: str, separator: str | None) -> list[str]:
    """Split a line into fields; `separator` None is white space. Trailing separators do not count."""
    fields = [field.strip() for field in line.split(separator)]
    while fields and not fields[-1]:
        fields.pop()
    return fields


def _names(header: list[str], width: int, separator: str | None, *, named: bool) -> list[str] | None:
    """Return the names of the columns with their units in brackets; None if the header has no names."""
    names = _header_fields(header[-1], width, separator)
    if names and len(header) > 1 and all(map(_BRACKETED.fullmatch, names)):
        above = _header_fields(header[-2], width, separator)
        names = [f"{name} {unit}" for name, unit in zip(above, names, strict=True)] if above else names
    if not names:
        return None
    units = [unit_of(found[0][1:-1]) for found in map(_BRACKETED.search, names) if found]
    if width == 1:
        return names if named or any(units) else None
    certain = named or separator is not None or "\t" in header[-1] or width > 2  # noqa: PLR2004  time, acceleration
    return names if certain or units or names[0].lower() in TIMES else None


def _header_fields(line: str, width: int, separator: str | None) -> list[str] | None:
    quoted = next(csv.reader([line], delimiter=separator)) if separator else []
    while quoted and not quoted[-1].strip():
        quoted.pop()
    plain = line.strip()
    splits = [[field.strip() for field in quoted], _fields(plain, "\t"), _WIDE_SPACE.split(plain), _WORD.findall(plain)]
    return next((fields for fields in splits if len(fields) == width), None)


def _csv_line(fields: list[str]) -> str:
    line = io.StringIO()
    csv.writer(line, lineterminator="").writerow(fields)
    return line.getvalue()
