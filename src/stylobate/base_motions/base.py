"""Interface of a base motion, and the declared numbers of base motions: symbols, units and ranges."""

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from inspect import isfunction
from typing import Annotated, Any, ClassVar

import numpy as np
import numpy.typing as npt

from stylobate.compiler.marks import advice
from stylobate.errors import ParameterError, as_numbers
from stylobate.quantities import QUARTER_TURN, Declared, Quantity, question_input
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


@advice
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


DISPLACEMENT, VELOCITY, ACCELERATION = range(3)
"""Orders of the time derivative of the displacement."""

Components = tuple[npt.NDArray[np.float64], npt.NDArray[np.float64], npt.NDArray[np.float64]]


def along_azimuth(azimuth: float, size: float) -> tuple[tuple[float, float], ...]:
    """Return the one horizontal vector of this size that spans a motion along a line."""
    return ((size * math.cos(azimuth), size * math.sin(azimuth)),)


class MotionContract(Declared, ABC):
    """The properties of a base motion from t = 0 on, in SI units, along x, y (horizontal) and z (up)."""

    __slots__ = ()

    ends: ClassVar[bool] = False
    """Whether all motions of the class end, so that a run under them needs no duration."""

    responds: ClassVar[bool] = False
    """Whether response curves can be computed for motions of the class: harmonic motions that can be horizontal."""

    def __init_subclass__(cls, **options: Any) -> None:
        """Reject fields that would replace a method or have a method as default."""
        super().__init_subclass__(**options)
        for name in vars(cls).get("__annotations__", {}):
            if isfunction(getattr(super(cls, cls), name, None)):
                raise ParameterError(
                    f"{name}: a method of every base motion (got a field of {cls.__name__}). Call the field peak."
                )

    @abstractmethod
    def derivative(self, time: npt.ArrayLike, order: int) -> Components:
        """Return the displacement (`order` 0), velocity (1) or acceleration (2) along x, y and z.

        Parameters
        ----------
        time
            Times of any shape [s].
        order
            DISPLACEMENT (0) [m], VELOCITY (1) [m/s] or ACCELERATION (2) [m/s²].

        Returns
        -------
        tuple
            Three arrays of the shape of `time`.
        """

    @abstractmethod
    def peak_horizontal(self, since: float = 0.0) -> PeakHorizontal:
        """Return sup |a_h| from the time `since` [s] on, or a bound above it [m/s²]."""

    @abstractmethod
    def vertical_range(self, since: float = 0.0) -> tuple[float, float]:
        """Return inf a_z and sup a_z from the time `since` [s] on, or bounds outside them [m/s²]."""

    @abstractmethod
    def directions(self) -> tuple[tuple[float, float], ...]:
        """Return horizontal vectors that span all horizontal accelerations of this motion [m/s²].

        Parallel vectors (or none) mean a motion along one straight line, which allows planar rocking.
        """

    @property
    def duration(self) -> Duration:
        """Time after which the base stands still [s]; infinite for a motion that never ends."""
        return math.inf

    @property
    def period(self) -> Period | None:
        """Common period of the steady motion [s]; None without period."""
        return None

    @property
    def highest_frequency(self) -> HighestFrequency:
        """Highest angular frequency in the acceleration [rad/s]; 0 if the acceleration is constant between its breaks.

        Uplift is searched on 64 samples per period of this frequency, and no step exceeds half of this period. A custom
        motion with varying acceleration must define it; runs reject a motion that varies faster.
        """
        return 0.0

    @property
    def mean_frequency(self) -> float:
        """Mean angular frequency of the peaks of the acceleration [rad/s]; by default the highest frequency.

        It estimates the duration of the push after uplift, and with it the energy below which a column counts as at
        rest.
        """
        return self.highest_frequency

    @property
    def breaks(self) -> tuple[float, ...]:
        """Times at which the acceleration is not smooth [s], increasing; integrators stop there."""
        return ()

    @property
    def degree(self) -> int | None:
        """Degree of the acceleration as a polynomial between its breaks; None if it is no polynomial.

        A motion that is linear between breaks, such as a record, is tabulated exactly.
        """
        return None

    def acceleration(self, time: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Return the base acceleration at `time` [s], shape (..., 3) [m/s²]."""
        return np.stack(self.derivative(as_numbers("time", time, "s"), ACCELERATION), axis=-1)

    def velocity(self, time: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Return the base velocity at `time` [s], shape (..., 3) [m/s]."""
        return np.stack(self.derivative(as_numbers("time", time, "s"), VELOCITY), axis=-1)

    def displacement(self, time: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Return the base displacement at `time` [s], shape (..., 3) [m]."""
        return np.stack(self.derivative(as_numbers("time", time, "s"), DISPLACEMENT), axis=-1)
