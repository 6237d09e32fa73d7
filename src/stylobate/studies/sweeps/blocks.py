"""Blocks: the pieces into which the runs of a sweep are cut, one task and one chunk of the store each."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

DISK_BLOCK = 4096
"""What the smallest file takes on disk [bytes]."""

# A sweep is cut into about so many blocks, each no smaller and no larger than these numbers of runs.
_USUAL_COUNT, _SMALLEST, _LARGEST = 64, 1024, 16384


@dataclass(frozen=True, slots=True)
class Block:
    """A rectangular piece of the array of runs; `index` is its place among all blocks."""

    index: int
    slices: tuple[slice, ...]

    @property
    def shape(self) -> tuple[int, ...]:
        """Its length along each dimension."""
        return tuple(part.stop - part.start for part in self.slices)

    @property
    def size(self) -> int:
        """The number of runs in it."""
        return math.prod(self.shape)


@dataclass(frozen=True, slots=True)
class Blocks:
    """All the blocks of an array of runs of this `shape`; each spans at most `edges` runs along each dimension."""

    shape: tuple[int, ...]
    edges: tuple[int, ...]

    @classmethod
    def of(cls, shape: tuple[int, ...], runs: int | None = None) -> "Blocks":
        """Return blocks of at most `runs` runs, the last dimensions whole as far as that goes."""
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
    """Return the largest number of runs in a block, for a sweep of so many `runs`, where nobody asks for another."""
    return min(max(_SMALLEST, -(-runs // _USUAL_COUNT)), _LARGEST)
