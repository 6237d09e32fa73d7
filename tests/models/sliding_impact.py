"""Impulses of a column that lands on the lowest point of its rim; for tests."""

import math

import numpy as np

UP = np.array([0.0, 0.0, 1.0])


def impulse(velocity, response, coefficient, restitution, impact):
    """Return the impulse (3,) [N s] at C, after which C rises with `restitution` times its speed of arrival.

    Parameters
    ----------
    velocity
        v_C on arrival [m/s], (3,).
    response
        W, change of v_C per impulse at C [1/kg], (3, 3).
    coefficient
        μ: along the plane the impulse is at most μ times that along Z.
    impact
        ``"stopping"``: C stops along the plane if μ allows, else the impulse lies on the cone of friction against
        the slip on arrival. With W as skew as it is here, a body can gain energy by that, unless it does not bounce.
        ``"dissipative"``: between the impulse without friction and that which adds, in full, what would stop C were
        it not to bounce; as far as μ allows. It takes energy whatever μ and e_n ≤ 1 (Chatterjee and Ruina's law).
    """
    return {"stopping": _stopping, "dissipative": _dissipative}[impact](velocity, response, coefficient, restitution)


def _stopping(velocity, response, coefficient, restitution):
    sticking = np.linalg.solve(response, -restitution * velocity[2] * UP - velocity)
    along = math.hypot(sticking[0], sticking[1])
    if along <= coefficient * sticking[2]:
        return sticking
    speed = math.hypot(velocity[0], velocity[1])
    # Without slip on arrival there is no direction but that of what would keep it so.
    against = -sticking[:2] / along if speed <= 1e-9 * abs(velocity[2]) else velocity[:2] / speed
    per_normal = np.append(-coefficient * against, 1.0)
    return -(1.0 + restitution) * velocity[2] / (response[2] @ per_normal) * per_normal


def _dissipative(velocity, response, coefficient, restitution):
    # P = (1 + e) P_1 + κ (P_2 − P_1): P_1 leaves no v_n, P_2 no v_C at all. P_2 − P_1 leaves v_n alone, so energy is
    # ½(e² P_1·W P_1 + (1 − κ)² (P_2 − P_1)·W (P_2 − P_1)), and was that with e = 1 and κ = 0.
    smooth = -velocity[2] / response[2, 2] * UP
    rough = np.linalg.solve(response, -velocity) - smooth
    bounced = (1.0 + restitution) * smooth
    along = math.hypot(rough[0], rough[1])
    short = along - coefficient * rough[2]
    share = 1.0 if short <= coefficient * bounced[2] else coefficient * bounced[2] / short
    return bounced + share * rough
