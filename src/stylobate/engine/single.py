"""One run, for a user to look at: `simulate`."""

import math
from collections.abc import Sequence
from dataclasses import asdict

import numpy as np

from stylobate.counted import counted
from stylobate.engine.afterwards import duration_of, told_of_its_end
from stylobate.engine.course import Course
from stylobate.engine.forcing import Forcing
from stylobate.engine.history import history
from stylobate.engine.moving import Method, Mover
from stylobate.engine.starts import Turning, require_plane
from stylobate.engine.switching.course import SwitchingCourse
from stylobate.engine.switching.verdict import Account, switching_verdict
from stylobate.engine.thresholds import Thresholds, is_rest, rest_is_coarse, thresholds_of
from stylobate.engine.tolerances import ATOL_SHARE, CLOSE_PASSAGE, RTOL_RANGE
from stylobate.engine.verdict import Verdict, long_term
from stylobate.engine.watch import Reason, Watch
from stylobate.errors import (
    Outcome,
    ParameterError,
    require_positive,
    require_vector,
    require_whole,
)
from stylobate.models import Model
from stylobate.motions import BASE_AT_REST, BaseMotion
from stylobate.motions.base import ACCELERATION
from stylobate.results import OutcomeRules, Response
from stylobate.spec import provenance_of_run

# Times at which the promises of a motion are checked before a run.
_MOTION_SAMPLES, _COMPONENTS = 257, 3


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
        record or a pulse.
    friction_coefficient
        Of the contact: where more friction is needed the result warns. Models that slip have their own.
    rtol, atol
        Local error tolerances of the integrator, relative and absolute [rad]; `atol` is 0.01 rtol c by default.
    tilt_limit
        A tilt that ends the run [rad]; none by default.
    rest_energy
        ε: with friction, rest is entered below the energy ε c² where the base motion holds the column down. By default
        the smaller of 1e-4 and 0.015/θ², θ being the highest dimensionless frequency of the base motion; where that
        can release the column again, also a hundredth of the energy with which it does, but not below 1e-8.
    max_steps
        Steps after which the run ends as FAILED.
    samples
        Number of samples in `data`; by default enough to draw every swing.
    rules
        When a motion counts as rolling, rocking or modulated.

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
    start_tilt = _pair("tilt", tilt, "rad")
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
    if at_rest:
        start_tilt = start_rate = (0.0, 0.0)
    require_plane(model, moved, start_tilt, start_rate)
    course: Course | SwitchingCourse
    if model.switches:
        course = SwitchingCourse(model, forcing, method, thresholds, duration / model.time_scale)
        course.follow(turning.begun(model, start_tilt, start_rate))
        verdict = switching_verdict(model, moved, course, rules)
    else:
        mover = Mover(model, forcing, Watch(model, forcing, thresholds), method)
        course = Course(model, forcing, mover, duration / model.time_scale)
        course.follow(turning.added_to(model, model.start(start_tilt, start_rate)))
        verdict = _verdict(model, moved, course, rules)
    recorded = history(
        model,
        moved,
        course.trajectory,
        samples,
        planar=course.planar,
        friction_coefficient=friction_coefficient,
    )
    freed = verdict.outcome is Outcome.STILL_MOVING and math.isfinite(moved.duration) and not model.switches
    return Response(
        outcome=verdict.outcome,
        reason=told_of_its_end(recorded.data, model.column, moved) if freed else verdict.reason,
        decided_at=_decided_at(course, verdict, duration),
        uncertain=_is_uncertain(model, forcing, course, thresholds),
        planar=course.planar,
        data=recorded.data,
        events=tuple(course.events),
        warnings=recorded.warnings,
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
        ),
        sampler=recorded.sampler,
    )


_ENDINGS = {
    Reason.OVERTURNED: (Outcome.OVERTURNED, "its tilt grows beyond the tilt from which it could come back"),
    Reason.LIMIT: (Outcome.LIMIT_REACHED, "its tilt reached tilt_limit"),
    Reason.LIFTED: (Outcome.LIFTED_OFF, "the base accelerates downwards faster than gravity"),
    Reason.RESTED: (Outcome.AT_REST, "it stands, and the base motion to come cannot release it"),
}


_RELEASED = "it may yet be released: follow it longer"


def _verdict(model: Model, motion: BaseMotion, course: Course, rules: OutcomeRules) -> Verdict:
    if course.ended is Reason.FAILED:
        return Verdict(Outcome.FAILED, f"the integration stopped: {course.failure}", {})
    unproved = math.isinf(model.least_safe_tilt(*_bounds(course.forcing)))
    if course.ended is Reason.OVERTURNED and unproved:
        return Verdict(Outcome.OVERTURNED, "its tilt reached π/2, which counts as overturned", {})
    if course.ended in _ENDINGS:
        return Verdict(*_ENDINGS[course.ended], {})
    if course.stands:
        releases = sum(event.kind == "release" for event in course.events)
        before = f", released {counted(releases, 'time')} before" if releases else ""
        left = motion.duration - course.trajectory.end * model.time_scale
        to_come = math.isfinite(left) and left > 0.0
        told = f", {left:.4g} s before the base motion stops; {_RELEASED}" if to_come else ""
        return Verdict(Outcome.AT_REST, f"it stands at the end of the run{before}{told}", {})
    period = None if motion.period is None else motion.period / model.time_scale
    return long_term(model, course.trajectory, period, rules, planar=course.planar)


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
    max_steps = require_whole("max_steps", max_steps, least=1)
    # Half the shortest period: no step can miss the forcing.
    frequency = motion.highest_frequency * model.time_scale
    return Method(
        rtol=rtol, atol=atol, max_step=math.pi / frequency if frequency > 0.0 else math.inf, max_steps=max_steps
    )


def check_motion(motion: BaseMotion, duration: float) -> None:
    """Raise ParameterError if `motion` breaks a promise: better told here than by a wrong outcome."""
    time = np.linspace(0.0, duration, _MOTION_SAMPLES)
    parts = motion.derivative(time, ACCELERATION)
    if len(parts) != _COMPONENTS or any(np.shape(part) != time.shape for part in parts):
        message = f"motion.derivative must return three arrays of the shape of time, got {parts!r}"
        raise ParameterError(message)
    broken = ~np.isfinite(np.stack(parts)).all(axis=0)
    if broken.any():
        message = f"motion must have a finite acceleration, got {parts[0][broken][0]!r} at t = {time[broken][0]!r} s"
        raise ParameterError(message)
    largest, bound = float(np.hypot(parts[0], parts[1]).max()), motion.largest_horizontal(0.0)
    if not largest <= bound * (1.0 + 1e-9):
        message = f"motion.largest_horizontal must bound |a_h|, got {bound!r} m/s² although |a_h| reaches {largest!r}"
        raise ParameterError(message)


def _pair(name: str, value: Sequence[float], unit: str) -> tuple[float, float]:
    x, y = require_vector(name, value, 2, unit)
    return x, y


def require_nouns(model: Model, motion: BaseMotion | None, rules: OutcomeRules | None) -> None:
    """Raise ParameterError if one of these is not what its name says."""
    if not isinstance(model, Model):
        message = f"model must be a model such as Slender(column), got {model!r}"
        raise ParameterError(message)
    if motion is not None and not isinstance(motion, BaseMotion):
        message = f"motion must be a base motion such as Harmonic.circular(...) or None, got {motion!r}"
        raise ParameterError(message)
    if rules is not None and not isinstance(rules, OutcomeRules):
        message = f"rules must be OutcomeRules(...) or None, got {rules!r}"
        raise ParameterError(message)
