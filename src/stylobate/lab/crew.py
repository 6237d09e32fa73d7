"""The processes that compute for the laboratory: as many at once as allowed, ended where nobody waits for them."""

import multiprocessing
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager, suppress
from dataclasses import dataclass, field
from multiprocessing.connection import Connection
from multiprocessing.context import SpawnProcess
from typing import Any

import anyio
from anyio import CapacityLimiter, Semaphore, to_thread

from stylobate.lab.worker import Broken, Event, Finished, Note, Progress, Ready, Refused, work

Told = Event | Progress | Note
Answer = Finished | Refused | Broken


@dataclass(slots=True)
class Worker:
    """One process and the pipe to it."""

    process: SpawnProcess
    connection: Connection

    @classmethod
    def started(cls) -> "Worker":
        """Return a new process; it says that it is ready."""
        context = multiprocessing.get_context("spawn")
        here, there = context.Pipe()
        process = context.Process(target=work, args=(there,), daemon=True, name="stylobate lab")
        process.start()
        there.close()
        return cls(process, here)

    def end(self) -> None:
        """End the process, whatever it does."""
        self.process.kill()
        self.connection.close()
        self.process.join()


@dataclass(slots=True)
class Crew:
    """At most `limit` processes; those that are idle are kept for the next task."""

    limit: int
    _idle: list[Worker] = field(default_factory=list)
    _threads: CapacityLimiter = field(init=False)
    _free: Semaphore = field(init=False)
    _open: bool = True

    def __post_init__(self) -> None:
        # A thread waits for each process.
        self._threads, self._free = CapacityLimiter(self.limit), Semaphore(self.limit)

    async def warm_up(self) -> None:
        """Have one process ready before the first task."""
        with suppress(_LostError):
            async with self._free, self._worker():
                pass

    async def perform(
        self,
        kind: str,
        values: Any,
        told: Callable[[Told], None],
        *,
        wait: float | None = None,
        limit: float | None = None,
    ) -> Answer:
        """Return how the task of this `kind` ended; what is found on the way is `told`.

        If the caller is cancelled the process is ended with it.

        Raises
        ------
        TimeoutError
            If all processes were busy for longer than `wait` [s], or the task took longer than `limit` [s].
        """
        with anyio.fail_after(wait):
            await self._free.acquire()
        try:
            told(Note("a process starts"))
            async with self._worker() as worker:
                with anyio.fail_after(limit):
                    return await self._answer(worker, kind, values, told)
        except _LostError:
            return Broken("the process that computed ended of its own, perhaps for want of memory")
        finally:
            self._free.release()

    def end(self) -> None:
        """End all processes."""
        self._open = False
        while self._idle:
            self._idle.pop().end()

    @asynccontextmanager
    async def _worker(self) -> AsyncIterator[Worker]:
        """Lend a process that is ready; one that did not come to the end of its task is ended."""
        worker = self._idle.pop() if self._idle else None
        try:
            if worker is None:
                worker = Worker.started()
                while not isinstance(await self._heard(worker), Ready):
                    pass  # what is logged at the start; a process that ends raises
            yield worker
        except BaseException:
            if worker is not None:
                worker.end()
            raise
        if self._open:
            self._idle.append(worker)
        else:
            worker.end()

    async def _answer(self, worker: Worker, kind: str, values: Any, told: Callable[[Told], None]) -> Answer:
        try:
            worker.connection.send((kind, values))
        except OSError:
            raise _LostError from None
        while True:
            message = await self._heard(worker)
            if isinstance(message, (Finished, Refused, Broken)):
                return message
            told(message)

    async def _heard(self, worker: Worker) -> Any:
        try:
            return await to_thread.run_sync(worker.connection.recv, limiter=self._threads, abandon_on_cancel=True)
        except (EOFError, OSError):
            raise _LostError from None


class _LostError(Exception):
    """A process ended of its own."""
