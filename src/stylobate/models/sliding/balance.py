"""State, friction and balance of forces of the sliding column, in every kind of contact with the plane.

Slip is a vector of three components, (v_x, v_y, ε ω_z): the velocity of the contact, and the speed of rotation at the
rim of a patch of radius ε. Slip reduces the moment, and rotation reduces the force. For the small contact of a rim with
Hertz's pressure, the integrals are approximated after V. F. Zhuravlev with the exponent 3. The error of the force is at
most 3.6 %. The moment is up to 22.5 % too small, at s = 1.57 |v|, by 16 % of the maximum moment:

T = −μN v/(|v|³ + (b s)³)^⅓,   M = −m μNε s_z/(s³ + (a|v|)³)^⅓,   s = |s_z|,  s_z = ε ω_z,

in which b and a make the limits of fast rotation and of fast slip exact. For a standing base with uniform pressure the
formulas are exact: elliptic integrals of the modulus k, the smaller of |v| and s over the larger (Z. Farkas and others,
Phys. Rev. Lett. 90, 248302, 2003).

Units as in `finite_tilt`: everything over J0, lengths in h, accelerations of the base in g; forces are over m g.
The body turns with w1 u + w2 n + w3 e3; C is the lowest point of its rim, d the horizontal direction of the lean.

I_t ẇ1 = I_t β̇w2 cos θ − I_a w2w3 + T_n + M1,   I_a ẇ3 = c T_n + M3,
I_t ẇ2 = I_t β̇² sin θ cos θ − I_a β̇w3 sin θ + M2 − N z' − T_d ρ',   N = 1 + a_z + κ(z'ẇ2 − ρ'w2²),
κ v̇_d = T_d − a_d − κ(ρ'ẇ2 + z'w2² + β̇w),   κ v̇_n = T_n − a_n + κ(ẇ − ρ'β̇w2),   w = c w3 + w1,

where v is the velocity of the body at C. Without slip v̇ = 0 gives T; with slip T follows N; in the air N = T = 0.
"""

import math
from enum import IntEnum
from typing import NamedTuple

import numpy as np

from stylobate.models.finite_tilt import FADING, TINY, cosine, sine_over_angle, tilt_acceleration
from stylobate.models.model import Floats


class Contact(IntEnum):
    """Kind of contact between column and plane: the value of the last state."""

    RESTING = 0
    """The column stands on its base, which does not move on the plane."""
    SLIDING = 1
    """The column stands on its base, which slides or turns on the plane."""
    ROLLING = 2
    """The lowest point of the rim touches and does not slip; a patch of contact does not turn either."""
    SLIPPING = 3
    """The lowest point of the rim touches and slips, or the patch turns."""
    FLYING = 4
    """The column is in the air."""
    JAMMED = 5
    """The contact can neither stick nor slip nor open: Painlevé's paradox, which ends a run."""


RESTING, SLIDING, ROLLING, SLIPPING, FLYING, JAMMED = map(float, Contact)
"""The kinds of contact as the numbers in a state."""


class SlidingState(NamedTuple):
    """The integrated state, in units of h and 1/ω0.

    Parameters
    ----------
    tilt_x, tilt_y, tilt_rate_x, tilt_rate_y
        θ(cos β, sin β) and its rate.
    spin, twist
        Angular velocity about the axis, and χ.
    footprint_x, footprint_y
        Centre of the circle in which the base would stand if it were tilted back over its contact point [h].
    velocity_x, velocity_y
        Velocity relative to the plane: of the contact point on the rim, of the centre of a standing base, or of the
        centre of mass in the air.
    rise, rise_rate
        Height of the centre of mass above that of a standing column, used in the air only.
    heading_x, heading_y, heading_z
        Unit vector of the slip (v_x, v_y, ε ω_z) at the start of the step. Friction acts against the sense of slip
        along it, so that the equations are smooth up to the instant at which slip ends.
    contact
        A `Contact`.
    """

    tilt_x: float
    tilt_y: float
    tilt_rate_x: float
    tilt_rate_y: float
    spin: float
    twist: float
    footprint_x: float
    footprint_y: float
    velocity_x: float
    velocity_y: float
    rise: float
    rise_rate: float
    heading_x: float
    heading_y: float
    heading_z: float
    contact: float


class SlidingNumbers(NamedTuple):
    """The parameters of the model, dimensionless.

    Parameters
    ----------
    c, eta, zeta, kappa, axial, resistance
        As for `Rolling`: c, η, ζ, κ, i_a and δ/r.
    kinetic, static
        Kinetic and static coefficients of friction.
    patch
        ε/r, radius of the contact of the rim.
    normal_restitution
        e_n of impacts.
    slope_x, slope_y, relief
        Terms that an inclined plane adds to the base acceleration [g].
    """

    c: float
    eta: float
    zeta: float
    kappa: float
    axial: float
    resistance: float
    kinetic: float
    static: float
    patch: float
    normal_restitution: float
    slope_x: float
    slope_y: float
    relief: float


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


