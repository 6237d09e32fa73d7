"""Integration of one run: simulate, from its arguments to a response."""

import math
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, replace
from functools import partial
from typing import Any, Unpack

import numpy as np
import numpy.typing as npt

from stylobate.base_motions import BASE_AT_REST, BaseMotion
from stylobate.engine.cost import EVERY, LOG, announce, expected_steps, report, step_limit, unseen
from stylobate.engine.ensembles.batch import Batch, Plan
from stylobate.engine.ensembles.late import Late
from stylobate.engine.ensembles.results import late_periods, results_of
from stylobate.engine.ensembles.run_columns import MotionPlan
from stylobate.engine.ensembles.runs import EnsembleRuns, one_run
from stylobate.engine.forcing import check_motion, is_rest, without_dust
from stylobate.engine.history import contact_measures, contact_warnings, history
from stylobate.engine.kernel.columns import EVENTS_AT, STATE, TRACE_TERMS, Log, Setup, Trace
from stylobate.engine.kernel.driver.events import EventSetup, RunStatus, TraceKind
from stylobate.engine.starts import (
    RunStart,
    Turning,
    refuse_friction,
    require_below_level,
    require_nouns,
    require_plane,
)
from stylobate.engine.tolerances import CLOSE_PASSAGE, OVERTURNED_TILT
from stylobate.engine.trajectory import EventFunction, Trajectory, checked_events, own_events
from stylobate.engine.verdict import (
    AFTER_END,
    BEFORE_END,
    FALLEN,
    FIRST_DIGIT,
    MANY_PASSAGES,
    MOST_PERIODS,
    MOVING,
    OPEN,
    SAFE,
    UNSETTLED,
    VERDICTS,
    duration_needed,
    duration_of,
    reason_on,
    steady_periods,
    survival,
)
from stylobate.errors import Outcome, UnsupportedError, require_vector
from stylobate.models import Model
from stylobate.provenance import provenance_of_run
from stylobate.results import Event, OutcomeRules, Run
from stylobate.run_arguments import Accuracy, EnsembleOptions, SingleRun, arguments_of, checked_options, takes
from stylobate.text import plural

Floats = npt.NDArray[np.float64]


@takes(SingleRun)
def simulate(
    model: Model,
    motion: BaseMotion | None = None,
    *,
    events: Sequence[EventFunction | Callable[[float, dict[str, Any]], float]] = (),
    **run: Unpack[SingleRun],
) -> Run:
    """Integrate one column from its initial state until its outcome is decided.

    The run is integrated by DOP853 (Hairer, Nørsett, Wanner, "Solving Ordinary Differential Equations I") between
    events: uplift, rest, overturning, the tilt limit, lift-off. If initial state and base motion lie in one vertical
    plane to 8 ulp, the run is integrated in that plane. A kernel is compiled at the first use of a model; steps,
    outcome and measures equal those of `simulate_ensemble` to the bit.

    Parameters
    ----------
    model
        Model of the column, such as `Slender(column, damping=0.1)`.
    motion
        Base motion; None for a base at rest.
    **run
    events
        Event functions, as `EventFunction` or plain functions of time and state with the optional attributes
        `direction` and `terminal`. Their zeros are recorded in `Run.events`; a terminal one ends the run, which
        has the outcome STOPPED. Files keep the events, not the functions.

    Returns
    -------
    Run
        Outcome and history. OVERTURNED is proved by the no-return criterion of the model if it has one.

    Raises
    ------
    ParameterError
        If an argument is out of range, or there is no `duration` and the base motion neither ends nor has a period.

    Examples
    --------
    >>> import stylobate as sb
    >>> model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
    >>> sb.simulate(model, tilt=(0.05, 0.0), duration=150.0).outcome
    <Outcome.AT_REST: 'at rest'>
    >>> shaking = sb.Harmonic.circular(acceleration=0.15, angular_frequency=0.5)
    >>> sb.simulate(model, shaking, duration=50.0).outcome
    <Outcome.OVERTURNED: 'overturned'>
    """
    require_nouns(model, motion)
    moved = BASE_AT_REST if motion is None else motion
    leaning = without_dust(np.array(_pair("tilt", run["tilt"], "rad")))
    require_below_level(leaning)
    x, y = leaning.tolist()
    start_tilt = (x, y)
    start_rate = _pair("tilt_rate", run["tilt_rate"], "rad/s")
    at_rest = bool(is_rest(start_tilt, start_rate, model.column.slenderness, model.time_scale))
    turning = Turning.checked(model, run, standing=at_rest)
    friction_coefficient = arguments_of(SingleRun)["friction_coefficient"].checked(run["friction_coefficient"])
    refuse_friction(model, friction_coefficient)
    samples = arguments_of(SingleRun)["samples"].checked(run["samples"])
    options = checked_options({**run, "samples": None, "recheck": False})
    rules = options["rules"] or OutcomeRules()
    duration = duration_of(run["duration"], model, moved, rules)
    functions = checked_events(events)
    if at_rest:
        start_tilt = start_rate = (0.0, 0.0)
    require_plane(model, moved, start_tilt, start_rate)

    def followed_to(duration: float) -> RunResult:
        check_motion(moved, duration)
        frequency = moved.highest_frequency * model.time_scale
        announce(expected_steps(model, frequency, duration / model.time_scale), options["max_steps"])
        return run_result(model, moved, options, RunStart(start_tilt, start_rate, duration, turning), functions)

    result = followed_to(duration)
    if run["duration"] is None and moved.duration == math.inf:
        result, duration = _decided(result, duration, followed_to, MOST_PERIODS * (moved.period or 0.0))
    recorded = history(model, moved, result.trajectory, samples, friction_coefficient=friction_coefficient)
    knife_edges = contact_warnings(model, result.measures) if model.switches else ()
    changes, doubts = result.repeated() if run["recheck"] else (False, ())
    return Run(
        outcome=result.outcome,
        reason=result.reason,
        decided_at=result.decided_at,
        uncertain=result.uncertain or changes,
        planar=result.planar,
        data=recorded.data,
        events=result.events,
        warnings=(*recorded.warnings, *doubts, *knife_edges),
        thresholds={"close_passage": CLOSE_PASSAGE, **result.thresholds, **asdict(rules)},
        measures={**result.measures, **recorded.measures},
        provenance=provenance_of_run(
            model,
            moved,
            tilt=start_tilt,
            tilt_rate=start_rate,
            **turning.values(),
            duration=duration,
            friction_coefficient=friction_coefficient,
            **{name: options[name] for name in Accuracy.__annotations__},  # type: ignore[literal-required]
            samples=samples,
            recheck=bool(run["recheck"]),
        )
        | {"atol": result.atol, "rules": asdict(rules)},
        sampler=recorded.sampler,
    )


