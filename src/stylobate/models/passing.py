"""How a column passes the upright so closely that its path cannot be resolved."""

import math


def past_the_upright(
    lean: tuple[float, float, float, float],
    push: tuple[float, float],
    weight: float,
    gyration: float,
    eta: float,
    inertia: float,
) -> tuple[float, tuple[float, float, float, float]]:
    """Return the duration and the end of a passage, at the tilt at which it begins.

    Near the upright, with the angular momentum ℓ = |α|²β̇ and the spin held, K d²|α|/dτ² = ℓ²/|α|³ − Gℓ/|α|²: a
    conic, along which the azimuth turns by 2√K φ, tan φ = √K|ȧ|/(|ℓ|(1/|α| − G/ℓ)), and beyond all bounds by
    √K [π + 2 sgn(ℓ) atan(G/(√K v))]. To this come the kick −(2wb/(Kv)) asinh(l/b) of the weight across a path with
    offset b at speed v, l being the distance to the point of closest approach, and what friction and base do meanwhile,
    half of it before the turn.

    Parameters
    ----------
    lean
        x, y, vx, vy where the passage begins.
    push
        Rate of the tilt rate by all else than friction and weight.
    weight
        w = c(1 + a_z), the moment of the weight about the rim.
    gyration
        G = cκσ for a column with the spin σ.
    eta, inertia
        Viscous friction, and K, the moment of inertia about a tangent of the rim over J0.
    """
    x, y, vx, vy = lean
    speed = math.hypot(vx, vy)
    ux, uy = vx / speed, vy / speed
    ahead, offset = -(x * ux + y * uy), y * ux - x * uy
    elapsed = 2.0 * ahead / speed
    jump_x = 0.5 * (push[0] - eta * vx) * elapsed
    jump_y = 0.5 * (push[1] - eta * vy) * elapsed
    bend = _bend(lean, gyration, math.sqrt(inertia))
    cos, sin = math.cos(bend), math.sin(bend)
    kick = -2.0 * weight / (inertia * speed) * (offset * math.asinh(ahead / abs(offset)) if offset != 0.0 else 0.0)
    # The state on the other side of a straight passage, turned about the upright.
    out_x, out_y = ahead * ux - offset * uy, ahead * uy + offset * ux
    way_x, way_y = vx + jump_x - kick * uy, vy + jump_y + kick * ux
    way_x, way_y = cos * way_x - sin * way_y + jump_x, sin * way_x + cos * way_y + jump_y
    shift = 0.5 * elapsed
    end_x, end_y = cos * out_x - sin * out_y + jump_x * shift, sin * out_x + cos * out_y + jump_y * shift
    return elapsed, (end_x, end_y, way_x, way_y)


def _bend(lean: tuple[float, float, float, float], gyration: float, root: float) -> float:
    """Return by what more the azimuth turns than along a straight path; straight on, where it leads to the upright."""
    x, y, vx, vy = lean
    tilt, momentum = math.hypot(x, y), x * vy - y * vx
    if momentum == 0.0:
        return 0.0
    inward = -(x * vx + y * vy) / tilt
    straight = math.atan2(inward, abs(momentum) / tilt)
    sense = math.copysign(1.0, momentum)
    against = abs(momentum) / tilt - sense * gyration
    return 2.0 * sense * (root * math.atan2(root * inward, against) - straight)
