"""Ballistic passage of a column so close to the vertical that its path cannot be resolved."""

import math


def pass_vertical(
    lean: tuple[float, float, float, float],
    push: tuple[float, float],
    weight: float,
    gyration: float,
    eta: float,
    inertia: float,
) -> tuple[float, tuple[float, float, float, float]]:
    """Return the duration and the end state of a passage; it ends at the tilt at which it begins.

    Near the vertical the angular momentum ℓ = |α|²β̇ and the spin are constant, and K d²|α|/dτ² = ℓ²/|α|³ − Gℓ/|α|².
    The path is a conic, along which the azimuth turns by 2√K φ, tan φ = √K|ȧ|/(|ℓ|(1/|α| − G/ℓ)). Between infinite
    distances it turns by √K [π + 2 sgn(ℓ) atan(G/(√K v))]. The weight adds the kick −(2wb/(Kv)) asinh(l/b) across a
    path with offset b and speed v; l is the distance from the point of closest approach. The effect of damping and base
    is also added, one half before the turn and one half after it.

    Parameters
    ----------
    lean
        x, y, vx, vy at the start of the passage.
    push
        Tilt acceleration without the terms of damping and weight.
    weight
        w = c(1 + a_z), the moment of the weight about the rim.
    gyration
        G = cκσ for a column with the spin σ.
    eta, inertia
        Damping η, and K, the moment of inertia about a tangent of the rim over J0.
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
    # The state on the other side of a straight passage, rotated about the vertical.
    out_x, out_y = ahead * ux - offset * uy, ahead * uy + offset * ux
    way_x, way_y = vx + jump_x - kick * uy, vy + jump_y + kick * ux
    way_x, way_y = cos * way_x - sin * way_y + jump_x, sin * way_x + cos * way_y + jump_y
    shift = 0.5 * elapsed
    end_x, end_y = cos * out_x - sin * out_y + jump_x * shift, sin * out_x + cos * out_y + jump_y * shift
    return elapsed, (end_x, end_y, way_x, way_y)


def _bend(lean: tuple[float, float, float, float], gyration: float, root: float) -> float:
    """Return the turn of the azimuth beyond that of a straight path; 0 for a path through the vertical itself."""
    x, y, vx, vy = lean
    tilt, momentum = math.hypot(x, y), x * vy - y * vx
    if momentum == 0.0:
        return 0.0
    inward = -(x * vx + y * vy) / tilt
    straight = math.atan2(inward, abs(momentum) / tilt)
    sense = math.copysign(1.0, momentum)
    against = abs(momentum) / tilt - sense * gyration
    return 2.0 * sense * (root * math.atan2(root * inward, against) - straight)