def _pair(name: str, value: Sequence[float], unit: str) -> tuple[float, float]:
    x, y = require_vector(name, value, 2, unit)
    return x, y


@dataclass(frozen=True, slots=True, kw_only=True)
class RunResult:
    """Result of a run.

    Parameters
    ----------
    outcome, reason, decided_at, uncertain, planar, events, thresholds, measures
        As in a `Run`.
    trajectory
        Motion of the column.
    atol
        Absolute tolerance [rad].
    needed
        Duration that suffices for an outcome of a run that moves at its end [s]; 0 if it is decided.
    repeated
        Repeats a run in doubt; returns whether the outcome changes, and warnings.
    """

    outcome: Outcome
    reason: str
    decided_at: float
    uncertain: bool
    planar: bool
    events: tuple[Event, ...]
    thresholds: dict[str, float]
    measures: dict[str, float]
    trajectory: Trajectory
    atol: float
    needed: float
    repeated: Callable[[], tuple[bool, tuple[str, ...]]]


def _decided(
    result: RunResult, duration: float, follow: Callable[[float], RunResult], most: float
) -> tuple[RunResult, float]:
    """Follow a run of `duration`, whose `result` is given, until its outcome is decided, at `most` to that time [s].

    Returns the result with its duration; a longer run that fails does not count.
    """
    while duration < result.needed and duration < most:
        longer = min(result.needed, most)
        again = follow(longer)
        if again.outcome is Outcome.FAILED:
            break
        result, duration = again, longer
    return result, duration


