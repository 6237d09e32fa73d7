"""Text files of strong-motion agencies with several components one after another: COSMOS, CSMIP and GeoNet."""

import math
import re
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from stylobate.records.contents import NoRecordError
from stylobate.records.databases import direction_of_channel
from stylobate.records.directions import Component, Direction
from stylobate.records.text_files import Text, TimeUnit, unit_of, unknown_unit


class Channel(NamedTuple):
    """A component in a file of several, with the names that tell it apart from the others.

    Parameters
    ----------
    station
        Network code and station as the file states them, such as "AK-BMR", "89146"; empty if unknown.
    name
        Name such as "Chan 1", "S16W", unique in the file.
    component
        The accelerations.
    """

    station: str
    name: str
    component: Component


# A number of a file as text, with the index of its line.
_Token = tuple[int, str]
_AGAIN = "Download the file again"


class _Layout(NamedTuple):
    """Numbers of fixed width, which may abut, as in the Fortran format (8F10.6)."""

    on_a_line: int
    width: int


_FORMAT = re.compile(r"\((?:\dP,?)?(?P<count>[1-9]\d{0,2})?[DEFGI](?P<width>[1-9]\d?)(?:\.\d+)?\)", re.IGNORECASE)


def _layout(text: Text, index: int) -> _Layout:
    found = _FORMAT.search(text.lines[index])
    if found is None:
        raise text.fault(index, f"the line must end with a format of numbers such as (8F10.5). {_AGAIN}")
    return _Layout(int(found["count"] or 1), int(found["width"]))


def _tokens(
    text: Text, begin: int, count: int, layout: _Layout | None, *, shifted: bool = False
) -> tuple[list[_Token], int]:
    """Split the lines from `begin` on into `count` numbers, at blanks without `layout`; return the next index too.

    With `shifted`, numbers between blanks may stand in other columns, as in headers that were edited by hand.
    """
    tokens: list[_Token] = []
    at = begin
    while (left := count - len(tokens)) > 0:
        line = text.lines[at].rstrip() if at < len(text.lines) else ""
        if layout is None:
            row = line.split()
            whole, form = 0 < len(row) <= left, "separated by blanks"
        else:
            row = [line[column : column + layout.width].strip() for column in range(0, len(line), layout.width)]
            expected = min(layout.on_a_line, left)
            whole, form = len(line) == expected * layout.width, "{} a line, {} characters each"
            if shifted and not whole and len(line.split()) == expected:
                whole, row = True, line.split()
        if not whole:
            form = form.format(*(layout or ()))
            what = f"the header states {count} numbers, {form}; {count - left} of them precede this line, which"
            raise text.fault(at, f"{what} is {'missing' if not line else 'cut or too long'}. {_AGAIN}")
        tokens += [(at, token) for token in row]
        at += 1
    return tokens, at


def _expect(text: Text, index: int, pattern: re.Pattern[str], what: str) -> re.Match[str]:
    """Match the line at `index`, or raise that `what` is missing."""
    found = pattern.match(text.lines[index]) if index < len(text.lines) else None
    if found is None:
        raise text.fault(index, f"{what} is missing. {_AGAIN}")
    return found


def _component(
    text: Text, tokens: Sequence[_Token], unit: tuple[int, str], step: float, direction: Direction | None, title: str
) -> Component:
    """Parse the numbers; `unit` is the unit in the file, with the index of its line."""
    index, name = unit
    tenths = name.lower().replace(" ", "") == "g/10"
    known = "g" if tenths else unit_of(name)
    if known is None:
        raise text.fault(index, unknown_unit(name))
    samples = text.rows([(at, [token]) for at, token in tokens])[:, 0] / (10.0 if tenths else 1.0)
    return Component(samples=samples, step=step, unit=known, direction=direction, title=title)


def _positive(text: Text, index: int, step: float) -> float:
    if not step > 0.0:
        raise text.fault(index, f"the time step must be positive, got {step!r}. Correct the header")
    return step


