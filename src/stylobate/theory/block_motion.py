"""Motion of a block on a harmonically vibrating plane over one period, piece by piece in closed form.

The plane rises by `incline` = ι along x; its normal is z. With the base acceleration (ax cos τ, az cos(τ + φ)) in g,
τ = Ωt, lengths in g/Ω² and velocities in g/Ω, a point mass at the distance s above the plane with the velocity u along
the plane obeys

    u̇ = T − sin ι − ax cos τ,    s̈ = N − cos ι − az cos(τ + φ).

    stick      u = 0, s = 0       T = sin ι + ax cos τ, while |T| ≤ μs N
    slide      u ≷ 0, s = 0       T = ∓μk N, while N ≥ 0
    flight     s > 0              T = N = 0
    landing    at the speed v     Pn = (1 + e)v, |Pt| ≤ μk Pn, at most the impulse that stops the slip

In every phase the forces are one harmonic and a constant (`HarmonicForce`), so velocity and position are trigonometric
functions and polynomials of τ. The next phase begins where a force changes its sign, in closed form,
or where u or s vanishes. Between the zeros of their derivatives, which are known, u and s are monotone: each root is
bracketed and no root is missed. The motion is exact to rounding except for one rule. For e > 0 infinitely many landings
can occur in a finite time. A landing with a rebound below `rest_speed` ends in contact if the plane then presses on the
block. The omitted bounces would last 2 rest_speed/((1 − e)N), see `stylobate.theory.bounce_time`, with the impulse of
the contact in that time.
"""

import cmath
import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from enum import IntEnum

from stylobate.errors import Named, ParameterError
from stylobate.theory.arguments import finite, not_negative, positive
from stylobate.theory.starting import below_elastic, steepness

# Instants closer than this [rad] to the previous one count as the same.
_INSTANT = 1e-14
# A zero this close before τ, by rounding, counts as a zero at τ.
_BEHIND = 1e-12
# Limit of the steps to a root: Newton needs about ten, bisection to rounding fewer than this limit.
_STEPS = 120
_ROUNDING = 4.0 * 2.0**-52


@dataclass(frozen=True, slots=True)
class HarmonicForce:
    """The force constant + Re(swing exp iτ) on a unit mass.

    Parameters
    ----------
    constant
        Mean of the force.
    swing
        Complex amplitude of the harmonic part.
    """

    constant: float
    swing: complex

    @property
    def angle(self) -> float:
        """Phase of the harmonic part."""
        return math.atan2(self.swing.imag, self.swing.real)

    def at(self, tau: float) -> float:
        """Evaluate the force at τ."""
        return self.constant + (self.swing * cmath.exp(1j * tau)).real

    def slope(self, tau: float) -> float:
        """Evaluate the rate of change at τ."""
        return -(self.swing * cmath.exp(1j * tau)).imag

    def gain(self, tau: float, span: float) -> float:
        """Compute the velocity gained between τ and τ + span."""
        turned = self.swing * cmath.exp(1j * tau)
        half = math.sin(0.5 * span)
        return self.constant * span + turned.real * math.sin(span) - turned.imag * 2.0 * half * half

    def travel(self, tau: float, span: float) -> float:
        """Compute the distance gained between τ and τ + span, accurate to rounding of span² for short spans."""
        turned = self.swing * cmath.exp(1j * tau)
        half = math.sin(0.5 * span)
        return (
            0.5 * self.constant * span * span + turned.real * 2.0 * half * half - turned.imag * (span - math.sin(span))
        )

    def next_fall(self, tau: float) -> float:
        """Compute the phase from τ to the next fall below zero: 0 if it falls now, infinite if it never falls."""
        size = abs(self.swing)
        if size <= abs(self.constant):
            return math.inf
        span = (math.acos(-self.constant / size) - self.angle - tau) % TURN
        return 0.0 if span > TURN - _BEHIND else span

    def zeros(self, tau: float, span: float) -> list[float]:
        """Compute the phases from τ to the zeros within `span`, at most a period, in increasing order."""
        size = abs(self.swing)
        if size <= abs(self.constant):
            return []
        angle = math.acos(-self.constant / size)
        places = ((sign * angle - self.angle - tau) % TURN for sign in (-1.0, 1.0))
        return sorted(place for place in places if _INSTANT < place < span)


def root(value: Callable[[float], float], slope: Callable[[float], float], low: float, high: float) -> float:
    """Find the zero of a function that is monotone between `low` and `high` and changes its sign.

    Newton steps while they stay in the bracket, bisection otherwise; accurate to rounding.
    """
    rises = value(high) > 0.0
    x = 0.5 * (low + high)
    for _ in range(_STEPS):
        y, rate = value(x), slope(x)
        if (y > 0.0) == rises:
            high = x
        else:
            low = x
        step = y / rate if rate != 0.0 else math.inf
        newer = x - step
        if not low < newer < high:
            newer = 0.5 * (low + high)
        if abs(newer - x) <= _ROUNDING * abs(newer):
            return newer
        x = newer
    return x


