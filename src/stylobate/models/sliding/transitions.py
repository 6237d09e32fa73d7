"""What becomes of a column when a kind of contact ends."""

import math
from typing import NamedTuple

from stylobate.models.finite_tilt import cosine, sine_over_angle
from stylobate.models.free_twist import departing
from stylobate.models.model import Push
from stylobate.models.sliding.balance import balance
from stylobate.models.sliding.equations import JAM, STILL, margins, rates
from stylobate.models.sliding.friction import TWISTING_BASE, sense_of
from stylobate.models.sliding.impacts import base_impulse, impulse, rebound, responses
from stylobate.models.sliding.phases import Numbers, State

_RESTING, _SLIDING, _ROLLING, _SLIPPING, _FLYING = 0.0, 1.0, 2.0, 3.0, 4.0
_JAMMED = 5.0
_LIFT, _FRICTION, _SUPPORT, _REST, _JAM, _STROKE = 0, 1, 2, 3, 4, 6

# Slip begins with so much [STILL], too little to be seen and enough to have a direction.
_KICK = 10.0

# A weight that counts as none [m g]: there a sliding base lifts off, and friction vanishes with it.
_WEIGHTLESS = 1e-12

# A base that trips while it slides begins to tilt by so much [c].
_TRIPPED = 1e-9

# The first of a slip takes no longer than the contact point takes for this part of the way round the rim [rad].
_PART_OF_A_TURN = 0.02

# The direction in which a contact gives way is found in so many steps at most, by differences over a small turn, until
# it is the same.
_MOST_TURNS, _SMALL_TURN, _SAME = 20, 1e-7, 1e-9

# A rim that strikes again and again does so at most so often, and no more below this part of its first speed.
_MOST_STRIKES, _FAINT = 50, 1e-10

Triple = tuple[float, float, float]
Margins = tuple[float, float, float, float, float, float, float]
Forces = tuple[
    float, float, float, float, float, float, float, float, float, float, float, float, float, float, float, float
]


def reaction(
    state: State, event: int, now: Triple, later: Triple, ahead: float, rest: float, numbers: Numbers
) -> tuple[float, State]:
    """Return how much later, and in which state, a column goes on whose margin of this number fell below nought.

    Parameters
    ----------
    state
        State at the event.
    event
        Place of the margin in MARGINS; any other number asks how a column in this state goes on.
    now, later, ahead
        Base accelerations [g] at the event, and so much `ahead` of it, from which a release goes.
    rest
        ε.
    numbers
        Parameters of the model.
    """
    rim = state.contact == _ROLLING or state.contact == _SLIPPING  # noqa: PLR1714  this is what Numba knows
    flies = state.contact == _FLYING
    if rim and event == _STROKE:
        return stroke(state, now, later, ahead, rest, numbers)
    if rim and event == _REST:
        return set_down(state, now, later, ahead, numbers)
    if rim and event == _JAM:
        return settle_rim(jammed(state, numbers), now, later, ahead, numbers)
    if rim and event == _LIFT:
        return leaving(state, now, later, ahead, numbers)
    if rim and event == _FRICTION and state.contact == _SLIPPING:
        return stopped(state, now, later, ahead, numbers)
    if rim and event == _FRICTION:
        return giving_way(state, now, later, ahead, numbers)
    if rim:
        return settle_rim(state, now, later, ahead, numbers)
    if flies:
        return land(state, now, later, ahead, rest, numbers)
    if event == _LIFT:
        return 0.0, lifted(state, numbers)
    if state.contact == _SLIDING:
        if event == _FRICTION:
            return stopped(state, now, later, ahead, numbers)
        if event == _SUPPORT and 1.0 + now[2] - numbers.relief > _WEIGHTLESS:
            return tripping(state, now, later, ahead, numbers)
        if event == _SUPPORT:
            return 0.0, lifted(state, numbers)
        return settle_flat(state, now, later, ahead, numbers)
    if event == _FRICTION:
        return set_sliding(state, now, later, ahead, numbers)
    if event == _SUPPORT:
        return released(state, now, later, ahead, numbers)
    return settle_flat(state, now, later, ahead, numbers)


def forces(state: State, now: Triple, n: Numbers) -> Forces:
    """Return what `balance` tells of a state."""
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
        n.resistance, n.kinetic, n.static, n.patch, n.restitution, n.passage_tilt, n.slope_x, n.slope_y, n.relief,
    )  # fmt: skip