def _read_all(text: Text, read_one: Callable[[Text, int], tuple[Channel | str, int]]) -> list[Channel]:
    """Read one part after another; `read_one` returns a channel or the kind of its data, and the index of the next."""
    if "spectr" in text.lines[0].lower():
        raise text.fault(0, "the file holds spectra, no accelerations. Read the V2 file of this record", NoRecordError)
    channels: list[Channel] = []
    others: dict[str, None] = {}
    end = max(at for at, line in enumerate(text.lines, start=1) if line.strip())
    at = 0
    while at < end:
        if not text.lines[at].strip():
            at += 1
            continue
        found, at = read_one(text, at)
        if isinstance(found, str):
            others[found] = None
            continue
        taken, name, number = {one.name for one in channels}, found.name, 1
        while name in taken:
            number += 1
            name = f"{found.name} {number}"
        channels.append(found._replace(name=name))
    if not channels:
        remedy = "Read the file with the accelerations of this station"
        raise text.fault(0, f"the file holds {' and '.join(others)}, no accelerations. {remedy}", NoRecordError)
    return channels


_MONTHS = ("jan", "feb", "mar", "apr", "may", "jun", "jul", "aug", "sep", "oct", "nov", "dec")
_MONTH_DAY_YEAR = rf"({'|'.join(_MONTHS)})[a-z]*\.?\s+(\d{{1,2}})\s*,\s*(\d{{4}})\b"
_DATE = re.compile(rf"\b{_MONTH_DAY_YEAR}", re.IGNORECASE)
_EVENT = re.compile(
    rf"\s*(?:(?:Record|Rcrd) of\s+)?(?P<event>.*?)\s*(?:\s\s|\bEarthquake\b|(?:\b[a-z]{{3}}\s+)?\b{_MONTH_DAY_YEAR}|$)",
    re.IGNORECASE,
)


def _title(lines: Sequence[str], station: str, name: str) -> str:
    """Return event, date, station and component; `lines` begin with the event, one of them has a date in words."""
    event = _EVENT.match(lines[0]) if lines else None
    date = next(filter(None, map(_DATE.search, lines)), None)
    when = f"{date[3]}-{_MONTHS.index(date[1].lower()) + 1:02d}-{int(date[2]):02d}" if date else ""
    return ", ".join(filter(None, (event["event"] if event else "", when, station, name)))


# The name of a channel in the text lines: `Sta Chan   1: 90 Deg (Rcrdr …`, `CHAN  2:   UP`.
_CHANNEL = re.compile(
    r"^\s*(?:Sta )?Chan?\b:?\s*(?P<number>[^\s:]+)\s*:\s*(?P<direction>.*?)\s*(?:\s\s|\(|\bLoc|$)", re.IGNORECASE
)


def _first_match(pattern: re.Pattern[str], lines: Sequence[str]) -> re.Match[str] | None:
    return next(filter(None, map(pattern.search, lines)), None)


# COSMOS: blocks of text lines, integers, reals, comments and one series; each of them begins with its count and format.
# Consortium of Organizations for Strong-Motion Observation Systems, "COSMOS strong motion data format", version 1.20,
# 2001.
_COSMOS = re.compile(r".*\(Format v(?P<version>\d+\.\d+) with\s+(?P<lines>\d{1,3}) text lines\)", re.IGNORECASE)
_COSMOS_VERSION = "01.20"
_INTEGERS = re.compile(r"\s*(?P<count>\d{1,4})\s+Integer-header values follow", re.IGNORECASE)
_REALS = re.compile(r"\s*(?P<count>\d{1,4})\s+Real-header values follow", re.IGNORECASE)
_COMMENTS = re.compile(r"\s*(?P<count>\d{1,4})\s+Comment line", re.IGNORECASE)
_COMMENT = re.compile(r"\s*\|")
_SERIES = re.compile(r"\s*(?P<count>\d+)\s+(?P<kind>\S.*?)\s*\bpts\b.*\bunits=\s*(?P<unit>[^,(]*)", re.IGNORECASE)
_END = re.compile(r"\s*(?:End-of-data|/&)", re.IGNORECASE)
_UNKNOWN = re.compile(r"unknown.*,\s*(?P<real>[-+]?\d+\.?\d*)\s*$", re.IGNORECASE)
_CODE = re.compile(r"\bCode:(?P<code>\S+)", re.IGNORECASE)
_SCNL = re.compile(r"<SCNL>\s*(?P<station>[^.\s]*)\.(?P<channel>\w+)\.(?P<network>[^.\s]*)\.(?P<location>\w*)")
_OF_DIGITIZERS = re.compile(r"counts?|[mµ]?v(?:olts?)?", re.IGNORECASE)
# Numbers of the headers, from 1: azimuth or its code; step [ms].
_AZIMUTH, _STEP = 54, 62
_FULL_TURN, _UP, _DOWN = 360, 400, 401
_MILLISECOND = TimeUnit("ms", 1e-3)


