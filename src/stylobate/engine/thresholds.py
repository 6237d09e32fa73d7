"""The numbers by which a run is judged while it goes on, and how small an energy counts as rest."""

import math
from dataclasses import dataclass

from stylobate.engine.forcing import Forcing
from stylobate.errors import require_not_negative, require_positive
from stylobate.models import Model

# The energy of steady rolling at frequency θ is 1.5 c²/θ²; rest is entered below a hundredth of it at most.
_REST_ENERGY, _REST_ENERGY_ROLLING = 1e-4, 0.015
# Where the base motion can release the column again, at most a hundredth of the energy it releases it with; not below
# the last number, which bounds the number of hops to follow.
_REST_ENERGY_HOP, _LEAST_REST_ENERGY = 0.01, 1e-8


@dataclass(frozen=True, slots=True, kw_only=True)
class Thresholds:
    """The numbers by which a run is judged; all of them are kept with its result.

    Parameters
    ----------
    rest_energy
        ε: rest is entered below the energy ε c² at most; 0 where friction cannot bring the column to rest.
    tilt_limit
        Tilt that ends the run, set by the user [rad]; infinite for none.
    overturned_tilt
        Tilt that counts as overturned where no rigorous criterion exists [rad].
    """

    rest_energy: float
    tilt_limit: float = math.inf
    overturned_tilt: float = math.pi / 2.0

    def rest_is_coarse(self, model: Model, forcing: Forcing) -> bool:
        """Return whether rest may be entered between hops so small that they may have grown instead."""
        hop = hop_energy(model, forcing)
        return hop is not None and _REST_ENERGY_HOP * hop < self.rest_energy


def thresholds_of(model: Model, forcing: Forcing, tilt_limit: float | None, rest_energy: float | None) -> Thresholds:
    """Return the thresholds of a run; a `tilt_limit` [rad] and a `rest_energy` the user gives are checked."""
    asked = None if rest_energy is None else require_not_negative("rest_energy", rest_energy)
    energy = 0.0 if not model.comes_to_rest else _default_rest_energy(model, forcing) if asked is None else asked
    limit = math.inf if tilt_limit is None else require_positive("tilt_limit", tilt_limit, "rad")
    return Thresholds(rest_energy=energy, tilt_limit=limit)


def _default_rest_energy(model: Model, forcing: Forcing) -> float:
    frequency = forcing.highest_frequency
    if frequency == 0.0:
        return _REST_ENERGY
    energy = min(_REST_ENERGY, _REST_ENERGY_ROLLING / frequency**2)
    hop = hop_energy(model, forcing)
    return energy if hop is None else min(energy, max(_LEAST_REST_ENERGY, _REST_ENERGY_HOP * hop))


def hop_energy(model: Model, forcing: Forcing) -> float | None:
    """Return the energy [c²] that a harmonic peak gives a column it has just released; None if it cannot release it.

    With |a_h| = c(1 + δ) at the peak the excess lasts 2√(2δ)/θ and leaves the speed (4/3)√2 c δ^{3/2}/θ.
    """
    weight = 1.0 + forcing.least_vertical(0.0)
    if weight <= 0.0:
        return math.inf
    excess = forcing.largest_horizontal(0.0) / (model.rest_capacity * weight) - 1.0
    if excess <= 0.0:
        return None
    frequency = forcing.highest_frequency
    return 16.0 / 9.0 * excess**3 / frequency**2 if frequency > 0.0 else math.inf
