"""Quantities that a sweep can vary: names, units and accepted numbers."""

from collections.abc import Iterable, Mapping
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from stylobate.base_motions import BaseMotion
from stylobate.engine.parameters import check_names
from stylobate.errors import ParameterError, as_numbers, require_finite, require_size
from stylobate.models import Model
from stylobate.parameter_quantities import quantity_of
from stylobate.quantities import Parameter

Floats = npt.NDArray[np.float64]
Own: TypeAlias = Mapping[str, Parameter] | None

STARTS = ("tilt_x", "tilt_y", "tilt_rate_x", "tilt_rate_y")
"""Components of the initial conditions."""

OF_A_RUN = (*STARTS, "spin", "duration")
"""Quantities that can vary besides the parameters of `simulate_ensemble`."""


def check_quantities(where: str, model: Model, names: Iterable[str], motion: BaseMotion | None = None) -> None:
    """Raise ParameterError if one of the `names` in the argument `where` cannot vary, or two are contradictory."""
    check_names(model, motion, names, where=where, others=OF_A_RUN)


def checked_values(where: str, name: str, values: npt.ArrayLike, own: Own = None, *, scalar: bool = False) -> Floats:
    """Return `values` of the quantity `name` as an array, shape (n,).

    Parameters
    ----------
    where
        The argument with names and values; or, such as scales, with the values alone.
    name, values
        The quantity and its values, which may be quantities of pint or astropy.
    own
        Declared numbers of the model and base motion at hand.
    scalar
        Whether the argument is the values alone, and a single number a list of one.

    Raises
    ------
    ParameterError
        If the values are not a list of numbers, or the quantity does not accept one of them.

    Warns
    -----
    UnlikelyInputWarning
        If the largest value was more likely meant in another unit.
    """
    argument = where if scalar or where in (name, f"{name}s") else f"{where}[{name!r}]"
    quantity = quantity_of(name, own)
    values = as_numbers(argument, values, quantity.unit)
    try:
        array = np.array(values, dtype=np.float64, ndmin=int(scalar))  # a copy: a sweep is immutable
    except (TypeError, ValueError):
        message = f"{argument} must be a list of numbers, got {values!r}"
        raise ParameterError(message) from None
    if array.ndim != 1:
        message = f"{argument} must be a list of numbers, got an array of shape {array.shape}"
        raise ParameterError(message)
    refused = ~quantity.accepts(array)
    if refused.any():
        number = require_finite(argument, float(array[refused][0]), quantity.unit)
        require_size(argument, number, quantity.unit)
        raise ParameterError(quantity.refusal(argument, number))
    for value in (array.min(initial=1.0), array.max(initial=1.0)):
        require_size(argument, float(value), quantity.unit, zero=quantity.gt is None or quantity.gt < 0.0)
    if array.size:
        quantity.question(argument, float(array[np.argmax(np.abs(array))]))
    array.setflags(write=False)
    return array
