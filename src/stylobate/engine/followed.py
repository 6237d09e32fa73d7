"""Computation of one run by the kernels, with the trace of its motion and its events."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from stylobate.engine.ensembles.batch import Batch, Plan
from stylobate.engine.ensembles.broadcasting import Runs
from stylobate.engine.ensembles.outcomes import Late, late_periods
from stylobate.engine.kernel.columns import STATE, TRACE_TERMS, Log, Setup, Trace
from stylobate.engine.kernel.driver.events import Status, TraceKind
from stylobate.engine.pace import EVERY
from stylobate.engine.starts import Turning
from stylobate.engine.trajectory import Trajectory
from stylobate.models import Model
from stylobate.results import Event

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Followed:
    """Finished run: its batch of one, its motion, its events, and the measures of its last periods.

    `last_guard` is the index of the guard of the last contact change; −1 for none.
    """

    batch: Batch
    trajectory: Trajectory
    events: tuple[Event, ...]
    late: Late
    last_guard: int

    @classmethod
    def of(cls, plan: Plan, run: Runs, paused: Callable[[float, float], None]) -> "Followed":
        """Compute the only run of `run`.

        Parameters
        ----------
        plan, run
            Plan and run as for ensembles.
        paused
            Called as `paused(steps, time [s])` whenever the trace is full.
        """
        plan = plan if plan.traces else replace(plan, traces=EVERY + plan.layout.trace_room)
        batch = Batch.of(plan, run)
        batch.advance(np.zeros(1, dtype=np.uint8), paused)
        entries = np.concatenate([*batch.traces, np.empty((0, plan.layout.trace_width))])
        batch.traces.clear()  # saves memory for long runs
        happened = entries[:, Trace.KIND] >= TraceKind.RELEASE
        stretches = entries[~happened] if not happened.all() else _nothing_moved(batch)
        line = batch.table[0, [Setup.LINE_X, Setup.LINE_Y]].tolist()
        end = float(batch.log(Log.TIME)[0])
        carried = (run.turning or Turning()).carried(plan.model)
        trajectory = Trajectory(plan.model, stretches, (line[0], line[1]), carried, end)
        scale = plan.model.time_scale
        named = [(_event_in(plan.model, entry), float(entry[Trace.START])) for entry in entries[happened]]
        named.append((Status(int(batch.log(Log.STATUS)[0])).event, end))
        events = tuple(Event(name, time * scale) for name, time in named if name)
        changes = entries[entries[:, Trace.KIND] == TraceKind.CONTACT]
        last_guard = int(changes[-1, len(Trace)]) if len(changes) else -1
        return cls(batch, trajectory, events, late_periods(batch), last_guard)

    @property
    def status(self) -> Status:
        """Status at the end of the run."""
        return Status(int(self.batch.log(Log.STATUS)[0]))

    def log(self, column: Log) -> float:
        """Return a column of the log of the kernel."""
        return float(self.batch.log(column)[0])


def _event_in(model: Model, entry: Floats) -> str:
    """Return the name of the event of an entry; "" for none."""
    kind = TraceKind(int(entry[Trace.KIND]))
    if kind is not TraceKind.CONTACT:
        return kind.event
    number, before, after = entry[len(Trace) : len(Trace) + 3].astype(int).tolist()
    return model.event_of(model.guard_names[number], before, after)


def _nothing_moved(batch: Batch) -> Floats:
    """Return the only trace entry of a run that ended at its start."""
    entry = np.zeros((1, batch.plan.layout.trace_width))
    entry[0, Trace.KIND] = TraceKind.PLANE_STEP if batch.planar[0] else TraceKind.STEP
    entry[0, Trace.LENGTH] = 1.0
    states = (entry.shape[1] - len(Trace)) // TRACE_TERMS
    entry[0, len(Trace) : len(Trace) + states] = batch.table[0, STATE : STATE + states]
    return entry
