"""Computation of a sweep in chunks: recipe of a run, blocks of runs, layout of the results."""

import hashlib
import math
import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from enum import Enum, auto
from pathlib import Path
from typing import Any

import google_crc32c
import lazy_loader
import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate.base_motions import BaseMotion
from stylobate.base_motions.combined import members_of
from stylobate.base_motions.declared import stated_numbers, with_numbers
from stylobate.engine import simulate_ensemble
from stylobate.errors import Interrupted
from stylobate.files import remove_left_behind, replace_in_store
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


DISK_BLOCK = 4096
"""Size of the smallest file on disk [bytes]."""

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


# Size of a value of a coordinate [bytes].
_FLOAT = 8


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


def bytes_on_disk(layout: Layout, design: Design, blocks: Blocks) -> int:
    """Return the maximum size of results and coordinates on disk [bytes]: no compression, whole disk blocks."""
    if not len(blocks):
        return DISK_BLOCK
    places = [design.dims.index(dim) for dim in design.coordinate_dims.values()]
    coordinates = sum(blocks.counts[place] * _on_disk(_FLOAT * blocks.edges[place]) for place in places)
    return len(blocks) * bytes_of_block(layout, blocks[0]) + coordinates


def bytes_of_block(layout: Layout, block: GridBlock) -> int:
    """Return the maximum size of one `block` on disk, with its mark [bytes]."""
    sizes = (variable.bytes_of_a_run * block.size for variable in layout.variables)
    return DISK_BLOCK + sum(_on_disk(size) for size in sizes)


