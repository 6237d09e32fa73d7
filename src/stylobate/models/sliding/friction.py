"""Friction of a contact that slips and turns on the plane: Coulomb's at a point, and over a patch by Contensou's idea.

Slip is a vector of three, (v_x, v_y, ε ω_z): the velocity of the contact, and how fast the rim of a patch of radius ε
turns. Force and moment fade into each other as a patch slips and turns at once. The exact integrals over the pressure
are approximated after V. F. Zhuravlev with the exponent 3, which for a pressure after Hertz is within 3.5 % in force
and 11 % in moment:

T = −μN v/(|v|³ + (b s)³)^⅓,   M = −m μNε s_z/(s³ + (a|v|)³)^⅓,   s = |s_z|,  s_z = ε ω_z,

in which b and a make the weak friction of a contact that turns fast, or slips fast, exact.
"""

import math

# b, a and m of the pressure of Hertz, of a small contact, and of an even pressure, under a base that stands.
_POINTED = (8.0 / (3.0 * math.pi), 15.0 * math.pi / 16.0, 3.0 * math.pi / 16.0)
_EVEN = (1.0, 8.0 / 3.0, 2.0 / 3.0)
SLOWED, EASED, TWISTING = _POINTED
SLOWED_BASE, EASED_BASE, TWISTING_BASE = _EVEN

# The loads that a patch can hold are bounded by those that it exerts as it slips: with T in μN and M in m μNε,
# T³ + M³ (1 + (b³a³ − 1) T³) = 1.
_BULGE = (SLOWED * EASED) ** 3 - 1.0

# Keeps a direction where there is no slip: it is that of the heading.
_TRACE = 1e-140


def cubic_sum(a: float, b: float) -> float:
    """Return (a³ + b³)^⅓ of two numbers that are not negative, by two steps of Halley's rule from a straight line."""
    larger = max(a, b) + 1e-300
    share = min(a, b) / larger
    cubed = share * share * share
    cube = 1.0 + cubed
    root = 1.0 + 0.26 * cubed
    power = root * root * root
    root = root * (power + 2.0 * cube) / (2.0 * power + cube)
    power = root * root * root
    root = root * (power + 2.0 * cube) / (2.0 * power + cube)
    return larger * root


def per_normal(
    vx: float,
    vy: float,
    turning: float,
    hx: float,
    hy: float,
    hz: float,
    radius: float,
    on_base: float,
    coefficient: float,
) -> tuple[float, float, float]:
    """Return force and moment about the vertical per normal force of a contact that slips.

    Parameters
    ----------
    vx, vy, turning
        v [h ω0] and ω_z [ω0].
    hx, hy, hz
        Heading: a unit vector of the slip; what has come to point backwards counts as if it went on.
    radius
        ε [h]; 0 for a point, which resists no turning.
    on_base
        1 where the base stands on the plane, 0 where its rim touches.
    coefficient
        μ.
    """
    sense = 1.0 if vx * hx + vy * hy + radius * turning * hz >= 0.0 else -1.0
    sx, sy, sz = sense * vx + _TRACE * hx, sense * vy + _TRACE * hy, sense * radius * turning + _TRACE * hz
    speed, twisting = math.sqrt(sx * sx + sy * sy), abs(sz)
    slowed = SLOWED_BASE if on_base > 0.0 else SLOWED
    eased = EASED_BASE if on_base > 0.0 else EASED
    most = TWISTING_BASE if on_base > 0.0 else TWISTING
    along = coefficient / cubic_sum(speed, slowed * twisting)
    about = coefficient * most * radius / cubic_sum(twisting, eased * speed)
    return -along * sx, -along * sy, -about * sz


def reserve(force: float, moment: float, normal: float, radius: float, coefficient: float) -> float:
    """Return what friction has left before a contact of the rim slips, per normal force; negative where it is too weak.

    Parameters
    ----------
    force, moment
        |T| and |M_z| that hold the contact.
    normal
        N.
    radius, coefficient
        ε, and the static μ.
    """
    bound = coefficient * max(normal, 1e-300)
    dragged = force / bound
    # Far outside the set the cubes are of no use, and may overflow.
    drag = min(dragged, 1e3)
    twist = min(moment / (TWISTING * bound * radius), 1e3) if radius > 0.0 else 0.0
    drag, twist = drag * drag * drag, twist * twist * twist
    return 1.0 - dragged if radius == 0.0 else 1.0 - drag - twist * (1.0 + _BULGE * drag)


def sense_of(force: float, moment: float, normal: float, radius: float, coefficient: float) -> tuple[float, float]:
    """Return the shares of slip and of turning, as of a unit vector, with which a contact begins to give way.

    Its friction is then most like the load that it has just failed to hold; arguments as for `reserve`.
    """
    if radius == 0.0:
        return 1.0, 0.0
    # What the plane would have to pull at slips rather than turns.
    drag = min(force / (coefficient * max(normal, 1e-300)), 1.0 - 1e-12) ** 3
    ratio = SLOWED * (drag / (1.0 - drag)) ** (1.0 / 3.0)  # |v|/s, for which T is this part of μN
    length = math.sqrt(1.0 + ratio * ratio)
    return ratio / length, math.copysign(1.0 / length, -moment)
