"""Impacts of the sliding column, and its transition when a kind of contact ends."""

import math
from typing import NamedTuple

from stylobate.models.finite_tilt import TINY, cosine, sine_over_angle
from stylobate.models.sliding.balance import (
    FLYING,
    RESTING,
    ROLLING,
    SLIDING,
    SLIPPING,
    TWISTING_BASE,
    SlidingNumbers,
    SlidingState,
)
from stylobate.models.sliding.equations import (
    KICK,
    STILL,
    Triple,
    energy_of,
    forces,
    headed,
    headed_along_slip,
    height_of,
    lean_of,
    lean_with_rate,
    moving,
    placed,
    radius_of,
    turning,
    with_energy_limit,
    yaw,
)
from stylobate.models.sliding.rim_and_base import (
    TRIPPED,
    base_impulse,
    begin_slip,
    held,
    impulse,
    jammed,
    kicked,
    leaving,
    lifted,
    lifted_with,
    rebound,
    responses,
    rests,
    set_down,
    set_sliding,
    settle_flat,
    settle_rim,
    tripping,
    uplifted,
)

# Maximum number of repeated impacts of a rim, and fraction of the first speed below which they stop.
_MOST_STRIKES, _FAINT = 50, 1e-10


class _Body(NamedTuple):
    """Motion of a column that is momentarily vertical: velocity of the centre of mass, tilt rate and spin."""

    velocity_x: float
    velocity_y: float
    climb: float
    rate_x: float
    rate_y: float
    spin: float


def face_impact(
    state: SlidingState, now: Triple, later: Triple, ahead: float, rest: float, n: SlidingNumbers
) -> tuple[float, SlidingState]:
    """Return elapsed time and state after an impact of the base face, which is an impact of the opposite rim point.

    The passage is computed in the vertical plane of the motion with the energy of the state. If this energy is too
    small for the slip, the column strikes with its actual velocities. e_n = 0 is Housner's impact. If the column then
    does not lean towards the struck point, the rim strikes again, until the column rests on the point towards which it
    leans. The impact neglects the tilt but adds no energy.
    """
    x, y, vx, vy = lean_with_rate(state)
    tilt, pace = math.hypot(x, y), math.hypot(vx, vy)
    ux, uy = vx / pace, vy / pace
    # A path straight to the vertical is followed to the vertical, and for the same time behind it.
    straight = -(x * ux + y * uy) > 0.5 * tilt
    elapsed = 2.0 * tilt / pace if straight else 0.0
    speed = _planar_speed(state, (ux, uy), n)
    body = in_plane(state, (ux, uy), speed, n) if speed >= 0.0 else _as_it_is(state, n)
    approach = n.c * (body.rate_x * ux + body.rate_y * uy) - body.climb
    bounce = rebound(n.normal_restitution, approach)
    body = _struck_at(body, ux, uy, bounce, n)
    if bounce > 0.0:
        kinetic, lift = energy_of(state, n)
        flying = _flying_from(state, body, (tilt * ux, tilt * uy), n)
        return elapsed, with_energy_limit(kinetic + lift, flying, n)
    behind = 0.5 * elapsed if straight else 0.0
    further, after = _coming_down(state, body, tilt, behind, now, later, ahead, rest, n)
    return elapsed + further, after


