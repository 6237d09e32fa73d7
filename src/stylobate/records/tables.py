"""Tables of numbers in text files, as spreadsheets and other programs write them: layout, names and units.

A table has lines of header (titles, names of columns, units in brackets) and rows of fields between commas, semicolons,
tabs or spaces. Lines that begin with #, %, ! or // are comments.
"""

import csv
import itertools
import re
from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from stylobate.base_motions.record import AXES
from stylobate.base_motions.signal_processing import Floats
from stylobate.errors import FileError
from stylobate.records.contents import NoRecordError
from stylobate.records.directions import Component, Directed, Direction, along_axes, is_one_set, split_name
from stylobate.records.text_files import (
    REMARKS,
    SECOND,
    Text,
    TimeUnit,
    is_number,
    time_unit_of,
    unit_of,
    unknown_unit,
)
from stylobate.records.time_steps import equal_steps, require_two

# Names of a column of times, in small letters.
_TIMES = ("time", "t", "zeit", "temps", "tempo", "tiempo")
_ACCELERATION = ("acceleration", "accel", "acc", "a")
# Single letters that are a velocity, a length, a time or a radius unless they fit the directions of other columns.
_UNSURE = ("v", "l", "t", "r")
_AXIS_NAMES = {name for axis in AXES for name in (axis, f"a{axis}")}
_TIME_AND_ACCELERATION = 2

_BETWEEN = re.compile(r"[;,\s]+")
_LEADING_ZERO = re.compile(r"[-+]?0\d")
_WITHOUT_POINT = re.compile(r"[-+]?\d*,\d+(?:[EeDd][-+]?\d+)?|[-+]?\d+(?:[EeDd][-+]?\d+)?")
# The innermost brackets: a search for closing ones beyond other opening ones takes long in a line of opening ones.
_BRACKETED = re.compile(r"[\[(][^\[\]()]*[\])]")
_WORD = re.compile(rf"[^\s\[(]+(?:\s*{_BRACKETED.pattern})?|{_BRACKETED.pattern}")
_DIGITS = re.compile(r"[-+]?\.?\d")
_HAS_LETTER = re.compile(r"[^\W\d_]")
_WIDE_SPACE = re.compile(r"\s{2,}")
_RULE = re.compile(r"[-=_+|\s]+")
NAME_AND_UNIT = re.compile(r"(?P<name>[^\[(]*)(?:[\[(](?P<unit>[^\])]*)[\])]\s*)?")
"""The name of a column with the blanks around it, and its unit in brackets; no two parts fit the same blanks."""
_WRITE_POINTS = "Write decimal points, or put semicolons between the columns"

Line = tuple[int, str]
"""A line and its index in the file."""


@dataclass(frozen=True, slots=True)
class TextTable:
    """Rows of fields with decimal points, each with the index of its line, below names and other lines of header.

    `names` are the names of the columns with their units in brackets, in the line at `names_at`; None without names.
    """

    text: Text
    rows: list[tuple[int, list[str]]]
    names: list[str] | None = None
    names_at: int = 0

    @classmethod
    def of(cls, text: Text, *, named: bool = False) -> "TextTable":
        """Find the rows and names of a text table.

        Parameters
        ----------
        text
            The file. Commas are decimal if no number has a point and semicolons, tabs or spaces separate the columns.
            Lines of words above the first line of numbers are a header.
        named
            Whether the last line of the header must hold names, one for each column.

        Raises
        ------
        FileError
            If commas may be decimal signs or column separators.
        """
        lines = [(at, line) for at, line in enumerate(text.lines) if line.strip()]
        lines = [(at, line) for at, line in lines if not line.lstrip().startswith(REMARKS)]
        begin = next((place for place, (_, line) in enumerate(lines) if _is_row(line)), len(lines))
        header, body = [one for one in lines[:begin] if not _RULE.fullmatch(one[1])], lines[begin:]
        if _has_decimal_commas(text, body):
            body = [(at, line.replace(",", ".")) for at, line in body]
        separator = next((sign for sign in ";," if body and sign in body[0][1]), None)
        width = len(_fields(body[0][1], separator)) if body else 0
        names = _names([line for _, line in header], width, separator, named=named) if header and body else None
        unnamed_csv = names is None and separator is not None and any(separator in line for _, line in header)
        if not body or unnamed_csv or not all(_is_header(line, width, separator) for _, line in header):
            return cls._with_names_in_first_line(text, lines, named=named)
        if names is None:
            return cls(text, [(at, _pieces(line)) for at, line in body])
        return cls(text, [(at, _fields(line, separator)) for at, line in body], names, header[-1][0])

    @classmethod
    def _with_names_in_first_line(cls, text: Text, lines: list[Line], *, named: bool) -> "TextTable":
        """Return a table of quoted fields or of spoilt rows, whose first line may hold names of columns."""
        first = lines[0][1] if lines else ""
        if not named and (not re.search(r"[,;]", first) or any(map(is_number, re.split(r"[,;]", first)))):
            return cls(text, [(at, _pieces(line)) for at, line in lines])
        between = ";" if first.count(";") > first.count(",") else ","
        rows = [(at, [cell.strip() for cell in next(csv.reader([line], delimiter=between))]) for at, line in lines]
        return cls(text, rows[1:], *rows[0][::-1]) if rows else cls(text, [])


