"""Executor on Dask workers, which must have the version and sources of the program that sends the tasks."""

import hashlib
import logging
import pickle
import signal
import uuid
from collections.abc import Generator, Iterable, Iterator, Sequence
from concurrent.futures import CancelledError
from contextlib import ExitStack
from dataclasses import dataclass, field
from functools import cache, lru_cache
from itertools import islice
from pathlib import Path
from queue import Empty, SimpleQueue
from time import monotonic
from typing import TYPE_CHECKING, Any, cast

from stylobate.errors import (
    MOST_THREADS,
    ParameterError,
    StylobateError,
    require_extra,
    require_positive,
    require_whole,
)
from stylobate.progress import Report
from stylobate.studies.sweeps.chunks import Computed, Task
from stylobate.studies.sweeps.executors import Threads

if TYPE_CHECKING:
    from types import ModuleType

    from stylobate.studies.sweeps.executors import Work


@dataclass(frozen=True, slots=True)
class PackageIdentity:
    """Version of stylobate and digest of its source: equal on two machines only if both compute the same."""

    version: str
    source: str

    def __str__(self) -> str:
        return f"stylobate {self.version} (source {self.source[:8]})"


@cache
def package_identity() -> PackageIdentity:
    """Return the identity of the package in this process, computed once."""
    from stylobate import __version__

    return PackageIdentity(__version__, source_digest(Path(__file__).parents[2]))


def source_digest(package: Path) -> str:
    """Return a digest of the paths and contents of all Python files in a package, whatever ends their lines."""
    digest = hashlib.sha256()
    for path in sorted(package.rglob("*.py"), key=lambda path: path.relative_to(package).parts):
        digest.update("/".join(path.relative_to(package).parts).encode() + b"\0")
        digest.update(path.read_bytes().replace(b"\r\n", b"\n") + b"\0")
    return digest.hexdigest()


class SealedTasks:
    """Tasks that become their results when they are loaded with `pickle.loads`.

    Loading imports stylobate inside the worker, so that a worker without the package raises ImportError there and
    the scheduler needs no package. What the tasks compute is opened only after `perform` has compared the packages.
    """

    def __init__(self, package: PackageIdentity, work: bytes, tasks: Sequence[Task]) -> None:
        self.parts = (package.version, package.source, work, pickle.dumps(tasks))

    def __reduce__(self) -> tuple[Any, ...]:
        return perform, self.parts


def perform(version: str, source: str, work: bytes, tasks: bytes) -> tuple[list[Computed], float]:
    """Compute tasks on one thread, and return their results and the time that they took [s].

    Raises
    ------
    StylobateError
        If version or source of the package differ from those of the process that made the tasks.
    """
    theirs, here = PackageIdentity(version, source), package_identity()
    if here != theirs:
        raise StylobateError(
            f"a Dask worker has {here}, but this process has {theirs}. "
            "Install the same version for both, and start the workers again."
        )
    begun, function = monotonic(), _opened(work)
    results = [function(task, threads=1, progress=None) for task in pickle.loads(tasks)]  # noqa: S301  as below
    return results, monotonic() - begun


@lru_cache(maxsize=1)
def _opened(work: bytes) -> "Work":
    """Return the function of a sweep, the same object for all its tasks, so that what it has prepared is kept."""
    function: Work = pickle.loads(work)  # noqa: S301  from the scheduler, which can run any code
    return function


# Number of messages that wait for each thread of the workers, so that no thread is idle.
_AHEAD = 2
# Dask takes some 10 ms for a message: so many seconds of short tasks travel in one.
_TOGETHER = 0.2
# While no result arrives, workers are counted once in so many seconds.
_COUNT_WORKERS = 0.5


