"""Rates, contact loads and guards of the sliding column, as functions of plain numbers and of states."""

import math

from stylobate.models.finite_tilt import TINY, cosine, sine_over_angle
from stylobate.models.sliding.balance import (
    FLYING,
    RESTING,
    ROLLING,
    SLIDING,
    SLIPPING,
    SlidingNumbers,
    SlidingState,
    balance,
)

GUARDS = ("lift", "friction", "support", "rest", "jam", "fallen", "face_impact")
"""Names of the `guards` in their order, which are positive under these conditions.

"lift": the contact presses. "friction": the contact holds, or still slips. "support": the base stands without tipping,
or there is air under the rim. "rest": a rocking column has more than the rest energy. "jam": Painlevé's denominator is
above its limit. "fallen": the tilt is below π/2. "face_impact": the base does not strike the plane; it strikes when the
tilt stops decreasing below the passage tilt.
"""

STILL = 1e-10
"""Slip slower than this counts as zero [h ω0]."""

CLEAR = 1e-13
"""A lowest point deeper than this has landed [h] if it moves down."""

JAM = 1e-3
"""Painlevé's denominator at which slip ends by dynamic jamming."""

STRAIGHT = 1e-9
"""A path that passes the vertical closer than this [c] is straight: the column moves in a vertical plane."""

# Tilt within which a straight path is computed in closed form, relative to the smaller of c and the speed.
_CLOSE = 1e-6


def rates(
    x: float,
    y: float,
    vx: float,
    vy: float,
    w3: float,
    _twist: float,
    _fx: float,
    _fy: float,
    sx: float,
    sy: float,
    _rise: float,
    climb: float,
    hx: float,
    hy: float,
    hz: float,
    contact: float,
    ax: float,
    ay: float,
    az: float,
    c: float,
    eta: float,
    zeta: float,
    kappa: float,
    axial: float,
    resistance: float,
    kinetic: float,
    static: float,
    patch: float,
    _normal_restitution: float,
    slope_x: float,
    slope_y: float,
    relief: float,
) -> tuple[
    float, float, float, float, float, float, float, float, float, float, float, float, float, float, float, float
]:
    """Return the rates of the state; kind of contact and heading are constant until an event."""
    bx, by, spin_rate, ox, oy, _, _, _, _, _, _, _, twisting, back_x, back_y, _ = balance(
        x,
        y,
        vx,
        vy,
        w3,
        sx,
        sy,
        hx,
        hy,
        hz,
        contact,
        ax,
        ay,
        az,
        c,
        eta,
        zeta,
        kappa,
        axial,
        resistance,
        kinetic,
        static,
        patch,
        slope_x,
        slope_y,
        relief,
    )
    stays = 1.0 if contact == RESTING else 0.0
    flies = 1.0 if contact == FLYING else 0.0
    return (
        vx,
        vy,
        bx,
        by,
        spin_rate,
        twisting,
        (1.0 - stays) * sx + back_x,
        (1.0 - stays) * sy + back_y,
        ox,
        oy,
        flies * climb,
        -flies * (1.0 + az - relief) / kappa,
        0.0,
        0.0,
        0.0,
        0.0,
    )


def contact_loads(
    x: float,
    y: float,
    vx: float,
    vy: float,
    w3: float,
    _twist: float,
    _fx: float,
    _fy: float,
    sx: float,
    sy: float,
    _rise: float,
    _climb: float,
    hx: float,
    hy: float,
    hz: float,
    contact: float,
    ax: float,
    ay: float,
    az: float,
    c: float,
    eta: float,
    zeta: float,
    kappa: float,
    axial: float,
    resistance: float,
    kinetic: float,
    static: float,
    patch: float,
    _normal_restitution: float,
    slope_x: float,
    slope_y: float,
    relief: float,
) -> tuple[float, float, float]:
    """Return N and |T| over m g, and |M_z| over m g r."""
    _, _, _, _, _, normal, tx, ty, moment, _, _, _, _, _, _, _ = balance(
        x,
        y,
        vx,
        vy,
        w3,
        sx,
        sy,
        hx,
        hy,
        hz,
        contact,
        ax,
        ay,
        az,
        c,
        eta,
        zeta,
        kappa,
        axial,
        resistance,
        kinetic,
        static,
        patch,
        slope_x,
        slope_y,
        relief,
    )
    return normal, math.sqrt(tx * tx + ty * ty), abs(moment) / c


