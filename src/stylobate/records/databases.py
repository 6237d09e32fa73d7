"""Files of strong-motion databases: AT2 of PEER, ASC of ESM and ITACA."""

import re

from stylobate.records.directions import Component, Direction
from stylobate.records.text_files import SECOND, Text, is_number, time_unit_of, unit_of, unknown_unit

# AT2: four lines of header, then the accelerations, several per line. The fourth line is
# `NPTS=   4000, DT=   .0050 SEC` in newer files and `4000    0.0050    NPTS, DT` in older ones. Neither pattern has two
# parts that the same characters fit: the time of a search would grow with the square of the length of a line.
_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[EeDd][-+]?\d+)?"
_NEW = re.compile(
    rf"NPTS\s*=\s*(?P<count>[^\s=]+?)\s*,\s*DT\s*=\s*(?P<step>{_NUMBER})?\s*(?P<clock>[^\W\d_]*)", re.IGNORECASE
)
_OLD = re.compile(rf"\s*(?P<count>\d+)\s+(?:(?P<step>{_NUMBER})\s*)?(?P<clock>)NPTS\s*,\s*DT", re.IGNORECASE)
_UNITS = re.compile(r"UNITS?\s+OF\s+(?P<unit>[^\s,.;]+)", re.IGNORECASE)
_OTHERS = re.compile(r"^\s*(VELOCITY|DISPLACEMENT)\b", re.IGNORECASE)
# The line with the count is the fourth; an additional blank or comment line is tolerated.
_HEADER = 8
_TIME_AND_ACCELERATION = 2


def is_at2(text: Text) -> bool:
    """Return whether the file has the header of an AT2 file."""
    return _counting_line(text) is not None


def is_wrapped(text: Text) -> bool:
    """Return whether the numbers are laid out as in an AT2 file: several per line, fewer on the last line."""
    rows = [row for row in map(str.split, text.lines[_first_row(text) :]) if row]
    return bool(rows) and _TIME_AND_ACCELERATION < len(rows[0]) >= len(rows[-1])


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
    last, count, clock = _counting_line(text), None, None
    if last is not None:
        found = _NEW.search(text.lines[last]) or _OLD.match(text.lines[last])
        assert found is not None
        if found["step"] is None:
            raise text.fault(last, "the time step DT is missing. State it in the header, in s")
        count, clock = text.count(last, "NPTS", found["count"]), time_unit_of(found["clock"])
        step = (clock or SECOND).in_seconds(text.number(last, found["step"].upper().replace("D", "E")))
        if step <= 0.0:
            raise text.fault(last, f"the time step DT must be positive, got {step!r}. Correct the header")
    else:
        last = _first_row(text) - 1
        if step is None or not is_wrapped(text):
            state = "incomplete header" if last >= 0 else "no header"
            remedy = "Restore it, or state step, in s, and units"
            raise text.fault(0, f"{state} of an AT2 file: the line with NPTS and DT is missing. {remedy}")
    header = text.lines[: last + 1]
    # the second line ends with the component: "Loma Prieta, 10/18/1989, Corralitos, 90"
    title = header[1] if len(header) > 1 else ""
    return Component(
        samples=text.series(last, count),
        step=step,
        unit=_unit_of_at2(text, header),
        direction=Direction.parse(title.rsplit(",", maxsplit=1)[-1]) if "," in title else None,
        title=title.strip(),
        states_time_unit=clock is not None,
    )


def _counting_line(text: Text) -> int | None:
    found = (at for at, line in enumerate(text.lines[:_HEADER]) if _NEW.search(line) or _OLD.match(line))
    return next(found, None)


def _first_row(text: Text) -> int:
    """Return the index of the first line that holds only numbers."""
    rows = (at for at, line in enumerate(text.lines) if line.strip() and all(map(is_number, line.split())))
    return next(rows, len(text.lines))


