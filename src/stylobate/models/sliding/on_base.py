"""Transitions of a column that stands on its base: rest, sliding, uplift, tripping and lift-off."""

import math

from stylobate.models.finite_tilt import uplift_terms
from stylobate.models.free_twist import departing
from stylobate.models.model import Push
from stylobate.models.sliding.equations import JAM, STILL
from stylobate.models.sliding.lift_off import lifted
from stylobate.models.sliding.on_rim import jammed, settle_rim
from stylobate.models.sliding.phases import RESTING, ROLLING, SLIDING, SLIPPING, Numbers, State
from stylobate.models.sliding.posture import (
    KICK,
    Triple,
    advanced,
    forces,
    guards_of,
    headed,
    headed_along_slip,
    lean_of,
    lean_with_rate,
    moving,
    placed,
    rates_of,
    slips,
)

_REST = 3

# Initial tilt of a sliding base that trips [c].
TRIPPED = 1e-9


def settle_flat(state: State, now: Triple, later: Triple, ahead: float, n: Numbers) -> tuple[float, State]:
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


def set_flat(state: State, n: Numbers) -> State:
    """Return a column on its rim set down on its base; its velocity is the slip of the centre of the base."""
    ux, uy, _, _ = lean_of(state) if state.tilt_x != 0.0 or state.tilt_y != 0.0 else (0.0, 0.0, 0.0, 1.0)
    velocity = (state.velocity_x + n.c * state.spin * uy, state.velocity_y - n.c * state.spin * ux)
    return moving(placed(state, (0.0, 0.0, 0.0, 0.0), state.spin, SLIDING), velocity, 0.0, 0.0, SLIDING)


def rests(state: State, now: Triple, rest: float, n: Numbers) -> bool:
    """Return whether a column on its rim comes to rest by the guard "rest"."""
    return guards_of(state, now, rest, n)[_REST] < 0.0


def set_down(state: State, now: Triple, later: Triple, ahead: float, n: Numbers) -> tuple[float, State]:
    """Return elapsed time and state of a column that comes to rest on its rim: at rest, or its base slides on."""
    flat = set_flat(state, n)
    if n.kinetic > n.c:
        flat = moving(placed(flat, lean_with_rate(flat), 0.0, SLIDING), (0.0, 0.0), 0.0, 0.0, SLIDING)
    return settle_flat(flat, now, later, ahead, n)


def set_sliding(state: State, now: Triple, later: Triple, ahead: float, n: Numbers) -> tuple[float, State]:
    """Return elapsed time and state a short time after a column at rest begins to slide; at once without friction."""
    if n.static == 0.0:
        return 0.0, headed(state, (0.0, 0.0, 0.0), SLIDING)
    kick = KICK * STILL
    first = set_off(state, now[0] + n.slope_x, now[1] + n.slope_y, kick)
    pull = rates_of(first, now, n)
    # The direction of the slip is that of the sum of its accelerations.
    px, py = later[0] + n.slope_x - n.kappa * pull[8], later[1] + n.slope_y - n.kappa * pull[9]
    last = set_off(state, px, py, max(ahead * math.hypot(pull[8], pull[9]), kick))
    begun = advanced(state, pull, 0.5 * ahead)
    begun = advanced(begun, rates_of(last, later, n), 0.5 * ahead)
    begun = headed(begun, (last.heading_x, last.heading_y, 0.0), SLIDING)
    forward = begun.velocity_x * last.heading_x + begun.velocity_y * last.heading_y
    return ahead, headed_along_slip(begun, n) if forward > 0.0 else state


def set_off(state: State, px: float, py: float, slip: float) -> State:
    """Return a standing column that slides with the speed `slip` against an acceleration."""
    pushed = math.hypot(px, py)
    way = (-px / pushed, -py / pushed)
    return moving(headed(state, (way[0], way[1], 0.0), SLIDING), (slip * way[0], slip * way[1]), 0.0, 0.0, SLIDING)


def uplifted(state: State, now: Triple, later: Triple, ahead: float, n: Numbers) -> tuple[float, State]:
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
    x, y, vx, vy, spin = departing(push, ahead, terms, n.c, n.kappa, n.axial)
    if x == 0.0 and y == 0.0:
        return ahead, state
    return ahead, settle_rim(placed(state, (x, y, vx, vy), spin, ROLLING), later, n)


def tripping(state: State, now: Triple, n: Numbers) -> tuple[float, State]:
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
