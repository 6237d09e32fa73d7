"""Pool of worker processes: a maximum number at once, with cancelled tasks ended."""

import asyncio
import logging
import math
import multiprocessing
import sys
import threading
from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import dataclass, field
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from typing import TYPE_CHECKING, Any

import anyio
from anyio import CapacityLimiter, Event, to_thread
from anyio.abc import TaskGroup
from anyio.streams.memory import MemoryObjectReceiveStream, MemoryObjectSendStream

from stylobate.lab.messages import Broken, Finished, Found, Lost, Note, Progress, Ready, Refused
from stylobate.lab.worker import work

if TYPE_CHECKING:
    from multiprocessing.context import BaseContext

Message = Found | Progress | Note
Answer = Finished | Refused | Broken | Lost

_log = logging.getLogger("stylobate.lab")

_NAME = "stylobate lab"
"""Name of each process."""

GRACE = 1.5
"""Time that a cancelled task may take to its end before its process is ended [s].

A new process takes longer to start than most runs take to end.
"""


class LostError(Exception):
    """A process ended before its answer.

    Attributes
    ----------
    exit_code
        Its exit code, if known.
    """

    def __init__(self, exit_code: int | None = None) -> None:
        self.exit_code = exit_code
        super().__init__(exit_code)


class BusyError(Exception):
    """No process became free in time."""


@dataclass(slots=True, eq=False)
class Worker:
    """One process, the pipe to it, and the received messages."""

    process: BaseProcess
    connection: Connection
    heard: MemoryObjectReceiveStream[Any]
    hears: MemoryObjectSendStream[Any]

    @classmethod
    async def started(cls, *, background: bool) -> "Worker":
        """Start a process, which sends a message when it is ready."""
        process, connection = await _started(background=background)
        hears, heard = anyio.create_memory_object_stream[Any](math.inf)
        return cls(process, connection, heard, hears)

    async def listen(self, threads: CapacityLimiter) -> None:
        """Receive messages from the process until it ends."""
        with self.hears:
            try:
                while True:
                    said = await to_thread.run_sync(self.connection.recv, limiter=threads, abandon_on_cancel=True)
                    self.hears.send_nowait(said)
            except (EOFError, OSError, TypeError, anyio.BrokenResourceError):
                pass  # TypeError: the pipe was closed here between two parts of a message

    async def next(self) -> Any:
        """Return the next message of the process, or raise LostError."""
        try:
            return await self.heard.receive()
        except (anyio.EndOfStream, anyio.ClosedResourceError):
            raise LostError from None

    def end(self) -> None:
        """End the process, even during a task."""
        self.process.kill()
        self.connection.close()
        self.process.join()
        self.heard.close()


async def _started(*, background: bool) -> tuple[BaseProcess, Connection]:
    """Start a process in a thread, because the start may wait for imports and must not delay the end of the program.

    A process without a caller ends when its pipe is closed.
    """
    started: Future[tuple[BaseProcess, Connection]] = Future()
    started.set_running_or_notify_cancel()

    def start() -> None:
        try:
            started.set_result(_process(background=background))
        except Exception as error:  # noqa: BLE001  raised for the caller
            started.set_exception(error)

    threading.Thread(target=start, daemon=True).start()
    return await asyncio.wrap_future(started)


def _process(*, background: bool) -> tuple[BaseProcess, Connection]:
    """Start a worker process.

    On Linux a fork server imports what every process needs, once, and forks each process from itself in milliseconds.
    Elsewhere each process has its own imports, because system libraries may not survive a fork.
    """
    context: BaseContext
    if sys.platform == "linux":
        context = multiprocessing.get_context("forkserver")
        context.set_forkserver_preload(["stylobate.lab.worker_imports"])
    else:
        context = multiprocessing.get_context("spawn")
    pipe: Any = context.Pipe()  # on Windows of another class
    here, there = pipe
    process = context.Process(target=work, args=(there,), kwargs={"background": background}, daemon=True, name=_NAME)
    process.start()
    there.close()
    return process, here