def run_result(
    model: Model, motion: BaseMotion, options: EnsembleOptions, start: RunStart, functions: Sequence[EventFunction]
) -> RunResult:
    """Compute a run by the kernels of ensembles, and return its result."""
    run = one_run(start)
    plan = Plan(model, MotionPlan.of(motion, {}, run.duration), options)

    def paused(steps: float, time: float) -> None:
        report(int(steps), options["max_steps"], time, start.duration)

    try:
        followed = Followed.of(plan, run, paused)
    except UnsupportedError as error:
        LOG.warning("%s", error)
        plan = replace(plan, plain=True)
        followed = Followed.of(plan, run, paused)
    own, stopped_at = own_events(functions, model, motion, followed.trajectory)
    whole = None
    if stopped_at is not None:
        whole = followed.trajectory
        run = one_run(replace(start, duration=stopped_at))
        followed = Followed.of(plan, run, paused)
    arrays = {name: values[0] for name, values in results_of(followed.batch).items()}
    outcome = Outcome(int(arrays["outcome"]))
    reason = reason_of(model, motion, followed, outcome)
    if stopped_at is not None:
        outcome, reason = Outcome.STOPPED, f"its event {own[-1].kind!r} ended the run"
    events = tuple(sorted([*own, *followed.events], key=lambda event: event.time))
    table = followed.batch.table[0]
    trajectory = followed.trajectory if whole is None else whole.until(followed.trajectory.end)
    return RunResult(
        outcome=outcome,
        reason=reason,
        decided_at=float(arrays["decided_at"]),
        uncertain=bool(arrays["uncertain"]),
        planar=bool(arrays["planar"]),
        events=events,
        thresholds={
            "passage_tilt": model.loss_tilt,
            "no_return_tilt": model.least_safe_tilt(*bounds_of(followed)),
            "rest_energy": float(followed.batch.rest_energy[0]),
            "rest_energy_for_good": float(table[Setup.REST_ENERGY_FOR_GOOD]),
            "tilt_limit": float(table[EVENTS_AT + EventSetup.TILT_LIMIT]),
            "overturned_tilt": OVERTURNED_TILT,
        },
        measures={
            "peak_tilt": float(arrays["peak_tilt"]),
            "peak_tilt_over_c": float(arrays["peak_tilt"]) / model.column.slenderness,
            "time_of_peak_tilt": float(arrays["time_of_peak_tilt"]),
            "minimum_tilt": float(arrays["minimum_tilt"]),
            "turns": float(arrays["turns"]),
            "steps": float(arrays["steps"]),
            "least_passage": followed.log(Log.CLOSEST_PASSAGE),
            "impacts": float(sum(event.kind == "impact" for event in events)),
            **late_measures(followed),
            **(contact_measures(arrays, motion, trajectory) if model.switches else {}),
        },
        trajectory=trajectory,
        atol=float(table[Setup.ATOL]),
        needed=_needed(motion, followed) if outcome is Outcome.STILL_MOVING else 0.0,
        repeated=partial(_repeated, plan, run, outcome, float(arrays["peak_tilt"]))
        if stopped_at is None and (arrays["in_doubt"] or _irregular(outcome, trajectory, events))
        else _not_repeated,
    )


def _irregular(outcome: Outcome, trajectory: Trajectory, events: Sequence[Event]) -> bool:
    """Return whether the column passed the vertical so often that its peak tilt may depend on the tolerance."""
    passages = trajectory.half_turns + sum(event.kind in ("passage", "impact") for event in events)
    return outcome in UNSETTLED and passages > MANY_PASSAGES


def _not_repeated() -> tuple[bool, tuple[str, ...]]:
    return False, ()


def _repeated(plan: Plan, run: EnsembleRuns, outcome: Outcome, peak: float) -> tuple[bool, tuple[str, ...]]:
    """Repeat a run in doubt; return whether the outcome changes, with warnings about outcome and peak tilt."""
    again = plan.repeated()
    batch = Batch.of(again, run)
    batch.advance(np.zeros(1, dtype=np.uint8))
    found = results_of(batch)
    other, other_peak = Outcome(int(found["outcome"][0])), float(found["peak_tilt"][0])
    if other is Outcome.FAILED:
        return False, ()
    passage = float(batch.table[0, Setup.PASSAGE_TILT])
    finer = f"passage_tilt {passage:.2g}, " if passage > 0.0 and not batch.planar[0] else ""
    settings = f"with {finer}rest_energy {float(batch.rest_energy[0]):.2g} and rtol {again.options['rtol']:.2g} it is"
    changed = (other in FALLEN) != (outcome in FALLEN)
    if changed:
        return True, (f"the outcome depends on the settings of the integration: {settings} {other.name}",)
    if outcome in FALLEN or abs(other_peak - peak) < FIRST_DIGIT * peak:
        return False, ()
    return False, (f"peak_tilt {peak:.2g} rad has no certain digit: {settings} {other_peak:.2g} rad",)


@dataclass(frozen=True, slots=True)
class Followed:
    """Finished run: its batch of one, its motion, its events, and the measures of its last periods.

    `last_guard` is the index of the guard of the last contact change; −1 for none.
    """

    batch: Batch
    trajectory: Trajectory
    events: tuple[Event, ...]
    late: Floats
    last_guard: int

    @classmethod
    def of(cls, plan: Plan, run: EnsembleRuns, paused: Callable[[float, float], None]) -> "Followed":
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
        named.append((RunStatus(int(batch.log(Log.STATUS)[0])).event, end))
        events = tuple(Event(name, time * scale) for name, time in named if name)
        changes = entries[entries[:, Trace.KIND] == TraceKind.CONTACT]
        last_guard = int(changes[-1, len(Trace)]) if len(changes) else -1
        return cls(batch, trajectory, events, late_periods(batch)[0], last_guard)

    @property
    def status(self) -> RunStatus:
        """Status at the end of the run."""
        return RunStatus(int(self.batch.log(Log.STATUS)[0]))

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


