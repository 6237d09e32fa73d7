"""Events of a run: the status of each end, the entries of a trace, and the events at which a step is to end.

A new event that ends runs is declared here and nowhere else: its `RunStatus`, a column of `EventSetup` for a number of
the run and its value in `event_numbers`, a `Target`, and a `KernelEvent` with its laws in `EVENTS`. Kernels call the
laws from that list. What happens at an event after which the motion goes on is in `smooth`.
"""

import math
from collections.abc import Callable, Mapping
from enum import IntEnum, auto
from typing import Any, NamedTuple, Self

import numpy.typing as npt

from stylobate.engine.elementary import first_growth_past, first_return, turning_point
from stylobate.engine.kernel.bound import PLANAR, FromZero, R, Table
from stylobate.engine.tolerances import OVERTURNED_TILT
from stylobate.errors import Outcome


class RunStatus(IntEnum):
    """Status of a run in its kernel, with the outcome, the event and the reason of a run that ends with it.

    `outcome` is None if the last periods decide it or the run goes on, `event` is empty if `Run.events` gets none,
    and `reason` is empty if it depends on the run.
    """

    outcome: Outcome | None
    event: str
    reason: str

    def __new__(cls, outcome: int | None = None, event: str = "", reason: str = "") -> Self:
        """Number the members from zero."""
        member = int.__new__(cls, len(cls.__members__))
        member._value_ = int(member)
        member.outcome = None if outcome is None else Outcome(outcome)
        member.event, member.reason = event, reason
        return member

    WAITING = None
    STOPPED = None
    """The run reached its duration."""
    RESTED = Outcome.AT_REST
    OVERTURNED = Outcome.OVERTURNED, "overturned", "its tilt grows beyond the tilt from which it could come back"
    LIMIT = Outcome.LIMIT_REACHED, "limit", "its tilt reached tilt_limit"
    LIFTED = Outcome.LIFTED_OFF, "lifted", "the base accelerates downwards faster than gravity"
    STEP_LIMIT = Outcome.FAILED, "failed"
    STEP_TOO_SMALL = Outcome.FAILED, "failed", "its step became smaller than the rounding of the time"
    UNSEEN = Outcome.FAILED, "failed"
    """The column stood for as many periods as the step limit allows to search, and the base motion goes on."""
    CANNOT_DEPART = None
    """The column was uplifted from rest, but its model has no function `departure`."""
    TO_PLANE = None
    """The column was uplifted from rest by motion along a line: the kernel for planar motion continues the run."""
    ENDLESS = Outcome.FAILED, "failed"
    """The contact changed infinitely often in a finite time."""
    JAMMED = (
        Outcome.FAILED,
        "",
        "its contact jams: with friction as large as this no motion of a rigid body follows (Painlevé's paradox)",
    )
    """Dynamic jamming: the contact can neither stick nor slip nor open."""
    CONVERGED = None
    """The run has converged to a known orbit, see `loop`."""


class TraceKind(IntEnum):
    """Kind of a trace entry: a segment of motion, or an event, with the name of the event in `Run.events`."""

    event: str

    def __new__(cls, event: str | int = "") -> Self:
        """Number the members from zero."""
        member = int.__new__(cls, len(cls.__members__))
        member._value_ = int(member)
        member.event = str(event)
        return member

    STEP = ""
    PLANE_STEP = ""
    """A step of planar motion; its state is tilt and tilt rate."""
    ANALYTICAL_STEP = ""
    """A short time for which the solution is analytical."""
    STAND = ""
    """The column stands on its base."""
    RELEASE = "uplift"
    """The first kind of event; of an event only START is used."""
    REST = "rest"
    IMPACT = "impact"
    PASSAGE = "passage"
    CONTACT = ""
    """The event that ends a kind of contact, named by the model; its guard and the kinds before and after it follow."""


class EventSetup(FromZero):
    """Numbers of a run that its events need; they follow the columns of `Setup`. Large numbers mean no event."""

    TILT_LIMIT = auto()
    """Tilt that ends the run; infinite if none does."""
    OVERTURNED_TILT = auto()
    """Tilt that counts as overturned if the model proves no point of no return."""


def event_numbers(options: Mapping[str, Any], time_scale: npt.ArrayLike) -> dict[EventSetup, npt.ArrayLike]:
    """Return the numbers of `EventSetup` of runs with these options; `time_scale` is the unit of time [s]."""
    del time_scale  # for events whose numbers have a unit with time
    return {
        EventSetup.TILT_LIMIT: math.inf if options["tilt_limit"] is None else options["tilt_limit"],
        EventSetup.OVERTURNED_TILT: OVERTURNED_TILT,
    }


class Target(FromZero):
    """Event at which an aimed step is to end."""

    LIMIT = auto()
    OVERTURNING = auto()
    """The tilt passes the point of no return while it grows."""
    GROWTH = auto()
    """The tilt begins to grow beyond the point of no return, which fell below the tilt."""
    VERTICAL = auto()
    """Passage through the vertical in planar motion."""
    IMPACT = auto()
    """Minimum tilt of a three-dimensional passage that loses energy."""


