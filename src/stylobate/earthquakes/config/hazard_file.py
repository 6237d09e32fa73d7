"""Files of hazard curves: two columns with their names in the first line, or a table of OpenQuake."""

import re
from dataclasses import dataclass, replace
from itertools import takewhile
from pathlib import Path
from typing import TypeAlias

from stylobate.earthquakes.config.hazard_columns import ExceedanceColumn, IntensityColumn
from stylobate.errors import FileError, ParameterError
from stylobate.records import HorizontalComponent
from stylobate.records.text_files import REMARKS, begins_with_a_number

Site: TypeAlias = int | tuple[float, float]
"""Number of a site in its table, from 0, or its longitude and latitude [degrees]."""

# Largest distance between a requested site and the site of a table [degrees].
_NEAR = 0.05
_POE = "poe-"
_SEPARATED = re.compile(r"[;\t]")
_TIME = re.compile(r"investigation_time\s*=\s*(\d+(?:\.\d*)?)")
_MEASURE = re.compile(r"\bimt\s*=\s*[\"']*([^\"',]+)")
_STATED = re.compile(r"\bcomponent\s*[:=]\s*(?P<component>[^,;\"']+)", re.IGNORECASE)


@dataclass(frozen=True, slots=True, kw_only=True)
class Row:
    """A point of a hazard curve in the units of its file, and its place `where`, for messages."""

    intensity: float
    exceedance: float
    where: str


@dataclass(frozen=True, slots=True, kw_only=True)
class HazardTable:
    """Points of a hazard curve in the units of its file, and the meaning of its columns."""

    rows: tuple[Row, ...]
    intensity: IntensityColumn
    exceedance: ExceedanceColumn


def read_hazard(path: str, site: Site | None) -> HazardTable:
    """Read the hazard curve of a file, for one `site` if it has several.

    Raises
    ------
    FileError
        If the file cannot be read, or does not name its columns.
    """
    try:
        lines = Path(path).read_text(encoding="utf-8-sig").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        message = f"cannot read {path}: {getattr(error, 'strerror', None) or error}"
        raise FileError(message) from None
    numbered = [(place, line.strip()) for place, line in enumerate(lines, start=1) if line.strip()]
    try:
        header = next((at for at, (_, line) in enumerate(numbered) if _is_openquake(line)), None)
        if header is not None:
            return _openquake(path, numbered[: header + 1], numbered[header + 1 :], site)
        return _two_columns(path, numbered, site)
    except ParameterError as error:
        message = f"{path}: {error}"
        raise FileError(message) from None


def _two_columns(path: str, lines: list[tuple[int, str]], site: Site | None) -> HazardTable:
    if site is not None:
        message = f"site: the file holds one curve, not several (got {site!r}). Remove it."
        raise ParameterError(message)
    rows = tuple(_pair(path, place, line) for place, line in lines if begins_with_a_number(line))
    if not rows:
        message = f"{path} holds no numbers: two columns are needed, intensity and annual rate"
        raise FileError(message)
    intensity, exceedance = _header([line for _, line in lines])
    return HazardTable(rows=rows, intensity=intensity, exceedance=exceedance)


def _header(lines: list[str]) -> tuple[IntensityColumn, ExceedanceColumn]:
    """Read the names of the columns: the last names before the numbers; names in remarks count if there are no others.

    A component may stand in a separate line.
    """
    before = list(takewhile(lambda line: not begins_with_a_number(line), lines))
    pairs = [pair for line in before if not line.startswith(REMARKS) and (pair := _two_names(line))][-1:]
    before = [line.lstrip("#%!/ ") for line in before]
    pairs = pairs or [pair for line in reversed(before) if (pair := _two_names(line))]
    if not pairs:
        message = (
            "the columns are not named, so rates cannot be told apart from probabilities. Name them in the first line, "
            "such as “PGA RotD50 [g], annual rate [1/a]” or “PGA RotD50 [g], probability in 50 years”."
        )
        raise ParameterError(message)
    first, exceedance = _clear(pairs)
    column = IntensityColumn.of(first)
    stated = next((found["component"].strip() for line in before if (found := _STATED.search(line))), None)
    if stated is not None and column.component is None:
        column = replace(column, component=HorizontalComponent.named(stated).value)
    return column, exceedance


