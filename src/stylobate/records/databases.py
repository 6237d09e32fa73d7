"""Files of strong-motion databases: AT2 of PEER, ASC of ESM and ITACA, and waveforms that ObsPy reads."""

import io
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from stylobate.errors import FileError, UnsupportedError
from stylobate.records.directions import Component, Direction
from stylobate.records.text_files import SECOND, Text, is_number, time_unit_of, unit_of, unknown_unit

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
        unit=_unit_of_header(text, last + 1),
        direction=_direction_in_title(text.lines[: last + 1]),
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


def _unit_of_header(text: Text, header: int) -> str | None:
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


def _direction_in_title(header: tuple[str, ...]) -> Direction | None:
    # the second line ends with the component: "Loma Prieta, 10/18/1989, Corralitos, 90"
    return Direction.parse(header[1].rsplit(",", maxsplit=1)[-1]) if len(header) > 1 and "," in header[1] else None


_KEY = re.compile(r"(?P<key>[A-Z][A-Z0-9_/^.%]*)\s*:\s*(?P<value>.*?)\s*")
_NEEDED = ("SAMPLING_INTERVAL_S", "NDATA")
_KNOWN = {*_NEEDED, "DATA_TYPE", "STREAM", "UNITS", "HEADER_FORMAT"}


@dataclass(frozen=True, slots=True)
class _Header:
    text: Text
    places: dict[str, int]
    values: dict[str, str]

    @classmethod
    def of(cls, text: Text) -> "_Header":
        places: dict[str, int] = {}
        values: dict[str, str] = {}
        for at, line in enumerate(text.lines):
            found = _KEY.fullmatch(line)
            if found is None and line.strip():
                break
            if found is not None:
                places[found["key"]], values[found["key"]] = at, found["value"]
        return cls(text, places, values)

    @property
    def last(self) -> int:
        """Index of the last line of the header."""
        return max(self.places.values())

    def get(self, key: str) -> str:
        """Return the value of a key, empty if the key is missing."""
        return self.values.get(key, "")


def is_asc(text: Text) -> bool:
    """Return whether the file begins with the header of an ASC file, complete or not."""
    return len(_KNOWN & _Header.of(text).values.keys()) > 1


def read_asc(text: Text) -> Component:
    """Read the component of an ASC file.

    Raises
    ------
    FileError
        If the header or a number is wrong, the count of numbers differs from the header, or the data are no
        acceleration.
    """
    header = _Header.of(text)
    for key in _NEEDED:
        if not header.get(key):
            what = f"incomplete header of an ASC file: {key} is missing. Restore it"
            raise text.fault(header.places.get(key, 0), what)
    kind = header.get("DATA_TYPE").lower()
    if kind and kind != "acceleration":
        what = f"the file holds {kind}, not acceleration. Read the file of this component with ACC in its name"
        raise text.fault(header.places["DATA_TYPE"], what)
    step = text.number(header.places["SAMPLING_INTERVAL_S"], header.get("SAMPLING_INTERVAL_S"))
    if step <= 0.0:
        raise text.fault(
            header.places["SAMPLING_INTERVAL_S"],
            f"SAMPLING_INTERVAL_S must be positive, got {step!r}. Correct the header",
        )
    count = text.count(header.places["NDATA"], "NDATA", header.get("NDATA"))
    return Component(
        samples=text.series(header.last, count),
        step=step,
        unit=_stated_unit(header),
        direction=direction_of_channel(header.get("STREAM")),
        title=_title(header),
    )


def direction_of_channel(code: str) -> Direction | None:
    """Return the direction of a channel such as HNE from its code or the last letter of its code, or None.

    >>> direction_of_channel("HNE").azimuth, direction_of_channel("HGZ").vertical, direction_of_channel("HN3")
    (90.0, 1, None)
    """
    return Direction.parse(code) or (Direction.parse(code[-1:]) if code[-1:].isalpha() else None)


def _stated_unit(header: _Header) -> str | None:
    stated = header.get("UNITS")
    unit = unit_of(stated)
    if stated and unit is None:
        raise header.text.fault(header.places["UNITS"], unknown_unit(stated))
    return unit


def _title(header: _Header) -> str:
    """Return event, date, station and component, in the order of the second line of an AT2 file."""
    event = header.get("EVENT_NAME") or header.get("EVENT_ID")
    station = ".".join(filter(None, (header.get("NETWORK"), header.get("STATION_CODE"))))
    date, time = header.get("EVENT_DATE_YYYYMMDD"), header.get("EVENT_TIME_HHMMSS")
    when = f"{date[:4]}-{date[4:6]}-{date[6:]} {time}".strip(" -")
    parts = (event, when, station, header.get("STREAM"))
    return ", ".join(filter(None, parts))


# ObsPy's calibration of these formats is in m/s².
_IN_SI = ("KNET",)


def read_waveform(path: Path, content: bytes) -> Component:
    """Read the component in a waveform file with ObsPy.

    Raises
    ------
    UnsupportedError
        If ObsPy is not installed.
    FileError
        If ObsPy cannot read the file, or the file holds no trace or several.

    Notes
    -----
    Samples are counts times the calibration in the header (`trace.stats.calib`); the instrument's response is not
    removed.
    """
    try:
        import obspy  # noqa: PLC0415  optional, slow to import
    except ImportError:
        message = (
            f'{path}: no text. To read a waveform such as miniSEED, install ObsPy: pip install "stylobate[records]"'
        )
        raise UnsupportedError(message) from None
    try:
        stream = obspy.read(io.BytesIO(content))
    except Exception as error:  # ObsPy's readers raise exceptions of any type; their texts name temporary files
        message = (
            f"{path}: ObsPy cannot read it: its format is unknown or its content damaged. Download the file again, or "
            "export the record as text or miniSEED"
        )
        raise FileError(message) from error
    if len(stream) != 1:
        remedy = "Write each trace to a file of its own, and fill its gaps"
        message = f"{path}: the file must hold one trace without gaps, got {len(stream)} traces. {remedy}"
        raise FileError(message)
    (trace,) = stream
    stats = trace.stats
    samples = np.ma.filled(np.ma.asarray(trace.data, dtype=float), np.nan) * float(stats.calib)
    if len(samples) < 2 or not np.all(np.isfinite(samples)):  # noqa: PLR2004  a step has two ends
        remedy = "Download the file again, or fill its gaps"
        message = f"{path}: the trace must have at least two finite samples without gaps. {remedy}"
        raise FileError(message)
    return Component(
        samples=samples,
        step=float(stats.delta),
        unit="m/s²" if stats.get("_format") in _IN_SI else None,
        direction=_direction(stats),
        title=f"{trace.id} {stats.starttime}",
    )


def _direction(stats: Any) -> Direction | None:
    sac = stats.get("sac", {})
    if "cmpaz" in sac and "cmpinc" in sac:
        if float(sac["cmpinc"]) == 0.0:
            return Direction(vertical=1)
        return Direction.of(float(sac["cmpaz"]))
    channel = str(stats.channel)
    return direction_of_channel(channel)
