"""Columns under a record by SciPy alone: the equations written out once more, integrated from knot to knot.

Two bodies: the slender column, equations (1), in three dimensions; and Housner's block at finite angles, in a plane,
whose impacts keep the angular momentum about the new edge. Rest and release are judged here too, with a rest threshold
of its own.
"""

import math
from dataclasses import dataclass, field

import numpy as np
from scipy.integrate import solve_ivp

REST = 1e-6
"""At rest below this energy, in units of c² of the body's own scale."""
SHORT = 1e-12
"""An interval shorter than this is over [s]."""
OFF = 1e-16
"""A column that is released begins this far from the vertical, in units of c."""


@dataclass
class Track:
    """What became of a run: whether it overturned, its peak tilt [rad], how often it was released after a rest."""

    overturned: bool = False
    largest: float = 0.0
    released_again: int = 0


@dataclass(frozen=True)
class SlenderBody:
    """Equations (1): tilt vector and rate, time in 1/ω0, accelerations in g."""

    c: float
    eta: float
    rate: float
    gravity: float

    def derivative(self, y, push):
        """Return the rates of the state [1/s] under a base acceleration [m/s²]."""
        tilt, speed = y[:2], y[2:]
        a = push / self.gravity
        lean = tilt / math.hypot(*tilt)
        pull = (1.0 + a[2]) * (tilt - self.c * lean) - self.eta * speed - a[:2]
        return self.rate * np.concatenate([speed, pull])

    def begin(self, push):
        """Return the state of a column just released."""
        return np.concatenate([-OFF * self.c * push[:2] / math.hypot(*push[:2]), [0.0, 0.0]])

    def energy(self, y, push):
        """Return the energy above rest over c²."""
        return (
            0.5 * (y[2] ** 2 + y[3] ** 2) + self.c * (1.0 + push[2] / self.gravity) * math.hypot(*y[:2])
        ) / self.c**2

    def tilt(self, y):
        """Return the tilt [rad], row by row."""
        return np.hypot(y[0], y[1])

    def excess(self, push):
        """Return what is positive where a standing column is released."""
        return math.hypot(*push[:2]) - self.c * (self.gravity + push[2])

    def impact_map(self, y):
        """Return None: nothing happens at a passage."""
        del y


@dataclass(frozen=True)
class Block:
    """A block in the plane x, z: angle θ and θ̇, about the edge on the side to which it leans."""

    r: float
    h: float
    centroidal_inertia_over_mass: float
    gravity: float

    @property
    def c(self):
        """Slenderness."""
        return self.r / self.h

    @property
    def about_edge(self):
        """Moment of inertia about an edge, over the mass."""
        return self.centroidal_inertia_over_mass + self.r**2 + self.h**2

    def derivative(self, y, push, side):
        """Return the rates of the state."""
        theta, r, h = y[0], side * self.r, self.h
        weight = (self.gravity + push[2]) * (h * math.sin(theta) - r * math.cos(theta))
        thrust = push[0] * (h * math.cos(theta) + r * math.sin(theta))
        return np.array([y[1], (weight - thrust) / self.about_edge])

    def kept(self):
        """Return the fraction of the angular velocity that an impact leaves."""
        return 1.0 - 2.0 * self.r**2 / self.about_edge

    def energy(self, y):
        """Return the kinetic energy at an impact over the scale m g h c² of the body."""
        return 0.5 * self.about_edge * y[1] ** 2 / (self.gravity * self.h * self.c**2)

    def excess(self, push):
        """Return what is positive where a standing block is released."""
        return abs(push[0]) - self.c * (self.gravity + push[2])


def legs(record, scale, tail):
    """Yield start, end and the accelerations at both of each interval between knots, and of the rest after them."""
    samples = scale * record.samples
    yield from zip(record.times[:-1], record.times[1:], samples[:-1], samples[1:], strict=True)
    yield record.times[-1], record.times[-1] + tail, np.zeros(3), np.zeros(3)