TURN = 2.0 * math.pi
# Relative distance from its limit below which a force counts as at its limit.
_FORCE_ROUNDING = 1e-13
# Minimum duration [rad] of a slip or flight from rest, in case rounding would end it at once.
_LEAST_SPAN = 1e-12


class BlockPhase(Named, IntEnum):
    """The phase of motion of a block on a vibrating plane."""

    STICK = 0
    FORWARD = 1
    """The block slides along +x, uphill."""
    BACKWARD = 2
    FLIGHT = 3


@dataclass(frozen=True, slots=True, kw_only=True)
class BlockSegment:
    """A time interval in which a block stays in one phase. Velocities are relative to the plane.

    Parameters
    ----------
    phase
        Phase of motion.
    start, end
        Ωt from the beginning of the cycle.
    velocity
        Velocity along the plane at the start and at the end [g/Ω]. A jump to the next segment is a landing.
    normal_velocity
        Velocity along the normal at the start and at the end [g/Ω]; 0 except in flight.
    travel
        Distance along the plane [g/Ω²].
    """

    phase: BlockPhase
    start: float
    end: float
    velocity: tuple[float, float]
    normal_velocity: tuple[float, float]
    travel: float


@dataclass(frozen=True, slots=True)
class BlockState:
    """State of a block in its cycle, with the phase of motion that begins."""

    tau: float
    u: float
    s: float
    rise: float
    phase: BlockPhase

    def off(self, other: "BlockState") -> float:
        """Compute the distance to another state at the same phase of the base motion."""
        return max(abs(self.u - other.u), abs(self.s - other.s), abs(self.rise - other.rise))


