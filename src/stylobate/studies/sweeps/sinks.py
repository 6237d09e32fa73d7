"""Sinks for the results of a sweep: arrays in memory, or a store on disk."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace
from typing import Protocol

import numpy as np
import xarray as xr

from stylobate.engine.cost import require_memory
from stylobate.errors import FileError
from stylobate.progress import Report
from stylobate.studies.sweeps.blocks import Block, Blocks
from stylobate.studies.sweeps.chunks import OUTCOME, Chunks, State
from stylobate.studies.sweeps.computing import Arrays, Computed, Task, compute
from stylobate.studies.sweeps.executors import Work
from stylobate.studies.sweeps.layout import Layout, dataset
from stylobate.studies.sweeps.recipe import Recipe
from stylobate.studies.sweeps.store import attributes_of_result, open_sweep
from stylobate.studies.sweeps.sweep import Sweep


class Sink(Protocol):
    """Destination of the results of a sweep."""

    @property
    def todo(self) -> Iterable[Block]:
        """The blocks that remain to be computed."""

    @property
    def runs_done(self) -> int:
        """Number of runs that are already computed at the beginning."""

    @property
    def work(self) -> Work:
        """Function that an executor calls with each task."""

    def accept(self, task: Task, result: Computed) -> None:
        """Take the result of a task."""

    def dataset(self) -> xr.Dataset:
        """Return all results so far."""


@dataclass(frozen=True, slots=True)
class InMemory:
    """Results as arrays in this process."""

    sweep: Sweep
    layout: Layout
    blocks: Blocks
    arrays: Arrays = field(init=False)

    def __post_init__(self) -> None:
        size = sum(variable.bytes_of_a_run for variable in self.layout.variables) * self.sweep.runs
        require_memory(size, self.sweep.runs, "Take fewer values, or keep the results in a store (NAME.zarr)")
        empty = {variable.name: variable.empty(self.sweep.shape) for variable in self.layout.variables}
        object.__setattr__(self, "arrays", empty)

    @property
    def todo(self) -> Iterable[Block]:
        """All blocks."""
        return self.blocks

    @property
    def runs_done(self) -> int:
        """None."""
        return 0

    @property
    def work(self) -> Work:
        """Function that computes and returns the results."""
        return _Compute(self.sweep.recipe)

    def accept(self, task: Task, result: Computed) -> None:
        """Copy the results into the arrays."""
        block = task.block
        for name, values in result.arrays.items():
            self.arrays[name][block.slices] = values.reshape(*block.shape, *values.shape[1:])

    def dataset(self) -> xr.Dataset:
        """Return the arrays with their coordinates."""
        return dataset(self.sweep.design, self.layout, self.arrays, attributes_of_result(self.sweep))


@dataclass(frozen=True, slots=True)
class OnDisk:
    """Results in a store, written by the workers that compute them."""

    sweep: Sweep
    chunks: Chunks
    done: frozenset[int]

    @property
    def todo(self) -> Iterator[Block]:
        """The blocks that are not done."""
        return (block for block in self.chunks.blocks if block.index not in self.done)

    @property
    def runs_done(self) -> int:
        """Number of runs in blocks that are done."""
        return sum(self.chunks.blocks[index].size for index in self.done)

    @property
    def work(self) -> Work:
        """Function that computes and stores the missing runs of a block."""
        return _ComputeAndStore(self.sweep.recipe, replace(self.chunks, path=self.chunks.path.absolute()))

    def accept(self, task: Task, result: Computed) -> None:
        """Do nothing: the worker has stored the result."""

    def dataset(self) -> xr.Dataset:
        """Return the contents of the store."""
        return open_sweep(self.chunks.path)


@dataclass(frozen=True, slots=True)
class _Compute:
    recipe: Recipe

    def __call__(self, task: Task, *, threads: int | None, progress: Report | None) -> Computed:
        return compute(self.recipe, task.values, threads, progress)


@dataclass(frozen=True, slots=True)
class _ComputeAndStore:
    recipe: Recipe
    chunks: Chunks

    def __call__(self, task: Task, *, threads: int | None, progress: Report | None) -> Computed:
        try:
            return self._stored(task, threads, progress)
        except (OSError, FileError) as error:
            reason = getattr(error, "strerror", None) or error
            message = f"cannot write {self.chunks.path}: {reason}. Continue it with resume=True"
            raise FileError(message) from error

    def _stored(self, task: Task, threads: int | None, progress: Report | None) -> Computed:
        state = self.chunks.state(task.block.index)
        if state is State.DONE:  # by another process
            return Computed({})
        # Without a seal the files are those of a writer that was killed.
        arrays = self.chunks.read(task.block) if state is State.BEGUN else None
        missing = np.ones(task.block.size, bool) if arrays is None else arrays[OUTCOME] < 0
        values = {name: array[missing] for name, array in task.values.items()}
        result = compute(self.recipe, values, threads, progress)
        if arrays is None:
            arrays = result.arrays
        else:
            for name, computed in result.arrays.items():
                arrays[name][missing] = computed
        try:
            self.chunks.write(task.block, arrays, done=not result.interrupted)
        except KeyboardInterrupt:  # save the computed runs first
            self.chunks.write(task.block, arrays, done=not result.interrupted)
            raise
        return Computed({}, result.interrupted)


def tasks_of(sweep: Sweep, blocks: Iterable[Block]) -> Iterator[Task]:
    """Yield a task for each of `blocks`, on demand."""
    return (Task(block, {n: np.asarray(v) for n, v in sweep.design.values(block.slices).items()}) for block in blocks)
