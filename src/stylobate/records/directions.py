"""Directions of components: their names, in files too, and rotation to the axes x, y and z."""

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple, Self

import numpy as np
import numpy.typing as npt

from stylobate.base_motions.signal_processing import Floats
from stylobate.errors import FileError, ParameterError

_FULL_TURN, _HALF_TURN = 360.0, 180.0
_COMPASS = {
    **dict.fromkeys(("N", "NS", "N-S", "NSC", "NORTH"), 0.0),
    **dict.fromkeys(("E", "EW", "E-W", "WE", "WEC", "EAST"), 90.0),
    **dict.fromkeys(("S", "SOUTH"), 180.0),
    **dict.fromkeys(("W", "WEST"), 270.0),
}
_UP = {"UP", "UPC", "V", "Z", "ZUP", "UD", "U-D", "VER", "VERT", "VRT", "VERTICAL"}
_DOWN = {"DN", "DWN", "DOWN"}
_ACROSS = {
    **dict.fromkeys(("L", "L1", "LONG", "LONGITUDINAL", "H1", "X", "XTE", "R", "FN"), "x"),
    **dict.fromkeys(("T", "T1", "TRAN", "TRANS", "TRANSVERSE", "H2", "Y", "YLN", "FP"), "y"),
}
WORDS = frozenset({*_COMPASS, *_UP, *_DOWN, *_ACROSS})
"""Words for directions, in capitals."""

QUADRANT = r"[NS]\s*\d{1,3}(?:\.\d+)?\s*°?\s*[EW]"
"""Bearings from north or south, such as N10E, S61W."""
CHANNEL = r"[BEH][GHLN][ENZ12]"
"""SEED codes of accelerometers and seismometers, such as HNE, BHZ."""

_AZIMUTH = re.compile(r"(\d{1,3}(?:\.\d+)?)\s*(?:DEG\w*|°)?\.?")
_BEARING = re.compile(QUADRANT.replace(r"\d{1,3}(?:\.\d+)?", r"(\d{1,3}(?:\.\d+)?)"))
_CHANNEL = re.compile(CHANNEL)
_OF_CHANNEL = {"1": "H1", "2": "H2"}


@dataclass(frozen=True, slots=True)
class Direction:
    """Direction in which a component is positive: a compass azimuth, up or down, or one of two perpendicular axes.

    Parameters
    ----------
    azimuth
        Clockwise from north [degrees].
    vertical
        +1 for up, −1 for down, 0 for horizontal.
    axis
        "x" or "y" for horizontal components whose azimuths are unknown but which are perpendicular, such as L and T,
        H1 and H2.
    """

    azimuth: float | None = None
    vertical: int = 0
    axis: str | None = None

    @classmethod
    def parse(cls, text: str) -> Self | None:
        """Parse the direction in a name such as "090", "NS", "S61W", "HNZ", "UP" or "L1"; None for other names.

        >>> Direction.parse("360").azimuth, Direction.parse("up").vertical, Direction.parse("Corralitos")
        (0.0, 1, None)
        >>> [Direction.parse(name).azimuth for name in ("N10E", "S80E", "S61W", "N20W", "HNE")]
        [10.0, 100.0, 241.0, 340.0, 90.0]
        >>> Direction.parse("L1").axis, Direction.parse("H2").axis
        ('x', 'y')
        """
        plain = text.strip().upper()
        if _CHANNEL.fullmatch(plain):
            plain = _OF_CHANNEL.get(plain[-1], plain[-1])
        if plain in _UP or plain in _DOWN:
            return cls(vertical=1 if plain in _UP else -1)
        if plain in _COMPASS:
            return cls(azimuth=_COMPASS[plain])
        if plain in _ACROSS:
            return cls(axis=_ACROSS[plain])
        if (found := _AZIMUTH.fullmatch(plain)) and float(found[1]) <= _FULL_TURN:
            return cls(azimuth=float(found[1]) % _FULL_TURN)
        if (found := _BEARING.fullmatch(plain)) and float(found[1]) <= _HALF_TURN:
            turn = float(found[1]) if (plain[0] == "N") == (plain[-1] == "E") else -float(found[1])
            return cls(azimuth=((0.0 if plain[0] == "N" else _HALF_TURN) + turn) % _FULL_TURN)
        return None

    @classmethod
    def of(cls, given: "float | str | Direction") -> "Direction":
        """Convert an azimuth [degrees] or a name to a direction.

        Raises
        ------
        ParameterError
            If it is neither.
        """
        if isinstance(given, Direction):
            return given
        try:
            found = cls.parse(given if isinstance(given, str) else f"{float(given) % _FULL_TURN:.6f}")
        except (TypeError, ValueError):
            found = None
        if found is None:
            raise ParameterError(
                f'a direction must be an azimuth in degrees or "up", got {given!r}; or "down", or a name as N10E, L'
            )
        return found

    def agrees_with(self, other: "Direction") -> bool:
        """Return whether both can describe one component; a name may leave the sign along a line open."""
        if self.azimuth is None or other.azimuth is None:
            return bool(self.vertical) == bool(other.vertical)
        return (self.azimuth - other.azimuth) % _HALF_TURN == 0.0

    def __str__(self) -> str:
        if self.vertical:
            return "up" if self.vertical > 0 else "down"
        if self.axis is not None:
            return f"{'first' if self.axis == 'x' else 'second'} of two perpendicular axes"
        return f"azimuth {self.azimuth:g}°"


