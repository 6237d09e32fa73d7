"""Intensity measures of records, with the definition of the horizontal component."""

import math
import re
from dataclasses import dataclass
from enum import Enum
from typing import Self

import numpy as np

from stylobate.base_motions import BaseMotion, Record
from stylobate.base_motions.base import ACCELERATION, VELOCITY
from stylobate.column import Column
from stylobate.engine.forcing import common_line
from stylobate.errors import ParameterError, UnsupportedError, require_not_negative, require_positive
from stylobate.records import response_spectra
from stylobate.records.intensities import HorizontalComponent
from stylobate.records.intensities import horizontal_peak as peak_of_record
from stylobate.studies.sweeps.designs import Floats

# Number of samples of a velocity between breaks, and in a period of the highest frequency.
_BETWEEN_BREAKS, _PER_PERIOD = 8, 100


class Intensity(Enum):
    """A measure of strength that grows in proportion to the record."""

    PEAK_ACCELERATION = "peak ground acceleration"
    """PGA [m/s²]."""
    PEAK_VELOCITY = "peak ground velocity"
    """PGV [m/s]."""
    ACCELERATION_RATIO = "PGA/(g tan α)"
    """Above 1 a record can start rocking, if PGA is defined by RotD100."""
    VELOCITY_RATIO = "p PGV/(g tan α)"
    """With p = √(m g R/K)."""

    @property
    def units(self) -> str:
        """The unit."""
        return {"peak ground acceleration": "m s-2", "peak ground velocity": "m s-1"}.get(self.value, "1")

    def of(self, motion: BaseMotion, column: Column, component: HorizontalComponent) -> float:
        """Compute the measure of `motion` for `column` from its horizontal `component`."""
        strength = column.gravity * column.slenderness
        match self:
            case Intensity.PEAK_ACCELERATION:
                return horizontal_peak(motion, ACCELERATION, component)
            case Intensity.PEAK_VELOCITY:
                return horizontal_peak(motion, VELOCITY, component)
            case Intensity.ACCELERATION_RATIO:
                return horizontal_peak(motion, ACCELERATION, component) / strength
            case Intensity.VELOCITY_RATIO:
                return column.frequency_parameter * horizontal_peak(motion, VELOCITY, component) / strength


