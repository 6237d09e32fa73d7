"""Component of a ground motion as read from a file, and its direction."""

import re
from dataclasses import dataclass
from typing import Self

import numpy as np
import numpy.typing as npt

from stylobate.errors import ParameterError

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
            message = (
                f'a direction must be an azimuth in degrees or "up", got {given!r}; or "down", or a name as N10E, L'
            )
            raise ParameterError(message)
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
