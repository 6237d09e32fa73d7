"""Description of an assessment: columns, records, dissipation, friction, analyses, and a design spectrum."""

import datetime as dt
import re
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Annotated, Any, Self

import numpy as np
import numpy.typing as npt
from pydantic import BeforeValidator, Field, TypeAdapter

from stylobate.base_motions import Record
from stylobate.config.axis import Axis
from stylobate.config.description import Config, Seconds, built
from stylobate.config.levels import LEVELS, is_by_level, problems_of_the_levels
from stylobate.config.parts import DEFAULT_MODEL, ColumnConfig, ModelConfig, described_model, number_or_word
from stylobate.config.record_collection import RecordsConfig
from stylobate.earthquakes.config.hazard import Hazard
from stylobate.earthquakes.config.limit_states import LimitStateConfig, built_limit_states
from stylobate.earthquakes.config.object_table import TableChoice, described_by_table
from stylobate.earthquakes.fragility import HazardCurve
from stylobate.earthquakes.fragility.displacement_limits import LimitStates
from stylobate.earthquakes.fragility_study import site_hazard
from stylobate.earthquakes.intensities import IntensityMeasure
from stylobate.errors import (
    LARGEST_SEED,
    ConfigError,
    FileError,
    ParameterError,
    UnlikelyInputWarning,
    require_not_negative,
    require_positive,
    require_whole,
)
from stylobate.files import file_of, sha256_of
from stylobate.models import Model
from stylobate.models.declared import model_quantities
from stylobate.records.tables import TextTable
from stylobate.records.text_files import KNOWN, Text, in_si, unit_of
from stylobate.results.report_details import DesignSpectrum, ReportDetails
from stylobate.results.verdict import FEW_RECORDS, require_variations
from stylobate.run_arguments import Accuracy, numbers_of
from stylobate.text import did_you_mean

_BRACKETED = re.compile(r"[\[(]([^\])]*)[\])]")
_COLUMNS = 2
_SECONDS = ("s", "sec", "second", "seconds")


class DesignSpectrumConfig(Config):
    """A design spectrum for the report: points, or a file of two columns.

    The first line of a file may state the unit: `period [s], Sa [g]`. Commas are decimal if semicolons or tabs
    separate the columns.

    Parameters
    ----------
    points
        Pairs of period [s] and spectral acceleration.
    file
        File of these two columns, in place of `points`.
    units
        Unit of the accelerations, such as "g" or "m/s²", if the file does not state it.
    name
        Name of the spectrum in the report.
    damping
        Damping ratio of the spectrum.
    """

    points: tuple[tuple[float, float], ...] = ()
    file: str | None = None
    units: str | None = None
    name: str = "design spectrum"
    damping: float = 0.05

    def build(self) -> DesignSpectrum:
        """Build the spectrum in SI units.

        Raises
        ------
        ParameterError
            If both or neither of points and file are given, or the unit is missing.
        FileError
            If the file cannot be read.
        """
        if (self.file is None) == (not self.points):
            raise ParameterError("design_spectrum: give either points or file.")
        points, stated = (self.points, None) if self.file is None else _read(self.file)
        given = None if self.units is None else unit_of(self.units)
        if self.units is not None and given is None:
            raise ParameterError(f"design_spectrum.units: unknown unit (got {self.units!r}). Use {KNOWN}.")
        if given and stated and given != stated:
            raise ParameterError(
                f"design_spectrum.units: {given!r} contradicts {stated!r} in {self.file}. Remove one of them."
            )
        units = given or stated
        if units is None:
            raise ParameterError(
                'design_spectrum.units: the unit of the accelerations is missing. Add units = "g" or "m/s²".'
            )
        return DesignSpectrum(
            period=tuple(float(period) for period, _ in points),
            acceleration=tuple(float(value) * in_si(units) for _, value in points),
            name=self.name,
            damping=self.damping,
        )


