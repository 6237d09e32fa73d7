"""Chunk files of a store: which of them are whole, and what that makes of the blocks of a sweep."""

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
"""Names of the arrays that are written last: the mark of a block after its outcomes, these after the other data."""
# The codec `crc32c` of Zarr ends a chunk with so many bytes.
_CHECKSUM = 4


class State(Enum):
    """What the chunk files of a block hold."""

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
        Into which its runs are cut.
    variables
        For each result the number of its dimensions after those of the runs.
    """

    path: Path
    blocks: Blocks
    variables: Mapping[str, int]

    def state(self, index: int) -> State:
        """Return the state of a block: DAMAGED if a file is not as it was written, or one is lost."""
        # Looked for in the reverse of the order of writing: another process may be writing this block.
        present = {name: file for name, file in reversed(self.files(index).items()) if file.exists()}
        lost = not self.variables.keys() <= present.keys()
        if (lost and (MARK in present or OUTCOME in present)) or not all(map(is_whole, present.values())):
            return State.DAMAGED
        return State.DONE if MARK in present else State.OPEN

    def states(self) -> dict[int, State]:
        """Return the state of each block."""
        return {index: self.state(index) for index in range(len(self.blocks))}

    def forget(self, index: int) -> None:
        """Remove the files of a block, those first that say that others are there."""
        for file in reversed(self.files(index).values()):
            file.unlink(missing_ok=True)

    def files(self, index: int) -> dict[str, Path]:
        """Return the files of a block by the name of the array, in the order in which they are written."""
        place = [int(number) for number in np.unravel_index(index, self.blocks.counts)]
        names = sorted(self.variables, key=lambda name: name == OUTCOME)
        files = {name: chunk_file(self.path / name, (*place, *(0,) * self.variables[name])) for name in names}
        return {**files, MARK: chunk_file(self.path / MARK, (index,))}


def chunk_file(array: Path, place: tuple[int, ...]) -> Path:
    """Return the file of the chunk of an `array` at this place."""
    return array.joinpath("c", *map(str, place))


def chunk_counts(array: Path) -> tuple[int, ...]:
    """Return into how many chunks an `array` is cut along each dimension, by its metadata."""
    metadata = json.loads((array / METADATA).read_bytes())
    edges = metadata["chunk_grid"]["configuration"]["chunk_shape"]
    return tuple(-(-length // edge) for length, edge in zip(metadata["shape"], edges, strict=True))


def files_along(array: Path) -> list[Path]:
    """Return the files of all chunks of an `array` of one dimension."""
    (count,) = chunk_counts(array)
    return [chunk_file(array, (index,)) for index in range(count)]


def is_whole(file: Path) -> bool:
    """Return whether a chunk file can be read and has the checksum that was written with it."""
    try:
        content = file.read_bytes()
    except OSError:
        return False
    data, checksum = content[:-_CHECKSUM], content[-_CHECKSUM:]
    return len(checksum) == _CHECKSUM and google_crc32c.value(data) == int.from_bytes(checksum, "little")