def is_cosmos(text: Text) -> bool:
    """Return whether the first line is that of a COSMOS file."""
    return _COSMOS.match(text.lines[0]) is not None


def read_cosmos(text: Text) -> list[Channel]:
    """Read the accelerations in a COSMOS file of version 1.20; velocities and displacements are left out.

    Parameters
    ----------
    text
        The file.

    Returns
    -------
    list
        One channel for each block of accelerations.

    Raises
    ------
    NoRecordError
        If the file holds no accelerations, but spectra, velocities or displacements.
    FileError
        If the file is cut, a header or a number is wrong or unknown, or the numbers are counts or volts of a digitizer.
    """
    return _read_all(text, _cosmos_block)


def _cosmos_block(text: Text, begin: int) -> tuple[Channel | str, int]:
    first = _expect(text, begin, _COSMOS, f"the first line of a block, with its format v{_COSMOS_VERSION},")
    if first["version"] != _COSMOS_VERSION:
        wrong = f"the version of the format must be {_COSMOS_VERSION}, got {first['version']}"
        raise text.fault(begin, f"{wrong}. Download the file in that version")
    at = begin + int(first["lines"])
    lines = text.lines[begin:at]
    integers, at = _cosmos_header(text, at, _INTEGERS, "the line of the integer header")
    reals, at = _cosmos_header(text, at, _REALS, "the line of the real header")
    count = int(_expect(text, at, _COMMENTS, "the line with the number of comments")["count"])
    for index in range(at + 1, at + 1 + count):
        _expect(text, index, _COMMENT, 'a comment, which begins with "|",')
    comments, at = text.lines[at + 1 : at + 1 + count], at + 1 + count
    series = _expect(text, at, _SERIES, "the line with number, kind, unit and format of the samples")
    kind, unit = series["kind"].lower(), series["unit"].strip()
    if _OF_DIGITIZERS.fullmatch(unit):
        raise text.fault(at, f"raw {unit} of a digitizer, no accelerations. Read the V1 or V2 file of this record")
    tokens, after = _tokens(text, at + 1, text.count(at, "the number of samples", series["count"]), _layout(text, at))
    after += after < len(text.lines) and _END.match(text.lines[after]) is not None
    if "accel" not in kind:
        return kind, after
    channel, names = _first_match(_CHANNEL, lines), _first_match(_SCNL, comments)
    words = channel["direction"] if channel else ""
    name = f"Chan {channel['number'] if channel else '?'}"
    if names:
        name = f"{names['channel']}.{names['location']}".rstrip(".")
    code = _first_match(_CODE, lines)
    station = code["code"].lstrip("-") if code else f"{names['network']}-{names['station']}" if names else ""
    found = _first_match(_UNKNOWN, lines[-1:])
    unknown = float(found["real"]) if found else math.nan
    index, step = _number(text, reals, _STEP)
    if step == unknown:
        raise text.fault(index, f"the time step, real no. {_STEP}, is unknown. Correct the header")
    step = _MILLISECOND.in_seconds(_positive(text, index, step))
    direction = _cosmos_direction(_number(text, integers, _AZIMUTH)[1], words, names["channel"] if names else "")
    component = _component(text, tokens, (at, unit), step, direction, _title(lines[1:], station, name))
    for gap in np.flatnonzero(component.samples == unknown):
        index, token = tokens[gap]
        remedy = "Fill the gap, or trim the file to the samples without gaps"
        raise text.fault(index, f"an unknown sample, {token}. {remedy}")
    return Channel(station, name, component), after


