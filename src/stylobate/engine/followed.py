"""One run through the kernels, with the trace of its motion and its events."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from stylobate.engine.ensembles.batch import Batch, Plan
from stylobate.engine.ensembles.broadcasting import Runs
from stylobate.engine.lanes.columns import STATE, TRACE_ROOM, TRACE_TERMS, Log, Setup, Status, Trace, TraceKind
from stylobate.engine.trajectory import Trajectory
from stylobate.results import Event

Floats = npt.NDArray[np.float64]

TRACES = 1000 + TRACE_ROOM
"""Entries of a trace that are kept before they are taken out and progress is reported."""

_EVENTS = {
    TraceKind.RELEASE: "release",
    TraceKind.REST: "rest",
    TraceKind.IMPACT: "impact",
    TraceKind.PASSAGE: "passage",
}
_LAST_EVENTS = {
    Status.OVERTURNED: "overturned",
    Status.LIMIT: "limit",
    Status.LIFTED: "lifted",
    Status.STEP_LIMIT: "failed",
    Status.STEP_TOO_SMALL: "failed",
    Status.UNSEEN: "failed",
}


@dataclass(frozen=True, slots=True)
class Followed:
    """A run that was followed to its end: as a batch of one, its motion, and its events."""

    batch: Batch
    trajectory: Trajectory
    events: tuple[Event, ...]

    @classmethod
    def of(
        cls, plan: Plan, run: Runs, carried: tuple[float, ...], paused: Callable[[float, float], None]
    ) -> "Followed":
        """Follow the only run of `run`.

        Parameters
        ----------
        plan, run
            As for ensembles; the plan keeps a trace.
        carried
            What is carried along, at the start.
        paused
            Called as `paused(steps, time [s])` whenever the trace is full.
        """
        batch = Batch.of(plan, run)
        batch.advance(np.zeros(1, dtype=np.uint8), paused)
        entries = np.concatenate([*batch.traces, np.empty((0, plan.layout.trace_width))])
        happened = entries[:, Trace.KIND] >= TraceKind.RELEASE
        stretches = entries[~happened] if not happened.all() else _nothing_moved(batch)
        line = batch.table[0, [Setup.LINE_X, Setup.LINE_Y]].tolist()
        end = float(batch.log(Log.TIME)[0])
        trajectory = Trajectory(plan.model, stretches, (line[0], line[1]), carried, end)
        scale = plan.model.time_scale
        events = [Event(_EVENTS[TraceKind(int(entry[0]))], entry[1] * scale) for entry in entries[happened]]
        last = _LAST_EVENTS.get(Status(int(batch.log(Log.STATUS)[0])))
        if last is not None:
            events.append(Event(last, end * scale))
        return cls(batch, trajectory, tuple(events))

    @property
    def status(self) -> Status:
        """Why the run ended."""
        return Status(int(self.batch.log(Log.STATUS)[0]))

    def log(self, column: Log) -> float:
        """Return what the kernel noted."""
        return float(self.batch.log(column)[0])


def _nothing_moved(batch: Batch) -> Floats:
    """Return the stretch of a run that ended where it began."""
    entry = np.zeros((1, batch.plan.layout.trace_width))
    entry[0, Trace.KIND] = TraceKind.PLANE_STEP if batch.planar[0] else TraceKind.STEP
    entry[0, Trace.LENGTH] = 1.0
    states = (entry.shape[1] - len(Trace)) // TRACE_TERMS
    entry[0, len(Trace) : len(Trace) + states] = batch.table[0, STATE : STATE + states]
    return entry
