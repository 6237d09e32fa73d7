"""Changes of a column in contact with the plane: lift-off, onset of slip, rolling, jamming, rest, sliding and uplift.

An impulse is limited by friction and adds no energy. The law is that of A. Chatterjee and A. Ruina, "A new algebraic
rigid-body collision law based on impulse space considerations", J. Appl. Mech. 65 (1998): P = (1 + e) P1 + q (P2 − P1).
P1 stops the approach without friction, P2 stops the whole velocity at the contact, and q ≤ 1 is the maximum that |P_t|
≤ μ P_z allows. The law never adds energy for e ≤ 1 and any μ; an impulse on the friction cone against the initial slip
can.
"""

import math

from stylobate.models.finite_tilt import sine_over_angle, uplift_terms
from stylobate.models.model import Push
from stylobate.models.sliding.balance import (
    FLYING,
    JAMMED,
    RESTING,
    ROLLING,
    SLIDING,
    SLIPPING,
    SlidingNumbers,
    SlidingState,
    sense_of,
)
from stylobate.models.sliding.equations import (
    JAM,
    KICK,
    STILL,
    Triple,
    advanced,
    forces,
    guards_of,
    headed,
    headed_along_slip,
    height_of,
    lean_of,
    lean_with_rate,
    moving,
    placed,
    rates_of,
    slips,
    tilt_speed,
    turning,
    yaw,
)
from stylobate.models.vertical import departure_with_spin


def lifted(state: SlidingState, n: SlidingNumbers) -> SlidingState:
    """Return the column in the air at the instant of lift-off without an impact."""
    return lifted_with(state, 0.0, n)


def lifted_with(state: SlidingState, opening: float, n: SlidingNumbers) -> SlidingState:
    """Return a column in the air whose lowest point leaves the plane with this speed."""
    if state.tilt_x == 0.0 and state.tilt_y == 0.0:
        return headed(
            moving(state, (state.velocity_x, state.velocity_y), 0.0, opening, FLYING), (0.0, 0.0, 0.0), FLYING
        )
    ux, uy, sine, cos = lean_of(state)
    w1, w2 = turning(state)
    # V_d = v_d + ρ'w2, V_n = v_n − w, and z' w2 upwards
    ahead, swing = (cos + n.c * sine) * w2, n.c * state.spin + w1
    velocity = (state.velocity_x + ahead * ux + swing * uy, state.velocity_y + ahead * uy - swing * ux)
    flying = moving(state, velocity, height_of(sine, cos, n.c), opening + (n.c * cos - sine) * w2, FLYING)
    return headed(flying, (0.0, 0.0, 0.0), FLYING)


def opens(state: SlidingState, now: Triple, n: SlidingNumbers) -> bool:
    """Return whether the rim would leave the plane: without contact forces its lowest point accelerates upwards."""
    free = rates_of(placed(state, lean_with_rate(state), state.spin, FLYING), now, n)
    ux, uy, sine, cos = lean_of(state)
    _, w2 = turning(state)
    around = (state.tilt_rate_y * ux - state.tilt_rate_x * uy) / math.hypot(state.tilt_x, state.tilt_y)
    falling = free[2] * ux + free[3] * uy + around * around * math.hypot(state.tilt_x, state.tilt_y)
    return free[11] - (n.c * cos - sine) * falling + (cos + n.c * sine) * w2 * w2 >= 0.0


# The onset lasts at most until the contact point has turned by this angle round the rim [rad].
_PART_OF_A_TURN = 0.02

# Acceleration of the slip so far: none.
STARTS = (0.0, 0.0, 0.0)

# Newton's method for the direction of slip: maximum number of steps, angle of the differences, and tolerance.
_MOST_TURNS, _SMALL_TURN, _SAME = 20, 1e-7, 1e-9


