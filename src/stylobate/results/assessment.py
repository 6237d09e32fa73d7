"""Result of an assessment: columns under records, with all numbers of the report."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import xarray as xr

from stylobate.errors import FileError
from stylobate.results.storage import read_tree, require_this_version, write_netcdf

_FORMAT = "stylobate assessment 1"


@dataclass(frozen=True, slots=True, kw_only=True)
class Assessment:
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
            message = f"{path} holds no assessment saved by stylobate"
            raise FileError(message)
        data = {str(name): child.to_dataset() for name, child in tree.children.items()}
        try:
            return cls(data=data, setting=json.loads(tree.attrs["setting"]))
        except (KeyError, TypeError, ValueError) as error:
            message = f"{path} is damaged: {error}. Compute it again"
            raise FileError(message) from error