class Lean(NamedTuple):
    """Tilt vector and its rate, the tilt, and tilt times tilt rate."""

    x: float
    y: float
    vx: float
    vy: float
    tilt: float
    radial: float


class KernelEvent(NamedTuple):
    """Laws of an event within a step, as functions of the buffer and a lane.

    Parameters
    ----------
    target
        Name of the event.
    status
        Status with which the run ends at the event.
    past
        `past(buf, i, new)` is positive if a step to `new` goes beyond the event. It is evaluated in all lanes.
    ahead
        `ahead(buf, i, h, new)` is the time to the event within a step `h` to `new`; `h` if it is not within, and
        infinite if the step cannot end there.
    left
        `left(buf, i, before)` is the time from the present state, the end of an aimed step from `before`, to the event.
    margin
        `margin(buf, i, lean)` falls below zero at the event, for limits that end the runs of all models; else None.
    planar
        Whether only planar motion has the event.
    """

    target: Target
    status: RunStatus
    past: Callable[[Table, int, Lean], float]
    ahead: Callable[[Table, int, float, Lean], float]
    left: Callable[[Table, int, Lean], float]
    margin: Callable[[Table, int, Lean], float] | None = None
    planar: bool = False


def lean(x: float, y: float, vx: float, vy: float) -> Lean:
    """Return a tilt vector and its rate, with its length and growth."""
    return Lean(x, y, vx, vy, math.sqrt(x * x + y * y), x * vx + y * vy)


def present_lean(buf: Table, i: int) -> Lean:
    """Return the tilt vector of a lane."""
    return Lean(buf[R.X, i], buf[R.Y, i], buf[R.VX, i], buf[R.VY, i], buf[R.TILT, i], buf[R.RADIAL, i])


# Tilt limit


def margin_of_limit(buf: Table, i: int, now: Lean) -> float:
    """Return the tilt limit minus the tilt."""
    return -past_limit(buf, i, now)


def past_limit(buf: Table, i: int, new: Lean) -> float:
    """Return the tilt minus its limit."""
    return new.tilt - buf[R.TILT_LIMIT, i]


def time_to_limit(buf: Table, i: int, h: float, new: Lean) -> float:
    """Return the time at which the tilt passes its limit."""
    limit = buf[R.TILT_LIMIT, i]
    return time_of_growth(buf, i, h, new, limit) if new.tilt > limit else h


def left_to_limit(buf: Table, i: int, _before: Lean) -> float:
    """Return the time to the tilt limit."""
    return left_to_tilt(buf, i, buf[R.TILT_LIMIT, i])


def time_of_growth(buf: Table, i: int, h: float, new: Lean, bound: float) -> float:
    """Return the time at which the tilt first grows beyond a bound, on the cubic of its square."""
    tilt = buf[R.TILT, i]
    squares = tilt * tilt, new.x * new.x + new.y * new.y
    slopes = 2.0 * h * buf[R.RADIAL, i], 2.0 * h * new.radial
    return h * first_growth_past(bound * bound, *squares, *slopes)


def left_to_tilt(buf: Table, i: int, bound: float) -> float:
    """Return the time to this tilt at the present tilt rate."""
    tilt, radial = buf[R.TILT, i], buf[R.RADIAL, i]
    return (bound - tilt) * tilt / radial if radial > 0.0 else 0.0


# Overturning: beyond the point of no return, the tilt grows


def past_return(buf: Table, i: int, new: Lean) -> float:
    """Return an indicator that is positive if the tilt grows beyond the point of no return."""
    return min(new.tilt - buf[R.NO_RETURN, i], new.radial)


def time_to_overturning(buf: Table, i: int, h: float, new: Lean) -> float:
    """Return the time at which the tilt passes the point of no return."""
    return time_past_return(buf, i, h, new) if buf[R.TILT, i] < buf[R.NO_RETURN, i] else math.inf


def left_to_overturning(buf: Table, i: int, _before: Lean) -> float:
    """Return the time to the point of no return."""
    return left_to_tilt(buf, i, buf[R.NO_RETURN, i])


def time_to_growth(buf: Table, i: int, h: float, new: Lean) -> float:
    """Return the time at which the tilt, beyond the point of no return, begins to grow."""
    return math.inf if buf[R.TILT, i] < buf[R.NO_RETURN, i] else time_past_return(buf, i, h, new)


def time_past_return(buf: Table, i: int, h: float, new: Lean) -> float:
    """Return the time at which the tilt first grows beyond the point of no return."""
    no_return = buf[R.NO_RETURN, i]
    return time_of_growth(buf, i, h, new, no_return) if new.tilt > no_return and new.radial > 0.0 else h


def left_to_growth(buf: Table, i: int, before: Lean) -> float:
    """Return the time to the minimum tilt, by the secant of the growth."""
    return secant(buf[R.MADE, i], before.radial, buf[R.RADIAL, i])