def guards(
    x: float,
    y: float,
    vx: float,
    vy: float,
    w3: float,
    _twist: float,
    _fx: float,
    _fy: float,
    sx: float,
    sy: float,
    rise: float,
    climb: float,
    hx: float,
    hy: float,
    hz: float,
    contact: float,
    ax: float,
    ay: float,
    az: float,
    rest: float,
    passage: float,
    c: float,
    eta: float,
    zeta: float,
    kappa: float,
    axial: float,
    resistance: float,
    kinetic: float,
    static: float,
    patch: float,
    _normal_restitution: float,
    slope_x: float,
    slope_y: float,
    relief: float,
) -> tuple[float, float, float, float, float, float, float]:
    """Return the guards, which are positive as long as a kind of contact lasts, in the order of GUARDS.

    An event ends the contact when a guard falls below zero; the last guard must have been positive before. `rest` is ε:
    a column on its rim comes to rest below the energy ε c² if the plane would hold it. The base strikes if the column
    passes the vertical closer than `passage` [rad].
    """
    _, _, _, ox, oy, normal, tx, ty, _, oz, kept, denominator, _, _, _, yawing = balance(
        x,
        y,
        vx,
        vy,
        w3,
        sx,
        sy,
        hx,
        hy,
        hz,
        contact,
        ax,
        ay,
        az,
        c,
        eta,
        zeta,
        kappa,
        axial,
        resistance,
        kinetic,
        static,
        patch,
        slope_x,
        slope_y,
        relief,
    )
    rolls = contact == ROLLING
    slips = contact == SLIPPING
    flies = contact == FLYING
    stands = contact == RESTING
    rim = 1.0 if rolls or slips else 0.0
    weight = 1.0 + az - relief
    pushed = math.sqrt((ax + slope_x) * (ax + slope_x) + (ay + slope_y) * (ay + slope_y))
    drag = math.sqrt(tx * tx + ty * ty)
    square = x * x + y * y + TINY
    tilt = math.sqrt(square)
    speed = math.sqrt(vx * vx + vy * vy) + TINY
    radial, aside = x * vx + y * vy, abs(x * vy - y * vx) / speed
    # Slip that decreases to zero, or the friction reserve of a contact without slip
    radius = c if contact == SLIDING else patch * c
    slip = sx * hx + sy * hy + radius * yawing * hz
    slipping = max(slip - STILL, ox * hx + oy * hy + oz * hz)
    # Slip without friction has no end.
    free = flies or (static == 0.0 and not (rolls or stands))
    friction = kept if rolls else (static * weight - pushed) if stands else 1.0 if free else slipping
    # Height of the lowest point of the rim
    sine, cos = sine_over_angle(square) * tilt, cosine(square)
    gap = rise - c * sine + sine * sine / (1.0 + cos)
    opening = climb - (c * cos - sine) * (radial / tilt)
    # A base that slides trips only if kinetic friction exceeds c.
    firm = rim > 0.0 or (kinetic <= c and not stands)
    support = max(gap, opening) + CLEAR if flies else 1.0 if firm else c * weight - drag
    energy = 0.5 * (1.0 + kappa * c * c) * speed * speed + c * weight * tilt - rest * c * c
    # Once set down, the base would slide with kinetic friction, or move with the plane; one that would trip stops
    trips = kinetic > c
    bx, by = sx + c * w3 * y / tilt, sy - c * w3 * x / tilt
    left = 0.5 * kappa * (bx * bx + by * by + axial * c * c * w3 * w3) if trips else 0.0
    # A standing column slides only if it does not tip before
    slides = slips or (static <= c and pushed > static * weight)
    burden = kinetic * weight if slides and not trips else pushed
    rests = energy + left if rim > 0.0 and c * weight > burden else 1.0
    # Distance along the path to the vertical: to its closest point, or to the end of the integrated path if it is
    # straight
    straight = aside < min(passage, STRAIGHT * c)
    close = _CLOSE * min(c, speed)
    far = tilt > passage and not (straight and tilt <= close)
    towards = tilt - close if straight else -radial / (tilt * speed)
    striking = 1.0 if rim == 0.0 or far else towards if radial < 0.0 else -1.0
    return (
        1.0 if flies else normal,
        friction,
        support,
        rests,
        denominator - JAM,
        0.5 * math.pi - tilt,
        striking,
    )


