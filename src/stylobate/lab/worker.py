"""Worker process of the laboratory: one task after the other, received and answered through a pipe."""

import logging
import multiprocessing
import os
import signal
import traceback
from collections.abc import Callable
from multiprocessing.connection import Connection
from typing import Any

from stylobate.lab.messages import Broken, Emit, Finished, Note, Ready, Refused
from stylobate.processes import end_when_closed

_NICENESS = 10
"""Niceness of a process in the background: beside one of the usual priority it gets a tenth of a processor."""


def work(connection: Connection, *, background: bool = False) -> None:
    """Perform the tasks that arrive through `connection` until it is closed.

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
            connection.send(_done(tasks.TASKS[kind], values, connection.send))
    except (EOFError, OSError):  # the server has ended
        os._exit(0)


def _done(task: Callable[[Any, Emit], Any], values: Any, emit: Emit) -> Finished | Refused | Broken:
    from stylobate.errors import ConfigError, StylobateError

    try:
        return Finished(task(values, emit))
    except ConfigError as error:
        return Refused(error.problems)
    except StylobateError as error:
        return Refused(tuple(str(error).splitlines()) or (type(error).__name__,))
    except MemoryError:
        return Refused(("out of memory: make the record, the duration or the grid smaller",))
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
