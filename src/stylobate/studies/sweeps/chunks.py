"""Chunk files of a store: their integrity, and the resulting state of the blocks of a sweep."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum, auto
from pathlib import Path

import google_crc32c
import numpy as np

from stylobate.studies.sweeps.blocks import Blocks

METADATA = "zarr.json"
"""Name of the file with the metadata of an array or a store."""
MARK, OUTCOME = "done", "outcome"
"""Names of the arrays that are written last: the outcomes after the other data, then the mark of a block."""
# Zarr's codec `crc32c` appends this number of bytes to a chunk.
_CHECKSUM = 4


class State(Enum):
    """State of the chunk files of a block."""

    DONE = auto()
    OPEN = auto()
    DAMAGED = auto()


@dataclass(frozen=True, slots=True)
class Chunks:
    """The chunk files of the store at `path`.

    Parameters
    ----------
    path
        The store.
    blocks
        Blocks of its runs.
    variables
        Number of dimensions of each result besides the dimensions of the runs.
    """

    path: Path
    blocks: Blocks
    variables: Mapping[str, int]

    def state(self, index: int) -> State:
        """Return the state of a block: DAMAGED if a file has changed since it was written, or is missing."""
        # Checked in the reverse order of writing: another process may be writing this block.
        present = {name: file for name, file in reversed(self.files(index).items()) if file.exists()}
        lost = not self.variables.keys() <= present.keys()
        if (lost and (MARK in present or OUTCOME in present)) or not all(map(is_whole, present.values())):
            return State.DAMAGED
        return State.DONE if MARK in present else State.OPEN

    def states(self) -> dict[int, State]:
        """Return the state of each block."""
        return {index: self.state(index) for index in range(len(self.blocks))}

    def forget(self, index: int) -> None:
        """Remove the files of a block, in the reverse order of writing."""
        for file in reversed(self.files(index).values()):
            file.unlink(missing_ok=True)

    def files(self, index: int) -> dict[str, Path]:
        """Return the files of a block by the name of the array, in the order in which they are written."""
        place = [int(number) for number in np.unravel_index(index, self.blocks.counts)]
        names = sorted(self.variables, key=lambda name: name == OUTCOME)
        files = {name: chunk_file(self.path / name, (*place, *(0,) * self.variables[name])) for name in names}
        return {**files, MARK: chunk_file(self.path / MARK, (index,))}


def chunk_file(array: Path, place: tuple[int, ...]) -> Path:
    """Return the file of the chunk of an `array` at this index."""
    return array.joinpath("c", *map(str, place))


def chunk_counts(array: Path) -> tuple[int, ...]:
    """Return the number of chunks of an `array` along each dimension, from its metadata."""
    metadata = json.loads((array / METADATA).read_bytes())
    edges = metadata["chunk_grid"]["configuration"]["chunk_shape"]
    return tuple(-(-length // edge) for length, edge in zip(metadata["shape"], edges, strict=True))


def files_along(array: Path) -> list[Path]:
    """Return the files of all chunks of an `array` of one dimension."""
    (count,) = chunk_counts(array)
    return [chunk_file(array, (index,)) for index in range(count)]


def is_whole(file: Path) -> bool:
    """Return whether a chunk file can be read and matches its checksum."""
    try:
        content = file.read_bytes()
    except OSError:
        return False
    data, checksum = content[:-_CHECKSUM], content[-_CHECKSUM:]
    return len(checksum) == _CHECKSUM and google_crc32c.value(data) == int.from_bytes(checksum, "little")
