"""Ctrl-C and SIGTERM: both raise KeyboardInterrupt, so that completed work is saved.

During an import both end the program with one line instead, since no work is lost yet: Python raises
KeyboardInterrupt at any point of the program, and an import may catch it, or leave a module half imported.
"""

import os
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any

INTERRUPTED = 130
"""Exit status of a program that Ctrl-C ended."""

_IMPORTING = "<frozen importlib"


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