def _unit_of_at2(text: Text, header: tuple[str, ...]) -> str | None:
    for index, line in enumerate(header):
        if _OTHERS.match(line):
            what = line.split()[0].lower()
            raise text.fault(index, f"the file holds {what}, not acceleration. Read the .AT2 file of this component")
        if found := _UNITS.search(line):
            unit = unit_of(found["unit"])
            if unit is None:
                raise text.fault(index, unknown_unit(found["unit"]))
            return unit
    return None


# ASC, with headers of DYNA 1.x: lines `KEY: value` such as `SAMPLING_INTERVAL_S: 0.005000`, then one acceleration per
# line. L. Luzi et al., "The engineering strong-motion database: a platform to access pan-European accelerometric data",
# Seismol. Res. Lett. 87, 2016.
_KEY = re.compile(r"(?P<key>[A-Z][A-Z0-9_/^.%]*)\s*:\s*(?P<value>.*?)\s*")
_STEP, _COUNT = "SAMPLING_INTERVAL_S", "NDATA"
_KNOWN = {_STEP, _COUNT, "DATA_TYPE", "STREAM", "UNITS", "HEADER_FORMAT"}


def is_asc(text: Text) -> bool:
    """Return whether the file begins with the header of an ASC file, complete or not."""
    return len(_KNOWN & _asc_header(text).keys()) > 1


def read_asc(text: Text) -> Component:
    """Read the component of an ASC file.

    Raises
    ------
    FileError
        If the header or a number is wrong, the count of numbers differs from the header, or the data are no
        acceleration.
    """
    header = _asc_header(text)
    places = {key: at for key, (at, _) in header.items()}
    values = dict.fromkeys(_KNOWN, "") | {key: value for key, (_, value) in header.items()}
    for key in (_STEP, _COUNT):
        if not values[key]:
            raise text.fault(places.get(key, 0), f"incomplete header of an ASC file: {key} is missing. Restore it")
    kind = values["DATA_TYPE"].lower()
    if kind not in ("", "acceleration"):
        raise text.fault(
            places["DATA_TYPE"],
            f"the file holds {kind}, not acceleration. Read the file of this component with ACC in its name",
        )
    step = text.number(places[_STEP], values[_STEP])
    if step <= 0.0:
        raise text.fault(places[_STEP], f"{_STEP} must be positive, got {step!r}. Correct the header")
    count = text.count(places[_COUNT], _COUNT, values[_COUNT])
    unit = unit_of(values["UNITS"])
    if values["UNITS"] and unit is None:
        raise text.fault(places["UNITS"], unknown_unit(values["UNITS"]))
    return Component(
        samples=text.series(max(places.values()), count),
        step=step,
        unit=unit,
        direction=direction_of_channel(values["STREAM"]),
        title=_title(values),
    )


def direction_of_channel(code: str) -> Direction | None:
    """Return the direction of a channel such as HNE from its code or the last letter of its code, or None.

    >>> direction_of_channel("HNE").azimuth, direction_of_channel("HGZ").vertical, direction_of_channel("HN3")
    (90.0, 1, None)
    """
    return Direction.parse(code) or (Direction.parse(code[-1:]) if code[-1:].isalpha() else None)


def _asc_header(text: Text) -> dict[str, tuple[int, str]]:
    """Return the values of the header by their keys, each with the index of its line."""
    header: dict[str, tuple[int, str]] = {}
    for at, line in enumerate(text.lines):
        found = _KEY.fullmatch(line)
        if found is None and line.strip():
            break
        if found is not None:
            header[found["key"]] = at, found["value"]
    return header


def _title(values: dict[str, str]) -> str:
    """Return event, date, station and component, in the order of the second line of an AT2 file."""
    event = values.get("EVENT_NAME") or values.get("EVENT_ID", "")
    station = ".".join(filter(None, (values.get("NETWORK"), values.get("STATION_CODE"))))
    date, time = values.get("EVENT_DATE_YYYYMMDD", ""), values.get("EVENT_TIME_HHMMSS", "")
    when = f"{date[:4]}-{date[4:6]}-{date[6:]} {time}".strip(" -")
    return ", ".join(filter(None, (event, when, station, values["STREAM"])))
