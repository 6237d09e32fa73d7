"""Uplift and passage of the vertical of a column with free axial rotation (spin)."""

import math

from stylobate.models.departing import departing_lean
from stylobate.models.model import Push
from stylobate.models.passing import pass_vertical


def departing(
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


def passing(
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