@dataclass(frozen=True, slots=True, kw_only=True)
class Component:
    """Accelerations of one component from a file, in the unit of the file.

    `samples` has the shape (n,), or (n, 3) if a file holds x, y and z; `unit` is None if the file does not state it.
    `states_time_unit` is whether the file or its format states the unit of time; otherwise it is assumed to be s.
    """

    samples: npt.NDArray[np.float64]
    step: float
    unit: str | None
    start: float = 0.0
    direction: Direction | None = None
    title: str = ""
    states_time_unit: bool = True


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
# Characters of the name of a file at most, on usual systems: a longer text, in an archive or above a column, names no
# direction. The time of these patterns grows with the third power of the length of a name.
_LONGEST_NAME = 255
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
    for pattern in patterns if len(stem) <= _LONGEST_NAME else ():
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
    return len(stem) <= _LONGEST_NAME and _NUMBERED.fullmatch(stem) is not None


def remark_of(stem: str) -> str:
    """Return the suffix of a name that marks a processed copy, or an empty string.

    >>> remark_of("CLS090_scaled"), remark_of("CLS090_Filtered-raw"), remark_of("CLS090")
    ('_scaled', '_filtered-raw', '')
    """
    found = _ITS_REMARK.fullmatch(stem) if len(stem) <= _LONGEST_NAME else None
    return found["remark"].lower() if found else ""


def record_number(stem: str) -> int | None:
    """Return the record number of the PEER databases, one per set of components, or None.

    >>> record_number("RSN0753_LOMAP_CLS000"), record_number("NGA_no_1106_KJM000"), record_number("CLS000")
    (753, 1106, None)
    """
    found = _NUMBER.search(stem)
    return int(found[1]) if found else None


# Tolerance of a right angle between azimuths that are rounded in file names [degrees].
_RIGHT_ANGLE_TOLERANCE = 2.0
# Minimum sine of the angle between horizontal components that determine the motion.
_LEAST_SINE = 0.5


class Directed(NamedTuple):
    """Accelerations of shape (n,) that are positive in this direction, with their file or column."""

    label: str
    direction: Direction
    samples: Floats


def is_one_set(directions: Sequence[Direction]) -> bool:
    """Return whether one event can have these directions: at most one vertical and two perpendicular horizontal ones.

    >>> is_one_set([Direction(azimuth=0.0), Direction(azimuth=90.0)]), is_one_set([Direction(axis="x")] * 2)
    (True, False)
    """
    flat = [one for one in directions if not one.vertical]
    return len(directions) - len(flat) <= 1 and len(flat) <= 2 and (len(flat) < 2 or _sine(*flat) != 0.0)  # noqa: PLR2004


