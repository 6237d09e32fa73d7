"""Background jobs: progress, events, cancellation, and removal of abandoned jobs."""

import logging
import secrets
import time
import traceback
from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum
from itertools import takewhile
from typing import Any

import anyio
from anyio.abc import TaskGroup

from stylobate.lab.limits import Limits, RefusedError
from stylobate.lab.pool import Answer, Broken, Finished, Found, Lost, Message, Note, Pool, Progress, Refused
from stylobate.text import plural

_log = logging.getLogger("stylobate.lab")


class State(Enum):
    """State of a job."""

    WAITING = "waiting"
    RUNNING = "running"
    DONE = "done"
    FAILED = "failed"
    CANCELLED = "cancelled"


_OPEN = (State.WAITING, State.RUNNING)


@dataclass(slots=True)
class Job:
    """A task of some `kind`, its state and its events."""

    kind: str
    identity: str = field(default_factory=lambda: secrets.token_urlsafe(12))
    state: State = State.WAITING
    done: int = 0
    total: int = 0
    note: str = ""
    events: list[Mapping[str, Any]] = field(default_factory=list)
    problems: tuple[str, ...] = ()
    result: Any = None
    asked_at: float = field(default_factory=time.monotonic)
    scope: anyio.CancelScope = field(default_factory=anyio.CancelScope)

    def heard(self, message: Message) -> None:
        """Process a message during the computation."""
        self.state = State.RUNNING
        match message:
            case Found(value):
                self.events.append(value)
            case Progress(done, total):
                self.done, self.total = done, total
            case Note(line):
                self.note = line

    def end(self, answer: Answer) -> None:
        """Process the answer at the end of the task."""
        self.note = ""
        match answer:
            case Finished(result):
                self.state, self.result = State.DONE, result
            case Refused(problems):
                self.state, self.problems = State.FAILED, problems
            case Lost():
                self.state, self.problems = State.FAILED, (answer.problem,)
            case Broken(trace):
                _log.error(trace)
                self.state, self.problems = State.FAILED, (broken(trace),)

    def report(self, after: int, ahead: int) -> dict[str, Any]:
        """Describe the job in plain values: events from the number `after` on, `ahead` jobs before it in the queue."""
        self.asked_at = time.monotonic()
        waits = f"waits for {plural(ahead, 'other job')}" if self.state is State.WAITING and ahead else ""
        return {
            "id": self.identity,
            "kind": self.kind,
            "state": self.state.value,
            "done": self.done,
            "total": self.total,
            "note": waits or self.note,
            "events": self.events[after:],
            "next": len(self.events),
            "problems": list(self.problems),
            "result": None if isinstance(self.result, bytes) else self.result,
        }


@dataclass(slots=True)
class Jobs:
    """All jobs; they run in `pool`, in tasks of `group`."""

    pool: Pool
    limits: Limits
    group: TaskGroup
    _known: dict[str, Job] = field(default_factory=dict)

    def __getitem__(self, identity: str) -> Job:
        if identity not in self._known:
            raise RefusedError(404, ["this job does not exist (any more). Begin it again."])
        return self._known[identity]

    def begin(self, kind: str, values: Mapping[str, Any]) -> Job:
        """Begin a new job and return it.

        Raises
        ------
        RefusedError
            If too many jobs wait.
        """
        waiting = sum(job.state is State.WAITING for job in self._known.values())
        if waiting >= self.limits.waiting:
            raise RefusedError(429, [f"{waiting} jobs are already waiting. Cancel one, or try again when one is done."])
        job = Job(kind)
        self._known[job.identity] = job
        self.group.start_soon(self._run, job, values)
        return job

    def report(self, identity: str, after: int) -> dict[str, Any]:
        """Return the state of a job as plain values, with the events from the number `after` on."""
        job = self[identity]
        earlier = takewhile(lambda one: one is not job, self._known.values())
        return job.report(after, sum(one.state in _OPEN for one in earlier))

    def cancel(self, identity: str) -> Job:
        """Cancel the job unless it has ended, and return it."""
        job = self[identity]
        if job.state in _OPEN:
            job.state = State.CANCELLED
            job.scope.cancel()
        return job

    async def watch(self) -> None:
        """Remove abandoned jobs periodically; never returns."""
        while True:
            await anyio.sleep(min(5.0, self.limits.abandoned / 2.0))
            for job in list(self._known.values()):
                if time.monotonic() - job.asked_at > self.limits.abandoned:
                    self.cancel(job.identity)
                    del self._known[job.identity]

    async def _run(self, job: Job, values: Mapping[str, Any]) -> None:
        with job.scope:
            try:
                answer: Answer = await self.pool.perform(job.kind, values, job.heard)
            except Exception:  # noqa: BLE001  a mistake in one job must not end the others
                answer = Broken(traceback.format_exc())
            job.end(answer)


def broken(trace: str) -> str:
    """Return the line that reports a mistake in the program."""
    last = trace.strip().splitlines()[-1]
    return f"internal error of the laboratory: {last}. Please report it with the link of this page."
