"""Results as netCDF files: the samples as variables, everything else in the attributes."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from stylobate.errors import FileError, Outcome
from stylobate.results.response import Event, Response

_FORMAT = "stylobate response 1"
_OF_ORBITS = ("orbit", "branch", "bifurcation")
_OWN_ATTRIBUTES = (
    "format",
    "outcome",
    "reason",
    "decided_at",
    "uncertain",
    "planar",
    "events",
    "thresholds",
    "measures",
    "provenance",
    "warnings",
)


def save_response(response: Response, path: Path) -> Path:
    """Write `response` to the netCDF file `path` and return the path.

    Raises
    ------
    FileError
        If the file cannot be written.
    """
    attributes = {
        "format": _FORMAT,
        "outcome": response.outcome.name,
        "reason": response.reason,
        "decided_at": response.decided_at,
        "uncertain": int(response.uncertain),
        "planar": int(response.planar),
        "events": json.dumps([[event.kind, event.time] for event in response.events]),
        "thresholds": json.dumps(dict(response.thresholds)),
        "measures": json.dumps(dict(response.measures)),
        "provenance": json.dumps(dict(response.provenance)),
        "warnings": json.dumps(list(response.warnings)),
    }
    data = response.data.assign_attrs(attributes)
    data["resting"] = data["resting"].astype(np.int8)
    return write_dataset(data, path)


def load(path: str | Path) -> Response:
    """Return the run saved in the netCDF file `path`.

    Raises
    ------
    FileError
        If the file cannot be read or holds no saved run; the result of a study is read by `xarray.open_dataset`.
    """
    data = read_dataset(path)
    attributes: dict[str, Any] = dict(data.attrs)
    if "format" not in attributes and "kind" in attributes:
        message = (
            f"{path} holds no run but the result of a study, of kind {attributes['kind']!r}; "
            "xarray.open_dataset reads it"
        )
        raise FileError(message)
    kind = str(attributes.get("format", "")).removeprefix("stylobate ").partition(" ")[0]
    if kind in _OF_ORBITS:
        message = (
            f"{path} holds no run but, of stylobate.orbits, an object of kind {kind!r}; stylobate.orbits.load reads it"
        )
        raise FileError(message)
    if attributes.get("format") != _FORMAT:
        message = f"{path} is no run saved by stylobate: its format is {attributes.get('format')!r}, not {_FORMAT!r}"
        raise FileError(message)
    try:
        return _response(data, attributes)
    except (KeyError, TypeError, ValueError) as error:
        message = f"{path} is damaged: {error}"
        raise FileError(message) from error


def read_dataset(path: str | Path) -> xr.Dataset:
    """Return what the netCDF file `path` holds, read into memory.

    Raises
    ------
    FileError
        If the file cannot be read.
    """
    if not Path(path).is_file():
        message = f"cannot read {path}: {'it is a folder' if Path(path).is_dir() else 'there is no such file'}"
        raise FileError(message)
    try:
        with xr.open_dataset(path, engine="h5netcdf") as stored:
            return stored.load()
    except (OSError, ValueError) as error:
        message = f"cannot read {path}: {getattr(error, 'strerror', None) or error}"
        raise FileError(message) from error


def write_dataset(data: xr.Dataset, path: Path) -> Path:
    """Write `data` to the netCDF file `path` and return the path.

    Raises
    ------
    FileError
        If the file cannot be written.
    """
    try:
        data.to_netcdf(path, engine="h5netcdf")
    except OSError as error:
        message = f"cannot write {path}: {error.strerror or error}"
        raise FileError(message) from error
    return path


def _response(data: xr.Dataset, attributes: dict[str, Any]) -> Response:
    data.attrs = {name: value for name, value in attributes.items() if name not in _OWN_ATTRIBUTES}
    data["resting"] = data["resting"].astype(bool)
    return Response(
        outcome=Outcome[attributes["outcome"]],
        reason=str(attributes["reason"]),
        decided_at=float(attributes["decided_at"]),
        uncertain=bool(attributes["uncertain"]),
        planar=bool(attributes["planar"]),
        data=data,
        events=tuple(Event(kind, time) for kind, time in json.loads(attributes["events"])),
        thresholds=json.loads(attributes["thresholds"]),
        measures=json.loads(attributes["measures"]),
        provenance=json.loads(attributes["provenance"]),
        warnings=tuple(json.loads(attributes.get("warnings", "[]"))),
    )
