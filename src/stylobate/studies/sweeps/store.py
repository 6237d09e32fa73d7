"""The store of a sweep: a Zarr group with one chunk of every variable for each task.

The data of a task are written before its mark `done`, and the outcomes after the rest of the data: a run whose outcome
is there is there as a whole, whatever happened in between. No two tasks share a chunk of any array, and writing a task
again writes the same.
"""

import json
import shutil
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
import zarr

from stylobate.errors import FileError
from stylobate.studies.sweeps.blocks import Block, Blocks
from stylobate.studies.sweeps.computing import Arrays
from stylobate.studies.sweeps.designs import whole
from stylobate.studies.sweeps.layout import Layout, bytes_of_block, bytes_on_disk
from stylobate.studies.sweeps.quantities import attributes_of
from stylobate.studies.sweeps.resuming import differences
from stylobate.studies.sweeps.sweep import Sweep

_FORMAT = "stylobate sweep 1"
_MARK = "done"
_OUTCOME = "outcome"
_SOFTWARE = ("numpy", "scipy", "numba", "zarr")


@dataclass(frozen=True, slots=True)
class Store:
    """The store at `path`, which exists."""

    path: Path

    def write(self, block: Block, arrays: Mapping[str, Any], *, done: bool) -> None:
        """Write the results of a `block`, flat over its runs: data, then outcomes, then the mark if it is `done`."""
        group = zarr.open_group(self.path, mode="r+")
        for name in sorted(arrays, key=lambda name: name == _OUTCOME):
            values = np.asarray(arrays[name])
            _array(group, name)[block.slices] = values.reshape(*block.shape, *values.shape[1:])
        if done:
            _array(group, _MARK)[block.index] = True

    def read(self, block: Block, names: tuple[str, ...]) -> Arrays:
        """Return the results of a `block`, flat over its runs."""
        group = zarr.open_group(self.path, mode="r")
        found = {name: np.asarray(_array(group, name)[block.slices]) for name in names}
        return {name: values.reshape(block.size, *values.shape[len(block.shape) :]) for name, values in found.items()}

    def done(self) -> set[int]:
        """Return the indices of the blocks that are done."""
        marks = np.asarray(_array(zarr.open_group(self.path, mode="r"), _MARK)[:])
        return {int(index) for index in np.flatnonzero(marks)}


def create_store(path: Path, sweep: Sweep, layout: Layout, blocks: Blocks) -> Store:
    """Return a new store at `path`, with coordinates and attributes and nothing computed.

    It is made beside its place and moved there when it is whole.

    Raises
    ------
    FileError
        If there is something at `path`, if the disk has no room for the whole sweep, or if it cannot be written.
    """
    if path.exists():
        message = f"{path} exists; continue it with resume=True, or give another store"
        raise FileError(message)
    beside = path.with_name(f".{path.name}.new")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        _require_room(path, bytes_on_disk(layout, sweep.design, blocks))
        shutil.rmtree(beside, ignore_errors=True)
        _fill_new(zarr.create_group(beside, attributes=_attributes(sweep, layout, blocks)), sweep, layout, blocks)
        beside.rename(path)
    except OSError as error:
        message = f"cannot write {path}: {error.strerror or error}"
        raise FileError(message) from error
    return Store(path)


def continue_store(path: Path, sweep: Sweep, layout: Layout, chunk_size: int | None) -> tuple[Store, Blocks]:
    """Return the store at `path` and the blocks into which it is cut, to compute what is missing in it.

    Raises
    ------
    FileError
        If it is no store of a sweep, or that of another sweep or version; the message names what differs.
    """
    attributes = _read_attributes(path)
    found = differences(json.loads(attributes["provenance"]), json.loads(json.dumps(sweep.describe())))
    if found:
        message = (
            f"{path} cannot be continued: {'; '.join(found)}. Give another store, or the sweep that began this one"
        )
        raise FileError(message)
    blocks = Blocks(sweep.shape, tuple(attributes["chunks"]))
    if chunk_size is not None and Blocks.of(sweep.shape, chunk_size) != blocks:
        message = f"{path} is cut into chunks of {list(blocks.edges)} runs, not of {chunk_size}; leave chunk_size out"
        raise FileError(message)
    store = Store(path)
    if len(blocks):
        _require_room(path, (len(blocks) - len(store.done())) * bytes_of_block(layout, blocks[0]))
    return store, blocks


