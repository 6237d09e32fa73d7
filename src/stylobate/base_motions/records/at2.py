"""AT2 files of the PEER strong-motion databases.

Four lines of header, then the accelerations, several per line. The fourth line is `NPTS=   4000, DT=   .0050 SEC` in
newer files and `4000    0.0050    NPTS, DT` in older ones.
"""

import re

from stylobate.base_motions.records.component import Component, Direction
from stylobate.base_motions.records.lines import Text, is_number
from stylobate.base_motions.records.units import SECOND, time_unit_of, unit_of, unknown_unit

_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[EeDd][-+]?\d+)?"
_NEW = re.compile(
    rf"NPTS\s*=\s*(?P<count>\S+?)\s*,\s*DT\s*=\s*(?P<step>{_NUMBER})?\s*(?P<clock>[^\W\d_]*)", re.IGNORECASE
)
_OLD = re.compile(rf"\s*(?P<count>\d+)\s+(?P<step>{_NUMBER})?\s*(?P<clock>)NPTS\s*,\s*DT", re.IGNORECASE)
_UNITS = re.compile(r"UNITS?\s+OF\s+(?P<unit>[^\s,.;]+)", re.IGNORECASE)
_OTHERS = re.compile(r"^\s*(VELOCITY|DISPLACEMENT)\b", re.IGNORECASE)
# The line with the count is the fourth; an additional blank or comment line is tolerated.
_HEADER = 8
_TIME_AND_ACCELERATION = 2


def is_at2(text: Text) -> bool:
    """Return whether the file has the header of an AT2 file."""
    return _counting_line(text) is not None


def read_at2(text: Text, step: float | None = None) -> Component:
    """Read the component of an AT2 file.

    Parameters
    ----------
    text
        The file.
    step
        Time step [s], for a file whose header lacks the line with NPTS and DT.

    Raises
    ------
    FileError
        If the header or a number is wrong, or the count of numbers differs from the header.
    """
    at = _counting_line(text)
    if at is None:
        return _without_count(text, step)
    found = _NEW.search(text.lines[at]) or _OLD.match(text.lines[at])
    assert found is not None
    if found["step"] is None:
        raise text.fault(at, "the time step DT is missing. State it in the header, in s")
    count = text.count(at, "NPTS", found["count"])
    clock = time_unit_of(found["clock"])
    step = (clock or SECOND).in_seconds(text.number(at, found["step"].upper().replace("D", "E")))
    if step <= 0.0:
        raise text.fault(at, f"the time step DT must be positive, got {step!r}. Correct the header")
    return _component(text, at, count, step, states_time_unit=clock is not None)


def is_wrapped(text: Text) -> bool:
    """Return whether the numbers are laid out as in an AT2 file: several per line, fewer on the last line."""
    rows = [row for row in map(str.split, text.lines[_first_row(text) :]) if row]
    return bool(rows) and _TIME_AND_ACCELERATION < len(rows[0]) >= len(rows[-1])


def _without_count(text: Text, step: float | None) -> Component:
    header = _first_row(text)
    if step is None or not is_wrapped(text):
        state = "incomplete header" if header else "no header"
        remedy = "Restore it, or state step, in s, and units"
        raise text.fault(0, f"{state} of an AT2 file: the line with NPTS and DT is missing. {remedy}")
    return _component(text, header - 1, None, step, states_time_unit=False)


def _component(text: Text, last: int, count: int | None, step: float, *, states_time_unit: bool) -> Component:
    """Read the component below the header, whose last line has the index `last`."""
    return Component(
        samples=text.series(last, count),
        step=step,
        unit=_unit(text, last + 1),
        direction=_direction(text.lines[: last + 1]),
        title=text.lines[1].strip() if last > 0 else "",
        states_time_unit=states_time_unit,
    )


def _first_row(text: Text) -> int:
    """Return the index of the first line that holds only numbers."""
    rows = (at for at, line in enumerate(text.lines) if line.strip() and all(map(is_number, line.split())))
    return next(rows, len(text.lines))


def _counting_line(text: Text) -> int | None:
    for index, line in enumerate(text.lines[:_HEADER]):
        if _NEW.search(line) or _OLD.match(line):
            return index
    return None


def _unit(text: Text, header: int) -> str | None:
    for index, line in enumerate(text.lines[:header]):
        if _OTHERS.match(line):
            what = line.split()[0].lower()
            raise text.fault(index, f"the file holds {what}, not acceleration. Read the .AT2 file of this component")
        if found := _UNITS.search(line):
            unit = unit_of(found["unit"])
            if unit is None:
                raise text.fault(index, unknown_unit(found["unit"]))
            return unit
    return None


def _direction(header: tuple[str, ...]) -> Direction | None:
    # the second line ends with the component: "Loma Prieta, 10/18/1989, Corralitos, 90"
    return Direction.parse(header[1].rsplit(",", maxsplit=1)[-1]) if len(header) > 1 and "," in header[1] else None
