"""One run, for a user to look at: `simulate`."""

import math
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np

from stylobate.base_motions import BASE_AT_REST, BaseMotion
from stylobate.config import provenance_of_run
from stylobate.engine.course import Course
from stylobate.engine.doubt import FALLEN, finer_rest, in_doubt, other_tolerance
from stylobate.engine.end_of_motion import duration_of, survival
from stylobate.engine.forcing import Forcing
from stylobate.engine.history import history
from stylobate.engine.motion_checks import check_motion
from stylobate.engine.moving import Method, Mover
from stylobate.engine.pace import announce, expected_steps
from stylobate.engine.starts import Turning, require_nouns, require_plane
from stylobate.engine.switching.course import SwitchingCourse
from stylobate.engine.switching.verdict import Account, switching_verdict
from stylobate.engine.thresholds import Thresholds, is_rest, rest_is_coarse, thresholds_of, without_dust
from stylobate.engine.tolerances import ATOL_SHARE, CLOSE_PASSAGE, RTOL_RANGE
from stylobate.engine.user_events import EventFunction, EventRecorder, checked_events
from stylobate.engine.verdict import Verdict, long_term
from stylobate.engine.watch import Reason, Watch
from stylobate.errors import (
    MOST_STEPS,
    Outcome,
    ParameterError,
    require_positive,
    require_vector,
    require_whole,
)
from stylobate.models import Model
from stylobate.results import OutcomeRules, Response
from stylobate.text import plural


