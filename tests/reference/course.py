"""The course of one run: from rest to motion and back, until something ends it."""

import math
from bisect import bisect_right
from dataclasses import dataclass, field

import numpy as np

from stylobate.engine.cost import unseen
from stylobate.engine.forcing import common_line
from stylobate.engine.tolerances import FIRST_STEP_OFF
from stylobate.models import Model
from stylobate.models.model import RELEASE_MARGIN
from stylobate.results import Event

from .following import Reason
from .forcing import Forcing
from .moving import Leg, Mover
from .pieces import Piece, Trajectory, nearest_turn
from .resting import departure, release_within, rest_piece, stays_for_good

Line = tuple[float, float]


@dataclass(slots=True)
class Course:
    """A run on its way; `follow` takes it to its end.

    Attributes
    ----------
    pieces, events
        What has been computed; times of pieces are dimensionless, of events in s.
    ended
        Why the run ended; STOP when its time was up.
    planar
        Whether all of its motion was integrated in one vertical plane.
    least_passage
        Minimum tilt at a passage of the upright out of a plane [rad].
    crossed
        Whether it passed the upright in a plane.
    """

    model: Model
    forcing: Forcing
    mover: Mover
    stop: float
    pieces: list[Piece] = field(default_factory=list)
    events: list[Event] = field(default_factory=list)
    ended: Reason = Reason.STOP
    failure: str = ""
    planar: bool = True
    least_passage: float = math.inf
    crossed: bool = False
    _time: float = 0.0
    _azimuth: float | None = None
    _steps: int = 0
    _stops: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        self._stops = self.forcing.stops(self.stop)

    @property
    def trajectory(self) -> Trajectory:
        """What has been computed, as one function of time."""
        return Trajectory(self.pieces, len(self.model.state_names) + len(self.model.carried_names))

    @property
    def stands(self) -> bool:
        """Whether the column stands at the end."""
        return self.pieces[-1].resting

    @property
    def released_from_rest(self) -> bool:
        """Whether the column came to rest in the run and was released again."""
        kinds = [event.kind for event in self.events]
        return "rest" in kinds and "uplift" in kinds[kinds.index("rest") :]

    def follow(self, state: tuple[float, ...]) -> None:
        """Go on from `state` at time 0 to the end."""
        now: tuple[float, ...] | None = state
        while now is not None and self._time < self.stop:
            now = self._stand(now) if self.model.stands(now) else self._move(now)
        if not self.pieces:  # not even a first step could be made
            held = np.array(state)[:, np.newaxis]
            nodes, azimuths = np.zeros(1), np.array([self._lean(state)])
            self._add(Piece(0.0, 0.0, lambda tau: np.repeat(held, tau.size, axis=1), False, nodes, azimuths))

    def _stand(self, held: tuple[float, ...]) -> tuple[float, ...] | None:
        # Stands until the motion releases the column; returns the state of departure, or None.
        start = self._time
        most = self.mover.method.max_steps
        release, known = release_within(self.model, self.forcing, start, self.stop, most)
        if release is None and not known:
            self.ended, self.failure = Reason.FAILED, unseen(most)
            self._rest(held, self.stop)
            return None
        if release is None:
            if stays_for_good(self.model, self.forcing, start):
                self.ended = Reason.RESTED
            self._rest(held, self.stop)
            return None
        if 1.0 + self.forcing.at(release)[2] <= RELEASE_MARGIN:  # nothing holds it down: not released but lifted
            if self._rest(held, release):
                self.ended = Reason.LIFTED
                self._note("lifted", release)
            return None
        later, moving = departure(self.model, self.forcing, release)
        state = *moving, *held[len(moving) :]
        if later >= self.stop:
            self._rest(held, self.stop)
            return None
        # The departure itself lifts the column by the third power of its duration: shown as rest.
        if not self._rest(held, later):
            return None
        self._note("uplift", release)
        return state

    def _rest(self, held: tuple[float, ...], until: float) -> bool:
        """Stand `until` a time; return False if an event of the user's own ended the run before."""
        piece = rest_piece(held, self._time, until)
        own = self.mover.recorder.search(piece.start, until, piece.states, resting=True)
        if own is not None:
            self.ended, until = Reason.TERMINATED, own
        self._add(rest_piece(held, self._time, until))
        return own is None

    def _move(self, state: tuple[float, ...]) -> tuple[float, ...] | None:
        column = np.array(state)[:, np.newaxis]
        tilt, rate = self.model.tilt(column)[:, 0], self.model.tilt_rate(column)[:, 0]
        line = common_line(
            (float(tilt[0]), float(tilt[1])), (float(rate[0]), float(rate[1])), *self.forcing.motion.directions()
        )
        index = self.model.spin_state
        if line is not None and self.model.planar_rates is not None and (index is None or state[index] == 0.0):
            return self._move_in_plane((float(tilt @ line), float(rate @ line)), line, state)
        self.planar = False
        return self._move_in_space(state)

    def _move_in_plane(
        self, state: tuple[float, ...], line: Line, begun: tuple[float, ...]
    ) -> tuple[float, ...] | None:
        order = len(self.model.state_names)
        carried = begun[order:]
        upright = self.model.standing((*(0.0,) * order, *carried))
        while self._time < self.stop:
            if state == (0.0, 0.0):
                return upright
            start = (state[0], state[1])
            leg = self.mover.in_plane(self._time, start, self._next_stop(), line, carried, self._budget())
            self._take(leg)
            if leg.reason is Reason.RESTED:
                return upright
            if leg.reason not in (Reason.CROSSED, Reason.STOP):
                return None
            state = leg.state
            if leg.reason is Reason.CROSSED:
                self.crossed = True
                self._note("impact" if self.model.loss_tilt > 0.0 else "passage", self._time)
            if leg.reason is Reason.CROSSED and self.model.loss_tilt > 0.0:
                state = self._struck_in_plane(leg.state, line)
        return None

    def _struck_in_plane(self, state: tuple[float, ...], line: Line) -> tuple[float, float]:
        """Return tilt and rate after a passage of the upright with loss."""
        model = self.model
        assert model.from_plane is not None
        after = self.mover.impact_map(model.from_plane(state[0], state[1], *line, *model.parameters))
        _, _, vx, vy = model.tilt_of(*after, *model.parameters)
        return state[0], float(vx * line[0] + vy * line[1])

    def _move_in_space(self, state: tuple[float, ...]) -> tuple[float, ...] | None:
        state = self._off_the_upright(state)
        begins = True
        while self._time < self.stop:
            lean, stop = self._lean(state), self._next_stop()
            leg = self.mover.in_space(self._time, state, stop, lean, self._budget(), begins=begins)
            self._take(leg)
            begins = False
            if leg.reason is Reason.CROSSED and self._time < self.stop:
                hop = self.mover.over_the_upright(self._time, leg.state, self._next_stop(), self._lean(leg.state))
                if hop is not None:
                    self._take(hop)
                    leg = hop
            if leg.reason is Reason.RESTED:
                return self.model.standing(leg.state)
            if leg.reason not in (Reason.CROSSED, Reason.STOP, Reason.STRUCK):
                return None
            state = self.mover.impact_map(leg.state) if leg.reason is Reason.STRUCK else leg.state
        return None

    def _off_the_upright(self, state: tuple[float, ...]) -> tuple[float, ...]:
        """Return `state`; where it begins at the upright itself with some speed, moved off along that speed."""
        column = np.array(state)[:, np.newaxis]
        if np.any(self.model.tilt(column)):
            return state
        rate = self.model.tilt_rate(column)[:, 0]
        step = FIRST_STEP_OFF * self.model.column.slenderness / float(np.hypot(*rate))
        x, y = (step * float(part) for part in rate)
        scale = self.model.time_scale
        moved = list(state)
        begun = self.model.start((x, y), (float(rate[0]) / scale, float(rate[1]) / scale))
        index = self.model.spin_state
        moved[: len(begun)] = [value if j != index else state[j] for j, value in enumerate(begun)]
        return tuple(moved)

    def _take(self, leg: Leg) -> None:
        if leg.piece is not None:
            self._add(leg.piece)
        self.least_passage = min(self.least_passage, leg.minimum_tilt)
        if leg.reason is Reason.RESTED:
            self._note("rest", self._time)
        elif leg.reason is Reason.STRUCK:
            self._note("impact", self._time)
        elif leg.reason not in (Reason.CROSSED, Reason.STOP):
            self.ended, self.failure = leg.reason, leg.failure
            if leg.reason is not Reason.TERMINATED:  # its event is recorded already
                self._note(leg.reason.name.lower(), self._time)

    def _add(self, piece: Piece) -> None:
        self.pieces.append(piece)
        self._steps += piece.steps
        self._time = piece.end
        if piece.azimuths.size:
            self._azimuth = float(piece.azimuths[-1])

    def _lean(self, state: tuple[float, ...]) -> float:
        x, y = self.model.tilt(np.array(state)[:, np.newaxis])[:, 0]
        return nearest_turn(math.atan2(y, x), self._azimuth)

    def _next_stop(self) -> float:
        return self._stops[bisect_right(self._stops, self._time)]

    def _budget(self) -> int:
        return self.mover.method.max_steps - self._steps

    def _note(self, kind: str, tau: float) -> None:
        self.events.append(Event(kind, tau * self.forcing.time_scale))