def are_perpendicular(first: Direction, second: Direction) -> bool:
    """Return whether two azimuths differ by a right angle, within 2°.

    >>> a, b, c = (Direction(azimuth=azimuth) for azimuth in (55.0, 325.0, 100.0))
    >>> are_perpendicular(a, b), are_perpendicular(a, c)
    (True, False)
    """
    if first.azimuth is None or second.azimuth is None:
        return False
    return abs((second.azimuth - first.azimuth) % 180.0 - 90.0) <= _RIGHT_ANGLE_TOLERANCE


def along_axes(event: str, components: Sequence[Directed]) -> tuple[dict[str, Floats], str]:
    """Rotate components to x, y and z; return the accelerations by axis, and their origin as a line of text.

    Raises
    ------
    FileError
        If there are more than two horizontal components or one vertical, or two are not independent.

    Notes
    -----
    x points along the lower azimuth θ1 of two, y 90° anticlockwise from x, z up, see `read_records`. Two perpendicular
    components of unknown azimuth are x and y, in the order of their axes.
    """
    up = [one for one in components if one.direction.vertical]
    flat = sorted((one for one in components if not one.direction.vertical), key=_order)
    if len(up) > 1 or len(flat) > 2:  # noqa: PLR2004
        raise FileError(
            f"{event}: two horizontal components and a vertical one at most, got {_listed(components)}. If they are of "
            "several events, list the files of each event together"
        )
    axes, lines = _horizontal(event, flat)
    if up:
        axes["z"] = up[0].direction.vertical * up[0].samples
        lines.append(f"z up, from {up[0].label} ({up[0].direction})")
    return axes, "; ".join(lines)


def _order(one: Directed) -> float:
    return one.direction.azimuth if one.direction.azimuth is not None else float(one.direction.axis == "y")


def _listed(components: Sequence[Directed]) -> str:
    return ", ".join(f"{one.label} ({one.direction})" for one in components)


def _sine(first: Direction, second: Direction) -> float:
    """Return the sine of the angle between two horizontal directions; 0 if they are not independent."""
    if first.azimuth is None or second.azimuth is None:
        return float(None not in (first.axis, second.axis) and first.axis != second.axis)
    sine = math.sin(math.radians(second.azimuth - first.azimuth))
    return sine if abs(sine) >= _LEAST_SINE else 0.0


def _horizontal(event: str, flat: list[Directed]) -> tuple[dict[str, Floats], list[str]]:
    if not flat:
        return {}, []
    first = flat[0]
    if len(flat) == 1:
        where = f"at {first.direction}" if first.direction.axis is None else f"along the {first.direction}"
        return {"x": first.samples}, [f"x {where}, from {first.label}"]
    second = flat[1]
    if _sine(first.direction, second.direction) == 0.0:
        raise FileError(
            f"{event}: horizontal components must be perpendicular, or nearly so, got {_listed(flat)}. State "
            "directions, or list the files of each event together"
        )
    if first.direction.azimuth is None or second.direction.azimuth is None:
        lines = [
            f"{axis} from {one.label} ({one.direction}, azimuth unknown)" for axis, one in zip("xy", flat, strict=True)
        ]
        return {"x": first.samples, "y": second.samples}, lines
    turn = math.radians(second.direction.azimuth - first.direction.azimuth)
    # exact right angles: the rounding error of cos 90° must not mix the components
    across = abs(math.cos(turn)) < 1e-12  # noqa: PLR2004
    cos, sin = (0.0, math.copysign(1.0, math.sin(turn))) if across else (math.cos(turn), math.sin(turn))
    lines = [
        f"x at {first.direction}, from {first.label}",
        f"y at azimuth {(first.direction.azimuth - 90.0) % 360.0:g}°, from {second.label} ({second.direction})",
    ]
    return {"x": first.samples, "y": (first.samples * cos - second.samples) / sin}, lines
