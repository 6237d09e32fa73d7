"""Units: numbers with a unit in text, and quantities of pint or astropy, become numbers in a declared unit.

One table serves both. A conversion is rounded once: "1.2 mm" is the float 0.0012.
"""

import math
import re
from collections.abc import Callable
from difflib import get_close_matches
from fractions import Fraction
from functools import cache
from typing import Any, NamedTuple


class UnitError(ValueError):
    """A unit that is unknown or has another dimension; the message continues the name of the argument."""


class Unit(NamedTuple):
    """A unit: its size in SI units, and its powers of metre, kilogram, second and radian."""

    size: Fraction
    powers: tuple[int, ...]


_NONE, _LENGTH, _MASS, _TIME, _ANGLE = (0, 0, 0, 0), (1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1)
_FREQUENCY, _ACCELERATION, _FORCE = (0, 0, -1, 1), (1, 0, -2, 0), (1, 1, -2, 0)
_TURN = Fraction(2.0 * math.pi)

_WITH_PREFIXES = {
    "m": Unit(Fraction(1), _LENGTH),
    "g": Unit(Fraction(1, 1000), _MASS),
    "s": Unit(Fraction(1), _TIME),
    "rad": Unit(Fraction(1), _ANGLE),
    "Hz": Unit(_TURN, _FREQUENCY),  # turns per second
    "N": Unit(Fraction(1), _FORCE),
    "g0": Unit(Fraction("9.80665"), _ACCELERATION),
    "Gal": Unit(Fraction(1, 100), _ACCELERATION),
}
_PREFIXES = {"n": -9, "µ": -6, "μ": -6, "u": -6, "m": -3, "c": -2, "d": -1, "k": 3, "M": 6, "G": 9}
_UNITS = {
    **{
        f"{prefix}{name}": Unit(Fraction(10) ** power * one.size, one.powers)
        for prefix, power in _PREFIXES.items()
        for name, one in _WITH_PREFIXES.items()
    },
    **_WITH_PREFIXES,
    "in": Unit(Fraction("0.0254"), _LENGTH),
    "ft": Unit(Fraction("0.3048"), _LENGTH),
    "lb": Unit(Fraction("0.45359237"), _MASS),
    "t": Unit(Fraction(1000), _MASS),
    "min": Unit(Fraction(60), _TIME),
    "h": Unit(Fraction(3600), _TIME),
    "a": Unit(Fraction(31_557_600), _TIME),
    "deg": Unit(_TURN / 360, _ANGLE),
    "turn": Unit(_TURN, _ANGLE),
    "rpm": Unit(_TURN / 60, _FREQUENCY),
    "%": Unit(Fraction(1, 100), _NONE),
    "": Unit(Fraction(1), _NONE),
    "1": Unit(Fraction(1), _NONE),
}
_OTHER_NAMES = {"°": "deg", "degrees": "deg", "rev": "turn", "cycle": "turn", "g_0": "g0", "g_n": "g0"}
_OTHER_NAMES |= {"inch": "in", "inches": "in", "feet": "ft", "lbs": "lb", "kgs": "kg"}
_OF_ACCELERATIONS = {"g": "g0", "mg": "mg0", "gal": "Gal"}
"""Names in a text that states an acceleration; elsewhere g is the gram."""

_USUAL = (
    *("mm cm m in ft", "g kg t lb", "s ms min", "deg rad mrad turn", "Hz rpm rad/s", "cm/s² m/s² g", "mm/s cm/s m/s"),
    *("g/cm³ t/m³ kg/m³", "g·cm² kg·m²"),
)
"""Usual units of one dimension each. A number far outside of its range was most likely meant in the first of them."""

_COUNTING_TURNS = {"1/min": "rpm", "Hz": "Hz", "rad/s": "rad/s"}
"""Declared units of frequencies. Other packages take 1 Hz for 1 rad/s, so that they do not convert these."""

_SUPERSCRIPTS = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-")
_NUMBER = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(\S.*?)?\s*")
_BETWEEN = re.compile(r"[\s*·⋅()]+")
_FACTOR = re.compile(r"(\D+?)\^?(-?\d+)?")
# A number between these times the size of a unit is a float.
_SMALLEST, _LARGEST = 1e-200, 1e200
_LIKENESS = 0.5


