"""Messages of the laboratory's processes to the server, during a computation and at its end."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

Emit = Callable[[Any], None]


@dataclass(frozen=True, slots=True)
class Ready:
    """The process has started and waits for tasks."""


@dataclass(frozen=True, slots=True)
class Found:
    """Something found on the way."""

    value: Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class Progress:
    """So many of all runs are done."""

    done: int
    total: int


@dataclass(frozen=True, slots=True)
class Note:
    """One line about what goes on, such as that a kernel is compiled."""

    line: str


@dataclass(frozen=True, slots=True)
class Finished:
    """The task is done."""

    result: Any


@dataclass(frozen=True, slots=True)
class Refused:
    """The task cannot be done, one line for each reason."""

    problems: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Lost:
    """The process that computed ended before it answered, with this exit code; a signal's number is negative."""

    exit_code: int | None

    @property
    def problem(self) -> str:
        """One line that says what happened and what to try."""
        how = f" by signal {-self.exit_code}" if self.exit_code is not None and self.exit_code < 0 else ""
        return (
            f"the worker process was ended{how} from outside before it answered, possibly because memory ran out. "
            "Make the record, the duration or the grid smaller, or try again."
        )


@dataclass(frozen=True, slots=True)
class Broken:
    """The task failed by a mistake of the program's own; the traceback is for its developers."""

    trace: str
