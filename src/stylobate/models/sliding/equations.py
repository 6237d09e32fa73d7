"""Equations of motion, contact loads and guards of the sliding column as functions of plain numbers."""

import math

from stylobate.models.finite_tilt import TINY, cosine, sine_over_angle
from stylobate.models.sliding.balance import balance
from stylobate.models.sliding.phases import FLYING, RESTING, ROLLING, SLIDING, SLIPPING

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
