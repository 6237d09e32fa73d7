"""Uplift of a column from its base: series in the time since uplift."""

from stylobate.models.model import Push


def departing_lean(
    push: Push, elapsed: float, eta: float, inertia: float, response: float
) -> tuple[float, float, float, float, float]:
    """Return the tilt vector a short time δ = `elapsed` after uplift, by series about α = 0.

    Along the push α = Fδ²/2 with F = (excess + (excess_rate − η excess/K) δ/3)/K; across it α = qδ³ with
    q (4 + 2b|a_h|/F) = b |a_h| × turning_rate, which for F → 0 is a lean that follows −a_h.

    Parameters
    ----------
    push
        Push of the base at uplift.
    elapsed
        δ.
    eta
        Damping η.
    inertia
        K, the moment of inertia for a lean along the push, over J0.
    response
        b: a base acceleration a_n across the lean accelerates the lean by −b a_n.

    Returns
    -------
    tuple
        Tilt vector, tilt rate, and the rate at which the push turns ahead of the lean.
    """
    jerk = push.excess_rate - eta * push.excess / inertia
    mean = (push.excess + jerk * elapsed / 3.0) / inertia
    if mean <= 0.0:
        return 0.0, 0.0, 0.0, 0.0, 0.0
    along = 0.5 * mean * elapsed**2
    along_rate = (push.excess * elapsed + 0.5 * jerk * elapsed**2) / inertia
    pushed = response * push.acceleration
    across = pushed * push.turning_rate * elapsed**3 / (4.0 + 2.0 * pushed / mean)
    across_rate = across / elapsed * (3.0 + jerk * elapsed / (3.0 * inertia) / mean)
    ahead = push.turning_rate - 2.0 * across / (mean * elapsed**3)
    ux, uy = push.direction
    return (
        along * ux - across * uy,
        along * uy + across * ux,
        along_rate * ux - across_rate * uy,
        along_rate * uy + across_rate * ux,
        ahead,
    )