# Speed of the first slip [STILL]: negligible, but enough for a direction.
KICK = 10.0

Triple = tuple[float, float, float]
Guards = tuple[float, float, float, float, float, float, float]
Forces = tuple[
    float, float, float, float, float, float, float, float, float, float, float, float, float, float, float, float
]


def forces(state: SlidingState, now: Triple, n: SlidingNumbers) -> Forces:
    """Return the `balance` of a state."""
    return balance(
        state.tilt_x, state.tilt_y, state.tilt_rate_x, state.tilt_rate_y, state.spin, state.velocity_x,
        state.velocity_y, state.heading_x, state.heading_y, state.heading_z, state.contact, now[0], now[1], now[2],
        n.c, n.eta, n.zeta, n.kappa, n.axial, n.resistance, n.kinetic, n.static, n.patch, n.slope_x, n.slope_y,
        n.relief,
    )  # fmt: skip


def rates_of(state: SlidingState, now: Triple, n: SlidingNumbers) -> Forces:
    """Return the rates of a state."""
    return rates(
        state.tilt_x, state.tilt_y, state.tilt_rate_x, state.tilt_rate_y, state.spin, state.twist, state.footprint_x,
        state.footprint_y, state.velocity_x, state.velocity_y, state.rise, state.rise_rate, state.heading_x,
        state.heading_y, state.heading_z, state.contact, now[0], now[1], now[2], n.c, n.eta, n.zeta, n.kappa, n.axial,
        n.resistance, n.kinetic, n.static, n.patch, n.normal_restitution, n.slope_x, n.slope_y,
        n.relief,
    )  # fmt: skip


def guards_of(state: SlidingState, now: Triple, rest: float, n: SlidingNumbers) -> Guards:
    """Return the guards of a state, without impacts of the base face."""
    return guards(
        state.tilt_x, state.tilt_y, state.tilt_rate_x, state.tilt_rate_y, state.spin, state.twist, state.footprint_x,
        state.footprint_y, state.velocity_x, state.velocity_y, state.rise, state.rise_rate, state.heading_x,
        state.heading_y, state.heading_z, state.contact, now[0], now[1], now[2], rest, 0.0, n.c, n.eta, n.zeta, n.kappa,
        n.axial, n.resistance, n.kinetic, n.static, n.patch, n.normal_restitution, n.slope_x, n.slope_y,
        n.relief,
    )  # fmt: skip


def advanced(state: SlidingState, by: Forces, elapsed: float) -> SlidingState:
    """Advance `state` by this time with the rates `by`."""
    return SlidingState(
        state.tilt_x + elapsed * by[0], state.tilt_y + elapsed * by[1], state.tilt_rate_x + elapsed * by[2],
        state.tilt_rate_y + elapsed * by[3], state.spin + elapsed * by[4], state.twist + elapsed * by[5],
        state.footprint_x + elapsed * by[6], state.footprint_y + elapsed * by[7], state.velocity_x + elapsed * by[8],
        state.velocity_y + elapsed * by[9], state.rise + elapsed * by[10], state.rise_rate + elapsed * by[11],
        state.heading_x, state.heading_y, state.heading_z, state.contact,
    )  # fmt: skip


def placed(state: SlidingState, lean: tuple[float, float, float, float], spin: float, contact: float) -> SlidingState:
    """Return `state` with this lean and its rate, spin and kind of contact."""
    return SlidingState(
        lean[0], lean[1], lean[2], lean[3], spin, state.twist, state.footprint_x, state.footprint_y,
        state.velocity_x, state.velocity_y, state.rise, state.rise_rate, state.heading_x, state.heading_y,
        state.heading_z, contact,
    )  # fmt: skip


def moving(
    state: SlidingState, velocity: tuple[float, float], rise: float, climb: float, contact: float
) -> SlidingState:
    """Return `state` with this velocity, height and its rate, and kind of contact."""
    return SlidingState(
        state.tilt_x, state.tilt_y, state.tilt_rate_x, state.tilt_rate_y, state.spin, state.twist,
        state.footprint_x, state.footprint_y, velocity[0], velocity[1], rise, climb, state.heading_x,
        state.heading_y, state.heading_z, contact,
    )  # fmt: skip


