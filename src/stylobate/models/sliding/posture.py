"""Construction and evaluation of states: lean, angular velocity and slip, rates, forces and guards."""

import math

from stylobate.models.finite_tilt import cosine, sine_over_angle
from stylobate.models.sliding.balance import balance
from stylobate.models.sliding.equations import STILL, guards, rates
from stylobate.models.sliding.phases import FLYING, SLIDING, Numbers, State

# Speed of the first slip [STILL]: negligible, but enough for a direction.
KICK = 10.0

Triple = tuple[float, float, float]
Guards = tuple[float, float, float, float, float, float, float]
Forces = tuple[
    float, float, float, float, float, float, float, float, float, float, float, float, float, float, float, float
]


def forces(state: State, now: Triple, n: Numbers) -> Forces:
    """Return the `balance` of a state."""
    return balance(
        state.tilt_x, state.tilt_y, state.tilt_rate_x, state.tilt_rate_y, state.spin, state.velocity_x,
        state.velocity_y, state.heading_x, state.heading_y, state.heading_z, state.contact, now[0], now[1], now[2],
        n.c, n.eta, n.zeta, n.kappa, n.axial, n.resistance, n.kinetic, n.static, n.patch, n.slope_x, n.slope_y,
        n.relief,
    )  # fmt: skip


def rates_of(state: State, now: Triple, n: Numbers) -> Forces:
    """Return the rates of a state."""
    return rates(
        state.tilt_x, state.tilt_y, state.tilt_rate_x, state.tilt_rate_y, state.spin, state.twist, state.footprint_x,
        state.footprint_y, state.velocity_x, state.velocity_y, state.rise, state.rise_rate, state.heading_x,
        state.heading_y, state.heading_z, state.contact, now[0], now[1], now[2], n.c, n.eta, n.zeta, n.kappa, n.axial,
        n.resistance, n.kinetic, n.static, n.patch, n.normal_restitution, n.slope_x, n.slope_y,
        n.relief,
    )  # fmt: skip


def guards_of(state: State, now: Triple, rest: float, n: Numbers) -> Guards:
    """Return the guards of a state, without impacts of the base face."""
    return guards(
        state.tilt_x, state.tilt_y, state.tilt_rate_x, state.tilt_rate_y, state.spin, state.twist, state.footprint_x,
        state.footprint_y, state.velocity_x, state.velocity_y, state.rise, state.rise_rate, state.heading_x,
        state.heading_y, state.heading_z, state.contact, now[0], now[1], now[2], rest, 0.0, n.c, n.eta, n.zeta, n.kappa,
        n.axial, n.resistance, n.kinetic, n.static, n.patch, n.normal_restitution, n.slope_x, n.slope_y,
        n.relief,
    )  # fmt: skip


def advanced(state: State, by: Forces, elapsed: float) -> State:
    """Advance `state` by this time with the rates `by`."""
    return State(
        state.tilt_x + elapsed * by[0], state.tilt_y + elapsed * by[1], state.tilt_rate_x + elapsed * by[2],
        state.tilt_rate_y + elapsed * by[3], state.spin + elapsed * by[4], state.twist + elapsed * by[5],
        state.footprint_x + elapsed * by[6], state.footprint_y + elapsed * by[7], state.velocity_x + elapsed * by[8],
        state.velocity_y + elapsed * by[9], state.rise + elapsed * by[10], state.rise_rate + elapsed * by[11],
        state.heading_x, state.heading_y, state.heading_z, state.contact,
    )  # fmt: skip


def placed(state: State, lean: tuple[float, float, float, float], spin: float, contact: float) -> State:
    """Return `state` with this lean and its rate, spin and kind of contact."""
    return State(
        lean[0], lean[1], lean[2], lean[3], spin, state.twist, state.footprint_x, state.footprint_y,
        state.velocity_x, state.velocity_y, state.rise, state.rise_rate, state.heading_x, state.heading_y,
        state.heading_z, contact,
    )  # fmt: skip


def moving(state: State, velocity: tuple[float, float], rise: float, climb: float, contact: float) -> State:
    """Return `state` with this velocity, height and its rate, and kind of contact."""
    return State(
        state.tilt_x, state.tilt_y, state.tilt_rate_x, state.tilt_rate_y, state.spin, state.twist,
        state.footprint_x, state.footprint_y, velocity[0], velocity[1], rise, climb, state.heading_x,
        state.heading_y, state.heading_z, contact,
    )  # fmt: skip


def headed(state: State, heading: Triple, contact: float) -> State:
    """Return `state` with this heading and kind of contact."""
    return State(
        state.tilt_x, state.tilt_y, state.tilt_rate_x, state.tilt_rate_y, state.spin, state.twist,
        state.footprint_x, state.footprint_y, state.velocity_x, state.velocity_y, state.rise, state.rise_rate,
        heading[0], heading[1], heading[2], contact,
    )  # fmt: skip


