"""Progressive executor for maps: every eighth run along each axis first, then the runs between them."""

import time
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from stylobate.progress import Report
from stylobate.studies.sweeps.computing import Arrays, Computed, Task
from stylobate.studies.sweeps.executors import Work

Cells = npt.NDArray[np.int64]

_STRIDES = (8, 4, 2, 1)
_FIRST_PIECE, _LARGEST_PIECE = 32, 4096
_SHOWN_EVERY = 0.4
"""Time between updates [s]; the pieces grow until they take about this long."""


@dataclass(frozen=True, slots=True)
class Refining:
    """Executor with threads of this process that compute a plane of runs from coarse to fine.

    Parameters
    ----------
    show
        Called with the stride, the indices of runs in the plane, shape (n, 2), and their outcomes, shape (n,).
    threads
        Number of threads; None for all cores.
    shape
        Shape of the plane if the runs form one row, with the second axis varying fastest; None if they form a grid.
    """

    show: Callable[[int, Cells, Cells], None]
    threads: int | None = None
    shape: tuple[int, ...] | None = None

    def results(
        self, work: Work, tasks: Iterable[Task], progress: Report | None = None
    ) -> Generator[tuple[Task, Computed], None, None]:
        """Yield each task with its result when all are computed."""
        asked = list(tasks)
        places = np.concatenate([_places(task) for task in asked])
        if self.shape is not None:
            places = np.stack(np.unravel_index(places[:, 0], self.shape), axis=-1)
        values = {name: np.concatenate([task.values[name] for task in asked]) for name in asked[0].values}
        found: Arrays = {}
        done = 0
        for stride, chosen in _pieces(places):
            piece = Task(asked[0].block, {name: every[chosen] for name, every in values.items()})
            result = work(piece, threads=self.threads, progress=None)
            _put(found, chosen, result.arrays, len(places))
            done += len(chosen)
            self.show(stride, places[chosen], result.arrays["outcome"])
            if progress is not None:
                progress(done, len(places))
        ends = np.cumsum([task.block.size for task in asked])
        for task, end in zip(asked, ends, strict=True):
            own = slice(end - task.block.size, end)
            yield task, Computed({name: array[own] for name, array in found.items()})


def _places(task: Task) -> Cells:
    """Return the indices in the plane of each run of `task`, shape (n, 2)."""
    across = np.meshgrid(*(np.arange(part.start, part.stop) for part in task.block.slices), indexing="ij")
    return np.stack([axis.ravel() for axis in across], axis=-1)


def _pieces(places: Cells) -> Iterator[tuple[int, Cells]]:
    """Yield each stride with some of the runs that it adds; fast pieces are followed by larger ones."""
    seen = np.zeros(len(places), dtype=bool)
    size = _FIRST_PIECE
    for stride in _STRIDES:
        new = np.flatnonzero(~seen & (places % stride == 0).all(axis=1))
        seen[new] = True
        while len(new):
            begun = time.monotonic()
            yield stride, new[:size]
            new = new[size:]
            if time.monotonic() - begun < 0.5 * _SHOWN_EVERY:
                size = min(2 * size, _LARGEST_PIECE)


def _put(found: Arrays, chosen: Cells, arrays: Mapping[str, npt.NDArray[np.generic]], runs: int) -> None:
    for name, values in arrays.items():
        if name not in found:
            found[name] = np.zeros((runs, *values.shape[1:]), dtype=values.dtype)
        found[name][chosen] = values
