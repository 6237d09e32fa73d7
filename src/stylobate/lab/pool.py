"""Worker processes of the laboratory: a maximum number at once, with cancelled tasks ended.

A task is a function of `stylobate.lab.tasks`. Its process sends messages while it computes, and one answer at the end.
"""

import asyncio
import logging
import multiprocessing
import os
import signal
import sys
import threading
import traceback
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from typing import TYPE_CHECKING, Any
from weakref import WeakSet

import anyio
from anyio.abc import TaskGroup

from stylobate.lab.messages import (
    OUT_OF_MEMORY,
    Answer,
    Broken,
    Emit,
    Finished,
    Lost,
    Note,
    Ready,
    Refused,
)
from stylobate.processes import end_when_closed

if TYPE_CHECKING:
    from multiprocessing.context import BaseContext

_log = logging.getLogger("stylobate.lab")

_NAME = "stylobate lab"
"""Name of each process."""

_NICENESS = 10
"""Niceness of a process in the background: beside one of the usual priority it gets a tenth of a processor."""

GRACE = 1.5
"""Time that a cancelled task may take to its end before its process is ended [s].

A new process takes longer to start than most runs take to end.
"""


class BusyError(Exception):
    """No process became free in time."""


# In the server


@dataclass(slots=True)
class Pool:
    """At most `limit` processes; idle processes wait for the next task. Tasks of `group` end the cancelled tasks.

    Processes in the `background` leave the processors to others: a run does not wait for maps.
    """

    limit: int
    group: TaskGroup
    background: bool = False
    ended: bool = False
    """Whether the pool performs no more tasks."""
    _taken: int = 0
    _idle: "list[_Worker]" = field(default_factory=list)
    _all: "WeakSet[_Worker]" = field(default_factory=WeakSet)
    _changed: anyio.Event = field(default_factory=anyio.Event)

    def warm_up(self) -> None:
        """Start one process before the first task.

        Raises
        ------
        RuntimeError
            If this is a worker process, which imports the user's program and thereby starts a laboratory.
        """
        if multiprocessing.current_process().name == _NAME:
            raise RuntimeError(
                "laboratory: a worker process started another. Call serve under `if __name__ == '__main__':`."
            )
        self._idle.append(self._started())

    async def perform(
        self, kind: str, values: Any, report: Emit, *, wait: float | None = None, limit: float | None = None
    ) -> Answer:
        """Perform a task of this `kind` and return its answer; other messages go to `report`.

        If the caller is cancelled, the task is ended unless it ends within the grace.

        Raises
        ------
        BusyError
            If no process was free, or had started, after the time `wait` [s].
        TimeoutError
            If the task took longer than `limit` [s].
        """
        try:
            with anyio.fail_after(wait):
                worker = await self._ready(report)
        except TimeoutError:
            raise BusyError from None
        if worker is None:
            return Lost()
        try:
            worker.send((kind, values))
            with anyio.fail_after(limit):
                answer = await worker.answer(report)
        except BaseException:
            self.group.start_soon(self._settle, worker)
            raise
        self._give_back(worker)
        return answer

    def end(self) -> None:
        """End all processes permanently; tasks that run or wait are lost."""
        self.ended = True
        for worker in self._all:
            worker.end()
        self._notify()

    async def _ready(self, report: Emit) -> "_Worker | None":
        """Take a process, and wait until it is ready or lost; return None if the pool has ended."""
        while self._taken >= self.limit and not self.ended:
            await self._changed.wait()
        if self.ended:
            return None
        self._taken += 1
        worker = self._idle.pop() if self._idle else self._started()
        while worker.has_ended():
            worker = self._idle.pop() if self._idle else self._started()
        try:
            if not worker.ready:
                report(Note("a process starts, which takes long the first time"))
            await worker.started()
        except BaseException:
            self._give_back(worker)
            raise
        report(Note(""))
        return worker

    def _started(self) -> "_Worker":
        worker = _Worker(background=self.background)
        self._all.add(worker)
        return worker

    async def _settle(self, worker: "_Worker") -> None:
        """Take back a process with a cancelled task; replace the process if the task continues too long."""
        with anyio.move_on_after(GRACE):
            await worker.answer(lambda _: None)
            self._give_back(worker)
            return
        worker.end()
        self._give_back(self._started())

    def _give_back(self, worker: "_Worker") -> None:
        self._taken -= 1
        self._idle.append(worker)
        self._notify()

    def _notify(self) -> None:
        self._changed.set()
        self._changed = anyio.Event()


