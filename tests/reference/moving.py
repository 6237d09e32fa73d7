"""The column in motion: stretches of SciPy's DOP853, in space or in one vertical plane, from event to event."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from scipy.integrate import DOP853, OdeSolution
from scipy.optimize import brentq

from stylobate.engine.cost import report, step_limit
from stylobate.engine.tolerances import PASSAGE_FROM, PASSAGE_OFFSET
from stylobate.engine.trajectory import EventRecorder
from stylobate.models import Model

from .following import Method, Reason
from .forcing import Floats, Forcing
from .pieces import Piece, unwrapped_azimuths
from .steps import Steps, attempted, just_before, with_finite_step
from .upright import back_at_upright
from .watch import Watch

# A motion that begins at a far smaller tilt is followed with a finer tolerance up to this one [units of c].
_GROWN = 1e-3

# Passages of the upright closer than this are measured [units of c].
_PASSAGE = 0.1

# A tilt that falls by less than this part of its speed does not fall: it is least there, as `driver/passages` has it.
_JUST_MET = 1e-6

# The contact point is followed in turns of at most this angle [rad], each step cut into at most so many parts.
_NODE_TURN, _MOST_PARTS = 0.5, 64


@dataclass(frozen=True, slots=True)
class Leg:
    """A stretch of motion: its piece, the state at its end, why it ended and the minimum tilt of its passages.

    The piece is None where the first step already failed.
    """

    piece: Piece | None
    state: tuple[float, ...]
    reason: Reason
    minimum_tilt: float = math.inf
    failure: str = ""


@dataclass(frozen=True, slots=True)
class Mover:
    """Advances a moving column to the next event."""

    model: Model
    forcing: Forcing
    watch: Watch
    method: Method
    recorder: EventRecorder

    def in_space(
        self, start: float, state: tuple[float, ...], stop: float, azimuth: float, budget: int, *, begins: bool
    ) -> Leg:
        """Advance a general motion from `start` to `stop` at most; `azimuth` [rad] is where its lean begins.

        A motion that `begins`, perhaps at a tilt far below the absolute tolerance, is followed with a finer one while
        it grows; the leg ends where it has grown, or first turns back.
        """
        atol = self._beginning_atol(state) if begins else self.method.atol
        solver = self._solver(self._derivative(just_before(stop)), start, state, stop, atol)
        steps = Steps(start)
        least = math.inf
        while solver.status == "running":
            self._report(budget - len(steps.dense), solver.t)
            if len(steps.dense) >= budget:
                return self._space_leg(
                    steps,
                    solver.y,
                    azimuth,
                    Reason.FAILED,
                    least,
                    step_limit(self.method.max_steps),
                )
            before = solver.y
            failure = attempted(solver)
            if failure is not None:
                return self._space_leg(steps, solver.y, azimuth, Reason.FAILED, least, failure)
            dense = steps.add(solver)
            passage = self._passage(before, steps, solver.y)
            least = min(least, passage[1] if self._counts(solver.y) else math.inf)
            events = [self.watch.first_event(steps.times[-2], solver.t, dense)]
            events.append((passage[0], Reason.STRUCK) if self._loses_at(passage, before) else None)
            found = [event for event in events if event is not None]
            event = self._with_own(steps.times[-2], solver.t, dense, min(found, key=lambda one: one[0], default=None))
            if event is not None:
                time, reason = event
                steps.cut(time)
                return self._space_leg(steps, dense(time), azimuth, reason, least)
            if atol < self.method.atol and self._has_grown(solver.y):
                return self._space_leg(steps, solver.y, azimuth, Reason.STOP, least)
            if self._grazes(solver.y):
                return self._space_leg(steps, solver.y, azimuth, Reason.CROSSED, least)
        return self._space_leg(steps, solver.y, azimuth, Reason.STOP, least)

    def _derivative(self, last: float) -> Callable[[float, Floats], Floats]:
        """Return the rates of the states and of what is carried along; the base moves as just before `last`."""
        rates, carried_rates, parameters = self.model.rates, self.model.carried_rates, self.model.parameters
        forcing, order = self.forcing, len(self.model.state_names)

        def derivative(tau: float, y: Floats) -> Floats:
            state = y.tolist()[:order]
            moving = rates(*state, *forcing.at(min(tau, last)), *parameters)
            return np.array(moving if carried_rates is None else (*moving, *carried_rates(*state, *parameters)))

        return derivative

    def impact_map(self, state: tuple[float, ...]) -> tuple[float, ...]:
        """Return the state after a passage of the upright with the loss that the model tells."""
        assert self.model.impact_map is not None
        moving, carried = state[: len(self.model.state_names)], state[len(self.model.state_names) :]
        return *self.model.impact_map(*moving, *self.model.parameters), *carried

    def over_the_upright(self, start: float, state: tuple[float, ...], stop: float, azimuth: float) -> Leg | None:
        """Hop over the upright by the model's law of passage, where it has one and gets there before `stop`."""
        if self.model.passage is None:
            return None
        moving, carried = state[: len(self.model.state_names)], state[len(self.model.state_names) :]
        elapsed, end_state = self.model.passage(*moving, *self.forcing.at(start), *self.model.parameters)
        if start + elapsed > stop:
            return None
        if self.model.carried_rates is not None:
            rates = self.model.carried_rates(*moving, *self.model.parameters)
            carried = tuple(value + rate * elapsed for value, rate in zip(carried, rates, strict=True))
        end_state = *end_state, *carried
        ends = np.array([state, end_state]).T

        def states(tau: Floats) -> Floats:
            share = (tau - start) / elapsed
            return ends[:, :1] * (1.0 - share) + ends[:, 1:] * share

        nodes = np.array([start, start + elapsed])
        piece = Piece(
            start,
            start + elapsed,
            states,
            resting=False,
            nodes=nodes,
            azimuths=unwrapped_azimuths(self.model.tilt(ends), azimuth),
        )
        (x, y), (vx, vy) = self.model.tilt(ends)[:, 0], self.model.tilt_rate(ends)[:, 0]
        reason = Reason.STRUCK if self.model.loss_tilt > 0.0 else Reason.STOP
        speed = math.hypot(vx, vy)
        return Leg(piece, end_state, reason, math.inf if self.watch.is_slow(speed) else abs(x * vy - y * vx) / speed)

    def in_plane(
        self,
        start: float,
        state: tuple[float, float],
        stop: float,
        line: tuple[float, float],
        carried: tuple[float, ...],
        budget: int,
    ) -> Leg:
        """Advance a motion in the plane along `line`; `state` is (tilt, rate) along it, on one side of the upright.

        What is `carried` along does not change in it.
        """
        planar_rates, parameters, forcing = self.model.planar_rates, self.model.parameters, self.forcing
        assert planar_rates is not None
        side, last = math.copysign(1.0, state[0] if state[0] != 0.0 else state[1]), just_before(stop)

        def derivative(tau: float, y: Floats) -> Floats:
            ax, ay, az = forcing.at(min(tau, last))
            return np.array(planar_rates(*y.tolist(), side, ax * line[0] + ay * line[1], az, *parameters))

        atol = min(self.method.atol, self.method.rtol * abs(state[0])) if state[0] != 0.0 else self.method.atol
        solver = self._solver(derivative, start, state, stop, atol)
        steps = Steps(start)
        plane = _Plane(self.model, line, carried)

        def leg(end: Floats, reason: Reason, failure: str = "") -> Leg:
            return self._planar_leg(steps, end, reason, plane, side, failure)

        while solver.status == "running":
            self._report(budget - len(steps.dense), solver.t)
            if len(steps.dense) >= budget:
                return leg(
                    solver.y,
                    Reason.FAILED,
                    step_limit(self.method.max_steps),
                )
            failure = attempted(solver)
            if failure is not None:
                return leg(solver.y, Reason.FAILED, failure)
            dense = steps.add(solver)
            began = steps.times[-2]
            back = back_at_upright(dense, side, began, solver.t)
            if back is not None:
                steps.cut(back)
                if back == began:
                    return leg(np.zeros(2), Reason.CROSSED)
            end = solver.t if back is None else back
            states = partial(plane.states, dense)
            event = self._with_own(began, end, states, self.watch.first_event(began, end, states, rests=False))
            if event is not None:
                time, reason = event
                steps.cut(time)
                return leg(dense(time), reason)
            if back is not None:
                speed = float(dense(back)[1])
                rests = self.watch.is_rest(back, 0.0, abs(speed))
                return leg(np.array([0.0, speed]), Reason.RESTED if rests else Reason.CROSSED)
        return leg(solver.y, Reason.STOP)

    def _with_own(
        self, start: float, end: float, states: Callable[[Floats], Floats], event: tuple[float, Reason] | None
    ) -> tuple[float, Reason] | None:
        """Record the user's own events of a step before its first `event`; return that which ends the leg, if any."""
        own = self.recorder.search(start, end if event is None else event[0], states)
        return event if own is None else (own, Reason.TERMINATED)

    def _report(self, left: int, tau: float) -> None:
        method, scale = self.method, self.forcing.time_scale
        report(left, method.max_steps, tau * scale, method.end * scale)

    def _solver(
        self,
        derivative: Callable[[float, Floats], Floats],
        start: float,
        state: tuple[float, ...],
        stop: float,
        atol: float,
    ) -> DOP853:
        method = self.method
        return with_finite_step(
            DOP853(derivative, start, np.array(state), stop, max_step=method.max_step, rtol=method.rtol, atol=atol)
        )

    def _beginning_atol(self, state: tuple[float, ...]) -> float:
        tilt = self._radial(np.array(state))[0]
        return min(self.method.atol, self.method.rtol * tilt) if tilt > 0.0 else self.method.atol

    def _has_grown(self, state: Floats) -> bool:
        tilt, radial = self._radial(state)
        return tilt > _GROWN * self.model.column.slenderness or radial < 0.0

    def _grazes(self, state: Floats) -> bool:
        x, y, vx, vy = self._lean(state)
        c, speed = self.model.column.slenderness, math.hypot(vx, vy)
        inward = x * vx + y * vy < 0.0
        return bool(
            inward
            and math.hypot(x, y) < PASSAGE_FROM * min(c, speed)
            and abs(x * vy - y * vx) < PASSAGE_OFFSET * c * speed
        )

    def _passage(self, before: Floats, steps: Steps, after: Floats) -> tuple[float, float]:
        # When within the last step the tilt stops falling and grows, and how small it is then; both infinite if it does
        # not, or stays wide.
        (tilt, radial), (_, radial_after) = self._radial(before), self._radial(after)
        wide = tilt >= _PASSAGE * self.model.column.slenderness and self.model.loss_tilt == 0.0
        if wide or not radial < 0.0 < radial_after:
            return math.inf, math.inf
        dense = steps.dense[-1]
        nearest = float(
            brentq(lambda tau: self._radial(dense(tau))[1], steps.times[-2], steps.times[-1], xtol=1e-300, rtol=1e-15)
        )
        return nearest, self._radial(dense(nearest))[0]

    def _counts(self, state: Floats) -> bool:
        """Return whether a passage that ends in `state` is none of a column as slow as one at rest."""
        _, _, vx, vy = self._lean(state)
        return not self.watch.is_slow(math.hypot(vx, vy))

    def _loses_at(self, passage: tuple[float, float], before: Floats) -> bool:
        """Return whether a passage in the step from the state `before` costs energy; one just met is not met again."""
        x, y, vx, vy = self._lean(before)
        falls = x * vx + y * vy < -_JUST_MET * math.hypot(x, y) * math.hypot(vx, vy)
        return passage[1] < self.model.loss_tilt and falls

    def _radial(self, state: Floats) -> tuple[float, float]:
        """Return |α| and α·α̇ of one state."""
        x, y, vx, vy = self._lean(state)
        return math.hypot(x, y), x * vx + y * vy

    def _lean(self, state: Floats) -> tuple[float, float, float, float]:
        """Return tilt vector and rate of one state, as floats: asked for several times in each step."""
        model = self.model
        x, y, vx, vy = model.tilt_of(*state.tolist()[: len(model.state_names)], *model.parameters)
        return x, y, vx, vy

    def _space_leg(
        self, steps: Steps, end: Floats, azimuth: float, reason: Reason, least: float, failure: str = ""
    ) -> Leg:
        if not steps.dense:
            return Leg(None, tuple(map(float, end)), reason, least, failure)
        states = OdeSolution(steps.times, steps.dense)
        nodes = self._azimuth_nodes(np.array(steps.times), states)
        azimuths = unwrapped_azimuths(self.model.tilt(states(nodes)), azimuth)
        piece = Piece(
            steps.times[0],
            steps.times[-1],
            states,
            resting=False,
            nodes=nodes,
            azimuths=azimuths,
            steps=len(steps.dense),
        )
        return Leg(piece, tuple(map(float, end)), reason, least, failure)

    def _azimuth_nodes(self, times: Floats, states: Callable[[Floats], Floats]) -> Floats:
        """Return `times` with more between them wherever the contact point goes far within a step."""
        at_times = states(times)
        (x, y), (vx, vy) = self.model.tilt(at_times), self.model.tilt_rate(at_times)
        rolling = np.abs(x * vy - y * vx) / np.maximum(x * x + y * y, np.finfo(float).tiny)
        turn = np.maximum(rolling[:-1], rolling[1:]) * np.diff(times)
        parts = np.clip(np.ceil(turn / _NODE_TURN), 1.0, _MOST_PARTS).astype(int)
        share = np.arange(parts.sum()) - np.repeat(np.cumsum(parts) - parts, parts)
        between = np.repeat(times[:-1], parts) + share * np.repeat(np.diff(times) / parts, parts)
        return np.append(between, times[-1])

    def _planar_leg(self, steps: Steps, end: Floats, reason: Reason, plane: "_Plane", side: float, failure: str) -> Leg:
        if not steps.dense:
            return Leg(None, (float(end[0]), float(end[1])), reason, math.inf, failure)
        solution = OdeSolution(steps.times, steps.dense)
        piece = Piece(
            steps.times[0],
            steps.times[-1],
            partial(plane.states, solution),
            resting=False,
            nodes=np.array(steps.times[:1]),
            azimuths=np.array([math.atan2(side * plane.line[1], side * plane.line[0])]),
            steps=len(steps.dense),
        )
        return Leg(piece, (float(end[0]), float(end[1])), reason, math.inf, failure)


@dataclass(frozen=True, slots=True)
class _Plane:
    """The vertical plane along `line`, in which a model moves; what is `carried` along stays as it is."""

    model: Model
    line: tuple[float, float]
    carried: tuple[float, ...]

    def states(self, dense: Callable[[Floats], Floats], tau: Floats) -> Floats:
        """Return the states, shape (number of states, n), of the tilt and its rate that `dense` gives."""
        assert self.model.from_plane is not None
        moving = np.stack(self.model.from_plane(*dense(tau), *self.line, *self.model.parameters))
        held = np.repeat(np.array(self.carried)[:, np.newaxis], moving.shape[1], axis=1)
        return np.concatenate([moving, held])
