"""The numbers by which the reference judges a run while it goes on."""

import math
from dataclasses import dataclass

from stylobate.engine.forcing import least_rest_energy, rest_energy_for_good, usual_rest_energy
from stylobate.errors import require_not_negative, require_positive
from stylobate.models import Model

from .forcing import Forcing


@dataclass(frozen=True, slots=True, kw_only=True)
class Thresholds:
    """The numbers by which a run is judged; all of them are kept with its result.

    Parameters
    ----------
    rest_energy
        ε: rest is entered below the energy ε c² at most; 0 where friction cannot bring the column to rest.
    rest_energy_for_good
        The same once nothing to come can release the column again.
    tilt_limit
        Tilt that ends the run, set by the user [rad]; infinite for none.
    overturned_tilt
        Tilt that counts as overturned where no rigorous criterion exists [rad].
    """

    rest_energy: float
    rest_energy_for_good: float = 0.0
    tilt_limit: float = math.inf
    overturned_tilt: float = math.pi / 2.0


def thresholds_of(model: Model, forcing: Forcing, tilt_limit: float | None, rest_energy: float | None) -> Thresholds:
    """Return the thresholds of a run; a `tilt_limit` [rad] and a `rest_energy` the user gives are checked."""
    asked = None if rest_energy is None else require_not_negative("rest_energy", rest_energy)
    limit = math.inf if tilt_limit is None else require_positive("tilt_limit", tilt_limit, "rad")
    if not model.comes_to_rest:
        return Thresholds(rest_energy=0.0, tilt_limit=limit)
    energy = _default_rest_energy(model, forcing) if asked is None else asked
    for_good = float(rest_energy_for_good(forcing.mean_frequency)) if asked is None else asked
    return Thresholds(rest_energy=energy, rest_energy_for_good=for_good, tilt_limit=limit)


def _default_rest_energy(model: Model, forcing: Forcing) -> float:
    return float(usual_rest_energy(*_forced(model, forcing), least=least_rest_energy(forcing.motion)))


def _forced(model: Model, forcing: Forcing) -> tuple[float, float, float, float]:
    least = forcing.minimum_vertical(0.0)
    return forcing.mean_frequency, forcing.peak_horizontal(0.0), least, model.rest_capacity
