"""Onset of slip of a rolling rim."""

import math

from stylobate.models.sliding.equations import JAM, STILL
from stylobate.models.sliding.friction import sense_of
from stylobate.models.sliding.lift_off import lifted, opens
from stylobate.models.sliding.phases import JAMMED, SLIPPING, Numbers, State
from stylobate.models.sliding.posture import (
    KICK,
    Triple,
    advanced,
    forces,
    headed,
    headed_along_slip,
    lean_of,
    lean_with_rate,
    moving,
    placed,
    rates_of,
    tilt_speed,
    turning,
)

# The onset lasts at most until the contact point has turned by this angle round the rim [rad].
_PART_OF_A_TURN = 0.02

# Acceleration of the slip so far: none.
STARTS = (0.0, 0.0, 0.0)

# Newton's method for the direction of slip: maximum number of steps, angle of the differences, and tolerance.
_MOST_TURNS, _SMALL_TURN, _SAME = 20, 1e-7, 1e-9


def begin_slip(state: State, now: Triple, later: Triple, ahead: float, n: Numbers) -> tuple[float, State]:
    """Return elapsed time and state a short time after a rolling column begins to slip.

    Friction acts with its limit along a slip that follows the load. The motion departs from rolling by the integral of
    the difference D of the rates, (D(0) + D(δ)) δ/2, with an error of the order δ³; D(δ) belongs to a column that
    departs with D(0). A slip that starts at zero would turn to the load at once; integration starts after it has grown.
    """
    first = slipping_along(state, load_direction(state, now, STARTS, n), KICK * STILL, n)
    started = forces(first, now, n)
    if started[11] < JAM:
        return 0.0, (lifted(state, n) if opens(state, now, n) else headed(state, (0.0, 0.0, 0.0), JAMMED))
    # The time in which the contact point turns by a small angle round the rim
    quick = _PART_OF_A_TURN * math.hypot(state.tilt_x, state.tilt_y) / tilt_speed(state)
    if quick < ahead:
        later, ahead = sooner(now, later, quick / ahead), quick
    rolled = rolled_on(state, now, later, ahead, n)
    found = forces(rolled, later, n)
    if found[5] > 0.0 and found[10] > 0.0:
        return ahead, rolled
    if opens(rolled, later, n):
        return ahead, lifted(rolled, n)
    departed = advanced(rolled, rates_of(first, now, n), ahead)
    departed = advanced(departed, rates_of(state, now, n), -ahead)
    pull = (started[3], started[4], started[9])
    slip = max(ahead * math.sqrt(pull[0] ** 2 + pull[1] ** 2 + pull[2] ** 2), KICK * STILL)
    last = slipping_along(departed, load_direction(departed, later, pull, n), slip, n)
    begun = advanced(rolled, rates_of(first, now, n), 0.5 * ahead)
    begun = advanced(begun, rates_of(state, now, n), -0.5 * ahead)
    begun = advanced(begun, rates_of(last, later, n), 0.5 * ahead)
    begun = advanced(begun, rates_of(rolled, later, n), -0.5 * ahead)
    begun = headed_along_slip(headed(begun, (last.heading_x, last.heading_y, last.heading_z), SLIPPING), n)
    found = forces(begun, later, n)
    return ahead, begun if found[5] > 0.0 else lifted(begun, n)


def sooner(now: Triple, later: Triple, share: float) -> Triple:
    """Interpolate between two accelerations; `share` is the fraction of the way."""
    return (
        now[0] + share * (later[0] - now[0]),
        now[1] + share * (later[1] - now[1]),
        now[2] + share * (later[2] - now[2]),
    )


def slipping_along(state: State, heading: Triple, slip: float, n: Numbers) -> State:
    """Return a column with the speed `slip` of slip along this heading."""
    started = moving(headed(state, heading, SLIPPING), (slip * heading[0], slip * heading[1]), 0.0, 0.0, SLIPPING)
    if n.patch == 0.0:
        return started
    _, _, sine, cos = lean_of(state)
    spin = (slip * heading[2] / (n.patch * n.c) + turning(state)[0] * sine) / cos
    return placed(started, lean_with_rate(started), spin, SLIPPING)


def load_direction(state: State, now: Triple, pull: Triple, n: Numbers) -> Triple:
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


def slip_rate(state: State, heading: Triple, now: Triple, pull: Triple, n: Numbers) -> Triple:
    """Return the acceleration of a slip along a heading, plus `pull`."""
    found = forces(slipping_along(state, heading, KICK * STILL, n), now, n)
    return found[3] + pull[0], found[4] + pull[1], found[9] + pull[2]


def dot(a: Triple, b: Triple) -> float:
    """Return the scalar product of two vectors."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def rolled_on(state: State, now: Triple, later: Triple, elapsed: float, n: Numbers) -> State:
    """Advance a rolling column by a short time, by the classical rule of Runge and Kutta."""
    middle = (0.5 * (now[0] + later[0]), 0.5 * (now[1] + later[1]), 0.5 * (now[2] + later[2]))
    first = rates_of(state, now, n)
    second = rates_of(advanced(state, first, 0.5 * elapsed), middle, n)
    third = rates_of(advanced(state, second, 0.5 * elapsed), middle, n)
    fourth = rates_of(advanced(state, third, elapsed), later, n)
    end = advanced(advanced(state, first, elapsed / 6.0), second, elapsed / 3.0)
    return advanced(advanced(end, third, elapsed / 3.0), fourth, elapsed / 6.0)
