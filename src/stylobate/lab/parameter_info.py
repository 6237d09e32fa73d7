"""The numbers one can set: symbol, unit, what they are, and the range of a slider where one range serves all."""

from collections.abc import Mapping
from dataclasses import dataclass

from stylobate.base_motions.declared import motion_quantities
from stylobate.models.declared import column_quantities, model_quantities


@dataclass(frozen=True, slots=True)
class Number:
    """How a number is shown; without a range a slider takes one about the present value."""

    symbol: str = ""
    unit: str = ""
    about: str = ""
    first: float | None = None
    last: float | None = None
    choices: tuple[int, ...] = ()


def _declared() -> Mapping[str, Number]:
    """Return the numbers of columns, models and base motions, as they are declared there."""
    return {
        name: Number(one.symbol, one.unit, one.text, first, last, one.choices)
        for name, one in {**column_quantities(), **model_quantities(), **motion_quantities()}.items()
        for first, last in [one.slider or (None, None)]
    }


NUMBERS: Mapping[str, Number] = {
    **_declared(),
    "scale": Number("", "", "scale factor", 0.1, 4.0),
    "rotation": Number("", "rad", "turned by", -3.142, 3.142),
    "tail": Number("", "s", "rest after the record"),
}