def secant(h: float, before: float, now: float) -> float:
    """Return the time from now to the zero of the line through the values `h` ago and now."""
    return -now * h / (now - before) if now != before else 0.0


# Passage through the vertical in planar motion


def past_vertical(buf: Table, i: int, new: Lean) -> float:
    """Return the depth to which the tilt falls below zero, at the end of the step or within it."""
    side, h = buf[R.SIDE, i], buf[R.H, i]
    s0, s1 = side * buf[R.X, i], side * new.x
    v0, v1 = side * buf[R.VX, i], side * new.vx
    _, lowest = turning_point(s0, s1, v0 * h, v1 * h, -1.0)
    lowest = lowest if v0 < 0.0 else s1
    lowest = lowest if v1 > 0.0 else s1
    return -min(s1, lowest)


def time_to_vertical(buf: Table, i: int, h: float, _new: Lean) -> float:
    """Return the time of the passage, 0 for a swing too short to be resolved within the step."""
    side = buf[R.SIDE, i]
    return first_return(
        h,
        side * buf[R.STATE, i],
        side * buf[R.STATE + 1, i],
        side * buf[R.SLOPE + 1, i],
        side * buf[R.NEW, i],
        side * buf[R.NEW + 1, i],
        side * buf[R.SLOPE_NEW + 1, i],
    )


def left_to_vertical(buf: Table, i: int, _before: Lean) -> float:
    """Return the time to the vertical at the present rate."""
    speed = buf[R.STATE + 1, i]
    return -buf[R.STATE, i] / speed if speed != 0.0 else 0.0


EVENTS = (
    KernelEvent(Target.LIMIT, RunStatus.LIMIT, past_limit, time_to_limit, left_to_limit, margin=margin_of_limit),
    KernelEvent(Target.OVERTURNING, RunStatus.OVERTURNED, past_return, time_to_overturning, left_to_overturning),
    KernelEvent(Target.GROWTH, RunStatus.OVERTURNED, past_return, time_to_growth, left_to_growth),
    KernelEvent(Target.VERTICAL, RunStatus.WAITING, past_vertical, time_to_vertical, left_to_vertical, planar=True),
)
"""Events for which steps are held back; of two at the same time the first one counts."""

LIMITS = tuple(event for event in EVENTS if event.margin is not None)
"""Events that end the runs of all models; a model that changes between kinds of contact has them as guards."""

STATUSES_AT_LIMITS = tuple(int(event.status) for event in LIMITS)
"""Statuses with which runs end at the limits."""


# Laws of all events


def overshoot_of(buf: Table, i: int, new: Lean) -> float:
    """Return an indicator that is positive if a step to `new` goes beyond an event."""
    past = EVENTS[0].past(buf, i, new)
    for event in EVENTS[1:]:
        if PLANAR or not event.planar:
            past = max(past, event.past(buf, i, new))
    return past


def first_event(buf: Table, i: int, h: float, new: Lean) -> tuple[int, float]:
    """Return the `Target` and the time of the first event within a step `h` to `new` that was held back.

    Of several at the same time it is the one that the step passes furthest. If none is located, because the step only
    just passes an event, that time is the end of the step.
    """
    target, ahead, furthest = int(EVENTS[0].target), h, -math.inf
    for event in EVENTS:
        if PLANAR or not event.planar:
            time, past = event.ahead(buf, i, h, new), event.past(buf, i, new)
            if time < ahead or (time == ahead and past > furthest):
                target, ahead, furthest = int(event.target), time, past
    return target, ahead


def time_left(buf: Table, i: int, before: Lean) -> float:
    """Return the time from the end of an aimed step from `before` to its target; at most half of that step."""
    target, half = buf[R.TARGET, i], 0.5 * abs(buf[R.MADE, i])
    further = left_to_growth(buf, i, before) if target == Target.IMPACT else 0.0
    for event in EVENTS:
        if (PLANAR or not event.planar) and target == event.target:
            further = event.left(buf, i, before)
    return min(max(further, -half), half)


def status_at_target(buf: Table, i: int) -> int:
    """Return the status with which the run ends at the target of the aimed steps; WAITING if the motion goes on."""
    status = int(RunStatus.WAITING)
    for event in EVENTS:
        if buf[R.TARGET, i] == event.target:
            status = int(event.status)
    return status


def limit_passed(buf: Table, i: int) -> int:
    """Return the status with which a run ends at its start because of a limit, or WAITING."""
    now, status = present_lean(buf, i), int(RunStatus.WAITING)
    for event in LIMITS:
        if event.margin(buf, i, now) < 0.0:  # type: ignore[misc]
            status = int(event.status)
    return status


def margins_of_limits(buf: Table, i: int, now: Lean) -> tuple[float, ...]:
    """Return the margins of the limits, which fall below zero there."""
    return tuple(event.margin(buf, i, now) for event in LIMITS)  # type: ignore[misc]