def read(text: str, unit: str) -> float:
    """Read a number with or without a unit, such as "1.2 mm", in the declared `unit`.

    A number without a unit is in the declared one. Of accelerations, "g" is standard gravity. "Hz" counts turns: 1 Hz
    is 2π rad/s.

    Raises
    ------
    UnitError
        If the text is no number, or its unit is unknown or has another dimension.

    Examples
    --------
    >>> read("1.2mm", "m"), read("25 deg", "rad"), read("0.3 g", "m/s²"), read("300rpm", "Hz"), read("2", "m")
    (0.0012, 0.4363323129985824, 2.941995, 5.0, 2.0)
    """
    number, given = split(text)
    if given:
        return _product(number, _ratio(given, unit, text.strip(), in_text=True))
    try:
        return float(number)
    except ValueError:
        raise UnitError(f"must be {'a number, with or without a unit' if unit else 'a number'}, got {text!r}") from None


def split(text: str) -> tuple[str, str]:
    """Split a text into its number and its unit; the unit is "" if the text is no number with a unit."""
    found = _NUMBER.fullmatch(text)
    return (text, "") if found is None else (found[1], found[2] or "")


def is_number(text: str) -> bool:
    """Return whether a text is a number, with or without a unit."""
    number, _ = split(text)
    try:
        float(number)
    except ValueError:
        return False
    return True


def has_unit(value: Any) -> bool:
    """Return whether a value is a number with a unit in text, or a list with such a text."""
    if isinstance(value, (list, tuple)):
        return any(map(has_unit, value))
    return isinstance(value, str) and bool(split(value)[1])


def read_all(value: Any, unit: str) -> Any:
    """Read a text, or the texts of a list, that are numbers with a unit; other values are unchanged."""
    if isinstance(value, (list, tuple)):
        return [read_all(one, unit) for one in value]
    return read(value, unit) if has_unit(value) else value


def in_unit(value: Any, unit: str) -> Any:
    """Convert a quantity of pint or astropy, or a list of quantities, to numbers in the declared `unit`.

    Other values are returned unchanged. Quantities are recognized by their attributes; no package is imported.

    Raises
    ------
    UnitError
        If the unit is unknown or has another dimension, or if the quantity is inside a labelled array.
    """
    kind: Any = type(value)
    if kind in (list, tuple):
        inner: Any = set(map(type, value))
        return value if all(map(_is_plain, inner)) else [in_unit(one, unit) for one in value]
    if _is_plain(kind):
        return value
    if _is_quantity(kind):
        return _converted(value, unit)
    inside: Any = type(getattr(value, "data", None))
    if _is_quantity(inside) or hasattr(getattr(value, "dtype", None), "units"):
        raise UnitError(f"must not be a labelled array with a unit. Convert it to plain numbers in {unit or 'no unit'}")
    return value


def is_angle(unit: str) -> bool:
    """Return whether a unit is that of an angle or a share, and the same for every column."""
    return getattr(_unit(unit), "powers", _NONE) in (_NONE, _ANGLE)


def size_of(unit: str) -> Unit | None:
    """Return size and dimension of a declared unit; None for an unknown unit."""
    return _unit(_COUNTING_TURNS.get(unit, unit))


def spelled(text: str) -> str:
    """Return a unit as this module knows it from the heading of a table, such as "KG" or "in."; "" if it is no unit.

    >>> spelled("KG"), spelled("in."), spelled("m/s²"), spelled("approx."), spelled("kg/m3")
    ('kg', 'in', 'm/s²', '', 'kg/m3')
    """
    plain = text.strip()
    return next((one for one in (plain, plain.rstrip("."), plain.lower().rstrip(".")) if one and _unit(one)), "")


def listed(unit: str) -> str:
    """List the usual units of the dimension of a declared unit."""
    *others, last = _usual(unit)
    return f"{', '.join(others)} or {last}" if others else last


def meant(number: float, unit: str, fits: Callable[[float], bool]) -> str:
    """Suggest the first usual unit for a number if it `fits` in this unit; "" if not.

    >>> meant(1.2, "m", lambda stroke: stroke < 0.5)
    'For 1.2 mm give 0.0012 m.'
    """
    other = _usual(unit)[0]
    value = read(f"{number!r} {other}", unit)
    return f"For {number:.6g} {other} give {value:.4g} {unit}." if other != unit and fits(value) else ""


