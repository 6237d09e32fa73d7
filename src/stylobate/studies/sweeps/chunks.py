"""Chunk files of a store: their bytes, and the seal that binds the files of a block to their arrays and places.

The files are those that Zarr would write: a chunk is compressed by Zstandard and followed by its CRC-32C. A checksum
detects damage within a file, not an exchange of files. Each block therefore has a seal, a digest of the checksums of
its files with the names of their arrays and with the index of the block.
"""

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum, auto
from pathlib import Path
from typing import Any

import google_crc32c
import lazy_loader
import numpy as np
import numpy.typing as npt

from stylobate.files import written_aside
from stylobate.studies.sweeps.blocks import Block, Blocks
from stylobate.studies.sweeps.computing import Arrays
from stylobate.studies.sweeps.layout import Variable

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


class State(Enum):
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

    def state(self, index: int) -> State:
        """Return the state of a block: DAMAGED if a file is missing or is not the file that was written there."""
        while True:
            seal = self._seal(index)
            found = self._state(index, seal)
            # Another process may be writing this block.
            if found is not State.DAMAGED or self._seal(index) == seal:
                return found

    def _state(self, index: int, seal: int | None) -> State:
        checksums = {name: checksum(file) for name, file in self.files(index).items() if file.exists()}
        if None in checksums.values() or (OUTCOME in checksums and len(checksums) < len(self.variables)):
            return State.DAMAGED
        if seal is None:
            return State.OPEN
        done = bool(seal & 1)
        if len(checksums) < len(self.variables) or seal != _seal_of(index, checksums, done=done):
            return State.DAMAGED
        return State.DONE if done else State.BEGUN

    def states(self) -> dict[int, State]:
        """Return the state of each block."""
        return {index: self.state(index) for index in range(len(self.blocks))}

    def write(self, block: Block, arrays: Mapping[str, npt.NDArray[Any]], *, done: bool) -> None:
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
            _write(files[variable.name], content)
        seal = np.array([_seal_of(block.index, checksums, done=done)], SEAL.dtype)
        _write(self._seal_file(block.index), encoded(seal))

    def read(self, block: Block) -> Arrays:
        """Return the results of a complete `block`, flat over its runs."""
        files = self.files(block.index)
        return {one.name: self._decoded(block, one, files[one.name].read_bytes()) for one in self.variables}

    def forget(self, index: int) -> None:
        """Remove the files of a block, in the reverse order of writing."""
        for file in (self._seal_file(index), *self.files(index).values()):
            file.unlink(missing_ok=True)

    def files(self, index: int) -> dict[str, Path]:
        """Return the files of the results of a block by the name of the array, the outcomes first."""
        place = [int(number) for number in np.unravel_index(index, self.blocks.counts)]
        variables = sorted(self.variables, key=lambda variable: variable.name != OUTCOME)
        return {one.name: chunk_file(self.path / one.name, (*place, *(0 for _ in one.shape))) for one in variables}

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

    def _encoded(self, block: Block, variable: Variable, values: npt.NDArray[Any]) -> bytes:
        """Return the chunk of a variable; the last chunk along a dimension is filled up, as Zarr does."""
        whole = variable.empty(self.blocks.edges)
        whole[_inner(block)] = np.asarray(values).reshape(*block.shape, *variable.shape)
        return encoded(whole)

    def _decoded(self, block: Block, variable: Variable, content: bytes) -> npt.NDArray[Any]:
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
        message = "the checksum differs"
        raise ValueError(message)
    return data, end


def _crc(data: bytes) -> bytes:
    return int(google_crc32c.value(data)).to_bytes(_CHECKSUM, "little")


def _seal_of(index: int, checksums: Mapping[str, bytes | None], *, done: bool) -> int:
    """Return the seal of the block at `index` with files of these checksums, by the name of the array."""
    digest = hashlib.sha256(f"{index}".encode())
    for name in sorted(checksums):
        digest.update(f" {name} ".encode() + (checksums[name] or b""))
    return int.from_bytes(digest.digest()[:8], "little") & ~1 | done


def _inner(block: Block) -> tuple[slice, ...]:
    return tuple(slice(length) for length in block.shape)


def _write(file: Path, content: bytes) -> None:
    file.parent.mkdir(parents=True, exist_ok=True)
    with written_aside(file) as beside:
        beside.write_bytes(content)
