"""Messages from worker processes to the server, during a computation and at its end."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

Emit = Callable[[Any], None]


@dataclass(frozen=True, slots=True)
class Ready:
    """The process has started and waits for tasks."""


@dataclass(frozen=True, slots=True)
class Found:
    """A partial result."""

    value: Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class Progress:
    """Number of completed runs, and of all runs."""

    done: int
    total: int


@dataclass(frozen=True, slots=True)
class Note:
    """One line about the state of the computation, such as the compilation of a kernel."""

    line: str


@dataclass(frozen=True, slots=True)
class Finished:
    """The task is done."""

    result: Any


@dataclass(frozen=True, slots=True)
class Refused:
    """The task is refused, with one line for each reason."""

    problems: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Lost:
    """The worker process ended before its answer, with this exit code; a signal's number is negative."""

    exit_code: int | None

    @property
    def problem(self) -> str:
        """One line with the problem and the remedy."""
        how = f" by signal {-self.exit_code}" if self.exit_code is not None and self.exit_code < 0 else ""
        return (
            f"the worker process was ended{how} from outside before it answered, possibly because memory ran out. "
            "Make the record, the duration or the grid smaller, or try again."
        )


@dataclass(frozen=True, slots=True)
class Broken:
    """The task failed because of an internal error; the traceback is for developers."""

    trace: str
