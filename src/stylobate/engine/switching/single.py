"""Single runs of models that change between kinds of contact."""

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace

import numpy as np
from scipy.optimize import minimize_scalar

from stylobate.base_motions import BaseMotion
from stylobate.engine.doubt import FALLEN, finer_rest, in_doubt, other_tolerance
from stylobate.engine.ensembles.options import Options
from stylobate.engine.forcing import Floats, Forcing
from stylobate.engine.history import default_count
from stylobate.engine.run_result import RunResult
from stylobate.engine.starts import Start
from stylobate.engine.switching.course import SwitchingCourse
from stylobate.engine.switching.following import Method, Reason
from stylobate.engine.switching.pieces import Trajectory
from stylobate.engine.switching.verdict import Account, switching_verdict
from stylobate.engine.thresholds import Thresholds, rest_is_coarse, thresholds_of
from stylobate.engine.tolerances import ATOL_SHARE, CLOSE_PASSAGE, RTOL_RANGE
from stylobate.engine.user_events import EventFunction
from stylobate.engine.verdict import Verdict
from stylobate.errors import MOST_STEPS, Outcome, ParameterError, require_positive, require_whole
from stylobate.models import Model
from stylobate.results import OutcomeRules


def switching_result(
    model: Model, motion: BaseMotion, options: Options, start: Start, functions: Sequence[EventFunction]
) -> RunResult:
    """Follow a run, and return what became of it."""
    method = method_of(model, motion, options.rtol, options.atol, options.max_steps)
    forcing = Forcing.of(model, motion)
    thresholds = thresholds_of(model, forcing, options.tilt_limit, options.rest_energy)
    end = start.duration / model.time_scale
    run = _Run(model, forcing, replace(method, end=end), thresholds, end, options.rules, tuple(functions))
    state = start.turning.begun(model, start.tilt, start.tilt_rate)
    course, verdict = run.follow(state)
    count = default_count(model, motion, course.trajectory.end)
    measures = _measures(model, course.trajectory, np.linspace(0.0, course.trajectory.end, count))
    bounds = forcing.largest_horizontal(0.0), forcing.least_vertical(0.0)
    return RunResult(
        outcome=verdict.outcome,
        reason=verdict.reason,
        decided_at=_decided_at(course, verdict, start.duration),
        uncertain=_is_uncertain(model, forcing, course, thresholds),
        planar=course.planar,
        events=tuple(course.events),
        thresholds={
            "passage_tilt": model.loss_tilt,
            "no_return_tilt": model.least_safe_tilt(*bounds),
            **asdict(thresholds),
        },
        measures={
            **measures,
            "least_passage": course.least_passage,
            "impacts": float(sum(event.kind == "impact" for event in course.events)),
            **verdict.measures,
            **Account.of(course).measures,
        },
        trajectory=course.trajectory,  # type: ignore[arg-type]
        atol=method.atol,
        repeated=lambda: run.repeated_otherwise(state, course, verdict, measures["largest_tilt"]),
    )


@dataclass(frozen=True, slots=True)
class _Run:
    """A run but for its initial state: how it is followed, and repeated with other numbers if it is in doubt."""

    model: Model
    forcing: Forcing
    method: Method
    thresholds: Thresholds
    stop: float
    rules: OutcomeRules
    events: tuple[EventFunction, ...]

    def follow(self, state: tuple[float, ...]) -> tuple[SwitchingCourse, Verdict]:
        """Integrate from `state` to the end."""
        model, forcing, motion = self.model, self.forcing, self.forcing.motion
        switching = SwitchingCourse(model, forcing, self.method, self.thresholds, self.stop, self.events)
        switching.follow(state)
        return switching, _stopped(switching) or switching_verdict(model, motion, switching, self.rules)

    def repeated_otherwise(
        self, state: tuple[float, ...], course: SwitchingCourse, verdict: Verdict, largest_tilt: float
    ) -> tuple[str, ...]:
        """Repeat a run in doubt; return a warning if it then has another outcome."""
        overturned = verdict.outcome in FALLEN
        doubtful = in_doubt(
            overturned=overturned,
            decided=course.trajectory.end,
            largest_tilt=largest_tilt,
            released_again=course.released_from_rest,
            slenderness=self.model.column.slenderness,
        )
        if verdict.outcome in (Outcome.FAILED, Outcome.STOPPED) or not doubtful:
            return ()
        rtol = other_tolerance(self.method.rtol)
        method = replace(self.method, rtol=rtol, atol=self.method.atol * (rtol / self.method.rtol))
        other = replace(self, method=method, thresholds=finer_rest(self.thresholds))
        outcome = other.follow(state)[1].outcome
        if outcome is not Outcome.FAILED and (outcome in FALLEN) == overturned:
            return ()
        return (
            f"the outcome depends on numbers of the integration: with rest_energy {other.thresholds.rest_energy:.2g} "
            f"and rtol {rtol:.2g} it is {outcome.name}",
        )