@dataclass(slots=True)
class WorkerPool:
    """At most `limit` processes, which live in tasks of `group`; idle processes wait for the next task.

    Processes in the `background` leave the processors to others: a run does not wait for maps.
    """

    limit: int
    group: TaskGroup
    background: bool = False
    _all: set[Worker] = field(default_factory=set)
    _starting: int = 0
    _idle: list[Worker] = field(default_factory=list)
    _changed: Event = field(default_factory=Event)
    _failed: LostError | None = None
    _open: bool = True
    _threads: CapacityLimiter = field(init=False)

    def __post_init__(self) -> None:
        # A thread listens to each process; threads of ended processes stop a moment later.
        self._threads = CapacityLimiter(4 * self.limit)

    def warm_up(self) -> None:
        """Start one process before the first task.

        Raises
        ------
        RuntimeError
            If this is a worker process, which imports the user's program and thereby starts a laboratory.
        """
        if multiprocessing.current_process().name == _NAME:
            message = "laboratory: a worker process started another. Call serve under `if __name__ == '__main__':`."
            raise RuntimeError(message)
        self._begin()

    async def perform(
        self,
        kind: str,
        values: Any,
        report: Callable[[Message], None],
        *,
        wait: float | None = None,
        limit: float | None = None,
    ) -> Answer:
        """Perform a task of this `kind` and return its answer; other messages go to `report`.

        If the caller is cancelled, the task is ended unless it ends within the grace.

        Raises
        ------
        BusyError
            If all processes were busy for longer than `wait` [s].
        TimeoutError
            If the task took longer than `limit` [s].
        """
        if self._idle or self._room():
            report(Note("a process starts, which takes long the first time"))  # the task need not wait for others
        try:
            with anyio.fail_after(wait):
                worker = await self._ready()
        except TimeoutError:
            raise BusyError from None
        except LostError as error:
            return Lost(error.exit_code)
        report(Note(""))
        try:
            worker.connection.send((kind, values))
            with anyio.fail_after(limit):
                answer = await _answer(worker, report)
        except (LostError, OSError) as error:
            if isinstance(error, TimeoutError):  # is also an OSError
                self.group.start_soon(self._settle, worker)
                raise
            self._discard(worker)
            return Lost(worker.process.exitcode)
        except BaseException:
            self.group.start_soon(self._settle, worker)
            raise
        self._release(worker)
        return answer

    @property
    def ended(self) -> bool:
        """Whether the pool performs no more tasks."""
        return not self._open

    def end(self) -> None:
        """End all processes permanently; tasks that run or wait are lost."""
        self._open = False
        for worker in list(self._all):
            self._discard(worker)
        self._notify()

    async def _ready(self) -> Worker:
        """Return an idle process; start one more if the limit allows."""
        self._failed = None  # an earlier failure to start, without a waiting task, does not concern the next process
        while self._open:
            while self._idle:
                worker = self._idle.pop()
                if worker.process.is_alive():
                    return worker
                self._discard(worker)
            if self._failed is not None:
                failed, self._failed = self._failed, None
                raise failed
            if self._room():
                self._begin()
            await self._changed.wait()
        raise LostError

    def _room(self) -> bool:
        return len(self._all) + self._starting < self.limit

    def _begin(self) -> None:
        if not self._open:
            return
        self._starting += 1
        self.group.start_soon(self._start)

    async def _start(self) -> None:
        try:
            worker = await Worker.started(background=self.background)
        except Exception:  # noqa: BLE001  any caller that waits gets an answer
            _log.exception("a worker process could not be started")
            self._failed = LostError()
            self._notify()
            return
        finally:
            self._starting -= 1
        self._all.add(worker)
        if not self._open:
            self._discard(worker)
            return
        self.group.start_soon(worker.listen, self._threads)
        try:
            while not isinstance(await worker.next(), Ready):
                pass  # log records at the start
        except LostError:
            self._discard(worker)
            self._failed = LostError(worker.process.exitcode)
        else:
            self._release(worker)

    async def _settle(self, worker: Worker) -> None:
        """Take back a process with a cancelled task; replace the process if the task continues too long."""
        try:
            with anyio.move_on_after(GRACE):
                await _answer(worker, lambda _: None)
                self._release(worker)
                return
        except LostError:
            pass
        self._discard(worker)
        self._begin()

    def _release(self, worker: Worker) -> None:
        if worker in self._all:
            self._idle.append(worker)
        self._notify()

    def _discard(self, worker: Worker) -> None:
        if worker in self._all:
            self._all.remove(worker)
            worker.end()
        self._notify()

    def _notify(self) -> None:
        self._changed.set()
        self._changed = Event()


async def _answer(worker: Worker, report: Callable[[Message], None]) -> Answer:
    while True:
        message = await worker.next()
        if isinstance(message, (Finished, Refused, Broken)):
            return message
        report(message)
