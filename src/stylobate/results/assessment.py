"""Result of an assessment: columns under records, with all numbers of the report."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import xarray as xr

from stylobate.cards import CardSection, Row, card
from stylobate.equality import ByContent
from stylobate.errors import FileError
from stylobate.results.plain import ByName, plain_value
from stylobate.results.storage import read_tree, require_this_version, write_netcdf
from stylobate.text import four_digits, plural

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
        "summary"; "variations", "sliding", "slip_margins", "slip_paths", "planar", "fragility" and "rates" if they were
        requested.
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
        return card("Assessment", [CardSection("", rows), CardSection("records that overturn the column", verdicts)])

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
