"""`run_sweep`: compute a sweep, or its missing runs, into arrays in memory or a store; and label the runs."""

from collections.abc import Callable, Iterable, Iterator
from contextlib import closing
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Protocol

import numpy as np
import xarray as xr

from stylobate.engine.cost import require_memory
from stylobate.errors import MOST_RUNS, FileError, Interrupted, ParameterError, require_whole
from stylobate.progress import Progress, Report, report_of, shows_progress
from stylobate.studies.sweeps.chunks import (
    OUTCOME,
    Arrays,
    Blocks,
    Chunks,
    ChunkState,
    Computed,
    GridBlock,
    Layout,
    Recipe,
    Task,
    compute,
    dataset,
)
from stylobate.studies.sweeps.executors import Executor, Threads, Work
from stylobate.studies.sweeps.store import attributes_of_result, continue_store, create_store, open_sweep
from stylobate.studies.sweeps.sweep import Sweep


class Sink(Protocol):
    """Destination of the results of a sweep."""

    @property
    def todo(self) -> Iterable[GridBlock]:
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
    def todo(self) -> Iterable[GridBlock]:
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
    def todo(self) -> Iterator[GridBlock]:
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
            raise FileError(f"cannot write {self.chunks.path}: {reason}. Continue it with resume=True") from error

    def _stored(self, task: Task, threads: int | None, progress: Report | None) -> Computed:
        state = self.chunks.state(task.block.index)
        if state is ChunkState.DONE:  # by another process
            return Computed({})
        # Without a seal the files are those of a writer that was killed.
        arrays = self.chunks.read(task.block) if state is ChunkState.BEGUN else None
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


def tasks_of(sweep: Sweep, blocks: Iterable[GridBlock]) -> Iterator[Task]:
    """Yield a task for each of `blocks`, on demand."""
    return (Task(block, {n: np.asarray(v) for n, v in sweep.design.values(block.slices).items()}) for block in blocks)


@shows_progress("runs")
def run_sweep(
    sweep: Sweep,
    *,
    store: str | Path | None = None,
    executor: Executor | None = None,
    resume: bool = False,
    chunk_size: int | None = None,
    progress: Progress = None,
) -> xr.Dataset:
    """Compute all runs of `sweep`, chunk by chunk.

    Every run is the same bit for bit on one machine, for all chunk sizes and executors.

    Parameters
    ----------
    sweep
        The runs to compute.
    store
        Folder of a new Zarr store, such as "map.zarr"; None keeps the results in memory.
    executor
        `Threads()`, the default, or `Dask(…)`.
    resume
        Continue the store if it exists: only missing runs are computed.
    chunk_size
        Maximum number of runs in a chunk; by default about a 64th of the sweep, between 1024 and 16384.
    progress
        A function that is called with the number of runs done and of all runs, or False. By default a bar appears after
        two seconds if stderr is a terminal, or in a notebook.

    Returns
    -------
    xarray.Dataset
        The variables of `simulate_ensemble`, over the dimensions of the sweep. From a store they are read when used.

    Raises
    ------
    FileError
        If the store exists and `resume` is not set, belongs to another sweep or version, or does not fit on the disk.
    ParameterError
        If an argument is out of range.
    Interrupted
        On Ctrl-C; `partial` and the store hold the runs computed so far.

    Examples
    --------
    >>> import stylobate as sb
    >>> from stylobate.studies.sweeps import Sweep, run_sweep
    >>> model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
    >>> motion = sb.Harmonic.circular(acceleration=0.15, angular_frequency=0.5)
    >>> sweep = Sweep.grid(model, motion, over={"acceleration": [0.05, 0.2]}, duration=20.0)
    >>> run_sweep(sweep)["outcome"].values
    array([0, 4], dtype=int8)
    """
    if not isinstance(sweep, Sweep):
        raise ParameterError(f"sweep must be a Sweep, such as Sweep.grid(...), got {sweep!r}")
    if executor is not None and not hasattr(executor, "results"):
        raise ParameterError(
            f"executor must be Threads(...) or Dask(...), got {executor!r}. "
            'Pass Dask(address="tcp://host:port") for the workers of a scheduler'
        )
    if chunk_size is not None:
        chunk_size = require_whole("chunk_size", chunk_size, least=1, most=MOST_RUNS)
    sink = _sink(sweep, _folder(store), chunk_size, resume=resume)
    try:
        _fill(sink, sweep, executor or Threads(), report_of(progress))
    except Interrupted:
        raise
    except KeyboardInterrupt:
        raise _interrupted(sink, store) from None
    return sink.dataset()


def _folder(store: str | Path | None) -> Path | None:
    if store is None:
        return None
    if not isinstance(store, (str, Path)) or not Path(store).name:
        raise ParameterError(f'store must name the folder of a store, such as "map.zarr", or be None; got {store!r}')
    return Path(store)


def _sink(sweep: Sweep, path: Path | None, chunk_size: int | None, *, resume: bool) -> Sink:
    layout = sweep.layout
    blocks = Blocks.of(sweep.shape, chunk_size)
    if path is None:
        if resume:
            raise ParameterError("resume needs the store to continue, got store=None")
        return InMemory(sweep, layout, blocks)
    if not (resume and path.exists()):
        try:
            return OnDisk(sweep, create_store(path, sweep, layout, blocks), frozenset())
        except FileError:
            if not (resume and path.exists()):  # otherwise continue the store that another process has just created
                raise
    return OnDisk(sweep, *continue_store(path, sweep, layout, chunk_size))


def _fill(sink: Sink, sweep: Sweep, executor: Executor, progress: Report) -> None:
    done, total = sink.runs_done, sweep.runs
    progress(done, total)
    if done == total:  # nothing to do: start no workers
        return

    def within(part: int, whole: int) -> None:
        del whole
        progress(done + part, total)

    with closing(executor.results(sink.work, tasks_of(sweep, sink.todo), within)) as results:
        for task, result in results:
            sink.accept(task, result)
            if result.interrupted:
                raise KeyboardInterrupt
            done += task.block.size
            progress(done, total)


def _interrupted(sink: Sink, store: str | Path | None) -> Interrupted:
    partial = sink.dataset()
    computed = int((partial["outcome"] >= 0).sum())
    remedy = "its result so far is .partial" if store is None else f"resume=True continues {store}"
    return Interrupted(f"stopped after {computed} of {partial['outcome'].size} runs; {remedy}", partial)


Label = Callable[[xr.Dataset], xr.Dataset]


def labelled_sweep(
    sweep: Sweep,
    label: Label,
    *,
    store: str | Path | None = None,
    executor: Executor | None = None,
    resume: bool = False,
    progress: Progress = None,
) -> xr.Dataset:
    """Run `sweep` and return its runs labelled by `label`; the other arguments are those of `run_sweep`.

    Raises
    ------
    Interrupted
        On Ctrl-C; `partial` is also labelled, unless the labelling was interrupted.
    """
    try:
        runs = run_sweep(sweep, store=store, executor=executor, resume=resume, progress=progress)
    except Interrupted as stop:
        raise Interrupted(str(stop), label(stop.partial)) from None
    try:
        return label(runs)
    except Interrupted:
        raise
    except KeyboardInterrupt:
        raise Interrupted("interrupted during the labelling; `partial` has all runs, without labels", runs) from None