def radius_of(state: State, n: Numbers) -> float:
    """Return the radius of the contact: that of the patch, or of the base."""
    return n.c if state.contact == SLIDING else n.patch * n.c


def lean_of(state: State) -> tuple[float, float, float, float]:
    """Return the direction d of the lean, and sine and cosine of the tilt; at zero tilt, d of the tilt rate."""
    square = state.tilt_x**2 + state.tilt_y**2
    tilt = math.sqrt(square)
    if tilt > 0.0:
        return state.tilt_x / tilt, state.tilt_y / tilt, sine_over_angle(square) * tilt, cosine(square)
    speed = math.hypot(state.tilt_rate_x, state.tilt_rate_y)
    return state.tilt_rate_x / speed, state.tilt_rate_y / speed, 0.0, 1.0


def lean_with_rate(state: State) -> tuple[float, float, float, float]:
    """Return the tilt vector and its rate."""
    return state.tilt_x, state.tilt_y, state.tilt_rate_x, state.tilt_rate_y


def turning(state: State) -> tuple[float, float]:
    """Return w1 and w2."""
    ux, uy, _, _ = lean_of(state)
    square = state.tilt_x**2 + state.tilt_y**2
    across = state.tilt_rate_y * ux - state.tilt_rate_x * uy
    return -sine_over_angle(square) * across, state.tilt_rate_x * ux + state.tilt_rate_y * uy


def yaw(state: State) -> float:
    """Return ω_z."""
    if state.tilt_x == 0.0 and state.tilt_y == 0.0:
        return state.spin
    _, _, sine, cos = lean_of(state)
    w1, _ = turning(state)
    return state.spin * cos - w1 * sine


def height_of(sine: float, cos: float, c: float) -> float:
    """Return the height of the centre of mass of a column on its rim above that of a standing column."""
    return c * sine - sine * sine / (1.0 + cos)


def headed_along_slip(state: State, n: Numbers) -> State:
    """Return `state` with its heading along its slip."""
    slip_z = radius_of(state, n) * yaw(state)
    size = math.sqrt(state.velocity_x**2 + state.velocity_y**2 + slip_z**2)
    if size == 0.0:
        return state
    return headed(state, (state.velocity_x / size, state.velocity_y / size, slip_z / size), state.contact)


def slips(vx: float, vy: float, turning: float) -> bool:
    """Return whether a slip is fast enough to count as slip."""
    return math.sqrt(vx * vx + vy * vy + turning * turning) > KICK * STILL


def tilt_speed(state: State) -> float:
    """Return |α̇| plus a tiny number, which keeps it above zero."""
    return math.hypot(state.tilt_rate_x, state.tilt_rate_y) + 1e-300


def energy_of(state: State, n: Numbers) -> tuple[float, float]:
    """Return the kinetic energy, and the potential energy of the centre of mass above rest [m g h]."""
    kinetic = n.kappa * n.axial * (n.c * state.spin) ** 2
    mx, my, climb, lift = state.velocity_x, state.velocity_y, 0.0, 0.0
    if state.tilt_x != 0.0 or state.tilt_y != 0.0 or state.tilt_rate_x != 0.0 or state.tilt_rate_y != 0.0:
        ux, uy, sine, cos = lean_of(state)
        w1, w2 = turning(state)
        ahead, swing = (cos + n.c * sine) * w2, n.c * state.spin + w1
        mx, my = mx + ahead * ux + swing * uy, my + ahead * uy - swing * ux
        climb, lift = (n.c * cos - sine) * w2, height_of(sine, cos, n.c)
        kinetic += (1.0 - n.kappa) * (w1 * w1 + w2 * w2)
    if state.contact == FLYING:
        mx, my, climb, lift = state.velocity_x, state.velocity_y, state.rise_rate, state.rise
    kinetic += n.kappa * (mx * mx + my * my + climb * climb)
    return 0.5 * kinetic, (1.0 - n.relief) * lift


def with_energy_limit(energy: float, state: State, n: Numbers) -> State:
    """Return `state` with all velocities reduced by one factor if its energy exceeds `energy`."""
    kinetic, lift = energy_of(state, n)
    if kinetic + lift <= energy:
        return state
    part = math.sqrt(max(energy - lift, 0.0) / kinetic)
    rates = (state.tilt_x, state.tilt_y, part * state.tilt_rate_x, part * state.tilt_rate_y)
    slower = placed(state, rates, part * state.spin, state.contact)
    velocity = (part * state.velocity_x, part * state.velocity_y)
    return moving(slower, velocity, state.rise, part * state.rise_rate, state.contact)
