"""Executors of the blocks of a sweep: the protocol, and threads of this process."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

from stylobate.errors import MOST_THREADS, require_whole
from stylobate.progress import Report

if TYPE_CHECKING:
    from collections.abc import Generator, Iterable

    from stylobate.studies.sweeps.chunks import Computed, Task


class Work(Protocol):
    """Function that computes a task; it can be pickled."""

    def __call__(self, task: "Task", *, threads: int | None, progress: Report | None) -> "Computed":
        """Return the results of `task`, or no arrays if they have been stored."""


class Executor(Protocol):
    """An executor of tasks.

    Notes
    -----
    For developers: yield (task, result) in any order. Take tasks from `tasks` as needed, not all at once. Calls of
    `progress`, with completed runs and all runs of one task, are optional.
    """

    def results(
        self, work: Work, tasks: "Iterable[Task]", progress: Report | None = None
    ) -> "Generator[tuple[Task, Computed], None, None]":
        """Yield each task with its result."""


@dataclass(frozen=True, slots=True)
class Threads:
    """Compute blocks one after the other, each on `threads` threads of this process; None for all cores.

    Raises
    ------
    ParameterError
        If `threads` is not a whole number of at least 1.
    """

    threads: int | None = None

    def __post_init__(self) -> None:
        if self.threads is not None:
            object.__setattr__(self, "threads", require_whole("threads", self.threads, least=1, most=MOST_THREADS))

    def results(
        self, work: Work, tasks: "Iterable[Task]", progress: Report | None = None
    ) -> "Generator[tuple[Task, Computed], None, None]":
        """Yield each task with its result, in order."""
        for task in tasks:
            yield task, work(task, threads=self.threads, progress=progress)
