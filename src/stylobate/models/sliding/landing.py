"""Landing of a column on the plane."""

import math

from stylobate.models.sliding.face_impacts import Body, coming_down, flying_from, struck_at
from stylobate.models.sliding.friction import TWISTING_BASE
from stylobate.models.sliding.impacts import base_impulse, impulse, rebound, responses
from stylobate.models.sliding.lift_off import lifted_with
from stylobate.models.sliding.on_base import TRIPPED, rests, set_down, settle_flat
from stylobate.models.sliding.on_rim import kicked, settle_rim
from stylobate.models.sliding.phases import FLYING, SLIDING, SLIPPING, Numbers, State
from stylobate.models.sliding.posture import Triple, lean_of, moving, placed, turning


def land(state: State, now: Triple, later: Triple, ahead: float, rest: float, n: Numbers) -> tuple[float, State]:
    """Return elapsed time and state after the lowest point of a column has landed on the plane."""
    if state.tilt_x == 0.0 and state.tilt_y == 0.0 and state.tilt_rate_x == 0.0 and state.tilt_rate_y == 0.0:
        return land_flat(state, now, later, ahead, n)
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


def touching(state: State, vd: float, vn: float, ux: float, uy: float) -> State:
    """Return a column whose lowest point touches the plane with this velocity."""
    return moving(state, (vd * ux - vn * uy, vd * uy + vn * ux), 0.0, 0.0, SLIPPING)


def land_flat(state: State, now: Triple, later: Triple, ahead: float, n: Numbers) -> tuple[float, State]:
    """Return elapsed time and state of a column that lands on its whole base: it may trip over its leading edge."""
    vx, vy, approach = state.velocity_x, state.velocity_y, max(-state.rise_rate, 0.0)
    bounce = rebound(n.normal_restitution, approach)
    normal = (1.0 + bounce) * approach
    inertia = n.axial * n.c * n.c  # I_a/κ
    kx, ky, turned = base_impulse(vx, vy, state.spin, normal, n.kinetic, TWISTING_BASE, n.c, inertia)
    if math.hypot(kx, ky) > n.c * normal:
        speed, tilt = math.hypot(vx, vy), TRIPPED * n.c
        body = struck_at(Body(vx, vy, -approach, 0.0, 0.0, state.spin), vx / speed, vy / speed, bounce, n)
        if bounce > 0.0:
            return 0.0, flying_from(state, body, (tilt * vx / speed, tilt * vy / speed), n)
        return coming_down(state, body, tilt, 0.0, now, later, ahead, 0.0, n)
    flat = placed(state, (0.0, 0.0, 0.0, 0.0), state.spin + turned, SLIDING)
    if bounce > 0.0:
        return 0.0, moving(flat, (vx + kx, vy + ky), 0.0, bounce * approach, FLYING)
    return settle_flat(moving(flat, (vx + kx, vy + ky), 0.0, 0.0, SLIDING), now, later, ahead, n)
