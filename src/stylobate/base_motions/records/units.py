"""Units of acceleration and their spellings."""

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


def unit_of(text: str) -> str | None:
    """Parse a unit to "g", "m/s²", "cm/s²" or "mm/s²", or None.

    >>> unit_of("CM/SEC**2"), unit_of("gal"), unit_of("volt")
    ('cm/s²', 'cm/s²', None)
    """
    plain = text.strip().lower().replace(" ", "").replace("sec", "s").replace("²", "2").replace("⁻", "-")
    return _SPELLINGS.get(plain.replace("**", "").replace("^", ""))


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