def _has_decimal_commas(text: Text, rows: list[Line]) -> bool:
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


def _is_header(line: str, width: int, separator: str | None) -> bool:
    """Return whether a line above the numbers is a header and not a faulty row of numbers."""
    pieces = _pieces(line) if separator is None else _fields(line, separator)
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
    return names if certain or units or names[0].lower() in _TIMES else None


def _header_fields(line: str, width: int, separator: str | None) -> list[str] | None:
    quoted = next(csv.reader([line], delimiter=separator)) if separator else []
    while quoted and not quoted[-1].strip():
        quoted.pop()
    plain = line.strip()
    splits = [[field.strip() for field in quoted], _fields(plain, "\t"), _WIDE_SPACE.split(plain), _WORD.findall(plain)]
    return next((fields for fields in splits if len(fields) == width), None)


def has_rows_of_numbers(text: Text) -> bool:
    """Return whether a text has at least two lines of numbers only, as every table of a record has."""
    return sum(map(_is_row, text.lines)) > 1


def read_table(table: TextTable, step: float | None) -> Component:
    """Read a table without names: a column of accelerations, or times and accelerations along x, y and z.

    Raises
    ------
    FileError
        If a field is no number, rows differ in length, times are not in equal steps, or a single column lacks `step`
        [s].
    """
    text, rows = table.text, table.rows
    if table.names is not None:
        rows = [(table.names_at, table.names), *rows]
    if not rows:
        raise text.fault(len(text.lines) - 1, "the file has no numbers. Export it again")
    width = len(rows[0][1])
    if width > 1 + len(AXES):
        text.rows(rows[:1])
        what = "one (acceleration) to four (time, x, y, z) are expected. Name them in the first line"
        raise text.fault(rows[0][0], f"{width} columns: {what}")
    for at, row in rows:
        if len(row) != width:
            text.rows([(at, row)])
            raise text.fault(at, f"{len(row)} columns, the lines before have {width}. Correct the line")
    values = text.rows(rows)
    places = [at for at, _ in rows]
    if width == 1:
        if step is None:
            raise text.fault(places[0], "a single column has no time step: state step, in s")
        require_two(text, places)
        return Component(samples=values[:, 0], step=step, unit=None, states_time_unit=False)
    start, own = equal_steps(text, values[:, 0], places, step)
    if width == _TIME_AND_ACCELERATION:
        return Component(samples=values[:, 1], step=own, start=start, unit=None, states_time_unit=False)
    _require_no_integral(text, places[0], values[:, 1:], own)
    samples = np.pad(values[:, 1:], ((0, 0), (0, 1 + len(AXES) - width)))
    title = f"columns 2 to {width} as {', '.join(AXES[: width - 1])}"
    return Component(samples=samples, step=own, start=start, unit=None, title=title, states_time_unit=False)


# Correlation of a column with the integral of the one before from which it is taken for a velocity.
_ALIKE = 0.98


