"""Parameters of the page: symbol, unit, description, and range of the slider if one range suits all cases."""

from collections.abc import Mapping
from dataclasses import dataclass

from stylobate.base_motions.declared import motion_quantities
from stylobate.column import Column
from stylobate.engine.parameters import COLUMN_NAMES, MOTION_NAMES
from stylobate.models.declared import column_quantities, model_quantities
from stylobate.quantities import Quantity


@dataclass(frozen=True, slots=True)
class Number:
    """Symbol, unit, description and slider of a number; without a range the slider is centred on the present value."""

    symbol: str = ""
    unit: str = ""
    about: str = ""
    first: float | None = None
    last: float | None = None
    choices: tuple[int, ...] = ()


def _declared() -> Mapping[str, Number]:
    """Return the numbers of columns, models and base motions, from their declarations."""
    return {
        name: Number(one.symbol, one.unit, one.text, first, last, one.choices)
        for name, one in {**column_quantities(), **model_quantities(), **motion_quantities()}.items()
        for first, last in [one.slider or (None, None)]
    }


NUMBERS: Mapping[str, Number] = {
    **_declared(),
    "scale": Number("", "", "scale factor", 0.1, 4.0),
    "rotation": Number("", "rad", "rotation about the vertical", -3.142, 3.142),
    "tail": Number("", "s", "free-vibration time after the record"),
}

OF_ANY_COLUMN = {
    **{
        name: one
        for name, one in column_quantities().items()
        if hasattr(Column, name) and name != "height"  # not every column has a height
    },
    "frequency_scale": Quantity(unit="rad/s", text="ω0"),
    "frequency_parameter": Quantity(unit="rad/s", text="frequency parameter √(m g R/K)"),
}
"""The attributes of a column that the page shows."""

_PATHS_AND_RATES = ("m", "m/s", "Hz", "1/min")

CASE_NUMBERS = {
    # A sweep varies a radius at constant mass; the mass of a body of a described shape depends on its radius.
    "column": {name: one for name, one in column_quantities().items() if name not in COLUMN_NAMES or name == "radius"},
    # Displacements and rates, from which acceleration and angular frequency follow; a sweep supports these.
    "motion": {
        name: one for name, one in motion_quantities().items() if one.unit in _PATHS_AND_RATES and one.components == 1
    },
}
"""Numbers that an axis can vary besides the quantities of sweeps, by the part that they describe."""

VARIED = frozenset(
    {*COLUMN_NAMES, *MOTION_NAMES, *model_quantities(), *CASE_NUMBERS["column"], *CASE_NUMBERS["motion"]}
)
"""The numbers of columns, models and base motions that a map can vary."""