@dataclass(frozen=True, slots=True)
class Dask:
    """Compute each block on one thread of Dask distributed; several blocks that take little time are one task of Dask.

    If a worker dies, its blocks are computed again by another one. With a store the workers write into it directly, so
    they must see the same disk; without a store the results are sent to this process. A script that starts workers on
    this machine must do so under `if __name__ == "__main__":`, because each worker imports it. Each block carries the
    version and a digest of the source of stylobate; a worker with another version or source refuses it.

    Parameters
    ----------
    address
        Address of a running scheduler, such as "tcp://10.0.0.1:8786". None starts workers on this machine, for this
        sweep only.
    workers
        Number of workers to start on this machine; None for one per core.
    client
        A `dask.distributed.Client` to use instead; it stays open.
    wait
        Maximum time to wait for the scheduler's answer, and maximum time without any worker [s], at the start and
        later, before the sweep stops with an error; None waits for workers without limit. Workers that are jobs of a
        batch system may need hours.

    Raises
    ------
    ParameterError
        If `workers` is not a whole number of at least 1, or is given with an address or a client; if `wait` is not
        positive.
    """

    address: str | None = None
    workers: int | None = None
    client: Any = field(default=None, repr=False)
    wait: float | None = 10.0

    def __post_init__(self) -> None:
        if self.wait is not None:
            object.__setattr__(self, "wait", require_positive("wait", self.wait, "s"))
        if self.workers is not None:
            object.__setattr__(self, "workers", require_whole("workers", self.workers, least=1, most=MOST_THREADS))
        given = [name for name in ("address", "workers", "client") if getattr(self, name) is not None]
        if len(given) > 1:
            raise ParameterError(f"Dask takes one of address, workers and client, got {' and '.join(given)}")

    def results(
        self, work: "Work", tasks: Iterable[Task], progress: Report | None = None
    ) -> Generator[tuple[Task, Computed], None, None]:
        """Yield each task with its result, in the order in which they finish.

        Raises
        ------
        UnsupportedError
            If Dask distributed is not installed.
        StylobateError
            If no scheduler answers at the address, if it is lost, if it has no workers for longer than `wait`, if a
            worker lacks stylobate or has another version or source, or if a block killed several workers in a row.
        """
        del progress  # a block is short, and its worker is another process
        distributed = _distributed()
        with ExitStack() as stack:
            client = self._client(distributed, stack)
            try:
                yield from _flow(distributed, client, work, iter(tasks), self.wait)
            except (distributed.comm.CommClosedError, CancelledError) as error:
                raise StylobateError(
                    f"the Dask scheduler was lost ({error}). Continue a sweep with a store by resume=True"
                ) from error

    def _client(self, distributed: "ModuleType", stack: ExitStack) -> Any:
        if self.client is not None:
            return self.client
        if self.address is None:
            return _local_client(distributed, self.workers, stack)
        try:
            return stack.enter_context(distributed.Client(self.address, timeout=self.wait))
        except (OSError, ValueError) as error:
            raise StylobateError(f"no Dask scheduler answers at {self.address}: {error}") from error


def _local_client(distributed: Any, workers: int | None, stack: ExitStack) -> Any:
    """Return a client of workers on this machine, which end with `stack`."""

    class LeavesCtrlC(distributed.WorkerPlugin):  # type: ignore[misc]  # distributed is imported when it is used
        """Ignore Ctrl-C, which a terminal sends to all processes, in workers."""

        def setup(self, worker: object) -> None:
            del worker
            signal.signal(signal.SIGINT, signal.SIG_IGN)

    cluster = stack.enter_context(
        distributed.LocalCluster(
            n_workers=workers, threads_per_worker=1, dashboard_address="127.0.0.1:0", silence_logs=logging.ERROR
        )
    )
    client = stack.enter_context(distributed.Client(cluster))
    client.register_plugin(LeavesCtrlC())
    return client


