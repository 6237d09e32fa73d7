"""Background jobs: progress, events, cancellation, and removal of abandoned jobs."""

import json
import logging
import secrets
import time
import traceback
from collections import OrderedDict
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import anyio
from anyio.abc import TaskGroup

from stylobate.lab import messages, pool
from stylobate.lab.answers import Job, JobState
from stylobate.lab.limits import Limits, RefusedError
from stylobate.text import plural

_log = logging.getLogger("stylobate.lab")

_KEPT, _MOST_KEPT = ("exact",), 32
"""Kinds of jobs that take long and have short results, which are kept for the same question, and how many are."""

_OPEN: tuple[JobState, ...] = ("waiting", "running")


@dataclass(slots=True)
class Work:
    """The task of a job, its state and its events."""

    kind: str
    identity: str = field(default_factory=lambda: secrets.token_urlsafe(12))
    state: JobState = "waiting"
    done: int = 0
    total: int = 0
    note: str = ""
    events: list[Any] = field(default_factory=list)
    problems: tuple[str, ...] = ()
    result: Any = None
    asked_at: float = field(default_factory=time.monotonic)
    scope: anyio.CancelScope = field(default_factory=anyio.CancelScope)

    def heard(self, message: messages.Message) -> None:
        """Process a message during the computation."""
        self.state = "running"
        match message:
            case messages.Found(value):
                self.events.append(value)
            case messages.Progress(done, total):
                self.done, self.total = done, total
            case messages.Note(line):
                self.note = line

    def end(self, answer: messages.Answer) -> None:
        """Process the answer at the end of the task."""
        self.note = ""
        match answer:
            case messages.Finished(result):
                self.state, self.result = "done", result
            case messages.Refused(problems):
                self.state, self.problems = "failed", problems
            case messages.Lost():
                self.state, self.problems = "failed", (answer.problem,)
            case messages.Broken(trace):
                self.state, self.problems = "failed", (broken(trace),)


@dataclass(slots=True)
class Jobs:
    """All jobs; they run in `processes`, in tasks of `group`."""

    processes: pool.Pool
    limits: Limits
    group: TaskGroup
    _known: dict[str, Work] = field(default_factory=dict)
    _kept: "OrderedDict[str, Any]" = field(default_factory=OrderedDict)

    def __getitem__(self, identity: str) -> Work:
        if identity not in self._known:
            raise RefusedError(404, ["this job does not exist (any more). Begin it again."])
        return self._known[identity]

    def begin(self, kind: str, values: Mapping[str, Any]) -> str:
        """Begin a new job and return its identity.

        Raises
        ------
        RefusedError
            If too many jobs wait.
        """
        waiting = sum(one.state == "waiting" for one in self._known.values())
        if waiting >= self.limits.waiting:
            raise RefusedError(429, [f"{waiting} jobs are already waiting. Cancel one, or try again when one is done."])
        job = Work(kind)
        self._known[job.identity] = job
        asked = json.dumps([kind, values], sort_keys=True, default=repr)
        if asked in self._kept:
            self._kept.move_to_end(asked)
            job.end(messages.Finished(self._kept[asked]))
        else:
            self.group.start_soon(self._run, job, values, asked)
        return job.identity

    def report(self, identity: str, after: int | None = None) -> Job:
        """Return the state of a job, with the events from the number `after` on, or none."""
        job = self[identity]
        job.asked_at = time.monotonic()
        ahead = 0
        for one in self._known.values():
            if one is job:
                break
            ahead += one.state in _OPEN
        waits = f"waits for {plural(ahead, 'other job')}" if job.state == "waiting" and ahead else ""
        return Job(
            id=identity,
            kind=job.kind,
            state=job.state,
            done=job.done,
            total=job.total,
            note=waits or job.note,
            events=[] if after is None else job.events[after:],
            next=len(job.events),
            problems=list(job.problems),
            result=None if isinstance(job.result, bytes) else job.result,
        )

    def cancel(self, identity: str) -> None:
        """Cancel the job unless it has ended."""
        job = self[identity]
        if job.state in _OPEN:
            job.state = "cancelled"
            job.scope.cancel()

    async def watch(self) -> None:
        """Remove abandoned jobs periodically; never returns."""
        while True:
            await anyio.sleep(min(5.0, self.limits.abandoned / 2.0))
            for job in list(self._known.values()):
                if time.monotonic() - job.asked_at > self.limits.abandoned:
                    self.cancel(job.identity)
                    del self._known[job.identity]

    async def _run(self, job: Work, values: Mapping[str, Any], asked: str) -> None:
        with job.scope:
            try:
                answer = await self.processes.perform(job.kind, values, job.heard)
            except Exception:  # noqa: BLE001  a mistake in one job must not end the others
                answer = messages.Broken(traceback.format_exc())
            job.end(answer)
            if job.kind in _KEPT and job.state == "done":
                self._kept[asked] = job.result
                if len(self._kept) > _MOST_KEPT:
                    self._kept.popitem(last=False)


def broken(trace: str) -> str:
    """Log the traceback of a mistake in the program, and return the line that reports it."""
    _log.error(trace)
    last = trace.strip().splitlines()[-1]
    return f"internal error of the laboratory: {last}. Please report it with the link of this page."
