"""Details of a report besides its numbers: author, project, records and the design spectrum."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

from stylobate.errors import ParameterError, require_not_negative, require_positive, require_printable

_ENDS = 2


@dataclass(frozen=True, slots=True, kw_only=True)
class DesignSpectrum:
    """An elastic design spectrum, drawn over the spectra of the records.

    Parameters
    ----------
    period
        Natural periods, increasing [s].
    acceleration
        Spectral accelerations [m/s²].
    name
        Name of the spectrum in the report.
    damping
        Damping ratio of the spectrum.

    Raises
    ------
    ParameterError
        If the periods do not increase, or a number is out of range.
    """

    period: tuple[float, ...]
    acceleration: tuple[float, ...]
    name: str = "design spectrum"
    damping: float = 0.05

    def __post_init__(self) -> None:
        require_printable("design_spectrum: the name", self.name)
        if len(self.period) < _ENDS or len(self.period) != len(self.acceleration):
            raise ParameterError(
                "design_spectrum: at least two points are needed, each with a period and an acceleration "
                f"(got {len(self.period)} periods, {len(self.acceleration)} accelerations). Add points."
            )
        for period, acceleration in zip(self.period, self.acceleration, strict=True):
            require_not_negative("design_spectrum: period", period, "s")
            require_not_negative("design_spectrum: acceleration", acceleration, "m/s²")
        require_positive("design_spectrum: damping", self.damping)
        for before, after in zip(self.period, self.period[1:], strict=False):
            if after <= before:
                raise ParameterError(
                    f"design_spectrum: periods must increase (got {after:g} s after {before:g} s). Sort the points."
                )


@dataclass(frozen=True, slots=True, kw_only=True)
class ReportDetails:
    """Details that the report of an assessment shows.

    Parameters
    ----------
    author, project
        Author of the report; project or its number.
    date
        Date of the assessment, such as "2026-05-14"; by default the day on which it is computed.
    study_file, study_sha256
        Name of the study file and its SHA-256; `stylobate assess` fills them in.
    command
        Command that repeats the assessment; `stylobate assess` fills it in.
    table_file, table_sha256
        Name of the table of objects and its SHA-256, if the columns come from one.
    table_read_as
        Headings of this table that are aliases, and of which names they are.
    about_columns
        Inventory number, place or material of a column, by its name.
    about_records
        Event, station, magnitude or distance of a record, by the name of the record.
    design_spectrum
        Design spectrum, drawn over the spectra of the records.
    spectral_period
        Natural period of the spectral acceleration Sa that the tables show [s].
    """

    author: str = ""
    project: str = ""
    date: str = ""
    study_file: str = ""
    study_sha256: str = ""
    command: str = ""
    table_file: str = ""
    table_sha256: str = ""
    table_read_as: Mapping[str, str] = field(default_factory=dict)
    about_columns: Mapping[str, str] = field(default_factory=dict)
    about_records: Mapping[str, str] = field(default_factory=dict)
    design_spectrum: DesignSpectrum | None = None
    spectral_period: float = 1.0

    def __post_init__(self) -> None:
        require_positive("spectral_period", self.spectral_period, "s")
        for name, text in (("author", self.author), ("project", self.project), ("date", self.date)):
            require_printable(name, text)
        for name, texts in (("about_columns", self.about_columns), ("about_records", self.about_records)):
            for text in texts.values():
                require_printable(name, text)

    def values(self) -> dict[str, Any]:
        """Return the details as plain values that JSON can hold."""
        names = ("about_records", "about_columns", "table_read_as")
        return {**asdict(self), **{name: dict(getattr(self, name)) for name in names}}
