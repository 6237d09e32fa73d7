"""Parsing of file names: common part of an event and direction of a component."""

import re
from pathlib import Path

from stylobate.base_motions.records.component import CHANNEL, QUADRANT, WORDS, Direction

_ENDINGS = {".at2", ".txt", ".csv", ".dat", ".asc", ".acc"}
# The suffix of a processed copy stays in the name of the event: copy and original are different events.
_REMARK = (
    r"(?P<remark>(?i:[-_. ](?:scaled|filtered|corrected|corr?|uncorrected|matched|processed|proc|raw|resampled|trimmed"
    r"|accel|acceleration|acc))*)"
)
_ITS_REMARK = re.compile(rf".*?{_REMARK}")
_WORDS = "|".join(sorted(WORDS, key=len, reverse=True))
_APART = rf"[-_. ]+(?P<apart>(?i:{_WORDS})|{CHANNEL}|(?i:{QUADRANT})|\d{{3}})"
# More digits than these are a date or a time: 20160117 is not azimuth 117.
_DIGITS = r"(?<!\d{3})\d{3}"
_CAPITALS = "NS|EW|UP|DWN|DOWN|UD|VER|VERT|XTE|YLN|ZUP"
_JOINED = rf"(?P<joined>(?i:{QUADRANT})|{_CAPITALS}|(?<=\d)(?i:{_CAPITALS})|{_DIGITS})"
_UNSURE = r"(?P<joined>(?<!\d{5})\d{3}|[HLT][12]|[NESWLTVZXY])"
_TAIL = re.compile(rf"(?P<event>.+?)(?:{_APART}|{_JOINED}){_REMARK}")
_UNSURE_TAIL = re.compile(rf"(?P<event>.+?){_UNSURE}{_REMARK}")
_HEAD = re.compile(r"(?P<apart>(?i:NS|EW|UD|UP|N-S|E-W|U-D|DWN|VER|VERT|H1|H2))[-_. ]+(?P<event>.+)")
_NUMBERED = re.compile(rf".+?(?:[-_. ]|(?<!\d{{3}}))\d{{3}}{_REMARK}")
_FIELD = re.compile(rf"(?P<event>.+[-_. ])(?P<apart>{CHANNEL})(?P<remark>[-_. ].+)")
# K-NET and KiK-net: AKT0239608110312.EW, …EW1 below and …EW2 on the ground.
_KIK_NET = re.compile(r"(?P<event>.+)\.(?P<apart>NS|EW|UD)(?P<remark>[12])")
_NUMBER = re.compile(r"(?:^|[-_. ])(?:RSN|NGA[-_]no)[-_]?0*(\d+)(?!\d)", re.IGNORECASE)


def stem_of(path: Path) -> str:
    """Return the name of a file without the suffixes of its format; suffixes such as `.EW` stay.

    >>> stem_of(Path("a/PAE000.AT2.txt")), stem_of(Path("AKT023.EW")), stem_of(Path("IU.ANMO.00.HNE"))
    ('PAE000', 'AKT023.EW', 'IU.ANMO.00.HNE')
    """
    name = path.name.removesuffix(".gz").removesuffix(".zip")
    stem, _, ending = name.rpartition(".")
    if not stem or _KIK_NET.fullmatch(name) or (not ending.isdigit() and Direction.parse(ending)):
        return name
    while stem[stem.rfind(".") :].lower() in _ENDINGS:
        stem = stem[: stem.rfind(".")]
    return stem


def split_name(stem: str, *, unsure: bool = False) -> tuple[str, Direction | None]:
    """Split the name of a file into the common part of its event and the direction of its component.

    Parameters
    ----------
    stem
        The name without the suffix of its format.
    unsure
        Whether a single letter, or digits after many digits, also count, as in PRPCS, PRPCW; use this only if the files
        are known to belong to one event.

    Examples
    --------
    >>> split_name("RSN753_LOMAP_CLS090")
    ('RSN753_LOMAP_CLS', Direction(azimuth=90.0, vertical=0, axis=None))
    >>> [split_name(stem)[0] for stem in ("ALH-UP", "site_N-S", "NS_quake", "PAE000_scaled", "El Centro")]
    ['ALH', 'site', 'quake', 'PAE_scaled', 'El Centro']
    """
    patterns = (_KIK_NET, _TAIL, _HEAD, _FIELD, *((_UNSURE_TAIL,) if unsure else ()))
    for pattern in patterns:
        if found := pattern.fullmatch(stem):
            parts = found.groupdict()
            direction = Direction.parse(parts.get("apart") or parts["joined"])
            event = f"{parts['event'].rstrip('-_. ')}{parts.get('remark') or ''}"
            if direction is not None and parts["event"].strip("-_. "):
                return event, direction
    return stem, None


def is_numbered(stem: str) -> bool:
    """Return whether a name ends with three digits, which may be an azimuth or a serial number.

    >>> [is_numbered(stem) for stem in ("CLS090", "quake_050_scaled", "q_N10E", "quake_20160117", "TAB-L1")]
    [True, True, False, False, False]
    """
    return _NUMBERED.fullmatch(stem) is not None


def remark_of(stem: str) -> str:
    """Return the suffix of a name that marks a processed copy, or an empty string.

    >>> remark_of("CLS090_scaled"), remark_of("CLS090_Filtered-raw"), remark_of("CLS090")
    ('_scaled', '_filtered-raw', '')
    """
    found = _ITS_REMARK.fullmatch(stem)
    return found["remark"].lower() if found else ""


def record_number(stem: str) -> int | None:
    """Return the record number of the PEER databases, one per set of components, or None.

    >>> record_number("RSN0753_LOMAP_CLS000"), record_number("NGA_no_1106_KJM000"), record_number("CLS000")
    (753, 1106, None)
    """
    found = _NUMBER.search(stem)
    return int(found[1]) if found else None
