"""Parameters that a study can vary by name, with their units and valid values."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from stylobate.base_motions.declared import motion_quantities
from stylobate.column import Column
from stylobate.models.declared import model_quantities
from stylobate.quantities import Quantity, parameters_of

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class VariedQuantity:
    """Name, unit and valid values of a parameter that a study varies."""

    long_name: str
    units: str
    accepts: Callable[[Floats], npt.NDArray[np.bool_]] = np.isfinite
    demand: str = "be finite"


def _positive(long_name: str, units: str) -> VariedQuantity:
    return VariedQuantity(long_name, units, lambda values: np.isfinite(values) & (values > 0.0), "be positive")


def _not_negative(long_name: str, units: str) -> VariedQuantity:
    return VariedQuantity(long_name, units, lambda values: np.isfinite(values) & (values >= 0.0), "be zero or positive")


def _declared(quantity: Quantity) -> VariedQuantity:
    return VariedQuantity(quantity.text, quantity.cf_units, quantity.accepts, quantity.demand)


_QUANTITIES = {
    "tilt_x": VariedQuantity("initial tilt along x", "rad"),
    "tilt_y": VariedQuantity("initial tilt along y", "rad"),
    "tilt_rate_x": VariedQuantity("initial rate of tilt along x", "rad s-1"),
    "tilt_rate_y": VariedQuantity("initial rate of tilt along y", "rad s-1"),
    "spin": VariedQuantity("initial angular velocity about the axis", "rad s-1"),
    "duration": _positive("duration", "s"),
    **{name: _declared(parameter.quantity) for name, parameter in parameters_of(Column).items()},
    "slenderness": _positive("slenderness", "1"),
    "size": _positive("size relative to the given column", "1"),
    **{name: _declared(quantity) for name, quantity in model_quantities().items()},
    **{f"{part}{name}": _declared(one) for name, one in motion_quantities().items() for part in ("", "motion.")},
    "motion": VariedQuantity(
        "number of the base motion",
        "1",
        lambda values: (values >= 0.0) & (values % 1.0 == 0.0),
        "be a whole number from 0 on",
    ),
    "acceleration": _not_negative("peak horizontal acceleration of the base", "m s-2"),
    "scale": VariedQuantity("factor of the base motion", "1"),
    "angular_frequency": _positive("angular frequency", "rad s-1"),
    "start_phase": VariedQuantity("phase of the base motion at the start", "rad"),
    "rotation": VariedQuantity("rotation of the base motion", "rad"),
    "delay": VariedQuantity("delay of the base motion", "s"),
    **{f"offset_{axis}": VariedQuantity(f"constant acceleration of the base along {axis}", "m s-2") for axis in "xy"},
    **{f"amplitude_{axis}": VariedQuantity(f"acceleration of the base along {axis}", "m s-2") for axis in "xyz"},
    "phase_difference": VariedQuantity("phase of the base along y minus phase along x", "rad"),
}

# Parameters of a user-defined model.
_ANY = VariedQuantity("", "")


def quantity_of(name: str) -> VariedQuantity:
    """Return the quantity `name`; an unknown name has a quantity that accepts any finite number."""
    return _QUANTITIES.get(name, _ANY)


def attributes_of(name: str) -> dict[str, str]:
    """Return the attributes of a coordinate that holds the quantity `name`."""
    known = _QUANTITIES.get(name)
    return {} if known is None else {"long_name": known.long_name, "units": known.units}
