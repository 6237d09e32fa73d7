"""ASC files of the Engineering Strong Motion database (ESM) and of ITACA, with headers of DYNA 1.x.

Lines `KEY: value`, then one acceleration per line:

    STREAM: HNE
    UNITS: cm/s^2
    SAMPLING_INTERVAL_S: 0.005000
    NDATA: 18904
    DATA_TYPE: ACCELERATION

L. Luzi et al., "The engineering strong-motion database: a platform to access pan-European accelerometric data",
Seismol. Res. Lett. 87 (2016).
"""

import re
from dataclasses import dataclass

from stylobate.base_motions.records.component import Component, Direction
from stylobate.base_motions.records.lines import Text
from stylobate.base_motions.records.units import unit_of, unknown_unit

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
        unit=_unit(header),
        direction=direction_of_channel(header.get("STREAM")),
        title=_title(header),
    )


def direction_of_channel(code: str) -> Direction | None:
    """Return the direction of a channel such as HNE from its code or the last letter of its code, or None.

    >>> direction_of_channel("HNE").azimuth, direction_of_channel("HGZ").vertical, direction_of_channel("HN3")
    (90.0, 1, None)
    """
    return Direction.parse(code) or (Direction.parse(code[-1:]) if code[-1:].isalpha() else None)


def _unit(header: _Header) -> str | None:
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