class _Worker:
    """One process. A thread starts it, because a start may take long, and receives its messages.

    The thread does not delay the end of the program: a process without a server ends when its pipe is closed.
    """

    def __init__(self, *, background: bool) -> None:
        self.ready = False
        self._lost: Lost | None = None
        self._ended = False
        self._process: BaseProcess | None = None
        self._connection: Connection | None = None
        self._heard: asyncio.Queue[Any] = asyncio.Queue()
        arguments = asyncio.get_running_loop(), background
        threading.Thread(target=self._listen, args=arguments, daemon=True).start()

    async def started(self) -> None:
        """Wait until the process is ready or lost."""
        while not (self.ready or self._lost):
            self._note(await self._heard.get())

    def has_ended(self) -> bool:
        """Whether the process has ended since its last answer."""
        while not self._heard.empty():
            self._note(self._heard.get_nowait())
        return self._lost is not None

    def send(self, task: tuple[str, Any]) -> None:
        """Send a task; if the process has ended, its answer is Lost."""
        with suppress(OSError):
            if self._connection is not None:
                self._connection.send(task)

    async def answer(self, report: Emit) -> Answer:
        """Return the answer of the process; other messages go to `report`."""
        while self._lost is None:
            message = self._note(await self._heard.get())
            if isinstance(message, Answer):
                return message
            report(message)
        return self._lost

    def end(self) -> None:
        """End the process, even during a start or a task; its answer is then Lost."""
        self._ended = True
        if self._process is None:
            self._heard.put_nowait(Lost())
        else:
            self._process.kill()

    def _note(self, message: Any) -> Any:
        if isinstance(message, Lost):
            self._lost = message
        self.ready = self.ready or isinstance(message, Ready)
        return message

    def _listen(self, loop: asyncio.AbstractEventLoop, background: bool) -> None:
        """Start the process and pass on its messages; runs in the thread."""
        lost = Lost()
        with suppress(RuntimeError):  # the loop of the server has ended
            try:
                self._process, self._connection = _process(background=background)
            except Exception:  # noqa: BLE001  the waiting task gets an answer
                _log.exception("a worker process could not be started")
            else:
                if self._ended:
                    self._process.kill()
                with suppress(EOFError, OSError), self._connection:
                    while True:
                        loop.call_soon_threadsafe(self._heard.put_nowait, self._connection.recv())
                self._process.join()
                lost = Lost(self._process.exitcode)
            loop.call_soon_threadsafe(self._heard.put_nowait, lost)


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


# In the process


def work(connection: Connection, *, background: bool = False) -> None:
    """Perform the tasks that arrive through `connection`, one after the other, until it is closed.

    In the `background` the process has a low priority; on Windows all have the same.
    """
    if background and hasattr(os, "nice"):
        os.nice(_NICENESS)
    # Ctrl-C in the terminal concerns the server, which then ends its workers.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    server = multiprocessing.parent_process()
    if server is not None:
        end_when_closed(server.sentinel)
    from stylobate.lab import tasks

    logging.getLogger("stylobate").addHandler(_LogSender(connection))
    tasks.warm_up()
    try:
        connection.send(Ready())
        while True:
            kind, values = connection.recv()
            connection.send(_done(tasks.task(kind), values, connection.send))
    except (EOFError, OSError):  # the server has ended
        os._exit(0)


def _done(task: Callable[[Any, Emit], Any], values: Any, emit: Emit) -> Answer:
    from stylobate.errors import ConfigError, StylobateError

    try:
        return Finished(task(values, emit))
    except ConfigError as error:
        return Refused(error.problems)
    except StylobateError as error:
        return Refused(tuple(str(error).splitlines()) or (type(error).__name__,))
    except MemoryError:
        return Refused((OUT_OF_MEMORY,))
    except OSError:  # of the pipe
        raise
    except Exception:  # noqa: BLE001  after any error the process continues with the next task
        return Broken(traceback.format_exc())


class _LogSender(logging.Handler):
    """Send the library's log records to the server."""

    def __init__(self, connection: Connection) -> None:
        super().__init__()
        self._connection = connection

    def emit(self, record: logging.LogRecord) -> None:
        self._connection.send(Note(record.getMessage()))
