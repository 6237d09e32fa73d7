"""Reset map and projection of the sliding column as functions of plain numbers, for the engines."""

import math

from stylobate.models.finite_tilt import TINY, cosine, sine_over_angle
from stylobate.models.sliding.phases import Numbers, State
from stylobate.models.sliding.transitions import reaction

_SLIDING, _SLIPPING = 1.0, 3.0


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
) -> tuple[float, State]:
    """Return elapsed time and state after the end of a kind of contact; see `reaction`."""
    state = State(x, y, vx, vy, w3, twist, fx, fy, sx, sy, rise, climb, hx, hy, hz, contact)
    numbers = Numbers(
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
    return reaction(state, int(event), (ax, ay, az), (bx, by, bz), ahead, rest, numbers)


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
    slides, slips = contact == _SLIDING, contact == _SLIPPING
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
