"""Uplift of a column from its base: series in the time since uplift."""

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
