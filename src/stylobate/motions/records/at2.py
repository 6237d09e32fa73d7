"""Files of the PEER strong-motion databases, AT2.

Four lines of header, then the accelerations, several on a line. The fourth line is `NPTS=   4000, DT=   .0050 SEC` in
newer files and `4000    0.0050    NPTS, DT` in older ones.
"""

import re

import numpy as np

from stylobate.motions.records.component import Component, Direction
from stylobate.motions.records.lines import Floats, Text
from stylobate.motions.records.units import unit_of

_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[EeDd][-+]?\d+)?"
_NEW = re.compile(rf"NPTS\s*=\s*(?P<count>\S+?)\s*,\s*DT\s*=\s*(?P<step>{_NUMBER})?", re.IGNORECASE)
_OLD = re.compile(rf"\s*(?P<count>\d+)\s+(?P<step>{_NUMBER})?\s*NPTS\s*,\s*DT", re.IGNORECASE)
_UNITS = re.compile(r"UNITS?\s+OF\s+(?P<unit>[^\s,.;]+)", re.IGNORECASE)
_OTHERS = re.compile(r"^\s*(VELOCITY|DISPLACEMENT)\b", re.IGNORECASE)
# The line with the count is the fourth; a blank or a remark more is tolerated.
_HEADER = 8


def is_at2(text: Text) -> bool:
    """Return whether the file has the header of an AT2 file."""
    return _counting_line(text) is not None


def read_at2(text: Text) -> Component:
    """Return the component of an AT2 file.

    Raises
    ------
    FileError
        If the header or a number is wrong, or there are more or fewer numbers than it says.
    """
    at = _counting_line(text)
    assert at is not None
    found = _NEW.search(text.lines[at]) or _OLD.match(text.lines[at])
    assert found is not None
    if not found["count"].isdigit():
        raise text.fault(at, f"NPTS must be a whole number, got {found['count']!r}")
    if found["step"] is None:
        raise text.fault(at, "the time step DT is missing")
    count, step = int(found["count"]), text.number(at, found["step"].upper().replace("D", "E"))
    if step <= 0.0:
        raise text.fault(at, f"the time step DT must be positive, got {step!r}")
    if count < 2:  # noqa: PLR2004  a step has two ends
        raise text.fault(at, f"two samples at least are wanted, NPTS says {count}")
    return Component(
        samples=_samples(text, at, count),
        step=step,
        unit=_unit(text, at),
        direction=_direction(text.lines[:at]),
        title=text.lines[1].strip() if at > 1 else "",
    )


def _counting_line(text: Text) -> int | None:
    for index, line in enumerate(text.lines[:_HEADER]):
        if _NEW.search(line) or _OLD.match(line):
            return index
    return None


def _samples(text: Text, header: int, count: int) -> Floats:
    tokens = [(at, line.split()) for at, line in enumerate(text.lines[header + 1 :], start=header + 1)]
    tokens = [(at, row) for at, row in tokens if row]
    found = sum(len(row) for _, row in tokens)
    samples = text.rows([(at, [token]) for at, row in tokens for token in row]) if found else np.empty((0, 1))
    if found != count:
        last = tokens[-1][0] if tokens else header
        raise text.fault(last, f"the header says {count} samples, the file has {found}")
    return samples[:, 0]


def _unit(text: Text, header: int) -> str | None:
    for index, line in enumerate(text.lines[:header]):
        if _OTHERS.match(line):
            raise text.fault(index, f"accelerations are wanted, this is {line.split()[0].lower()}")
        if found := _UNITS.search(line):
            unit = unit_of(found["unit"])
            if unit is None:
                raise text.fault(index, f"unknown unit {found['unit']!r}")
            return unit
    return None


def _direction(header: tuple[str, ...]) -> Direction | None:
    # the second line ends with the component: "Loma Prieta, 10/18/1989, Corralitos, 90"
    return Direction.parse(header[1].rsplit(",", maxsplit=1)[-1]) if len(header) > 1 and "," in header[1] else None
