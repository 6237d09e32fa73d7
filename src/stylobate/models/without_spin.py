"""Functions of the models at finite tilt without spin, whose parameters begin with c, η, κ."""

from stylobate.models import finite_tilt
from stylobate.models.departing import departing_lean
from stylobate.models.model import Push


def rest_energy(tilt: float, speed: float, vertical: float, c: float, _eta: float, kappa: float, *_: float) -> float:
    """Return ½K|α̇|² + c(1 + a_z)|α|, the energy above rest near the vertical."""
    return finite_tilt.energy_at_rest(tilt, speed, vertical, c, kappa)


def no_return_tilt(peak_horizontal: float, minimum_vertical: float, c: float, *_: float) -> float:
    """Return the point of no return [rad], beyond which a growing tilt can never come back."""
    return finite_tilt.no_return_tilt(peak_horizontal, minimum_vertical, c)


def departure(
    push: Push, elapsed: float, c: float, eta: float, kappa: float, resistance: float
) -> tuple[float, float, float, float]:
    """Return the state a short time after uplift."""
    damping, inertia, gain = finite_tilt.uplift_terms(push, c, eta, kappa, resistance)
    return departing_lean(push, elapsed, damping, inertia, gain, 1.0)[:4]
