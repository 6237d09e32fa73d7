"""Motions of a `SlidingBody` from event to event: sticking, slipping, flying, and the impacts between; for tests.

A phase is integrated by its own smooth equations until one of its events; each is located by integrating to it, not
by interpolation. Where friction has just been overcome, or a patch creeps, the direction of slip follows the load
almost at once; there the integrator is an implicit one.

Slip ends at a speed no step may pass: a step at most halves it, as it goes, until `Limits.still` is left, and the rest
takes one straight step. Slip begins with ten times as much, against the friction that would have been needed.
"""

import math

import numpy as np
from scipy.integrate import DOP853, Radau
from scipy.optimize import brentq

from .constrained_body import PLACE, VELOCITY, at_rest
from .sliding_body import NOTHING
from .sliding_impact import impulse
from .sliding_track import Event, Limits, Track

STICK, SLIP, FLIGHT, ENDED = "stick", "slip", "flight", "ended"
# How many steps of an explicit integrator the direction of slip may cost before another takes over, and gives back.
STIFF, SOFT = 40.0, 10.0
# Where, within a step, events are looked for.
LOOKED = np.array([0.25, 0.5, 0.75, 1.0])


def follow(body, start, *, duration, acceleration=at_rest, times=None, limits=None):
    """Follow a body from `start`, a state (13,), and return a `Track`.

    Parameters
    ----------
    duration
        The end of the motion, which starts at time 0 [s].
    acceleration
        Function of time [s] which returns (ax, ay, az) [m/s²] of the plane.
    times
        When to look, increasing and inside (0, duration) [s]; start and end come of themselves. A step ends at each.
        All steps without it.
    """
    run = _Run(body, acceleration, limits or Limits())
    state = np.asarray(start, dtype=float)
    phase, state = run.land(0.0, state) if body.gap(state) <= 1e-12 * body.column.radius else (FLIGHT, state)
    run.record(0.0, phase, state)
    now = 0.0
    for end in [*([] if times is None else times), duration]:
        while now < end and phase != ENDED:
            now, state, happened = run.advance(phase, now, state, end, all_steps=times is None)
            if happened is not None:
                phase, state = run.reset_map(happened, phase, now, state)
                if times is None:
                    run.record(now, phase, state)
        if times is not None or phase == ENDED:
            run.record(now, phase, state)
        if phase == ENDED:
            break
    return run.track()


