"""CSV files with column names and optional units in brackets."""

import csv
import re
from collections.abc import Mapping

import numpy as np

from stylobate.base_motions.records.axes import Directed, along_axes, is_one_set
from stylobate.base_motions.records.component import Component, Direction
from stylobate.base_motions.records.layout import TIMES
from stylobate.base_motions.records.lines import Floats, Text, is_number
from stylobate.base_motions.records.naming import split_name
from stylobate.base_motions.records.record import AXES
from stylobate.base_motions.records.tables import equal_steps
from stylobate.base_motions.records.units import SECOND, TimeUnit, time_unit_of, unit_of

_NAME = re.compile(r"\s*(?P<name>[^\[(]*?)\s*(?:[\[(](?P<unit>[^\])]*)[\])])?\s*")
_ACCELERATION = ("acceleration", "accel", "acc", "a")
_SAME = {name: name for name in ("time", *AXES)}


def is_csv(text: Text) -> bool:
    """Return whether the first line that is no comment names columns, separated by commas or semicolons."""
    line = next((line for line in text.lines if line.strip() and not line.lstrip().startswith("#")), "")
    return ("," in line or ";" in line) and not any(map(is_number, re.split(r"[,;]", line)))


def read_csv(text: Text, columns: Mapping[str, str] | None, step: float | None) -> Component:
    """Read the component or components of a CSV file.

    Parameters
    ----------
    text
        The file, with names in its first line, such as `time [s],x [m/s²],y [m/s²]`.
    columns
        Columns of "time", "x", "y", "z" by their names in the file, without units. None looks for columns with these
        names, for names of directions such as NS, EW and UD, or for one acceleration beside the time. A column named
        acceleration takes precedence over single letters, which may be a velocity V or a length L.
    step
        Time step [s]; needed only without a column of times.

    Raises
    ------
    FileError
        If a column is missing, units differ or are unknown, or a number is wrong.
    """
    first = next(at for at, line in enumerate(text.lines) if line.strip() and not line.lstrip().startswith("#"))
    between = ";" if text.lines[first].count(";") > text.lines[first].count(",") else ","
    rows = list(csv.reader(text.lines, delimiter=between))
    header = [_NAME.fullmatch(name) for name in rows[first]]
    names = [found["name"].strip() if found else "" for found in header]
    units = [found["unit"] if found else None for found in header]
    body = [(at, row) for at, row in enumerate(rows) if at > first and any(token.strip() for token in row)]
    chosen = _chosen(text, first, names, columns)
    for at, row in body:
        if len(row) != len(names):
            raise text.fault(at, f"{len(row)} columns, the first line names {len(names)}")
    values = text.rows([(at, [row[place] for place in chosen.values()]) for at, row in body])
    if not body:
        raise text.fault(first, "the file has no numbers")
    by_name = dict(zip(chosen, values.T, strict=True))
    places = [at for at, _ in body]
    start = 0.0
    clock = _time_unit(text, first, units[chosen["time"]]) if "time" in chosen else None
    if "time" in by_name:
        start, step = equal_steps(text, by_name["time"], places, step, clock or SECOND)
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
            if axis not in _SAME or name not in names:
                raise text.fault(line, f"no column {name!r} for {axis!r}: the columns are {', '.join(names)}")
        return {axis: names.index(name) for axis, name in columns.items()}
    times = [lower.index(name) for name in TIMES if name in lower]
    chosen = {"time": times[0]} if times else {}
    others = [place for place in range(len(names)) if place not in times[:1]]
    axes = {axis: lower.index(name) for axis in AXES for name in (axis, f"a{axis}") if name in lower}
    directed = _directed(names, others)
    accelerations = [place for place in others if lower[place] in _ACCELERATION]
    spelt_out = any(len(names[place]) > 1 for place in (*axes.values(), *directed.values()))
    if not accelerations and (axes.keys() - {"z"} or (axes and len(directed) < 2)):  # noqa: PLR2004  others beside z
        return chosen | axes
    if not accelerations and directed:
        return chosen | directed
    likely = accelerations or others
    if len(likely) != 1 or spelt_out:
        listed = ", ".join(names)
        raise text.fault(line, f"which of {listed} is the acceleration? state columns, or name it x or acceleration")
    return chosen | {"x": likely[0]}


def _directed(names: list[str], places: list[int]) -> dict[str, int]:
    """Return the columns at `places` whose names state a direction.

    A single letter such as V counts only if it fits the other directions or names the only column.
    """
    found = {names[place]: place for place in places if _direction(names[place])}
    if len(places) == 1 or (len(found) > 1 and is_one_set([one for one in map(_direction, found) if one])):
        return found
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
    known = {unit_of(unit) for unit in units.values() if unit is not None}
    if None in known:
        raise text.fault(line, f"unknown unit among {', '.join(map(repr, units.values()))}")
    if len(known) > 1:
        raise text.fault(line, f"columns of different units: {', '.join(map(repr, units.values()))}")
    return next(iter(known), None)
