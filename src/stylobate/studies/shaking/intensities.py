"""How strong a record is: the measures of its horizontal components over which incremental analyses are told."""

import math
from dataclasses import dataclass
from enum import Enum

import numpy as np

from stylobate.column import Column
from stylobate.errors import ParameterError, UnsupportedError, require_not_negative, require_positive
from stylobate.motions import BaseMotion, Record
from stylobate.motions.base import VELOCITY
from stylobate.motions.records import response_spectra

# A velocity is looked at so many times between breaks, and in a period of the highest frequency.
_BETWEEN_BREAKS, _PER_PERIOD = 8, 100


class Intensity(Enum):
    """A measure that grows in proportion to the record; horizontal vectors are taken whole, whatever the axes."""

    PEAK_ACCELERATION = "peak ground acceleration"
    """PGA = sup |a_h| [m/s²]."""
    PEAK_VELOCITY = "peak ground velocity"
    """PGV = sup |v_h| [m/s]."""
    ACCELERATION_RATIO = "PGA/(g tan α)"
    """Above 1 the record alone can set the column rocking."""
    VELOCITY_RATIO = "p PGV/(g tan α)"
    """With p = √(m g R/K)."""

    @property
    def units(self) -> str:
        """The unit."""
        return {"peak ground acceleration": "m s-2", "peak ground velocity": "m s-1"}.get(self.value, "1")

    def of(self, motion: BaseMotion, column: Column) -> float:
        """Return the measure of `motion` for `column`."""
        strength = column.gravity * column.slenderness
        match self:
            case Intensity.PEAK_ACCELERATION:
                return motion.largest_horizontal(0.0)
            case Intensity.PEAK_VELOCITY:
                return peak_horizontal_velocity(motion)
            case Intensity.ACCELERATION_RATIO:
                return motion.largest_horizontal(0.0) / strength
            case Intensity.VELOCITY_RATIO:
                return column.frequency_parameter * peak_horizontal_velocity(motion) / strength


@dataclass(frozen=True, slots=True)
class SpectralAcceleration:
    """Pseudo-acceleration of an elastic oscillator: RotD50 of a record along x and y, else that of its one component.

    Parameters
    ----------
    period
        Natural period [s].
    damping
        Damping ratio.
    """

    period: float
    damping: float = 0.05

    def __post_init__(self) -> None:
        object.__setattr__(self, "period", require_positive("period", self.period, "s"))
        object.__setattr__(self, "damping", require_not_negative("damping", self.damping))

    @property
    def value(self) -> str:
        """What it is called."""
        return f"spectral acceleration at {self.period:g} s, {100.0 * self.damping:g} % damping"

    @property
    def units(self) -> str:
        """The unit."""
        return "m s-2"

    def of(self, motion: BaseMotion, column: Column) -> float:
        """Return the measure of a record.

        Raises
        ------
        UnsupportedError
            If `motion` is no Record: a spectrum needs samples.
        """
        del column
        if not isinstance(motion, Record):
            message = f"a spectral acceleration needs a Record, got {motion!r}; choose another intensity"
            raise UnsupportedError(message)
        spectra = response_spectra(motion, [self.period], damping=self.damping)
        if "rotd50" in spectra:
            return float(spectra["rotd50"][0])
        horizontal = [axis for axis in motion.axes if axis != "z"]
        return float(spectra["psa"].sel(axis=horizontal[0])[0]) if horizontal else 0.0


def as_intensity(intensity: str | Intensity | SpectralAcceleration) -> Intensity | SpectralAcceleration:
    """Return the measure, or that of this name.

    Raises
    ------
    ParameterError
        If there is none of this name.
    """
    if isinstance(intensity, (Intensity, SpectralAcceleration)):
        return intensity
    for one in Intensity:
        if one.value == intensity:
            return one
    known = ", ".join(repr(one.value) for one in Intensity)
    message = f"intensity must be {known}, or SpectralAcceleration(period); got {intensity!r}"
    raise ParameterError(message)


def peak_horizontal_velocity(motion: BaseMotion) -> float:
    """Return sup |v_h| up to the end of the motion [m/s], from values dense enough to be 0.1 % low at most."""
    end = motion.duration
    number = math.ceil(_PER_PERIOD * end * motion.highest_frequency / (2.0 * math.pi)) + _PER_PERIOD
    if motion.degree is not None:  # smooth between breaks, however close these are
        number = _PER_PERIOD
    knots = np.unique([0.0, *(time for time in motion.breaks if 0.0 < time < end), end])
    parts = np.arange(_BETWEEN_BREAKS) / _BETWEEN_BREAKS
    between = (knots[:-1, np.newaxis] + np.diff(knots)[:, np.newaxis] * parts).ravel()
    times = np.concatenate([between, np.linspace(0.0, end, number)])
    x, y, _ = motion.derivative(times, VELOCITY)
    return float(np.hypot(x, y).max())