def _clear(pairs: list[tuple[str, str]]) -> tuple[str, ExceedanceColumn]:
    """Return the first pair of names whose second states a kind of exceedance; else raise the error of the first."""
    problem: ParameterError | None = None
    for first, second in pairs:
        try:
            return first, ExceedanceColumn.of(second)
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


def _pair(path: str, place: int, line: str) -> Row:
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
        message = f"{where}: two numbers are needed, intensity and annual rate, got {line!r}.{comma}"
        raise FileError(message) from None
    return Row(intensity=intensity, exceedance=exceedance, where=where)


def _is_openquake(line: str) -> bool:
    names = line.lower().split(",")
    return "lon" in names and "lat" in names and any(name.startswith(_POE) for name in names)


def _openquake(
    path: str, before: list[tuple[int, str]], after: list[tuple[int, str]], site: Site | None
) -> HazardTable:
    """Read the curve of a site: a header of lon, lat and poe-LEVEL; above it investigation_time and imt."""
    names = before[-1][1].lower().split(",")
    remark = " ".join(line for _, line in before[:-1])
    measure, time = _MEASURE.search(remark), _TIME.search(remark)
    if measure is None:
        message = "imt is not named above the header. State it there as OpenQuake does, such as imt='PGA'."
        raise ParameterError(message)
    sites = [_site(path, place, line, names) for place, line in after]
    place, values = sites[_chosen(site, [(row["lon"], row["lat"]) for _, row in sites])]
    units = "cm/s" if measure[1].strip().upper() == "PGV" else "g"
    return HazardTable(
        rows=tuple(
            Row(intensity=float(name.removeprefix(_POE)), exceedance=value, where=f"{path}, line {place}, {name}")
            for name, value in values.items()
            if name.startswith(_POE)
        ),
        intensity=IntensityColumn.of(f"{measure[1].strip()} [{units}]"),
        exceedance=ExceedanceColumn(is_probability=True, investigation_time=None if time is None else float(time[1])),
    )


def _site(path: str, place: int, line: str, names: list[str]) -> tuple[int, dict[str, float]]:
    """Read the numbers of a row by their names; other cells, such as names of sites, are skipped."""
    parts = line.split(",")
    try:
        wanted = [name in ("lon", "lat") or name.startswith(_POE) for name in names]
        return place, {name: float(part) for name, part, used in zip(names, parts, wanted, strict=True) if used}
    except ValueError:
        message = (
            f"{path}, line {place}: {len(names)} values are needed, numbers for lon, lat and {_POE}…, got {line!r}"
        )
        raise FileError(message) from None


def _chosen(site: Site | None, places: list[tuple[float, float]]) -> int:
    """Return the number of the requested site."""
    if not places:
        message = "the table holds no site"
        raise ParameterError(message)
    if site is None and len(places) == 1:
        return 0
    if site is None:
        message = (
            f"site: missing, and the table holds {len(places)} sites. Give a number from 0 to {len(places) - 1} or "
            f"longitude and latitude, such as {places[0][0]:g}, {places[0][1]:g}."
        )
        raise ParameterError(message)
    if isinstance(site, int):
        if 0 <= site < len(places):
            return site
        message = f"site: no such number (got {site}). Give one from 0 to {len(places) - 1}."
        raise ParameterError(message)
    away = [max(abs(lon - site[0]), abs(lat - site[1])) for lon, lat in places]
    nearest = away.index(min(away))
    if away[nearest] > _NEAR:
        lon, lat = places[nearest]
        message = f"site: none within {_NEAR}° (got {site[0]:g}, {site[1]:g}). The nearest is at {lon:g}, {lat:g}."
        raise ParameterError(message)
    return nearest