def _cubic_sum(a: float, b: float) -> float:
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


def pointed(speed: float, twisting: float) -> tuple[float, float]:
    """Return |T|/|v| and |M|/(ε s) over μN for Hertz's pressure in a small contact; arguments as for `even`."""
    return 1.0 / _cubic_sum(speed, SLOWED * twisting), TWISTING / _cubic_sum(twisting, EASED * speed)


def per_normal(
    vx: float,
    vy: float,
    turning: float,
    hx: float,
    hy: float,
    hz: float,
    radius: float,
    on_base: bool,
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
        Whether the base stands on the plane; else its rim touches.
    coefficient
        μ.
    """
    sense = 1.0 if vx * hx + vy * hy + radius * turning * hz >= 0.0 else -1.0
    sx, sy, sz = sense * vx + _TRACE * hx, sense * vy + _TRACE * hy, sense * radius * turning + _TRACE * hz
    speed, twisting = math.sqrt(sx * sx + sy * sy), abs(sz)
    per_speed, per_twisting = even(speed, twisting) if on_base else pointed(speed, twisting)
    along, about = coefficient * per_speed, coefficient * radius * per_twisting
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


# Minimum of a denominator.
_LEAST = 1e-12


def balance(
    x: float,
    y: float,
    vx: float,
    vy: float,
    w3: float,
    slip_x: float,
    slip_y: float,
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
    slope_x: float,
    slope_y: float,
    relief: float,
) -> tuple[
    float, float, float, float, float, float, float, float, float, float, float, float, float, float, float, float
]:
    """Return rates and forces.

    Returns
    -------
    tuple
        Rates of the tilt rate (2), of the spin, of the velocity (2); N, T_x, T_y over m g, M_z over m g h; ε ω̇_z of
        the slip; the friction reserve (`reserve`); Painlevé's denominator; rate of the twist; rate of the centre of the
        footprint without slip (2); ω_z.
    """
    rolls, slips, slides, flies = contact == ROLLING, contact == SLIPPING, contact == SLIDING, contact == FLYING
    rim = rolls or slips
    base = not (rim or flies)
    ax, ay, weight = ax + slope_x, ay + slope_y, 1.0 + az - relief
    # Kinematics
    square = x * x + y * y + TINY
    tilt = math.sqrt(square)
    ux, uy = x / tilt, y / tilt
    per_angle, cos = sine_over_angle(square), cosine(square)
    sine = per_angle * tilt
    turning = vy * ux - vx * uy  # θ β̇
    around = turning / tilt  # β̇
    w1, w2 = -per_angle * turning, vx * ux + vy * uy
    outward, across = ax * ux + ay * uy, ay * ux - ax * uy  # a_d, a_n
    transverse, inertia = 1.0 - kappa, kappa * axial * c * c  # I_t, I_a
    height, slope = cos + c * sine, c * cos - sine  # ρ', z'
    yawing = w3 * cos - w1 * sine  # ω_z
    swing = c * w3 + w1  # w
    # The couples of a rim that touches: −η(w1 u + w2 n); −D0 ω_z about the vertical; rolling resistance.
    rolling = w1 * cos + w3 * sine  # the angular rate about d
    freedom = 1.0 + axial - kappa  # Λ
    drained = zeta * kappa * c * c * freedom * yawing
    m1, m3 = drained * sine - eta * w1, -drained * cos
    whirl = around * (transverse * around * sine * cos - inertia * sine * w3)
    # Without slip, as for `Rolling`: K θ̈ = I_tβ̇² sin θ cos θ − I_aβ̇w3 sin θ − κρ'β̇w − (1 + a_z)z' − ρ'a_d + M2
    leaned = whirl - kappa * height * around * swing - weight * slope - height * outward - eta * w2
    held_fall, held_normal, held_drag = tilt_acceleration(leaned, w2, rolling, sine, cos, weight, c, kappa, resistance)
    held_m1, held_m3 = m1 - held_drag * rolling * cos, m3 - held_drag * rolling * sine
    # κv̇_n = 0: T_n, and for a patch without slip the moment M_z that prevents its rotation
    gyro = inertia * w2 * w3
    unturned = kappa * (w2 * (inertia * w3 - transverse * c * w1) - held_m1) + transverse * across
    unturned = axial / freedom * (unturned - transverse * held_m3 / (axial * c))
    given = axial / freedom * (kappa * sine - transverse * cos / (axial * c))
    spun = (c * unturned + held_m3) / inertia * cos - sine * ((unturned + held_m1 - gyro) / transverse + w3 * w2)
    answer = cos * (c * given + cos) / inertia - sine * (given - sine) / transverse
    pivot = -spun / answer if rolls and patch > 0.0 else 0.0
    held_n = unturned + given * pivot
    # With slip: T = Nτ, and N from its own equation after ẇ2 is eliminated
    tau_x, tau_y, tau_z = per_normal(slip_x, slip_y, yawing, hx, hy, hz, c if base else patch * c, base, kinetic)
    tau_d, tau_n = tau_x * ux + tau_y * uy, tau_y * ux - tau_x * uy
    lever = c * resistance / math.sqrt(w2 * w2 + rolling * rolling + FADING * FADING)
    falls = whirl - eta * w2
    arm = slope + tau_d * height + lever * w2
    denominator = 1.0 + kappa / transverse * slope * arm
    opened = weight - kappa * height * w2 * w2 + kappa / transverse * slope * falls
    safe = max(denominator, _LEAST)
    slip_normal = opened / safe
    slip_fall = (falls - slip_normal * arm) / transverse
    slip_m1 = m1 - lever * slip_normal * rolling * cos - tau_z * slip_normal * sine
    slip_m3 = m3 - lever * slip_normal * rolling * sine + tau_z * slip_normal * cos
    # Select rolling, slip, flight or base
    normal = held_normal if rolls else slip_normal if slips else weight if base else 0.0
    falling = held_fall if rolls else slip_fall if slips else whirl / transverse
    force_n = held_n if rolls else slip_normal * tau_n if slips else 0.0
    c1 = held_m1 - pivot * sine if rolls else slip_m1 if slips else 0.0
    c3 = held_m3 + pivot * cos if rolls else slip_m3 if slips else tau_z * weight if slides else 0.0
    driven = (force_n + c1 - gyro) / transverse
    inward = falling - tilt * around * around
    sideways = 2.0 * w2 * around * (1.0 - cos / per_angle) - driven / per_angle
    bx = 0.0 if base else inward * ux - sideways * uy
    by = 0.0 if base else inward * uy + sideways * ux
    spin_rate = (c * force_n + c3) / inertia
    # Forces along x and y; a column at rest moves with the plane.
    held_d = outward + kappa * (height * held_fall + slope * w2 * w2 + around * swing)
    force_d = held_d if rolls else slip_normal * tau_d if slips else 0.0
    tx = force_d * ux - force_n * uy if rim else tau_x * weight if slides else ax if base else 0.0
    ty = force_d * uy + force_n * ux if rim else tau_y * weight if slides else ay if base else 0.0
    moment = pivot - drained if rolls else slip_normal * tau_z - drained if slips else tau_z * weight if slides else 0.0
    # Velocity: v̇ of C, or that of the centre of mass, or of the base
    swung = c * spin_rate + w2 * around * cos + driven  # ẇ
    left_d = -kappa * (height * slip_fall + slope * w2 * w2 + around * swing)
    left_n = kappa * (swung - height * around * w2)
    ox = 0.0 if rolls else (tx - ax + (left_d * ux - left_n * uy if slips else 0.0)) / kappa
    oy = 0.0 if rolls else (ty - ay + (left_d * uy + left_n * ux if slips else 0.0)) / kappa
    # ω̇_z, and ε ω̇_z of a patch or base
    yaw_rate = spin_rate * cos - sine * (driven + w3 * w2)
    oz = patch * c * yaw_rate if slips else c * spin_rate if slides else 0.0
    drag = math.sqrt(tx * tx + ty * ty)
    kept = reserve(drag, abs(pivot), normal, patch * c if rim else 0.0, static)
    # χ̇ = w3 − w1 tan(θ/2); Ḃ0 = v − r χ̇ n, in the air V − (ρ'θ̇ d + ρβ̇ n)
    twisting = w3 + (1.0 - cos) * around
    past = sine + c * (1.0 - cos)  # ρ
    back_d = height * w2 if flies else 0.0
    back_n = c * twisting if rim else past * around if flies else 0.0
    return (
        bx,
        by,
        spin_rate,
        ox,
        oy,
        normal,
        tx,
        ty,
        moment,
        oz,
        kept,
        denominator if slips else 1.0,
        twisting,
        -back_d * ux + back_n * uy,
        -back_d * uy - back_n * ux,
        yawing,
    )


# Number of results of `balance` for a state.
_RESULTS = 16


def forces_along(states: Floats, accelerations: Floats, n: SlidingNumbers) -> Floats:
    """Compute the `balance` of each state, shape (16, number of states).

    Parameters
    ----------
    states
        Shape (16, number of states).
    accelerations
        Accelerations of the base [g], shape (3, number of states).
    n
        The parameters.
    """
    from stylobate.compiler.compiled import over_rows

    state = SlidingState(*states)
    rows = np.column_stack(np.broadcast_arrays(
        state.tilt_x, state.tilt_y, state.tilt_rate_x, state.tilt_rate_y, state.spin, state.velocity_x,
        state.velocity_y, state.heading_x, state.heading_y, state.heading_z, state.contact, *accelerations,
        n.c, n.eta, n.zeta, n.kappa, n.axial, n.resistance, n.kinetic, n.static, n.patch, n.slope_x, n.slope_y,
        n.relief,
    ))  # fmt: skip
    return np.ascontiguousarray(over_rows(balance, rows, name="sliding").reshape(-1, _RESULTS).T)
