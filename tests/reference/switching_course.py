"""The course of a run of a column that changes between kinds of contact."""

import math
from bisect import bisect_right
from collections.abc import Callable
from dataclasses import dataclass, field
from enum import IntEnum

import numpy as np
from scipy.integrate import OdeSolution
from scipy.optimize import brentq

from stylobate.engine.cost import report, step_limit, unseen
from stylobate.engine.tolerances import SLIP_SHORTER
from stylobate.engine.trajectory import EventFunction, EventRecorder
from stylobate.models import Model
from stylobate.models.model import RELEASE_MARGIN
from stylobate.results import Event

from .following import Method, Reason
from .forcing import Floats, Forcing
from .guard import Guard
from .inclined import InclinedForcing
from .pieces import Piece, Trajectory, nearest_turn, unwrapped_azimuths
from .resting import departure_lapse, release_within, rest_piece, stays_for_good
from .solvers import Stepper
from .steps import Steps, just_before
from .thresholds import Thresholds

# The limit of the user and a terminal event of the user are no margins of the model.
_LIMIT, _TERMINATED = -2, -3

# Kinds of contact in which the column stands on its base: at rest, and sliding.
_ON_BASE = (0, 1)

# Those in which a contact slips.
_SLIPS = ("SLIDING", "SLIPPING")

# Events with which a slip begins.
_BEGIN_TO_SLIP = ("slip", "slide", "reverse")

_JAM = "its contact jams: with friction as large as this no motion of a rigid body follows (Painlevé's paradox)"

# So many changes of contact without a step between them are no motion.
_MOST_AT_ONCE = 100

# Shorter than this a run of changes counts as one moment [units of the larger of 1 and the time].
_MOMENT = 1e-12


def _moment(time: float) -> float:
    return _MOMENT * max(1.0, abs(time))