@dataclass(frozen=True, slots=True)
class SpectralAcceleration:
    """Pseudo-acceleration of an elastic oscillator.

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
        """Full name."""
        return f"spectral acceleration at {self.period:g} s, {100.0 * self.damping:g} % damping"

    @property
    def units(self) -> str:
        """The unit."""
        return "m s-2"

    def of(self, motion: BaseMotion, column: Column, component: HorizontalComponent) -> float:
        """Compute the measure of a record from its horizontal `component`.

        Raises
        ------
        UnsupportedError
            If `motion` is no Record: a spectrum needs samples.
        """
        del column
        if not isinstance(motion, Record):
            raise UnsupportedError(f"a spectral acceleration needs a Record, got {motion!r}; choose another intensity")
        spectra = response_spectra(motion, [self.period], damping=self.damping).isel(period=0)
        along = [float(spectra["psa"].sel(axis=axis)) for axis in motion.axes if axis != "z"]
        if len(along) < 2:  # noqa: PLR2004  one component or none
            return max(along, default=0.0)
        match component if has_two_components(motion) else HorizontalComponent.ROTD100:
            case HorizontalComponent.ROTD50:
                return float(spectra["rotd50"])
            case HorizontalComponent.ROTD100:
                return float(spectra["rotd100"])
            case HorizontalComponent.GEOMETRIC_MEAN:
                return float(spectra["geometric_mean"])
            case HorizontalComponent.LARGER:
                return max(along)


_SHORT = {"pga": Intensity.PEAK_ACCELERATION, "pgv": Intensity.PEAK_VELOCITY}
_SPECTRAL = re.compile(
    r"(?:spectral acceleration|psa|sa)(?: at)?[\s(]*(?P<period>\d*\.?\d+)\s*(?:s|secs?|seconds?)?\s*\)?"
    r"(?:[\s,(]*(?P<damping>\d*\.?\d+)\s*%(?:\s*damp(?:ing|ed))?\s*\)?)?"
)


def quantity_named(name: str, text: object) -> Intensity | SpectralAcceleration:
    """Return the measured quantity of a name, in full or as engineers write it.

    Parameters
    ----------
    name
        Name of the argument, for messages.
    text
        "PGA", "PGV", "SA(0.5)", "Sa(0.5 s, 2 %)" or a full name; a damping that is not stated is 5 %.

    Raises
    ------
    ParameterError
        If no quantity has this name.

    Examples
    --------
    >>> quantity_named("intensity", "PGA").value
    'peak ground acceleration'
    >>> quantity_named("intensity", "Sa(0.5 s)") == SpectralAcceleration(0.5)
    True
    """
    lower = " ".join(str(text).lower().split())
    known = {one.value.lower(): one for one in Intensity} | _SHORT
    if isinstance(text, str) and lower in known:
        return known[lower]
    if isinstance(text, str) and (found := _SPECTRAL.fullmatch(lower)):
        period, damping = float(found["period"]), float(found["damping"] or 5.0)
        return SpectralAcceleration(period, float(f"{0.01 * damping:.12g}"))
    listed = ", ".join(repr(one.value) for one in Intensity)
    raise ParameterError(
        f"{name} must be {listed}, or a spectral acceleration, got {text!r}. Name its period in seconds, such as "
        '"SA(0.5 s)"'
    )


@dataclass(frozen=True, slots=True)
class IntensityMeasure:
    """An intensity measure with the definition of its horizontal component.

    Parameters
    ----------
    quantity
        Measured quantity.
    component
        Definition that combines two horizontal components to one number.
    """

    quantity: Intensity | SpectralAcceleration
    component: HorizontalComponent = HorizontalComponent.ROTD50

    @classmethod
    def named(
        cls,
        intensity: "str | Intensity | SpectralAcceleration",
        component: str | HorizontalComponent = HorizontalComponent.ROTD50,
    ) -> Self:
        """Look up the measure with these names.

        Raises
        ------
        ParameterError
            If a name is unknown.
        """
        definition = HorizontalComponent.named(component)
        if isinstance(intensity, (Intensity, SpectralAcceleration)):
            return cls(intensity, definition)
        return cls(quantity_named("intensity", intensity), definition)

    @property
    def name(self) -> str:
        """Quantity and definition, for labels."""
        return f"{self.quantity.value}, {self.component.value}"

    @property
    def attributes(self) -> dict[str, str]:
        """Unit, name and definition, for attributes of arrays."""
        return {"units": self.quantity.units, "long_name": self.name, "component": self.component.value}

    def of(self, motion: BaseMotion, column: Column) -> float:
        """Compute the measure of `motion` for `column`."""
        return self.quantity.of(motion, column, self.component)


def horizontal_peak(motion: BaseMotion, order: int, component: HorizontalComponent) -> float:
    """Compute the peak horizontal acceleration [m/s²] or velocity [m/s] of a motion that ends.

    A motion along one straight line has one horizontal component; its peak is the same in every definition.

    Parameters
    ----------
    motion
        Base motion; velocities are evaluated up to its end.
    order
        ACCELERATION or VELOCITY.
    component
        The definition.

    Notes
    -----
    Peak accelerations of a record are exact; those of another motion along a line are its own `peak_horizontal`. All
    other peaks are those of dense samples and at most 0.1 % low.
    """
    if isinstance(motion, Record):
        return peak_of_record(motion, order, component, since=0.0)
    if not has_two_components(motion):
        component = HorizontalComponent.ROTD100
        if order == ACCELERATION:
            return motion.peak_horizontal(0.0)
    x, y, _ = motion.derivative(_dense_times(motion), order)
    return component.peak(x, y)


def has_two_components(motion: BaseMotion) -> bool:
    """Return whether a motion accelerates along more than one horizontal line."""
    vectors = motion.directions()
    return any(map(any, vectors)) and common_line(*vectors) is None


def _dense_times(motion: BaseMotion) -> Floats:
    """Return dense times up to the end of a motion [s]."""
    end = motion.duration
    number = math.ceil(_PER_PERIOD * end * motion.highest_frequency / (2.0 * math.pi)) + _PER_PERIOD
    if motion.degree is not None:  # smooth between breaks, however close these are
        number = _PER_PERIOD
    knots = np.unique([0.0, *(time for time in motion.breaks if 0.0 < time < end), end])
    parts = np.arange(_BETWEEN_BREAKS) / _BETWEEN_BREAKS
    between = (knots[:-1, np.newaxis] + np.diff(knots)[:, np.newaxis] * parts).ravel()
    return np.concatenate([between, np.linspace(0.0, end, number)])


def peak_horizontal_velocity(motion: BaseMotion) -> float:
    """Compute the peak of the horizontal velocity vector up to the end of the motion [m/s]."""
    return horizontal_peak(motion, VELOCITY, HorizontalComponent.ROTD100)