def headed(state: SlidingState, heading: Triple, contact: float) -> SlidingState:
    """Return `state` with this heading and kind of contact."""
    return SlidingState(
        state.tilt_x, state.tilt_y, state.tilt_rate_x, state.tilt_rate_y, state.spin, state.twist,
        state.footprint_x, state.footprint_y, state.velocity_x, state.velocity_y, state.rise, state.rise_rate,
        heading[0], heading[1], heading[2], contact,
    )  # fmt: skip


def radius_of(state: SlidingState, n: SlidingNumbers) -> float:
    """Return the radius of the contact: that of the patch, or of the base."""
    return n.c if state.contact == SLIDING else n.patch * n.c


def lean_of(state: SlidingState) -> tuple[float, float, float, float]:
    """Return the direction d of the lean, and sine and cosine of the tilt; at zero tilt, d of the tilt rate."""
    square = state.tilt_x**2 + state.tilt_y**2
    tilt = math.sqrt(square)
    if tilt > 0.0:
        return state.tilt_x / tilt, state.tilt_y / tilt, sine_over_angle(square) * tilt, cosine(square)
    speed = math.hypot(state.tilt_rate_x, state.tilt_rate_y)
    return state.tilt_rate_x / speed, state.tilt_rate_y / speed, 0.0, 1.0


def lean_with_rate(state: SlidingState) -> tuple[float, float, float, float]:
    """Return the tilt vector and its rate."""
    return state.tilt_x, state.tilt_y, state.tilt_rate_x, state.tilt_rate_y


def turning(state: SlidingState) -> tuple[float, float]:
    """Return w1 and w2."""
    ux, uy, _, _ = lean_of(state)
    square = state.tilt_x**2 + state.tilt_y**2
    across = state.tilt_rate_y * ux - state.tilt_rate_x * uy
    return -sine_over_angle(square) * across, state.tilt_rate_x * ux + state.tilt_rate_y * uy


def yaw(state: SlidingState) -> float:
    """Return ω_z."""
    if state.tilt_x == 0.0 and state.tilt_y == 0.0:
        return state.spin
    _, _, sine, cos = lean_of(state)
    w1, _ = turning(state)
    return state.spin * cos - w1 * sine


def height_of(sine: float, cos: float, c: float) -> float:
    """Return the height of the centre of mass of a column on its rim above that of a standing column."""
    return c * sine - sine * sine / (1.0 + cos)


def headed_along_slip(state: SlidingState, n: SlidingNumbers) -> SlidingState:
    """Return `state` with its heading along its slip."""
    slip_z = radius_of(state, n) * yaw(state)
    size = math.sqrt(state.velocity_x**2 + state.velocity_y**2 + slip_z**2)
    if size == 0.0:
        return state
    return headed(state, (state.velocity_x / size, state.velocity_y / size, slip_z / size), state.contact)


def slips(vx: float, vy: float, turning: float) -> bool:
    """Return whether a slip is fast enough to count as slip."""
    return math.sqrt(vx * vx + vy * vy + turning * turning) > KICK * STILL


def tilt_speed(state: SlidingState) -> float:
    """Return |α̇| plus a tiny number, which keeps it above zero."""
    return math.hypot(state.tilt_rate_x, state.tilt_rate_y) + 1e-300


def energy_of(state: SlidingState, n: SlidingNumbers) -> tuple[float, float]:
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


def with_energy_limit(energy: float, state: SlidingState, n: SlidingNumbers) -> SlidingState:
    """Return `state` with all velocities reduced by one factor if its energy exceeds `energy`."""
    kinetic, lift = energy_of(state, n)
    if kinetic + lift <= energy:
        return state
    part = math.sqrt(max(energy - lift, 0.0) / kinetic)
    rates = (state.tilt_x, state.tilt_y, part * state.tilt_rate_x, part * state.tilt_rate_y)
    slower = placed(state, rates, part * state.spin, state.contact)
    velocity = (part * state.velocity_x, part * state.velocity_y)
    return moving(slower, velocity, state.rise, part * state.rise_rate, state.contact)
