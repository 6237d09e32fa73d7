"""Executors: who computes the blocks of a sweep. Threads of this process here; Dask has a file of its own."""

from collections.abc import Generator, Iterable
from dataclasses import dataclass
from typing import Protocol

from stylobate.errors import MOST_THREADS, ParameterError, require_whole
from stylobate.studies.sweeps.computing import Computed, Progress, Task
from stylobate.studies.sweeps.dask_executor import Dask


class Work(Protocol):
    """What is done with a task; it can be pickled."""

    def __call__(self, task: Task, *, threads: int | None, progress: Progress | None) -> Computed:
        """Return the results of `task`, or no arrays if they have been stored."""


class Executor(Protocol):
    """An executor of tasks.

    Notes
    -----
    For developers: yield (task, result) in any order. Take tasks from `tasks` as they are needed, not all at once;
    `progress`, called with runs done and runs in all of one task, may be left alone.
    """

    def results(
        self, work: Work, tasks: Iterable[Task], progress: Progress | None = None
    ) -> Generator[tuple[Task, Computed], None, None]:
        """Yield each task with its result."""


@dataclass(frozen=True, slots=True)
class Threads:
    """One block after the other, each on `threads` threads of this process; None for all cores.

    Raises
    ------
    ParameterError
        If `threads` is no whole number of at least 1.
    """

    threads: int | None = None

    def __post_init__(self) -> None:
        if self.threads is not None:
            object.__setattr__(self, "threads", require_whole("threads", self.threads, least=1, most=MOST_THREADS))

    def results(
        self, work: Work, tasks: Iterable[Task], progress: Progress | None = None
    ) -> Generator[tuple[Task, Computed], None, None]:
        """Yield each task with its result, in order."""
        for task in tasks:
            yield task, work(task, threads=self.threads, progress=progress)


def executor_from(text: str) -> Threads | Dask:
    """Return the executor that `text` names: `threads`, `dask://` (workers on this machine) or `dask://host:port`.

    Raises
    ------
    ParameterError
        If it names none.

    Examples
    --------
    >>> executor_from("dask://10.0.0.1:8786")
    Dask(address='tcp://10.0.0.1:8786', workers=None)
    """
    if text == "threads":
        return Threads()
    scheme, separator, place = text.partition("://")
    if scheme == "dask" and separator:
        return Dask(address=f"tcp://{place}" if place else None)
    message = f'executor must be "threads", "dask://" or "dask://host:port", got {text!r}'
    raise ParameterError(message)
