"""One component as a file gives it, and which way it points."""

import re
from dataclasses import dataclass
from typing import Self

import numpy as np
import numpy.typing as npt

from stylobate.errors import ParameterError

_FULL_TURN = 360.0
_COMPASS = {"N": 0.0, "NS": 0.0, "N-S": 0.0, "E": 90.0, "EW": 90.0, "E-W": 90.0, "S": 180.0, "W": 270.0}
_UP = {"UP", "V", "Z", "UD", "U-D", "VER", "VERT", "VRT", "VERTICAL"}
_DOWN = {"DN", "DWN", "DOWN"}
_AZIMUTH = re.compile(r"[NS]?\s*(\d{1,3}(?:\.\d+)?)\s*(?:DEG\w*|°)?\.?")
# Tails of file names: three digits anywhere, names of directions behind a separator.
_NAMES = "|".join(sorted({*_COMPASS, *_UP, *_DOWN}))
_TAIL = re.compile(rf"(?P<event>.*?)(?:(?P<digits>\d{{3}})|[-_. ](?P<letters>{_NAMES}))", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class Direction:
    """Which way a component is positive: at a compass `azimuth`, clockwise from north [degrees], or up or down.

    `vertical` is +1 for up, −1 for down and 0 for horizontal.
    """

    azimuth: float | None = None
    vertical: int = 0

    @classmethod
    def parse(cls, text: str) -> Self | None:
        """Return the direction that a name such as "090", "NS" or "UP" tells, or None.

        >>> Direction.parse("360"), Direction.parse("up").vertical, Direction.parse("Corralitos")
        (Direction(azimuth=0.0, vertical=0), 1, None)
        """
        plain = text.strip().upper()
        if plain in _UP or plain in _DOWN:
            return cls(vertical=1 if plain in _UP else -1)
        if plain in _COMPASS:
            return cls(azimuth=_COMPASS[plain])
        found = _AZIMUTH.fullmatch(plain)
        if found and plain[0].isdigit() and float(found[1]) <= _FULL_TURN:
            return cls(azimuth=float(found[1]) % _FULL_TURN)
        return None

    @classmethod
    def of(cls, given: "float | str | Direction") -> "Direction":
        """Return the direction somebody gives as an azimuth [degrees] or a name.

        Raises
        ------
        ParameterError
            If it is neither.
        """
        if isinstance(given, Direction):
            return given
        found = cls.parse(given if isinstance(given, str) else f"{float(given) % _FULL_TURN:.6f}")
        if found is None:
            message = f'a direction must be an azimuth in degrees or "up", got {given!r}'
            raise ParameterError(message)
        return found

    def __str__(self) -> str:
        if self.vertical:
            return "up" if self.vertical > 0 else "down"
        return f"azimuth {self.azimuth:g}°"


def split_name(stem: str) -> tuple[str, Direction | None]:
    """Return the part of a file's name that its components share, and the direction the rest tells.

    >>> split_name("RSN753_LOMAP_CLS090")
    ('RSN753_LOMAP_CLS', Direction(azimuth=90.0, vertical=0))
    >>> split_name("ALH-UP")[0], split_name("site_N-S")[0], split_name("El Centro")
    ('ALH', 'site', ('El Centro', None))
    """
    found = _TAIL.fullmatch(stem)
    direction = Direction.parse(found["digits"] or found["letters"]) if found else None
    if found is None or direction is None or not found["event"]:
        return stem, None
    return found["event"].rstrip("-_. "), direction


@dataclass(frozen=True, slots=True, kw_only=True)
class Component:
    """Accelerations of one component from a file, in the unit of the file.

    `samples` has the shape (n,), or (n, 3) where a file holds x, y and z; `unit` is None where the file does not tell.
    """

    samples: npt.NDArray[np.float64]
    step: float
    unit: str | None
    start: float = 0.0
    direction: Direction | None = None
    title: str = ""