def _read(path: str) -> tuple[tuple[tuple[float, float], ...], str | None]:
    """Read the points of a file, and the unit of accelerations in its first line."""
    table = TextTable.of(Text.read(Path(path)))
    text = table.text
    units = None if table.names is None else _stated_unit(text, table.names_at, table.names)
    points: list[tuple[float, float]] = []
    for at, row in table.rows:
        cells = " ".join(row).replace(";", " ").split()
        if len(cells) != _COLUMNS:
            plain = text.lines[at].strip()
            remedy = ". Write decimal points" if "," in plain else ""
            raise text.fault(
                at, f"two numbers are needed, period [s] and spectral acceleration (got {plain!r}){remedy}"
            )
        points.append((text.number(at, cells[0]), text.number(at, cells[1])))
    return tuple(points), units


def _stated_unit(text: Text, at: int, names: list[str]) -> str | None:
    """Return the unit of the accelerations in the names; periods must be in seconds."""
    period, *_, acceleration = (_BRACKETED.findall(name) for name in names)
    if period and period[-1].strip().lower() not in _SECONDS:
        raise text.fault(at, f"the first column must be the period in s (got [{period[-1]}]). Convert it")
    return unit_of(acceleration[-1]) if acceleration else None


_MARGIN = {"from": 0.2, "to": 5.0, "number": 300, "spacing": "log"}


def _with_name(values: Any) -> Any:
    """Convert the values of a margin to those of an axis."""
    return {**_MARGIN, **values, "name": "scale"} if isinstance(values, dict) and "values" not in values else values


def as_source(values: Any) -> Any:
    """Convert a folder, a pattern or a list of files to the values of records."""
    return {"source": values} if isinstance(values, (str, list, tuple)) else values


def _as_friction(values: Any) -> Any:
    """Validate one coefficient, or one for each column."""
    return (_BY_COLUMN if isinstance(values, Mapping) else _ONE).validate_python(values)


def _as_level(values: Any) -> Any:
    """Validate the numbers of a level, or the levels of a column by name."""
    return (_LEVELS if is_by_level(values) else _LEVEL).validate_python(values)


def _as_limit_states(values: Any) -> Any:
    """Validate one list of limit states, or one for each column."""
    return (_LIMITS_BY_COLUMN if isinstance(values, Mapping) else _LIMITS).validate_python(values)


_LIMITS: TypeAdapter[tuple[LimitStateConfig, ...]] = TypeAdapter(tuple[LimitStateConfig, ...])
_LIMITS_BY_COLUMN: TypeAdapter[dict[str, tuple[LimitStateConfig, ...]]] = TypeAdapter(
    dict[str, tuple[LimitStateConfig, ...]]
)
_DAMPING = number_or_word(model_quantities()["damping"])
_LEVEL: TypeAdapter[dict[str, float | str]] = TypeAdapter(dict[str, _DAMPING])  # type: ignore[valid-type]
_LEVELS: TypeAdapter[dict[str, dict[str, float | str]]] = TypeAdapter(dict[str, dict[str, _DAMPING]])  # type: ignore[valid-type]
_ONE: TypeAdapter[float] = TypeAdapter(float)
_BY_COLUMN: TypeAdapter[dict[str, float]] = TypeAdapter(dict[str, float])


@dataclass(frozen=True, slots=True)
class AssessmentSetup:
    """Models, records and other arguments of `earthquakes.assess`, read from a file."""

    columns: dict[str, Model]
    records: dict[str, Record]
    options: dict[str, Any]


