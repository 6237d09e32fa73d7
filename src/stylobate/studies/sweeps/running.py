"""`run_sweep`: compute a sweep, or its missing runs."""

from contextlib import closing
from pathlib import Path

import xarray as xr

from stylobate.errors import MOST_RUNS, FileError, Interrupted, ParameterError, require_whole
from stylobate.progress import Progress, Report, report_of, shows_progress
from stylobate.studies.sweeps.blocks import Blocks
from stylobate.studies.sweeps.executors import Executor, Threads
from stylobate.studies.sweeps.sinks import InMemory, OnDisk, Sink, tasks_of
from stylobate.studies.sweeps.store import continue_store, create_store
from stylobate.studies.sweeps.sweep import Sweep


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
        message = f"sweep must be a Sweep, such as Sweep.grid(...), got {sweep!r}"
        raise ParameterError(message)
    if executor is not None and not hasattr(executor, "results"):
        message = (
            f"executor must be Threads(...) or Dask(...), got {executor!r}. "
            'Make one from a text by executor_from("dask://host:port")'
        )
        raise ParameterError(message)
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
        message = f'store must name the folder of a store, such as "map.zarr", or be None; got {store!r}'
        raise ParameterError(message)
    return Path(store)


def _sink(sweep: Sweep, path: Path | None, chunk_size: int | None, *, resume: bool) -> Sink:
    layout = sweep.layout
    blocks = Blocks.of(sweep.shape, chunk_size)
    if path is None:
        if resume:
            message = "resume needs the store to continue, got store=None"
            raise ParameterError(message)
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
