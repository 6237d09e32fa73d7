"""The rigid column once more, for tests: Newton's and Euler's equations in six freedoms, held by constraint forces.

Neither coordinates nor equations are shared with the models of the package. The attitude is a quaternion; the ground
enters by unknown forces, which are solved for together with the accelerations. So a number on which this and a model
agree is right, or two different derivations went wrong in the same way.

    from .constrained_body import ConstrainedBody

    body = ConstrainedBody(column, hold="wobbling", viscous=0.02)
    start = body.state(theta=0.05, beta=0.3, w1=-0.03, w2=0.1)
    track = body.follow(start, duration=2.0, acceleration=lambda t: (math.sin(9.0 * t), 0.0, 0.0))
    track.tilt[-1], track.w3[-1], track.demand.max()

Names: the axis e3 leans by θ towards the azimuth β, d is the horizontal direction of β, n = Z × d, and u = n × e3
points from the centre of the base to the lowest point of its rim, the contact C. Components w1, w2, w3 of the angular
velocity are those along u, n, e3. The body is turned from upright by Rz(β) Ry(θ) Rz(χ − β), χ its twist. The frame is
that of the plane, units are SI.

The equations fail at θ = 0, where no point of the rim is the lowest. Ground that would have to pull (N < 0) does.
"""

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal, NamedTuple

import numpy as np
from scipy.integrate import solve_ivp

import stylobate as sb

UP = np.array([0.0, 0.0, 1.0])
IDENTITY = np.eye(3)
# A state is (G, q, v, ω): centre of mass, quaternion (w, x, y, z), velocity, angular velocity, all along X, Y, Z.
PLACE, ATTITUDE, VELOCITY, TURNING = slice(0, 3), slice(3, 7), slice(7, 10), slice(10, 13)
# The unknowns of the linear system: acceleration, angular acceleration, contact force (Z last), multiplier of a couple.
LINEAR, ANGULAR, FORCE, NORMAL, MULTIPLIER = slice(0, 3), slice(3, 6), slice(6, 9), 8, 9


class Contact(NamedTuple):
    """Where a body touches the plane: directions, and arm ρ from the centre of mass to C with its rate, all (3,)."""

    e3: np.ndarray
    e3_rate: np.ndarray
    d: np.ndarray
    u: np.ndarray
    arm: np.ndarray
    arm_rate: np.ndarray

    @property
    def n(self):
        return np.array([-self.d[1], self.d[0], 0.0])


class Motion(NamedTuple):
    """What follows from a state: its `rates` (13,), the `force` (3,) of the ground, the `couple` (3,) of `hold`."""

    rates: np.ndarray
    force: np.ndarray
    couple: np.ndarray


@dataclass(frozen=True, kw_only=True)
class Track:
    """A motion at the times asked for; the leading dimension of every array is time.

    Parameters
    ----------
    time
        Times [s], (n,), the start included.
    state
        States as `ConstrainedBody.state` gives them, (n, 13).
    theta, beta, twist
        θ > 0, β and χ [rad], (n,); β starts within (−π, π] and χ within (−2π, 2π], both go on continuously.
    tilt, tilt_rate
        θ(cos β, sin β) and its rate [rad, rad/s], (n, 2).
    w1, w2, w3
        Angular velocity along u, n, e3 [rad/s], (n,).
    contact, base_centre
        C and B0 = C − r d, about which the rim turns, on the plane [m], (n, 2).
    normal, friction_d, friction_n
        Force of the ground on the body along Z, d, n [N], (n,).
    couple
        What `hold` needs, along X, Y, Z [N m], (n, 3): with ``"wobbling"`` its vertical part is its axial part, with
        ``"rubber"`` it is vertical, without either nought.
    energy
        Kinetic and potential energy, the latter from the height of the plane [J], (n,).
    gap, slip
        Height of C [m] and speed of the body there [m/s], (n,): nought but for errors of the integration.
    peak_demand
        The largest friction per normal force at all steps of the integrator, not only at `time`.
    """

    time: np.ndarray
    state: np.ndarray
    theta: np.ndarray
    beta: np.ndarray
    twist: np.ndarray
    tilt: np.ndarray
    tilt_rate: np.ndarray
    w1: np.ndarray
    w2: np.ndarray
    w3: np.ndarray
    contact: np.ndarray
    base_centre: np.ndarray
    normal: np.ndarray
    friction_d: np.ndarray
    friction_n: np.ndarray
    couple: np.ndarray
    energy: np.ndarray
    gap: np.ndarray
    slip: np.ndarray
    peak_demand: float

    @property
    def demand(self):
        """Friction per normal force at `time`, (n,)."""
        return np.hypot(self.friction_d, self.friction_n) / self.normal