@dataclass(slots=True)
class SwitchingCourse:
    """A run on its way; `follow` takes it to its end.

    Attributes
    ----------
    pieces, events, contacts, times
        What has been computed; `contacts` has the kind of contact of each piece, `times` the ends of its steps.
    ended, failure
        Why the run ended; STOP when its time was up.
    planar, least_passage, crossed
        As for `Course`: no motion is integrated in a plane, and strokes of the base are no passages to be resolved.
    """

    model: Model
    forcing: Forcing
    method: Method
    thresholds: Thresholds
    stop: float
    functions: tuple[EventFunction, ...] = ()
    pieces: list[Piece] = field(default_factory=list)
    times: list[Floats] = field(default_factory=list)
    contacts: list[int] = field(default_factory=list)
    events: list[Event] = field(default_factory=list)
    ended: Reason = Reason.STOP
    failure: str = ""
    planar: bool = False
    least_passage: float = math.inf
    crossed: bool = False
    _time: float = 0.0
    _azimuth: float | None = None
    _steps: int = 0
    _at_once: int = 0
    _last_event: float = -math.inf
    _stops: tuple[float, ...] = ()
    _recorder: EventRecorder = field(init=False)

    def __post_init__(self) -> None:
        self._stops = self.forcing.stops(self.stop)
        self._recorder = EventRecorder(self.functions, self.model, self.forcing, self.events)

    @property
    def released_from_rest(self) -> bool:
        """Whether the column came to rest in the run and was released again."""
        kinds = [event.kind for event in self.events]
        return "rest" in kinds and "uplift" in kinds[kinds.index("rest") :]

    @property
    def slips(self) -> int:
        """How often a contact that held began to slip."""
        return sum(event.kind in _BEGIN_TO_SLIP for event in self.events)

    @property
    def trajectory(self) -> Trajectory:
        """What has been computed, as one function of time."""
        return Trajectory(self.pieces, len(self.model.state_names))

    def follow(self, state: tuple[float, ...]) -> None:
        """Go on from `state` at time 0 to the end."""
        flies = self._kind(state).name == "FLYING"
        now: tuple[float, ...] | None = state if flies else self._reaction(state, -1)
        while now is not None and self._time < self.stop:
            now = self._stand(now) if self._kind(now).name == "RESTING" else self._move(now)
        if not self.pieces:
            self._rest(state, 0.0)

    def _contact(self, state: tuple[float, ...]) -> int:
        return int(state[-1])

    def _kind(self, state: tuple[float, ...]) -> IntEnum:
        assert self.model.contact_kinds is not None
        return self.model.contact_kinds(self._contact(state))

    def _stand(self, held: tuple[float, ...]) -> tuple[float, ...] | None:
        """Stand until the base sets the column going; return the state after it, or None."""
        start = self._time
        felt = InclinedForcing.of(self.model, self.forcing.motion)
        most = self.method.max_steps
        release, known = release_within(self.model, felt, start, self.stop, most)
        if release is None and not known:
            self.ended, self.failure = Reason.FAILED, unseen(most)
            self._rest(held, self.stop)
            return None
        if release is None:
            if stays_for_good(self.model, felt, start):
                self.ended = Reason.RESTED
            self._rest(held, self.stop)
            return None
        # By a rounding none of them may be broken yet.
        lift, *others = self._guard().guards(release, np.array(held))[:-1]
        broken = 0 if lift <= RELEASE_MARGIN else 1 + int(np.argmin(others))
        if release > start and not self._rest(held, release):
            return None
        return self._reaction(held, broken)

    def _move(self, state: tuple[float, ...]) -> tuple[float, ...] | None:
        """Move until an event; return the state after it, or None where it ends the run."""
        stop, guard = self._stops[bisect_right(self._stops, self._time)], self._guard()
        contact = self._contact(state)
        guards = guard.guards(self._time, np.array(state))
        broken = guard.broken(guards)
        if broken is not None:
            return self._reaction(state, broken)
        stepper, steps, friction = (
            self._stepper(state, stop),
            Steps(self._time),
            self.model.guard_names.index("friction"),
        )
        while stepper.running:
            if self._given_up(steps, contact):
                return None
            failure = stepper.step()
            if failure is not None and (number := guard.nearly_broken(guards)) is not None:
                self._take(steps, contact)
                return self._reaction(tuple(stepper.solver.y.tolist()), number)
            if failure is not None:
                self._fail(steps, contact, failure)
                return None
            solver = stepper.solver
            dense = steps.add(solver)
            time, number, found = guard.first_event(steps.times[-2], solver.t, dense, guards)
            if number == friction and time - steps.times[-2] > _moment(time) and stepper.turned(dense(time)):
                steps.drop()
                stepper.again(SLIP_SHORTER * (time - steps.times[-1]))
                continue
            guards = found
            limit = self._limit_time(dense, steps.times[-2], time)
            if limit is not None:
                time, number = limit, _LIMIT
            own = self._recorder.search(steps.times[-2], time, dense, resting=contact in _ON_BASE)
            if own is not None:
                time, number = own, _TERMINATED
            if number != -1:
                steps.cut(time)
                self._take(steps, contact)
                return self._reaction(tuple(dense(time).tolist()), number)
            solver.y[:] = self._refreshed(solver.y)
        self._take(steps, contact)
        return tuple(stepper.solver.y.tolist())

    def _given_up(self, steps: Steps, contact: int) -> bool:
        """Return whether no step more is to be made."""
        left = self.method.max_steps - self._steps - len(steps.dense)
        report(left, self.method.max_steps, steps.times[-1] * self.model.time_scale, self.stop * self.model.time_scale)
        if left > 0:
            return False
        self._fail(steps, contact, step_limit(self.method.max_steps))
        return True

    def _stepper(self, state: tuple[float, ...], stop: float) -> Stepper:
        rates, parameters, forcing, last = self.model.rates, self.model.parameters, self.forcing, just_before(stop)

        def derivative(tau: float, y: Floats) -> Floats:
            return np.array(rates(*y.tolist(), *forcing.at(min(tau, last)), *parameters))

        slip = self.model.slip_states if self._kind(state).name in _SLIPS else ()
        return Stepper(derivative, self._time, np.array(state), stop, self.method, slip)

    def _refreshed(self, y: Floats) -> Floats:
        project = self.model.project
        return y if project is None else np.array(project(*y.tolist(), *self.model.parameters))

    def _guard(self) -> Guard:
        return Guard(self.model, self.forcing, self.thresholds.rest_energy)

    def _reaction(self, state: tuple[float, ...], number: int) -> tuple[float, ...] | None:
        """Return the state after the margin of this number was broken; None where that ends the run."""
        model, time = self.model, self._time
        assert model.reset_map is not None
        if number == _TERMINATED:
            self.ended = Reason.TERMINATED
            return None
        name = model.guard_names[number] if number >= 0 else ""
        if name == "fallen" or number == _LIMIT:
            self.ended = Reason.OVERTURNED if name == "fallen" else Reason.LIMIT
            self._note("overturned" if name == "fallen" else "limit", time)
            return None
        self._at_once = self._at_once + 1 if time - self._last_event <= _moment(time) else 0
        self._last_event = time
        if self._at_once > _MOST_AT_ONCE:
            self.ended, self.failure = Reason.FAILED, f"its contact changes without end ({name})"
            self._note("failed", time)
            return None
        ahead = departure_lapse(self.forcing)
        now, later = self.forcing.at(time), self.forcing.at(time + ahead)
        elapsed, after = model.reset_map(
            *state, float(number), *now, *later, ahead, self.thresholds.rest_energy, *model.parameters
        )
        kind = model.event_of(name, self._contact(state), self._contact(after))
        # Slip that goes on at once along another heading has not ended.
        goes_on = name == "friction" and elapsed == 0.0 and self._contact(after) == self._contact(state)
        if kind and number >= 0 and not goes_on:
            self._note(kind, time)
        if self._kind(after).name == "JAMMED":
            self.ended, self.failure = Reason.FAILED, _JAM
            return None
        if elapsed > 0.0 and time + elapsed < self.stop:
            self._bridge(state, after, elapsed)
        return tuple(after)

    def _bridge(self, state: tuple[float, ...], after: tuple[float, ...], elapsed: float) -> None:
        """Pass the short time in which one state becomes the other, seen as the kind of contact that ends."""
        start, contact = self._time, self._contact(state)
        ends = np.array([state, after]).T
        kept = [self.model.state_names.index(name) for name in ("heading_x", "heading_y", "heading_z", "contact")]
        ends[kept, 1] = ends[kept, 0]

        def states(tau: Floats) -> Floats:
            share = (tau - start) / elapsed
            return ends[:, :1] * (1.0 - share) + ends[:, 1:] * share

        self._add(states, np.array([start, start + elapsed]), contact, 0)

    def _take(self, steps: Steps, contact: int) -> None:
        if steps.dense:
            states = OdeSolution(steps.times, steps.dense)
            self._add(states, np.array(steps.times), contact, len(steps.dense))

    def _add(self, states: Callable[[Floats], Floats], times: Floats, contact: int, steps: int) -> None:
        nodes, azimuths = np.empty(0), np.empty(0)
        on_base = contact in _ON_BASE
        if not on_base:
            nodes, tilt = times, self.model.tilt(states(times))
            azimuths = unwrapped_azimuths(tilt, nearest_turn(math.atan2(tilt[1, 0], tilt[0, 0]), self._azimuth))
            self._azimuth = float(azimuths[-1])
        start, end = float(times[0]), float(times[-1])
        self._keep(Piece(start, end, states, on_base, nodes, azimuths, steps), times, contact)

    def _rest(self, held: tuple[float, ...], until: float) -> bool:
        """Stand `until` a time; return False if an event of the user's own ended the run before."""
        piece = rest_piece(held, self._time, until)
        own = self._recorder.search(piece.start, until, piece.states, resting=True)
        if own is not None:
            self.ended, until = Reason.TERMINATED, own
        self._keep(rest_piece(held, self._time, until), np.array([self._time, until]), self._contact(held))
        return own is None

    def _keep(self, piece: Piece, times: Floats, contact: int) -> None:
        self.pieces.append(piece)
        self.times.append(times)
        self.contacts.append(contact)
        self._steps += piece.steps
        self._time = piece.end

    def _fail(self, steps: Steps, contact: int, failure: str) -> None:
        self._take(steps, contact)
        self.ended, self.failure = Reason.FAILED, failure
        self._note("failed", self._time)

    def _limit_time(self, dense: Callable[[float], Floats], start: float, end: float) -> float | None:
        """Return when the tilt grows beyond the limit of the user within a step, if it does."""
        limit = self.thresholds.tilt_limit
        if math.isinf(limit):
            return None

        def beyond(tau: float) -> float:
            return float(np.hypot(*self.model.tilt(dense(tau)[:, np.newaxis]))[0]) - limit

        if beyond(end) <= 0.0:
            return None
        return start if beyond(start) >= 0.0 else float(brentq(beyond, start, end, xtol=4e-15 * max(1.0, end)))

    def _note(self, kind: str, tau: float) -> None:
        self.events.append(Event(kind, tau * self.forcing.time_scale))
