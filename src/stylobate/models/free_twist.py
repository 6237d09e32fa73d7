"""How a column that may turn about its axis leaves its base and passes the upright: with what its spin does to it."""

import math

from stylobate.models.departing import departing_lean
from stylobate.models.model import Push
from stylobate.models.passing import past_the_upright


def departing(
    push: Push, elapsed: float, inertia: float, c: float, eta: float, kappa: float, axial: float
) -> tuple[float, float, float, float, float]:
    """Return the state a short time δ after release, its spin −½|a_h| β (1 − κ)δ²/(cκD).

    β is the rate at which the push turns ahead of the lean, `inertia` that about a tangent of the rim over J0.
    """
    freedom = 1.0 + axial - kappa
    x, y, vx, vy, ahead = departing_lean(push, elapsed, eta, inertia, axial / freedom)
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
    """Return the duration and the end of a passage of the upright, on which the spin turns the path.

    Without loss: the limit of grazing rolling.
    """
    x, y, vx, vy = lean
    ax, ay, az = acceleration
    speed = math.hypot(vx, vy)
    ux, uy = vx / speed, vy / speed
    freedom, sideways = 1.0 + axial - kappa, ay * ux - ax * uy
    along, across = (ax * ux + ay * uy) / inertia, sideways * axial / freedom
    push = (across * uy - along * ux, -across * ux - along * uy)
    # The base spins it up until it turns, and down as much behind.
    gained = sideways * (1.0 - kappa) / (c * kappa * freedom) * (x * ux + y * uy) / speed
    gyration = c * kappa * (spin + gained)
    elapsed, end = past_the_upright(lean, push, c * (1.0 + az), gyration, eta, inertia)
    return elapsed, (*end, spin * math.exp(-zeta * elapsed))