def _stopped(course: SwitchingCourse) -> Verdict | None:
    if course.ended is not Reason.TERMINATED:
        return None
    return Verdict(Outcome.STOPPED, f"its event {course.events[-1].kind!r} ended the run", {})


def _is_uncertain(model: Model, forcing: Forcing, course: SwitchingCourse, thresholds: Thresholds) -> bool:
    close = course.least_passage < CLOSE_PASSAGE * model.column.slenderness
    coarse = course.released_from_rest and rest_is_coarse(model, forcing, thresholds.rest_energy)
    return close or coarse or course.ended is Reason.FAILED


def _decided_at(course: SwitchingCourse, verdict: Verdict, duration: float) -> float:
    if verdict.outcome is Outcome.AT_REST and course.ended is Reason.RESTED:
        return course.pieces[-1].start * course.model.time_scale
    if course.ended is Reason.STOP:
        return duration
    return course.trajectory.end * course.model.time_scale


def method_of(model: Model, motion: BaseMotion, rtol: float, atol: float | None, max_steps: int) -> Method:
    """Return how a run is integrated, its options checked."""
    low, high = RTOL_RANGE
    rtol = require_positive("rtol", rtol)
    if not low <= rtol <= high:
        message = f"rtol must lie between {low!r} and {high!r}, got {rtol!r}"
        raise ParameterError(message)
    atol = ATOL_SHARE * rtol * model.column.slenderness if atol is None else require_positive("atol", atol, "rad")
    max_steps = require_whole("max_steps", max_steps, least=1, most=MOST_STEPS)
    # Half the shortest period: no step can miss the forcing.
    frequency = motion.highest_frequency * model.time_scale
    return Method(
        rtol=rtol, atol=atol, max_step=math.pi / frequency if frequency > 0.0 else math.inf, max_steps=max_steps
    )


def _measures(model: Model, trajectory: Trajectory, tau: Floats) -> dict[str, float]:
    amplitude = np.hypot(*model.tilt(trajectory.states(tau)))
    largest, when = _largest_tilt(model, trajectory, amplitude, tau)
    moving = [piece.azimuths for piece in trajectory.pieces if piece.azimuths.size]
    return {
        "largest_tilt": largest,
        "largest_tilt_over_c": largest / model.column.slenderness,
        "time_of_largest_tilt": when * model.time_scale,
        "least_tilt": float(amplitude.min()),
        "turns": float(moving[-1][-1] - moving[0][0]) / (2.0 * math.pi) if moving else 0.0,
        "steps": float(trajectory.steps),
    }


def _largest_tilt(model: Model, trajectory: Trajectory, amplitude: Floats, tau: Floats) -> tuple[float, float]:
    """Return the largest tilt and when it is reached, sought on dense output about the largest sample."""
    top = int(np.argmax(amplitude))
    low, high = float(tau[max(top - 1, 0)]), min(float(tau[min(top + 1, tau.size - 1)]), trajectory.end)

    def below(time: float) -> float:
        return -float(np.hypot(*model.tilt(trajectory.states(np.array([time]))))[0])

    found = minimize_scalar(below, bounds=(low, high), method="bounded", options={"xatol": 1e-9 * (high - low)})
    if -found.fun > amplitude[top]:
        return -float(found.fun), float(found.x)
    return float(amplitude[top]), float(tau[top])
