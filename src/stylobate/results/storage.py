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

_HDF5 = b"\x89HDF\r\n\x1a\n"
# Bytes that the values in a file may declare: a small file can declare any size of equal values.
_LARGEST, _DENSEST = 1 << 30, 4
# Filters with higher numbers than those of HDF5 itself are loaded from plugins.
_LAST_OWN_FILTER = 255

_TABLE = f"{OWN_FORMATS}table 1"
"""Format of files of other data, such as the result of a study; what is read does not contain it."""


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

    The file is made in memory, so that a full disk raises an error; the HDF5 library would end the process. Its
    attribute `format` states that it has a checksum.

    Raises
    ------
    FileError
        If the file cannot be written; an older file then stays.
    """
    labelled = data.copy()
    labelled.attrs = {"format": _TABLE, **data.attrs}
    with _without_a_cluster():
        content = labelled.to_netcdf(None, engine="h5netcdf")
    whole = sealed(content)
    content.release()  # a later error would keep the memory of the closed file, which Python 3.12 does not survive
    return write_whole(path, whole)


def require_this_version(path: str | Path, written: object, known: str) -> None:
    """Raise FileError if the format `written` is the format `known`, such as "stylobate table 1", with another number.

    A file of another kind passes.
    """
    kind, _, number = known.rpartition(" ")
    written_kind, _, other = str(written).rpartition(" ")
    if written_kind != kind or other == number or not other.isdecimal():
        return
    age, remedy = ("later", "Update stylobate") if int(other) > int(number) else ("earlier", "Compute it again")
    raise FileError(
        f"{path}: written by a {age} version of stylobate (got the format {written!r}, not {known!r}). {remedy}"
    )


def _without_a_cluster() -> AbstractContextManager[Any]:
    """Return a context that disables an active Dask client, with which xarray would lock the file in memory."""
    dask = sys.modules.get("dask")
    return nullcontext() if dask is None else dask.config.set(scheduler="synchronous")


def _read(open_file: Callable[..., _Data], path: str | Path) -> _Data:
    content, is_sealed = read_sealed(path)
    try:
        _require_readable(content, is_sealed=is_sealed)
        with open_file(BytesIO(content), engine="h5netcdf", decode_times=False) as stored:
            data = stored.load()
    except Exception as error:  # HDF5 and the layers above it raise many classes of errors for damaged files
        raise FileError(
            f"cannot read {path}: it is not a netCDF file, or damaged ({' '.join(str(error).split())}). "
            "Give another file, or compute it again"
        ) from error
    written = str(data.attrs.get("format", ""))
    if not is_sealed and written.startswith(OWN_FORMATS):
        raise FileError(f"{path} is damaged, or another program changed it: its checksum is missing. Compute it again")
    require_this_version(path, written, _TABLE)
    if written == _TABLE:
        del data.attrs["format"]
    return data


def _require_readable(content: bytes, *, is_sealed: bool) -> None:
    """Refuse what is no HDF5 file, or refers to other files; read one without a checksum whole, as it may be damaged.

    h5py always closes a file after an error, h5netcdf does not.
    """
    if not content.startswith(_HDF5):
        raise ValueError("it begins otherwise")
    size = 0

    def look_at(_: str, item: Any) -> None:
        nonlocal size
        if isinstance(item, h5py.Group):
            _require_own_members(item)
        if isinstance(item, h5py.Dataset):
            size += _own_size(item)
            if size > max(_LARGEST, _DENSEST * len(content)):
                raise ValueError(f"its data are to take {size / _LARGEST:.3g} GiB, the file has {len(content)} bytes")
        if not is_sealed:
            dict(item.attrs)
            if isinstance(item, h5py.Dataset):
                item[()]

    with h5py.File(BytesIO(content), "r") as file:
        look_at("/", file)
        file.visititems(look_at)


def _require_own_members(group: h5py.Group) -> None:
    for name in group:
        if not isinstance(group.get(name, getlink=True), h5py.HardLink):
            raise ValueError(f"{name!r} is a link")  # noqa: TRY004  of a file, not of an argument


def _own_size(data: h5py.Dataset) -> int:
    """Return the size that the values declare [bytes]; refuse values in other files, or that need plugins."""
    made = data.id.get_create_plist()
    filters = [made.get_filter(place)[0] for place in range(made.get_nfilters())]
    if data.is_virtual or data.external or any(number > _LAST_OWN_FILTER for number in filters):
        raise ValueError(f"the values of {data.name!r} lie in other files, or need a plugin of HDF5")
    return int(data.nbytes)