def _cosmos_header(text: Text, at: int, pattern: re.Pattern[str], what: str) -> tuple[list[_Token], int]:
    count = int(_expect(text, at, pattern, what)["count"])
    return _tokens(text, at + 1, count, _layout(text, at), shifted=True)


def _number(text: Text, header: Sequence[_Token], number: int) -> tuple[int, float]:
    """Parse one of the numbers of a header, counted from 1, and return the index of its line first."""
    if len(header) < number:
        last = header[-1][0] if header else 0
        raise text.fault(last, f"the header must have at least {number} numbers, got {len(header)}. {_AGAIN}")
    index, token = header[number - 1]
    return index, text.number(index, token)


def _cosmos_direction(azimuth: float, words: str, channel: str) -> Direction | None:
    if azimuth in (_UP, _DOWN):
        return Direction(vertical=1 if azimuth == _UP else -1)
    if 1 <= azimuth <= _FULL_TURN:
        return Direction(azimuth=azimuth % _FULL_TURN)
    return Direction.parse(words) or direction_of_channel(channel)


# CSMIP, volumes 1 and 2: sections of text lines, integers, reals and up to three series, each with one line before it.
# A. F. Shakal and M. J. Huang, "Standard tape format for CSMIP strong-motion data tapes", California Division of Mines
# and Geology, OSMS 85-03, 1985.
_VOLUME_1 = re.compile(r"\s*Uncorrected accelerogram data\b", re.IGNORECASE)
_CORRECTED = re.compile(
    r"\s*(?P<count>\d+)\s+points of (?P<kind>accel|veloc|displ)\w* data equally spaced at\s+(?P<step>\S+)\s+sec\b\W*"
    r"(?:in|units:)\s+(?P<unit>[^\s)]+)",
    re.IGNORECASE,
)
_UNCORRECTED = re.compile(
    r"\s*(?P<count>\d+)\s+accelerogram points at\s+(?P<rate>\S+)\s+pts/sec in units of\s+(?P<unit>\S+)", re.IGNORECASE
)
_UNEVEN = re.compile(r"\baccel are sec and g\b", re.IGNORECASE)
_STATION = re.compile(r"^\s*Station (?:No|Id)\.\s*(?P<station>\S+)", re.IGNORECASE)
_KINDS = {"veloc": "velocity", "displ": "displacement"}


def is_csmip(text: Text) -> bool:
    """Return whether the first lines are those of a CSMIP file: volume 1, 2 or 3."""
    return any(map(_VOLUME_1.match, text.lines[:3]))


def read_csmip(text: Text) -> list[Channel]:
    """Read the accelerations in a CSMIP file of volume 1 or 2; velocities and displacements are left out.

    Parameters
    ----------
    text
        The file.

    Returns
    -------
    list
        One channel for each section.

    Raises
    ------
    NoRecordError
        If the file holds no accelerations, but spectra (volume 3), velocities or displacements.
    FileError
        If the file is cut, a header or a number is wrong, or the accelerations have uneven times.
    """
    return _read_all(text, _csmip_section)


def _csmip_section(text: Text, begin: int) -> tuple[Channel | str, int]:
    at = first = _csmip_mark(text, begin)
    lines = text.lines[begin:first]
    channel: Channel | None = None
    others = []
    while not _END.match(text.lines[at]):
        corrected = _CORRECTED.match(text.lines[at])
        series = corrected or _UNCORRECTED.match(text.lines[at])
        assert series is not None
        if corrected and corrected["kind"].lower() in _KINDS:
            others.append(_KINDS[corrected["kind"].lower()])
            at = _csmip_mark(text, at + 1)
            continue
        if channel is not None:
            raise text.fault(at, f"the end of data of {channel.name} is missing. {_AGAIN}")
        layout = _layout(text, at) if "(" in text.lines[at][series.end() :] else None
        tokens, after = _tokens(text, at + 1, text.count(at, "the number of points", series["count"]), layout)
        channel = _csmip_channel(text, lines, at, series, tokens)
        at = _csmip_mark(text, after)
        if at != after:
            raise text.fault(after, f"the header states {len(tokens)} samples, the file has more. {_AGAIN}")
    if channel is None and not others:
        uneven = next((index for index, line in enumerate(lines, start=begin) if _UNEVEN.search(line)), None)
        if uneven is not None:
            raise text.fault(uneven, "accelerations at uneven times. Read the corrected file (V2) of this record")
        raise text.fault(at, f"the line with the number of points of accelerations is missing. {_AGAIN}")
    return channel or " and ".join(others), at + 1


