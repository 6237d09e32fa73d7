"""An orbit to begin with, somewhere in a range of frequencies."""

import numpy as np

from stylobate.engine import with_parameters
from stylobate.errors import NoOrbitError
from stylobate.models import Model
from stylobate.motions import BaseMotion
from stylobate.orbits import PeriodicOrbit, periodic_orbit

_TRIES = 24


def first_orbit(
    model: Model, motion: BaseMotion, angular_frequency: tuple[float, float], sense: int | None
) -> PeriodicOrbit:
    """Return rolling by theory at the highest frequency of the range [rad/s] at which it is found.

    Raises
    ------
    NoOrbitError
        If it is found at none that was tried.
    """
    low, high = angular_frequency
    reason: Exception | None = None
    for frequency in np.geomspace(high, max(low, 1e-3 * high), _TRIES):
        changed = with_parameters(model, motion, angular_frequency=float(frequency))
        try:
            return periodic_orbit(*changed, sense=sense)
        except NoOrbitError as error:
            reason = error
    message = f"no orbit was found between {low!r} and {high!r} rad/s to begin with: {reason}"
    raise NoOrbitError(message)
