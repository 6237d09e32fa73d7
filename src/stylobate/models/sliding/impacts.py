"""Impulses of a column that strikes the plane: limited by friction, without gain of energy.

The law is that of A. Chatterjee and A. Ruina, "A new algebraic rigid-body collision law based on impulse space
considerations", J. Appl. Mech. 65 (1998): P = (1 + e) P1 + q (P2 − P1). P1 stops the approach without friction, P2
stops the whole velocity at the contact, and q ≤ 1 is the maximum that |P_t| ≤ μ P_z allows. The law never adds energy
for e ≤ 1 and any μ; an impulse on the friction cone against the initial slip can.
"""

import math

REST_SPEED = 1e-5
"""Minimum speed of a rebound [h ω0]: slower rebounds are plastic, so that a sequence of impacts ends.

Such a rebound rises to 5e-11 κ h, far above the accuracy with which a landing is located.
"""


def responses(sine: float, cos: float, c: float, kappa: float, axial: float) -> tuple[float, float, float, float]:
    """Return the changes of v at the lowest rim point per unit impulse at this point: W_dd, W_dz, W_zz and W_nn."""
    height, slope, transverse = cos + c * sine, c * cos - sine, 1.0 - kappa
    mass = 1.0 / kappa
    return (
        mass + height * height / transverse,
        height * slope / transverse,
        mass + slope * slope / transverse,
        mass + 1.0 / (kappa * axial) + 1.0 / transverse,
    )


def impulse(
    arrival: tuple[float, float, float],
    response: tuple[float, float, float, float],
    coefficient: float,
    normal_restitution: float,
) -> tuple[float, float, float]:
    """Return the impulse along d, n and the vertical at a point that arrives with this velocity."""
    vd, vn, vz = arrival
    dd, dz, zz, nn = response
    smooth = -vz / zz
    # P2 − P1 does not change v_z: its vertical component follows from that along d.
    rough_d = -(vd + dz * smooth) / (dd - dz * dz / zz)
    rough_n, rough_z = -vn / nn, -dz / zz * rough_d
    bounced = (1.0 + normal_restitution) * smooth
    along = math.hypot(rough_d, rough_n)
    short = along - coefficient * rough_z
    share = 1.0 if short <= coefficient * bounced else coefficient * bounced / short
    return share * rough_d, share * rough_n, bounced + share * rough_z


def rebound(normal_restitution: float, approach: float) -> float:
    """Return the restitution of an impact with this approach speed: 0 if the rebound would be too slow."""
    return normal_restitution if normal_restitution * approach > REST_SPEED else 0.0


def base_impulse(
    vx: float, vy: float, w3: float, normal: float, coefficient: float, twisting: float, c: float, inertia: float
) -> tuple[float, float, float]:
    """Return the impulse along x and y, and its moment, of a base that lands flat, over the mass κ and I_a.

    The impulse stops slip and rotation of the base as far as the normal impulse `normal`, over κ, allows each of them.
    """
    speed = math.hypot(vx, vy)
    kept = max(0.0, 1.0 - coefficient * normal / speed) if speed > 0.0 else 0.0
    turning = coefficient * normal * twisting * c / inertia
    spun = max(0.0, 1.0 - turning / abs(w3)) if w3 != 0.0 else 0.0
    return (kept - 1.0) * vx, (kept - 1.0) * vy, (spun - 1.0) * w3
