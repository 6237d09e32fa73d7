"""Transport of a block by a vibrating plane: its cycle, and the bounce once per period in closed form.

`stylobate.theory.block_motion` computes the segments period by period until the motion repeats.

`hopping_speed` needs no such computation: in the simplest motion of a bouncing ball the block leaves with the absolute
normal velocity π cos ι in g/Ω, flies for one period and lands with −π cos ι. The velocity w of the plane then obeys π
cos ι − w = e(π cos ι + w). With the throw number Γ,

    sin s = π(1 − e)/((1 + e)Γ),  cos s < 0,

where s is the phase of the base acceleration cos ι Γ cos s at the landing. The map of deviations δt and δv from one
landing to the next has the determinant e² and the trace 1 + e² + (1 + e)²Γ cos s. So the motion is stable between its
onset at cos s = 0 and the period doubling at −Γ cos s = 2(1 + e²)/(1 + e)² (Holmes 1982).
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from stylobate.errors import require_whole
from stylobate.theory.arguments import (
    BoolArray,
    FloatArray,
    Real,
    Values,
    finite,
    not_negative,
    plain_results,
    positive,
)
from stylobate.theory.block_motion import TURN, BlockOnPlane, BlockPhase, BlockSegment, BlockState
from stylobate.theory.starting import below_elastic, steepness

# If a motion approaches its cycle by the factor −λ per period of the base motion, two periods repeat 1/(1 − λ) times
# better than one. Up to this ratio the shorter cycle counts.
_SLOW = 1e3


@dataclass(frozen=True, slots=True, kw_only=True)
class BlockCycle:
    """The long-term motion of a block on a vibrating plane.

    Parameters
    ----------
    mean_speed
        Mean velocity along the plane [g/Ω], uphill positive; infinite if the block slides ever faster.
    period
        Periods of the base motion after which the motion repeats; 0 if no repetition was found. The cycle is then the
        second half of the computed motion.
    cycles
        Total number of computed periods of the base motion.
    segments
        The cycle, from a zero of Ωt mod 2π.
    """

    mean_speed: float
    period: int
    cycles: int
    segments: tuple[BlockSegment, ...]

    @property
    def repeats(self) -> bool:
        """Whether the motion repeats."""
        return self.period > 0

    @property
    def fraction(self) -> dict[BlockPhase, float]:
        """Fraction of the time spent in each phase."""
        spent = dict.fromkeys(BlockPhase, 0.0)
        for segment in self.segments:
            spent[segment.phase] += segment.end - segment.start
        whole = self.segments[-1].end - self.segments[0].start
        return {phase: time / whole for phase, time in spent.items()}

    @property
    def switches(self) -> tuple[float, ...]:
        """Ωt of each change of phase and each landing that begins another flight, from the start of the cycle."""
        return tuple(segment.end for segment in self.segments[:-1])


@plain_results
def block_cycle(
    along: float,
    normal: float = 0.0,
    *,
    static_friction: float,
    kinetic_friction: float | None = None,
    normal_restitution: float = 0.0,
    phase: float = 0.0,
    incline: float = 0.0,
    start_velocity: float = 0.0,
    start_normal_velocity: float = 0.0,
    cycles: int = 1000,
    longest_period: int = 16,
    tolerance: float = 1e-13,
    rest_speed: float = 1e-9,
) -> BlockCycle:
    """Compute the periodic motion that a block on a harmonically vibrating plane settles to.

    Parameters
    ----------
    along, normal
        Amplitudes of the base acceleration [g]: along·cos τ uphill along the plane, normal·cos(τ + phase) along its
        normal. Vibration of amplitude a along a line at the angle δ to the plane is along = a cos δ, normal = a sin δ.
    static_friction
        μs.
    kinetic_friction
        μk, at most μs and equal to it by default.
    normal_restitution
        Normal restitution e of a landing, below 1.
    phase
        Phase of the normal component [rad].
    incline
        Angle ι of the plane [rad], between −π/2 and π/2.
    start_velocity, start_normal_velocity
        Velocity relative to the plane at τ = 0, along it and, zero or positive, away from it [g/Ω].
    cycles
        Maximum number of computed periods of the base motion.
    longest_period
        Maximum number of periods of the base motion in one repetition.
    tolerance
        Tolerance of the repetition of both velocities [g/Ω] and the distance from the plane [g/Ω²], in units of 1 +
        along + normal.
    rest_speed
        Rebound velocity below which a landing ends in contact [g/Ω].

    Returns
    -------
    BlockCycle
        The cycle reached from these initial conditions. With e > 0 or on a steep plane several cycles can attract;
        other initial conditions may then reach another cycle.

    Raises
    ------
    ParameterError
        If a friction or `start_normal_velocity` is negative, the kinetic friction above the static one,
        `normal_restitution` not in [0, 1), the plane as steep as a wall, `tolerance` or `rest_speed` not positive, or a
        count below 1.

    Notes
    -----
    A contact whose slip has just stopped has static friction: slip resumes only if abs(T) > μs N.

    Averaged over a cycle that repeats, the friction carries the component sin ι of the weight and the normal force
    cos ι, landings included. So with μk < abs(tan ι) a block that never sticks slides down ever faster.

    Examples
    --------
    >>> cycle = block_cycle(0.8 * np.cos(0.5), 0.8 * np.sin(0.5), static_friction=0.4)
    >>> print(round(cycle.mean_speed, 6), cycle.period, [segment.phase.name for segment in cycle.segments])
    0.166664 1 ['BACKWARD', 'STICK', 'FORWARD', 'STICK', 'BACKWARD']
    """
    block = BlockOnPlane.checked(
        along,
        normal,
        phase,
        incline,
        static_friction,
        kinetic_friction,
        normal_restitution=normal_restitution,
        rest_speed=rest_speed,
    )
    for name, count in (("cycles", cycles), ("longest_period", longest_period)):
        require_whole(name, count, least=1)
    near = float(positive("tolerance", tolerance)) * block.scale
    rise = float(not_negative("start_normal_velocity", start_normal_velocity))
    state = BlockState(0.0, float(finite("start_velocity", start_velocity)), 0.0, rise, BlockPhase.FLIGHT)
    state = state if rise > 0.0 else block.landed(state)
    seen, run = [state], list[list[BlockSegment]]()
    for _ in range(cycles):
        segments, state = block.turn(state)
        run.append(segments)
        seen.append(state)
        period = _repeats(seen[-longest_period - 1 :], near)
        if period:
            return _summary(run[-period:], period, len(run))
    cycle = _summary(run[len(run) // 2 :], 0, len(run))
    return replace(cycle, mean_speed=-math.copysign(math.inf, incline)) if _escapes(block, cycle) else cycle


@plain_results
def mean_block_speed(
    along: Real,
    normal: Real = 0.0,
    *,
    static_friction: Real,
    kinetic_friction: Real | None = None,
    normal_restitution: Real = 0.0,
    phase: Real = 0.0,
    incline: Real = 0.0,
    cycles: int = 1000,
) -> Values:
    """Compute the mean transport velocity of a block that begins at rest on a harmonically vibrating plane.

    Parameters
    ----------
    along, normal, static_friction, kinetic_friction, normal_restitution, phase, incline, cycles
        As for `block_cycle`.

    Returns
    -------
    numpy.ndarray
        Mean velocity along the plane [g/Ω], of the broadcast shape, uphill positive. If no repetition was found, the
        mean of the second half of `cycles` periods; infinite if the block slides ever faster.

    Raises
    ------
    ParameterError
        As for `block_cycle`.

    See Also
    --------
    block_cycle : the complete cycle of one block.

    Examples
    --------
    >>> angle = np.radians([20.0, 30.0, 40.0])
    >>> print(mean_block_speed(np.cos(angle), np.sin(angle), static_friction=0.4).round(5))
    [0.21986 0.28063 0.29896]
    """
    kinetic = static_friction if kinetic_friction is None else kinetic_friction
    given = np.broadcast_arrays(
        finite("along", along),
        finite("normal", normal),
        not_negative("static_friction", static_friction),
        not_negative("kinetic_friction", kinetic),
        below_elastic(normal_restitution),
        finite("phase", phase),
        steepness(incline),
    )
    speed = np.empty(given[0].shape)
    for cell in np.ndindex(speed.shape):
        ax, az, mu_s, mu_k, e, phi, psi = (float(number[cell]) for number in given)
        speed[cell] = block_cycle(
            ax,
            az,
            static_friction=mu_s,
            kinetic_friction=mu_k,
            normal_restitution=e,
            phase=phi,
            incline=psi,
            cycles=cycles,
        ).mean_speed
    return speed


def _repeats(seen: list[BlockState], near: float) -> int:
    """Return the number of periods of the base motion after which the last state repeats, or 0."""
    off = [seen[-1].off(state) for state in seen[-2::-1]]
    for period, difference in enumerate(off, 1):
        if difference <= near:
            return next(part for part in range(1, period + 1) if not period % part and off[part - 1] <= _SLOW * near)
    return 0


def _summary(run: list[list[BlockSegment]], period: int, cycles: int) -> BlockCycle:
    """Join the segments of the computed periods into one cycle."""
    joined = list[BlockSegment]()
    for turn, segments in enumerate(run):
        for number, segment in enumerate(segments):
            moved = replace(segment, start=segment.start + turn * TURN, end=segment.end + turn * TURN)
            if turn and not number and joined[-1].phase is moved.phase:
                joined[-1] = _joined(joined[-1], moved)
            else:
                joined.append(moved)
    travel = math.fsum(segment.travel for segment in joined)
    return BlockCycle(mean_speed=travel / (len(run) * TURN), period=period, cycles=cycles, segments=tuple(joined))


def _joined(first: BlockSegment, second: BlockSegment) -> BlockSegment:
    return replace(
        first,
        end=second.end,
        velocity=(first.velocity[0], second.velocity[1]),
        normal_velocity=(first.normal_velocity[0], second.normal_velocity[1]),
        travel=first.travel + second.travel,
    )


def _escapes(block: BlockOnPlane, cycle: BlockCycle) -> bool:
    """Return whether a block that friction cannot hold never stopped sliding down."""
    down = -math.copysign(1.0, block.pull.constant)
    steep = block.mu_k * block.weight.constant < abs(block.pull.constant)
    return steep and all(down * speed > 0.0 for segment in cycle.segments for speed in segment.velocity)


# Nodes that check the flight for an intermediate contact, which comes early.
_NODES, _FIRST = 1024, 1e-4


@plain_results
def hopping_speed(
    along: Real,
    normal: Real,
    *,
    normal_restitution: Real,
    kinetic_friction: Real,
    phase: Real = 0.0,
    incline: Real = 0.0,
) -> Values:
    """Compute the mean transport velocity of a block that bounces once per period of the base motion.

    Parameters
    ----------
    along, normal, normal_restitution, kinetic_friction, phase, incline
        As for `block_cycle`.

    Returns
    -------
    numpy.ndarray
        Mean velocity along the plane [g/Ω], of the broadcast shape, uphill positive; NaN if this motion does not exist
        or is unstable, or if friction does not hold the block on the incline.

    Raises
    ------
    ParameterError
        If `normal`, `normal_restitution` or `kinetic_friction` is negative, `normal_restitution` is 1 or more or the
        plane is as steep as a wall.

    See Also
    --------
    block_cycle : the motion from given initial conditions, often a different one.

    Notes
    -----
    A landing has the normal impulse 2π cos ι. It can stop the slip 2π sin ι, which gravity adds in a flight, if μk ≥
    abs(tan ι). Then the block is thrown without slip and moves, for any friction, at

        along sin(s − phase) − π sin ι

    on average. On a horizontal plane that vibrates along a line this is π(1 − e)/(1 + e) along/normal.

    Exact. An intermediate contact, possible for small e, is checked on 1024 nodes. With e = 0 this motion exists only
    from Γ = √(1 + π²).

    Examples
    --------
    >>> print(hopping_speed(1.0, [1.0, 1.3, 1.6], normal_restitution=0.5, kinetic_friction=0.4).round(6))
    [     nan 0.805537      nan]
    """
    x, z, e, mu, phi, psi = np.broadcast_arrays(
        finite("along", along),
        not_negative("normal", normal),
        below_elastic(normal_restitution),
        not_negative("kinetic_friction", kinetic_friction),
        finite("phase", phase),
        steepness(incline),
    )
    gamma = z / np.cos(psi)
    rising = np.pi * (1.0 - e) / (1.0 + e)  # Γ sin s
    falling = np.sqrt(np.maximum((gamma - rising) * (gamma + rising), 0.0))  # −Γ cos s
    stable = (gamma > rising) & (falling * (1.0 + e) ** 2 < 2.0 * (1.0 + e**2))
    holds = mu * np.cos(psi) >= np.abs(np.sin(psi))
    speed = x * np.sin(np.arctan2(rising, -falling) - phi) - np.pi * np.sin(psi)
    return np.where(stable & holds & _clear(e, rising, falling), speed, np.nan)


def _clear(e: FloatArray, rising: FloatArray, falling: FloatArray) -> BoolArray:
    """Return whether a flight of one period stays above the plane."""
    e, rising, falling = (number[..., np.newaxis] for number in (e, rising, falling))
    x = np.geomspace(_FIRST, 2.0 * np.pi, _NODES, endpoint=False)
    thrown = 2.0 * np.pi * e / (1.0 + e)
    gap = thrown * x - 0.5 * x**2 + 2.0 * falling * np.sin(0.5 * x) ** 2 + rising * (x - np.sin(x))
    lifted = (e[..., 0] > 0.0) | (falling[..., 0] >= 1.0)
    return np.asarray(lifted & (gap > 0.0).all(axis=-1))
