"""The rigid column in six freedoms, which may slip on the plane at its rim, leave it and land again; for tests.

Newton's and Euler's equations with a quaternion. Every force of the ground is the answer of a small linear system:
what acceleration of the lowest point of the rim, C, one newton causes there (`Touch.response`), and what that
acceleration must be. Nothing is taken from the models of the package, and no reduced equation of motion is used.

    from .sliding_body import SlidingBody
    from .sliding_events import follow

    body = SlidingBody(column, kinetic=0.2, static=0.25, restitution=0.3)
    track = follow(body, body.state(theta=0.05, slip=(0.1, 0.0)), duration=2.0, acceleration=lambda t: (1.0, 0.0, 0.0))
    track.events[0].kind, track.events[0].time, track.force[-1]

Frame, names and units are those of `constrained_body`, and so is a state (G, q, v, ω). While C touches, what is
integrated is (G, q, v_C, ω) instead: velocities of slip far below those of the body keep all their digits.

Slip is a vector (v_x, v_y, ε ω_z) of three: velocity of C, and how fast the rim of a patch of contact of radius ε
turns. Without a patch the third is left out of all that follows.
"""

import math
from dataclasses import dataclass, field
from typing import Literal, NamedTuple

import numpy as np

import stylobate as sb

from .constrained_body import ATTITUDE, PLACE, TURNING, UP, VELOCITY, _cross, _crossing, _product, _rotation, _turn

IDENTITY = np.eye(3)
# Coulomb's friction on a patch (Contensou), after Zhuravlev: the exponent, and numbers of a pressure after Hertz.
EXPONENT, SLOWED, TWISTING, EASED = 3, 8.0 / (3.0 * math.pi), 3.0 * math.pi / 16.0, 15.0 * math.pi / 16.0


class Touch(NamedTuple):
    """Mechanics of C in a state, before any force is known.

    Attributes
    ----------
    e3, arm, lever
        Axis, ρ from the centre of mass to C, (3,), and the matrix of ρ ×, (3, 3).
    mobility
        I_G⁻¹ (3, 3).
    free_spin
        ω̇ without a force of the ground [rad/s²], (3,).
    free
        v̇_C without one [m/s²], (3,); of it the vertical is how fast the gap would open.
    response
        v̇_C per force at C [1/kg], (3, 3).
    """

    e3: np.ndarray
    arm: np.ndarray
    lever: np.ndarray
    mobility: np.ndarray
    free_spin: np.ndarray
    free: np.ndarray
    response: np.ndarray

    def by_couple(self, couple):
        """Return v̇_C by a couple [m/s²], (3,)."""
        return -self.lever @ (self.mobility @ couple)


class Load(NamedTuple):
    """What the ground exerts: force (3,) at C, couple (3,), and m Z·v̇_C per N, Painlevé's denominator, if C slips."""

    force: np.ndarray
    couple: np.ndarray
    denominator: float = math.nan


NOTHING = Load(np.zeros(3), np.zeros(3))