_STOPS = ", {left:.4g} s before the base motion stops; it may still be uplifted: follow it longer"


_RACING = (
    "; it passes the vertical so closely that the contact point runs fast round the rim, and no passage loses energy: "
    "set restitution below 1"
)


# Passages through the vertical closer than this take many steps [units of c].
_RACES = 1e-3


def reason_texts() -> dict[str, Any]:
    """Return the reasons of outcomes as texts, with gaps for numbers, for a page that states them without Python."""
    return {
        "grounds": [reason for _, reason in VERDICTS.values()],
        "statuses": [one.reason for one in RunStatus],
        "final_events": [one.event for one in RunStatus],
        "trace_events": [one.event for one in TraceKind],
        "upright": {outcome.name: text for outcome, text in _UPRIGHT.items()},
        "stands": [f"it stands, and the base motion to come {_STANDS[switches]}" for switches in (False, True)],
        "stands_at_end": "it stands at the end of the run",
        "unproved": _UNPROVED,
        "stopped": "the integration stopped: ",
        "step_limit": step_limit(0).replace(" 0", " {most}"),
        "unseen": unseen(0).replace(" 0", " {most}"),
        "racing": _RACING,
        "moving": MOVING,
        "open": OPEN,
        "before_end": BEFORE_END,
        "after_end": AFTER_END,
        "safe": SAFE,
        "standing_before_end": _STOPS,
    }


def reason_of(model: Model, motion: BaseMotion, followed: Followed, outcome: Outcome) -> str:
    """Return the reason of the `outcome` of a run."""
    status = followed.status
    if outcome is Outcome.FAILED:
        return f"the integration stopped: {_failure(model, followed)}{_RACING if _races(model, followed) else ''}"
    if outcome is Outcome.OVERTURNED and math.isinf(model.least_safe_tilt(*bounds_of(followed))):
        return _UNPROVED
    if status is RunStatus.RESTED:
        return f"it stands, and the base motion to come {_STANDS[model.switches]}"
    return status.reason or _UPRIGHT.get(outcome) or _at_its_end(model, motion, followed, outcome)


def _at_its_end(model: Model, motion: BaseMotion, followed: Followed, outcome: Outcome) -> str:
    """Return the reason of the outcome of a run that reached its duration."""
    if outcome is Outcome.AT_REST:
        return _standing(model, motion, followed)
    if outcome in (Outcome.STILL_MOVING, Outcome.SURVIVED) and math.isfinite(motion.duration):
        return survival(model, motion, followed.trajectory)[1]
    return reason_on(followed.late, followed.batch.plan.rules, motion.period or 0.0)


def _needed(motion: BaseMotion, followed: Followed) -> float:
    """Return the duration that suffices for an outcome of a run that moves at its end [s]; 0 without a period."""
    if motion.period is None or followed.status is not RunStatus.STOPPED:
        return 0.0
    return duration_needed(followed.late, followed.batch.plan.rules, motion.period)


def _failure(model: Model, followed: Followed) -> str:
    """Return the reason of a failed integration."""
    most = int(followed.batch.plan.options["max_steps"])
    match followed.status:
        case RunStatus.STEP_LIMIT:
            return step_limit(most)
        case RunStatus.UNSEEN:
            return unseen(most)
        case RunStatus.ENDLESS:
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
    stops = _STOPS.format(left=left) if to_come else ""
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
    span, turned = float(late[Late.SPAN]), float(late[Late.TURNED])
    if math.isnan(span):
        return {}
    scale = followed.trajectory.model.time_scale
    measures = {
        "mean_rolling_rate": 2.0 * math.pi * turned / (span * scale),
        "repetition": float(late[Late.RETURNS]),
        "repeats_after": float(late[Late.REPEATS_AFTER]),
        "mean_tilt_late": float(late[Late.MEAN_TILT]),
        "minimum_tilt_late": float(late[Late.MINIMUM_TILT]),
        "peak_tilt_late": _peak_tilt(followed),
    }
    if late[Late.HELD] >= steady_periods(followed.batch.plan.rules):
        measures["modulation_change"] = abs(math.expm1(float(late[Late.CHANGE_SLOPE] * late[Late.CHANGE_WINDOW])))
        measures["rolling_rate_error"] = abs(float(late[Late.LAG_SLOPE]))
    return measures


# Samples per period for the peak tilt in the last periods.
_SAMPLES = 64


def _peak_tilt(followed: Followed) -> float:
    trajectory, periods = followed.trajectory, followed.batch.plan.rules.periods
    tau = np.linspace(trajectory.end - float(followed.late[Late.SPAN]), trajectory.end, periods * _SAMPLES + 1)
    return float(np.hypot(*trajectory.model.tilt(trajectory.own_states(tau))).max())
