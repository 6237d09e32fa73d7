"""Blocks of the runs of a sweep: each is one task and one chunk of the store."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

DISK_BLOCK = 4096
"""Size of the smallest file on disk [bytes]."""

# Target number of blocks of a sweep; minimum and maximum number of runs in a block.
_USUAL_COUNT, _SMALLEST, _LARGEST = 64, 1024, 16384


@dataclass(frozen=True, slots=True)
class Block:
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

    def __getitem__(self, index: int) -> Block:
        if not 0 <= index < len(self):
            raise IndexError(index)
        rest, slices = index, []
        for count, length, edge in zip(reversed(self.counts), reversed(self.shape), reversed(self.edges), strict=True):
            rest, place = divmod(rest, count)
            slices.append(slice(place * edge, min((place + 1) * edge, length)))
        return Block(index, tuple(reversed(slices)))

    def __iter__(self) -> Iterator[Block]:
        return (self[index] for index in range(len(self)))


def usual_size(runs: int) -> int:
    """Return the default maximum number of runs in a block of a sweep of `runs` runs."""
    return min(max(_SMALLEST, -(-runs // _USUAL_COUNT)), _LARGEST)