@dataclass(frozen=True)
class SlidingBody:
    """A column on a plane that holds it by friction as far as that goes, and not at all once it has left.

    Parameters
    ----------
    column
        The body; of its numbers, those it was made from.
    kinetic, static
        Coefficients of friction while C slips, and up to which it does not (`kinetic` unless given).
    restitution, impact
        e_n, velocity of C along Z after an impact per that before, and how friction acts in it: see `impulse`.
    patch
        Radius ε of the contact [m] for pivoting friction; 0 is a point, which resists no pivoting.
    viscous
        D1 of the couple −D1 (w1 u + w2 n) [N m s], while C touches.
    rolling_arm, rolling_rate
        δ [m] and its rate [rad/s] of rolling resistance, as for `ConstrainedBody`.
    """

    column: sb.Column
    kinetic: float = field(kw_only=True)
    static: float | None = field(default=None, kw_only=True)
    restitution: float = field(default=0.0, kw_only=True)
    impact: Literal["stopping", "dissipative"] = field(default="stopping", kw_only=True)
    patch: float = field(default=0.0, kw_only=True)
    viscous: float = field(default=0.0, kw_only=True)
    rolling_arm: float = field(default=0.0, kw_only=True)
    rolling_rate: float = field(default=1e-3, kw_only=True)

    @property
    def threshold(self):
        """The coefficient up to which C does not slip."""
        return self.kinetic if self.static is None else self.static

    def state(self, *, theta, beta=0.0, twist=0.0, w1=0.0, w2=0.0, w3=0.0, slip=(0.0, 0.0), rise=0.0, gap=0.0):
        """Return the state (13,) with C at (r cos β, r sin β, gap) and v_C = (*slip, rise) [m/s]."""
        leaning = _product(_turn(beta, (0.0, 0.0, 1.0)), _turn(theta, (0.0, 1.0, 0.0)))
        attitude = _product(leaning, _turn(twist - beta, (0.0, 0.0, 1.0)))
        turn = _rotation(_product(leaning, _turn(-beta, (0.0, 0.0, 1.0))))
        d = np.array([math.cos(beta), math.sin(beta), 0.0])
        n, e3 = np.array([-d[1], d[0], 0.0]), turn[:, 2]
        u = np.cross(n, e3)
        spin, arm = w1 * u + w2 * n + w3 * e3, self.column.radius * u - self.column.mass_height * e3
        place = self.column.radius * d + gap * UP - arm
        return np.concatenate([place, attitude, np.array([*slip, rise]) - _cross(spin, arm), spin])

    def axis(self, state):
        """Return e3 (3,); both forms of a state will do, here and where only attitude and ω are looked at."""
        return _rotation(state[ATTITUDE])[:, 2]

    def arm(self, state):
        """Return ρ (3,)."""
        e3 = self.axis(state)
        lean = math.hypot(e3[0], e3[1])
        if lean == 0.0:
            return -self.column.mass_height * e3  # upright no point of the rim is the lowest: the centre of the base
        u = np.array([e3[2] * e3[0] / lean, e3[2] * e3[1] / lean, -lean])
        return self.column.radius * u - self.column.mass_height * e3

    def touching(self, state):
        """Return (G, q, v_C, ω) of a `state` (G, q, v, ω)."""
        return self._with_velocity(state, state[VELOCITY] + _cross(state[TURNING], self.arm(state)))

    def whole(self, touching):
        """Return the state (G, q, v, ω) of (G, q, v_C, ω)."""
        return self._with_velocity(touching, touching[VELOCITY] - _cross(touching[TURNING], self.arm(touching)))

    def gap(self, state):
        """Return the height of C above the plane [m]."""
        return state[2] + self.arm(state)[2]

    def touch(self, state, acceleration=(0.0, 0.0, 0.0)):
        """Return the `Touch` of a state in either form; `acceleration` (3,) [m/s²] is that of the plane."""
        r, h, mass = self.column.radius, self.column.mass_height, self.column.mass
        transverse, axial = self.column.transverse_inertia, self.column.axial_inertia
        spin, e3 = state[TURNING], self.axis(state)
        e3_rate = _cross(spin, e3)
        (x, y, z), (x_rate, y_rate, z_rate) = e3.tolist(), e3_rate.tolist()
        lean = math.hypot(x, y)
        d = x / lean, y / lean
        lean_rate = d[0] * x_rate + d[1] * y_rate
        d_rate = (x_rate - lean_rate * d[0]) / lean, (y_rate - lean_rate * d[1]) / lean
        arm = r * np.array([z * d[0], z * d[1], -lean]) - h * e3
        rim_rate = np.array([z_rate * d[0] + z * d_rate[0], z_rate * d[1] + z * d_rate[1], -lean_rate])
        arm_rate = r * rim_rate - h * e3_rate
        mobility = IDENTITY / transverse + (1.0 / axial - 1.0 / transverse) * e3[:, np.newaxis] * e3
        around = spin @ e3
        # I ω̇ + ω × Iω = couple, with Iω = I_t ω + (I_a − I_t)(ω·e3) e3
        couple = -self.viscous * (spin - around * e3) - (axial - transverse) * around * e3_rate
        free_spin = mobility @ couple
        lever = _crossing(arm)
        free = _cross(spin, arm_rate) - lever @ free_spin - self.column.gravity * UP - acceleration
        return Touch(e3, arm, lever, mobility, free_spin, free, IDENTITY / mass - lever @ mobility @ lever)

    def slip(self, touching):
        """Return the slip (3,) [m/s] of (G, q, v_C, ω)."""
        return np.array([*touching[VELOCITY][:2], self.patch * touching[TURNING][2]])

    def friction(self, slip):
        """Return (T_x, T_y, M_z/ε) per μN while slipping, (3,)."""
        speed = math.hypot(slip[0], slip[1])
        if self.patch == 0.0:
            return -slip / speed
        pivoting = abs(slip[2])
        held = math.hypot(speed, pivoting)  # keeps what is raised to a power near 1
        drag = ((speed / held) ** EXPONENT + (SLOWED * pivoting / held) ** EXPONENT) ** (-1.0 / EXPONENT)
        twist = ((pivoting / held) ** EXPONENT + (EASED * speed / held) ** EXPONENT) ** (-1.0 / EXPONENT)
        return -np.array([drag * slip[0], drag * slip[1], TWISTING * twist * slip[2]]) / held

    def reserve(self, load):
        """Return what friction has left before slip: positive inside the set of loads that a patch or point bears.

        On a patch that set is bounded by what `friction` can be: with T in μN and M in 3π/16 μNε,
        T^p + M^p (1 + ((8/3π)^p (15π/16)^p − 1) T^p) = 1.
        """
        drag = math.hypot(load.force[0], load.force[1])
        bound = self.threshold * load.force[2]
        if self.patch == 0.0 or bound <= 0.0:
            return bound - drag
        drag, twist = (drag / bound) ** EXPONENT, abs(load.couple[2]) / (TWISTING * bound * self.patch)
        return 1.0 - drag - twist**EXPONENT * (1.0 + ((SLOWED * EASED) ** EXPONENT - 1.0) * drag)

    def with_slip(self, touching, slip):
        """Return (G, q, v_C, ω) with this slip (3,) and C neither rising nor falling."""
        changed = self._with_velocity(touching, [slip[0], slip[1], 0.0])
        if self.patch > 0.0:
            changed[TURNING.start + 2] = slip[2] / self.patch
        return changed

    def kicked(self, touching, load, speed):
        """Return (G, q, v_C, ω) with a first slip of this `speed` [m/s], that whose friction is most like `load`."""
        drag = math.hypot(load.force[0], load.force[1])
        along = -load.force[:2] / drag if drag > 0.0 else np.zeros(2)
        if self.patch == 0.0:
            return self.with_slip(touching, speed * np.append(along, 0.0))
        # As `reserve` has it: of T in μN, (|v|/s)^p = (8/3π)^p T^p/(1 − T^p).
        part = min(drag / (self.threshold * load.force[2]), 1.0 - 1e-12) ** EXPONENT
        ratio = SLOWED * (part / (1.0 - part)) ** (1.0 / EXPONENT)
        return self.with_slip(
            touching, speed / math.hypot(ratio, 1.0) * np.append(ratio * along, -np.sign(load.couple[2]))
        )

    def held(self, touching, at):
        """Return the `Load` that keeps C, and its patch from turning, where they are."""
        system, rolling = np.zeros((4, 4)), self._rolling(touching[TURNING])
        system[:3, :3] = at.response
        system[:3, 2] += at.by_couple(rolling)
        system[:3, 3] = at.by_couple(UP)
        system[3, :3] = at.mobility[2] @ at.lever
        system[3, 2] += at.mobility[2] @ rolling
        system[3, 3] = at.mobility[2, 2]
        size = 3 if self.patch == 0.0 else 4
        found = np.linalg.solve(system[:size, :size], -np.append(at.free, at.free_spin[2])[:size])
        couple = found[2] * rolling + (found[3] * UP if size > 3 else 0.0)
        return Load(found[:3], couple)

    def slipping(self, touching, at):
        """Return the `Load` while C slips: N keeps the gap shut, and friction follows N and slip."""
        friction = self.kinetic * self.friction(self.slip(touching))
        per_normal = np.array([friction[0], friction[1], 1.0])
        couple = self._rolling(touching[TURNING]) + self.patch * friction[2] * UP
        opening = at.response[2] @ per_normal + at.by_couple(couple)[2]
        normal = -at.free[2] / opening
        return Load(normal * per_normal, normal * couple, self.column.mass * opening)

    def rates_touching(self, touching, at, load):
        """Return the rates (13,) of (G, q, v_C, ω)."""
        spin = touching[TURNING]
        velocity = touching[VELOCITY] - _cross(spin, at.arm)
        angular = at.free_spin + at.mobility @ (at.lever @ load.force + load.couple)
        linear = at.free + at.response @ load.force + at.by_couple(load.couple)
        return np.concatenate([velocity, self._attitude_rate(touching), linear, angular])

    def rates_flying(self, state, acceleration):
        """Return the rates (13,) of (G, q, v, ω) in the air."""
        spin, e3 = state[TURNING], self.axis(state)
        transverse, axial = self.column.transverse_inertia, self.column.axial_inertia
        # The couple −(I_a − I_t)(ω·e3) ω × e3 is across e3.
        angular = (1.0 - axial / transverse) * (spin @ e3) * _cross(spin, e3)
        linear = -self.column.gravity * UP - np.asarray(acceleration, dtype=float)
        return np.concatenate([state[VELOCITY], self._attitude_rate(state), linear, angular])

    def struck(self, state, impulse):
        """Return the state after an `impulse` (3,) at C."""
        at, after = self.touch(state), state.copy()
        after[VELOCITY] += impulse / self.column.mass
        after[TURNING] += at.mobility @ at.lever @ impulse
        return after

    def energy(self, state):
        """Return kinetic and potential energy [J], the latter from the height of the plane."""
        speed, momentum = state[VELOCITY], self.spin_momentum(state)
        height = self.column.gravity * state[PLACE][2]
        return 0.5 * self.column.mass * speed @ speed + 0.5 * state[TURNING] @ momentum + self.column.mass * height

    def spin_momentum(self, state):
        """Return the angular momentum about the centre of mass [N m s], (3,)."""
        spin, e3 = state[TURNING], self.axis(state)
        transverse, axial = self.column.transverse_inertia, self.column.axial_inertia
        return transverse * spin + (axial - transverse) * (spin @ e3) * e3

    def _rolling(self, spin):
        """Couple of rolling resistance per normal force [m]."""
        level = np.array([spin[0], spin[1], 0.0])
        return -self.rolling_arm * level / math.sqrt(level @ level + self.rolling_rate**2)

    @staticmethod
    def _attitude_rate(state):
        return 0.5 * _product(np.array([0.0, *state[TURNING]]), state[ATTITUDE])

    @staticmethod
    def _with_velocity(state, velocity):
        changed = np.array(state, dtype=float)
        changed[VELOCITY] = velocity
        return changed
