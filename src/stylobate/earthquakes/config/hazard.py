"""Description of a hazard curve: exceedance rates of an intensity at a site, as numbers or in a file."""

from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TypeVar

from stylobate.config.description import Config
from stylobate.earthquakes.config.hazard_columns import (
    ExceedanceColumn,
    IntensityColumn,
    canonical_unit,
    require_measure,
    si_factor,
)
from stylobate.earthquakes.config.hazard_file import HazardTable, Row, Site, read_hazard
from stylobate.errors import ParameterError, require_positive
from stylobate.records import HorizontalComponent

_T = TypeVar("_T")


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
        Name of the intensity measure, such as "spectral acceleration at 0.5 s"; empty if not stated.
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
            message = "give either intensity and rate (or probability), or a file"
            raise ParameterError(message)
        table = self._listed() if self.file is None else read_hazard(self.file, self.site)
        column, exceedance = self._intensity_column(table.intensity), self._exceedance_column(table.exceedance)
        rows = _in_order(table.rows, column.units or "", exceedance)
        factor, si = (1.0, None) if column.units is None else si_factor(column.units)
        return HazardPoints(
            intensity=tuple(row.intensity * factor for row in rows),
            exceedance=tuple(row.exceedance * exceedance.factor for row in rows),
            investigation_time=exceedance.investigation_time,
            units=si,
            measure=column.measure or "",
            component=column.component,
            source=self.file or "",
        )

    def _listed(self) -> HazardTable:
        values = self.rate or self.probability
        if self.rate and self.probability:
            message = "rate and probability: only one is allowed. Remove the other."
            raise ParameterError(message)
        if self.site is not None:
            message = f"site: applies to files only (got {self.site!r}). Remove it."
            raise ParameterError(message)
        if len(values) != len(self.intensity):
            counts = f"{len(self.intensity)} and {len(values)}"
            message = f"intensity and its rates must have equal numbers of values, got {counts}"
            raise ParameterError(message)
        rows = tuple(
            Row(intensity=x, exceedance=y, where=f"point {place}")
            for place, (x, y) in enumerate(zip(self.intensity, values, strict=True), start=1)
        )
        column = ExceedanceColumn(is_probability=bool(self.probability))
        return HazardTable(rows=rows, intensity=IntensityColumn(), exceedance=column)

    def _intensity_column(self, column: IntensityColumn) -> IntensityColumn:
        component = None if self.component is None else HorizontalComponent.named(self.component).value
        measure = None if self.measure is None else require_measure(self.measure)
        return IntensityColumn(
            measure=_one_of("measure", column.measure, measure),
            units=_one_of("units", column.units, _known_unit(self.units)),
            component=_one_of("component", column.component, component),
        )

    def _exceedance_column(self, column: ExceedanceColumn) -> ExceedanceColumn:
        given = self.investigation_time
        if given is not None:
            given = require_positive("investigation_time", given, "a")
        if not column.is_probability:
            if given is not None:
                message = f"investigation_time: not used with annual rates (got {given:g}). Remove it."
                raise ParameterError(message)
            return column
        time = _one_of("investigation_time", column.investigation_time, given)
        if time is None:
            message = "investigation_time: needed for probabilities of exceedance. State it in years, such as 50."
            raise ParameterError(message)
        return replace(column, investigation_time=time)


def _in_order(rows: tuple[Row, ...], units: str, column: ExceedanceColumn) -> list[Row]:
    """Sort the points by intensity; raise ParameterError if they do not form a hazard curve."""
    kind = "probability" if column.is_probability else "annual rate"
    most = 1.0 / column.factor
    unit = f" {units}" if units not in ("", "1") else ""
    for row in rows:
        if not 0.0 < row.intensity < float("inf"):
            message = f"{row.where}: intensity must be positive and finite (got {row.intensity:g}{unit}). Remove it."
            raise ParameterError(message)
        if column.is_probability and not 0.0 <= row.exceedance <= most:
            message = (
                f"{row.where}: probability must be between 0 and {most:g} (got {row.exceedance:g}). Name the column "
                "“probability in 50 years [%]” if these are percentages."
            )
            raise ParameterError(message)
        if not column.is_probability and not 0.0 < row.exceedance < float("inf"):
            message = f"{row.where}: annual rate must be positive and finite (got {row.exceedance:g}). Remove it."
            raise ParameterError(message)
    ordered = sorted(rows, key=lambda row: row.intensity)
    for low, high in pairwise(ordered):
        if low.intensity == high.intensity:
            message = f"{high.where}: intensity {high.intensity:g}{unit} occurs twice. Keep one of the two points."
            raise ParameterError(message)
        if high.exceedance > low.exceedance:
            message = (
                f"{high.where}: {kind} must not increase with intensity (got {high.exceedance:g} at "
                f"{high.intensity:g}{unit} after {low.exceedance:g} at {low.intensity:g}{unit}). Correct the table."
            )
            raise ParameterError(message)
    return ordered


def _known_unit(units: str | None) -> str | None:
    if units is None or (found := canonical_unit(units)) is not None:
        return None if units is None else found
    message = f'units must be "g", "m/s²", "cm/s²", "m/s", "cm/s" or "1", got {units!r}'
    raise ParameterError(message)


def _one_of(name: str, in_file: _T | None, given: _T | None) -> _T | None:
    """Return the value of file or description; raise ParameterError if they contradict each other."""
    if in_file is not None and given is not None and in_file != given:
        message = f"{name}: the file states {in_file!r}, the description {given!r}. Remove it from the description."
        raise ParameterError(message)
    return given if in_file is None else in_file
