"""Progress of long work on stderr: a line that moves on a terminal, and what the library warns of."""

import logging
import sys
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
        _warnings_on(console),
    ):
        task = bar.add_task(what, total=None, rate="")

        def advance(done: int, total: int) -> None:
            bar.update(task, completed=done, total=total)
            speed = bar.tasks[0].speed
            bar.update(task, rate=f"{speed:.0f} runs/s" if speed else "")

        yield advance


class _OnConsole(logging.Handler):
    """Prints records above the line that moves."""

    def __init__(self, console: "Console") -> None:
        super().__init__()
        self._console = console

    def emit(self, record: logging.LogRecord) -> None:
        self._console.print(f"stylobate: {record.getMessage()}", soft_wrap=True)


@contextmanager
def _warnings_on(console: "Console") -> Iterator[None]:
    log, handler = logging.getLogger("stylobate"), _OnConsole(console)
    log.addHandler(handler)
    try:
        yield
    finally:
        log.removeHandler(handler)
