"""NetCDF files with a checksum."""

import sys
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from io import BytesIO
from pathlib import Path
from typing import Any, TypeVar

import h5py
import xarray as xr

from stylobate.errors import FileError
from stylobate.files import read_sealed, sealed, write_whole

_Data = TypeVar("_Data", xr.Dataset, xr.DataTree)

OWN_FORMATS = "stylobate "
"""First word of the formats of the package's own files."""


def read_dataset(path: str | Path) -> xr.Dataset:
    """Read the Dataset in the netCDF file `path` into memory; times stay numbers.

    Raises
    ------
    FileError
        If the file cannot be read, or its checksum differs.
    """
    return _read(xr.open_dataset, path)


def read_tree(path: str | Path) -> xr.DataTree:
    """Read the groups of the netCDF file `path` into memory; times stay numbers.

    Raises
    ------
    FileError
        If the file cannot be read, or its checksum differs.
    """
    return _read(xr.open_datatree, path)


def write_netcdf(data: xr.Dataset | xr.DataTree, path: str | Path) -> Path:
    """Write `data` to the netCDF file `path`, with a checksum at its end, and return the path.

    The file is made in memory, so that a full disk raises an error; the HDF5 library would end the process.

    Raises
    ------
    FileError
        If the file cannot be written; an older file then stays.
    """
    with _without_a_cluster():
        content = data.to_netcdf(None, engine="h5netcdf")
    return write_whole(path, sealed(content))


def _without_a_cluster() -> AbstractContextManager[Any]:
    """Return a context that disables an active Dask client, with which xarray would lock the file in memory."""
    dask = sys.modules.get("dask")
    return nullcontext() if dask is None else dask.config.set(scheduler="synchronous")


def _read(open_file: Callable[..., _Data], path: str | Path) -> _Data:
    content, is_sealed = read_sealed(path)
    try:
        if not is_sealed:
            _require_readable(content)
        with open_file(BytesIO(content), engine="h5netcdf", decode_times=False) as stored:
            data = stored.load()
    except Exception as error:  # HDF5 and the layers above it raise many classes of errors for damaged files
        message = f"cannot read {path}: it is not a netCDF file, or damaged ({' '.join(str(error).split())})"
        raise FileError(message) from error
    if not is_sealed and str(data.attrs.get("format", "")).startswith(OWN_FORMATS):
        message = f"{path} is damaged, or another program changed it: its checksum is missing. Compute it again"
        raise FileError(message)
    return data


def _require_readable(content: bytes) -> None:
    """Read a whole HDF5 file that may be damaged; h5py always closes it after an error, h5netcdf does not."""

    def read(_: str, item: Any) -> None:
        dict(item.attrs)
        if isinstance(item, h5py.Dataset):
            item[()]

    with h5py.File(BytesIO(content), "r") as file:
        dict(file.attrs)
        file.visititems(read)
