"""Friction of a contact that slips and turns on the plane: Coulomb at a point, Coulomb–Contensou over a patch.

Slip is a vector of three components, (v_x, v_y, ε ω_z): the velocity of the contact, and the speed of rotation at the
rim of a patch of radius ε. Slip reduces the moment, and rotation reduces the force. For the small contact of a rim with
Hertz's pressure, the integrals are approximated after V. F. Zhuravlev with the exponent 3. The error of the force is at
most 3.6 %. The moment is up to 22.5 % too small, at s = 1.57 |v|, by 16 % of the maximum moment:

T = −μN v/(|v|³ + (b s)³)^⅓,   M = −m μNε s_z/(s³ + (a|v|)³)^⅓,   s = |s_z|,  s_z = ε ω_z,

in which b and a make the limits of fast rotation and of fast slip exact. For a standing base with uniform pressure the
formulas are exact: elliptic integrals of the modulus k, the smaller of |v| and s over the larger (Z. Farkas and others,
Phys. Rev. Lett. 90, 248302, 2003).
"""

import math

# b, a and m of Hertz's pressure in a small contact; m of a uniform pressure under a standing base.
SLOWED, EASED, TWISTING = 8.0 / (3.0 * math.pi), 15.0 * math.pi / 16.0, 3.0 * math.pi / 16.0
TWISTING_BASE = 2.0 / 3.0
# Minimum of the complementary modulus, at which the integrals are finite.
_LEAST_COMPLEMENT = 1e-8

# The loads that a patch can bear without slip are bounded by those of slip: with T in μN and M in m μNε,
# T³ + M³ (1 + (b³a³ − 1) T³) = 1.
_BULGE = (SLOWED * EASED) ** 3 - 1.0

# Weight of the heading, which sets the direction of friction without slip.
_TRACE = 1e-140


def cubic_sum(a: float, b: float) -> float:
    """Return (a³ + b³)^⅓ of two nonnegative numbers, by two steps of Halley's method from a linear guess."""
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


def even(speed: float, twisting: float) -> tuple[float, float]:
    """Return |T|/|v| and |M|/(ε s) over μN for uniform pressure on a disc that slips at |v| and turns at s = ε|ω_z|.

    K(k) = π/(2a) with the arithmetic-geometric mean a of 1 and √(1 − k²), and E = K (1 − k²/2 − k⁴q); q is the sum of
    2ⁿ⁻¹(c_n/k²)² over its steps from the first. Terms of E and K that cancel are left out.
    """
    larger = max(speed, twisting) + 1e-300
    share = min(speed, twisting) / larger
    square = share * share
    b0 = math.sqrt(max(1.0 - square, _LEAST_COMPLEMENT * _LEAST_COMPLEMENT))
    a1, b1 = 0.5 * (1.0 + b0), math.sqrt(b0)
    c1 = 0.25 / a1
    a2, b2 = 0.5 * (a1 + b1), math.sqrt(a1 * b1)
    c2 = 0.25 * square * c1 * c1 / a2
    a3, b3 = 0.5 * (a2 + b2), math.sqrt(a2 * b2)
    c3 = 0.25 * square * c2 * c2 / a3
    a4, b4 = 0.5 * (a3 + b3), math.sqrt(a3 * b3)
    c4 = 0.25 * square * c3 * c3 / a4
    a5, b5 = 0.5 * (a4 + b4), math.sqrt(a4 * b4)
    c5 = 0.25 * square * c4 * c4 / a5
    a6 = 0.5 * (a5 + b5)
    c6 = 0.25 * square * c5 * c5 / a6
    q = c1 * c1 + 2.0 * c2 * c2 + 4.0 * c3 * c3 + 8.0 * c4 * c4 + 16.0 * c5 * c5 + 32.0 * c6 * c6
    slipping = 2.0 / (3.0 * a6) * (1.5 - 0.5 * square - square * (1.0 + square) * q)
    turns = 3.0 - 3.0 * square + square * square * (1.0 - (4.0 - 2.0 * square) * q)
    slides = 1.0 + (2.0 - 4.0 * square) * q
    turning = 2.0 / (9.0 * a6) * (turns if twisting >= speed else slides)
    return slipping / larger, turning / larger


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
        Heading, a unit vector: a slip against it counts as slip along it.
    radius
        ε [h]; 0 for a point, which resists no turning.
    on_base
        1 if the base stands on the plane, 0 if its rim touches.
    coefficient
        μ.
    """
    sense = 1.0 if vx * hx + vy * hy + radius * turning * hz >= 0.0 else -1.0
    sx, sy, sz = sense * vx + _TRACE * hx, sense * vy + _TRACE * hy, sense * radius * turning + _TRACE * hz
    speed, twisting = math.sqrt(sx * sx + sy * sy), abs(sz)
    even_along, even_about = even(speed, twisting)
    pointed_along, pointed_about = (
        1.0 / cubic_sum(speed, SLOWED * twisting),
        TWISTING / cubic_sum(twisting, EASED * speed),
    )
    along = coefficient * (even_along if on_base > 0.0 else pointed_along)
    about = coefficient * radius * (even_about if on_base > 0.0 else pointed_about)
    return -along * sx, -along * sy, -about * sz


def reserve(force: float, moment: float, normal: float, radius: float, coefficient: float) -> float:
    """Return the dimensionless friction reserve of a rim contact before it slips; negative if friction is too weak.

    Parameters
    ----------
    force, moment
        |T| and |M_z| that the contact needs without slip.
    normal
        N.
    radius, coefficient
        ε, and the static μ.
    """
    bound = max(coefficient * normal, 1e-300)
    dragged = force / bound
    # Far outside the limit the cubes are useless and may overflow.
    drag = min(dragged, 1e3)
    twist = min(moment / max(TWISTING * bound * radius, 1e-300), 1e3) if radius > 0.0 else 0.0
    drag, twist = drag * drag * drag, twist * twist * twist
    return 1.0 - dragged if radius == 0.0 else 1.0 - drag - twist * (1.0 + _BULGE * drag)


def sense_of(force: float, moment: float, normal: float, radius: float, coefficient: float) -> tuple[float, float]:
    """Return slip and rotation, as components of a unit vector, with which a contact begins to slip.

    The friction of this slip is closest to the load that exceeds the limit; arguments as for `reserve`.
    """
    if radius == 0.0:
        return 1.0, 0.0
    # A contact under tension slips and does not turn.
    drag = min(force / max(coefficient * normal, 1e-300), 1.0 - 1e-12) ** 3
    ratio = SLOWED * (drag / (1.0 - drag)) ** (1.0 / 3.0)  # |v|/s for which T is this fraction of μN
    length = math.sqrt(1.0 + ratio * ratio)
    return ratio / length, math.copysign(1.0 / length, -moment)
