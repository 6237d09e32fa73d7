"""Results as netCDF files: the samples as variables, everything else in the attributes."""

import json
import sys
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from io import BytesIO
from pathlib import Path
from typing import Any, TypeVar

import h5py
import numpy as np
import xarray as xr

from stylobate.errors import FileError, Outcome
from stylobate.files import read_sealed, sealed, write_whole
from stylobate.results.response import Event, Response

_Data = TypeVar("_Data", xr.Dataset, xr.DataTree)

_OWN_FORMATS = "stylobate "
_FORMAT = f"{_OWN_FORMATS}response 1"
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
    return write_netcdf(data, path)


def load_response(path: str | Path) -> Response:
    """Return the run saved in the netCDF file `path`.

    Raises
    ------
    FileError
        If the file cannot be read or holds no saved run; `stylobate.load` reads any result.
    """
    data = read_dataset(path)
    attributes: dict[str, Any] = dict(data.attrs)
    if "format" not in attributes and "kind" in attributes:
        message = (
            f"{path} holds no run but the result of a study, of kind {attributes['kind']!r}; stylobate.load reads it"
        )
        raise FileError(message)
    kind = str(attributes.get("format", "")).removeprefix(_OWN_FORMATS).partition(" ")[0]
    if kind in _OF_ORBITS:
        message = f"{path} holds no run but, of stylobate.orbits, an object of kind {kind!r}; stylobate.load reads it"
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
    """Return what the netCDF file `path` holds, read into memory; times stay numbers.

    Raises
    ------
    FileError
        If the file cannot be read, or is not as it was written.
    """
    return _read(xr.open_dataset, path)


def read_tree(path: str | Path) -> xr.DataTree:
    """Return the groups that the netCDF file `path` holds, read into memory; times stay numbers.

    Raises
    ------
    FileError
        If the file cannot be read, or is not as it was written.
    """
    return _read(xr.open_datatree, path)


def write_netcdf(data: xr.Dataset | xr.DataTree, path: str | Path) -> Path:
    """Write `data` to the netCDF file `path`, with a checksum at its end, and return the path.

    The file is made in memory: a full disk then is an error of this process and not of the HDF5 library, which would
    end it.

    Raises
    ------
    FileError
        If the file cannot be written; an older file stays then.
    """
    with _without_a_cluster():
        content = data.to_netcdf(None, engine="h5netcdf")
    return write_whole(path, sealed(content))


def _without_a_cluster() -> AbstractContextManager[Any]:
    """Return a context in which an active Dask client is not used: xarray would have it lock the file in memory."""
    dask = sys.modules.get("dask")
    return nullcontext() if dask is None else dask.config.set(scheduler="synchronous")


def _read(open_file: Callable[..., _Data], path: str | Path) -> _Data:
    content, is_sealed = read_sealed(path)
    try:
        if not is_sealed:
            _require_readable(content)
        with open_file(BytesIO(content), engine="h5netcdf", decode_times=False) as stored:
            data = stored.load()
    except Exception as error:  # of a damaged file HDF5 and the layers above it raise errors of many classes
        message = f"cannot read {path}: it is no netCDF file, or damaged ({' '.join(str(error).split())})"
        raise FileError(message) from error
    if not is_sealed and str(data.attrs.get("format", "")).startswith(_OWN_FORMATS):
        message = f"{path} is damaged, or another program changed it: its checksum is missing. Compute it again"
        raise FileError(message)
    return data


def _require_readable(content: bytes) -> None:
    """Read all of an HDF5 file that may be damaged: h5py closes it after an error, which h5netcdf does not always."""

    def read(_: str, item: Any) -> None:
        dict(item.attrs)
        if isinstance(item, h5py.Dataset):
            item[()]

    with h5py.File(BytesIO(content), "r") as file:
        dict(file.attrs)
        file.visititems(read)


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