class AssessConfig(Config):
    """An assessment of columns under records.

    Parameters
    ----------
    title
        Title of the report.
    columns
        Columns by name: tables as `column`. Or a path of a table of objects (CSV, Excel, GeoPackage), as for an
        inventory: it then states friction coefficients and, if `dissipation` does not, the central damping, of which
        the low and the high level are half and twice.
    carry
        Headings of columns of the table of objects to carry through although they are or resemble a known name.
    defaults
        Values for empty cells and missing columns of the table of objects, by name.
    model
        Model of all columns.
    dissipation
        Dissipation parameters at the levels "low", "central" and "high": a table for each level. A table with the
        name of a column holds the levels of this column.
    friction_coefficient
        Friction coefficient of column and base: one number, or one for each column by its name.
    records
        Records: a folder, a pattern or a list of files; or a table as below.
    scales
        Scales of the records.
    margin
        Scales over which overturning is searched: a table as below, without a name.
    width
        Relative width to which the ends of overturning intervals are located.
    tail
        Free-vibration time after a record [s]; 20/`column.frequency_parameter` by default.
    contact_laws
        Whether to assess the other contact law too, such as `rolling` beside `wobbling`.
    variations
        Number of small variations of each verdict; 0 for none. Fewer than 52 leave every case undecided.
    seed
        Seed of the small variations.
    sliding
        Whether to compute the slip of columns that slide before they rock.
    limit_states
        Limits of the displacement: a list of tables as below, or one for each column by its name.
    friction_dispersion
        Standard deviation of the logarithm of the friction coefficient among the small variations of slip.
    planar
        Whether to run Housner's planar model too.
    contact
        Whether to report the contact demand.
    least_records
        Minimum number of records for fragility curves.
    rtol
        Relative tolerance.
    rest_energy
        Energy below which a column can come to rest, in c².
    max_steps
        Maximum number of integration steps.
    notes
        Paragraphs for the report.
    author
        Author, for the report.
    project
        Project, for the report.
    date
        Date, for the report.
    about_columns
        Text on each column, by its name, for the report.
    table
        Path of the table of objects that `columns` named.
    read_as
        Headings of this table that are aliases, and of which names they are.
    about_records
        Text on each record, by its name, for the report.
    hazard
        Hazard curve of the site, for annual rates: a table as below.
    years
        Period of the stated probability [years].
    target_rate
        Annual rate that is accepted [1/year]: each rate is compared with it.
    design_spectrum
        Design spectrum to draw beside those of the records: a table as below.
    spectral_period
        Period of the spectral acceleration in the table of records [s].
    """

    title: str = "Columns under records"
    columns: dict[str, ColumnConfig]
    carry: tuple[str, ...] = ()
    defaults: dict[str, float | str] = Field(default_factory=dict)
    model: ModelConfig = described_model(DEFAULT_MODEL)
    dissipation: dict[str, Annotated[dict[str, Any], BeforeValidator(_as_level)]]
    friction_coefficient: Annotated[float | dict[str, float], BeforeValidator(_as_friction)]
    records: Annotated[RecordsConfig, BeforeValidator(as_source)]
    scales: tuple[float, ...] = (1.0,)
    margin: Annotated[Axis, BeforeValidator(_with_name)] = Field(
        default_factory=lambda: Axis.parse({**_MARGIN, "name": "scale"})
    )
    width: float = 5e-3
    tail: Seconds | None = None
    contact_laws: bool = True
    variations: int = 200
    seed: int = 0
    sliding: bool = False
    limit_states: Annotated[
        tuple[LimitStateConfig, ...] | dict[str, tuple[LimitStateConfig, ...]], BeforeValidator(_as_limit_states)
    ] = ()
    friction_dispersion: float = 0.1
    planar: bool = True
    contact: bool = True
    least_records: int = FEW_RECORDS
    rtol: float = 1e-8
    rest_energy: float | None = None
    max_steps: int = 200_000
    notes: tuple[str, ...] = ()
    author: str = ""
    project: str = ""
    date: dt.date | None = None
    about_columns: dict[str, str] = Field(default_factory=dict)
    table: str = ""
    read_as: dict[str, str] = Field(default_factory=dict)
    about_records: dict[str, str] = Field(default_factory=dict)
    hazard: Hazard | None = None
    years: float = 50.0
    target_rate: float | None = None
    design_spectrum: DesignSpectrumConfig | None = None
    spectral_period: Seconds = 1.0

    @classmethod
    def parse(cls, values: Mapping[str, Any]) -> Self:
        """Validate these `values`.

        Raises
        ------
        ConfigError
            With one line for each mistake; if the dissipation is missing, a line shows how to state it.
        """
        problems: list[str] = []
        of_table = isinstance(values.get("columns"), str)
        given = described_by_table(values) if of_table else dict(values)
        problems += [
            f"{name}: belongs to a table of objects, and the columns come from none. Remove it."
            for name in TableChoice.model_fields
            if name in values and not (of_table or values.get("table"))
        ]
        for name, remedy in _NEEDED.items():
            if name not in given:
                problems.append(f"{name} is missing: {remedy}")
                given[name] = _PLACEHOLDERS[name]
        try:
            found = super().parse(given)
        except ConfigError as error:
            raise ConfigError([*error.problems, *problems]) from None
        if problems:
            raise ConfigError(problems)
        return found

    def build(self) -> AssessmentSetup:
        """Build models, records and the other arguments of `stylobate.earthquakes.assess`.

        Raises
        ------
        ConfigError
            With one line for each invalid part.
        """
        problems: list[str] = []
        problems += self._problems_of_the_model()
        models = {name: self._model(name, problems) for name in self.columns}
        if not models:
            problems.append("columns must hold at least one column, such as [columns.tank]")
        scales = built("margin", self.margin.build, problems)
        problems += [] if scales is None else _problems_of_the_margin(scales)
        bodies = {name: None if model is None else model.column for name, model in models.items()}
        problems += problems_of_the_levels(self.dissipation, type(self.model), bodies)
        problems += self._problems_of_the_numbers()
        records: dict[str, Record] = {}
        with warnings.catch_warnings(record=True) as remarks:
            warnings.simplefilter("always")
            try:
                records = self.records.build()
            except ConfigError as error:
                problems += error.problems
        for remark in remarks:
            warnings.warn(remark.message, remark.category, stacklevel=2)
        problems += self._problems_of_the_remarks(records)
        details = self._details(problems)
        hazard = None if self.hazard is None else built("hazard", partial(hazard_as_stated, self.hazard), problems)
        limits = self._limit_states(problems)
        if problems:
            raise ConfigError(problems)
        options = {"details": details, "hazard": hazard, "limit_states": limits} | {
            name: getattr(self, name) for name in (*_PASSED, *self._of_runs())
        }
        options["notes"] = (
            *self.notes,
            *(f"Warning: {one.message}" for one in remarks if one.category is UnlikelyInputWarning),
        )
        built_models = {name: model for name, model in models.items() if model is not None}
        return AssessmentSetup(built_models, records, {**options, "margin_scales": scales})

    def _details(self, problems: list[str]) -> ReportDetails | None:
        """Build the details of the report; None, and a line in `problems`, if one is invalid."""
        given = self.design_spectrum
        try:
            return ReportDetails(
                author=self.author,
                project=self.project,
                date="" if self.date is None else self.date.isoformat(),
                about_records=self.about_records,
                about_columns=self.about_columns,
                table_file=file_of(Path(self.table)).name if self.table else "",
                table_sha256=sha256_of(file_of(Path(self.table))) if self.table else "",
                table_read_as=self.read_as,
                design_spectrum=None if given is None else given.build(),
                spectral_period=self.spectral_period,
            )
        except (ParameterError, FileError) as error:
            problems.append(str(error))
            return None

    def _limit_states(self, problems: list[str]) -> LimitStates:
        """Build the limit states of all columns, or of each."""
        given = self.limit_states
        if not isinstance(given, dict):
            return built_limit_states("limit_states", given, problems)
        problems += [
            f"limit_states: {name!r} is no column; {did_you_mean(name, self.columns) or 'leave it out'}"
            for name in given
            if name not in self.columns
        ]
        return {name: built_limit_states(f"limit_states.{name}", one, problems) for name, one in given.items()}

    def _problems_of_the_remarks(self, records: Mapping[str, Record]) -> list[str]:
        return [
            f"about_records: {name!r} is no record; {did_you_mean(name, records) or 'leave it out'}"
            for name in self.about_records
            if records and name not in records
        ]

    def _model(self, name: str, problems: list[str]) -> Model | None:
        column = built(f"columns.{name}", self.columns[name].build, problems)
        if column is None:
            return None
        return built("model", lambda: self.model.build(column), problems) if not self._problems_of_the_model() else None

    def _problems_of_the_model(self) -> list[str]:
        if self.model.kind == "sliding":
            return ["model.kind: must assume permanent contact (got 'sliding'). Use one such as wobbling."]
        stated = dict.fromkeys(name for levels in self._levels() for numbers in levels.values() for name in numbers)
        repeated = [name for name in stated if name in self.model.model_fields_set]
        return [f"model.{name}: `dissipation` sets it. Remove it from the model." for name in repeated]

    @classmethod
    def _of_runs(cls) -> list[str]:
        """Return the names of the numbers of all runs."""
        return [name for name in numbers_of(Accuracy) if name in cls.model_fields]

    def _problems_of_the_numbers(self) -> list[str]:
        """Return a line for each invalid number."""
        friction = self.friction_coefficient
        by_column = friction if isinstance(friction, dict) else {}
        checks: list[Callable[[], object]] = [
            lambda: require_positive("width", self.width),
            *(partial(numbers_of(Accuracy)[name].checked, getattr(self, name)) for name in self._of_runs()),
            lambda: require_whole("least_records", self.least_records, least=2),
            lambda: require_variations(self.variations),
            lambda: require_whole("seed", self.seed, least=0, most=LARGEST_SEED),
            lambda: require_not_negative("tail", self.tail or 0.0, "s"),
            lambda: require_not_negative("friction_dispersion", self.friction_dispersion),
            lambda: require_positive("years", self.years, "a"),
            lambda: require_positive("target_rate", 1.0 if self.target_rate is None else self.target_rate, "1/a"),
            *(partial(require_positive, "scales", scale) for scale in self.scales),
            *(partial(require_positive, f"friction_coefficient.{name}", one) for name, one in by_column.items()),
        ]
        if not isinstance(friction, dict):
            checks.append(lambda: require_positive("friction_coefficient", friction))
        problems = [] if self.scales else ["scales must hold at least one scale factor, such as [1.0]"]
        for check in checks:
            try:
                check()
            except ParameterError as error:
                problems.append(str(error))
        return [*problems, *self._problems_of_the_frictions(by_column)]

    def _levels(self) -> list[Mapping[str, Mapping[str, Any]]]:
        """Return the levels of all columns, and those of each column with its own."""
        own = [one for one in self.dissipation.values() if is_by_level(one)]
        return [*own, {name: one for name, one in self.dissipation.items() if not is_by_level(one)}]

    def _problems_of_the_frictions(self, by_column: Mapping[str, float]) -> list[str]:
        if not by_column:
            return []
        unknown = [
            f"friction_coefficient: {name!r} is no column; {did_you_mean(name, self.columns) or 'leave it out'}"
            for name in by_column
            if name not in self.columns
        ]
        lacking = [name for name in self.columns if name not in by_column]
        return [*unknown, *(f"friction_coefficient: {name!r} has none; state one for each column" for name in lacking)]


