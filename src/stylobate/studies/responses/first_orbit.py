"""First orbit for a continuation within a range of frequencies."""

import logging

import numpy as np

from stylobate.base_motions import BaseMotion, as_harmonic
from stylobate.engine import with_parameters
from stylobate.errors import NoOrbitError, UnsupportedError
from stylobate.models import Model
from stylobate.orbits import PeriodicOrbit, periodic_orbit

_log = logging.getLogger("stylobate")

_TRIES = 24
# Start of the message of a search without a guess.
_ASKED = "guess must be given: "


def first_orbit(
    model: Model, motion: BaseMotion, angular_frequency: tuple[float, float], sense: int | None
) -> PeriodicOrbit:
    """Find a rolling orbit from theory, at the highest frequency of the range [rad/s] at which the search succeeds.

    Raises
    ------
    NoOrbitError
        If no orbit is found at the frequencies that were tried.
    UnsupportedError
        If theory has no rolling of this model under this motion.
    """
    low, high = angular_frequency
    reason: Exception | None = None
    for frequency in np.geomspace(high, max(low, 1e-3 * high), _TRIES):
        _log.info("searching for a first orbit at %.4g rad/s", frequency)
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
        f"no orbit was found between {low!r} and {high!r} rad/s: {_sentence(reason)}. Widen the range, or "
        "increase the acceleration"
    )
    raise NoOrbitError(message)


def _unknown(model: Model, motion: BaseMotion) -> str:
    """Describe the model and motion without rolling in theory, and the remedy, without the long repr of a motion."""
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
