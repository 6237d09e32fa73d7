"""Messages of a worker process: those during a computation, and the answer at its end."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

OUT_OF_MEMORY = "out of memory: make the record, the duration or the grid smaller"

# Messages during a computation


@dataclass(frozen=True, slots=True)
class Ready:
    """The process has started and waits for tasks."""


@dataclass(frozen=True, slots=True)
class Found:
    """A partial result."""

    value: Any


@dataclass(frozen=True, slots=True)
class Progress:
    """Number of completed runs, and of all runs."""

    done: int
    total: int


@dataclass(frozen=True, slots=True)
class Note:
    """One line about the state of the computation, such as the compilation of a kernel."""

    line: str


Message = Found | Progress | Note
Emit = Callable[[Message], None]

# Answers


@dataclass(frozen=True, slots=True)
class Finished:
    """The task is done."""

    result: Any


@dataclass(frozen=True, slots=True)
class Refused:
    """The task is refused, with one line for each reason."""

    problems: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Broken:
    """The task failed because of an internal error; the traceback is for developers."""

    trace: str


@dataclass(frozen=True, slots=True)
class Lost:
    """The process ended before its answer, with this exit code, if known; a signal's number is negative."""

    exit_code: int | None = None

    @property
    def problem(self) -> str:
        """One line with the problem and the remedy."""
        how = f" by signal {-self.exit_code}" if self.exit_code is not None and self.exit_code < 0 else ""
        return (
            f"the worker process was ended{how} from outside before it answered, possibly because memory ran out. "
            "Make the record, the duration or the grid smaller, or try again."
        )


Answer = Finished | Refused | Broken | Lost