def _on_disk(size: int) -> int:
    """Return the maximum size of a chunk on disk; its compressed form can be larger by 1/256 and 72 bytes."""
    return -(-(size + size // 256 + 72) // DISK_BLOCK) * DISK_BLOCK


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


numcodecs: Any = lazy_loader.load("numcodecs")
"""Loaded when the first store is opened."""

METADATA = "zarr.json"
"""Name of the file with the metadata of an array or a store."""
OUTCOME = "outcome"
"""Name of the array that is written after the other data."""
SEAL = Variable("seal", np.dtype(np.uint64), (), (), {})
"""The array with the seal of each block, written last; its lowest bit is 1 if all runs of the block are computed."""
CODECS: tuple[dict[str, Any], ...] = (
    {"name": "zstd", "configuration": {"level": 0, "checksum": False}},
    {"name": "crc32c"},
)
"""The codecs of a chunk, as Zarr names them."""
# Size of a checksum [bytes].
_CHECKSUM = 4
# A number that is no seal.
_NO_SEAL = -1


class ChunkState(Enum):
    """State of the chunk files of a block."""

    DONE = auto()
    BEGUN = auto()
    """Some of the runs are computed."""
    OPEN = auto()
    DAMAGED = auto()


@dataclass(frozen=True, slots=True)
class Chunks:
    """The chunk files of the results in the store at `path`.

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

    def state(self, index: int) -> ChunkState:
        """Return the state of a block: DAMAGED if a file is missing or is not the file that was written there."""
        while True:
            seal = self._seal(index)
            found = self._state(index, seal)
            # Another process may be writing this block.
            if found is not ChunkState.DAMAGED or self._seal(index) == seal:
                return found

    def _state(self, index: int, seal: int | None) -> ChunkState:
        if seal is None and not self._file(self._outcome, index).exists():
            return ChunkState.OPEN  # whatever an interrupted writer has left
        checksums = {name: checksum(file) for name, file in self.files(index).items() if file.exists()}
        if None in checksums.values() or (OUTCOME in checksums and len(checksums) < len(self.variables)):
            return ChunkState.DAMAGED
        if seal is None:
            return ChunkState.OPEN
        done = bool(seal & 1)
        if len(checksums) < len(self.variables) or seal != _seal_of(index, checksums, done=done):
            return ChunkState.DAMAGED
        return ChunkState.DONE if done else ChunkState.BEGUN

    def states(self) -> dict[int, ChunkState]:
        """Return the state of each block."""
        return {index: self.state(index) for index in range(len(self.blocks))}

    def write(self, block: GridBlock, arrays: Mapping[str, npt.NDArray[Any]], *, done: bool) -> None:
        """Write the results of a `block`, flat over its runs: data, then outcomes, then the seal.

        Raises
        ------
        FileError
            If a file cannot be written.
        """
        files = self.files(block.index)
        self._seal_file(block.index).unlink(missing_ok=True)  # of the runs that an interrupted task had stored
        checksums = {}
        for variable in sorted(self.variables, key=lambda variable: variable.name == OUTCOME):
            content = self._encoded(block, variable, arrays[variable.name])
            checksums[variable.name] = content[-_CHECKSUM:]
            replace_in_store(str(files[variable.name]), content)
        seal = np.array([_seal_of(block.index, checksums, done=done)], SEAL.dtype)
        replace_in_store(str(self._seal_file(block.index)), encoded(seal))

    def read(self, block: GridBlock) -> Arrays:
        """Return the results of a complete `block`, flat over its runs."""
        files = self.files(block.index)
        return {one.name: self._decoded(block, one, files[one.name].read_bytes()) for one in self.variables}

    def forget(self, index: int) -> None:
        """Remove the files of a block, in the reverse order of writing."""
        for file in (self._seal_file(index), *self.files(index).values()):
            file.unlink(missing_ok=True)

    def files(self, index: int) -> dict[str, Path]:
        """Return the files of the results of a block by the name of the array, the outcomes first."""
        variables = sorted(self.variables, key=lambda variable: variable.name != OUTCOME)
        return {one.name: self._file(one, index) for one in variables}

    def remove_left_behind(self) -> None:
        """Remove the parts of files that killed writers on this machine have left."""
        for folder, _, _ in os.walk(self.path):
            remove_left_behind(folder)

    @property
    def _outcome(self) -> Variable:
        return next(one for one in self.variables if one.name == OUTCOME)

    def _file(self, variable: Variable, index: int) -> Path:
        place = map(int, np.unravel_index(index, self.blocks.counts))
        return chunk_file(self.path / variable.name, (*place, *(0 for _ in variable.shape)))

    def _seal_file(self, index: int) -> Path:
        return chunk_file(self.path / SEAL.name, (index,))

    def _seal(self, index: int) -> int | None:
        """Return the seal of a block; None if it has none, −1 if its file is damaged."""
        file = self._seal_file(index)
        if not file.exists():
            return None
        try:
            (seal,) = decoded(file.read_bytes(), SEAL.dtype)
        except FileNotFoundError:
            return None
        except (OSError, ValueError):
            return _NO_SEAL
        return int(seal)

    def _encoded(self, block: GridBlock, variable: Variable, values: npt.NDArray[Any]) -> bytes:
        """Return the chunk of a variable; the last chunk along a dimension is filled up, as Zarr does."""
        whole = variable.empty(self.blocks.edges)
        whole[_inner(block)] = np.asarray(values).reshape(*block.shape, *variable.shape)
        return encoded(whole)

    def _decoded(self, block: GridBlock, variable: Variable, content: bytes) -> npt.NDArray[Any]:
        whole = decoded(content, variable.dtype).reshape(*self.blocks.edges, *variable.shape)
        return whole[_inner(block)].reshape(block.size, *variable.shape)


def chunk_file(array: Path, place: tuple[int, ...]) -> Path:
    """Return the file of the chunk of an `array` at this index."""
    return array.joinpath("c", *map(str, place))


def checksum(file: Path) -> bytes | None:
    """Return the checksum of a chunk file; None if the file cannot be read or does not match its checksum."""
    try:
        return _checked(file.read_bytes())[1]
    except (OSError, ValueError):
        return None


def encoded(values: npt.NDArray[Any]) -> bytes:
    """Return a chunk as its file holds it."""
    data = bytes(numcodecs.Zstd(level=0, checksum=False).encode(np.ascontiguousarray(values)))
    return data + _crc(data)


def decoded(content: bytes, dtype: np.dtype[Any]) -> npt.NDArray[Any]:
    """Return the values in the file of a chunk, flat.

    Raises
    ------
    ValueError
        If the file does not match its checksum, or holds no values of this type.
    """
    return np.frombuffer(numcodecs.Zstd().decode(_checked(content)[0]), dtype).copy()


def _checked(content: bytes) -> tuple[bytes, bytes]:
    """Return the data and the checksum of a chunk file, or raise ValueError if they do not match."""
    data, end = content[:-_CHECKSUM], content[-_CHECKSUM:]
    if _crc(data) != end:
        raise ValueError("the checksum differs")
    return data, end


def _crc(data: bytes) -> bytes:
    return int(google_crc32c.value(data)).to_bytes(_CHECKSUM, "little")


def _seal_of(index: int, checksums: Mapping[str, bytes | None], *, done: bool) -> int:
    """Return the seal of the block at `index` with files of these checksums, by the name of the array."""
    digest = hashlib.sha256(f"{index}".encode())
    for name in sorted(checksums):
        digest.update(f" {name} ".encode() + (checksums[name] or b""))
    return int.from_bytes(digest.digest()[:8], "little") & ~1 | done


def _inner(block: GridBlock) -> tuple[slice, ...]:
    return tuple(slice(length) for length in block.shape)
