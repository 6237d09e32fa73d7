"""The columns of a hazard curve: intensity measure, unit and component, and kind of exceedance."""

import re
from dataclasses import dataclass

from stylobate.errors import ParameterError
from stylobate.records import HorizontalComponent
from stylobate.records.text_files import in_si, unit_of

# Units of velocities; units of accelerations are those of records.
_VELOCITIES = {"m/s": 1.0, "ms-1": 1.0, "cm/s": 0.01, "cms-1": 0.01, "mm/s": 0.001, "mms-1": 0.001}
_PER_YEAR = ("1/a", "a-1", "1/y", "1/yr", "1/year", "y-1", "yr-1")
UNITS = "g, m/s², cm/s², m/s, cm/s or 1"
"""The units of intensities, as messages list them."""

MEASURES = ("peak ground acceleration", "peak ground velocity", "PGA/(g tan α)", "p PGV/(g tan α)")
"""The measures besides spectral accelerations."""
_SHORT = {"pga": MEASURES[0], "pgv": MEASURES[1], **{name.lower(): name for name in MEASURES}}
# Names of a column that do not state the measure.
_OPEN = ("", "intensity", "intensity measure", "im", "iml")

# Name of a column, and its unit in brackets at the end; round brackets may belong to the name, as in SA(0.5 s).
_SQUARE = re.compile(r"\s*(?P<name>.*?)\s*\[(?P<unit>[^\]]*)\]\s*")
_ROUND = re.compile(r"\s*(?P<name>.*?)\s*\((?P<unit>[^()]*)\)\s*")
_PERIOD = r"(?P<{}>\d*\.?\d+)\s*(?:s|secs?|seconds?)?"
_SPECTRAL = re.compile(
    rf"(?:spectral acceleration|psa|sa)(?: at)?\s*(?:\(\s*{_PERIOD.format('inside')}\s*\)|{_PERIOD.format('period')})"
    r"[\s,(]*(?:5(?:\.0*)?\s*%(?:\s*damp(?:ing|ed))?\)?)?"
)
_COMPONENT = re.compile(
    r"[\s,(_-]*\b(?P<component>(?:gm)?rot[a-z]*\d+|geometric mean|geomean|larger component|vector(?: maximum)?)\b"
    r"[\s,)_-]*",
    re.IGNORECASE,
)
_PROBABILITY = re.compile(r"prob|\bpo?e\b", re.IGNORECASE)
_RATE = re.compile(r"rate|frequency|lambda|λ|\bm?afe\b", re.IGNORECASE)
_YEARS = re.compile(r"(?P<years>\d+(?:\.\d+)?)[\s-]*(?:years?|yrs?|y|a)\b", re.IGNORECASE)
_ANNUAL = re.compile(r"annual|yearly|(?:\bper|\ba|\bone|/)\s*(?:year|yr)\b", re.IGNORECASE)
# Words for times that the two expressions above do not match.
_OTHER_TIME = re.compile(
    r"\b(?:years?|yrs?|decades?|century|centuries|months?|days?|lifetime)\b|monthly|daily", re.IGNORECASE
)


@dataclass(frozen=True, slots=True, kw_only=True)
class IntensityColumn:
    """The intensities of a hazard curve; fields that are not stated are None.

    Parameters
    ----------
    measure
        Full name of the measure, such as "spectral acceleration at 0.5 s".
    units
        Unit, in canonical spelling.
    component
        Definition of the horizontal component.
    """

    measure: str | None = None
    units: str | None = None
    component: str | None = None

    @classmethod
    def of(cls, header: str) -> "IntensityColumn":
        """Read a header such as "PGA RotD50 [g]".

        Raises
        ------
        ParameterError
            If measure, unit or component is unknown.
        """
        name, unit = _split(header)
        if unit is not None and canonical_unit(unit) is None:
            message = f"the unit of the intensity must be {UNITS}, got [{unit}]"
            raise ParameterError(message)
        stated = _COMPONENT.search(name)
        component = None if stated is None else HorizontalComponent.named(stated["component"]).value
        rest = name if stated is None else f"{name[: stated.start()]} {name[stated.end() :]}".strip()
        measure = None if rest.lower() in _OPEN else require_measure(rest)
        return cls(measure=measure, units=None if unit is None else canonical_unit(unit), component=component)