def _coming_down(
    state: SlidingState,
    body: _Body,
    tilt: float,
    behind: float,
    now: Triple,
    later: Triple,
    ahead: float,
    rest: float,
    n: SlidingNumbers,
) -> tuple[float, SlidingState]:
    """Return elapsed time and state of a vertical column that has struck the plane and stays on it.

    The rim strikes again until the column rests on the rim point towards which it leans. The tilt is then `tilt`, or
    the tilt rate times the time `behind` the vertical.
    """
    kinetic, lift = energy_of(state, n)
    energy = kinetic + lift
    speed = math.hypot(body.velocity_x, body.velocity_y) + math.hypot(body.rate_x, body.rate_y) + abs(body.climb)
    for _ in range(_MOST_STRIKES):
        pace = math.hypot(body.rate_x, body.rate_y)
        if pace <= _FAINT * speed:
            break
        ux, uy = body.rate_x / pace, body.rate_y / pace
        if body.climb - n.c * pace >= -_FAINT * speed:
            reach = pace * behind if behind > 0.0 else tilt
            after = placed(state, (reach * ux, reach * uy, body.rate_x, body.rate_y), body.spin, SLIPPING)
            sx = body.velocity_x - body.rate_x - n.c * body.spin * uy
            sy = body.velocity_y - body.rate_y + n.c * body.spin * ux
            after = with_energy_limit(energy, moving(after, (sx, sy), 0.0, 0.0, SLIPPING), n)
            if rests(after, now, rest, n):
                return set_down(after, now, later, ahead, n)
            return 0.0, settle_rim(after, now, n)
        body = _struck_at(body, ux, uy, 0.0, n)
    return _flattened(state, body, now, later, ahead, n)


def _planar_speed(state: SlidingState, way: tuple[float, float], n: SlidingNumbers) -> float:
    """Return the tilt rate of a planar passage of the vertical with the energy of `state`.

    The column then turns about the rim point behind it, with the slip of `state`. The result is −1 if this motion has
    more energy than `state`.
    """
    c, kappa = n.c, n.kappa
    body = _as_it_is(state, n)
    behind_x, behind_y = state.velocity_x - c * state.spin * way[1], state.velocity_y + c * state.spin * way[0]
    energy = 0.5 * kappa * (body.velocity_x**2 + body.velocity_y**2 + body.climb**2)
    energy += 0.5 * (1.0 - kappa) * (body.rate_x**2 + body.rate_y**2)
    energy -= 0.5 * kappa * (behind_x * behind_x + behind_y * behind_y)
    inertia, along = 1.0 + kappa * c * c, kappa * (behind_x * way[0] + behind_y * way[1])
    square = along * along + 2.0 * inertia * energy
    return (math.sqrt(square) - along) / inertia if square >= 0.0 and math.sqrt(square) >= along else -1.0


def in_plane(state: SlidingState, way: tuple[float, float], speed: float, n: SlidingNumbers) -> _Body:
    """Return a column that passes the vertical in this direction with this tilt rate, on the rim point behind it."""
    return _Body(
        state.velocity_x + speed * way[0] - n.c * state.spin * way[1],
        state.velocity_y + speed * way[1] + n.c * state.spin * way[0],
        -n.c * speed,
        speed * way[0],
        speed * way[1],
        state.spin,
    )


def _as_it_is(state: SlidingState, n: SlidingNumbers) -> _Body:
    """Return a column near the vertical with the velocities of `state`."""
    x, y, vx, vy = lean_with_rate(state)
    tilt = math.hypot(x, y)
    dx, dy = (x / tilt, y / tilt) if tilt > 0.0 else (-vx / math.hypot(vx, vy), -vy / math.hypot(vx, vy))
    # The centre of mass: v + α̇ − c w3 Z × d for a column that touches, and its vertical velocity
    return _Body(
        state.velocity_x + vx + n.c * state.spin * dy,
        state.velocity_y + vy - n.c * state.spin * dx,
        n.c * (vx * dx + vy * dy),
        vx,
        vy,
        state.spin,
    )


def _struck_at(body: _Body, ux: float, uy: float, bounce: float, n: SlidingNumbers) -> _Body:
    """Return a vertical column after an impact of its rim point in the direction (ux, uy)."""
    c, kappa = n.c, n.kappa
    vx = body.velocity_x - body.rate_x - c * body.spin * uy
    vy = body.velocity_y - body.rate_y + c * body.spin * ux
    vz = body.climb - c * (body.rate_x * ux + body.rate_y * uy)
    arrival = (vx * ux + vy * uy, vy * ux - vx * uy, vz)
    pd, pn, pz = impulse(arrival, responses(0.0, 1.0, c, kappa, n.axial), n.kinetic, bounce)
    one, two = pn / (1.0 - kappa), -(c * pz + pd) / (1.0 - kappa)  # of w1 and w2
    return _Body(
        body.velocity_x + (pd * ux - pn * uy) / kappa,
        body.velocity_y + (pd * uy + pn * ux) / kappa,
        body.climb + pz / kappa,
        body.rate_x + two * ux + one * uy,
        body.rate_y + two * uy - one * ux,
        body.spin + pn / (kappa * n.axial * c),
    )