def margins_of(state: State, now: Triple, rest: float, n: Numbers) -> Margins:
    """Return the margins of a state."""
    return margins(
        state.tilt_x, state.tilt_y, state.tilt_rate_x, state.tilt_rate_y, state.spin, state.twist, state.footprint_x,
        state.footprint_y, state.velocity_x, state.velocity_y, state.rise, state.rise_rate, state.heading_x,
        state.heading_y, state.heading_z, state.contact, now[0], now[1], now[2], rest, n.c, n.eta, n.zeta, n.kappa,
        n.axial, n.resistance, n.kinetic, n.static, n.patch, n.restitution, n.passage_tilt, n.slope_x, n.slope_y,
        n.relief,
    )  # fmt: skip


def advanced(state: State, by: Forces, elapsed: float) -> State:
    """Return `state` after this time with the rates `by`."""
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
    """Return the radius of what touches: that of the patch, or of the base."""
    return n.c if state.contact == _SLIDING else n.patch * n.c


def lean_of(state: State) -> tuple[float, float, float, float]:
    """Return the direction d of the lean, its sine and its cosine; upright, that in which it begins to lean."""
    square = state.tilt_x**2 + state.tilt_y**2
    tilt = math.sqrt(square)
    if tilt > 0.0:
        return state.tilt_x / tilt, state.tilt_y / tilt, sine_over_angle(square) * tilt, cosine(square)
    speed = math.hypot(state.tilt_rate_x, state.tilt_rate_y)
    return state.tilt_rate_x / speed, state.tilt_rate_y / speed, 0.0, 1.0


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
    """Return how much higher the centre of mass of a column on its rim is than that of one that stands."""
    return c * sine - sine * sine / (1.0 + cos)


def headed_along_slip(state: State, n: Numbers) -> State:
    """Return `state` with its heading along its slip."""
    slip_z = radius_of(state, n) * yaw(state)
    size = math.sqrt(state.velocity_x**2 + state.velocity_y**2 + slip_z**2)
    if size == 0.0:
        return state
    return headed(state, (state.velocity_x / size, state.velocity_y / size, slip_z / size), state.contact)


# --- on the rim


def settle_rim(state: State, now: Triple, later: Triple, ahead: float, n: Numbers) -> tuple[float, State]:
    """Return how a column goes on whose rim touches the plane and neither closes in nor opens."""
    if slips(state.velocity_x, state.velocity_y, n.patch * n.c * yaw(state)):
        slipping = headed_along_slip(placed(state, lean_with_rate(state), state.spin, _SLIPPING), n)
        found = forces(slipping, now, n)
        if found[11] >= JAM:
            return 0.0, slipping if found[5] > 0.0 else lifted(slipping, n)
        state = jammed(slipping, n)
    still = held(state, n)
    found = forces(still, now, n)
    if found[5] > 0.0 and found[10] > 0.0:
        return 0.0, still
    return (0.0, lifted(still, n)) if opens(still, now, n) else giving_way(still, now, later, ahead, n)


def leaving(state: State, now: Triple, later: Triple, ahead: float, n: Numbers) -> tuple[float, State]:
    """Return how a column goes on whose rim the plane would have to pull: in the air, or slipping if that presses."""
    if state.contact == _SLIPPING or opens(state, now, n):
        return 0.0, lifted(state, n)
    return giving_way(state, now, later, ahead, n)


def opens(state: State, now: Triple, n: Numbers) -> bool:
    """Return whether the rim leaves the plane if it is left to itself: its lowest point then accelerates upwards."""
    free = rates_of(placed(state, lean_with_rate(state), state.spin, _FLYING), now, n)
    ux, uy, sine, cos = lean_of(state)
    _, w2 = turning(state)
    around = (state.tilt_rate_y * ux - state.tilt_rate_x * uy) / math.hypot(state.tilt_x, state.tilt_y)
    falling = free[2] * ux + free[3] * uy + around * around * math.hypot(state.tilt_x, state.tilt_y)
    return free[11] - (n.c * cos - sine) * falling + (cos + n.c * sine) * w2 * w2 >= 0.0


def slips(vx: float, vy: float, turning: float) -> bool:
    """Return whether a slip is one, and does not count as none."""
    return math.sqrt(vx * vx + vy * vy + turning * turning) > _KICK * STILL


def lean_with_rate(state: State) -> tuple[float, float, float, float]:
    """Return the tilt vector and its rate."""
    return state.tilt_x, state.tilt_y, state.tilt_rate_x, state.tilt_rate_y