class _Run:
    """One motion under way. Touching, states are (G, q, v_C, ω), flying they are (G, q, v, ω)."""

    def __init__(self, body, acceleration, limits):
        self.body, self.acceleration, self.limits = body, acceleration, limits
        self.rows, self.events, self.least_denominator = [], [], math.inf

    def push(self, time):
        return np.asarray(self.acceleration(time), dtype=float)

    def load(self, phase, time, state):
        """Return the `Touch`, unless flying, and the `Load`."""
        if phase in {FLIGHT, ENDED}:
            return None, NOTHING
        at = self.body.touch(state, self.push(time))
        return at, (self.body.held if phase == STICK else self.body.slipping)(state, at)

    def rates(self, phase, time, state):
        if phase == FLIGHT:
            return self.body.rates_flying(state, self.push(time))
        return self.body.rates_touching(state, *self.load(phase, time, state))

    def guards(self, phase, time, state):
        """What is positive until an event, by its kind."""
        if phase == FLIGHT:
            return {"land": self.body.gap(state) / self.body.column.radius + self.limits.deep}
        at, load = self.load(phase, time, state)
        tilted = {"flat": math.hypot(at.e3[0], at.e3[1]) - self.limits.flat, "fallen": at.e3[2]}
        if phase == STICK:
            return {"slip": self.body.reserve(load), **tilted}
        return {"lift": -at.free[2], "jam": load.denominator, **tilted}

    def advance(self, phase, begin, state, end, *, all_steps):
        """Integrate to an event or to `end`: time, state and, if there was one, the kind of the event."""
        solver, implicit = None, False
        while begin < end:
            longest, stiffness = self._pace(phase, begin, state, end)
            if solver is None or (stiffness > STIFF and not implicit) or (stiffness < SOFT and implicit):
                implicit = stiffness > STIFF
                solver = self._solver(phase, begin, state, end, implicit=implicit)
            solver.max_step = longest
            message = solver.step()
            if solver.status == "failed":
                raise RuntimeError(message)
            kind, bracket = self._first_crossing(phase, solver)
            if kind is not None:
                return (*self._locate(kind, phase, begin, state, bracket, implicit=implicit), kind)
            begin, state = solver.t, solver.y.copy()
            if phase == SLIP and self._still(begin, state):
                return *self._stop(begin, state, end), "stop"
            if all_steps:
                self.record(begin, phase, state)
        return begin, state, None

    def reset_map(self, happened, phase, time, state):
        """Return phase and state after what `happened`."""
        body = self.body
        if happened in {"flat", "fallen", "jam"}:
            return self._event(happened, time, body.whole(state), body.whole(state), ENDED), body.whole(state)
        if happened == "lift":
            flying = body.whole(state)
            return self._event("lift", time, flying, flying, FLIGHT), flying
        if happened == "slip":
            kicked = body.kicked(state, self.load(STICK, time, state)[1], 10.0 * self.limits.still)
            return self._event("slip", time, body.whole(state), body.whole(kicked), SLIP), kicked
        if happened == "stop":
            after, new = self._settle(time, state)
            kind = {STICK: "stick", SLIP: "reverse", FLIGHT: "lift"}[after]
            return self._event(kind, time, body.whole(state), self._whole(after, new), after), new
        return self.land(time, state)

    def land(self, time, state):
        """Return phase and state of a body (G, q, v, ω) whose C is on the plane, after the impact if it closes."""
        body, grounded, struck = self.body, state.copy(), np.zeros(3)
        if math.hypot(*body.axis(state)[:2]) <= self.limits.flat:
            return self._event("flat", time, state, state, ENDED), state
        grounded[2] -= body.gap(state)
        velocity = body.touching(grounded)[VELOCITY]
        if velocity[2] < -self.limits.still:
            bounce = -body.restitution * velocity[2] > self.limits.resting
            struck = impulse(
                velocity, body.touch(grounded).response, body.kinetic, body.restitution if bounce else 0.0, body.impact
            )
            grounded = body.struck(grounded, struck)
        touching = body.touching(grounded)
        if touching[VELOCITY][2] > self.limits.resting:
            phase, new = FLIGHT, grounded
        else:
            touching[VELOCITY.start + 2] = 0.0
            phase, new = self._settle(time, touching)
        if time > 0.0 or struck.any():
            self._event("land", time, state, self._whole(phase, new), phase, struck)
        return phase, new

    def record(self, time, phase, state):
        load = self.load(phase, time, state)[1]
        whole = self._whole(phase, state)
        touching = state if phase in {STICK, SLIP} else self.body.touching(state)
        values = self.body.slip(touching), self.body.gap(whole), *load, self.body.energy(whole)
        self.rows.append((time, whole, phase, *values))

    def track(self):
        time, state, phase, slip, gap, force, couple, denominator, energy = zip(*self.rows, strict=True)
        return Track(
            time=np.array(time), state=np.array(state), phase=list(phase), slip=np.array(slip), gap=np.array(gap),
            force=np.array(force), couple=np.array(couple), denominator=np.array(denominator),
            energy=np.array(energy), events=self.events, least_denominator=self.least_denominator,
        )  # fmt: skip

    def _whole(self, phase, state):
        return self.body.whole(state) if phase in {STICK, SLIP} else state

    def _settle(self, time, state):
        """Return phase and state of a body whose C neither closes nor opens, (G, q, v_C, ω) as is."""
        body, at = self.body, self.body.touch(state, self.push(time))
        if np.linalg.norm(body.slip(state)) <= self.limits.still:
            load = body.held(state, at)
            still = body.with_slip(state, np.zeros(3))
            if load.force[2] > 0.0 and body.reserve(load) > 0.0:
                return STICK, still
            if at.free[2] >= 0.0:
                return FLIGHT, body.whole(still)
            return SLIP, body.kicked(still, load, 10.0 * self.limits.still)
        return (SLIP, state) if at.free[2] < 0.0 else (FLIGHT, body.whole(state))

    def _slip_rate(self, rates):
        return self.body.slip(rates)  # linear in (v_C, ω)

    def _pace(self, phase, time, state, end):
        """Return the longest step [s], and how stiff slip is: steps that its direction would cost within that one."""
        if phase != SLIP:
            return np.inf, 0.0
        at, load = self.load(phase, time, state)
        self.least_denominator = min(self.least_denominator, load.denominator)
        slip = self.body.slip(state)
        speed = np.linalg.norm(slip)
        rate = np.linalg.norm(self._slip_rate(self.body.rates_touching(state, at, load)))
        longest = 0.5 * speed / rate if rate > 0.0 else np.inf
        column = self.body.column
        smooth = 0.05 * math.sqrt(column.radius / column.gravity)
        following = self.body.kinetic * load.force[2] * np.trace(at.response) / speed
        return longest, following * min(longest, smooth, end - time)

    def _solver(self, phase, begin, state, end, *, implicit):
        limits = self.limits

        def rates(time, state):
            return self.rates(phase, time, state)

        if not implicit:
            return DOP853(rates, begin, state, end, rtol=limits.rtol, atol=limits.atol)
        return Radau(rates, begin, state, end, rtol=limits.rtol, atol=limits.atol, jac=self._jacobian)

    def _jacobian(self, time, state):
        """Derivative of the rates while slipping, (13, 13), by differences small against slip; that by G is nought."""
        speed, patch = np.linalg.norm(self.body.slip(state)), self.body.patch
        steps = np.full(state.size, 1e-7)
        steps[VELOCITY] = 1e-6 * speed
        if patch > 0.0:
            steps[-1] = 1e-6 * speed / patch
        rates, jacobian = self.rates(SLIP, time, state), np.zeros((state.size, state.size))
        for column in range(PLACE.stop, state.size):
            moved = state.copy()
            moved[column] += steps[column]
            jacobian[:, column] = (self.rates(SLIP, time, moved) - rates) / (moved[column] - state[column])
        return jacobian

    def _first_crossing(self, phase, solver):
        """Return the kind of the first event within the last step, and times that bracket it."""
        dense, before = solver.dense_output(), solver.t_old
        for part in LOOKED:
            time = solver.t if part == 1.0 else solver.t_old + part * (solver.t - solver.t_old)
            guards = self.guards(phase, time, solver.y if part == 1.0 else dense(time))
            crossed = [kind for kind, margin in guards.items() if margin < 0.0]
            if crossed:
                return crossed[0], (before, time)
            before = time
        return None, None

    def _locate(self, kind, phase, begin, state, bracket, *, implicit):
        """Return time and state of the event, integrated to from the start of its step."""

        def at(time):
            if time == begin:
                return state
            solver = self._solver(phase, begin, state, time, implicit=implicit)
            while solver.status == "running":
                solver.step()
            return solver.y

        def margin(time):
            return self.guards(phase, time, at(time))[kind]

        low, high = bracket
        if margin(low) <= 0.0 or margin(high) >= 0.0:  # at a margin already, or so near that rounding decides
            time = low if margin(low) <= 0.0 else high
        else:
            time = brentq(margin, low, high, xtol=1e-16, rtol=1e-15)
        return time, at(time)

    def _still(self, time, state):
        slip = self.body.slip(state)
        fading = slip @ self._slip_rate(self.rates(SLIP, time, state)) < 0.0
        return fading and np.linalg.norm(slip) < self.limits.still

    def _stop(self, time, state, end):
        """Take the straight step to no slip."""
        slip, rates = self.body.slip(state), self.rates(SLIP, time, state)
        left = slip @ slip / -(slip @ self._slip_rate(rates))
        return min(float(time + left), end), self.body.with_slip(state + left * rates, np.zeros(3))

    def _event(self, kind, time, before, after, phase, impulse=None):
        """Note an event and return the phase that it leads to."""
        if len(self.events) >= self.limits.events:
            message = f"more than {self.limits.events} events until {time} s"
            raise RuntimeError(message)
        self.events.append(Event(kind, time, before, after, np.zeros(3) if impulse is None else impulse, phase))
        return phase
