"""Progress of an assessment on stderr: what is computed or drawn, and what the library tells."""

import logging
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def parts_done() -> Iterator[Callable[[str, int, int], None]]:
    """Give a function that shows what is done, and how much of the work; a line each without a terminal."""
    from rich.console import Console  # noqa: PLC0415  heavy imports wait until the options are read
    from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeRemainingColumn  # noqa: PLC0415

    console = Console(stderr=True, markup=False, highlight=False)
    columns = (TextColumn("{task.description}"), BarColumn(), TaskProgressColumn(), TimeRemainingColumn())
    with (
        Progress(*columns, console=console, transient=True, disable=not sys.stderr.isatty()) as bar,
        _told(lambda line: console.print(f"stylobate: {line}", soft_wrap=True)),
    ):
        task = bar.add_task("assessment", total=None)
        said: list[str] = []

        def advance(what: str, done: int, total: int) -> None:
            bar.update(task, description=what, completed=done, total=total)
            if not sys.stderr.isatty() and said[-1:] != [what]:
                said.append(what)
                print(f"stylobate: {what} ({100 * done // max(total, 1)} % done)", file=sys.stderr)

        yield advance


@contextmanager
def _told(tell: Callable[[str], None]) -> Iterator[None]:
    """Tell what is logged, remarks that are no warnings too."""
    log, handler = logging.getLogger("stylobate"), _Telling(tell)
    before = log.level
    log.addHandler(handler)
    log.setLevel(logging.INFO)
    try:
        yield
    finally:
        log.setLevel(before)
        log.removeHandler(handler)


class _Telling(logging.Handler):
    def __init__(self, tell: Callable[[str], None]) -> None:
        super().__init__()
        self._tell = tell

    def emit(self, record: logging.LogRecord) -> None:
        self._tell(record.getMessage())