def held(state: State, n: Numbers) -> State:
    """Return `state` rolling: its contact does not slip, and its patch does not turn."""
    spin = state.spin
    if n.patch > 0.0:
        _, _, sine, cos = lean_of(state)
        spin = turning(state)[0] * sine / cos
    rolling = placed(state, lean_with_rate(state), spin, _ROLLING)
    return headed(moving(rolling, (0.0, 0.0), 0.0, 0.0, _ROLLING), (0.0, 0.0, 0.0), _ROLLING)


def giving_way(state: State, now: Triple, later: Triple, ahead: float, n: Numbers) -> tuple[float, State]:
    """Return a column that has rolled so far a short time after it began to slip.

    Friction then acts on with what it has, along a slip that follows the load. By that the motion departs from rolling
    as the integral of the difference D of their rates, (D(0) + D(δ)) δ/2, with an error of the third power of δ. A slip
    that began from nothing would take its direction from the load within no time: it has grown when it is integrated.
    """
    if forces(slipping_along(state, load_direction(state, now, n), n), now, n)[11] < JAM:
        return 0.0, (lifted(state, n) if opens(state, now, n) else headed(state, (0.0, 0.0, 0.0), _JAMMED))
    # The time in which the contact point goes a small part of the way round the rim
    quick = _PART_OF_A_TURN * math.hypot(state.tilt_x, state.tilt_y) / pace(state)
    if quick < ahead:
        later, ahead = sooner(now, later, quick / ahead), quick
    rolled = rolled_on(state, now, later, ahead, n)
    found = forces(rolled, later, n)
    if found[5] > 0.0 and found[10] > 0.0:
        return ahead, rolled
    if opens(rolled, later, n):
        return ahead, lifted(rolled, n)
    first = slipping_along(state, load_direction(state, now, n), n)
    last = slipping_along(rolled, load_direction(rolled, later, n), n)
    begun = advanced(rolled, rates_of(first, now, n), 0.5 * ahead)
    begun = advanced(begun, rates_of(state, now, n), -0.5 * ahead)
    begun = advanced(begun, rates_of(last, later, n), 0.5 * ahead)
    begun = advanced(begun, rates_of(rolled, later, n), -0.5 * ahead)
    begun = headed_along_slip(headed(begun, (last.heading_x, last.heading_y, last.heading_z), _SLIPPING), n)
    found = forces(begun, later, n)
    return ahead, begun if found[5] > 0.0 else lifted(begun, n)


def pace(state: State) -> float:
    """Return |α̇|, and not nought."""
    return math.hypot(state.tilt_rate_x, state.tilt_rate_y) + 1e-300


def sooner(now: Triple, later: Triple, share: float) -> Triple:
    """Return what lies a share of the way between two accelerations."""
    return (
        now[0] + share * (later[0] - now[0]),
        now[1] + share * (later[1] - now[1]),
        now[2] + share * (later[2] - now[2]),
    )


def slipping_along(state: State, heading: Triple, n: Numbers) -> State:
    """Return a rolling column with a slip along this heading that is too small to be seen."""
    kick = _KICK * STILL
    started = moving(headed(state, heading, _SLIPPING), (kick * heading[0], kick * heading[1]), 0.0, 0.0, _SLIPPING)
    if n.patch == 0.0:
        return started
    _, _, _, cos = lean_of(state)
    spin = state.spin + kick * heading[2] / (n.patch * n.c * cos)
    return placed(started, lean_with_rate(started), spin, _SLIPPING)


