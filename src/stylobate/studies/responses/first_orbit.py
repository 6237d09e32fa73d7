"""An orbit to begin with, somewhere in a range of frequencies."""

import logging

import numpy as np

from stylobate.base_motions import BaseMotion, as_harmonic
from stylobate.engine import with_parameters
from stylobate.errors import NoOrbitError, UnsupportedError
from stylobate.models import Model
from stylobate.orbits import PeriodicOrbit, periodic_orbit

_log = logging.getLogger("stylobate")

_TRIES = 24
# What a search from a guess asks for, and a range of frequencies does not.
_ASKED = "guess must be given: "


def first_orbit(
    model: Model, motion: BaseMotion, angular_frequency: tuple[float, float], sense: int | None
) -> PeriodicOrbit:
    """Return rolling by theory at the highest frequency of the range [rad/s] at which it is found.

    Raises
    ------
    NoOrbitError
        If it is found at none that was tried.
    UnsupportedError
        If theory knows no rolling of this model under this motion.
    """
    low, high = angular_frequency
    reason: Exception | None = None
    for frequency in np.geomspace(high, max(low, 1e-3 * high), _TRIES):
        _log.info("%.4g rad/s is tried for a first orbit", frequency)
        changed = with_parameters(model, motion, angular_frequency=float(frequency))
        try:
            return periodic_orbit(*changed, sense=sense)
        except NoOrbitError as error:
            reason = error
        except UnsupportedError as error:
            reason_given = _unknown(model, motion) if str(error).startswith("guess must be given") else str(error)
            message = f"no orbit is known to begin with: {reason_given}"
            raise UnsupportedError(message) from None
    message = (
        f"no orbit was found between {low!r} and {high!r} rad/s: {_sentence(reason)}; widen the range, or "
        "make the acceleration larger"
    )
    raise NoOrbitError(message)


def _unknown(model: Model, motion: BaseMotion) -> str:
    """Return of what theory has no rolling, and the remedy: the repr of a motion would fill a screen."""
    harmonic = as_harmonic(motion)
    if harmonic is None:
        under = f"under {type(motion).__name__} motion"
    else:
        under = "with a vertical amplitude" if harmonic.amplitude[2] != 0.0 else "under horizontal motion"
    return (
        f"theory has no steady rolling of this {model.name} model {under}; give orbits.periodic_orbit a run as guess, "
        "and follow its orbit by orbits.continue_branch"
    )


def _sentence(reason: Exception | None) -> str:
    return str(reason).removeprefix(_ASKED)
