"""Computation of one run by the kernels: trace of its motion, events, measures and reason of its outcome."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from stylobate.base_motions import BaseMotion
from stylobate.engine.cost import EVERY, step_limit, unseen
from stylobate.engine.ensembles.batch import Batch, Plan
from stylobate.engine.ensembles.runs import Runs
from stylobate.engine.ensembles.summaries import Late, grounds_of, late_periods
from stylobate.engine.kernel.columns import STATE, TRACE_TERMS, Log, Setup, Trace
from stylobate.engine.kernel.driver.events import Status, TraceKind
from stylobate.engine.starts import Turning
from stylobate.engine.trajectory import Trajectory
from stylobate.engine.verdict import Ground, reason_on, steady_periods, survival
from stylobate.errors import Outcome
from stylobate.models import Model
from stylobate.results import Event
from stylobate.text import plural

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
        carried = (run.turning[0] if run.turning else Turning()).carried(plan.model)
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


_STANDS = {True: "can neither tip nor move it", False: "cannot uplift it"}
_UPRIGHT = {
    Outcome.SLID: "it stands upright, and its base face slides on the plane to the end",
    Outcome.LIFTED_OFF: "it stays upright over the last periods, and leaves the plane again and again",
}
_UNPROVED = "its tilt reached π/2, which counts as overturned"
_RELEASED = "it may still be uplifted: follow it longer"
_RACING = (
    "; it passes the vertical so closely that the contact point runs fast round the rim, and no passage loses energy: "
    "set restitution below 1"
)
# Passages through the vertical closer than this take many steps [units of c].
_RACES = 1e-3


def reason_of(model: Model, motion: BaseMotion, followed: Followed, outcome: Outcome) -> str:
    """Return the reason of the `outcome` of a run."""
    status = followed.status
    if outcome is Outcome.FAILED:
        return f"the integration stopped: {_failure(model, followed)}{_RACING if _races(model, followed) else ''}"
    if outcome is Outcome.OVERTURNED and math.isinf(model.least_safe_tilt(*bounds_of(followed))):
        return _UNPROVED
    if status is Status.RESTED:
        return f"it stands, and the base motion to come {_STANDS[model.switches]}"
    return status.reason or _UPRIGHT.get(outcome) or _at_its_end(model, motion, followed, outcome)


def _at_its_end(model: Model, motion: BaseMotion, followed: Followed, outcome: Outcome) -> str:
    """Return the reason of the outcome of a run that reached its duration."""
    if outcome is Outcome.AT_REST:
        return _standing(model, motion, followed)
    if outcome in (Outcome.STILL_MOVING, Outcome.SURVIVED) and math.isfinite(motion.duration):
        return survival(model, motion, followed.trajectory)[1]
    ground = Ground(int(grounds_of(followed.batch, followed.late)[0]))
    return reason_on(ground, followed.late.evidence, followed.batch.plan.rules, motion.period or 0.0)


def _failure(model: Model, followed: Followed) -> str:
    """Return the reason of a failed integration."""
    most = int(followed.batch.plan.options["max_steps"])
    match followed.status:
        case Status.STEP_LIMIT:
            return step_limit(most)
        case Status.UNSEEN:
            return unseen(most)
        case Status.ENDLESS:
            planar = followed.log(Log.THREE_DIMENSIONAL) == 0.0
            remedy = "; it moves in exactly one vertical plane: pass a tilt out of it" if planar else ""
            return f"its contact changes without end ({model.guard_names[followed.last_guard]}){remedy}"
        case status:
            return status.reason


def _standing(model: Model, motion: BaseMotion, followed: Followed) -> str:
    releases = int(followed.log(Log.RELEASES))
    before = f", uplifted {plural(releases, 'time')} before" if releases else ""
    left = motion.duration - followed.trajectory.end * model.time_scale
    to_come = math.isfinite(left) and left > 0.0
    stops = f", {left:.4g} s before the base motion stops; {_RELEASED}" if to_come else ""
    return f"it stands at the end of the run{before}{stops}"


def _races(model: Model, followed: Followed) -> bool:
    """Return whether close passages explain the number of steps, and the model could have a loss but has none."""
    lossless = model.impact_map is not None and model.loss_tilt == 0.0
    return lossless and followed.log(Log.CLOSEST_PASSAGE) < _RACES * model.column.slenderness


def bounds_of(followed: Followed) -> tuple[float, float]:
    """Return sup |a_h| and inf a_z [g] of a whole run."""
    motions = followed.batch.motions
    return float(motions.largest[0]), float(motions.minimum_vertical[0])


def late_measures(followed: Followed) -> dict[str, float]:
    """Return the measures of the last periods if these were completed."""
    late = followed.late
    if np.isnan(late.span[0]):
        return {}
    scale = followed.trajectory.model.time_scale
    measures = {
        "mean_rolling_rate": 2.0 * math.pi * float(late.turned[0] / (late.span[0] * scale)),
        "repetition": float(late.repetition[0]),
        "repeats_after": float(late.repeats_after[0]),
        "mean_tilt_late": float(late.mean_tilt[0]),
        "minimum_tilt_late": float(late.minimum_tilt[0]),
        "peak_tilt_late": _peak_tilt(followed),
    }
    if late.evidence is not None and late.evidence.held[0] >= steady_periods(followed.batch.plan.rules):
        change, lag = late.evidence.change, late.evidence.lag
        measures["modulation_change"] = abs(math.expm1(float(change.slope[0] * change.window[0])))
        measures["rolling_rate_error"] = abs(float(lag.slope[0]))
    return measures


# Samples per period for the peak tilt in the last periods.
_SAMPLES = 64


def _peak_tilt(followed: Followed) -> float:
    trajectory, periods = followed.trajectory, followed.batch.plan.rules.periods
    tau = np.linspace(trajectory.end - float(followed.late.span[0]), trajectory.end, periods * _SAMPLES + 1)
    return float(np.hypot(*trajectory.model.tilt(trajectory.states(tau))).max())
