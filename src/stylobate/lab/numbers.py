"""The numbers one can set: symbol, unit, what they are, and the range of a slider where one range serves all."""

from collections.abc import Mapping
from dataclasses import dataclass

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


_TURN = 6.283


def _declared() -> Mapping[str, Number]:
    """Return the numbers of columns and models, as they are declared there."""
    return {
        name: Number(one.symbol, one.unit, one.text, *(one.slider or ()))
        for name, one in {**column_quantities(), **model_quantities()}.items()
    }


NUMBERS: Mapping[str, Number] = {
    **_declared(),
    "acceleration": Number("a", "m/s²", "amplitude of the acceleration"),
    "amplitude": Number("", "", "amplitudes along the axes"),
    "angular_frequency": Number("Ω", "rad/s", "angular frequency"),
    "frequency": Number("f", "Hz", "frequency"),
    "direction": Number("", "rad", "direction in the plane, from x towards y", -3.142, 3.142),
    "angle": Number("", "rad", "rise above the horizontal", -1.5, 1.5),
    "phase": Number("", "rad", "phase", -3.142, 3.142),
    "start_phase": Number("", "rad", "phase at the start", 0.0, _TURN),
    "ramp": Number("", "s", "time in which it grows to its amplitude"),
    "sense": Number("", "", "+1 anticlockwise, −1 clockwise", choices=(1, -1)),
    "stroke": Number("", "m", "stroke from peak to peak"),
    "diameter": Number("", "m", "diameter of the circle"),
    "rpm": Number("", "1/min", "turns a minute"),
    "velocity": Number("v", "m/s", "amplitude of the velocity"),
    "oscillations": Number("", "", "oscillations under the bell", 1.0, 6.0),
    "cycles": Number("", "", "cycles", 1.0, 6.0),
    "start": Number("", "s", "when it begins"),
    "vertical": Number("", "", "vertical part over the horizontal", -1.0, 1.0),
    "displacement": Number("", "m", "amplitude of the displacement"),
    "frequencies": Number("f", "Hz", "first and last frequency"),
    "length": Number("", "s", "length"),
    "scale": Number("", "", "scale factor", 0.1, 4.0),
    "rotation": Number("", "rad", "turned by", -3.142, 3.142),
    "tail": Number("", "s", "rest after the record"),
}
