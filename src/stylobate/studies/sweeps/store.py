"""Zarr stores of sweeps: create, open and continue them; state why a store belongs to another sweep.

A `KeyedStore` holds wholes under keys; this store is one array that many workers fill, chunk by chunk.
"""

import hashlib
import json
import logging
import re
import shutil
from collections.abc import Iterator, Mapping
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from xarray.backends import BackendArray, BackendEntrypoint
from xarray.core import indexing

from stylobate.errors import FileError
from stylobate.files import written_aside
from stylobate.results.storage import require_this_version
from stylobate.studies.sweeps.chunks import (
    METADATA,
    SEAL,
    Blocks,
    Chunks,
    ChunkState,
    Layout,
    StoredArray,
    Variable,
    axis,
    bytes_of_block,
    bytes_on_disk,
    checksum,
)
from stylobate.studies.sweeps.designs import whole
from stylobate.studies.sweeps.sweep import Sweep
from stylobate.text import plural

# Maximum number of listed differences; more show that the sweeps are unrelated.
_LISTED = 3


def differences(stored: Mapping[str, Any], given: Mapping[str, Any]) -> list[str]:
    """Return one phrase for each of the first differences, with the version first; empty if there is none."""
    if stored.get("version") != given.get("version"):
        return [f"the store was made by stylobate {stored.get('version')}, this is {given.get('version')}"]
    before, now = dict(_leaves(_by_name(stored))), dict(_leaves(_by_name(given)))
    names = [*now, *(name for name in before if name not in now)]
    found = [_difference(name, before.get(name), now.get(name)) for name in names if before.get(name) != now.get(name)]
    more = [f"and {len(found) - _LISTED} more differences"] if len(found) > _LISTED else []
    return [*found[:_LISTED], *more]


def _by_name(values: Any) -> Any:
    """Return `values` with records identified by name and content, independent of their folder."""
    if isinstance(values, list):
        return [_by_name(value) for value in values]
    if not isinstance(values, Mapping):
        return values
    found = {name: _by_name(value) for name, value in values.items()}
    if isinstance(values.get("file_sha256"), Mapping) and values["file_sha256"]:
        found.pop("path", None)
        found["file_sha256"] = {Path(path).name: digest for path, digest in values["file_sha256"].items()}
    return found


