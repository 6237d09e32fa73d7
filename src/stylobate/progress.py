"""Progress of long computations: a bar on a terminal or in a notebook, once they take more than two seconds.

A public function with the argument `progress` is decorated by `shows_progress`. The outermost function that runs shows
the bar; the functions that it calls report to it alone. Without a terminal or a notebook, in other threads, and in
processes that Python started, nothing is shown.
"""

import io
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import wraps
from importlib import import_module
from typing import TYPE_CHECKING, Any, NamedTuple, ParamSpec, TypeVar

from stylobate.errors import Interrupted, ParameterError, refuse_unknown_arguments
from stylobate.text import four_digits

if TYPE_CHECKING:
    from rich.console import Console
    from rich.progress import Progress as RichProgress

_P = ParamSpec("_P")
_T = TypeVar("_T")

Report = Callable[..., None]
"""A function that is called with the progress, most often as `report(done, total)`."""
Progress = Report | bool | None
"""The argument `progress`: a function to call; False for nothing; by default a bar."""

DUE = 2.0
"""Time from which a computation shows a bar [s]."""

# Time between two pictures in a notebook [s], and the width of the bar there [columns].
_PAUSE, _WIDTH = 0.2, 100

_running: list[Report] = []
"""Reports of the functions that run in the main thread, the outermost first."""
_quiet = False


class News(NamedTuple):
    """Progress of a computation: what it computes now, the state in words, how much is done and of how much."""

    what: str
    state: str
    done: float
    total: float | None


def counted(done: int, total: int) -> News:
    """Read a report of how many are done, and of how many."""
    return News("", f"{done}/{total}", done, total)


def in_parts(what: str, done: int, total: int) -> News:
    """Read a report with the name of the present part."""
    return News(what, f"{100 * done // max(total, 1)} %", done, total)


def at_value(*values: float) -> News:
    """Read a report of the present values of parameters; how far they go is not known."""
    return News("", f"at {', '.join(map(four_digits, values))}", 0, None)


def silent(*_: object) -> None:
    """Show no progress."""


def shows_progress(what: str, read: Callable[..., News] = counted) -> Callable[[Callable[_P, _T]], Callable[_P, _T]]:
    """Show a bar while a function runs, unless its argument `progress` is False or a function; a decorator.

    Parameters
    ----------
    what
        Name of the computation beside the bar.
    read
        Reads the arguments with which the function reports its progress.
    """

    def decorated(function: Callable[_P, _T]) -> Callable[_P, _T]:
        @wraps(function)
        def reporting(*arguments: _P.args, **named: _P.kwargs) -> _T:
            refuse_unknown_arguments(function, named)
            with _report(what, read, named.get("progress")) as report:
                named["progress"] = report
                return function(*arguments, **named)

        return reporting

    return decorated


def report_of(progress: Progress) -> Report:
    """Return the function to which a function with `progress` reports."""
    return progress if callable(progress) else silent


def beat() -> None:
    """Show the bar of the computation if it is due, also before its first report."""
    if _running and isinstance(_running[0], _Bar):
        _running[0].beat()


def never() -> None:
    """Show no bars in this process."""
    global _quiet  # noqa: PLW0603  one for the process
    _quiet = True


@contextmanager
def _report(what: str, read: Callable[..., News], progress: object) -> Iterator[Report]:
    if not (callable(progress) or progress is None or isinstance(progress, bool)):
        raise ParameterError(
            f"progress: no function (got {progress!r}). Pass one, False for no progress, or leave it out."
        )
    if threading.current_thread() is not threading.main_thread():
        yield report_of(progress)
        return
    shown = (progress is None or progress is True) and not _running and _place()
    bar = _Bar(what, read) if shown else None
    report = report_of(progress) if bar is None else bar
    outermost = not _running
    _running.append(report)
    try:
        yield report
    except KeyboardInterrupt as stop:
        if isinstance(stop, Interrupted) or not outermost:
            raise
        raise Interrupted(f"{what}: interrupted, and nothing is kept; `partial` is None", None) from stop
    finally:
        _running.pop()
        if bar is not None:
            bar.close()


