"""Computation of a sweep in chunks: recipe of a run, blocks of runs, layout of the results."""

import hashlib
import json
import math
import struct
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from enum import Enum, auto
from io import BytesIO
from itertools import product
from pathlib import Path
from typing import IO, Any

import google_crc32c
import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate.base_motions import BaseMotion
from stylobate.base_motions.combined import members_of
from stylobate.base_motions.declared import stated_numbers, with_numbers
from stylobate.engine import simulate_ensemble
from stylobate.errors import Interrupted
from stylobate.models import Model
from stylobate.parameter_quantities import attributes_of
from stylobate.progress import Report
from stylobate.results.known_orbits import as_orbits
from stylobate.results.outcomes import NOT_COMPUTED
from stylobate.run_arguments import RunOptions
from stylobate.studies.known_rolling import known_rolling
from stylobate.studies.sweeps.designs import OF_A_RUN, Design, Floats, whole


@dataclass(frozen=True, slots=True)
class Recipe:
    """Model, motion and options of every run, and either its `duration` [s] or its number of `periods`, or neither."""

    model: Model
    motion: BaseMotion
    duration: float | None
    periods: float | None
    options: RunOptions

    def arguments(self, values: Mapping[str, Floats]) -> dict[str, Any]:
        """Return the keyword arguments of `simulate_ensemble` for runs at these `values`, arrays of one length."""
        count = next(iter(values.values())).size
        chosen: dict[str, Any] = {**self.options}
        for name in ("tilt", "tilt_rate"):
            x, y = chosen[name]
            parts = (values.get(f"{name}_x", np.full(count, x)), values.get(f"{name}_y", np.full(count, y)))
            chosen[name] = np.stack(parts, axis=-1)
        chosen["spin"] = values.get("spin", chosen["spin"])
        own = {name: array for name, array in values.items() if name not in OF_A_RUN}
        if chosen.pop("end_converged") and count > 0:
            rolling = known_rolling(self.model, self.motion, own, count)
            chosen["known_orbits"] = (*as_orbits(chosen["known_orbits"]), rolling)
        return {**chosen, "duration": self._durations(values), "parameters": own}

    def _durations(self, values: Mapping[str, Floats]) -> Floats | float:
        if self.periods is None:
            return values["duration"] if self.duration is None else self.duration
        if "angular_frequency" in values:
            return np.asarray(self.periods * 2.0 * math.pi / values["angular_frequency"])
        if "motion" in values:
            periods = np.array([member.period or math.nan for member in members_of(self.motion)])
            return np.asarray(self.periods * periods[values["motion"].astype(np.intp)])
        assert self.motion.period is not None  # a sweep refuses periods of a motion without one
        stated = [name for name in values if name in stated_numbers(self.motion)]
        if stated:  # such as a frequency [Hz]
            rows, which = np.unique(np.stack([values[name] for name in stated], axis=1), axis=0, return_inverse=True)
            changed = (with_numbers(self.motion, dict(zip(stated, row, strict=True))) for row in rows.tolist())
            return self.periods * np.array([motion.period for motion in changed], dtype=float)[which.ravel()]
        return self.periods * self.motion.period


# Target number of blocks of a sweep; minimum and maximum number of runs in a block.
_USUAL_COUNT, _SMALLEST, _LARGEST = 64, 1024, 16384


@dataclass(frozen=True, slots=True)
class GridBlock:
    """A rectangular piece of the array of runs; `index` is its number among all blocks."""

    index: int
    slices: tuple[slice, ...]

    @property
    def shape(self) -> tuple[int, ...]:
        """Length of the block along each dimension."""
        return tuple(part.stop - part.start for part in self.slices)

    @property
    def size(self) -> int:
        """Number of runs in the block."""
        return math.prod(self.shape)