def load_direction(state: State, now: Triple, n: Numbers) -> Triple:
    """Return the heading along which a rolling contact gives way: that of the acceleration that its slip would have.

    Found by Newton's rule from the slip whose friction is most like the load; where that has no answer, it is this one.
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
        aside = pulled_aside(state, heading, one, two, now, n)
        by_one = pulled_aside(state, tilted(heading, one, _SMALL_TURN), one, two, now, n)
        by_two = pulled_aside(state, tilted(heading, two, _SMALL_TURN), one, two, now, n)
        a, b = (by_one[0] - aside[0]) / _SMALL_TURN, (by_two[0] - aside[0]) / _SMALL_TURN
        c, d = (by_one[1] - aside[1]) / _SMALL_TURN, (by_two[1] - aside[1]) / _SMALL_TURN
        # The two directions turn with the heading.
        gain = along_slip(state, heading, now, n)
        a, d = a - gain, d - gain
        if n.patch == 0.0:  # a point turns freely: one direction only
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
    """Return two unit vectors across a heading, the first level with the plane."""
    hx, hy, hz = heading
    level = math.hypot(hx, hy)
    one = (-hy / level, hx / level, 0.0) if level > 0.0 else (1.0, 0.0, 0.0)
    return one, (hy * one[2] - hz * one[1], hz * one[0] - hx * one[2], hx * one[1] - hy * one[0])


def tilted(heading: Triple, way: Triple, angle: float) -> Triple:
    """Return a heading turned towards a `way` across it by an angle whose tangent is told."""
    x, y, z = heading[0] + angle * way[0], heading[1] + angle * way[1], heading[2] + angle * way[2]
    size = math.sqrt(x * x + y * y + z * z)
    return x / size, y / size, z / size


def pulled_aside(
    state: State, heading: Triple, one: Triple, two: Triple, now: Triple, n: Numbers
) -> tuple[float, float]:
    """Return the acceleration of a slip along a heading, across that: its parts along two directions."""
    found = forces(slipping_along(state, heading, n), now, n)
    x, y, z = found[3], found[4], found[9]
    return x * one[0] + y * one[1] + z * one[2], x * two[0] + y * two[1] + z * two[2]


def along_slip(state: State, heading: Triple, now: Triple, n: Numbers) -> float:
    """Return the acceleration of a slip along its heading."""
    found = forces(slipping_along(state, heading, n), now, n)
    return found[3] * heading[0] + found[4] * heading[1] + found[9] * heading[2]


def rolled_on(state: State, now: Triple, later: Triple, elapsed: float, n: Numbers) -> State:
    """Return a column that goes on rolling for a short time, by the classical rule of Runge and Kutta."""
    middle = (0.5 * (now[0] + later[0]), 0.5 * (now[1] + later[1]), 0.5 * (now[2] + later[2]))
    first = rates_of(state, now, n)
    second = rates_of(advanced(state, first, 0.5 * elapsed), middle, n)
    third = rates_of(advanced(state, second, 0.5 * elapsed), middle, n)
    fourth = rates_of(advanced(state, third, elapsed), later, n)
    end = advanced(advanced(state, first, elapsed / 6.0), second, elapsed / 3.0)
    return advanced(advanced(end, third, elapsed / 3.0), fourth, elapsed / 6.0)


def stopped(state: State, now: Triple, later: Triple, ahead: float, n: Numbers) -> tuple[float, State]:
    """Return how a column goes on whose slip has all but ended."""
    if state.contact == _SLIDING:
        still = moving(placed(state, lean_with_rate(state), 0.0, _RESTING), (0.0, 0.0), 0.0, 0.0, _RESTING)
        return settle_flat(still, now, later, ahead, n)
    return settle_rim(held(state, n), now, later, ahead, n)


def jammed(state: State, n: Numbers) -> State:
    """Return the state after the impulse with which slip ends where Painlevé's denominator vanishes.

    It stops all velocity of the contact, and takes energy: that is the end of a normal force that grows beyond bounds.
    """
    ux, uy, sine, cos = lean_of(state)
    vd = state.velocity_x * ux + state.velocity_y * uy
    vn = state.velocity_y * ux - state.velocity_x * uy
    dd, dz, zz, nn = responses(sine, cos, n.c, n.kappa, n.axial)
    along = -vd / (dd - dz * dz / zz)
    struck = kicked(state, (along, -vn / nn, -dz / zz * along), n)
    return moving(struck, (0.0, 0.0), 0.0, 0.0, _SLIPPING)


def kicked(state: State, struck: Triple, n: Numbers) -> State:
    """Return `state` turning as it does after an impulse along d, n and the vertical at its lowest point."""
    ux, uy, sine, cos = lean_of(state)
    w1, w2 = turning(state)
    w1 += struck[1] / (1.0 - n.kappa)
    w2 -= ((n.c * cos - sine) * struck[2] + (cos + n.c * sine) * struck[0]) / (1.0 - n.kappa)
    spin = state.spin + struck[1] / (n.kappa * n.axial * n.c)
    across = -w1 / sine_over_angle(state.tilt_x**2 + state.tilt_y**2)
    rate = (w2 * ux - across * uy, w2 * uy + across * ux)
    return placed(state, (state.tilt_x, state.tilt_y, rate[0], rate[1]), spin, state.contact)


# --- the stroke of the base


class Body(NamedTuple):
    """A column that stands upright for a moment: velocity of its centre of mass, rate of its tilt, and spin."""

    velocity_x: float
    velocity_y: float
    climb: float
    rate_x: float
    rate_y: float
    spin: float


def stroke(state: State, now: Triple, later: Triple, ahead: float, rest: float, n: Numbers) -> tuple[float, State]:
    """Return how a column goes on whose base strikes the plane: on the other side, after an impact of the rim there.

    The passage is taken for one in the vertical plane of its motion, with the energy that it has. e_n = 0 is Housner's
    impact; where the column then leans another way than the struck point lies, the rim strikes again, until it rests
    on the point towards which it leans.
    """
    x, y, vx, vy = lean_with_rate(state)
    tilt, pace = math.hypot(x, y), math.hypot(vx, vy)
    ux, uy = vx / pace, vy / pace
    # A path that leads straight to the upright is followed there, and as long behind it.
    straight = -(x * ux + y * uy) > 0.5 * tilt
    elapsed = 2.0 * tilt / pace if straight else 0.0
    speed = planar_speed(state, (ux, uy), n)
    body = Body(
        state.velocity_x + speed * ux - n.c * state.spin * uy,
        state.velocity_y + speed * uy + n.c * state.spin * ux,
        -n.c * speed,
        speed * ux,
        speed * uy,
        state.spin,
    )
    bounce = rebound(n.restitution, 2.0 * n.c * speed)
    body = struck_at(body, ux, uy, bounce, n)
    if bounce > 0.0:
        return elapsed, flying_from(state, body, (tilt * ux, tilt * uy), n)
    behind = 0.5 * elapsed if straight else 0.0
    further, after = coming_down(state, body, tilt, behind, now, later, ahead, rest, n)
    return elapsed + further, after


def coming_down(
    state: State,
    body: Body,
    tilt: float,
    behind: float,
    now: Triple,
    later: Triple,
    ahead: float,
    rest: float,
    n: Numbers,
) -> tuple[float, State]:
    """Return how a column goes on that has struck the plane, upright, and stays on it.

    It strikes again until it rests on the point of its rim towards which it leans, by `tilt`, or by as much as it goes
    in the time `behind` the upright.
    """
    speed = math.hypot(body.velocity_x, body.velocity_y) + math.hypot(body.rate_x, body.rate_y) + abs(body.climb)
    for _ in range(_MOST_STRIKES):
        pace = math.hypot(body.rate_x, body.rate_y)
        if pace <= _FAINT * speed:
            break
        ux, uy = body.rate_x / pace, body.rate_y / pace
        if body.climb - n.c * pace >= -_FAINT * speed:
            reach = pace * behind if behind > 0.0 else tilt
            after = placed(state, (reach * ux, reach * uy, body.rate_x, body.rate_y), body.spin, _SLIPPING)
            sx = body.velocity_x - body.rate_x - n.c * body.spin * uy
            sy = body.velocity_y - body.rate_y + n.c * body.spin * ux
            after = moving(after, (sx, sy), 0.0, 0.0, _SLIPPING)
            if rests(after, now, rest, n):
                return set_down(after, now, later, ahead, n)
            return settle_rim(after, now, later, ahead, n)
        body = struck_at(body, ux, uy, 0.0, n)
    return flattened(state, body, now, later, ahead, n)


def planar_speed(state: State, way: tuple[float, float], n: Numbers) -> float:
    """Return the rate of tilt with which a column passes the upright in a plane that has the energy of `state`.

    It then turns about the point of its rim behind it, with the slip that it has now.
    """
    c, kappa = n.c, n.kappa
    x, y, vx, vy = lean_with_rate(state)
    tilt, sx, sy = math.hypot(x, y), state.velocity_x, state.velocity_y
    dx, dy = (x / tilt, y / tilt) if tilt > 0.0 else (-way[0], -way[1])
    # The centre of mass: v + α̇ − c w3 Z × d where it touches, and upwards
    mx, my, climb = sx + vx + c * state.spin * dy, sy + vy - c * state.spin * dx, c * (vx * dx + vy * dy)
    behind_x, behind_y = sx - c * state.spin * way[1], sy + c * state.spin * way[0]
    energy = 0.5 * kappa * (mx * mx + my * my + climb * climb) + 0.5 * (1.0 - kappa) * (vx * vx + vy * vy)
    energy -= 0.5 * kappa * (behind_x * behind_x + behind_y * behind_y)
    inertia, along = 1.0 + kappa * c * c, kappa * (behind_x * way[0] + behind_y * way[1])
    return max((math.sqrt(max(along * along + 2.0 * inertia * energy, 0.0)) - along) / inertia, 0.0)


def struck_at(body: Body, ux: float, uy: float, bounce: float, n: Numbers) -> Body:
    """Return a column that stands upright after an impact of the point of its rim in the direction (ux, uy)."""
    c, kappa = n.c, n.kappa
    vx = body.velocity_x - body.rate_x - c * body.spin * uy
    vy = body.velocity_y - body.rate_y + c * body.spin * ux
    vz = body.climb - c * (body.rate_x * ux + body.rate_y * uy)
    arrival = (vx * ux + vy * uy, vy * ux - vx * uy, vz)
    pd, pn, pz = impulse(arrival, responses(0.0, 1.0, c, kappa, n.axial), n.kinetic, bounce)
    one, two = pn / (1.0 - kappa), -(c * pz + pd) / (1.0 - kappa)  # of w1 and w2
    return Body(
        body.velocity_x + (pd * ux - pn * uy) / kappa,
        body.velocity_y + (pd * uy + pn * ux) / kappa,
        body.climb + pz / kappa,
        body.rate_x + two * ux + one * uy,
        body.rate_y + two * uy - one * ux,
        body.spin + pn / (kappa * n.axial * c),
    )


def flying_from(state: State, body: Body, lean: tuple[float, float], n: Numbers) -> State:
    """Return a column in the air that the plane has just thrown off, leaning this much."""
    tilt = math.hypot(lean[0], lean[1])
    square = tilt * tilt
    rise = height_of(sine_over_angle(square) * tilt, cosine(square), n.c)
    flying = placed(state, (lean[0], lean[1], body.rate_x, body.rate_y), body.spin, _FLYING)
    flying = moving(flying, (body.velocity_x, body.velocity_y), rise, body.climb, _FLYING)
    return headed(flying, (0.0, 0.0, 0.0), _FLYING)


def flattened(state: State, body: Body, now: Triple, later: Triple, ahead: float, n: Numbers) -> tuple[float, State]:
    """Return a column too squat to rock over to its other side: its whole base stops on the plane."""
    approach, vx, vy = max(-body.climb, 0.0), body.velocity_x, body.velocity_y
    kx, ky, turned = base_impulse(vx, vy, body.spin, approach, n.kinetic, TWISTING_BASE, n.c, n.axial * n.c * n.c)
    flat = placed(state, (0.0, 0.0, 0.0, 0.0), body.spin + turned, _SLIDING)
    return settle_flat(moving(flat, (vx + kx, vy + ky), 0.0, 0.0, _SLIDING), now, later, ahead, n)


def rests(state: State, now: Triple, rest: float, n: Numbers) -> bool:
    """Return whether a column on its rim comes to rest there, as the margin "rest" tells."""
    return margins_of(state, now, rest, n)[_REST] < 0.0


def set_down(state: State, now: Triple, later: Triple, ahead: float, n: Numbers) -> tuple[float, State]:
    """Return how a column goes on that comes to rest on its rim: it stops, or its base slides on where it can."""
    flat = upright(state, n)
    if n.kinetic > n.c:
        flat = moving(placed(flat, lean_with_rate(flat), 0.0, _SLIDING), (0.0, 0.0), 0.0, 0.0, _SLIDING)
    return settle_flat(flat, now, later, ahead, n)


# --- on the base


def upright(state: State, n: Numbers) -> State:
    """Return a column on its rim set down on its base, with the slip of the middle of its base."""
    ux, uy, _, _ = lean_of(state) if state.tilt_x != 0.0 or state.tilt_y != 0.0 else (0.0, 0.0, 0.0, 1.0)
    velocity = (state.velocity_x + n.c * state.spin * uy, state.velocity_y - n.c * state.spin * ux)
    return moving(placed(state, (0.0, 0.0, 0.0, 0.0), state.spin, _SLIDING), velocity, 0.0, 0.0, _SLIDING)


def settle_flat(state: State, now: Triple, later: Triple, ahead: float, n: Numbers) -> tuple[float, State]:
    """Return how a column goes on that stands on its base: at rest, sliding, released or in the air."""
    weight = 1.0 + now[2] - n.relief
    if weight <= 0.0:
        return 0.0, lifted(state, n)
    if slips(state.velocity_x, state.velocity_y, n.c * state.spin):
        sliding = headed_along_slip(headed(state, (state.heading_x, state.heading_y, state.heading_z), _SLIDING), n)
        found = forces(sliding, now, n)
        if math.hypot(found[6], found[7]) <= n.c * weight:
            return 0.0, sliding
        return tripping(sliding, now, later, ahead, n)
    standing = moving(placed(state, (0.0, 0.0, 0.0, 0.0), 0.0, _RESTING), (0.0, 0.0), 0.0, 0.0, _RESTING)
    standing = headed(standing, (0.0, 0.0, 0.0), _RESTING)
    px, py = now[0] + n.slope_x, now[1] + n.slope_y
    pushed = math.hypot(px, py)
    if pushed <= min(n.static, n.c) * weight:
        return 0.0, standing
    if n.static <= n.c:
        return set_sliding(standing, now, later, ahead, n)
    return released(standing, now, later, ahead, n)


def set_sliding(state: State, now: Triple, later: Triple, ahead: float, n: Numbers) -> tuple[float, State]:
    """Return a column that has stood so far a short time after it began to slide."""
    first, last = set_off(state, now, n), set_off(state, later, n)
    begun = advanced(state, rates_of(first, now, n), 0.5 * ahead)
    begun = advanced(begun, rates_of(last, later, n), 0.5 * ahead)
    begun = headed(begun, (last.heading_x, last.heading_y, 0.0), _SLIDING)
    forward = begun.velocity_x * last.heading_x + begun.velocity_y * last.heading_y
    return ahead, headed_along_slip(begun, n) if forward > 0.0 else state


def set_off(state: State, now: Triple, n: Numbers) -> State:
    """Return a column that stands, sliding against the acceleration of the base too slowly to be seen."""
    px, py = now[0] + n.slope_x, now[1] + n.slope_y
    pushed, kick = math.hypot(px, py), _KICK * STILL
    way = (-px / pushed, -py / pushed)
    return moving(headed(state, (way[0], way[1], 0.0), _SLIDING), (kick * way[0], kick * way[1]), 0.0, 0.0, _SLIDING)


def released(state: State, now: Triple, later: Triple, ahead: float, n: Numbers) -> tuple[float, State]:
    """Return a column a short time after the base has let it go."""
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
    x, y, vx, vy, spin = departing(push, ahead, 1.0 + n.kappa * n.c**2, n.c, n.eta, n.kappa, n.axial)
    if x == 0.0 and y == 0.0:
        return ahead, state
    further, after = settle_rim(placed(state, (x, y, vx, vy), spin, _ROLLING), later, later, ahead, n)
    return ahead + further, after


def tripping(state: State, now: Triple, later: Triple, ahead: float, n: Numbers) -> tuple[float, State]:
    """Return a sliding column that friction has begun to tip, against its direction."""
    sliding = forces(state, now, n)
    drag = math.hypot(sliding[6], sliding[7])
    way = (-sliding[6] / drag, -sliding[7] / drag)
    tilt = _TRIPPED * n.c
    leaning = placed(state, (tilt * way[0], tilt * way[1], 0.0, 0.0), state.spin, _SLIPPING)
    # From the middle of the base to its rim
    vx, vy = state.velocity_x - n.c * state.spin * way[1], state.velocity_y + n.c * state.spin * way[0]
    leaning = headed_along_slip(moving(leaning, (vx, vy), 0.0, 0.0, _SLIPPING), n)
    found = forces(leaning, now, n)
    if found[11] < JAM:
        return settle_rim(jammed(leaning, n), now, later, ahead, n)
    pull = max(found[0] * way[0] + found[1] * way[1], 0.0)
    rate = math.sqrt(2.0 * pull * tilt)
    leaning = placed(leaning, (tilt * way[0], tilt * way[1], rate * way[0], rate * way[1]), state.spin, _SLIPPING)
    elapsed, after = settle_rim(leaning, now, later, ahead, n)
    return elapsed + (2.0 * tilt / rate if rate > 0.0 else 0.0), after


# --- in the air


def lifted(state: State, n: Numbers) -> State:
    """Return a column that leaves the plane without an impact."""
    return lifted_with(state, 0.0, n)


def lifted_with(state: State, opening: float, n: Numbers) -> State:
    """Return a column in the air whose lowest point leaves the plane with this speed."""
    if state.tilt_x == 0.0 and state.tilt_y == 0.0:
        return headed(
            moving(state, (state.velocity_x, state.velocity_y), 0.0, opening, _FLYING), (0.0, 0.0, 0.0), _FLYING
        )
    ux, uy, sine, cos = lean_of(state)
    w1, w2 = turning(state)
    # V_d = v_d + ρ'w2, V_n = v_n − w, and z' w2 upwards
    ahead, swing = (cos + n.c * sine) * w2, n.c * state.spin + w1
    velocity = (state.velocity_x + ahead * ux + swing * uy, state.velocity_y + ahead * uy - swing * ux)
    flying = moving(state, velocity, height_of(sine, cos, n.c), opening + (n.c * cos - sine) * w2, _FLYING)
    return headed(flying, (0.0, 0.0, 0.0), _FLYING)


def land(state: State, now: Triple, later: Triple, ahead: float, rest: float, n: Numbers) -> tuple[float, State]:
    """Return how a column goes on whose lowest point has come down on the plane."""
    if state.tilt_x == 0.0 and state.tilt_y == 0.0 and state.tilt_rate_x == 0.0 and state.tilt_rate_y == 0.0:
        return land_flat(state, now, later, ahead, n)
    ux, uy, sine, cos = lean_of(state)
    w1, w2 = turning(state)
    vd = state.velocity_x * ux + state.velocity_y * uy - (cos + n.c * sine) * w2
    vn = state.velocity_y * ux - state.velocity_x * uy + n.c * state.spin + w1
    vz = state.rise_rate - (n.c * cos - sine) * w2
    if state.tilt_x == 0.0 and state.tilt_y == 0.0:
        tilt = _TRIPPED * n.c
        state = placed(state, (tilt * ux, tilt * uy, state.tilt_rate_x, state.tilt_rate_y), state.spin, state.contact)
    if vz >= 0.0:
        return settle_rim(touching(state, vd, vn, ux, uy), now, later, ahead, n)
    response = responses(sine, cos, n.c, n.kappa, n.axial)
    bounce = rebound(n.restitution, -vz)
    pd, pn, pz = impulse((vd, vn, vz), response, n.kinetic, bounce)
    dd, dz, _, nn = response
    struck = touching(kicked(state, (pd, pn, pz), n), vd + dd * pd + dz * pz, vn + nn * pn, ux, uy)
    if bounce > 0.0:
        return 0.0, lifted_with(struck, -bounce * vz, n)
    if rests(struck, now, rest, n):
        return set_down(struck, now, later, ahead, n)
    return settle_rim(struck, now, later, ahead, n)


def touching(state: State, vd: float, vn: float, ux: float, uy: float) -> State:
    """Return a column whose lowest point touches, with this velocity."""
    return moving(state, (vd * ux - vn * uy, vd * uy + vn * ux), 0.0, 0.0, _SLIPPING)


def land_flat(state: State, now: Triple, later: Triple, ahead: float, n: Numbers) -> tuple[float, State]:
    """Return how a column goes on that comes down on the whole of its base: it may trip over the edge in front."""
    vx, vy, approach = state.velocity_x, state.velocity_y, max(-state.rise_rate, 0.0)
    bounce = rebound(n.restitution, approach)
    normal = (1.0 + bounce) * approach
    inertia = n.axial * n.c * n.c  # I_a/κ
    kx, ky, turned = base_impulse(vx, vy, state.spin, normal, n.kinetic, TWISTING_BASE, n.c, inertia)
    if math.hypot(kx, ky) > n.c * normal:
        speed, tilt = math.hypot(vx, vy), _TRIPPED * n.c
        body = struck_at(Body(vx, vy, -approach, 0.0, 0.0, state.spin), vx / speed, vy / speed, bounce, n)
        if bounce > 0.0:
            return 0.0, flying_from(state, body, (tilt * vx / speed, tilt * vy / speed), n)
        return coming_down(state, body, tilt, 0.0, now, later, ahead, 0.0, n)
    flat = placed(state, (0.0, 0.0, 0.0, 0.0), state.spin + turned, _SLIDING)
    if bounce > 0.0:
        return 0.0, moving(flat, (vx + kx, vy + ky), 0.0, bounce * approach, _FLYING)
    return settle_flat(moving(flat, (vx + kx, vy + ky), 0.0, 0.0, _SLIDING), now, later, ahead, n)
