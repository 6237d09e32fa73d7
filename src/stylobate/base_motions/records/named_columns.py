"""CSV files with column names and optional units in brackets."""

import csv
import re
from collections.abc import Hashable, Mapping, Sequence

import numpy as np

from stylobate.base_motions.records.axes import Directed, along_axes, is_one_set
from stylobate.base_motions.records.component import Component, Direction
from stylobate.base_motions.records.layout import TIMES
from stylobate.base_motions.records.lines import Floats, Text, is_number
from stylobate.base_motions.records.naming import split_name
from stylobate.base_motions.records.record import AXES
from stylobate.base_motions.records.tables import equal_steps
from stylobate.base_motions.records.units import SECOND, TimeUnit, time_unit_of, unit_of, unknown_unit

_NAME = re.compile(r"\s*(?P<name>[^\[(]*?)\s*(?:[\[(](?P<unit>[^\])]*)[\])])?\s*")
_ACCELERATION = ("acceleration", "accel", "acc", "a")
# Single letters that are a velocity, a length, a time or a radius unless they fit the directions of other columns.
_UNSURE = ("v", "l", "t", "r")
_AXIS_NAMES = {name for axis in AXES for name in (axis, f"a{axis}")}
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
            raise text.fault(at, f"{len(row)} columns, the first line names {len(names)}. Correct the line")
    values = text.rows([(at, [row[place] for place in chosen.values()]) for at, row in body])
    if not body:
        raise text.fault(first, "the file has no numbers. Export it again")
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
        _require_distinct(text, line, [(name, name) for name in names if name in columns.values()])
        return {axis: names.index(name) for axis, name in columns.items()}
    times = [lower.index(name) for name in TIMES if name in lower]
    chosen = {"time": times[0]} if times else {}
    others = [place for place in range(len(names)) if place not in times[:1]]
    accelerations = [place for place in others if lower[place] in _ACCELERATION]
    components = {} if accelerations else _components_among(text, line, names, others)
    likely = accelerations or others
    if not components and (len(likely) != 1 or any(_spells_direction(names[place]) for place in others)):
        listed = ", ".join(names)
        raise text.fault(line, f"which of {listed} is the acceleration? state columns, or name it x or acceleration")
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
    for at, (_, component) in enumerate(components):
        same = [other for other, its in components[at:] if its == component]
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