def hazard_as_stated(hazard: Hazard) -> HazardCurve:
    """Build a hazard curve in the intensity that it states."""
    points = hazard.points()
    if not points.measure or points.component is None:
        lacking = "component" if points.measure else "measure"
        measure = "" if points.measure else 'measure = "PGA" and '
        raise ParameterError(f'{lacking}: missing. State it, such as {measure}component = "RotD50"')
    return site_hazard(points, IntensityMeasure.named(points.measure, points.component), "hazard")


def _problems_of_the_margin(scales: npt.NDArray[np.float64]) -> list[str]:
    if scales.size < 2:  # noqa: PLR2004  edges lie between two
        return [f"margin.number must be 2 or more, got {scales.size}"]
    if np.all(np.diff(scales) > 0.0):
        return []
    return [f"margin.from must be less than margin.to, got {scales[0]:g} and {scales[-1]:g}"]


_NEEDED = {
    "dissipation": (
        "it decides the outcome of a three-dimensional column and is seldom known. State it for three levels, such "
        'as [dissipation] low = {damping = 0.04}, central = {damping = "housner"}, high = {damping = 0.16}'
    ),
    "friction_coefficient": "the friction between column and base, to compare with the friction that the runs need",
}
_PLACEHOLDERS: dict[str, Any] = {
    "dissipation": {level: {"damping": 0.0} for level in LEVELS},
    "friction_coefficient": 1.0,
}

_PASSED = (
    *("title", "dissipation", "friction_coefficient", "scales", "width", "tail", "planar", "contact"),
    *(
        "sliding",
        "friction_dispersion",
        "contact_laws",
        "variations",
        "seed",
        "least_records",
        "notes",
        "years",
        "target_rate",
    ),
)