def open_sweep(path: str | Path, *, load: bool = False) -> xr.Dataset:
    """Return the results in the store at `path`, finished or not: outcome −1 and NaN where nothing is computed.

    Parameters
    ----------
    path
        The store that `run_sweep` wrote.
    load
        Read everything into memory at once. Otherwise a variable is read when it is used, and of a selection
        (`isel`, `sel`) only the chunks it touches; `.chunk()` on the result gives Dask arrays, if Dask is installed.

    Returns
    -------
    xarray.Dataset
        As `run_sweep` returns it; `attrs["runs_done"]` counts the runs in finished chunks.

    Raises
    ------
    FileError
        If there is no store of a sweep at `path`.
    """
    path = Path(path)
    attributes = _read_attributes(path)
    blocks = Blocks(tuple(attributes["shape"]), tuple(attributes["chunks"]))
    runs_done = sum(blocks[index].size for index in Store(path).done())
    data: xr.Dataset = xr.open_zarr(path, chunks=None, consolidated=False, decode_cf=False, drop_variables=_MARK)
    for variable in data.variables.values():
        variable.attrs.pop("_FillValue", None)
        if "flag_values" in variable.attrs:
            variable.attrs["flag_values"] = np.array(variable.attrs["flag_values"], dtype=variable.dtype)
    data = data.set_coords(attributes["coordinates"].split()).assign_coords(attributes["labels"])
    data = data[attributes["variables"]]  # in their order, with their coordinates
    kept = {name: attributes[name] for name in ("kind", "provenance")}
    data.attrs = {**kept, "runs_done": runs_done}
    return data.load() if load else data


def _fill_new(group: zarr.Group, sweep: Sweep, layout: Layout, blocks: Blocks) -> None:
    for variable in layout.variables:
        group.create_array(
            variable.name,
            shape=(*blocks.shape, *variable.shape),
            chunks=(*blocks.edges, *(max(1, length) for length in variable.shape)),
            dtype=variable.dtype,
            fill_value=variable.fill,
            dimension_names=(*sweep.dims, *variable.dims),
            attributes=_plain(variable.attributes),
        )
    group.create_array(
        _MARK, shape=(len(blocks),), chunks=(1,), dtype=bool, fill_value=False, dimension_names=("chunk",)
    )
    design = sweep.design
    for name, dim in design.coordinate_dims.items():
        place = design.dims.index(dim)
        group.create_array(
            name,
            shape=(blocks.shape[place],),
            chunks=(blocks.edges[place],),
            dtype=float,
            fill_value=np.nan,
            dimension_names=(dim,),
            attributes=dict(attributes_of(name)),
        )
    # Random and given points may be many: they are written piece by piece.
    for slices in (block.slices for block in blocks) if design.dims == ("run",) else (whole(design),):
        for name, values in design.coordinates(slices).items():
            _array(group, name)[slices[design.dims.index(design.coordinate_dims[name])]] = values


def _attributes(sweep: Sweep, layout: Layout, blocks: Blocks) -> dict[str, Any]:
    return {
        "format": _FORMAT,
        **attributes_of_result(sweep),
        "shape": list(blocks.shape),
        "chunks": list(blocks.edges),
        "coordinates": " ".join(sweep.design.coordinate_dims),
        "variables": [variable.name for variable in layout.variables],
        "labels": dict(layout.labels),
        "software": {name: version(name) for name in _SOFTWARE if find_spec(name)},
    }


def attributes_of_result(sweep: Sweep) -> dict[str, Any]:
    """Return the attributes of the results of `sweep`, stored or not."""
    return {"kind": "sweep", "provenance": json.dumps(sweep.describe())}


def _read_attributes(path: Path) -> dict[str, Any]:
    try:
        attributes = dict(zarr.open_group(path, mode="r").attrs)
    except (OSError, ValueError) as error:  # zarr's own exceptions are ValueErrors
        message = f"cannot read {path}: {getattr(error, 'strerror', None) or 'it is no store of a sweep'}"
        raise FileError(message) from error
    if attributes.get("format") != _FORMAT:
        message = f"{path} is no store of a sweep: its format is {attributes.get('format')!r}, not {_FORMAT!r}"
        raise FileError(message)
    return attributes


def _require_room(path: Path, needed: int) -> None:
    free = shutil.disk_usage(path.parent).free
    if needed > free:
        message = (
            f"the sweep needs up to {_size(needed)} at {path} and the disk has {_size(free)} free; "
            "choose another disk, fewer runs, or fewer samples and strobes"
        )
        raise FileError(message)


def _size(count: int) -> str:
    size, units = float(count), ["bytes", "kB", "MB", "GB", "TB"]
    while size >= 1000.0 and len(units) > 1:  # noqa: PLR2004  SI prefixes
        size, units = size / 1000.0, units[1:]
    return f"{size:.3g} {units[0]}"


def _plain(attributes: Mapping[str, Any]) -> dict[str, Any]:
    return {name: value.tolist() if isinstance(value, np.ndarray) else value for name, value in attributes.items()}


def _array(group: zarr.Group, name: str) -> Any:
    return group[name]