def _place() -> str:
    """Return the place for a bar: "notebook", "terminal", or "" for none."""
    started = sys.modules.get("multiprocessing.process")
    if _quiet or (started is not None and started.parent_process() is not None):
        return ""
    shell = getattr(sys.modules.get("IPython"), "get_ipython", lambda: None)()
    if hasattr(shell, "kernel"):
        return "notebook"
    return "terminal" if sys.stderr is not None and sys.stderr.isatty() else ""


class _Bar:
    """A bar that appears when it is due; rich, which draws it, is imported then.

    On a terminal a timer draws it, since imports and compilation before the first run report nothing.
    """

    def __init__(self, what: str, read: Callable[..., News]) -> None:
        self._what, self._read, self._begun = what, read, time.monotonic()
        self._news = News("", "", 0, None)
        self._drawn: _Drawn | None = None
        self._lock, self._closed = threading.RLock(), False
        self._timer = threading.Timer(DUE, self.beat)
        self._timer.daemon = True
        if _place() == "terminal":
            self._timer.start()

    def __call__(self, *news: Any) -> None:
        self._news = self._read(*news)
        self.beat()

    def beat(self) -> None:
        """Draw the bar if it is due."""
        with self._lock:
            if not self._closed:
                self._draw()

    def _draw(self) -> None:
        news = self._news._replace(what=self._news.what or self._what)
        if self._drawn is None and time.monotonic() - self._begun >= DUE:
            # In a thread, because an import that Ctrl-C interrupts may leave modules half imported.
            imported = threading.Thread(target=import_module, args=("rich.progress",))
            imported.start()
            imported.join()
            self._drawn = (_InNotebook if _place() == "notebook" else _OnTerminal)(news)
        if self._drawn is not None:
            self._drawn.update(news)

    def close(self) -> None:
        """Remove the bar."""
        self._timer.cancel()
        with self._lock:
            self._closed = True
            if self._drawn is not None:
                self._drawn.close()


class _Drawn:
    """A bar of rich: what is computed, the bar, how much is done, and the time that remains."""

    def __init__(self, news: News, console: "Console") -> None:
        from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

        what, state = (TextColumn(f"{{task.{name}}}", markup=False) for name in ("description", "fields[state]"))
        # What the program prints on stdout stays there.
        self.bar: RichProgress = Progress(
            what, BarColumn(), state, TimeRemainingColumn(), console=console, transient=True, redirect_stdout=False
        )
        self.task = self.bar.add_task(news.what, total=None, state=news.state)

    def update(self, news: News) -> None:
        """Set the progress."""
        self.bar.update(self.task, description=news.what, completed=news.done, total=news.total, state=news.state)

    def close(self) -> None:
        """Remove the bar."""
        self.bar.stop()


class _OnTerminal(_Drawn):
    """A bar on the last line of a terminal; text on stderr appears above it."""

    def __init__(self, news: News) -> None:
        from rich.console import Console

        super().__init__(news, Console(stderr=True, markup=False, highlight=False))
        self.bar.start()


class _InNotebook(_Drawn):
    """A bar as text in the output of a cell, which is replaced; it needs no widgets."""

    def __init__(self, news: News) -> None:
        from rich.console import Console

        self._page = io.StringIO()
        super().__init__(news, Console(file=self._page, width=_WIDTH, force_jupyter=False, color_system=None))
        self._shown = 0.0
        display: Any = import_module("IPython.display").display
        self._handle = display({"text/plain": ""}, raw=True, display_id=True)

    def update(self, news: News) -> None:
        """Set the progress, and draw it again after a pause."""
        super().update(news)
        if time.monotonic() - self._shown >= _PAUSE:
            self._shown = time.monotonic()
            self._page.seek(0)
            self._page.truncate()
            self.bar.console.print(self.bar.get_renderable())
            self._handle.update({"text/plain": self._page.getvalue().rstrip()}, raw=True)

    def close(self) -> None:
        """Remove the bar."""
        self._handle.update({"text/plain": ""}, raw=True)