@dataclass(frozen=True, slots=True, kw_only=True)
class ExceedanceColumn:
    """Kind of exceedance of a hazard curve: annual rates or probabilities.

    Parameters
    ----------
    is_probability
        Whether the numbers are probabilities within a time, and not annual rates.
    investigation_time
        Time of the probabilities [a]; None if not stated.
    factor
        Factor on the numbers: 0.01 for percentages.
    """

    is_probability: bool = False
    investigation_time: float | None = None
    factor: float = 1.0

    @classmethod
    def of(cls, header: str) -> "ExceedanceColumn":
        """Read a header such as "annual rate [1/a]" or "probability in 50 years".

        Raises
        ------
        ParameterError
            If it states neither, or both.
        """
        name, unit = _split(header)
        times = {float(found["years"]) for found in _YEARS.finditer(header)} | (
            {1.0} if _ANNUAL.search(name) else set()
        )
        other_time = _OTHER_TIME.search(_ANNUAL.sub("", _YEARS.sub("", name))) is not None
        is_probability, is_rate = (bool(kind.search(name)) for kind in (_PROBABILITY, _RATE))
        per_year = unit is not None and _plain(unit) in _PER_YEAR
        if is_probability and not is_rate and not per_year and len(times) <= 1 and not other_time:
            return cls(
                is_probability=True,
                investigation_time=next(iter(times), None),
                factor=0.01 if "%" in header else 1.0,
            )
        annual = (unit is None or per_year) and times <= {1.0} and not other_time and "%" not in header
        if is_rate and not is_probability and annual:
            return cls()
        message = (
            f'the kind of the second column is unclear (got "{header.strip()}"). Name it "annual rate [1/a]" or '
            '"probability in 50 years"; convert return periods to annual rates.'
        )
        raise ParameterError(message)


def require_measure(text: str) -> str:
    """Return the full name of the intensity measure `text`.

    Raises
    ------
    ParameterError
        If the measure is unknown.
    """
    lower = " ".join(text.lower().split())
    if spectral := _SPECTRAL.fullmatch(lower):
        return f"spectral acceleration at {float(spectral['inside'] or spectral['period']):g} s"
    if lower not in _SHORT:
        message = (
            f"measure must be {', '.join(map(repr, MEASURES))}, or a spectral acceleration of 5 % damping, "
            f'got {text!r}. Name its period in seconds, such as "SA(0.5 s)"'
        )
        raise ParameterError(message)
    return _SHORT[lower]


def canonical_unit(text: str) -> str | None:
    """Return the canonical spelling of the unit `text`, or None."""
    plain = _plain(text).replace("**", "").replace("^", "")
    if plain in ("1", "-", "—", "–"):
        return "1"
    return plain if plain in _VELOCITIES else unit_of(text)


def si_factor(units: str) -> tuple[float, str]:
    """Return the factor that converts intensities to SI, and the SI unit."""
    if units == "1":
        return 1.0, "1"
    return (_VELOCITIES[units], "m s-1") if units in _VELOCITIES else (in_si(units), "m s-2")


def _split(column: str) -> tuple[str, str | None]:
    """Return name and unit of a column."""
    if found := _SQUARE.fullmatch(column):
        return found["name"], found["unit"]
    found = _ROUND.fullmatch(column)
    if found and (_plain(found["unit"]) in _PER_YEAR or canonical_unit(found["unit"]) not in (None, "1")):
        return found["name"], found["unit"]
    return column.strip(), None


def _plain(unit: str) -> str:
    return unit.strip().lower().replace(" ", "").replace("⁻¹", "-1")
