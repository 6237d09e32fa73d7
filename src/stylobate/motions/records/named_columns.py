"""CSV files: columns with names, units in brackets where they are told."""

import csv
import re
from collections.abc import Mapping

import numpy as np

from stylobate.motions.records.component import Component
from stylobate.motions.records.lines import Text
from stylobate.motions.records.record import AXES
from stylobate.motions.records.tables import equal_steps
from stylobate.motions.records.units import unit_of

_NAME = re.compile(r"\s*(?P<name>[^\[(]*?)\s*(?:[\[(](?P<unit>[^\])]*)[\])])?\s*")
_TIME = ("time", "t")
_ACCELERATION = ("acceleration", "accel", "acc", "a")
_SAME = {name: name for name in ("time", *AXES)}


def is_csv(text: Text) -> bool:
    """Return whether the first line that is no remark names columns, with commas or semicolons between."""
    line = next((line for line in text.lines if line.strip() and not line.lstrip().startswith("#")), "")
    return ("," in line or ";" in line) and not any(map(_is_number, re.split(r"[,;]", line)))


def read_csv(text: Text, columns: Mapping[str, str] | None, step: float | None) -> Component:
    """Return the component or components of a CSV file.

    Parameters
    ----------
    text
        The file: names in its first line, such as `time [s],x [m/s²],y [m/s²]`.
    columns
        Which column is "time", "x", "y", "z", by the names of the file, units apart; None looks for columns named so,
        or for one acceleration beside the time.
    step
        Time step [s]; only needed without a column of times.

    Raises
    ------
    FileError
        If a column is missing, units differ, or a number is wrong.
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
    if "time" in by_name:
        start, step = equal_steps(text, by_name["time"], places, step)
    elif step is None:
        raise text.fault(first, "no column of times: state step, the time step in s")
    samples = np.stack([by_name.get(axis, np.zeros(len(body))) for axis in AXES], axis=-1)
    single = chosen.keys() & set(AXES) == {"x"}
    return Component(
        samples=samples[:, 0] if single else samples,
        step=step,
        start=start,
        unit=_unit(text, first, {names[place]: units[place] for axis, place in chosen.items() if axis != "time"}),
    )


def _chosen(text: Text, line: int, names: list[str], columns: Mapping[str, str] | None) -> dict[str, int]:
    lower = [name.lower() for name in names]
    if columns is not None:
        for axis, name in columns.items():
            if axis not in _SAME or name not in names:
                raise text.fault(line, f"no column {name!r} for {axis!r}: the columns are {', '.join(names)}")
        return {axis: names.index(name) for axis, name in columns.items()}
    times = [lower.index(name) for name in _TIME if name in lower]
    chosen = {"time": times[0]} if times else {}
    chosen |= {axis: lower.index(name) for axis in AXES for name in (axis, f"a{axis}") if name in lower}
    others = [place for place in range(len(names)) if place not in chosen.values()]
    if not chosen.keys() & set(AXES):
        likely = [place for place in others if lower[place] in _ACCELERATION] or others
        if len(likely) != 1:
            told = ", ".join(names)
            raise text.fault(line, f"which of {told} is the acceleration? state columns, or name it x or acceleration")
        chosen["x"] = likely[0]
    return chosen


def _unit(text: Text, line: int, told: Mapping[str, str | None]) -> str | None:
    known = {unit_of(unit) for unit in told.values() if unit is not None}
    if None in known:
        raise text.fault(line, f"unknown unit among {', '.join(map(repr, told.values()))}")
    if len(known) > 1:
        raise text.fault(line, f"columns of different units: {', '.join(map(repr, told.values()))}")
    return next(iter(known), None)


def _is_number(token: str) -> bool:
    try:
        float(token)
    except ValueError:
        return False
    return True