def _flying_from(state: SlidingState, body: _Body, lean: tuple[float, float], n: SlidingNumbers) -> SlidingState:
    """Return a column with this lean in the air, just after a rebound from the plane."""
    tilt = math.hypot(lean[0], lean[1])
    square = tilt * tilt
    rise = height_of(sine_over_angle(square) * tilt, cosine(square), n.c)
    flying = placed(state, (lean[0], lean[1], body.rate_x, body.rate_y), body.spin, FLYING)
    flying = moving(flying, (body.velocity_x, body.velocity_y), rise, body.climb, FLYING)
    return headed(flying, (0.0, 0.0, 0.0), FLYING)


def _flattened(
    state: SlidingState, body: _Body, now: Triple, later: Triple, ahead: float, n: SlidingNumbers
) -> tuple[float, SlidingState]:
    """Return elapsed time and state of a column too squat to rock to its other side: its base stops on the plane."""
    approach, vx, vy = max(-body.climb, 0.0), body.velocity_x, body.velocity_y
    kx, ky, turned = base_impulse(vx, vy, body.spin, approach, n.kinetic, TWISTING_BASE, n.c, n.axial * n.c * n.c)
    flat = placed(state, (0.0, 0.0, 0.0, 0.0), body.spin + turned, SLIDING)
    return settle_flat(moving(flat, (vx + kx, vy + ky), 0.0, 0.0, SLIDING), now, later, ahead, n)


def land(
    state: SlidingState, now: Triple, later: Triple, ahead: float, rest: float, n: SlidingNumbers
) -> tuple[float, SlidingState]:
    """Return elapsed time and state after the lowest point of a column has landed on the plane."""
    if state.tilt_x == 0.0 and state.tilt_y == 0.0 and state.tilt_rate_x == 0.0 and state.tilt_rate_y == 0.0:
        return _land_flat(state, now, later, ahead, n)
    ux, uy, sine, cos = lean_of(state)
    w1, w2 = turning(state)
    vd = state.velocity_x * ux + state.velocity_y * uy - (cos + n.c * sine) * w2
    vn = state.velocity_y * ux - state.velocity_x * uy + n.c * state.spin + w1
    vz = state.rise_rate - (n.c * cos - sine) * w2
    if state.tilt_x == 0.0 and state.tilt_y == 0.0:
        tilt = TRIPPED * n.c
        state = placed(state, (tilt * ux, tilt * uy, state.tilt_rate_x, state.tilt_rate_y), state.spin, state.contact)
    if vz >= 0.0:
        return 0.0, settle_rim(touching(state, vd, vn, ux, uy), now, n)
    response = responses(sine, cos, n.c, n.kappa, n.axial)
    bounce = rebound(n.normal_restitution, -vz)
    pd, pn, pz = impulse((vd, vn, vz), response, n.kinetic, bounce)
    dd, dz, _, nn = response
    struck = touching(kicked(state, (pd, pn, pz), n), vd + dd * pd + dz * pz, vn + nn * pn, ux, uy)
    if bounce > 0.0:
        return 0.0, lifted_with(struck, -bounce * vz, n)
    if rests(struck, now, rest, n):
        return set_down(struck, now, later, ahead, n)
    return 0.0, settle_rim(struck, now, n)


def touching(state: SlidingState, vd: float, vn: float, ux: float, uy: float) -> SlidingState:
    """Return a column whose lowest point touches the plane with this velocity."""
    return moving(state, (vd * ux - vn * uy, vd * uy + vn * ux), 0.0, 0.0, SLIPPING)


