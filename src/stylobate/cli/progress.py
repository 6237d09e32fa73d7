"""Progress of long computations on stderr: a progress bar on a terminal, and the warnings of the library."""

import logging
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rich.console import Console
    from rich.progress import ProgressColumn, Task


@contextmanager
def runs_done(what: str) -> Iterator[Callable[[int, int], None]]:
    """Yield a function that shows completed runs and all runs, with their rate and the remaining time.

    If stderr is not a terminal, only warnings are printed, one per line.
    """
    from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeRemainingColumn  # noqa: PLC0415

    columns = (BarColumn(), MofNCompleteColumn(), TextColumn("{task.fields[rate]}"), TimeRemainingColumn())
    with _bar(what, *columns, rate="") as update:

        def advance(done: int, total: int) -> None:
            task = update(completed=done, total=total)
            update(rate=f"{task.speed:.0f} runs/s" if task.speed else "")

        yield advance


@contextmanager
def parts_done() -> Iterator[Callable[[str, int, int], None]]:
    """Yield a function that shows the current part of an assessment, and the fraction that is complete.

    If stderr is not a terminal, each part is a line.
    """
    from rich.progress import BarColumn, TaskProgressColumn, TimeRemainingColumn  # noqa: PLC0415

    columns = (BarColumn(), TaskProgressColumn(), TimeRemainingColumn())
    with _bar("assessment", *columns, level=logging.INFO) as update:
        last = ""

        def advance(what: str, done: int, total: int) -> None:
            nonlocal last
            update(description=what, completed=done, total=total)
            if not sys.stderr.isatty() and what != last:
                print(f"stylobate: {what} ({100 * done // max(total, 1)} % done)", file=sys.stderr)
            last = what

        yield advance


@contextmanager
def sections_done() -> Iterator[Callable[[str, int, int, float], None]]:
    """Yield a function that shows the completed sections of the paper's check; a line each without a terminal."""
    from rich.progress import BarColumn, TextColumn, TimeElapsedColumn  # noqa: PLC0415

    name, moments = "checking the paper", list[tuple[float, float]]()
    with _bar(
        name, BarColumn(), TextColumn("{task.fields[state]}"), TimeElapsedColumn(), total=1.0, state=""
    ) as update:

        def advance(heading: str, done: int, total: int, fraction: float) -> None:
            moments.append((time.monotonic(), fraction))
            state = f"{done}/{total}{remaining(moments)}"
            update(completed=fraction, description=heading or name, state=state)
            if not sys.stderr.isatty():
                print(f"stylobate: {state}{heading and ': '}{heading}", file=sys.stderr)

        yield advance


def remaining(moments: list[tuple[float, float]]) -> str:
    """Describe the remaining time, from moments [s] and the completed fraction of the work at each.

    >>> remaining([(0.0, 0.25), (10.0, 0.5)])
    ', about 20 s remaining'
    >>> remaining([(0.0, 0.25)]), remaining([(0.0, 0.25), (10.0, 1.0)])
    ('', '')
    """
    (begun, before), (now, done) = moments[0], moments[-1]
    if not before < done < 1.0:
        return ""
    return f", about {(now - begun) * (1.0 - done) / (done - before):.0f} s remaining"


@contextmanager
def _bar(
    what: str, *columns: "ProgressColumn", level: int = logging.WARNING, total: float | None = None, **fields: Any
) -> Iterator[Callable[..., "Task"]]:
    """Yield a function that updates a progress bar; the library's records from a `level` up are printed above it."""
    from rich.console import Console  # noqa: PLC0415  heavy imports wait until the options are read
    from rich.progress import Progress, TextColumn  # noqa: PLC0415

    console, text = Console(stderr=True, markup=False, highlight=False), TextColumn("{task.description}")
    shown = Progress(text, *columns, console=console, transient=True, disable=not sys.stderr.isatty())
    with shown as bar, _handled_by(_OnConsole(console, level)):
        task = bar.add_task(what, total=total, **fields)

        def update(**changes: Any) -> "Task":
            bar.update(task, **changes)
            return bar.tasks[0]

        yield update


@contextmanager
def log_lines() -> Iterator[None]:
    """Print the library's warnings on stderr, and one line of its progress reports every few seconds."""
    with _handled_by(_Lines()):
        yield


class _Lines(logging.Handler):
    """Print records one per line; print reports below warnings only after some processor time without a line."""

    def __init__(self) -> None:
        super().__init__()
        self._last = time.process_time()

    def emit(self, record: logging.LogRecord) -> None:
        now = time.process_time()
        if record.levelno < logging.WARNING and now - self._last < _QUIET:
            return
        self._last = now
        print(f"stylobate: {record.getMessage()}", file=sys.stderr, flush=True)


# Processor time between lines [s].
_QUIET = 4.0


class _OnConsole(logging.Handler):
    """Print records above the progress bar."""

    def __init__(self, console: "Console", level: int) -> None:
        super().__init__(level)
        self._console = console

    def emit(self, record: logging.LogRecord) -> None:
        self._console.print(f"stylobate: {record.getMessage()}", soft_wrap=True)


@contextmanager
def _handled_by(handler: logging.Handler) -> Iterator[None]:
    """Print the library's log records through this handler only."""
    log = logging.getLogger("stylobate")
    before = log.handlers[:], log.level
    log.handlers = [handler]
    log.setLevel(logging.INFO)
    try:
        yield
    finally:
        log.handlers = before[0]
        log.setLevel(before[1])
