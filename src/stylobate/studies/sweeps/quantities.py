"""Quantities that a sweep can vary: names, units and accepted numbers."""

from collections.abc import Iterable

import numpy as np
import numpy.typing as npt

from stylobate.base_motions import BaseMotion
from stylobate.engine.parameter_quantities import quantity_of
from stylobate.engine.parameters import check_names
from stylobate.errors import ParameterError, require_size
from stylobate.models import Model

Floats = npt.NDArray[np.float64]

STARTS = ("tilt_x", "tilt_y", "tilt_rate_x", "tilt_rate_y")
"""Components of the initial conditions."""

OF_A_RUN = (*STARTS, "spin", "duration")
"""Quantities that can vary besides the parameters of `simulate_ensemble`."""


def check_quantities(where: str, model: Model, names: Iterable[str], motion: BaseMotion | None = None) -> None:
    """Raise ParameterError if one of the `names` in the argument `where` cannot vary, or two are contradictory."""
    check_names(model, motion, names, where=where, others=OF_A_RUN)


def checked_values(where: str, name: str, values: npt.ArrayLike) -> Floats:
    """Return `values` of the quantity `name` as an array, shape (n,).

    Parameters
    ----------
    where
        The argument with names and values; or, such as scales, with the values alone.
    name, values
        The quantity and its values.

    Raises
    ------
    ParameterError
        If the values are not a list of numbers, or the quantity does not accept one of them.
    """
    argument = where if where in (name, f"{name}s") else f"{where}[{name!r}]"
    try:
        array = np.array(values, dtype=np.float64)  # a copy: a sweep is immutable
    except (TypeError, ValueError):
        message = f"{argument} must be a list of numbers, got {values!r}"
        raise ParameterError(message) from None
    if array.ndim != 1:
        message = f"{argument} must be a list of numbers, got an array of shape {array.shape}"
        raise ParameterError(message)
    quantity = quantity_of(name)
    refused = ~quantity.accepts(array)
    if refused.any():
        unit = f" {quantity.units}" if quantity.units not in ("", "1") else ""
        message = f"{argument} must {quantity.demand}, got {float(array[refused][0])!r}{unit}"
        raise ParameterError(message)
    unit = "" if quantity.units == "1" else quantity.units
    for value in (array.min(initial=1.0), array.max(initial=1.0)):
        require_size(argument, float(value), unit, zero=quantity.demand != "be positive")
    array.setflags(write=False)
    return array
