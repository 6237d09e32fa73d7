"""What an assessment finds: columns under records, with all numbers of its report; saved and shown again."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import xarray as xr

from stylobate.errors import FileError

_FORMAT = "stylobate assessment 1"


@dataclass(frozen=True, slots=True, kw_only=True)
class Assessment:
    """Columns under records: whether they stood, how close it was, and how sure that is.

    Attributes
    ----------
    data
        Datasets by name: "columns", "records", "verdicts", "margins" and "histories"; "robustness", "planar" and
        "fragility" where they were asked for.
    setting
        What was assessed, as plain values: title, version, models, dissipation, friction, processing of the records,
        scales, what the scan of margins looked at.
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
        beside = Path(path).with_name(f"{Path(path).name}.part")
        try:
            tree.to_netcdf(beside, engine="h5netcdf")
            beside.replace(path)
        except OSError as error:
            message = f"cannot write {path}: {error.strerror or error}"
            raise FileError(message) from None
        return Path(path)

    @classmethod
    def load(cls, path: str | Path) -> "Assessment":
        """Return the assessment saved in the netCDF file `path`.

        Raises
        ------
        FileError
            If the file cannot be read or holds no assessment.
        """
        if not Path(path).is_file():
            message = f"cannot read {path}: No such file or directory"
            raise FileError(message)
        try:
            with xr.open_datatree(path, engine="h5netcdf", decode_times=False) as stored:
                attributes = dict(stored.attrs)
                data = {str(name): child.to_dataset().load() for name, child in stored.children.items()}
        except (OSError, ValueError) as error:
            message = f"cannot read {path}: {getattr(error, 'strerror', None) or error}"
            raise FileError(message) from None
        if attributes.get("format") != _FORMAT:
            message = f"{path} holds no assessment saved by stylobate"
            raise FileError(message)
        return cls(data=data, setting=json.loads(attributes["setting"]))