def release_in(body, left, right):
    """Return the share of an interval at which a standing body is released, or None: the excess is convex in it."""
    if body.excess(left) > 0.0:
        return 0.0
    if body.excess(right) <= 0.0:
        return None
    low, high = 0.0, 1.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        if body.excess(left + middle * (right - left)) > 0.0:
            high = middle
        else:
            low = middle
    return high


def follow_slender(body, record, scale, tail, rtol=1e-9):
    """Follow a slender column from rest."""
    track, state, rested = Track(), None, False
    for knot, end, first, right in legs(record, scale, tail):
        start, left = knot, first
        if state is not None and body.energy(state, left) < REST and body.excess(left) < 0.0:
            state, rested = None, True
        if state is None:
            share = release_in(body, left, right)
            if share is None:
                continue
            start, left = start + share * (end - start), left + share * (right - left)
            state = body.begin(left if np.any(left[:2]) else right)
            track.released_again += rested
        if end - start <= SHORT:
            continue

        def rates(t, y, start=start, end=end, left=left, right=right):
            return body.derivative(y, left + (t - start) / (end - start) * (right - left))

        flow = solve_ivp(rates, (start, end), state, method="DOP853", rtol=rtol, atol=1e-12 * body.c, events=_fallen)
        state = flow.y[:, -1]
        track.largest = max(track.largest, float(body.tilt(flow.y).max()))
        if flow.status == 1:
            track.overturned = True
            break
    return track


def _fallen(t, y):
    del t
    return math.hypot(y[0], y[1]) - math.pi / 2.0


_fallen.terminal = True


def follow_block(body, record, scale, tail, rtol=1e-9):
    """Follow a block from rest, from impact to impact."""
    rocking = Rocking(body, rtol)
    for leg in legs(record, scale, tail):
        rocking.through(*leg)
        if rocking.track.overturned:
            break
    return rocking.track


@dataclass
class Rocking:
    """A block on its way: its state, None while it stands, and the side to which it leans."""

    body: Block
    rtol: float
    track: Track = field(default_factory=Track)
    state: np.ndarray | None = None
    side: float = 1.0
    rested: bool = False

    def through(self, start, end, left, right):
        """Go on through an interval in which the base acceleration is linear."""

        def push(t):
            return left + (t - start) / (end - start) * (right - left)

        time = start
        while time < end and not self.track.overturned:
            if self.state is None:
                share = release_in(self.body, push(time), right)
                if share is None:
                    return
                time += share * (end - time)
                self.let_go(push(time), right)
            if end - time <= SHORT:
                return
            time = self.swing(time, end, push)

    def let_go(self, ahead, right):
        """Begin to rock, away from the acceleration."""
        self.side = -math.copysign(1.0, ahead[0] if ahead[0] != 0.0 else right[0])
        self.state = np.array([self.side * OFF * self.body.c, 0.0])
        self.track.released_again += self.rested

    def swing(self, time, end, push):
        """Rock on one side up to the impact or the end; return when that was."""
        body, side = self.body, self.side

        def back(t, y):
            del t
            return side * y[0]

        def fallen(t, y):
            del t
            return abs(y[0]) - math.pi / 2.0

        back.terminal, back.direction, fallen.terminal = True, -1.0, True
        flow = solve_ivp(
            lambda t, y: body.derivative(y, push(t), side),
            (time, end), self.state, method="DOP853", rtol=self.rtol, atol=1e-12 * body.c, events=[back, fallen],
        )  # fmt: skip
        time, self.state = float(flow.t[-1]), flow.y[:, -1]
        self.track.largest = max(self.track.largest, float(np.abs(flow.y[0]).max()))
        self.track.overturned = bool(flow.t_events[1].size)
        if flow.t_events[0].size:
            self.strike(push(time))
        return time

    def strike(self, push):
        """Land on the other edge, or come to rest."""
        self.state = np.array([0.0, self.body.kept() * self.state[1]])
        self.side = math.copysign(1.0, self.state[1])
        if self.body.energy(self.state) < REST and self.body.excess(push) < 0.0:
            self.state, self.rested = None, True
        else:
            self.state[0] = self.side * 1e-15 * self.body.c