def _flow(
    distributed: "ModuleType", client: Any, work: "Work", tasks: Iterator[Task], wait: float | None
) -> Generator[tuple[Task, Computed], None, None]:
    """Yield results while a bounded number of tasks is submitted."""
    sweep = uuid.uuid4().hex
    package, packed = package_identity(), distributed.protocol.pickle.dumps(work)
    waiting: dict[Any, tuple[Task, ...]] = {}
    finished: SimpleQueue[Any] = SimpleQueue()
    together = 1

    def room() -> int:
        # The number of workers may change.
        threads = int(sum(client.nthreads().values()))
        return _AHEAD * max(1, threads) - len(waiting)

    def submit() -> None:
        for _ in range(room()):
            if not (group := tuple(islice(tasks, together))):
                return
            # A unique key: Dask must not return the result of an earlier sweep.
            key = f"stylobate-{sweep}-{group[0].block.index}"
            sealed = pickle.dumps(SealedTasks(package, packed, group))
            future = client.submit(pickle.loads, sealed, key=key, pure=False)
            waiting[future] = group
            future.add_done_callback(finished.put)

    submit()
    try:
        while waiting:
            future = _finished(client, finished, wait)
            group = waiting.pop(future)
            results, seconds = _results(distributed, future, group)
            yield from zip(group, results, strict=True)
            together = max(1, min(2 * len(group), int(len(group) * _TOGETHER / max(seconds, 1e-9))))
            submit()
    finally:
        client.cancel(list(waiting))


def _finished(client: Any, finished: "SimpleQueue[Any]", wait: float | None) -> Any:
    """Return the next finished future.

    Raises
    ------
    StylobateError
        If there is no worker for longer than `wait` seconds.
    """
    seen = monotonic()
    while True:
        try:
            return finished.get(timeout=_COUNT_WORKERS if wait is None else min(wait, _COUNT_WORKERS))
        except Empty:
            pass
        now = monotonic()
        if client.nthreads():
            seen = now
        elif wait is not None and now - seen > wait:
            address = client.scheduler.address
            raise StylobateError(
                f"the Dask scheduler at {address} has had no workers for {wait:g} s. Start some by "
                f'"dask worker {address}", or wait longer by Dask(…, wait=3600); with a store, continue by resume=True.'
            )


def _results(distributed: "ModuleType", future: Any, group: tuple[Task, ...]) -> tuple[list[Computed], float]:
    try:
        results: tuple[list[Computed], float] = future.result()
    except distributed.KilledWorker as error:
        chunks = " to ".join(map(str, dict.fromkeys((group[0].block.index, group[-1].block.index))))
        raise StylobateError(
            f"{error.allowed_failures + 1} workers died on chunk {chunks} of {group[0].block.size} runs. "
            "Give them more memory, or reduce chunk_size"
        ) from error
    except (ImportError, AttributeError) as error:
        if SealedTasks.__module__ not in str(error) and getattr(error, "name", None) != "stylobate":
            raise
        raise StylobateError(
            f"a Dask worker lacks {package_identity()} ({error}). "
            "Install this version for the workers, and start them again."
        ) from error
    return results


def _distributed() -> "ModuleType":
    message = 'Dask needs the package dask.distributed: pip install "stylobate[cluster]"'
    return cast("ModuleType", require_extra("distributed", message))


def executor_from(text: str) -> Threads | Dask:
    """Return the executor that `text` names.

    Parameters
    ----------
    text
        `threads`; `dask://` for workers on this machine; `dask://host:port` for a scheduler. `?wait=600` after the port
        sets the time [s] to wait for workers.

    Raises
    ------
    ParameterError
        If `text` names no executor.

    Examples
    --------
    >>> executor_from("dask://10.0.0.1:8786")
    Dask(address='tcp://10.0.0.1:8786', workers=None, wait=10.0)
    """
    if text == "threads":
        return Threads()
    scheme, separator, place = text.partition("://")
    if scheme == "dask" and separator:
        place, asks, wait = place.partition("?wait=")
        address = f"tcp://{place}" if place else None
        return Dask(address=address, wait=_seconds(wait)) if asks else Dask(address=address)
    raise ParameterError(f'executor must be "threads", "dask://" or "dask://host:port", got {text!r}')


def _seconds(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise ParameterError(
            f"wait: not a number of seconds (got {text!r}). Write dask://host:port?wait=600."
        ) from None
