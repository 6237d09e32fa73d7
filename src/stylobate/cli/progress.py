"""Progress of long work on stderr: a line that moves on a terminal, and what the library warns of."""

import logging
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.console import Console


@contextmanager
def runs_done(what: str) -> Iterator[Callable[[int, int], None]]:
    """Give a function that is told runs done and runs in all, and shows them with their rate and the time left.

    Where stderr is no terminal nothing moves; warnings are told one to a line in any case.
    """
    from rich.console import Console  # noqa: PLC0415  heavy imports wait until the options are read
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn  # noqa: PLC0415

    console = Console(stderr=True, markup=False, highlight=False)
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn("{task.fields[rate]}"),
        TimeRemainingColumn(),
    )
    with (
        Progress(*columns, console=console, transient=True, disable=not sys.stderr.isatty()) as bar,
        _handled_by(_OnConsole(console)),
    ):
        task = bar.add_task(what, total=None, rate="")

        def advance(done: int, total: int) -> None:
            bar.update(task, completed=done, total=total)
            speed = bar.tasks[0].speed
            bar.update(task, rate=f"{speed:.0f} runs/s" if speed else "")

        yield advance


@contextmanager
def log_lines() -> Iterator[None]:
    """Print warnings of the library on stderr, and of what it reports while it computes a line every few seconds."""
    with _handled_by(_Lines()):
        yield


class _Lines(logging.Handler):
    """Prints records one to a line; reports below warnings after so much processor time without another."""

    def __init__(self) -> None:
        super().__init__()
        self._last = time.process_time()

    def emit(self, record: logging.LogRecord) -> None:
        now = time.process_time()
        if record.levelno < logging.WARNING and now - self._last < _QUIET:
            return
        self._last = now
        print(f"stylobate: {record.getMessage()}", file=sys.stderr, flush=True)


# Processor time that a computation may take without a line [s].
_QUIET = 4.0


class _OnConsole(logging.Handler):
    """Prints records above the line that moves."""

    def __init__(self, console: "Console") -> None:
        super().__init__(logging.WARNING)
        self._console = console

    def emit(self, record: logging.LogRecord) -> None:
        self._console.print(f"stylobate: {record.getMessage()}", soft_wrap=True)


@contextmanager
def _handled_by(handler: logging.Handler) -> Iterator[None]:
    """Let this handler alone print what the library logs."""
    log = logging.getLogger("stylobate")
    before = log.handlers[:], log.level
    log.handlers = [handler]
    log.setLevel(logging.INFO)
    try:
        yield
    finally:
        log.handlers = before[0]
        log.setLevel(before[1])
