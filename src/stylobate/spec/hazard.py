"""The description of a hazard curve: intensities with their unit, and how often in a year each is exceeded."""

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from stylobate.errors import FileError, ParameterError
from stylobate.motions.records.units import in_si, unit_of
from stylobate.spec.description import Description

# Of velocities; those of accelerations are as in records.
_VELOCITIES = {"m/s": 1.0, "ms-1": 1.0, "cm/s": 0.01, "cms-1": 0.01, "mm/s": 0.001, "mms-1": 0.001}
_PER_YEAR = ("1/a", "a-1", "1/y", "1/yr", "1/year", "y-1", "yr-1")

_MEASURES = ("peak ground acceleration", "peak ground velocity", "PGA/(g tan α)", "p PGV/(g tan α)")
_SHORT = {"pga": _MEASURES[0], "pgv": _MEASURES[1], **{name.lower(): name for name in _MEASURES}}

# A name of a column and, in brackets at its end, its unit; round ones may belong to the name, as in SA(0.5 s).
_SQUARE = re.compile(r"\s*(?P<name>.*?)\s*\[(?P<unit>[^\]]*)\]\s*")
_ROUND = re.compile(r"\s*(?P<name>.*?)\s*\((?P<unit>[^()]*)\)\s*")
_SPECTRAL = re.compile(r"(?:spectral acceleration|psa|sa)(?: at)?[\s(]*(?P<period>\d*\.?\d+)\s*(?:s|sec)?\b.*")


@dataclass(frozen=True, slots=True, kw_only=True)
class HazardPoints:
    """Points of a hazard curve in SI.

    Parameters
    ----------
    intensity, rate
        Intensities, and the annual rates at which they are exceeded [1/a].
    units
        "m s-2", "m s-1" or "1"; None where it is not told.
    measure
        What the intensity is, a spectral acceleration as "spectral acceleration at 0.5 s"; empty where it is not told.
    source
        The file, for messages; empty without.
    """

    intensity: tuple[float, ...]
    rate: tuple[float, ...]
    units: str | None = None
    measure: str = ""
    source: str = ""


class Hazard(Description):
    """Annual `rate` at which each `intensity` is exceeded; or a `file` of two columns, these two.

    `units` is that of the intensity: "g", "m/s²", "cm/s²", "m/s", "cm/s", or "1"; `measure` what it is: "peak ground
    acceleration" or PGA, "SA(0.5 s)". A file tells them in its first line: `PGA [g], annual rate [1/a]`.
    """

    intensity: tuple[float, ...] = ()
    rate: tuple[float, ...] = ()
    file: str | None = None
    units: str | None = None
    measure: str | None = None

    def points(self) -> HazardPoints:
        """Return intensities in SI, and rates.

        Raises
        ------
        FileError
            If the file cannot be read.
        ParameterError
            If they are given in two ways or none, or units or measure in two that differ.
        """
        if (self.file is None) == (not self.intensity and not self.rate):
            message = "intensity and rate must be given, or a file of them, one of both"
            raise ParameterError(message)
        x, rate, name, unit = (self.intensity, self.rate, "", None) if self.file is None else _read(self.file)
        measure = _one_of("measure", _measure(name), _known_measure(self.measure)) or ""
        units = _one_of("units", None if unit is None else _canonical(unit), _known_unit(self.units))
        factor, si = (1.0, None) if units is None else _si(units)
        scaled = tuple(value * factor for value in x)
        return HazardPoints(intensity=scaled, rate=rate, units=si, measure=measure, source=self.file or "")


def _known_unit(units: str | None) -> str | None:
    if units is None or (found := _canonical(units)) is not None:
        return None if units is None else found
    message = f'units must be "g", "m/s²", "cm/s²", "m/s", "cm/s" or "1", got {units!r}'
    raise ParameterError(message)


def _known_measure(measure: str | None) -> str | None:
    if measure is None or (found := _measure(measure)) is not None:
        return None if measure is None else found
    message = f'measure must be {", ".join(map(repr, _MEASURES))} or such as "SA(0.5 s)", got {measure!r}'
    raise ParameterError(message)


