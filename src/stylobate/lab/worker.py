"""A process that computes for the laboratory: one task after the other, told to it and answered through a pipe."""

import logging
import os
import signal
import traceback
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from multiprocessing.connection import Connection
from typing import Any

Emit = Callable[[Any], None]


@dataclass(frozen=True, slots=True)
class Ready:
    """The process has started and waits for tasks."""


@dataclass(frozen=True, slots=True)
class Found:
    """Something found on the way."""

    value: Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class Progress:
    """So many of all runs are done."""

    done: int
    total: int


@dataclass(frozen=True, slots=True)
class Note:
    """One line about what goes on, such as that a kernel is compiled."""

    line: str


@dataclass(frozen=True, slots=True)
class Finished:
    """The task is done."""

    result: Any


@dataclass(frozen=True, slots=True)
class Refused:
    """The task cannot be done, one line for each reason."""

    problems: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Broken:
    """The task failed by a mistake of the program's own; the traceback is for its developers."""

    trace: str


def work(connection: Connection) -> None:
    """Do what the other end of `connection` asks for, until it is closed."""
    # Ctrl-C in the terminal is for the server, which then ends its workers.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    from stylobate.lab import tasks  # noqa: PLC0415  heavy imports happen in the new process

    logging.getLogger("stylobate").addHandler(_Telling(connection))
    tasks.warm_up()
    try:
        connection.send(Ready())
        while True:
            kind, values = connection.recv()
            connection.send(_done(tasks.TASKS[kind], values, connection.send))
    except (EOFError, OSError):  # the server is gone
        os._exit(0)


def _done(task: Callable[[Any, Emit], Any], values: Any, emit: Emit) -> Finished | Refused | Broken:
    from stylobate.errors import DescriptionError, StylobateError  # noqa: PLC0415  as above

    try:
        return Finished(task(values, emit))
    except DescriptionError as error:
        return Refused(error.problems)
    except StylobateError as error:
        return Refused(tuple(str(error).splitlines()) or (type(error).__name__,))
    except MemoryError:
        return Refused(("this needs more memory than there is; make the record, the duration or the grid smaller",))
    except OSError:  # of the pipe
        raise
    except Exception:  # noqa: BLE001  whatever it is, the process goes on with the next task
        return Broken(traceback.format_exc())


class _Telling(logging.Handler):
    """Tells the server what the library logs."""

    def __init__(self, connection: Connection) -> None:
        super().__init__()
        self._connection = connection

    def emit(self, record: logging.LogRecord) -> None:
        self._connection.send(Note(record.getMessage()))
