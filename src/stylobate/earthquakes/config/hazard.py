"""Description of a hazard curve: exceedance rates of an intensity at a site, as numbers or in a file.

A file has two columns, named above the numbers, or is a table of hazard curves of OpenQuake.
"""

import re
from dataclasses import dataclass, replace
from itertools import pairwise, takewhile
from pathlib import Path
from typing import Any, TypeAlias, TypeVar

from stylobate.config.description import Config
from stylobate.earthquakes.intensities import quantity_named
from stylobate.errors import FileError, ParameterError, require_positive
from stylobate.records.intensities import HorizontalComponent
from stylobate.records.text_files import REMARKS, begins_with_a_number, in_si, unit_of

_T = TypeVar("_T")

Site: TypeAlias = int | tuple[float, float]
"""Number of a site in its table, from 0, or its longitude and latitude [degrees]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class HazardPoints:
    """Points of a hazard curve in SI, in increasing order.

    Parameters
    ----------
    intensity
        Intensities.
    exceedance
        Annual rates of exceedance [1/a]; with an `investigation_time`, the probabilities of exceedance within it.
    investigation_time
        Time of the probabilities [a]; None for rates.
    units
        "m s-2", "m s-1" or "1"; None if not stated.
    measure
        Name of the intensity measure, such as "peak ground acceleration"; empty if not stated.
    component
        Definition of the horizontal component; None if not stated.
    source
        File, for messages; empty without one.
    """

    intensity: tuple[float, ...]
    exceedance: tuple[float, ...]
    investigation_time: float | None = None
    units: str | None = None
    measure: str = ""
    component: str | None = None
    source: str = ""


class Hazard(Config):
    """Hazard curve of a site: intensities with annual rates or probabilities of exceedance, or a file of them.

    A file has two columns, named in its first line: `PGA RotD50 [g], annual rate [1/a]` or `SA(0.5 s) RotD50 [g],
    probability in 50 years`; or it is a hazard curve of OpenQuake. Give the keys that the file does not state.

    Parameters
    ----------
    intensity
        Intensities, in the unit `units`.
    rate
        Annual rate of exceedance of each intensity [1/year].
    probability
        Probability of exceedance of each intensity in `investigation_time`, in place of `rate`.
    investigation_time
        Time of the probabilities [years].
    file
        File of the curve, relative to the folder of the TOML file.
    site
        Site in a table of OpenQuake: number of its row, from 0, or its longitude and latitude.
    units
        Unit of the intensity: "g", "m/s²", "cm/s²", "m/s", "cm/s" or "1".
    measure
        Intensity measure: "PGA", "PGV" or a spectral acceleration such as "SA(0.5 s)".
    component
        Horizontal component of the intensity: "RotD50", "RotD100", "geometric mean" or "larger component".
    """

    intensity: tuple[float, ...] = ()
    rate: tuple[float, ...] = ()
    probability: tuple[float, ...] = ()
    investigation_time: float | None = None
    file: str | None = None
    site: Site | None = None
    units: str | None = None
    measure: str | None = None
    component: str | None = None

    def points(self) -> HazardPoints:
        """Convert to intensities in SI units, and rates or probabilities.

        Raises
        ------
        FileError
            If the file cannot be read, or does not name its columns.
        ParameterError
            If the curve is missing, given twice or not a curve, or if file and description contradict each other.
        """
        listed = self.intensity or self.rate or self.probability
        if bool(listed) == (self.file is not None):
            raise ParameterError("give either intensity and rate (or probability), or a file")
        curve = self._completed(self._listed() if self.file is None else _read(self.file, self.site))
        units = curve.units
        if units is None or units == "1":
            factor, si = 1.0, units
        else:
            factor, si = (_VELOCITIES[units], "m s-1") if units in _VELOCITIES else (in_si(units), "m s-2")
        rows = _in_order(curve)
        return HazardPoints(
            intensity=tuple(row.intensity * factor for row in rows),
            exceedance=tuple(row.exceedance * curve.factor for row in rows),
            investigation_time=curve.investigation_time,
            units=si,
            measure=curve.measure or "",
            component=curve.component,
            source=self.file or "",
        )

    def _listed(self) -> "_Curve":
        values = self.rate or self.probability
        if self.rate and self.probability:
            raise ParameterError("rate and probability: only one is allowed. Remove the other.")
        if self.site is not None:
            raise ParameterError(f"site: applies to files only (got {self.site!r}). Remove it.")
        if len(values) != len(self.intensity):
            counts = f"{len(self.intensity)} and {len(values)}"
            raise ParameterError(f"intensity and its rates must have equal numbers of values, got {counts}")
        pairs = enumerate(zip(self.intensity, values, strict=True), start=1)
        rows = tuple(_Row(x, y, f"point {place}") for place, (x, y) in pairs)
        return _Curve(rows=rows, is_probability=bool(self.probability))

    def _completed(self, curve: "_Curve") -> "_Curve":
        """Add to a curve what the description states and its file does not."""
        component = None if self.component is None else HorizontalComponent.named(self.component).value
        measure = None if self.measure is None else _measure(self.measure)
        units = None if self.units is None else _unit(self.units)
        if self.units is not None and units is None:
            raise ParameterError(f'units must be "g", "m/s²", "cm/s²", "m/s", "cm/s" or "1", got {self.units!r}')
        curve = replace(
            curve,
            measure=_one_of("measure", curve.measure, measure),
            units=_one_of("units", curve.units, units),
            component=_one_of("component", curve.component, component),
        )
        given = self.investigation_time
        given = None if given is None else require_positive("investigation_time", given, "a")
        if not curve.is_probability:
            if given is not None:
                raise ParameterError(f"investigation_time: not used with annual rates (got {given:g}). Remove it.")
            return curve
        time = _one_of("investigation_time", curve.investigation_time, given)
        if time is None:
            raise ParameterError(
                "investigation_time: needed for probabilities of exceedance. State it in years, such as 50."
            )
        return replace(curve, investigation_time=time)


@dataclass(frozen=True, slots=True)
class _Row:
    """A point of a hazard curve in the units of its file, and its place `where`, for messages."""

    intensity: float
    exceedance: float
    where: str


@dataclass(frozen=True, slots=True, kw_only=True)
class _Curve:
    """Points in the units of their file, and the meaning of the two columns; None for what the file leaves open.

    `factor` is the factor on probabilities, 0.01 for percentages; `units` has its canonical spelling.
    """

    rows: tuple[_Row, ...]
    measure: str | None = None
    units: str | None = None
    component: str | None = None
    is_probability: bool = False
    investigation_time: float | None = None
    factor: float = 1.0


def _one_of(name: str, in_file: _T | None, given: _T | None) -> _T | None:
    """Return the value of file or description; raise ParameterError if they contradict each other."""
    if in_file is not None and given is not None and in_file != given:
        raise ParameterError(
            f"{name}: the file states {in_file!r}, the description {given!r}. Remove it from the description."
        )
    return given if in_file is None else in_file


def _in_order(curve: _Curve) -> list[_Row]:
    """Sort the points by intensity; raise ParameterError if they do not form a hazard curve."""
    kind = "probability" if curve.is_probability else "annual rate"
    most = 1.0 / curve.factor
    unit = f" {curve.units}" if curve.units not in (None, "1") else ""
    for row in curve.rows:
        if not 0.0 < row.intensity < float("inf"):
            raise ParameterError(
                f"{row.where}: intensity must be positive and finite (got {row.intensity:g}{unit}). Remove it."
            )
        if curve.is_probability and not 0.0 <= row.exceedance <= most:
            raise ParameterError(
                f"{row.where}: probability must be between 0 and {most:g} (got {row.exceedance:g}). Name the column "
                "“probability in 50 years [%]” if these are percentages."
            )
        if not curve.is_probability and not 0.0 < row.exceedance < float("inf"):
            raise ParameterError(
                f"{row.where}: annual rate must be positive and finite (got {row.exceedance:g}). Remove it."
            )
    ordered = sorted(curve.rows, key=lambda row: row.intensity)
    for low, high in pairwise(ordered):
        if low.intensity == high.intensity:
            raise ParameterError(
                f"{high.where}: intensity {high.intensity:g}{unit} occurs twice. Keep one of the two points."
            )
        if high.exceedance > low.exceedance:
            raise ParameterError(
                f"{high.where}: {kind} must not increase with intensity (got {high.exceedance:g} at "
                f"{high.intensity:g}{unit} after {low.exceedance:g} at {low.intensity:g}{unit}). Correct the table."
            )
    return ordered


# Largest distance between a requested site and the site of a table [degrees].
_NEAR = 0.05
_POE = "poe-"
_SEPARATED = re.compile(r"[;\t]")
_TIME = re.compile(r"investigation_time\s*=\s*(\d+(?:\.\d*)?)")
_MEASURE = re.compile(r"\bimt\s*=\s*[\"']*([^\"',]+)")
_STATED = re.compile(r"\bcomponent\s*[:=]\s*(?P<component>[^,;\"']+)", re.IGNORECASE)


def _read(path: str, site: Site | None) -> _Curve:
    """Read the hazard curve of a file, for one `site` if it has several."""
    try:
        lines = Path(path).read_text(encoding="utf-8-sig").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise FileError(f"cannot read {path}: {getattr(error, 'strerror', None) or error}") from None
    numbered = [(place, line.strip()) for place, line in enumerate(lines, start=1) if line.strip()]
    try:
        header = next((at for at, (_, line) in enumerate(numbered) if _is_openquake(line)), None)
        if header is not None:
            return _openquake(path, numbered[: header + 1], numbered[header + 1 :], site)
        return _two_columns(path, numbered, site)
    except ParameterError as error:
        raise FileError(f"{path}: {error}") from None


def _two_columns(path: str, lines: list[tuple[int, str]], site: Site | None) -> _Curve:
    if site is not None:
        raise ParameterError(f"site: the file holds one curve, not several (got {site!r}). Remove it.")
    rows = tuple(_pair(path, place, line) for place, line in lines if begins_with_a_number(line))
    if not rows:
        raise FileError(f"{path} holds no numbers: two columns are needed, intensity and annual rate")
    return _Curve(rows=rows, **_header([line for _, line in lines]))


def _header(lines: list[str]) -> dict[str, Any]:
    """Read the names of the columns: the last names before the numbers; names in remarks count if there are no others.

    A component may stand in a separate line.
    """
    before = list(takewhile(lambda line: not begins_with_a_number(line), lines))
    pairs = [pair for line in before if not line.startswith(REMARKS) and (pair := _two_names(line))][-1:]
    before = [line.lstrip("#%!/ ") for line in before]
    pairs = pairs or [pair for line in reversed(before) if (pair := _two_names(line))]
    if not pairs:
        raise ParameterError(
            "the columns are not named, so rates cannot be told apart from probabilities. Name them in the first line, "
            "such as “PGA RotD50 [g], annual rate [1/a]” or “PGA RotD50 [g], probability in 50 years”."
        )
    first, exceedance = _clear(pairs)
    columns = {**_intensity_column(first), **exceedance}
    stated = next((found["component"].strip() for line in before if (found := _STATED.search(line))), None)
    if stated is not None and columns["component"] is None:
        columns["component"] = HorizontalComponent.named(stated).value
    return columns


def _clear(pairs: list[tuple[str, str]]) -> tuple[str, dict[str, Any]]:
    """Return the first pair of names whose second states a kind of exceedance; else raise the error of the first."""
    problem: ParameterError | None = None
    for first, second in pairs:
        try:
            return first, _exceedance_column(second)
        except ParameterError as error:
            problem = problem or error
    assert problem is not None
    raise problem


def _two_names(line: str) -> tuple[str, str] | None:
    """Split a line into the names of two columns, at a tab or semicolon, else at the last comma."""
    parts = _SEPARATED.split(line)
    if len(parts) == 1:
        first, comma, second = line.rpartition(",")
        return (first, second) if comma else None
    return (parts[0], parts[1]) if len(parts) == 2 else None  # noqa: PLR2004  two columns


def _pair(path: str, place: int, line: str) -> _Row:
    """Read the two numbers of a line; commas are decimal if semicolons or tabs separate the columns."""
    where = f"{path}, line {place}"
    separated = _SEPARATED.search(line) is not None
    parts = _SEPARATED.split(line) if separated else line.replace(",", " ").split()
    if separated and not ("," in line and "." in line):
        parts = [part.replace(",", ".") for part in parts]
    try:
        intensity, exceedance = (float(part) for part in parts)
    except ValueError:
        comma = " If commas are decimal, separate the columns by semicolons." if "," in line else ""
        raise FileError(f"{where}: two numbers are needed, intensity and annual rate, got {line!r}.{comma}") from None
    return _Row(intensity, exceedance, where)


def _is_openquake(line: str) -> bool:
    names = line.lower().split(",")
    return "lon" in names and "lat" in names and any(name.startswith(_POE) for name in names)


def _openquake(path: str, before: list[tuple[int, str]], after: list[tuple[int, str]], site: Site | None) -> _Curve:
    """Read the curve of a site: a header of lon, lat and poe-LEVEL; above it investigation_time and imt."""
    names = before[-1][1].lower().split(",")
    remark = " ".join(line for _, line in before[:-1])
    measure, time = _MEASURE.search(remark), _TIME.search(remark)
    if measure is None:
        raise ParameterError("imt is not named above the header. State it there as OpenQuake does, such as imt='PGA'.")
    sites = [_site(path, place, line, names) for place, line in after]
    place, values = sites[_chosen(site, [(row["lon"], row["lat"]) for _, row in sites])]
    units = "cm/s" if measure[1].strip().upper() == "PGV" else "g"
    return _Curve(
        rows=tuple(
            _Row(float(name.removeprefix(_POE)), value, f"{path}, line {place}, {name}")
            for name, value in values.items()
            if name.startswith(_POE)
        ),
        **_intensity_column(f"{measure[1].strip()} [{units}]"),
        is_probability=True,
        investigation_time=None if time is None else float(time[1]),
    )


def _site(path: str, place: int, line: str, names: list[str]) -> tuple[int, dict[str, float]]:
    """Read the numbers of a row by their names; other cells, such as names of sites, are skipped."""
    parts = line.split(",")
    try:
        wanted = [name in ("lon", "lat") or name.startswith(_POE) for name in names]
        return place, {name: float(part) for name, part, used in zip(names, parts, wanted, strict=True) if used}
    except ValueError:
        raise FileError(
            f"{path}, line {place}: {len(names)} values are needed, numbers for lon, lat and {_POE}…, got {line!r}"
        ) from None


def _chosen(site: Site | None, places: list[tuple[float, float]]) -> int:
    """Return the number of the requested site."""
    if not places:
        raise ParameterError("the table holds no site")
    if site is None and len(places) == 1:
        return 0
    if site is None:
        raise ParameterError(
            f"site: missing, and the table holds {len(places)} sites. Give a number from 0 to {len(places) - 1} or "
            f"longitude and latitude, such as {places[0][0]:g}, {places[0][1]:g}."
        )
    if isinstance(site, int):
        if 0 <= site < len(places):
            return site
        raise ParameterError(f"site: no such number (got {site}). Give one from 0 to {len(places) - 1}.")
    away = [max(abs(lon - site[0]), abs(lat - site[1])) for lon, lat in places]
    nearest = away.index(min(away))
    if away[nearest] > _NEAR:
        lon, lat = places[nearest]
        raise ParameterError(
            f"site: none within {_NEAR}° (got {site[0]:g}, {site[1]:g}). The nearest is at {lon:g}, {lat:g}."
        )
    return nearest


# Units of velocities; units of accelerations are those of records.
_VELOCITIES = {"m/s": 1.0, "ms-1": 1.0, "cm/s": 0.01, "cms-1": 0.01, "mm/s": 0.001, "mms-1": 0.001}
_PER_YEAR = ("1/a", "a-1", "1/y", "1/yr", "1/year", "y-1", "yr-1")
# Names of a column that do not state the measure.
_OPEN = ("", "intensity", "intensity measure", "im", "iml")

# Name of a column, and its unit in brackets at the end; round brackets may belong to the name, as in SA(0.5 s).
_SQUARE = re.compile(r"\s*(?P<name>.*?)\s*\[(?P<unit>[^\]]*)\]\s*")
_ROUND = re.compile(r"\s*(?P<name>.*?)\s*\((?P<unit>[^()]*)\)\s*")
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


def _intensity_column(header: str) -> dict[str, Any]:
    """Return measure, units and component of a header such as "PGA RotD50 [g]"; None for what it does not state."""
    name, unit = _split(header)
    if unit is not None and _unit(unit) is None:
        raise ParameterError(f"the unit of the intensity must be g, m/s², cm/s², m/s, cm/s or 1, got [{unit}]")
    stated = _COMPONENT.search(name)
    rest = name if stated is None else f"{name[: stated.start()]} {name[stated.end() :]}".strip()
    return {
        "component": None if stated is None else HorizontalComponent.named(stated["component"]).value,
        "measure": None if rest.lower() in _OPEN else _measure(rest),
        "units": None if unit is None else _unit(unit),
    }


def _exceedance_column(header: str) -> dict[str, Any]:
    """Return whether the numbers below a header such as "probability in 50 years" are probabilities, and their time."""
    name, unit = _split(header)
    times = {float(found["years"]) for found in _YEARS.finditer(header)} | ({1.0} if _ANNUAL.search(name) else set())
    other_time = _OTHER_TIME.search(_ANNUAL.sub("", _YEARS.sub("", name))) is not None
    is_probability, is_rate = (bool(kind.search(name)) for kind in (_PROBABILITY, _RATE))
    per_year = unit is not None and _plain(unit) in _PER_YEAR
    if is_probability and not is_rate and not per_year and len(times) <= 1 and not other_time:
        factor = 0.01 if "%" in header else 1.0
        return {"is_probability": True, "investigation_time": next(iter(times), None), "factor": factor}
    annual = (unit is None or per_year) and times <= {1.0} and not other_time and "%" not in header
    if is_rate and not is_probability and annual:
        return {}
    raise ParameterError(
        f'the kind of the second column is unclear (got "{header.strip()}"). Name it "annual rate [1/a]" or '
        '"probability in 50 years"; convert return periods to annual rates.'
    )


def _measure(text: str) -> str:
    """Return the full name of an intensity measure."""
    return quantity_named("measure", text).value


def _unit(text: str) -> str | None:
    """Return the canonical spelling of a unit, or None."""
    plain = _plain(text).replace("**", "").replace("^", "")
    if plain in ("1", "-", "—", "–"):
        return "1"
    return plain if plain in _VELOCITIES else unit_of(text)


def _split(column: str) -> tuple[str, str | None]:
    """Return name and unit of a column."""
    if found := _SQUARE.fullmatch(column):
        return found["name"], found["unit"]
    found = _ROUND.fullmatch(column)
    if found and (_plain(found["unit"]) in _PER_YEAR or _unit(found["unit"]) not in (None, "1")):
        return found["name"], found["unit"]
    return column.strip(), None


def _plain(unit: str) -> str:
    return unit.strip().lower().replace(" ", "").replace("⁻¹", "-1")