def _one_of(name: str, in_file: str | None, given: str | None) -> str | None:
    """Return what the file or the description tells; both may, the same."""
    if in_file and given and in_file != given:
        message = f"the file tells {name} {in_file!r}, the description {given!r}; leave one of them out"
        raise ParameterError(message)
    return in_file or given


def _canonical(text: str) -> str | None:
    """Return the unit that `text` spells, or None."""
    plain = text.strip().lower().replace(" ", "").replace("⁻¹", "-1").replace("**", "").replace("^", "")
    if plain in ("1", "-", "—", "–"):
        return "1"
    return plain if plain in _VELOCITIES else unit_of(text)


def _si(units: str) -> tuple[float, str]:
    """Return by what intensities are multiplied, and the unit in which they are then."""
    if units == "1":
        return 1.0, "1"
    return (_VELOCITIES[units], "m s-1") if units in _VELOCITIES else (in_si(units), "m s-2")


def _measure(text: str) -> str | None:
    """Return the full name of the measure that `text` spells, or None."""
    lower = " ".join(text.lower().split())
    if spectral := _SPECTRAL.fullmatch(lower):
        return f"spectral acceleration at {float(spectral['period']):g} s"
    return _SHORT.get(lower)


def _read(path: str) -> tuple[tuple[float, ...], tuple[float, ...], str, str | None]:
    """Return intensities and rates of a file, and what its first line says of the intensity: name and unit."""
    try:
        lines = Path(path).read_text(encoding="utf-8-sig").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        message = f"cannot read {path}: {getattr(error, 'strerror', None) or error}"
        raise FileError(message) from None
    told = [(place, line.strip()) for place, line in enumerate(lines, start=1) if line.strip()]
    numbers = [_pair(path, place, line) for place, line in told if _begins_with_a_number(line)]
    if not numbers:
        message = f"{path} holds no numbers: two columns are needed, intensity and annual rate"
        raise FileError(message)
    name, unit = _header(path, [line for _, line in told])
    x, rate = np.array(numbers).T
    return tuple(x.tolist()), tuple(rate.tolist()), name, unit


def _header(path: str, lines: list[str]) -> tuple[str, str | None]:
    """Return name and unit of the first column; the first line that names two columns is taken, a remark too."""
    for line in lines:
        if _begins_with_a_number(line):
            break
        names = re.split(r"[,;\t]", line.lstrip("#% "))
        if len(names) != 2:  # noqa: PLR2004  two columns
            continue
        (name, unit), (_, per) = map(_split, names)
        if per is not None and per.lower().replace(" ", "").replace("⁻¹", "-1") not in _PER_YEAR:
            message = f"{path}: the second column must be the annual rate of exceedance [1/a], got [{per}]"
            raise FileError(message)
        if unit is not None and _canonical(unit) is None:
            message = f"{path}: the unit of the intensity must be g, m/s², cm/s², m/s, cm/s or 1, got [{unit}]"
            raise FileError(message)
        return name, unit
    return "", None


def _split(column: str) -> tuple[str, str | None]:
    """Return name and unit of a column."""
    if found := _SQUARE.fullmatch(column):
        return found["name"], found["unit"]
    found = _ROUND.fullmatch(column)
    if found and (found["unit"] in _PER_YEAR or _canonical(found["unit"]) not in (None, "1")):
        return found["name"], found["unit"]
    return column.strip(), None


def _begins_with_a_number(line: str) -> bool:
    """Return whether a line is neither a remark nor a header."""
    return line[0].isdigit() or line[0] in "+-."


def _pair(path: str, place: int, line: str) -> tuple[float, float]:
    parts = line.replace(",", " ").replace(";", " ").split()
    try:
        intensity, rate = (float(part) for part in parts)
    except ValueError:
        message = f"{path}, line {place}: two numbers are needed, intensity and annual rate, got {line!r}"
        raise FileError(message) from None
    return intensity, rate