def at_rest(time):
    """The acceleration of a plane at rest."""
    del time
    return 0.0, 0.0, 0.0


@dataclass(frozen=True, kw_only=True)
class ConstrainedBody:
    """A column that touches the plane by a point of its rim, which neither slips nor lifts off.

    Parameters
    ----------
    column
        The body; of its numbers, those it was made from.
    hold
        What keeps the body from twisting: nothing (``"free"``), or a couple that keeps ω·(e3 + Z) = 0
        (``"wobbling"``) or ω·Z = 0 (``"rubber"``), along the vector of that constraint, so that it does no work.
    viscous
        D1 of the couple −D1 (w1 u + w2 n) [N m s].
    spin_damping
        D0 of the couple −D0 (ω·Z) Z [N m s].
    rolling_arm, rolling_rate
        δ [m] and ε [rad/s] of rolling resistance: the couple −δN ω_h/√(|ω_h|² + ε²), ω_h the horizontal part of ω.
    """

    column: sb.Column
    hold: Literal["free", "wobbling", "rubber"] = "free"
    viscous: float = 0.0
    spin_damping: float = 0.0
    rolling_arm: float = 0.0
    rolling_rate: float = 1e-3

    def state(self, *, theta, beta=0.0, twist=0.0, w1=0.0, w2=0.0, w3=None, contact=None):
        """Return the state (13,) of a body which rolls.

        Parameters
        ----------
        theta, beta, twist
            θ > 0, β, χ [rad].
        w1, w2, w3
            Angular velocity along u, n, e3 [rad/s]; without w3 what `hold` says, nought if the body is free. Forces
            keep the rate of a constraint only: a w3 which `hold` forbids stays as wrong as it is.
        contact
            C on the plane, (2,) [m]; (r cos β, r sin β) unless given, so that B0 starts at the origin.
        """
        if w3 is None:
            w3 = w1 * {"free": 0.0, "wobbling": math.tan(theta / 2.0), "rubber": math.tan(theta)}[self.hold]
        leaning = _product(_turn(beta, (0.0, 0.0, 1.0)), _turn(theta, (0.0, 1.0, 0.0)))
        attitude = _product(leaning, _turn(twist - beta, (0.0, 0.0, 1.0)))
        state = np.concatenate([np.zeros(3), attitude, np.zeros(6)])
        at = self.contact(state)
        spin = w1 * at.u + w2 * at.n + w3 * at.e3
        place = self.column.radius * at.d[:2] if contact is None else np.asarray(contact, dtype=float)
        state[PLACE] = np.append(place, 0.0) - at.arm
        state[VELOCITY] = -_cross(spin, at.arm)  # the body stands still at C
        state[TURNING] = spin
        return state

    def contact(self, state):
        """Return the lowest point of the rim, and how it moves along rim and plane, as a `Contact`."""
        r, h = self.column.radius, self.column.mass_height
        e3 = _rotation(state[ATTITUDE])[:, 2]
        e3_rate = _cross(state[TURNING], e3)
        lean = math.hypot(e3[0], e3[1])
        d = np.array([e3[0] / lean, e3[1] / lean, 0.0])
        lean_rate = d @ e3_rate
        d_rate = (e3_rate - e3_rate[2] * UP - lean_rate * d) / lean
        # Down the slope of the base: across e3, in the vertical plane of d.
        u = e3[2] * d - lean * UP
        u_rate = e3_rate[2] * d + e3[2] * d_rate - lean_rate * UP
        return Contact(e3, e3_rate, d, u, r * u - h * e3, r * u_rate - h * e3_rate)

    def motion(self, state, acceleration=(0.0, 0.0, 0.0)):
        """Return rates and forces at a `state` as a `Motion`; `acceleration` (3,) [m/s²] is that of the plane."""
        mass, gravity = self.column.mass, self.column.gravity
        at, spin, inertia = self.contact(state), state[TURNING], self._inertia(state)
        arm, turning = _crossing(at.arm), _crossing(spin)
        size = 9 if self.hold == "free" else 10
        system, known = np.zeros((size, size)), np.zeros(size)
        # m v̇ = F − m g Z − m a
        system[LINEAR, LINEAR] = mass * IDENTITY
        system[LINEAR, FORCE] = -IDENTITY
        known[LINEAR] = -mass * gravity * UP - mass * np.asarray(acceleration, dtype=float)
        # I ω̇ + ω × Iω = ρ × F + couples, of which rolling resistance goes with the unknown N
        system[ANGULAR, ANGULAR] = inertia
        system[ANGULAR, FORCE] = -arm
        system[ANGULAR, NORMAL] += self.rolling_arm * self._rolling(spin)
        known[ANGULAR] = self._couples(spin, at) - turning @ inertia @ spin
        # v + ω × ρ = 0, whose rate is v̇ + ω̇ × ρ + ω × ρ̇ = 0
        system[FORCE, LINEAR] = IDENTITY
        system[FORCE, ANGULAR] = -arm
        known[FORCE] = -turning @ at.arm_rate
        along, along_rate = self._held(at)
        if size > MULTIPLIER:
            # ω·c = 0, whose rate is ω̇·c + ω·ċ = 0, kept by a couple along c
            system[MULTIPLIER, ANGULAR] = along
            system[ANGULAR, MULTIPLIER] = -along
            known[MULTIPLIER] = -spin @ along_rate
        found = np.linalg.solve(system, known)
        attitude_rate = 0.5 * _product(np.append(0.0, spin), state[ATTITUDE])
        rates = np.concatenate([state[VELOCITY], attitude_rate, found[LINEAR], found[ANGULAR]])
        return Motion(rates, found[FORCE], found[MULTIPLIER] * along if size > MULTIPLIER else np.zeros(3))

    def energy(self, state):
        """Return kinetic and potential energy [J]."""
        speed, spin = state[VELOCITY], state[TURNING]
        kinetic = 0.5 * self.column.mass * speed @ speed + 0.5 * spin @ self._inertia(state) @ spin
        return kinetic + self.column.mass * self.column.gravity * state[2]

    def power(self, state, acceleration=(0.0, 0.0, 0.0)):
        """Return the rate of `energy` [W] that the accelerations of a `state` amount to."""
        rates, speed, spin = self.motion(state, acceleration).rates, state[VELOCITY], state[TURNING]
        lifting = self.column.mass * self.column.gravity * speed[2]
        # ω·(ω × Iω) = 0 is what a turning I would add.
        return self.column.mass * speed @ rates[VELOCITY] + spin @ self._inertia(state) @ rates[TURNING] + lifting

    def follow(self, start, *, duration, acceleration=at_rest, times=None, rtol=1e-13, atol=1e-17):
        """Integrate from `start` by DOP853 and return a `Track`.

        Parameters
        ----------
        start
            A state, for example from `state`.
        duration
            The end of the motion, which starts at time 0 [s].
        acceleration
            Function of time [s] which returns (ax, ay, az) [m/s²] of the plane.
        times
            Where to look in between, increasing and inside (0, duration) [s]. A step ends at each of them, so
            none is interpolated; start and end come of themselves.
        rtol, atol
            Tolerances of the integration. The latter is small against attitudes at close passages of the upright.
        """
        nodes = np.concatenate([[0.0], [] if times is None else np.asarray(times, dtype=float), [duration]])
        time, states, chosen = [np.zeros(1)], [np.asarray(start, dtype=float)[np.newaxis]], [0]
        for begin, end in pairwise(nodes):
            run = solve_ivp(
                lambda t, y: self.motion(y, acceleration(t)).rates, (begin, end), states[-1][-1], "DOP853",
                rtol=rtol, atol=atol,
            )  # fmt: skip
            if not run.success:
                raise RuntimeError(run.message)
            time.append(run.t[1:])
            states.append(run.y.T[1:])
            chosen.append(chosen[-1] + len(run.t) - 1)
        return self._track(np.concatenate(time), np.concatenate(states), acceleration, chosen)

    def _inertia(self, state):
        rotation = _rotation(state[ATTITUDE])
        transverse, axial = self.column.transverse_inertia, self.column.axial_inertia
        return rotation @ np.diag([transverse, transverse, axial]) @ rotation.T

    def _couples(self, spin, at):
        tilting = spin - (spin @ at.e3) * at.e3
        return -self.viscous * tilting - self.spin_damping * spin[2] * UP

    def _rolling(self, spin):
        level = np.array([spin[0], spin[1], 0.0])
        return level / math.sqrt(level @ level + self.rolling_rate**2)

    def _held(self, at):
        return (at.e3 + UP, at.e3_rate) if self.hold == "wobbling" else (UP, np.zeros(3))

    def _track(self, time, states, acceleration, chosen):
        """Look at every step, so that angles can be followed and no demand is missed, and keep those `chosen`."""
        ats = [self.contact(state) for state in states]
        motions = [self.motion(state, acceleration(t)) for t, state in zip(time, states, strict=True)]
        e3, e3_rate, d, u, arm = (np.array([getattr(at, name) for at in ats]) for name in Contact._fields[:5])
        n = np.array([at.n for at in ats])
        spin, force = states[:, TURNING], np.array([motion.force for motion in motions])
        theta = np.arctan2(np.hypot(e3[:, 0], e3[:, 1]), e3[:, 2])
        swing = _along(e3_rate, n) / np.sinc(theta / math.pi)  # θ β̇, from sin θ β̇
        touching = states[:, PLACE] + arm
        values = {
            "time": time,
            "state": states,
            "theta": theta,
            "beta": np.unwrap(np.arctan2(d[:, 1], d[:, 0])),
            # Without the turn that tilts it, what is left of the quaternion is (cos χ/2, 0, 0, sin χ/2).
            "twist": 2.0 * np.unwrap(np.arctan2(states[:, 6], states[:, 3])),
            "tilt": theta[:, np.newaxis] * d[:, :2],
            "tilt_rate": _along(e3_rate, u)[:, np.newaxis] * d[:, :2] + swing[:, np.newaxis] * n[:, :2],
            "w1": _along(spin, u),
            "w2": _along(spin, n),
            "w3": _along(spin, e3),
            "contact": touching[:, :2],
            "base_centre": touching[:, :2] - self.column.radius * d[:, :2],
            "normal": force[:, 2],
            "friction_d": _along(force, d),
            "friction_n": _along(force, n),
            "couple": np.array([motion.couple for motion in motions]),
            "energy": np.array([self.energy(state) for state in states]),
            "gap": touching[:, 2],
            "slip": np.linalg.norm(states[:, VELOCITY] + np.cross(spin, arm), axis=1),
        }
        demand = np.hypot(values["friction_d"], values["friction_n"]) / values["normal"]
        return Track(**{name: value[chosen] for name, value in values.items()}, peak_demand=float(demand.max()))


def _along(vectors, directions):
    return np.sum(vectors * directions, axis=1)


# In floats of Python, which are several times as fast as those of short arrays.


def _crossing(vector):
    """Return the matrix of vector ×."""
    x, y, z = vector.tolist()
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def _turn(angle, axis):
    """Return the quaternion of a turn about a unit vector."""
    return np.append(math.cos(angle / 2.0), math.sin(angle / 2.0) * np.asarray(axis))


def _cross(first, second):
    """Return first × second."""
    (a, b, c), (x, y, z) = first.tolist(), second.tolist()
    return np.array([b * z - c * y, c * x - a * z, a * y - b * x])


def _product(first, second):
    """Return the product of two quaternions."""
    (s, a, b, c), (w, x, y, z) = first.tolist(), second.tolist()
    return np.array(
        [
            s * w - a * x - b * y - c * z,
            s * x + w * a + b * z - c * y,
            s * y + w * b + c * x - a * z,
            s * z + w * c + a * y - b * x,
        ]
    )


def _rotation(quaternion):
    """Return the matrix (3, 3) of a quaternion of any length."""
    w, x, y, z = (quaternion / math.sqrt(quaternion @ quaternion)).tolist()
    return np.array(
        [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
            [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
            [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
        ]
    )
