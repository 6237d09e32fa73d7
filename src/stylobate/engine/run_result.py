"""Result of a single run: outcome, reason, motion, events and measures."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from stylobate.base_motions import BaseMotion
from stylobate.engine.contact_measures import contact_measures
from stylobate.engine.doubt import FALLEN, FIRST_DIGIT, MANY_PASSAGES, UNSETTLED
from stylobate.engine.ensembles.batch import Batch, Plan
from stylobate.engine.ensembles.broadcasting import Runs, one_run
from stylobate.engine.ensembles.motion_columns import MotionPlan
from stylobate.engine.ensembles.summaries import summaries
from stylobate.engine.followed import Followed
from stylobate.engine.kernel.columns import EVENTS_AT, Log, Setup
from stylobate.engine.kernel.driver.events import EventSetup
from stylobate.engine.pace import LOG, report
from stylobate.engine.reasons import bounds_of, late_measures, reason_of
from stylobate.engine.starts import Start
from stylobate.engine.tolerances import OVERTURNED_TILT
from stylobate.engine.trajectory import Trajectory
from stylobate.engine.user_events import EventFunction, own_events
from stylobate.errors import Outcome, UnsupportedError
from stylobate.models import Model
from stylobate.results import Event
from stylobate.run_arguments import Options


@dataclass(frozen=True, slots=True, kw_only=True)
class RunResult:
    """Result of a run.

    Parameters
    ----------
    outcome, reason, decided_at, uncertain, planar, events, thresholds, measures
        As in a `Response`.
    trajectory
        Motion of the column.
    atol
        Absolute tolerance [rad].
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
    repeated: Callable[[], tuple[bool, tuple[str, ...]]]


def run_result(
    model: Model, motion: BaseMotion, options: Options, start: Start, functions: Sequence[EventFunction]
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
    arrays = {name: values[0] for name, values in summaries(followed.batch).items()}
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


def _repeated(plan: Plan, run: Runs, outcome: Outcome, peak: float) -> tuple[bool, tuple[str, ...]]:
    """Repeat a run in doubt; return whether the outcome changes, with warnings about outcome and peak tilt."""
    again = plan.repeated()
    batch = Batch.of(again, run)
    batch.advance(np.zeros(1, dtype=np.uint8))
    found = summaries(batch)
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
