"""Newton's and Euler's equations of the column in every kind of contact, with the contact forces.

Units as in `finite_tilt`: everything over J0, lengths in h, accelerations of the base in g; forces are over m g.
The body turns with w1 u + w2 n + w3 e3; C is the lowest point of its rim, d the horizontal direction of the lean.

I_t ẇ1 = I_t β̇w2 cos θ − I_a w2w3 + T_n + M1,   I_a ẇ3 = c T_n + M3,
I_t ẇ2 = I_t β̇² sin θ cos θ − I_a β̇w3 sin θ + M2 − N z' − T_d ρ',   N = 1 + a_z + κ(z'ẇ2 − ρ'w2²),
κ v̇_d = T_d − a_d − κ(ρ'ẇ2 + z'w2² + β̇w),   κ v̇_n = T_n − a_n + κ(ẇ − ρ'β̇w2),   w = c w3 + w1,

where v is the velocity of the body at C. Without slip v̇ = 0 gives T; with slip T follows N; in the air N = T = 0.
"""

import math

from stylobate.models.finite_tilt import FADING, TINY, cosine, sine_over_angle, tilt_acceleration
from stylobate.models.sliding.friction import per_normal, reserve
from stylobate.models.sliding.phases import FLYING, ROLLING, SLIDING, SLIPPING

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
    rolls = 1.0 if contact == ROLLING else 0.0
    slips = 1.0 if contact == SLIPPING else 0.0
    flies = 1.0 if contact == FLYING else 0.0
    slides = 1.0 if contact == SLIDING else 0.0
    rim, base = rolls + slips, 1.0 - rolls - slips - flies
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
    pivot = (-spun / answer if patch > 0.0 else 0.0) * rolls
    held_n = unturned + given * pivot
    # With slip: T = Nτ, and N from its own equation after ẇ2 is eliminated
    tau_x, tau_y, tau_z = per_normal(slip_x, slip_y, yawing, hx, hy, hz, base * c + rim * patch * c, base, kinetic)
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
    normal = rolls * held_normal + slips * slip_normal + base * weight
    falling = rolls * held_fall + slips * slip_fall + flies * whirl / transverse
    force_n = rolls * held_n + slips * slip_normal * tau_n
    c1 = rolls * (held_m1 - pivot * sine) + slips * slip_m1
    c3 = rolls * (held_m3 + pivot * cos) + slips * slip_m3 + slides * tau_z * weight
    driven = (force_n + c1 - gyro) / transverse
    inward = falling - tilt * around * around
    sideways = 2.0 * w2 * around * (1.0 - cos / per_angle) - driven / per_angle
    moving = rim + flies
    bx, by = moving * (inward * ux - sideways * uy), moving * (inward * uy + sideways * ux)
    spin_rate = (c * force_n + c3) / inertia
    # Forces along x and y; a column at rest moves with the plane.
    held_d = outward + kappa * (height * held_fall + slope * w2 * w2 + around * swing)
    force_d = rolls * held_d + slips * slip_normal * tau_d
    standing_x = ax + slides * (tau_x * weight - ax)
    standing_y = ay + slides * (tau_y * weight - ay)
    tx = force_d * ux - force_n * uy + base * standing_x
    ty = force_d * uy + force_n * ux + base * standing_y
    moment = rolls * pivot + (slips * slip_normal + slides * weight) * tau_z - rim * drained
    # Velocity: v̇ of C, or that of the centre of mass, or of the base
    swung = c * spin_rate + w2 * around * cos + driven  # ẇ
    left_d = -kappa * (height * slip_fall + slope * w2 * w2 + around * swing)
    left_n = kappa * (swung - height * around * w2)
    free = 1.0 - rolls
    ox = free * (tx - ax + slips * (left_d * ux - left_n * uy)) / kappa
    oy = free * (ty - ay + slips * (left_d * uy + left_n * ux)) / kappa
    # ω̇_z, and ε ω̇_z of a patch or base
    yaw_rate = spin_rate * cos - sine * (driven + w3 * w2)
    oz = slides * c * spin_rate + slips * patch * c * yaw_rate
    drag = math.sqrt(tx * tx + ty * ty)
    kept = reserve(drag, abs(pivot), normal, patch * c * rim, static)
    # χ̇ = w3 − w1 tan(θ/2); Ḃ0 = v − r χ̇ n, in the air V − (ρ'θ̇ d + ρβ̇ n)
    twisting = w3 + (1.0 - cos) * around
    past = sine + c * (1.0 - cos)  # ρ
    back_d, back_n = flies * height * w2, rim * c * twisting + flies * past * around
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
        slips * denominator + 1.0 - slips,
        twisting,
        -back_d * ux + back_n * uy,
        -back_d * uy - back_n * ux,
        yawing,
    )