def _require_no_integral(text: Text, line: int, values: Floats, step: float) -> None:
    """Raise FileError if a column is the integral of the one before: velocity and displacement, no components."""
    for place in range(values.shape[1] - 1):
        before, after = values[:, place], values[:, place + 1]
        gained, own = step * np.cumsum(before), after - after.mean()
        gained = gained - gained.mean()
        size = float(np.linalg.norm(gained) * np.linalg.norm(own))
        if len(values) > _FEW and size > 0.0 and float(gained @ own) > _ALIKE * size:
            what = f"column {place + 3} looks like the integral of column {place + 2}, a velocity or displacement"
            raise text.fault(line, f"{what}. Name the columns in the first line, such as time, x and velocity")


_FEW = 20  # samples, of which a correlation shows nothing


def read_named_columns(table: TextTable, columns: Mapping[str, str] | None, step: float | None) -> Component:
    """Read the component or components of a table with names.

    Parameters
    ----------
    table
        The table, with names such as `time [s],x [m/s²],y [m/s²]`.
    columns
        Columns of "time", "x", "y", "z" by their names in the file, without units. None looks for columns with these
        names, for names of directions such as NS, EW and UD, or for one acceleration beside the time. A column named
        acceleration takes precedence over single letters, which may be a velocity V or a length L.
    step
        Time step [s]; needed only without a column of times.

    Raises
    ------
    FileError
        If the table has no names, a column is missing, units differ or are unknown, or a number is wrong.
    """
    text, first = table.text, table.names_at
    if table.names is None:
        raise text.fault(table.rows[0][0] if table.rows else 0, "no names of columns. Write them above the numbers")
    header = [NAME_AND_UNIT.fullmatch(name) for name in table.names]
    names = [found["name"].strip() if found else "" for found in header]
    units = [found["unit"] if found else None for found in header]
    chosen = _chosen(text, first, names, columns)
    for at, row in table.rows:
        if len(row) != len(names):
            raise text.fault(at, f"{len(row)} columns, the first line names {len(names)}. Correct the line")
    values = text.rows([(at, [row[place] for place in chosen.values()]) for at, row in table.rows])
    if not table.rows:
        raise text.fault(first, "the file has no numbers. Export it again")
    by_name = dict(zip(chosen, values.T, strict=True))
    start = 0.0
    clock = _time_unit(text, first, units[chosen["time"]]) if "time" in chosen else None
    if "time" in by_name:
        start, step = equal_steps(text, by_name["time"], [at for at, _ in table.rows], step, clock or SECOND)
    elif step is None:
        raise text.fault(first, "no column of times: state step, the time step in s")
    unit = _unit(text, first, {names[place]: units[place] for axis, place in chosen.items() if axis != "time"})
    samples, direction, title = _components(text, {name: by_name[name] for name in by_name if name != "time"})
    return Component(
        samples=samples,
        step=step,
        start=start,
        unit=unit,
        direction=direction,
        title=title,
        states_time_unit=clock is not None,
    )


def _components(text: Text, columns: Mapping[str, Floats]) -> tuple[Floats, Direction | None, str]:
    """Return accelerations of shape (n,) or (n, 3), the direction of a single one, and the origin of several."""
    axes, title = dict(columns), ""
    if not columns.keys() <= set(AXES):
        directed = [Directed(name, _direction(name) or Direction(), values) for name, values in columns.items()]
        if len(directed) == 1:
            return directed[0].samples, directed[0].direction, ""
        axes, title = along_axes(str(text.path), directed)
    if axes.keys() == {"x"}:
        return axes["x"], None, title
    rest = np.zeros_like(next(iter(columns.values())))
    return np.stack([axes.get(axis, rest) for axis in AXES], axis=-1), None, title


def _direction(name: str) -> Direction | None:
    """Return the direction that the name of a column states, such as NS or acc_NS."""
    return Direction.parse(name) or split_name(name)[1]