def begin_slip(
    state: SlidingState, now: Triple, later: Triple, ahead: float, n: SlidingNumbers
) -> tuple[float, SlidingState]:
    """Return elapsed time and state a short time after a rolling column begins to slip.

    Friction acts with its limit along a slip that follows the load. The motion departs from rolling by the integral of
    the difference D of the rates, (D(0) + D(δ)) δ/2, with an error of the order δ³; D(δ) belongs to a column that
    departs with D(0). A slip that starts at zero would turn to the load at once; integration starts after it has grown.
    """
    first = _slipping_along(state, load_direction(state, now, STARTS, n), KICK * STILL, n)
    started = forces(first, now, n)
    if started[11] < JAM:
        return 0.0, (lifted(state, n) if opens(state, now, n) else headed(state, (0.0, 0.0, 0.0), JAMMED))
    # The time in which the contact point turns by a small angle round the rim
    quick = _PART_OF_A_TURN * math.hypot(state.tilt_x, state.tilt_y) / tilt_speed(state)
    if quick < ahead:
        later, ahead = _sooner(now, later, quick / ahead), quick
    rolled = _rolled_on(state, now, later, ahead, n)
    found = forces(rolled, later, n)
    if found[5] > 0.0 and found[10] > 0.0:
        return ahead, rolled
    if opens(rolled, later, n):
        return ahead, lifted(rolled, n)
    departed = advanced(rolled, rates_of(first, now, n), ahead)
    departed = advanced(departed, rates_of(state, now, n), -ahead)
    pull = (started[3], started[4], started[9])
    slip = max(ahead * math.sqrt(pull[0] ** 2 + pull[1] ** 2 + pull[2] ** 2), KICK * STILL)
    last = _slipping_along(departed, load_direction(departed, later, pull, n), slip, n)
    begun = advanced(rolled, rates_of(first, now, n), 0.5 * ahead)
    begun = advanced(begun, rates_of(state, now, n), -0.5 * ahead)
    begun = advanced(begun, rates_of(last, later, n), 0.5 * ahead)
    begun = advanced(begun, rates_of(rolled, later, n), -0.5 * ahead)
    begun = headed_along_slip(headed(begun, (last.heading_x, last.heading_y, last.heading_z), SLIPPING), n)
    found = forces(begun, later, n)
    return ahead, begun if found[5] > 0.0 else lifted(begun, n)


def _sooner(now: Triple, later: Triple, share: float) -> Triple:
    """Interpolate between two accelerations; `share` is the fraction of the way."""
    return (
        now[0] + share * (later[0] - now[0]),
        now[1] + share * (later[1] - now[1]),
        now[2] + share * (later[2] - now[2]),
    )


def _slipping_along(state: SlidingState, heading: Triple, slip: float, n: SlidingNumbers) -> SlidingState:
    """Return a column with the speed `slip` of slip along this heading."""
    started = moving(headed(state, heading, SLIPPING), (slip * heading[0], slip * heading[1]), 0.0, 0.0, SLIPPING)
    if n.patch == 0.0:
        return started
    _, _, sine, cos = lean_of(state)
    spin = (slip * heading[2] / (n.patch * n.c) + turning(state)[0] * sine) / cos
    return placed(started, lean_with_rate(started), spin, SLIPPING)


def load_direction(state: SlidingState, now: Triple, pull: Triple, n: SlidingNumbers) -> Triple:
    """Return the heading along which a rolling contact begins to slip: that of the acceleration of its slip.

    A slip that began earlier with the acceleration `pull` has the direction of the sum of the two accelerations.
    Newton's method starts from the slip whose friction is closest to the load; if it fails, this slip is the result.
    """
    found = forces(state, now, n)
    drag = math.hypot(found[6], found[7])
    along, about = sense_of(drag, found[8], found[5], n.patch * n.c, n.static)
    if drag == 0.0:
        return 0.0, 0.0, math.copysign(1.0, about)
    guess = (-along * found[6] / drag, -along * found[7] / drag, about)
    heading = guess
    for _ in range(_MOST_TURNS):
        one, two = across(heading)
        here = slip_rate(state, heading, now, pull, n)
        by_one = slip_rate(state, tilted(heading, one, _SMALL_TURN), now, pull, n)
        by_two = slip_rate(state, tilted(heading, two, _SMALL_TURN), now, pull, n)
        aside = dot(here, one), dot(here, two)
        a, b = (dot(by_one, one) - aside[0]) / _SMALL_TURN, (dot(by_two, one) - aside[0]) / _SMALL_TURN
        c, d = (dot(by_one, two) - aside[1]) / _SMALL_TURN, (dot(by_two, two) - aside[1]) / _SMALL_TURN
        # The two directions turn with the heading.
        gain = dot(here, heading)
        a, d = a - gain, d - gain
        if n.patch == 0.0:  # a point has no moment: one direction only
            b, c, d = 0.0, 0.0, 1.0
        size = a * d - b * c
        if size == 0.0:
            return guess
        p, q = (b * aside[1] - d * aside[0]) / size, (c * aside[0] - a * aside[1]) / size
        if n.patch == 0.0:
            q = 0.0
        if math.hypot(p, q) > 1.0:
            return guess
        heading = tilted(tilted(heading, one, p), two, q)
        if math.hypot(p, q) < _SAME:
            return heading
    return guess


