"""Integration of one run: simulate."""

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, replace
from functools import partial
from typing import Any, Unpack

import numpy as np

from stylobate.base_motions import BASE_AT_REST, BaseMotion
from stylobate.engine.cost import LOG, announce, expected_steps, report
from stylobate.engine.ensembles.batch import Batch, Plan
from stylobate.engine.ensembles.run_columns import MotionPlan
from stylobate.engine.ensembles.runs import Runs, one_run
from stylobate.engine.ensembles.summaries import summaries
from stylobate.engine.followed import Followed, bounds_of, late_measures, reason_of
from stylobate.engine.forcing import check_motion, is_rest, without_dust
from stylobate.engine.history import contact_measures, contact_warnings, history
from stylobate.engine.kernel.columns import EVENTS_AT, Log, Setup
from stylobate.engine.kernel.driver.events import EventSetup
from stylobate.engine.starts import Start, Turning, refuse_friction, require_below_level, require_nouns, require_plane
from stylobate.engine.tolerances import CLOSE_PASSAGE, OVERTURNED_TILT
from stylobate.engine.trajectory import Trajectory
from stylobate.engine.user_events import EventFunction, checked_events, own_events
from stylobate.engine.verdict import FALLEN, FIRST_DIGIT, MANY_PASSAGES, UNSETTLED, duration_of
from stylobate.errors import Outcome, UnsupportedError, require_vector
from stylobate.models import Model
from stylobate.provenance import provenance_of_run
from stylobate.results import Event, OutcomeRules, Response
from stylobate.run_arguments import Accuracy, EnsembleOptions, SingleRun, arguments_of, checked_options, takes


@takes(SingleRun)
def simulate(
    model: Model,
    motion: BaseMotion | None = None,
    *,
    events: Sequence[EventFunction | Callable[[float, dict[str, Any]], float]] = (),
    **run: Unpack[SingleRun],
) -> Response:
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
        `direction` and `terminal`. Their zeros are recorded in `Response.events`; a terminal one ends the run, which
        has the outcome STOPPED. Files keep the events, not the functions.

    Returns
    -------
    Response
        Outcome and history. OVERTURNED is proved by the no-return criterion of the model if it has one.

    Raises
    ------
    ParameterError
        If an argument is out of range, or there is no `duration` and the base motion does not end.

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
    at_rest = bool(is_rest(np.array(start_tilt), np.array(start_rate), model.column.slenderness, model.time_scale))
    turning = Turning.checked(model, run, standing=at_rest)
    friction_coefficient = arguments_of(SingleRun)["friction_coefficient"].checked(run["friction_coefficient"])
    refuse_friction(model, friction_coefficient)
    duration = duration_of(run["duration"], model, moved)
    samples = arguments_of(SingleRun)["samples"].checked(run["samples"])
    options = checked_options({**run, "samples": None, "recheck": False})
    rules = options["rules"] or OutcomeRules()
    check_motion(moved, duration)
    functions = checked_events(events)
    if at_rest:
        start_tilt = start_rate = (0.0, 0.0)
    require_plane(model, moved, start_tilt, start_rate)
    announce(
        expected_steps(model, moved.highest_frequency * model.time_scale, duration / model.time_scale),
        options["max_steps"],
    )
    result = run_result(model, moved, options, Start(start_tilt, start_rate, duration, turning), functions)
    recorded = history(model, moved, result.trajectory, samples, friction_coefficient=friction_coefficient)
    knife_edges = contact_warnings(model, result.measures) if model.switches else ()
    changes, doubts = result.repeated() if run["recheck"] else (False, ())
    return Response(
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
    model: Model, motion: BaseMotion, options: EnsembleOptions, start: Start, functions: Sequence[EventFunction]
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
