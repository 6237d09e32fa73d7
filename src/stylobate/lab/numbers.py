"""The numbers one can set: symbol, unit, what they are, and the range of a slider where one range serves all."""

from collections.abc import Mapping
from dataclasses import dataclass


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

NUMBERS: Mapping[str, Number] = {
    "radius": Number("r", "m", "radius of the base"),
    "height": Number("H", "m", "height of the body"),
    "density": Number("ρ", "kg/m³", "density"),
    "inner_radius": Number("r_i", "m", "inner radius"),
    "top_radius": Number("r_t", "m", "radius of the top"),
    "mass": Number("m", "kg", "mass"),
    "mass_height": Number("h", "m", "height of the centre of mass"),
    "transverse_inertia": Number("I_t", "kg m²", "about a horizontal axis through the centre of mass"),
    "axial_inertia": Number("I_a", "kg m²", "about the axis"),
    "gravity": Number("g", "m/s²", "gravity", 0.5, 15.0),
    "slenderness": Number("c", "", "slenderness r/h", 0.02, 0.5),
    "inertia_ratio": Number("κ", "", "m h²/J0", 0.3, 0.95),
    "axial_ratio": Number("i_a", "", "I_a/(m r²)", 0.1, 1.0),
    "damping": Number("η", "", "friction of tilting", 0.0, 0.5),
    "spin_friction": Number("ζ", "", "friction of turning", 0.0, 2.0),
    "rolling_resistance": Number("μ_r", "", "rolling resistance", 0.0, 0.05),
    "restitution": Number("e", "", "speed kept when the base strikes", 0.0, 1.0),
    "passage_tilt": Number("", "rad", "tilt below which the upright is passed"),
    "friction_coefficient": Number("μ", "", "friction of the contact", 0.02, 1.2),
    "static_friction_coefficient": Number("μ_s", "", "friction of the contact at rest", 0.02, 1.5),
    "patch": Number("", "", "radius of the contact patch over that of the base", 0.0, 0.2),
    "incline": Number("", "rad", "slope of the base", 0.0, 0.4),
    "incline_direction": Number("", "rad", "direction of the slope", -3.142, 3.142),
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