def across(heading: Triple) -> tuple[Triple, Triple]:
    """Return two unit vectors across a heading, the first parallel to the plane."""
    hx, hy, hz = heading
    level = math.hypot(hx, hy)
    one = (-hy / level, hx / level, 0.0) if level > 0.0 else (1.0, 0.0, 0.0)
    return one, (hy * one[2] - hz * one[1], hz * one[0] - hx * one[2], hx * one[1] - hy * one[0])


def tilted(heading: Triple, way: Triple, angle: float) -> Triple:
    """Turn a heading towards the direction `way` across it by an angle with the tangent `angle`."""
    x, y, z = heading[0] + angle * way[0], heading[1] + angle * way[1], heading[2] + angle * way[2]
    size = math.sqrt(x * x + y * y + z * z)
    return x / size, y / size, z / size


def slip_rate(state: SlidingState, heading: Triple, now: Triple, pull: Triple, n: SlidingNumbers) -> Triple:
    """Return the acceleration of a slip along a heading, plus `pull`."""
    found = forces(_slipping_along(state, heading, KICK * STILL, n), now, n)
    return found[3] + pull[0], found[4] + pull[1], found[9] + pull[2]


def dot(a: Triple, b: Triple) -> float:
    """Return the scalar product of two vectors."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _rolled_on(state: SlidingState, now: Triple, later: Triple, elapsed: float, n: SlidingNumbers) -> SlidingState:
    """Advance a rolling column by a short time, by the classical rule of Runge and Kutta."""
    middle = (0.5 * (now[0] + later[0]), 0.5 * (now[1] + later[1]), 0.5 * (now[2] + later[2]))
    first = rates_of(state, now, n)
    second = rates_of(advanced(state, first, 0.5 * elapsed), middle, n)
    third = rates_of(advanced(state, second, 0.5 * elapsed), middle, n)
    fourth = rates_of(advanced(state, third, elapsed), later, n)
    end = advanced(advanced(state, first, elapsed / 6.0), second, elapsed / 3.0)
    return advanced(advanced(end, third, elapsed / 3.0), fourth, elapsed / 6.0)


REST_SPEED = 1e-5
"""Minimum speed of a rebound [h ω0]: slower rebounds are plastic, so that a sequence of impacts ends.