def _csmip_mark(text: Text, begin: int) -> int:
    """Return the index of the next line before a series or at the end of a section."""
    for at in range(begin, len(text.lines)):
        if any(pattern.match(text.lines[at]) for pattern in (_END, _CORRECTED, _UNCORRECTED)):
            return at
    raise text.fault(len(text.lines) - 1, f"the last line, with the end of data of a channel, is missing. {_AGAIN}")


def _csmip_channel(
    text: Text, lines: Sequence[str], at: int, series: re.Match[str], tokens: Sequence[_Token]
) -> Channel:
    named = _first_match(_CHANNEL, lines)
    if named is None:
        raise text.fault(at, f"the line with number and direction of the channel is missing before this one. {_AGAIN}")
    found = _first_match(_STATION, lines)
    station, name = found["station"] if found else "", f"Chan {named['number']}"
    event = next((index + 1 for index, line in enumerate(lines) if _VOLUME_1.match(line)), 0)
    title = _title(lines[event:], station, name)
    corrected = series.re is _CORRECTED
    step = _positive(text, at, text.number(at, series["step" if corrected else "rate"]))
    step = step if corrected else 1.0 / step
    unit = at, series["unit"].rstrip(".")
    return Channel(station, name, _component(text, tokens, unit, step, Direction.parse(named["direction"]), title))


# GeoNet: for each component 16 text lines, 40 integers, 60 reals and up to three series, all of them ten numbers a
# line. W. J. Cousins, "GNS accelerogram data files, standard format", GNS Science, New Zealand, 2008.
_GEONET = re.compile(r"\s*(?:Un)?corrected accelerogram\b", re.IGNORECASE)
_SITE = re.compile(r"\s*Site\s+(?P<station>\S+)", re.IGNORECASE)
_OF_GEONET = re.compile(r"\s*Component\s+(?P<direction>\S.*?)\s*(?:\s\s|$)", re.IGNORECASE)
_TENS = _Layout(10, 8)


def is_geonet(text: Text) -> bool:
    """Return whether the first two lines are those of a GeoNet file: V1A or V2A."""
    first, second = (*text.lines, "")[:2]
    return _GEONET.match(first) is not None and _SITE.match(second) is not None


def read_geonet(text: Text) -> list[Channel]:
    """Read the accelerations [mm/s²] in a GeoNet file, V1A or V2A; velocities and displacements are left out.

    Parameters
    ----------
    text
        The file.

    Returns
    -------
    list
        One channel for each component.

    Raises
    ------
    FileError
        If the file is cut, or a header or a number is wrong.
    """
    return _read_all(text, _geonet_component)


def _geonet_component(text: Text, begin: int) -> tuple[Channel | str, int]:
    _expect(text, begin, _GEONET, "the first line of a component")
    station = _expect(text, begin + 1, _SITE, "the line with the site")["station"]
    name = _expect(text, begin + 12, _OF_GEONET, "the line with the direction of the component")["direction"]
    integers, at = _tokens(text, begin + 16, 40, _TENS)
    reals, at = _tokens(text, at, 60, _TENS)
    index, token = integers[33]
    tokens, at = _tokens(text, at, text.count(index, "the number of accelerations, integer no. 34,", token), _TENS)
    for index, token in integers[34:36]:
        if not token.isdecimal():
            raise text.fault(index, f"not a number of samples: {token!r}. Correct the header")
        _, at = _tokens(text, at, int(token), _TENS)
    step = _positive(text, *_number(text, reals, 26))
    year, month, day = (token for _, token in integers[:3])
    date = f"{year}-{month:0>2}-{day:0>2}"
    title = ", ".join(filter(None, (text.lines[begin + 6].strip(), date, station, name)))
    component = _component(text, tokens, (index, "mm/s2"), step, Direction.parse(name), title)
    return Channel(station, name, component), at
