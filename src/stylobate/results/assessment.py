"""Result of an assessment of columns under records, and the details of its report besides the numbers."""

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import xarray as xr

from stylobate.cards import Row, Section, card
from stylobate.equality import ByContent
from stylobate.errors import FileError, ParameterError, require_not_negative, require_positive
from stylobate.results.plain import ByName, plain_value
from stylobate.results.storage import read_tree, require_this_version, write_netcdf
from stylobate.text import four_digits, plural

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
    about_records: Mapping[str, str] = field(default_factory=dict)
    design_spectrum: DesignSpectrum | None = None
    spectral_period: float = 1.0

    def __post_init__(self) -> None:
        require_positive("spectral_period", self.spectral_period, "s")

    def values(self) -> dict[str, Any]:
        """Return the details as plain values that JSON can hold."""
        return {**asdict(self), "about_records": dict(self.about_records)}


# Records that a card names.
_SHOWN = 6

_FORMAT = "stylobate assessment 1"


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Assessment(ByContent):
    """Result of an assessment: verdicts, margins and shares of small variations of columns under records.

    Attributes
    ----------
    data
        Datasets by name: "columns", "records", "spectra", "ground_motions", "verdicts", "margins", "histories" and
        "summary"; "variations", "sliding", "planar" and "fragility" if they were requested.
    setting
        Inputs of the assessment as plain values: title, version, models, dissipation, friction, processing of the
        records, scales, range of the margins, the `ReportDetails`, versions of the software.
    """

    data: Mapping[str, xr.Dataset]
    setting: Mapping[str, Any]

    def __post_init__(self) -> None:
        object.__setattr__(self, "data", ByName(self.data))
        object.__setattr__(self, "setting", plain_value(self.setting))

    def __repr__(self) -> str:
        verdicts = "; ".join(f"{name}: {row}" for name, row in self._verdicts().items())
        counts = ", ".join(plural(len(self.setting.get(f"{noun}s", ())), noun) for noun in ("column", "record"))
        return f"Assessment({counts}; {verdicts})"

    def _repr_html_(self) -> str:
        """Render the card that notebooks show."""
        records = list(self.setting.get("records", ()))
        more = [f"… {len(records) - _SHOWN} more"] if records[_SHOWN:] else []
        rows = [
            Row("title", str(self.setting.get("title") or "–")),
            Row(
                "records",
                ", ".join([*records[:_SHOWN], *more]),
            ),
            Row("scales", ", ".join(map(four_digits, self.setting.get("scales", ())))),
        ]
        verdicts = [Row(name, row) for name, row in self._verdicts().items()]
        return card("Assessment", [Section("", rows), Section("records that overturn the column", verdicts)])

    def _verdicts(self) -> dict[str, str]:
        """Return for each column how many records overturn it at the first scale, in the central case."""
        if "summary" not in self.data:
            return {}
        summary, total = self.data["summary"].isel(scale=0), len(self.setting["records"])
        counts = {name: summary[name].to_numpy() for name in ("overturned", "undecided")}
        texts = (
            f"{fallen} of {total} overturn" + (f", {unclear} undecided" if unclear else "")
            for fallen, unclear in zip(*counts.values(), strict=True)
        )
        return dict(zip(map(str, summary["column"].to_numpy()), texts, strict=True))

    def save(self, path: str | Path) -> Path:
        """Write the assessment to the netCDF file `path`; `Assessment.load` reads it again.

        Raises
        ------
        FileError
            If the file cannot be written.
        """
        tree = xr.DataTree.from_dict({f"/{name}": data for name, data in self.data.items()})
        tree.attrs = {"format": _FORMAT, "setting": json.dumps(dict(self.setting), ensure_ascii=False)}
        return write_netcdf(tree, path)

    @classmethod
    def load(cls, path: str | Path) -> "Assessment":
        """Read the assessment saved in the netCDF file `path`.

        Raises
        ------
        FileError
            If the file cannot be read or holds no assessment.
        """
        tree = read_tree(path)
        require_this_version(path, tree.attrs.get("format"), _FORMAT)
        if tree.attrs.get("format") != _FORMAT:
            raise FileError(f"{path} holds no assessment saved by stylobate")
        data = {str(name): child.to_dataset() for name, child in tree.children.items()}
        try:
            return cls(data=data, setting=json.loads(tree.attrs["setting"]))
        except (KeyError, TypeError, ValueError) as error:
            raise FileError(f"{path} is damaged: {error}. Compute it again") from error
