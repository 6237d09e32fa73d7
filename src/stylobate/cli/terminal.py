"""What a command writes on stderr while it computes, and how Ctrl-C and SIGTERM end it."""

import logging
import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any

from stylobate.text import printable

INTERRUPTED = 130
"""Exit status of a program that Ctrl-C ended."""
NOT_READ = 141
"""Exit status of a program whose output is no longer read: 128 and the number of SIGPIPE."""

_IMPORTING = "<frozen importlib"


def say(text: str) -> None:
    """Print `text` on stdout; what a terminal would obey, such as an escape in a name, is replaced."""
    print(printable(text))


def remark(text: str) -> None:
    """Print a line of the program itself on stderr; what a terminal would obey is replaced."""
    print(f"stylobate: {printable(text)}", file=sys.stderr, flush=True)


@contextmanager
def interrupted_by_signals() -> Iterator[None]:
    """Raise KeyboardInterrupt for Ctrl-C and SIGTERM; during an import end the program with one line."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    with _handled(signal.SIGINT, signal.default_int_handler), _handled(signal.SIGTERM, signal.SIG_DFL):
        yield


@contextmanager
def _handled(number: signal.Signals, usual: Any) -> Iterator[None]:
    if signal.getsignal(number) is not usual:
        yield  # the caller handles this signal in another way
        return
    signal.signal(number, _interrupt)
    try:
        yield
    finally:
        if signal.getsignal(number) is _interrupt:
            signal.signal(number, usual)


def _interrupt(number: int, frame: FrameType | None) -> None:
    if _is_importing(frame):
        os.write(2, b"stylobate: interrupted\n")
        os._exit(INTERRUPTED)
    signal.default_int_handler(number, frame)


def _is_importing(frame: FrameType | None) -> bool:
    while frame is not None:
        if frame.f_code.co_filename.startswith(_IMPORTING):
            return True
        frame = frame.f_back
    return False


def part_lines() -> Callable[[str, int, int], None] | None:
    """Return a function that prints the name of each part of an assessment; None on a terminal, which shows a bar."""
    if sys.stderr.isatty():
        return None
    last = ""

    def advance(what: str, done: int, total: int) -> None:
        nonlocal last
        if what != last:
            remark(f"{what} ({100 * done // max(total, 1)} % done)")
        last = what

    return advance


def section_lines() -> Callable[[str, int, int, float], None] | None:
    """Return a function that prints each section of the paper's check; None on a terminal, which shows a bar."""
    if sys.stderr.isatty():
        return None
    moments = list[tuple[float, float]]()

    def advance(heading: str, done: int, total: int, fraction: float) -> None:
        moments.append((time.monotonic(), fraction))
        remark(f"{done}/{total}{remaining(moments)}{heading and ': '}{heading}")

    return advance


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


# Processor time between lines [s].
_QUIET = 4.0


@contextmanager
def log_lines(quiet: float = _QUIET) -> Iterator[None]:
    """Print the library's warnings on stderr, and its other messages after `quiet` processor seconds without a line."""
    log = logging.getLogger("stylobate")
    before = log.handlers[:], log.level
    log.handlers = [_Lines(quiet)]
    log.setLevel(logging.INFO)
    try:
        yield
    finally:
        log.handlers = before[0]
        log.setLevel(before[1])


class _Lines(logging.Handler):
    """Print records one per line."""

    def __init__(self, quiet: float) -> None:
        super().__init__()
        self._quiet, self._last = quiet, time.process_time()

    def emit(self, record: logging.LogRecord) -> None:
        now = time.process_time()
        if record.levelno < logging.WARNING and now - self._last < self._quiet:
            return
        self._last = now
        remark(record.getMessage())