def simulate(
    model: Model,
    motion: BaseMotion | None = None,
    *,
    tilt: Sequence[float] = (0.0, 0.0),
    tilt_rate: Sequence[float] = (0.0, 0.0),
    spin: float = 0.0,
    twist: float = 0.0,
    position: Sequence[float] = (0.0, 0.0),
    velocity: Sequence[float] = (0.0, 0.0, 0.0),
    clearance: float = 0.0,
    duration: float | None = None,
    friction_coefficient: float | None = None,
    rtol: float = 1e-8,
    atol: float | None = None,
    tilt_limit: float | None = None,
    rest_energy: float | None = None,
    max_steps: int = 200_000,
    samples: int | None = None,
    rules: OutcomeRules | None = None,
    recheck: bool = True,
    events: Sequence[EventFunction | Callable[[float, dict[str, Any]], float]] = (),
) -> Response:
    """Follow one column from a start to its outcome.

    Integrates with DOP853 (Hairer, Nørsett, Wanner, "Solving Ordinary Differential Equations I"), piece by piece
    between events that are located on its dense output: release from rest, coming to rest, overturning, the tilt
    limit, lift-off. Start and base motion that lie in one vertical plane to 8 ulp are integrated in that plane.

    Parameters
    ----------
    model
        The column with its equations of motion, such as `Slender(column, damping=0.1)`.
    motion
        The base motion; None is a base at rest.
    tilt
        Tilt vector at t = 0: where the column leans, its length the tilt angle [rad].
    tilt_rate
        Its rate [rad/s].
    spin, twist
        Angular velocity about its axis [rad/s] and angle of turn about it [rad], of models that know them.
    position
        Centre of the footprint circle in the frame of the base [m], of models that carry it along.
    velocity, clearance
        Of models that can slip and fly: velocity of the lowest point of the rim, or of the base, relative to the plane
        [m/s], and its height above it [m].
    duration
        How long to follow it [s]; where it is left out, to a free tail of 20/p after a base motion that ends, such as a
        record, a pulse or a sine sweep.
    friction_coefficient
        Of the contact: where more friction is needed the result warns. Models that slip have their own.
    rtol, atol
        Local error tolerances of the integrator, relative and absolute [rad]; `atol` is 0.01 rtol c by default.
    tilt_limit
        A tilt that ends the run [rad]; none by default.
    rest_energy
        ε: with friction, rest is entered below the energy ε c² where the base motion holds the column down. By default
        the smaller of 1e-4 and 0.015/θ², θ being the mean dimensionless frequency of the base motion; if that can
        release the column again, at most a hundredth of the energy with which it does, but not below 1e-8, and not
        below 1e-5 under a record or a brief motion.
    max_steps
        Steps after which the run ends as FAILED. The log warns beforehand where more are expected.
    samples
        Number of samples in `data`; by default enough to draw every swing.
    rules
        When a motion counts as rolling, rocking or modulated.
    recheck
        Repeat a run in doubt with a hundredth of the rest energy and ten times the tolerance: one that was released
        again after it had come to rest and then overturned or tilted beyond half of its tipping angle, that came back
        from 0.95 of its tipping angle or more, or that overturned after 40/p or more. If the column then overturns
        instead of surviving, or the other way round, the result is `uncertain`, and a warning says so.
    events
        Event functions, as `EventFunction` or plain functions of time and state with the optional attributes
        `direction` and `terminal`. Their zeros are recorded in `Response.events`; a terminal one ends the run, which
        has the outcome STOPPED. Files keep the events, not the functions.

    Returns
    -------
    Response
        Outcome and history. OVERTURNED is proved by the model's no-return criterion where it has one.

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
    require_nouns(model, motion, rules)
    moved = BASE_AT_REST if motion is None else motion
    x, y = without_dust(np.array(_pair("tilt", tilt, "rad"))).tolist()
    start_tilt = (x, y)
    if math.hypot(*start_tilt) >= math.pi / 2.0:
        message = f"tilt must be below π/2 rad in length (angles are in rad, not degrees), got {start_tilt!r}"
        raise ParameterError(message)
    start_rate = _pair("tilt_rate", tilt_rate, "rad/s")
    at_rest = bool(is_rest(np.array(start_tilt), np.array(start_rate), model.column.slenderness, model.time_scale))
    turning = Turning.checked(model, spin, twist, position, velocity, clearance, standing=at_rest)
    if friction_coefficient is not None and model.switches:
        message = f"friction_coefficient must be given to model {model.name} itself, got {friction_coefficient!r} here"
        raise ParameterError(message)
    if friction_coefficient is not None:
        friction_coefficient = require_positive("friction_coefficient", friction_coefficient)
    duration = duration_of(duration, model, moved)
    samples = None if samples is None else require_whole("samples", samples, least=2)
    method = method_of(model, moved, rtol, atol, max_steps)
    forcing = Forcing.of(model, moved)
    thresholds = thresholds_of(model, forcing, tilt_limit, rest_energy)
    check_motion(moved, duration)
    rules = rules or OutcomeRules()
    functions = checked_events(events)
    if at_rest:
        start_tilt = start_rate = (0.0, 0.0)
    require_plane(model, moved, start_tilt, start_rate)
    if model.switches:
        state = turning.begun(model, start_tilt, start_rate)
    else:
        state = turning.added_to(model, model.start(start_tilt, start_rate))
    end = duration / model.time_scale
    announce(expected_steps(model, forcing.highest_frequency, end), method.max_steps)
    run = _Run(model, forcing, replace(method, end=end), thresholds, end, rules, functions)
    course, verdict = run.follow(state)
    recorded = history(
        model,
        moved,
        course.trajectory,
        samples,
        planar=course.planar,
        friction_coefficient=friction_coefficient,
    )
    doubts = run.repeated_otherwise(state, course, verdict, recorded.measures["largest_tilt"]) if recheck else ()
    return Response(
        outcome=verdict.outcome,
        reason=verdict.reason,
        decided_at=_decided_at(course, verdict, duration),
        uncertain=_is_uncertain(model, forcing, course, thresholds) or bool(doubts),
        planar=course.planar,
        data=recorded.data,
        events=tuple(course.events),
        warnings=(*recorded.warnings, *doubts),
        thresholds={
            "close_passage": CLOSE_PASSAGE,
            "passage_tilt": model.loss_tilt,
            "no_return_tilt": model.least_safe_tilt(*_bounds(forcing)),
            **asdict(thresholds),
            **asdict(rules),
        },
        measures={
            **recorded.measures,
            "least_tilt": 0.0 if course.crossed else min(recorded.measures["least_tilt"], course.least_passage),
            "least_passage": course.least_passage,
            "impacts": float(sum(event.kind == "impact" for event in course.events)),
            **verdict.measures,
            **(Account.of(course).measures if isinstance(course, SwitchingCourse) else {}),
        },
        provenance=provenance_of_run(
            model,
            moved,
            tilt=start_tilt,
            tilt_rate=start_rate,
            **turning.values(),
            duration=duration,
            friction_coefficient=friction_coefficient,
            rtol=method.rtol,
            atol=method.atol,
            tilt_limit=None if tilt_limit is None else thresholds.tilt_limit,
            rest_energy=None if rest_energy is None else float(rest_energy),
            max_steps=method.max_steps,
            samples=samples,
            rules=asdict(rules),
            recheck=bool(recheck),
        ),
        sampler=recorded.sampler,
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

    def follow(self, state: tuple[float, ...]) -> tuple[Course | SwitchingCourse, Verdict]:
        """Integrate from `state` to the end."""
        model, forcing, motion = self.model, self.forcing, self.forcing.motion
        if model.switches:
            switching = SwitchingCourse(model, forcing, self.method, self.thresholds, self.stop, self.events)
            switching.follow(state)
            return switching, _stopped(switching) or switching_verdict(model, motion, switching, self.rules)
        recorder = EventRecorder(self.events, model, forcing, [])
        mover = Mover(model, forcing, Watch(model, forcing, self.thresholds), self.method, recorder)
        course = Course(model, forcing, mover, self.stop, events=recorder.events)
        course.follow(state)
        return course, _stopped(course) or _verdict(model, motion, course, self.rules)

    def repeated_otherwise(
        self, state: tuple[float, ...], course: Course | SwitchingCourse, verdict: Verdict, largest_tilt: float
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


_ENDINGS = {
    Reason.OVERTURNED: (Outcome.OVERTURNED, "its tilt grows beyond the tilt from which it could come back"),
    Reason.LIMIT: (Outcome.LIMIT_REACHED, "its tilt reached tilt_limit"),
    Reason.LIFTED: (Outcome.LIFTED_OFF, "the base accelerates downwards faster than gravity"),
    Reason.RESTED: (Outcome.AT_REST, "it stands, and the base motion to come cannot release it"),
}


def _stopped(course: Course | SwitchingCourse) -> Verdict | None:
    if course.ended is not Reason.TERMINATED:
        return None
    return Verdict(Outcome.STOPPED, f"its event {course.events[-1].kind!r} ended the run", {})


_RELEASED = "it may yet be released: follow it longer"


def _verdict(model: Model, motion: BaseMotion, course: Course, rules: OutcomeRules) -> Verdict:
    if course.ended is Reason.FAILED:
        racing = _RACING if _races(model, course) else ""
        return Verdict(Outcome.FAILED, f"the integration stopped: {course.failure}{racing}", {})
    unproved = math.isinf(model.least_safe_tilt(*_bounds(course.forcing)))
    if course.ended is Reason.OVERTURNED and unproved:
        return Verdict(Outcome.OVERTURNED, "its tilt reached π/2, which counts as overturned", {})
    if course.ended in _ENDINGS:
        return Verdict(*_ENDINGS[course.ended], {})
    if course.stands:
        releases = sum(event.kind == "release" for event in course.events)
        before = f", released {plural(releases, 'time')} before" if releases else ""
        left = motion.duration - course.trajectory.end * model.time_scale
        to_come = math.isfinite(left) and left > 0.0
        told = f", {left:.4g} s before the base motion stops; {_RELEASED}" if to_come else ""
        return Verdict(Outcome.AT_REST, f"it stands at the end of the run{before}{told}", {})
    period = None if motion.period is None else motion.period / model.time_scale
    verdict = long_term(model, course.trajectory, period, rules, planar=course.planar)
    if verdict.outcome is Outcome.STILL_MOVING and math.isfinite(motion.duration):
        return Verdict(*survival(model, motion, course.trajectory), verdict.measures)
    return verdict


_RACING = (
    "; it passes the vertical so closely that the contact point races round the rim, and no passage costs energy: "
    "set restitution below 1"
)
_RACES = 1e-3
"""Passages of the vertical closer than this take many steps [units of c]."""


def _races(model: Model, course: Course) -> bool:
    """Return whether close passages without loss, which the model could have, explain the number of steps."""
    lossless = model.impact_map is not None and model.loss_tilt == 0.0
    return lossless and course.least_passage < _RACES * model.column.slenderness


def _bounds(forcing: Forcing) -> tuple[float, float]:
    """Return sup |a_h| and inf a_z [g] of a whole run."""
    return forcing.largest_horizontal(0.0), forcing.least_vertical(0.0)


def _is_uncertain(model: Model, forcing: Forcing, course: Course | SwitchingCourse, thresholds: Thresholds) -> bool:
    close = course.least_passage < CLOSE_PASSAGE * model.column.slenderness
    coarse = course.released_from_rest and rest_is_coarse(model, forcing, thresholds.rest_energy)
    return close or coarse or course.ended is Reason.FAILED


def _decided_at(course: Course | SwitchingCourse, verdict: Verdict, duration: float) -> float:
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


def _pair(name: str, value: Sequence[float], unit: str) -> tuple[float, float]:
    x, y = require_vector(name, value, 2, unit)
    return x, y