def _chosen(text: Text, line: int, names: list[str], columns: Mapping[str, str] | None) -> dict[str, int]:
    lower = [name.lower() for name in names]
    if columns is not None:
        for axis, name in columns.items():
            if axis not in ("time", *AXES) or name not in names:
                raise text.fault(line, f"no column {name!r} for {axis!r}: the columns are {', '.join(names)}")
        _require_distinct(text, line, [(name, name) for name in names if name in columns.values()])
        return {axis: names.index(name) for axis, name in columns.items()}
    times = [lower.index(name) for name in _TIMES if name in lower]
    chosen = {"time": times[0]} if times else {}
    others = [place for place in range(len(names)) if place not in times[:1]]
    accelerations = [place for place in others if lower[place] in _ACCELERATION]
    components = {} if accelerations else _components_among(text, line, names, others)
    likely = accelerations or others
    if not components and (len(likely) != 1 or any(_spells_direction(names[place]) for place in others)):
        listed = ", ".join(names)
        what = f"which of {listed} is the acceleration? state columns, or name it x or acceleration"
        raise text.fault(line, what, FileError if times else NoRecordError)
    return chosen | (components or {"x": likely[0]})


def _components_among(text: Text, line: int, names: list[str], places: list[int]) -> dict[str, int]:
    """Return the columns at `places` whose names state an axis, else a direction; none if both kinds are mixed."""
    on_axes = {place: names[place].lower()[-1] for place in places if names[place].lower() in _AXIS_NAMES}
    axes = {axis: place for place, axis in on_axes.items()}
    directed = _directed(names, places)
    if axes.keys() - {"z"} or (axes and len(directed) < 2):  # noqa: PLR2004  others beside z
        _require_distinct(text, line, [(names[place], axis) for place, axis in on_axes.items()])
        # velocities and displacements such as vel_NS may stand beside axes
        mixed = any(len(names[at]) > 1 and Direction.parse(names[at]) for at in places if at not in on_axes)
        return {} if mixed else axes
    _require_distinct(text, line, [(names[place], _line_of(names[place])) for place in places])
    return directed


def _spells_direction(name: str) -> bool:
    """Return whether a name of more than one letter is an axis or a direction."""
    return len(name) > 1 and (name.lower() in _AXIS_NAMES or _direction(name) is not None)


def _line_of(name: str) -> Hashable:
    """Return the line along which a column acts, whatever its sign; None if its name does not state one."""
    if name.lower() in _UNSURE:
        return name
    if (way := _direction(name)) is None:
        return None
    return way.vertical != 0, None if way.azimuth is None else way.azimuth % 180.0, way.axis


def _require_distinct(text: Text, line: int, components: Sequence[tuple[str, Hashable]]) -> None:
    """Raise FileError if two columns, each with its name, state one component."""
    names: dict[Hashable, list[str]] = {}
    for name, component in components:
        names.setdefault(component, []).append(name)
    for component, same in names.items():
        if component is not None and len(same) > 1:
            remedy = "Rename or remove one" if len(set(same)) == 1 else "State columns, or rename or remove one"
            raise text.fault(line, f"columns for one component: {', '.join(map(repr, same))}. {remedy}")


def _directed(names: list[str], places: list[int]) -> dict[str, int]:
    """Return the columns at `places` whose names state a direction.

    A single letter such as V counts only if it fits the other directions or names the only column.
    """
    found = {names[place]: place for place in places if _direction(names[place])}
    sure = {name: place for name, place in found.items() if name.lower() not in _UNSURE}
    if len(places) == 1:
        return found
    for some in (found, sure):
        if len(some) > 1 and is_one_set([one for one in map(_direction, some) if one]):
            return some
    return {name: place for name, place in found.items() if len(name) > 1}


def _time_unit(text: Text, line: int, unit: str | None) -> TimeUnit | None:
    """Return the unit of the column of times, or None if the file does not state it."""
    if unit is None:
        return None
    if (known := time_unit_of(unit)) is None:
        raise text.fault(
            line, f"unknown unit of time {unit!r}. Convert the times to s, ms, µs or min, and state that unit"
        )
    return known


def _unit(text: Text, line: int, units: Mapping[str, str | None]) -> str | None:
    known = {unit: unit_of(unit) for unit in units.values() if unit is not None}
    for unit, its in known.items():
        if its is None:
            raise text.fault(line, unknown_unit(unit))
    if len(set(known.values())) > 1:
        listed = ", ".join(map(repr, units.values()))
        raise text.fault(line, f"columns of different units: {listed}. Convert them to one unit")
    return next(iter(known.values()), None)