@dataclass(frozen=True, slots=True)
class BlockOnPlane:
    """A block, its plane and the base motion."""

    weight: HarmonicForce  # N in contact
    pull: HarmonicForce  # T if it sticks
    mu_s: float
    mu_k: float
    normal_restitution: float
    rest_speed: float

    @classmethod
    def checked(
        cls,
        along: float,
        normal: float,
        phase: float,
        incline: float,
        static_friction: float,
        kinetic_friction: float | None,
        *,
        normal_restitution: float,
        rest_speed: float,
    ) -> "BlockOnPlane":
        """Return the block, or raise ParameterError at the first invalid argument of `block_cycle`."""
        mu_s = float(not_negative("static_friction", static_friction))
        mu_k = mu_s if kinetic_friction is None else float(not_negative("kinetic_friction", kinetic_friction))
        if mu_k > mu_s:
            raise ParameterError(f"kinetic_friction must be at most static_friction = {mu_s!r}, got {mu_k!r}")
        psi = float(steepness(incline))
        swing = float(finite("normal", normal)) * cmath.exp(1j * float(finite("phase", phase)))
        return cls(
            weight=HarmonicForce(math.cos(psi), swing),
            pull=HarmonicForce(math.sin(psi), complex(float(finite("along", along)))),
            mu_s=mu_s,
            mu_k=mu_k,
            normal_restitution=float(below_elastic(normal_restitution)),
            rest_speed=float(positive("rest_speed", rest_speed)),
        )

    @property
    def scale(self) -> float:
        """Size of the accelerations [g]."""
        return 1.0 + abs(self.weight.swing) + abs(self.pull.swing)

    def margin(self, mu: float, sense: float) -> HarmonicForce:
        """Return μN + sense T; a slip in this sense begins when it vanishes (μs), and it brakes the slip (μk)."""
        return HarmonicForce(
            mu * self.weight.constant + sense * self.pull.constant, mu * self.weight.swing + sense * self.pull.swing
        )

    def lost(self, force: HarmonicForce, tau: float) -> bool:
        """Return whether a force that must not be negative is negative or becomes negative now."""
        value, rounding = force.at(tau), _FORCE_ROUNDING * self.scale
        return value < -rounding or (value < rounding and force.slope(tau) < 0.0)

    def landed(self, state: BlockState) -> BlockState:
        """Return the state on the plane with the phase of motion that follows."""
        if self.lost(self.weight, state.tau):
            return replace(state, phase=BlockPhase.FLIGHT)
        if state.u != 0.0:
            return replace(state, phase=BlockPhase.FORWARD if state.u > 0.0 else BlockPhase.BACKWARD)
        for phase, sense in ((BlockPhase.FORWARD, 1.0), (BlockPhase.BACKWARD, -1.0)):
            if self.lost(self.margin(self.mu_s, sense), state.tau):
                return replace(state, phase=phase)
        return replace(state, phase=BlockPhase.STICK)

    def turn(self, state: BlockState) -> tuple[list[BlockSegment], BlockState]:
        """Return the segments of one period of the base motion from τ = 0, and the state after it."""
        segments = []
        while state.tau < TURN:
            move = {BlockPhase.STICK: self.stick, BlockPhase.FLIGHT: self.fly}.get(state.phase, self.slide)
            segment, after = move(state, TURN - state.tau)
            if segment.end > segment.start:
                segments.append(segment)
            state = after
        return segments, replace(state, tau=0.0)

    def stick(self, state: BlockState, horizon: float) -> tuple[BlockSegment, BlockState]:
        """Return the segment of a block that sticks, up to a slip, a lift-off or the horizon, and the next state."""
        falls = {
            BlockPhase.FLIGHT: self.weight.next_fall(state.tau),
            BlockPhase.FORWARD: self.margin(self.mu_s, 1.0).next_fall(state.tau),
            BlockPhase.BACKWARD: self.margin(self.mu_s, -1.0).next_fall(state.tau),
        }
        first = min(falls, key=lambda phase: falls[phase])
        span = min(falls[first], horizon)
        after = BlockState(_later(state, span, horizon), 0.0, 0.0, 0.0, first if span < horizon else BlockPhase.STICK)
        return _segment(state, after, 0.0), after

    def slide(self, state: BlockState, horizon: float) -> tuple[BlockSegment, BlockState]:
        """Return the segment of a block that slides, up to a stop, a lift-off or the horizon, and the next state."""
        sense = 1.0 if state.phase is BlockPhase.FORWARD else -1.0
        brake, speed, tau = self.margin(self.mu_k, sense), sense * state.u, state.tau
        lifts = self.weight.next_fall(tau)
        span = min(lifts, horizon)
        stops = _first_zero(
            lambda x: speed - brake.gain(tau, x), lambda x: -brake.at(tau + x), [*brake.zeros(tau, span), span]
        )
        if stops is None:
            u = state.u - sense * brake.gain(tau, span)
            after = BlockState(_later(state, span, horizon), u, 0.0, 0.0, state.phase)
            if span < horizon:
                after = replace(after, phase=BlockPhase.FLIGHT)
        else:
            span = max(stops, 0.0 if speed > 0.0 else min(_LEAST_SPAN, span))
            after = self.landed(BlockState(_later(state, span, horizon), 0.0, 0.0, 0.0, BlockPhase.STICK))
        return _segment(state, after, sense * (speed * span - brake.travel(tau, span))), after

    def fly(self, state: BlockState, horizon: float) -> tuple[BlockSegment, BlockState]:
        """Return the segment of a block in flight, up to a landing or the horizon, and the next state."""
        tau, weight = state.tau, self.weight

        def rise(x: float) -> float:
            return state.rise - weight.gain(tau, x)

        marks = [*weight.zeros(tau, horizon), horizon]
        turns, low = [], 0.0
        for high in marks:
            if rise(low) * rise(high) < 0.0:
                turns.append(root(rise, lambda x: -weight.at(tau + x), low, high))
            turns.append(high)
            low = high
        lands = _first_zero(lambda x: state.s + state.rise * x - weight.travel(tau, x), rise, turns)
        least = 0.0 if state.rise > 0.0 or state.s > 0.0 else min(_LEAST_SPAN, horizon)
        span = horizon if lands is None else max(lands, least)
        u = state.u - self.pull.gain(tau, span)
        travel = state.u * span - self.pull.travel(tau, span)
        end = BlockState(_later(state, span, horizon), u, 0.0, rise(span), BlockPhase.FLIGHT)
        if lands is None:
            end = replace(end, s=state.s + state.rise * span - weight.travel(tau, span))
            return _segment(state, end, travel), end
        return _segment(state, end, travel), self.impact(end)

    def impact(self, state: BlockState) -> BlockState:
        """Return the state after a landing."""
        speed = max(-state.rise, 0.0)
        stays = not self.lost(self.weight, state.tau) and self.normal_restitution * speed < self.rest_speed
        rebound = 0.0 if stays else self.normal_restitution * speed
        grip = self.mu_k * (speed + rebound)
        u = math.copysign(max(abs(state.u) - grip, 0.0), state.u)
        after = replace(state, u=u, rise=rebound)
        return self.landed(after) if rebound == 0.0 else after


def _later(state: BlockState, span: float, horizon: float) -> float:
    return TURN if span >= horizon else state.tau + span


def _first_zero(value: Callable[[float], float], slope: Callable[[float], float], marks: list[float]) -> float | None:
    """Return the first zero of a function that starts positive and is monotone between marks, or None."""
    low = 0.0
    for high in marks:
        if value(high) <= 0.0:
            return root(value, slope, low, high)
        low = high
    return None


def _segment(before: BlockState, after: BlockState, travel: float) -> BlockSegment:
    return BlockSegment(
        phase=before.phase,
        start=before.tau,
        end=after.tau,
        velocity=(before.u, after.u),
        normal_velocity=(before.rise, after.rise),
        travel=travel,
    )
