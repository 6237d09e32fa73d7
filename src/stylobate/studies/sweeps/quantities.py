"""What a sweep can vary: names, units and the numbers they accept."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from stylobate.base_motions import BaseMotion
from stylobate.base_motions.declared import motion_quantities
from stylobate.column import Column
from stylobate.engine.parameters import check_names
from stylobate.errors import ParameterError, require_size
from stylobate.models import Model
from stylobate.models.declared import model_quantities
from stylobate.quantities import Quantity, parameters_of

Floats = npt.NDArray[np.float64]

STARTS = ("tilt_x", "tilt_y", "tilt_rate_x", "tilt_rate_y")
"""The components of the start."""

OF_A_RUN = (*STARTS, "spin", "duration")
"""What can vary besides the parameters of `simulate_ensemble`."""


@dataclass(frozen=True, slots=True)
class _Quantity:
    long_name: str
    units: str
    accepts: Callable[[Floats], npt.NDArray[np.bool_]] = np.isfinite
    demand: str = "be finite"


def _positive(long_name: str, units: str) -> _Quantity:
    return _Quantity(long_name, units, lambda values: np.isfinite(values) & (values > 0.0), "be positive")


def _not_negative(long_name: str, units: str) -> _Quantity:
    return _Quantity(long_name, units, lambda values: np.isfinite(values) & (values >= 0.0), "be zero or positive")


def _declared(quantity: Quantity) -> _Quantity:
    return _Quantity(quantity.text, quantity.cf_units, quantity.accepts, quantity.demand)


_QUANTITIES = {
    "tilt_x": _Quantity("initial tilt along x", "rad"),
    "tilt_y": _Quantity("initial tilt along y", "rad"),
    "tilt_rate_x": _Quantity("initial rate of tilt along x", "rad s-1"),
    "tilt_rate_y": _Quantity("initial rate of tilt along y", "rad s-1"),
    "spin": _Quantity("initial angular velocity about the axis", "rad s-1"),
    "duration": _positive("duration", "s"),
    **{name: _declared(parameter.quantity) for name, parameter in parameters_of(Column).items()},
    "slenderness": _positive("slenderness", "1"),
    "size": _positive("size, in that of the column given", "1"),
    **{name: _declared(quantity) for name, quantity in model_quantities().items()},
    **{name: _declared(quantity) for name, quantity in motion_quantities().items()},
    "motion": _Quantity(
        "number of the base motion", "1", lambda values: (values >= 0.0) & (values % 1.0 == 0.0), "be whole, from 0 on"
    ),
    "acceleration": _not_negative("largest horizontal acceleration of the base", "m s-2"),
    "scale": _Quantity("factor of the base motion", "1"),
    "angular_frequency": _positive("angular frequency", "rad s-1"),
    "start_phase": _Quantity("phase of the base motion at the start", "rad"),
    "rotation": _Quantity("rotation of the base motion", "rad"),
    "delay": _Quantity("delay of the base motion", "s"),
    **{f"amplitude_{axis}": _Quantity(f"acceleration of the base along {axis}", "m s-2") for axis in "xyz"},
    "phase_difference": _Quantity("phase of the base along y less that along x", "rad"),
}

# The parameters of a user's own model.
_ANY = _Quantity("", "")


def check_quantities(where: str, model: Model, names: Iterable[str], motion: BaseMotion | None = None) -> None:
    """Raise ParameterError if one of the `names` in the argument `where` cannot vary, or two say contrary things."""
    check_names(model, motion, names, where=where, others=OF_A_RUN)


def attributes_of(name: str) -> dict[str, str]:
    """Return the attributes of a coordinate that holds the quantity `name`."""
    known = _QUANTITIES.get(name)
    return {} if known is None else {"long_name": known.long_name, "units": known.units}


def checked_values(where: str, name: str, values: npt.ArrayLike) -> Floats:
    """Return `values` of the quantity `name` as an array, shape (n,).

    Parameters
    ----------
    where
        The argument that names it with its values; or, such as scales, holds its values alone.
    name, values
        The quantity and its values.

    Raises
    ------
    ParameterError
        If they are no list of numbers, or one of them is not what the quantity accepts.
    """
    argument = where if where in (name, f"{name}s") else f"{where}[{name!r}]"
    try:
        array = np.array(values, dtype=np.float64)  # a copy: what a sweep describes does not change
    except (TypeError, ValueError):
        message = f"{argument} must be a list of numbers, got {values!r}"
        raise ParameterError(message) from None
    if array.ndim != 1:
        message = f"{argument} must be a list of numbers, got an array of shape {array.shape}"
        raise ParameterError(message)
    quantity = _QUANTITIES.get(name, _ANY)
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