def _land_flat(
    state: SlidingState, now: Triple, later: Triple, ahead: float, n: SlidingNumbers
) -> tuple[float, SlidingState]:
    """Return elapsed time and state of a column that lands on its whole base: it may trip over its leading edge."""
    vx, vy, approach = state.velocity_x, state.velocity_y, max(-state.rise_rate, 0.0)
    bounce = rebound(n.normal_restitution, approach)
    normal = (1.0 + bounce) * approach
    inertia = n.axial * n.c * n.c  # I_a/κ
    kx, ky, turned = base_impulse(vx, vy, state.spin, normal, n.kinetic, TWISTING_BASE, n.c, inertia)
    if math.hypot(kx, ky) > n.c * normal:
        speed, tilt = math.hypot(vx, vy), TRIPPED * n.c
        body = _struck_at(_Body(vx, vy, -approach, 0.0, 0.0, state.spin), vx / speed, vy / speed, bounce, n)
        if bounce > 0.0:
            return 0.0, _flying_from(state, body, (tilt * vx / speed, tilt * vy / speed), n)
        return _coming_down(state, body, tilt, 0.0, now, later, ahead, 0.0, n)
    flat = placed(state, (0.0, 0.0, 0.0, 0.0), state.spin + turned, SLIDING)
    if bounce > 0.0:
        return 0.0, moving(flat, (vx + kx, vy + ky), 0.0, bounce * approach, FLYING)
    return settle_flat(moving(flat, (vx + kx, vy + ky), 0.0, 0.0, SLIDING), now, later, ahead, n)


_LIFT, _FRICTION, _SUPPORT, _REST, _JAM, _FACE_IMPACT = 0, 1, 2, 3, 4, 6

# A weight below this counts as zero [m g]: a sliding base lifts off, and friction vanishes.
_WEIGHTLESS = 1e-12


def _reaction(
    state: SlidingState, event: int, now: Triple, later: Triple, ahead: float, rest: float, numbers: SlidingNumbers
) -> tuple[float, SlidingState]:
    """Return elapsed time and state after the guard of this number has fallen below zero.

    Parameters
    ----------
    state
        State at the event.
    event
        Index of the guard in GUARDS; any other number settles the contact of the state.
    now, later, ahead
        Base accelerations [g] at the event and after the time `ahead`, in which uplift or slip develops.
    rest
        Rest energy ε.
    numbers
        Parameters of the model.
    """
    rim = state.contact in (ROLLING, SLIPPING)
    flies = state.contact == FLYING
    if rim and event == _FACE_IMPACT:
        return face_impact(state, now, later, ahead, rest, numbers)
    if rim and event == _REST:
        return set_down(state, now, later, ahead, numbers)
    if rim and event == _JAM:
        return 0.0, settle_rim(jammed(state, numbers), now, numbers)
    if rim and event == _LIFT:
        return leaving(state, now, later, ahead, numbers)
    if rim and event == _FRICTION and state.contact == SLIPPING:
        return _stopped(state, now, later, ahead, numbers)
    if rim and event == _FRICTION:
        return begin_slip(state, now, later, ahead, numbers)
    if rim:
        return 0.0, settle_rim(state, now, numbers)
    if flies:
        return land(state, now, later, ahead, rest, numbers)
    if event == _LIFT:
        return 0.0, lifted(state, numbers)
    if state.contact == SLIDING:
        if event == _FRICTION:
            return _stopped(state, now, later, ahead, numbers)
        if event == _SUPPORT and 1.0 + now[2] - numbers.relief > _WEIGHTLESS:
            return tripping(state, now, numbers)
        if event == _SUPPORT:
            return 0.0, lifted(state, numbers)
        return settle_flat(state, now, later, ahead, numbers)
    if event == _FRICTION:
        return set_sliding(state, now, later, ahead, numbers)
    if event == _SUPPORT:
        return uplifted(state, now, later, ahead, numbers)
    return settle_flat(state, now, later, ahead, numbers)