def _leaves(values: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    for name, value in values.items():
        if isinstance(value, Mapping) and "sha256" not in value:
            # Quantities that vary have their own names.
            yield from _leaves(value, "" if name == "values" else f"{prefix}{name}.")
        else:
            yield f"{prefix}{name}", value


def _difference(name: str, before: Any, now: Any) -> str:
    if name.endswith("_sha256"):
        return f"{name.removesuffix('_sha256').replace('.', ' ')} changed"
    shown = _shown(before), _shown(now)
    return f"{name} was {shown[0]}, is {shown[1]}" if shown[0] != shown[1] else f"{name} has other values than before"


def _shown(value: Any) -> str:
    if isinstance(value, Mapping) and "sha256" in value:
        ends = f" from {value['first']!r} to {value['last']!r}" if value["count"] else ""
        return f"{value['count']} values{ends}"
    return "not given" if value is None else repr(value)


_log = logging.getLogger("stylobate")

_FORMAT = "stylobate sweep 4"
_SOFTWARE = ("numpy", "scipy", "llvmlite")
_SEAL = "metadata_sha256"


def create_store(path: Path, sweep: Sweep, layout: Layout, blocks: Blocks) -> Chunks:
    """Create a store at `path` with coordinates and attributes, without computed runs.

    The store is written beside `path` and moved there when complete.

    Raises
    ------
    FileError
        If `path` exists, the disk has no room for the whole sweep, or the store cannot be written.
    """
    _require_new(path)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileError(f"cannot write {path}: {error.strerror or error}") from error
    _require_room(path, bytes_on_disk(layout, sweep.design, blocks))
    try:
        with written_aside(path) as beside:
            _fill_new(beside, sweep, layout, blocks)
    except FileError:
        _require_new(path)  # another process may have created it in the meantime
        raise
    return Chunks(path, blocks, layout.variables)


def _require_new(path: Path) -> None:
    if path.exists():
        raise FileError(f"{path} exists. Continue it with resume=True, or give another store")


def continue_store(path: Path, sweep: Sweep, layout: Layout, chunk_size: int | None) -> tuple[Chunks, frozenset[int]]:
    """Return the chunks of the store at `path`, and the indices of the completed blocks.

    Damaged blocks are emptied, with a warning in the log.

    Raises
    ------
    FileError
        If `path` is not the store of a sweep, or of another sweep or version; the message names the differences.
    """
    attributes = _read_attributes(path)
    found = differences(json.loads(attributes["provenance"]), json.loads(json.dumps(sweep.describe())))
    if found or attributes["variables"] != _described(layout.variables):
        found = found or ["its variables differ"]
        raise FileError(
            f"{path} cannot be continued: {'; '.join(found)}. Give another store, or the sweep that began this one"
        )
    blocks = Blocks(sweep.shape, tuple(attributes["chunks"]))
    if chunk_size is not None and Blocks.of(sweep.shape, chunk_size) != blocks:
        raise FileError(f"{path} has chunks of {list(blocks.edges)} runs, not of {chunk_size}. Leave chunk_size out")
    chunks = Chunks(path, blocks, layout.variables)
    states = chunks.states()
    _compute_again(chunks, [index for index, state in states.items() if state is ChunkState.DAMAGED])
    if missing := [index for index, state in states.items() if state is not ChunkState.DONE]:
        _require_room(path, len(missing) * bytes_of_block(layout, blocks))
    return chunks, frozenset(index for index, state in states.items() if state is ChunkState.DONE)


def _compute_again(chunks: Chunks, damaged: list[int]) -> None:
    if not damaged:
        return
    runs = sum(chunks.blocks[index].size for index in damaged)
    _log.warning("%s is damaged: %s are computed again", chunks.path, plural(runs, "run"))
    try:
        for index in damaged:
            if chunks.state(index) is ChunkState.DAMAGED:  # another process may have computed it in the meantime
                chunks.forget(index)
    except OSError as error:
        raise FileError(f"cannot write {chunks.path}: {error.strerror or error}. Begin another store") from error


def open_sweep(path: str | Path, *, load: bool = False) -> xr.Dataset:
    """Open the store of a sweep, finished or not: outcome −1 and NaN where nothing is computed.

    Parameters
    ----------
    path
        Folder of a store that `run_sweep` wrote.
    load
        Read everything into memory at once. Otherwise a variable is read when it is used, and only the chunks that a
        selection (`isel`, `sel`) touches. If Dask is installed, `.chunk()` on the result gives Dask arrays.

    Returns
    -------
    xarray.Dataset
        As `run_sweep` returns it; `attrs["runs_done"]` counts the runs in finished chunks.

    Raises
    ------
    FileError
        If there is no store of a sweep at `path`, or if it is damaged: all files are compared with their seals.
    """
    path = Path(path)
    attributes = _read_attributes(path)
    chunks = Chunks(path, Blocks(tuple(attributes["shape"]), tuple(attributes["chunks"])), _variables(attributes))
    states = chunks.states()
    if damaged := sum(chunks.blocks[index].size for index, state in states.items() if state is ChunkState.DAMAGED):
        raise FileError(f"{path} is damaged: {plural(damaged, 'run')} cannot be read. Continue it with resume=True")
    runs_done = sum(chunks.blocks[index].size for index, state in states.items() if state is ChunkState.DONE)
    axes, labels = attributes["coordinates"].split(), attributes["labels"]
    data = xr.open_dataset(
        path, engine=_Backend, arrays=[chunks.arrays[name] for name in attributes["variables"]], axes=axes
    )
    data = data.assign_coords(labels)
    kept = {name: attributes[name] for name in ("kind", "provenance")}
    data.attrs = {**kept, "runs_done": runs_done}
    return data.load() if load else data


class _Backend(BackendEntrypoint):
    """Read a store without Zarr, whose import takes some tenths of a second."""

    def open_dataset(  # type: ignore[override]
        self, path: Path, *, drop_variables: None = None, arrays: list[StoredArray], axes: list[str]
    ) -> xr.Dataset:
        del drop_variables
        data = {array.variable.name: _lazy(array) for array in arrays}
        lengths = {name: _metadata(path / name)["shape"][0] for name in axes}
        return xr.Dataset(data, {name: _lazy(axis(path, name, length)) for name, length in lengths.items()})


class _LazyArray(BackendArray):
    """An array that is read when it is used."""

    def __init__(self, array: StoredArray) -> None:
        self.array, self.shape, self.dtype = array, array.shape, array.variable.dtype

    def __getitem__(self, key: indexing.ExplicitIndexer) -> Any:
        outer = indexing.IndexingSupport.OUTER
        return indexing.explicit_indexing_adapter(key, self.shape, outer, self.array.read)


def _lazy(array: StoredArray) -> xr.Variable:
    described = _metadata(array.folder)
    dims, attributes = described["dimension_names"], described["attributes"]
    if "flag_values" in attributes:
        attributes["flag_values"] = np.array(attributes["flag_values"], dtype=array.variable.dtype)
    chunks = {"preferred_chunks": dict(zip(dims, array.chunk, strict=True))}
    return xr.Variable(dims, indexing.LazilyIndexedArray(_LazyArray(array)), attributes, chunks)


def _fill_new(path: Path, sweep: Sweep, layout: Layout, blocks: Blocks) -> None:
    path.mkdir()
    design, everything = sweep.design, whole(sweep.design)
    for array in Chunks(path, blocks, layout.variables).arrays.values():
        array.create(("chunk",) if array.variable is SEAL else (*design.dims, *array.variable.dims))
    for place, (dim, length) in enumerate(zip(design.dims, design.shape, strict=True)):
        axes = [axis(path, name, length) for name, along in design.coordinate_dims.items() if along == dim]
        for one in axes:
            one.create((dim,))
        for block in axes[0].blocks:  # random and given points may be numerous
            values = design.coordinates((*everything[:place], *block.slices, *everything[place + 1 :]))
            for one in axes:
                with one.shard("r+b") as shard:
                    shard.write(block.index, one.encoded(block, values[one.variable.name]))
    attributes = _attributes(sweep, layout, blocks)
    metadata = {"attributes": attributes, "zarr_format": 3, "node_type": "group"}
    attributes[_SEAL] = _digest(path, json.loads(json.dumps(metadata)))
    (path / METADATA).write_text(json.dumps(metadata, indent=2), "utf-8")


def _attributes(sweep: Sweep, layout: Layout, blocks: Blocks) -> dict[str, Any]:
    return {
        "format": _FORMAT,
        **attributes_of_result(sweep),
        "shape": list(blocks.shape),
        "chunks": list(blocks.edges),
        "coordinates": " ".join(sweep.design.coordinate_dims),
        "variables": _described(layout.variables),
        "labels": dict(layout.labels),
        "software": {name: version(name) for name in _SOFTWARE if find_spec(name)},
    }


def attributes_of_result(sweep: Sweep) -> dict[str, Any]:
    """Return the attributes of the results of `sweep`, stored or not."""
    return {"kind": "sweep", "provenance": json.dumps(sweep.describe())}


def _described(variables: tuple[Variable, ...]) -> dict[str, list[Any]]:
    """Describe variables in plain values: type, and shape besides the runs, by name."""
    return {variable.name: [variable.dtype.str, list(variable.shape)] for variable in variables}


def _variables(attributes: Mapping[str, Any]) -> tuple[Variable, ...]:
    """Return the variables that `_described` describes, without dimensions and attributes."""
    described = attributes["variables"].items()
    return tuple(Variable(name, np.dtype(dtype), (), tuple(shape), {}) for name, (dtype, shape) in described)


# A folder in the store itself.
_NAME = re.compile(r"\w[\w.-]*")
_NUMBERS = "biuf"


def _are_own_arrays(attributes: Mapping[str, Any]) -> bool:
    """Return whether the named arrays are folders of the store and hold numbers, which NumPy reads without objects."""
    try:
        types = [np.dtype(dtype).kind for dtype, _ in attributes["variables"].values()]
        names = [*attributes["variables"], *attributes["coordinates"].split()]
    except (KeyError, TypeError, ValueError, AttributeError, SyntaxError):  # SyntaxError: of types with commas
        return False
    return all(kind in _NUMBERS for kind in types) and all(map(_NAME.fullmatch, names))


def _read_attributes(path: Path) -> dict[str, Any]:
    """Return the attributes of the store at `path`, after a check of its metadata and axes."""
    try:
        metadata = _metadata(path)
        attributes = dict(metadata["attributes"])
    except (OSError, ValueError, KeyError, TypeError, RecursionError) as error:
        reason = "it is no store of a sweep" if path.is_dir() else getattr(error, "strerror", None) or error
        raise FileError(f"cannot read {path}: {reason}. Give another folder") from error
    written = attributes.get("format")
    require_this_version(path, written, _FORMAT)
    if written != _FORMAT:
        raise FileError(
            f"{path} is no store of a sweep: its format is {written!r}, not {_FORMAT!r}. Give another folder"
        )
    seal = attributes.pop(_SEAL, None)
    if seal is None or not _are_own_arrays(attributes) or seal != _digest(path, metadata):
        raise FileError(f"{path} is damaged: its metadata or axes are not as they were written. Begin another store")
    return attributes


def _metadata(path: Path) -> dict[str, Any]:
    found: dict[str, Any] = json.loads((path / METADATA).read_bytes())
    return found


def _digest(path: Path, metadata: Mapping[str, Any]) -> str | None:
    """Return a digest of the metadata of the store at `path`, without seal, of its arrays and of its axes.

    None if a file is missing or damaged.
    """
    try:
        attributes = {name: value for name, value in metadata["attributes"].items() if name != _SEAL}
        axes = attributes["coordinates"].split()
        digest = hashlib.sha256(json.dumps({**metadata, "attributes": attributes}, sort_keys=True).encode())
        for name in (SEAL.name, *attributes["variables"], *axes):
            content = (path / name / METADATA).read_bytes()
            digest.update(f" {name} {len(content)} ".encode() + content)
        for name in axes:
            array = axis(path, name, _metadata(path / name)["shape"][0])
            with array.shard() as shard:
                for index in range(len(array.blocks)):
                    if not shard.holds(index):
                        return None
                    digest.update(checksum(shard.content(index)))
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return None
    return digest.hexdigest()


def _require_room(path: Path, needed: int) -> None:
    free = shutil.disk_usage(path.parent).free
    if needed > free:
        raise FileError(
            f"the sweep needs up to {_size(needed)} at {path} and the disk has {_size(free)} free. "
            "Choose another disk, fewer runs, or fewer samples and strobes"
        )


def _size(count: int) -> str:
    size, units = float(count), ["bytes", "kB", "MB", "GB", "TB"]
    while size >= 1000.0 and len(units) > 1:  # noqa: PLR2004  SI prefixes
        size, units = size / 1000.0, units[1:]
    return f"{size:.3g} {units[0]}"
