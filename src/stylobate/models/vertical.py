"""Uplift of a column from its base, and its passage of the vertical."""

import math

from stylobate.models.model import Push


def departing_lean(
    push: Push, elapsed: float, damping: float, inertia: float, gain: float, response: float
) -> tuple[float, float, float, float, float]:
    """Return the tilt vector a short time δ = `elapsed` after uplift, by series about α = 0.

    Along the push K α̈ = F(τ) − η α̇ + g α, with F = excess + excess_rate τ: α = (F δ²/2 + j δ³/6 + s δ⁴/24)/K with
    j = excess_rate − η F/K and s = g F/K − η j/K. Across it α = qδ³ with q (4 + 2b|a_h|/F̄) = b |a_h| × turning_rate,
    F̄ = 2Kα/δ², which for F → 0 is a lean that follows −a_h.

    Parameters
    ----------
    push
        Push of the base at uplift.
    elapsed
        δ.
    damping
        η, the damping couple per angular rate at a vanishing rate.
    inertia
        K, the moment of inertia for a lean along the push, over J0.
    gain
        g, by which the moment along the push grows with the tilt.
    response
        b: a base acceleration a_n across the lean accelerates the lean by −b a_n.

    Returns
    -------
    tuple
        Tilt vector, tilt rate, and the rate at which the push turns ahead of the lean.

    Notes
    -----
    The error of the tilt rate along the push is of the order δ⁴ if `excess_rate` is the mean rate over the first two
    thirds of δ: the speed δ³F̈/6 of a curved push is then complete. The error across the push is one order lower, and
    the angle between lean and push decays from there as τ^(−3/2) or faster.
    """
    per_inertia = 1.0 / inertia
    jerk = push.excess_rate - damping * push.excess * per_inertia
    snap = (gain * push.excess - damping * jerk) * per_inertia
    mean = (push.excess + (jerk + 0.25 * snap * elapsed) * elapsed / 3.0) * per_inertia
    if mean <= 0.0:
        return 0.0, 0.0, 0.0, 0.0, 0.0
    along = 0.5 * mean * elapsed**2
    along_rate = (push.excess + 0.5 * (jerk + snap * elapsed / 3.0) * elapsed) * elapsed * per_inertia
    pushed = response * push.acceleration
    across = pushed * push.turning_rate * elapsed**3 / (4.0 + 2.0 * pushed / mean)
    across_rate = across / elapsed * (3.0 + jerk * elapsed * per_inertia / (3.0 * mean))
    ahead = push.turning_rate - 2.0 * across / (mean * elapsed**3)
    ux, uy = push.direction
    return (
        along * ux - across * uy,
        along * uy + across * ux,
        along_rate * ux - across_rate * uy,
        along_rate * uy + across_rate * ux,
        ahead,
    )


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


def departure_with_spin(
    push: Push, elapsed: float, terms: tuple[float, float, float], c: float, kappa: float, axial: float
) -> tuple[float, float, float, float, float]:
    """Return the state a short time δ after uplift, with the spin −½|a_h| β (1 − κ)δ²/(cκΛ).

    β is the rate at which the push turns ahead of the lean; `terms` are damping, moment of inertia about a tangent of
    the rim over J0 and gain, as for `departing_lean`.
    """
    damping, inertia, gain = terms
    freedom = 1.0 + axial - kappa
    x, y, vx, vy, ahead = departing_lean(push, elapsed, damping, inertia, gain, axial / freedom)
    spin = -0.5 * push.acceleration * ahead * elapsed**2 * (1.0 - kappa) / (freedom * c * kappa)
    return x, y, vx, vy, spin


def passage_with_spin(
    lean: tuple[float, float, float, float],
    spin: float,
    acceleration: tuple[float, float, float],
    inertia: float,
    c: float,
    eta: float,
    zeta: float,
    kappa: float,
    axial: float,
) -> tuple[float, tuple[float, float, float, float, float]]:
    """Return the duration and the end state of a passage of the vertical; the spin bends the path.

    The passage loses no energy: the limit of grazing rolling.
    """
    x, y, vx, vy = lean
    ax, ay, az = acceleration
    speed = math.hypot(vx, vy)
    ux, uy = vx / speed, vy / speed
    freedom, sideways = 1.0 + axial - kappa, ay * ux - ax * uy
    along, across = (ax * ux + ay * uy) / inertia, sideways * axial / freedom
    push = (across * uy - along * ux, -across * ux - along * uy)
    # The base spins the column up until the path turns, and down by as much after the turn.
    gained = sideways * (1.0 - kappa) / (c * kappa * freedom) * (x * ux + y * uy) / speed
    gyration = c * kappa * (spin + gained)
    elapsed, end = pass_vertical(lean, push, c * (1.0 + az), gyration, eta, inertia)
    return elapsed, (*end, spin * math.exp(-zeta * elapsed))