def _stopped(
    state: SlidingState, now: Triple, later: Triple, ahead: float, n: SlidingNumbers
) -> tuple[float, SlidingState]:
    """Return elapsed time and state after the slip along the heading has ended.

    A slip that has turned across its heading continues along a new heading. Only a slip close to zero stops.
    """
    slip_z = radius_of(state, n) * yaw(state)
    along = state.velocity_x * state.heading_x + state.velocity_y * state.heading_y + slip_z * state.heading_z
    if math.sqrt(state.velocity_x**2 + state.velocity_y**2 + slip_z**2) > KICK * max(STILL, along):
        return 0.0, headed_along_slip(state, n)
    if state.contact == SLIDING:
        still = moving(placed(state, lean_with_rate(state), 0.0, RESTING), (0.0, 0.0), 0.0, 0.0, RESTING)
        return settle_flat(still, now, later, ahead, n)
    still = settle_rim(held(state, n), now, n)
    if still.contact == ROLLING and forces(still, now, n)[10] <= 0.0:
        return begin_slip(still, now, later, ahead, n)
    return 0.0, still


def reset_map(
    x: float,
    y: float,
    vx: float,
    vy: float,
    w3: float,
    twist: float,
    fx: float,
    fy: float,
    sx: float,
    sy: float,
    rise: float,
    climb: float,
    hx: float,
    hy: float,
    hz: float,
    contact: float,
    event: float,
    ax: float,
    ay: float,
    az: float,
    bx: float,
    by: float,
    bz: float,
    ahead: float,
    rest: float,
    c: float,
    eta: float,
    zeta: float,
    kappa: float,
    axial: float,
    resistance: float,
    kinetic: float,
    static: float,
    patch: float,
    normal_restitution: float,
    slope_x: float,
    slope_y: float,
    relief: float,
) -> tuple[float, SlidingState]:
    """Return elapsed time and state after the end of a kind of contact; see `_reaction`."""
    state = SlidingState(x, y, vx, vy, w3, twist, fx, fy, sx, sy, rise, climb, hx, hy, hz, contact)
    numbers = SlidingNumbers(
        c,
        eta,
        zeta,
        kappa,
        axial,
        resistance,
        kinetic,
        static,
        patch,
        normal_restitution,
        slope_x,
        slope_y,
        relief,
    )
    return _reaction(state, int(event), (ax, ay, az), (bx, by, bz), ahead, rest, numbers)


def project(
    x: float,
    y: float,
    vx: float,
    vy: float,
    w3: float,
    twist: float,
    fx: float,
    fy: float,
    sx: float,
    sy: float,
    rise: float,
    climb: float,
    hx: float,
    hy: float,
    hz: float,
    contact: float,
    c: float,
    _eta: float,
    _zeta: float,
    _kappa: float,
    _axial: float,
    _resistance: float,
    _kinetic: float,
    _static: float,
    patch: float,
    _normal_restitution: float,
    _slope_x: float,
    _slope_y: float,
    _relief: float,
) -> tuple[
    float, float, float, float, float, float, float, float, float, float, float, float, float, float, float, float
]:
    """Return the state with its heading along its slip, if it slips."""
    slides, slips = contact == SLIDING, contact == SLIPPING
    square = x * x + y * y + TINY
    per_angle = sine_over_angle(square)
    # ω_z = w3 cos θ − w1 sin θ
    yawing = w3 * cosine(square) + per_angle * per_angle * (vy * x - vx * y)
    turning = (c if slides else patch * c) * yawing
    size = math.sqrt(sx * sx + sy * sy + turning * turning)
    turns = (slides or slips) and size > 0.0
    per = 1.0 / (size if turns else 1.0)
    hx, hy, hz = sx * per if turns else hx, sy * per if turns else hy, turning * per if turns else hz
    return x, y, vx, vy, w3, twist, fx, fy, sx, sy, rise, climb, hx, hy, hz, contact