Such a rebound rises to 5e-11 κ h, far above the accuracy with which a landing is located.
"""


def responses(sine: float, cos: float, c: float, kappa: float, axial: float) -> tuple[float, float, float, float]:
    """Return the changes of v at the lowest rim point per unit impulse at this point: W_dd, W_dz, W_zz and W_nn."""
    height, slope, transverse = cos + c * sine, c * cos - sine, 1.0 - kappa
    mass = 1.0 / kappa
    return (
        mass + height * height / transverse,
        height * slope / transverse,
        mass + slope * slope / transverse,
        mass + 1.0 / (kappa * axial) + 1.0 / transverse,
    )


def impulse(
    arrival: tuple[float, float, float],
    response: tuple[float, float, float, float],
    coefficient: float,
    normal_restitution: float,
) -> tuple[float, float, float]:
    """Return the impulse along d, n and the vertical at a point that arrives with this velocity."""
    vd, vn, vz = arrival
    dd, dz, zz, nn = response
    smooth = -vz / zz
    # P2 − P1 does not change v_z: its vertical component follows from that along d.
    rough_d = -(vd + dz * smooth) / (dd - dz * dz / zz)
    rough_n, rough_z = -vn / nn, -dz / zz * rough_d
    bounced = (1.0 + normal_restitution) * smooth
    along = math.hypot(rough_d, rough_n)
    short = along - coefficient * rough_z
    share = 1.0 if short <= coefficient * bounced else coefficient * bounced / short
    return share * rough_d, share * rough_n, bounced + share * rough_z


def rebound(normal_restitution: float, approach: float) -> float:
    """Return the restitution of an impact with this approach speed: 0 if the rebound would be too slow."""
    return normal_restitution if normal_restitution * approach > REST_SPEED else 0.0


def base_impulse(
    vx: float, vy: float, w3: float, normal: float, coefficient: float, twisting: float, c: float, inertia: float
) -> tuple[float, float, float]:
    """Return the impulse along x and y, and its moment, of a base that lands flat, over the mass κ and I_a.

    The impulse stops slip and rotation of the base as far as the normal impulse `normal`, over κ, allows each of them.
    """
    speed = math.hypot(vx, vy)
    kept = max(0.0, 1.0 - coefficient * normal / speed) if speed > 0.0 else 0.0
    turning = coefficient * normal * twisting * c / inertia
    spun = max(0.0, 1.0 - turning / abs(w3)) if w3 != 0.0 else 0.0
    return (kept - 1.0) * vx, (kept - 1.0) * vy, (spun - 1.0) * w3


def settle_rim(state: SlidingState, now: Triple, n: SlidingNumbers) -> SlidingState:
    """Return the next state of a column whose rim touches the plane without normal velocity.

    A column without slip rolls, even if friction is too weak: its slip then begins with the next event. Without
    friction it slips at any speed.
    """
    if n.static == 0.0 or slips(state.velocity_x, state.velocity_y, n.patch * n.c * yaw(state)):
        slipping = headed_along_slip(placed(state, lean_with_rate(state), state.spin, SLIPPING), n)
        found = forces(slipping, now, n)
        if found[11] >= JAM:
            return slipping if found[5] > 0.0 else lifted(slipping, n)
        state = jammed(slipping, n)
    still = held(state, n)
    found = forces(still, now, n)
    if found[5] > 0.0 and found[10] > 0.0:
        return still
    return lifted(still, n) if opens(still, now, n) else still


def leaving(
    state: SlidingState, now: Triple, later: Triple, ahead: float, n: SlidingNumbers
) -> tuple[float, SlidingState]:
    """Return elapsed time and state at a negative normal force: in the air, or slipping if slip presses the rim."""
    if state.contact == SLIPPING or opens(state, now, n):
        return 0.0, lifted(state, n)
    return begin_slip(state, now, later, ahead, n)


def held(state: SlidingState, n: SlidingNumbers) -> SlidingState:
    """Return `state` rolling: its contact does not slip, and its patch does not turn."""
    spin = state.spin
    if n.patch > 0.0:
        _, _, sine, cos = lean_of(state)
        spin = turning(state)[0] * sine / cos
    rolling = placed(state, lean_with_rate(state), spin, ROLLING)
    return headed(moving(rolling, (0.0, 0.0), 0.0, 0.0, ROLLING), (0.0, 0.0, 0.0), ROLLING)


def jammed(state: SlidingState, n: SlidingNumbers) -> SlidingState:
    """Return the state after the impulse that ends slip at a zero of Painlevé's denominator (dynamic jamming).

    The impulse stops the contact and dissipates energy; it is the limit of an unbounded normal force.
    """
    ux, uy, sine, cos = lean_of(state)
    vd = state.velocity_x * ux + state.velocity_y * uy
    vn = state.velocity_y * ux - state.velocity_x * uy
    dd, dz, zz, nn = responses(sine, cos, n.c, n.kappa, n.axial)
    along = -vd / (dd - dz * dz / zz)
    struck = kicked(state, (along, -vn / nn, -dz / zz * along), n)
    return moving(struck, (0.0, 0.0), 0.0, 0.0, SLIPPING)


def kicked(state: SlidingState, struck: Triple, n: SlidingNumbers) -> SlidingState:
    """Return `state` with its angular velocity after an impulse along d, n and the vertical at its lowest point."""
    ux, uy, sine, cos = lean_of(state)
    w1, w2 = turning(state)
    w1 += struck[1] / (1.0 - n.kappa)
    w2 -= ((n.c * cos - sine) * struck[2] + (cos + n.c * sine) * struck[0]) / (1.0 - n.kappa)
    spin = state.spin + struck[1] / (n.kappa * n.axial * n.c)
    across = -w1 / sine_over_angle(state.tilt_x**2 + state.tilt_y**2)
    rate = (w2 * ux - across * uy, w2 * uy + across * ux)
    return placed(state, (state.tilt_x, state.tilt_y, rate[0], rate[1]), spin, state.contact)


_REST = 3

# Initial tilt of a sliding base that trips [c].
TRIPPED = 1e-9


def settle_flat(
    state: SlidingState, now: Triple, later: Triple, ahead: float, n: SlidingNumbers
) -> tuple[float, SlidingState]:
    """Return elapsed time and state of a column on its base: at rest, sliding, after uplift or in the air."""
    weight = 1.0 + now[2] - n.relief
    if weight <= 0.0:
        return 0.0, lifted(state, n)
    if slips(state.velocity_x, state.velocity_y, n.c * state.spin):
        sliding = headed_along_slip(headed(state, (state.heading_x, state.heading_y, state.heading_z), SLIDING), n)
        found = forces(sliding, now, n)
        if n.kinetic <= n.c or math.hypot(found[6], found[7]) <= n.c * weight:
            return 0.0, sliding
        return tripping(sliding, now, n)
    standing = moving(placed(state, (0.0, 0.0, 0.0, 0.0), 0.0, RESTING), (0.0, 0.0), 0.0, 0.0, RESTING)
    standing = headed(standing, (0.0, 0.0, 0.0), RESTING)
    px, py = now[0] + n.slope_x, now[1] + n.slope_y
    pushed = math.hypot(px, py)
    if pushed <= min(n.static, n.c) * weight:
        return 0.0, standing
    if n.static <= n.c:
        return set_sliding(standing, now, later, ahead, n)
    return uplifted(standing, now, later, ahead, n)


def _set_flat(state: SlidingState, n: SlidingNumbers) -> SlidingState:
    """Return a column on its rim set down on its base; its velocity is the slip of the centre of the base."""
    ux, uy, _, _ = lean_of(state) if state.tilt_x != 0.0 or state.tilt_y != 0.0 else (0.0, 0.0, 0.0, 1.0)
    velocity = (state.velocity_x + n.c * state.spin * uy, state.velocity_y - n.c * state.spin * ux)
    return moving(placed(state, (0.0, 0.0, 0.0, 0.0), state.spin, SLIDING), velocity, 0.0, 0.0, SLIDING)


def rests(state: SlidingState, now: Triple, rest: float, n: SlidingNumbers) -> bool:
    """Return whether a column on its rim comes to rest by the guard "rest"."""
    return guards_of(state, now, rest, n)[_REST] < 0.0


def set_down(
    state: SlidingState, now: Triple, later: Triple, ahead: float, n: SlidingNumbers
) -> tuple[float, SlidingState]:
    """Return elapsed time and state of a column that comes to rest on its rim: at rest, or its base slides on."""
    flat = _set_flat(state, n)
    if n.kinetic > n.c:
        flat = moving(placed(flat, lean_with_rate(flat), 0.0, SLIDING), (0.0, 0.0), 0.0, 0.0, SLIDING)
    return settle_flat(flat, now, later, ahead, n)


def set_sliding(
    state: SlidingState, now: Triple, later: Triple, ahead: float, n: SlidingNumbers
) -> tuple[float, SlidingState]:
    """Return elapsed time and state a short time after a column at rest begins to slide; at once without friction."""
    if n.static == 0.0:
        return 0.0, headed(state, (0.0, 0.0, 0.0), SLIDING)
    kick = KICK * STILL
    first = _set_off(state, now[0] + n.slope_x, now[1] + n.slope_y, kick)
    pull = rates_of(first, now, n)
    # The direction of the slip is that of the sum of its accelerations.
    px, py = later[0] + n.slope_x - n.kappa * pull[8], later[1] + n.slope_y - n.kappa * pull[9]
    last = _set_off(state, px, py, max(ahead * math.hypot(pull[8], pull[9]), kick))
    begun = advanced(state, pull, 0.5 * ahead)
    begun = advanced(begun, rates_of(last, later, n), 0.5 * ahead)
    begun = headed(begun, (last.heading_x, last.heading_y, 0.0), SLIDING)
    forward = begun.velocity_x * last.heading_x + begun.velocity_y * last.heading_y
    return ahead, headed_along_slip(begun, n) if forward > 0.0 else state


def _set_off(state: SlidingState, px: float, py: float, slip: float) -> SlidingState:
    """Return a standing column that slides with the speed `slip` against an acceleration."""
    pushed = math.hypot(px, py)
    way = (-px / pushed, -py / pushed)
    return moving(headed(state, (way[0], way[1], 0.0), SLIDING), (slip * way[0], slip * way[1]), 0.0, 0.0, SLIDING)


def uplifted(
    state: SlidingState, now: Triple, later: Triple, ahead: float, n: SlidingNumbers
) -> tuple[float, SlidingState]:
    """Return elapsed time and state a short time after uplift."""
    ax, ay, weight = now[0] + n.slope_x, now[1] + n.slope_y, 1.0 + now[2] - n.relief
    bx, by, heavier = later[0] + n.slope_x, later[1] + n.slope_y, 1.0 + later[2] - n.relief
    here, there = math.hypot(ax, ay), math.hypot(bx, by)
    excess = max(here - n.c * weight, 0.0)
    push = Push(
        (-ax / here, -ay / here),
        here,
        excess,
        (there - n.c * heavier - excess) / ahead,
        math.atan2(ax * by - ay * bx, ax * bx + ay * by) / ahead,
    )
    terms = uplift_terms(push, n.c, n.eta, n.kappa, n.resistance)
    x, y, vx, vy, spin = departure_with_spin(push, ahead, terms, n.c, n.kappa, n.axial)
    if x == 0.0 and y == 0.0:
        return ahead, state
    leaning = placed(state, (x, y, vx, vy), spin, ROLLING)
    # Beyond π/2 the column has overturned at once, and its forces mean nothing.
    return ahead, settle_rim(leaning, later, n) if math.hypot(x, y) < 0.5 * math.pi else leaning


def tripping(state: SlidingState, now: Triple, n: SlidingNumbers) -> tuple[float, SlidingState]:
    """Return elapsed time and state of a sliding column that friction begins to tip."""
    sliding = forces(state, now, n)
    drag = math.hypot(sliding[6], sliding[7])
    way = (-sliding[6] / drag, -sliding[7] / drag)
    tilt = TRIPPED * n.c
    leaning = placed(state, (tilt * way[0], tilt * way[1], 0.0, 0.0), state.spin, SLIPPING)
    # From the centre of the base to its rim
    vx, vy = state.velocity_x - n.c * state.spin * way[1], state.velocity_y + n.c * state.spin * way[0]
    leaning = headed_along_slip(moving(leaning, (vx, vy), 0.0, 0.0, SLIPPING), n)
    found = forces(leaning, now, n)
    if found[11] < JAM:
        return 0.0, settle_rim(jammed(leaning, n), now, n)
    pull = max(found[0] * way[0] + found[1] * way[1], 0.0)
    rate = math.sqrt(2.0 * pull * tilt)
    leaning = placed(leaning, (tilt * way[0], tilt * way[1], rate * way[0], rate * way[1]), state.spin, SLIPPING)
    return 2.0 * tilt / rate if rate > 0.0 else 0.0, settle_rim(leaning, now, n)
