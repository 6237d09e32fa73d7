"""Units of acceleration and of time, and their spellings."""

from typing import NamedTuple

from stylobate.column import STANDARD_GRAVITY
from stylobate.errors import ParameterError

_FACTORS = {"g": STANDARD_GRAVITY, "m/s²": 1.0, "cm/s²": 0.01, "mm/s²": 0.001}
KNOWN = '"g", "m/s²" (m/s2), "cm/s²" (cm/s2, gal) or "mm/s²"'
"""List of the units for messages."""

_SPELLINGS = {
    "g": "g",
    "m/s2": "m/s²",
    "m/s/s": "m/s²",
    "ms-2": "m/s²",
    "cm/s2": "cm/s²",
    "cm/s/s": "cm/s²",
    "cms-2": "cm/s²",
    "gal": "cm/s²",
    "gals": "cm/s²",
    "mm/s2": "mm/s²",
    "mm/s/s": "mm/s²",
}


class TimeUnit(NamedTuple):
    """Unit of the times in a file: its symbol, and its length [s]."""

    symbol: str
    seconds: float

    def in_seconds(self, time: float) -> float:
        """Convert a time in this unit to s, without the last digits of the product: 35 ms are 0.035 s."""
        return time if self.seconds == 1.0 else float(f"{time * self.seconds:.14g}")


SECOND = TimeUnit("s", 1.0)
_TIME_SPELLINGS = {
    SECOND: "s sec secs second seconds sek sekunde sekunden seconde secondes secondi seg segundo segundos",
    TimeUnit("ms", 1e-3): "ms msec msecs millisecond milliseconds",
    TimeUnit("µs", 1e-6): "µs us µsec usec microsecond microseconds",
    TimeUnit("min", 60.0): "min mins minute minutes",
}
_TIME_UNITS = {spelling: unit for unit, spellings in _TIME_SPELLINGS.items() for spelling in spellings.split()}
_GREEK_MU, _MICRO_SIGN = "μ", "µ"


def unit_of(text: str) -> str | None:
    """Parse a unit to "g", "m/s²", "cm/s²" or "mm/s²", or None.

    >>> unit_of("CM/SEC**2"), unit_of("gal"), unit_of("volt")
    ('cm/s²', 'cm/s²', None)
    """
    plain = text.strip().lower().replace(" ", "").replace("sec", "s").replace("²", "2").replace("⁻", "-")
    return _SPELLINGS.get(plain.replace("**", "").replace("^", ""))


def time_unit_of(text: str) -> TimeUnit | None:
    """Parse a unit of time: s, ms, µs or min; None for other units.

    >>> time_unit_of("Sec."), time_unit_of("ms"), time_unit_of("samples")
    (TimeUnit(symbol='s', seconds=1.0), TimeUnit(symbol='ms', seconds=0.001), None)
    """
    return _TIME_UNITS.get(text.strip().lower().replace(_GREEK_MU, _MICRO_SIGN).rstrip("."))


def unknown_unit(text: str) -> str:
    """Describe, for a message, a unit in a file that `unit_of` does not know."""
    return f"unknown unit {text!r}. Give accelerations in {KNOWN}, and state that unit"


def require_unit(text: str) -> str:
    """Parse a unit, or raise ParameterError.

    Raises
    ------
    ParameterError
        If the unit is unknown.
    """
    unit = unit_of(text) if isinstance(text, str) else None
    if unit is None:
        message = f"units must be {KNOWN}, got {text!r}"
        raise ParameterError(message)
    return unit


def in_si(unit: str) -> float:
    """Return the factor from a `unit` of `unit_of` to m/s²; g is standard gravity, 9.80665 m/s²."""
    return _FACTORS[unit]