@dataclass(frozen=True, slots=True)
class Blocks:
    """All the blocks of an array of runs of this `shape`; each spans at most `edges` runs along each dimension."""

    shape: tuple[int, ...]
    edges: tuple[int, ...]

    @classmethod
    def of(cls, shape: tuple[int, ...], runs: int | None = None) -> "Blocks":
        """Return blocks of at most `runs` runs, which span the last dimensions completely if possible."""
        room = usual_size(math.prod(shape)) if runs is None else runs
        edges = []
        for length in reversed(shape):
            pieces = -(-length // max(1, room))  # rounded up
            edge = -(-length // max(1, pieces))  # the same for all pieces but the last
            edges.append(max(1, edge))
            room = room // max(1, edge) if edge == length else 1
        return cls(shape, tuple(reversed(edges)))

    @property
    def counts(self) -> tuple[int, ...]:
        """The number of blocks along each dimension."""
        return tuple(-(-length // edge) for length, edge in zip(self.shape, self.edges, strict=True))

    def __len__(self) -> int:
        return math.prod(self.counts)

    def __getitem__(self, index: int) -> GridBlock:
        if not 0 <= index < len(self):
            raise IndexError(index)
        rest, slices = index, []
        for count, length, edge in zip(reversed(self.counts), reversed(self.shape), reversed(self.edges), strict=True):
            rest, place = divmod(rest, count)
            slices.append(slice(place * edge, min((place + 1) * edge, length)))
        return GridBlock(index, tuple(reversed(slices)))

    def __iter__(self) -> Iterator[GridBlock]:
        return (self[index] for index in range(len(self)))


def usual_size(runs: int) -> int:
    """Return the default maximum number of runs in a block of a sweep of `runs` runs."""
    return min(max(_SMALLEST, -(-runs // _USUAL_COUNT)), _LARGEST)


@dataclass(frozen=True, slots=True)
class Variable:
    """One result: an array over the runs and, for each run, over `dims` of `shape`."""

    name: str
    dtype: np.dtype[Any]
    dims: tuple[str, ...]
    shape: tuple[int, ...]
    attributes: Mapping[str, Any]

    @property
    def fill(self) -> Any:
        """Value for a run that is not computed: −1 for the outcome, NaN, 0 or False."""
        if self.name == "outcome":
            return NOT_COMPUTED
        return self.dtype.type(np.nan if self.dtype.kind == "f" else 0)

    @property
    def bytes_of_a_run(self) -> int:
        """Memory of the result of one run [bytes]."""
        return self.dtype.itemsize * math.prod(self.shape)

    def empty(self, runs: tuple[int, ...]) -> npt.NDArray[Any]:
        """Return an array of this shape of runs, filled with the value for runs that are not computed."""
        return np.full((*runs, *self.shape), self.fill, self.dtype)


@dataclass(frozen=True, slots=True)
class Layout:
    """The `variables` of a sweep's results, and the `labels` along the dimensions of each run."""

    variables: tuple[Variable, ...]
    labels: Mapping[str, list[Any]]


def layout_of(recipe: Recipe, names: tuple[str, ...]) -> Layout:
    """Determine the layout of a sweep's results over `names` from an ensemble without runs.

    Raises
    ------
    ParameterError
        If `simulate_ensemble` does not accept an option, or a name that varies.
    """
    nothing = {name: np.empty(0) for name in names}
    sample = simulate_ensemble(recipe.model, recipe.motion, **recipe.arguments(nothing))
    variables = []
    for name, array in sample.data_vars.items():
        own = {str(dim): size for dim, size in array.sizes.items() if dim != "run"}
        variables.append(Variable(str(name), array.dtype, tuple(own), tuple(own.values()), dict(array.attrs)))
    labels = {str(name): array.values.tolist() for name, array in sample.coords.items() if array.dims == (name,)}
    return Layout(tuple(variables), {name: values for name, values in labels.items() if name != "run"})


def dataset(
    design: Design, layout: Layout, arrays: Mapping[str, npt.NDArray[Any]], attributes: Mapping[str, Any]
) -> xr.Dataset:
    """Return `arrays`, each over all runs of the design, with their coordinates and attributes."""
    data = {
        variable.name: ((*design.dims, *variable.dims), arrays[variable.name], dict(variable.attributes))
        for variable in layout.variables
    }
    coordinates = {
        name: (design.coordinate_dims[name], values, attributes_of(name))
        for name, values in design.coordinates(whole(design)).items()
    }
    return xr.Dataset(data, coords={**coordinates, **layout.labels}, attrs=dict(attributes))


Arrays = dict[str, npt.NDArray[Any]]


@dataclass(frozen=True, slots=True)
class Task:
    """One block of runs with the values of the quantities that vary."""

    block: GridBlock
    values: Mapping[str, Floats]


@dataclass(frozen=True, slots=True)
class Computed:
    """The results of a task, flat over its runs; `interrupted` if Ctrl-C stopped it before all were computed."""

    arrays: Arrays
    interrupted: bool = False


def compute(
    recipe: Recipe, values: Mapping[str, Floats], threads: int | None, progress: Report | None = None
) -> Computed:
    """Compute the runs of `recipe` at these `values`."""
    arguments = recipe.arguments(values)
    try:
        result = simulate_ensemble(recipe.model, recipe.motion, **arguments, threads=threads, progress=progress)
    except Interrupted as stop:
        return Computed(_arrays(stop.partial), interrupted=True)
    return Computed(_arrays(result))


def _arrays(result: xr.Dataset) -> Arrays:
    return {str(name): np.asarray(array.values) for name, array in result.data_vars.items()}


METADATA = "zarr.json"
"""Name of the file with the metadata of an array or a store."""
OUTCOME = "outcome"
"""Name of the array that is written after the other data."""
SEAL = Variable("seal", np.dtype(np.uint64), (), (), {})
"""The array with the seal of each block, written last; it marks the block as finished or begun."""
CODECS: tuple[dict[str, Any], ...] = ({"name": "bytes", "configuration": {"endian": "little"}}, {"name": "crc32c"})
"""The codecs of a chunk, as Zarr names them; without compression all chunks of an array have one size."""
# Sizes of a checksum and of the smallest file on disk [bytes].
_CHECKSUM, _DISK_BLOCK = 4, 4096
# Maximum number of values in a chunk of an axis.
_AXIS_CHUNK = 2**17
# An entry of the index of a shard: place and size of a chunk [bytes]; or the entry for a chunk that is not written.
_ENTRY = struct.Struct("<QQ")
_ABSENT = b"\xff" * _ENTRY.size


class ChunkState(Enum):
    """State of the chunks of a block."""

    DONE = auto()
    BEGUN = auto()
    """Some of the runs are computed."""
    OPEN = auto()
    DAMAGED = auto()


@dataclass(frozen=True, slots=True)
class Shard:
    """An open file with the `count` chunks of one array, each of `size` bytes with its checksum, behind their index.

    It is a shard of Zarr that is written in place, because a disk takes many times longer to create a file. An entry
    is written after its chunk, and removed before its chunk is written again: a reader finds no part of a chunk.
    """

    file: IO[bytes]
    count: int
    size: int

    def entry(self, index: int) -> bytes:
        """Return the entry of a chunk."""
        return self._read(_ENTRY.size * index, _ENTRY.size)

    def holds(self, index: int) -> bool:
        """Return whether a chunk is written; raise ValueError if its entry is damaged."""
        entry = self.entry(index)
        if entry not in (_ABSENT, self._entry_of(index)):
            raise ValueError("a file of a store is damaged: its index is not as it was written")
        return entry != _ABSENT

    def content(self, index: int) -> bytes:
        """Return the bytes in the place of a chunk."""
        return self._read(self._place(index), self.size)

    def write(self, index: int, content: bytes) -> None:
        """Write a chunk that is not in the index."""
        self._write(self._place(index), content)
        self._write(_ENTRY.size * index, self._entry_of(index))

    def forget(self, index: int) -> None:
        """Remove a chunk from the index."""
        self._write(_ENTRY.size * index, _ABSENT)

    def _place(self, index: int) -> int:
        return _ENTRY.size * self.count + self.size * index

    def _entry_of(self, index: int) -> bytes:
        return _ENTRY.pack(self._place(index), self.size)

    def _read(self, place: int, size: int) -> bytes:
        self.file.seek(place)
        content = self.file.read(size)
        while len(content) < size and (more := self.file.read(size - len(content))):
            content += more
        return content

    def _write(self, place: int, content: bytes) -> None:
        self.file.seek(place)
        rest = memoryview(content)
        while rest:
            rest = rest[self.file.write(rest) :]


@dataclass(frozen=True, slots=True)
class StoredArray:
    """The array of a `variable` over `blocks` in the store at `path`: a folder with metadata and one shard."""

    path: Path
    variable: Variable
    blocks: Blocks

    @property
    def folder(self) -> Path:
        """Folder of the array."""
        return self.path / self.variable.name

    @property
    def shape(self) -> tuple[int, ...]:
        """Lengths of the dimensions."""
        return (*self.blocks.shape, *self.variable.shape)

    @property
    def chunk(self) -> tuple[int, ...]:
        """Lengths of a chunk."""
        return (*self.blocks.edges, *(max(1, length) for length in self.variable.shape))

    @property
    def chunk_size(self) -> int:
        """Size of a chunk with its checksum [bytes]."""
        return self.variable.bytes_of_a_run * math.prod(self.blocks.edges) + _CHECKSUM

    @property
    def file_size(self) -> int:
        """Size of the complete shard [bytes]."""
        return len(self.blocks) * (_ENTRY.size + self.chunk_size)

    @property
    def _file(self) -> Path:
        return self.folder / ".".join(("c", *("0" for _ in self.shape)))

    def create(self, dims: tuple[str, ...]) -> None:
        """Write the metadata, for `dims` as names of the dimensions, and the shard without chunks."""
        counts = (*(max(1, count) for count in self.blocks.counts), *(1 for _ in self.variable.shape))
        codecs = {"chunk_shape": self.chunk, "codecs": CODECS, "index_codecs": CODECS[:1], "index_location": "start"}
        grid = {"chunk_shape": [count * edge for count, edge in zip(counts, self.chunk, strict=True)]}
        attributes, fill = self.variable.attributes, self.variable.fill
        metadata = {
            "shape": self.shape,
            "data_type": self.variable.dtype.name,
            "chunk_grid": {"name": "regular", "configuration": grid},
            "chunk_key_encoding": {"name": "default", "configuration": {"separator": "."}},
            "fill_value": "NaN" if np.isnan(fill) else np.asarray(fill).item(),
            "codecs": [{"name": "sharding_indexed", "configuration": codecs}],
            "attributes": {n: v.tolist() if isinstance(v, np.ndarray) else v for n, v in attributes.items()},
            "dimension_names": dims,
            "zarr_format": 3,
            "node_type": "array",
            "storage_transformers": [],
        }
        self.folder.mkdir()
        (self.folder / METADATA).write_text(json.dumps(metadata, indent=2), "utf-8")
        self._file.write_bytes(_ABSENT * len(self.blocks))

    @contextmanager
    def shard(self, mode: str = "rb") -> Iterator[Shard]:
        """Open the shard; a lost file is an empty one."""
        with _opened(self._file, mode) as file:
            yield Shard(file, len(self.blocks), self.chunk_size)

    def encoded(self, block: GridBlock, values: npt.NDArray[Any]) -> bytes:
        """Return the chunk with these values of a block; the last one along a dimension is filled up, as Zarr does."""
        whole = self.variable.empty(self.blocks.edges)
        whole[_inner(block)] = np.asarray(values).reshape(*block.shape, *self.variable.shape)
        return encoded(whole)

    def decoded(self, chunk: bytes) -> npt.NDArray[Any]:
        """Return the values of a chunk; raise ValueError if it does not match its checksum."""
        checksum(chunk)
        values = np.frombuffer(chunk[:-_CHECKSUM], self.variable.dtype)
        return values.reshape(*self.blocks.edges, *self.variable.shape)

    def read(self, key: tuple[Any, ...]) -> npt.NDArray[Any]:
        """Return a part of the array, from the chunks that it touches; `key` selects along each dimension by itself."""
        places = [np.atleast_1d(np.arange(length)[part]) for length, part in zip(self.shape, key, strict=True)]
        owners = [place // edge for place, edge in zip(places, self.chunk, strict=True)]
        found = np.full([place.size for place in places], self.variable.fill, self.variable.dtype)
        with self.shard() as shard:
            for corner in product(*map(np.unique, owners)):
                index = int(np.ravel_multi_index(corner[: len(self.blocks.shape)], self.blocks.counts))
                if shard.holds(index):
                    inside = [np.flatnonzero(owner == one) for owner, one in zip(owners, corner, strict=True)]
                    parts = zip(places, inside, corner, self.chunk, strict=True)
                    source = [place[chosen] - one * edge for place, chosen, one, edge in parts]
                    found[np.ix_(*inside)] = self.decoded(shard.content(index))[np.ix_(*source)]
        return found[tuple(0 if isinstance(part, (int, np.integer)) else slice(None) for part in key)]


def axis(path: Path, name: str, length: int) -> StoredArray:
    """Return the array of an axis with `length` values in the store at `path`."""
    variable = Variable(name, np.dtype(float), (), (), attributes_of(name))
    return StoredArray(path, variable, Blocks.of((length,), _AXIS_CHUNK))


@dataclass(frozen=True, slots=True)
class Chunks:
    """The chunks of the results in the store at `path`: one in the shard of each array for each block.

    Parameters
    ----------
    path
        The store.
    blocks
        Blocks of its runs.
    variables
        The results, in the order of the sweep.
    """

    path: Path
    blocks: Blocks
    variables: tuple[Variable, ...]

    @property
    def arrays(self) -> dict[str, StoredArray]:
        """The arrays in the order of writing: data, outcomes, seals."""
        results = sorted(self.variables, key=lambda variable: variable.name == OUTCOME)
        arrays = [StoredArray(self.path, variable, self.blocks) for variable in results]
        seals = StoredArray(self.path, SEAL, Blocks((len(self.blocks),), (1,)))
        return {array.variable.name: array for array in (*arrays, seals)}

    def state(self, index: int) -> ChunkState:
        """Return the state of a block: DAMAGED if a chunk is missing or is not the chunk that was written there."""
        with self.shards() as shards:
            return _state(shards, index)

    def states(self) -> dict[int, ChunkState]:
        """Return the state of each block."""
        with self.shards() as shards:
            return {index: _state(shards, index) for index in range(len(self.blocks))}

    def write(self, block: GridBlock, arrays: Mapping[str, npt.NDArray[Any]], *, done: bool) -> None:
        """Write the results of a `block`, flat over its runs: data, then outcomes, then the seal.

        Raises
        ------
        OSError
            If a file cannot be written.
        """
        stored = self.arrays
        chunks = {one.name: stored[one.name].encoded(block, arrays[one.name]) for one in self.variables}
        checksums = {name: chunk[-_CHECKSUM:] for name, chunk in chunks.items()}
        chunks[SEAL.name] = _seal_of(block.index, checksums, done=done)
        with self.shards("r+b") as shards:
            _forget(shards, block.index)  # the runs that an interrupted task had stored
            for name, shard in shards.items():
                shard.write(block.index, chunks[name])

    def read(self, block: GridBlock) -> Arrays:
        """Return the results of a complete `block`, flat over its runs."""
        inner, stored = _inner(block), self.arrays
        with self.shards() as shards:
            wholes = [(one, stored[one.name].decoded(shards[one.name].content(block.index))) for one in self.variables]
        return {one.name: whole[inner].reshape(block.size, *one.shape).copy() for one, whole in wholes}

    def forget(self, index: int) -> None:
        """Remove the chunks of a block, in the reverse order of writing."""
        with self.shards("r+b") as shards:
            _forget(shards, index)

    @contextmanager
    def shards(self, mode: str = "rb") -> Iterator[dict[str, Shard]]:
        """Open the shards, by the name of the array in the order of writing; a lost file is an empty one."""
        with ExitStack() as stack:
            yield {name: stack.enter_context(array.shard(mode)) for name, array in self.arrays.items()}


def _opened(path: Path, mode: str) -> IO[bytes]:
    try:
        return path.open(mode, buffering=0)
    except OSError:
        if mode == "rb":
            return BytesIO()
    path.touch()
    return path.open(mode, buffering=0)


def _state(shards: dict[str, Shard], index: int) -> ChunkState:
    while True:
        marks = _marks(shards, index)
        found = _state_now(shards, index)
        # Another process may be writing this block.
        if found is not ChunkState.DAMAGED or _marks(shards, index) == marks:
            return found


def _marks(shards: Mapping[str, Shard], index: int) -> list[bytes]:
    """Return the bytes of a block that each of its writers changes."""
    return [shards[SEAL.name].content(index), *(shard.entry(index) for shard in shards.values())]


def _state_now(shards: Mapping[str, Shard], index: int) -> ChunkState:
    try:
        held = {name for name, shard in shards.items() if shard.holds(index)}
        if OUTCOME not in held and SEAL.name not in held:
            return ChunkState.OPEN  # whatever an interrupted writer has left
        checksums = {name: checksum(shards[name].content(index)) for name in shards if name != SEAL.name}
    except ValueError:
        return ChunkState.DAMAGED
    if not held.issuperset(checksums):
        return ChunkState.DAMAGED
    if SEAL.name not in held:
        return ChunkState.OPEN
    for state, done in ((ChunkState.DONE, True), (ChunkState.BEGUN, False)):
        if shards[SEAL.name].content(index) == _seal_of(index, checksums, done=done):
            return state
    return ChunkState.DAMAGED


def _forget(shards: dict[str, Shard], index: int) -> None:
    for shard in reversed(shards.values()):
        shard.forget(index)


def encoded(values: npt.NDArray[Any]) -> bytes:
    """Return a chunk as its file holds it."""
    data = values.tobytes()
    return data + _crc(data)


def checksum(chunk: bytes) -> bytes:
    """Return the checksum of a chunk; raise ValueError if the chunk does not match it."""
    if _crc(chunk[:-_CHECKSUM]) != chunk[-_CHECKSUM:]:
        raise ValueError("a chunk of a store is damaged: its checksum differs")
    return chunk[-_CHECKSUM:]


def _crc(data: bytes) -> bytes:
    return int(google_crc32c.value(data)).to_bytes(_CHECKSUM, "little")


def _seal_of(index: int, checksums: Mapping[str, bytes], *, done: bool) -> bytes:
    """Return the seal of the block at `index` with chunks of these checksums, by the name of the array."""
    digest = hashlib.sha256(f"{index} {done}".encode())
    for name in sorted(checksums):
        digest.update(f" {name} ".encode() + checksums[name])
    return encoded(np.frombuffer(digest.digest()[: SEAL.dtype.itemsize], SEAL.dtype))


def _inner(block: GridBlock) -> tuple[slice, ...]:
    return tuple(slice(length) for length in block.shape)


def bytes_on_disk(layout: Layout, design: Design, blocks: Blocks) -> int:
    """Return the size of results, coordinates and metadata on disk [bytes], in whole disk blocks."""
    lengths = {name: design.shape[design.dims.index(dim)] for name, dim in design.coordinate_dims.items()}
    axes = [axis(Path(), name, length) for name, length in lengths.items()]
    arrays = (*axes, *Chunks(Path(), blocks, layout.variables).arrays.values())
    return _DISK_BLOCK * sum(1 - (-size // _DISK_BLOCK) for size in (0, *(array.file_size for array in arrays)))


def bytes_of_block(layout: Layout, blocks: Blocks) -> int:
    """Return the size of the results of one block on disk [bytes]."""
    return sum(array.chunk_size for array in Chunks(Path(), blocks, layout.variables).arrays.values())
