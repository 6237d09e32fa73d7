"""Declared parameters of base motions: symbols, units and ranges."""

import math
from collections.abc import Sequence
from typing import Annotated

from stylobate.quantities import QUARTER_TURN, Quantity, question_input
from stylobate.units import listed, meant

# Beyond the machines that exist: 1000 g, 100 kHz.
_MOST_ACCELERATION, _MOST_FREQUENCY = 1e4, 1e5

_SHORT = "since a pulse is short: use Harmonic for steady shaking"

Acceleration = Annotated[
    float,
    Quantity(symbol="a", unit="m/s²", text="amplitude of the acceleration", unlikely_above=_MOST_ACCELERATION),
]
AngularFrequency = Annotated[
    float,
    Quantity(
        symbol="Ω", unit="rad/s", text="angular frequency", gt=0.0, unlikely_above=2.0 * math.pi * _MOST_FREQUENCY
    ),
]
Frequency = Annotated[float, Quantity(symbol="f", unit="Hz", text="frequency", gt=0.0, unlikely_above=_MOST_FREQUENCY)]
Velocity = Annotated[float, Quantity(symbol="v", unit="m/s", text="amplitude of the velocity")]
Phase = Annotated[float, Quantity(unit="rad", text="phase", slider=(-3.142, 3.142))]
StartPhase = Annotated[float, Quantity(unit="rad", text="phase at the start", slider=(0.0, 6.283))]
Ramp = Annotated[float, Quantity(unit="s", text="time of growth to the full amplitude", ge=0.0)]
Direction = Annotated[
    float, Quantity(unit="rad", text="direction in the plane, from x towards y", slider=(-3.142, 3.142))
]
Stroke = Annotated[float, Quantity(unit="m", text="stroke from peak to peak", gt=0.0)]
Rise = Annotated[
    float,
    Quantity(
        unit="rad",
        text="rise above the horizontal",
        gt=-QUARTER_TURN,
        lt=QUARTER_TURN,
        note="see Harmonic.vertical",
        slider=(-1.5, 1.5),
    ),
]
RiseOfPath = Annotated[
    float,
    Quantity(unit="rad", text="rise above the horizontal", ge=-QUARTER_TURN, le=QUARTER_TURN, slider=(-1.5, 1.5)),
]
Sense = Annotated[int, Quantity(text="+1 anticlockwise, −1 clockwise", choices=(1, -1))]
Start = Annotated[float, Quantity(unit="s", text="start of the motion", ge=0.0)]
VerticalRatio = Annotated[float, Quantity(text="vertical acceleration over the horizontal one", slider=(-1.0, 1.0))]
Cycles = Annotated[float, Quantity(text="cycles", gt=0.0, le=1000.0, note=_SHORT, slider=(1.0, 6.0))]
WholeCycles = Annotated[int, Quantity(text="cycles", ge=1.0, slider=(1.0, 6.0))]
Oscillations = Annotated[
    float, Quantity(text="oscillations under the bell", gt=0.0, le=100.0, note=_SHORT, slider=(1.0, 6.0))
]
Bell = Annotated[float, Quantity(text="oscillations under the bell", gt=1.0, le=100.0, note=_SHORT, slider=(1.0, 6.0))]
Amplitudes = Annotated[Sequence[float], Quantity(unit="m", text="amplitudes along the axes", components=3)]
Displacement = Annotated[float, Quantity(unit="m", text="amplitude of the displacement")]
Frequencies = Annotated[
    tuple[float, float],
    Quantity(
        symbol="f",
        unit="Hz",
        text="first and last frequency",
        gt=0.0,
        unlikely_above=_MOST_FREQUENCY,
        components=2,
    ),
]
Length = Annotated[float, Quantity(unit="s", text="length", gt=0.0)]
Factor = Annotated[float, Quantity(text="factor of the horizontal components")]
VerticalFactor = Annotated[float, Quantity(text="factor of the vertical component")]
Angle = Annotated[float, Quantity(unit="rad", text="turned by", slider=(-3.142, 3.142))]
Chosen = Annotated[int, Quantity(text="number of the motion, from 0 on")]
Delay = Annotated[float, Quantity(unit="s", text="delay")]
OffsetAcceleration = Annotated[float, Quantity(unit="m/s²", text="constant acceleration of the base")]
Phases = Annotated[Sequence[float], Quantity(unit="rad", text="phases of the components", components=3)]
PeakHorizontal = Annotated[
    float, Quantity(symbol="sup |a_h|", unit="m/s²", text="largest horizontal acceleration, or a bound", in_repr=False)
]
Duration = Annotated[float, Quantity(unit="s", text="time after which the base stands still", in_repr=False)]
Period = Annotated[float, Quantity(symbol="T", unit="s", text="period of the steady motion", in_repr=False)]
HighestFrequency = Annotated[
    float, Quantity(unit="rad/s", text="highest angular frequency in the acceleration", in_repr=False)
]


def question_path(name: str, length: float, share: float, angular_frequency: float) -> None:
    """Issue an UnlikelyInputWarning for a path of which no machine has the acceleration.

    Parameters
    ----------
    name, length
        Argument with the length of the path [m].
    share
        Amplitude of the displacement over this length.
    angular_frequency
        Ω [rad/s].
    """
    acceleration = share * length * angular_frequency**2
    if acceleration > _MOST_ACCELERATION:
        remedy = meant(length, "m", lambda other: acceleration * other / length <= _MOST_ACCELERATION)
        remedy = remedy or f"Check its unit, such as {listed('m')}, and that of the frequency."
        question_input(
            f"{name}: {length:.6g} m is unlikely, with an acceleration of {acceleration / 9.80665:.0f} g. {remedy}"
        )
