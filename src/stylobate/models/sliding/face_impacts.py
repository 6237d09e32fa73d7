"""Impact of the base face: the motion of a column after its base strikes the plane at the vertical."""

import math
from typing import NamedTuple

from stylobate.models.finite_tilt import cosine, sine_over_angle
from stylobate.models.sliding.friction import TWISTING_BASE
from stylobate.models.sliding.impacts import base_impulse, impulse, rebound, responses
from stylobate.models.sliding.on_base import rests, set_down, settle_flat
from stylobate.models.sliding.on_rim import settle_rim
from stylobate.models.sliding.phases import FLYING, SLIDING, SLIPPING, Numbers, State
from stylobate.models.sliding.posture import (
    Triple,
    energy_of,
    headed,
    height_of,
    lean_with_rate,
    moving,
    placed,
    with_energy_limit,
)

# Maximum number of repeated impacts of a rim, and fraction of the first speed below which they stop.
_MOST_STRIKES, _FAINT = 50, 1e-10


class Body(NamedTuple):
    """Motion of a column that is momentarily vertical: velocity of the centre of mass, tilt rate and spin."""

    velocity_x: float
    velocity_y: float
    climb: float
    rate_x: float
    rate_y: float
    spin: float


def face_impact(state: State, now: Triple, later: Triple, ahead: float, rest: float, n: Numbers) -> tuple[float, State]:
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
    speed = planar_speed(state, (ux, uy), n)
    body = in_plane(state, (ux, uy), speed, n) if speed >= 0.0 else as_it_is(state, n)
    approach = n.c * (body.rate_x * ux + body.rate_y * uy) - body.climb
    bounce = rebound(n.normal_restitution, approach)
    body = struck_at(body, ux, uy, bounce, n)
    if bounce > 0.0:
        kinetic, lift = energy_of(state, n)
        flying = flying_from(state, body, (tilt * ux, tilt * uy), n)
        return elapsed, with_energy_limit(kinetic + lift, flying, n)
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
        body = struck_at(body, ux, uy, 0.0, n)
    return flattened(state, body, now, later, ahead, n)


def planar_speed(state: State, way: tuple[float, float], n: Numbers) -> float:
    """Return the tilt rate of a planar passage of the vertical with the energy of `state`.

    The column then turns about the rim point behind it, with the slip of `state`. The result is −1 if this motion has
    more energy than `state`.
    """
    c, kappa = n.c, n.kappa
    body = as_it_is(state, n)
    behind_x, behind_y = state.velocity_x - c * state.spin * way[1], state.velocity_y + c * state.spin * way[0]
    energy = 0.5 * kappa * (body.velocity_x**2 + body.velocity_y**2 + body.climb**2)
    energy += 0.5 * (1.0 - kappa) * (body.rate_x**2 + body.rate_y**2)
    energy -= 0.5 * kappa * (behind_x * behind_x + behind_y * behind_y)
    inertia, along = 1.0 + kappa * c * c, kappa * (behind_x * way[0] + behind_y * way[1])
    square = along * along + 2.0 * inertia * energy
    return (math.sqrt(square) - along) / inertia if square >= 0.0 and math.sqrt(square) >= along else -1.0


def in_plane(state: State, way: tuple[float, float], speed: float, n: Numbers) -> Body:
    """Return a column that passes the vertical in this direction with this tilt rate, on the rim point behind it."""
    return Body(
        state.velocity_x + speed * way[0] - n.c * state.spin * way[1],
        state.velocity_y + speed * way[1] + n.c * state.spin * way[0],
        -n.c * speed,
        speed * way[0],
        speed * way[1],
        state.spin,
    )


def as_it_is(state: State, n: Numbers) -> Body:
    """Return a column near the vertical with the velocities of `state`."""
    x, y, vx, vy = lean_with_rate(state)
    tilt = math.hypot(x, y)
    dx, dy = (x / tilt, y / tilt) if tilt > 0.0 else (-vx / math.hypot(vx, vy), -vy / math.hypot(vx, vy))
    # The centre of mass: v + α̇ − c w3 Z × d for a column that touches, and its vertical velocity
    return Body(
        state.velocity_x + vx + n.c * state.spin * dy,
        state.velocity_y + vy - n.c * state.spin * dx,
        n.c * (vx * dx + vy * dy),
        vx,
        vy,
        state.spin,
    )


def struck_at(body: Body, ux: float, uy: float, bounce: float, n: Numbers) -> Body:
    """Return a vertical column after an impact of its rim point in the direction (ux, uy)."""
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
    """Return a column with this lean in the air, just after a rebound from the plane."""
    tilt = math.hypot(lean[0], lean[1])
    square = tilt * tilt
    rise = height_of(sine_over_angle(square) * tilt, cosine(square), n.c)
    flying = placed(state, (lean[0], lean[1], body.rate_x, body.rate_y), body.spin, FLYING)
    flying = moving(flying, (body.velocity_x, body.velocity_y), rise, body.climb, FLYING)
    return headed(flying, (0.0, 0.0, 0.0), FLYING)


def flattened(state: State, body: Body, now: Triple, later: Triple, ahead: float, n: Numbers) -> tuple[float, State]:
    """Return elapsed time and state of a column too squat to rock to its other side: its base stops on the plane."""
    approach, vx, vy = max(-body.climb, 0.0), body.velocity_x, body.velocity_y
    kx, ky, turned = base_impulse(vx, vy, body.spin, approach, n.kinetic, TWISTING_BASE, n.c, n.axial * n.c * n.c)
    flat = placed(state, (0.0, 0.0, 0.0, 0.0), body.spin + turned, SLIDING)
    return settle_flat(moving(flat, (vx + kx, vy + ky), 0.0, 0.0, SLIDING), now, later, ahead, n)