def _converted(value: Any, unit: str) -> Any:
    import numpy as np

    pint = hasattr(value, "dimensionality")
    given = format(value.units, "~C") if pint else str(value.units if hasattr(value, "units") else value.unit)
    numbers = value.magnitude if pint else value.value
    got = f"{numbers} {given}".rstrip() if np.ndim(numbers) == 0 else f"numbers in {given or 'no unit'}"
    if _unit(given) is None and unit not in _COUNTING_TURNS:
        try:  # a unit that only the package of the quantity knows
            converted = value.to(_BETWEEN.sub("*", unit.translate(_SUPERSCRIPTS)))
            given, numbers = unit, converted.magnitude if pint else converted.value
        except (TypeError, ValueError, AttributeError):
            pass
    ratio = _ratio(given, unit, got)
    try:
        array = np.asarray(numbers, dtype=float)
    except (TypeError, ValueError):
        raise UnitError(f"must be real numbers, got {got}") from None
    if ratio != 1:
        exact = [_product(repr(number), ratio) for number in array.ravel().tolist()]
        array = np.array(exact, dtype=float).reshape(array.shape)
    return array if array.ndim else float(array)


def _ratio(given: str, unit: str, got: str, *, in_text: bool = False) -> Fraction:
    """Return the size of a unit in the declared unit."""
    if given == unit:
        return Fraction(1)
    declared = size_of(unit)
    of_acceleration = in_text and declared is not None and declared.powers == _ACCELERATION
    found = _unit(given, of_acceleration)
    if declared is not None and found is not None:
        number_for_angle = unit in ("rad", "1") and found.powers in (_NONE, _ANGLE)
        if number_for_angle or found.powers == declared.powers:
            return found.size / declared.size
    similar = get_close_matches(given, _usual(unit), n=1, cutoff=_LIKENESS) if found is None else ()
    question = f". Did you mean {similar[0]}?" if similar else ""
    wanted = "a number without unit" if unit in ("", "1") else f"in {listed(unit)}"
    raise UnitError(f"must be {wanted}, got {got}{question}")


def _product(number: str, ratio: Fraction) -> float:
    """Return the float next to a decimal number times a ratio; beyond all sizes of columns, the product of floats."""
    rounded = float(number)
    return float(Fraction(number) * ratio) if _SMALLEST < abs(rounded) < _LARGEST else rounded * float(ratio)


@cache
def _usual(unit: str) -> tuple[str, ...]:
    """Return the usual units of the dimension of a declared unit."""
    powers = getattr(size_of(unit), "powers", None)
    groups = (tuple(group.split()) for group in _USUAL)
    return next((group for group in groups if getattr(_unit(group[0]), "powers", None) == powers), (unit,))


@cache
def _unit(text: str, of_acceleration: bool = False) -> Unit | None:
    """Return the product of powers in a text, such as "kg m²", "m/s**2" or "m s-2"; None if a unit is unknown."""
    above, _, below = text.translate(_SUPERSCRIPTS).replace("**", "^").partition("/")
    size, powers = _UNITS[""]
    for factors, sign in ((above, 1), (below.replace("/", " "), -1)):
        for factor in filter(None, _BETWEEN.split(factors)):
            found = _FACTOR.fullmatch(factor)
            name, power = (factor, "1") if _named(factor) or found is None else (found[1], found[2] or "1")
            one = _named(_OF_ACCELERATIONS.get(name, name) if of_acceleration else name)
            if one is None:
                return None
            exponent = sign * int(power)
            size *= one.size**exponent
            powers = tuple(have + exponent * more for have, more in zip(powers, one.powers, strict=True))
    return Unit(size, powers)


def _named(name: str) -> Unit | None:
    return _UNITS.get(_OTHER_NAMES.get(name, name))


@cache
def _is_plain(kind: type) -> bool:
    return kind.__module__ in ("builtins", "numpy") and not issubclass(kind, (list, tuple))


@cache
def _is_quantity(kind: type) -> bool:
    return hasattr(kind, "to") and (hasattr(kind, "units") or hasattr(kind, "unit"))
