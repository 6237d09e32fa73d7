"""Worker processes, which end with the process that started them, however that process ends.

A worker reads tasks from its standard input and writes answers to its standard output, one after the other. The user's
script needs no `if __name__ == "__main__"`. Ctrl-C in a terminal reaches only the parent process, which ends its
workers.
"""

import os
import pickle
import select
import signal
import subprocess
import sys
import threading
import traceback
from collections import deque
from collections.abc import Callable, Generator, Iterator, Mapping
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from contextlib import contextmanager
from dataclasses import dataclass
from typing import IO, Any, TypeVar, cast

from stylobate.errors import WorkerLostError
from stylobate.progress import never

_K = TypeVar("_K")
_R = TypeVar("_R")

# Interval at which a wait checks for Ctrl-C or for the end of the parent [s].
_LOOK = 0.1
# Size of the number that precedes a request, its length [bytes].
_LENGTH = 8

_running: set["Worker"] = set()


@dataclass(frozen=True, slots=True)
class Worker:
    """A process that computes tasks for this process."""

    process: subprocess.Popen[bytes]

    @classmethod
    def started(cls, *, quiet: bool = False) -> "Worker":
        """Start a process; its log goes to stderr unless it is `quiet`.

        Raises
        ------
        OSError
            If no process can be started.
        """
        program = f"import sys; sys.path[:] = {sys.path!r}; from stylobate.processes import _serve; _serve()"
        errors = subprocess.DEVNULL if quiet else None
        with _without_interrupts():
            process = subprocess.Popen(  # noqa: S603  this Python
                [sys.executable, "-c", program], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=errors
            )
        worker = cls(process)
        _running.add(worker)
        return worker

    def call(self, task: Callable[..., _R], *arguments: Any) -> _R:
        """Run `task`, a function that the worker can import, in the worker and return its result.

        Raises
        ------
        WorkerLostError
            If the process ends before its answer.
        KeyboardInterrupt
            If `end_all` ends it.
        Exception
            The exception of the task; a note holds the traceback of the worker.
        """
        pipes = cast("tuple[IO[bytes], IO[bytes]]", (self.process.stdin, self.process.stdout))
        request = pickle.dumps((task, arguments))
        try:
            pipes[0].write(len(request).to_bytes(_LENGTH) + request)
            pipes[0].flush()
            answer, error = pickle.load(pipes[1])  # noqa: S301  our own process
        except (OSError, EOFError, pickle.UnpicklingError):
            if self not in _running:
                raise KeyboardInterrupt from None
            message = f"worker process: it ended before its result (got exit status {self.process.wait()}). "
            raise WorkerLostError(message + "If memory ran out, use fewer workers.") from None
        if error is not None:
            raise error
        return cast("_R", answer)

    def end(self) -> None:
        """End the process at once."""
        _running.discard(self)
        self.process.kill()
        self.process.wait()
        for pipe in (self.process.stdin, self.process.stdout):
            if pipe is not None:
                pipe.close()


def computed(tasks: Mapping[_K, Callable[[], _R]], *, workers: int) -> Generator[tuple[_K, _R], None, None]:
    """Compute tasks on `workers` processes; yield the key and the result of each task when it is done.

    Close the iterator (`contextlib.closing`) to end the processes before all is done.

    Raises
    ------
    WorkerLostError
        If a process ends before its answer.
    Exception
        The exception of a task.
    """
    waiting = deque(tasks.items())
    running: dict[Future[_R], tuple[_K, Worker]] = {}
    threads = ThreadPoolExecutor(max(min(workers, len(tasks)), 1), thread_name_prefix="stylobate worker")
    started: list[Worker] = []
    try:
        for _ in range(min(workers, len(tasks))):
            started.append(Worker.started())  # noqa: PERF401  if the next start fails, the others are ended
        idle = list(started)
        while waiting or running:
            while waiting and idle:
                key, task = waiting.popleft()
                worker = idle.pop()
                running[threads.submit(worker.call, task)] = key, worker
            for future in wait(running, timeout=_LOOK, return_when=FIRST_COMPLETED).done:
                key, worker = running.pop(future)
                idle.append(worker)
                yield key, future.result()
    finally:
        for worker in started:
            worker.process.kill()
        threads.shutdown()
        for worker in started:
            worker.end()


def end_all() -> None:
    """End all workers of this process after Ctrl-C: threads that wait for one get a KeyboardInterrupt."""
    while _running:
        _running.pop().process.kill()


def end_when_closed(pipe: int, *, watched: bool = True) -> None:
    """End this process when the other end of `pipe` is closed, for example by the death of its owner.

    The system sends a signal, which works while a compiler holds Python's lock and no thread can run. Bytes that arrive
    end the process too: stop watching before any can arrive. For a process of `multiprocessing` the pipe is
    `multiprocessing.parent_process().sentinel`. On Windows this does nothing.

    Parameters
    ----------
    pipe
        File descriptor of the end that this process reads.
    watched
        Whether to start or to stop watching the pipe.
    """
    if sys.platform == "win32":
        return
    import fcntl

    flags = fcntl.fcntl(pipe, fcntl.F_GETFL)
    fcntl.fcntl(pipe, fcntl.F_SETOWN, os.getpid())
    fcntl.fcntl(pipe, fcntl.F_SETFL, flags | os.O_ASYNC if watched else flags & ~os.O_ASYNC)
    if watched:  # the pipe may be closed already
        look = select.poll()
        look.register(pipe, select.POLLHUP)
        if any(event & select.POLLHUP for _, event in look.poll(0)):
            os._exit(1)


@contextmanager
def ending_with_parent() -> Iterator[None]:
    """End this process if its parent ends meanwhile; afterwards no thread is left that a fork could lose."""
    parent, done = os.getppid(), threading.Event()

    def watch() -> None:
        while not done.wait(_LOOK):
            if os.getppid() != parent:
                os._exit(1)

    thread = threading.Thread(target=watch, daemon=True)
    thread.start()
    try:
        yield
    finally:
        done.set()
        thread.join()


def _serve() -> None:
    """Compute the tasks of the parent process until it closes the pipe or ends."""
    requests, answers = sys.stdin.buffer, os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # keeps the output of a task out of the answers
    never()
    while request := requests.read(int.from_bytes(requests.read(_LENGTH))):
        end_when_closed(0)
        task, arguments = pickle.loads(request)  # noqa: S301  our own parent; imports what the task needs
        answer = pickle.dumps(_answer(task, arguments))
        end_when_closed(0, watched=False)
        try:
            answers.write(answer)
            answers.flush()
        except BrokenPipeError:
            os._exit(0)


def _answer(task: Callable[..., Any], arguments: tuple[Any, ...]) -> tuple[Any, Exception | None]:
    try:
        return task(*arguments), None
    except Exception as error:  # noqa: BLE001  raised in the calling process
        error.add_note(traceback.format_exc())
        try:
            pickle.loads(pickle.dumps(error))  # noqa: S301  our own
        except Exception:  # noqa: BLE001  pickling can fail in any way
            return None, RuntimeError(traceback.format_exc())
        return None, error


@contextmanager
def _without_interrupts() -> Iterator[None]:
    """Block Ctrl-C until the end; processes that start meanwhile inherit the block."""
    if sys.platform == "win32":
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
