"""Sine sweeps: a straight harmonic motion whose frequency changes with time."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import Annotated, Any, ClassVar, Self

import numpy as np
import numpy.typing as npt

from stylobate.base_motions.base import (
    ACCELERATION,
    DISPLACEMENT,
    VELOCITY,
    Acceleration,
    Components,
    Direction,
    Displacement,
    Frequencies,
    Length,
    Start,
    StartPhase,
    VerticalRatio,
    along_azimuth,
)
from stylobate.base_motions.combined import BaseMotion
from stylobate.base_motions.pulse_waveforms import double_integral, integral
from stylobate.errors import ParameterError
from stylobate.quantities import Quantity, checked_arguments, parameters_of

Floats = npt.NDArray[np.float64]

MOST_CYCLES = 1e5
"""Maximum number of cycles of a sweep, whose integrals are stored per cycle."""


class SweepLaw(StrEnum):
    """Law of the frequency of a sweep from its first to its last value."""

    LINEAR = "linear"
    """Constant rate in hertz per second."""
    LOGARITHMIC = "logarithmic"
    """Constant rate in octaves per second."""


class SweepQuantity(StrEnum):
    """Quantity with a constant amplitude during a sweep."""

    ACCELERATION = "acceleration"
    DISPLACEMENT = "displacement"


@dataclass(frozen=True, slots=True, kw_only=True)
class SineSweep(BaseMotion):
    """A sine sweep along a line: constant amplitude of acceleration or displacement, and varying frequency.

    `linear` and `logarithmic` create a sweep from `acceleration` or `displacement`.

    Parameters
    ----------
    amplitude
        Amplitude of the constant quantity [m/s²] or [m].
    quantity
        ACCELERATION: the acceleration is A cos Φ(t). DISPLACEMENT: the displacement is D cos Φ(t), and the acceleration
        −D(Φ̇² cos Φ + Φ̈ sin Φ).
    law
        Linear or exponential change of Φ̇/2π from the first to the last frequency.
    frequencies
        First and last frequency [Hz], increasing or decreasing.
    length
        Duration of the sweep [s].
    direction
        Azimuth of the line [rad] from x.
    start_phase
        Φ at the start [rad]; with 0 the acceleration (displacement) starts at its peak.
    start
        Time at which the sweep begins [s].
    vertical
        Vertical acceleration over the horizontal one.

    Notes
    -----
    Φ has a closed form: 2π(f₁t + ½(f₂ − f₁)t²/T), or 2πf₁T (rᵗ⁄ᵀ − 1)/ln r with r = f₂/f₁. A sweep by displacement has
    closed forms. For a sweep by acceleration, velocity and displacement (Fresnel and exponential integrals) come from
    Gauss quadrature, to 1e-12 of A/(2πf) and A T/(2πf) with the lower frequency f. Their initial values are those of
    the steady motion at the first frequency. Before the start and after the end the base moves uniformly.

    Raises
    ------
    ParameterError
        If a number is not finite, `length` or a frequency not positive, `start` negative, or both or neither of
        `acceleration` and `displacement` are given.

    Examples
    --------
    >>> sweep = SineSweep.logarithmic(acceleration=0.5, frequencies=(0.5, 8.0), length=120.0)  # 2 octaves per minute
    >>> print(sweep.frequency([0.0, 30.0, 60.0]).round(6))
    [0.5 1.  2. ]
    """

    ends: ClassVar[bool] = True

    amplitude: Annotated[float, Quantity(text="amplitude of the constant quantity")]
    quantity: Annotated[SweepQuantity, Quantity(text="quantity of constant amplitude")] = SweepQuantity.ACCELERATION
    law: Annotated[SweepLaw, Quantity(text="law of the frequency")] = SweepLaw.LINEAR
    frequencies: Frequencies
    length: Length
    direction: Direction = 0.0
    start_phase: StartPhase = 0.0
    start: Start = 0.0
    vertical: VerticalRatio = 0.0

    def validate(self) -> None:
        """Raise ParameterError for a sweep with too many cycles to store."""
        cycles = max(self.frequencies) * self.length
        if cycles > MOST_CYCLES:
            raise ParameterError(
                f"length: a sweep has at most {MOST_CYCLES:g} cycles, since all are stored (got {cycles:.4g}). "
                "Shorten it, or lower its frequencies."
            )

    @classmethod
    @checked_arguments
    def linear(
        cls,
        *,
        acceleration: Acceleration | None = None,
        displacement: Displacement | None = None,
        frequencies: Frequencies,
        length: Length,
        direction: Direction = 0.0,
        start_phase: StartPhase = 0.0,
        start: Start = 0.0,
        vertical: VerticalRatio = 0.0,
    ) -> Self:
        """Create a linear sweep (constant hertz per second) by `acceleration` [m/s²] or `displacement` [m]."""
        return cls(
            amplitude=_given(acceleration, displacement),
            quantity=SweepQuantity.ACCELERATION if displacement is None else SweepQuantity.DISPLACEMENT,
            law=SweepLaw.LINEAR,
            frequencies=frequencies,
            length=length,
            direction=direction,
            start_phase=start_phase,
            start=start,
            vertical=vertical,
        )

    @classmethod
    @checked_arguments
    def logarithmic(
        cls,
        *,
        acceleration: Acceleration | None = None,
        displacement: Displacement | None = None,
        frequencies: Frequencies,
        length: Length,
        direction: Direction = 0.0,
        start_phase: StartPhase = 0.0,
        start: Start = 0.0,
        vertical: VerticalRatio = 0.0,
    ) -> Self:
        """Create a logarithmic sweep (constant octaves per second) by `acceleration` [m/s²] or `displacement` [m]."""
        return cls(
            amplitude=_given(acceleration, displacement),
            quantity=SweepQuantity.ACCELERATION if displacement is None else SweepQuantity.DISPLACEMENT,
            law=SweepLaw.LOGARITHMIC,
            frequencies=frequencies,
            length=length,
            direction=direction,
            start_phase=start_phase,
            start=start,
            vertical=vertical,
        )

    def made_by(self) -> tuple[Callable[..., BaseMotion], Mapping[str, Any]]:
        """Return the constructor of the law, and the amplitude by the name of its constant quantity."""
        shared = [name for name in parameters_of(SineSweep.linear) if name in parameters_of(SineSweep)]
        numbers = {name: getattr(self, name) for name in shared}
        make = SineSweep.linear if self.law is SweepLaw.LINEAR else SineSweep.logarithmic
        return make, {self.quantity.value: self.amplitude, **numbers}

    def frequency(self, time: npt.ArrayLike) -> Floats:
        """Compute the frequency at `time` [Hz]; before and after the sweep it is the frequency at the end."""
        since = np.clip(np.asarray(time, dtype=float) - self.start, 0.0, self.length)
        return self._rates(since)[1] / (2.0 * math.pi)

    def derivative(self, time: npt.ArrayLike, order: int) -> Components:
        """Return the displacement (`order` 0), velocity (1) or acceleration (2) along x, y and z."""
        t = np.asarray(time, dtype=float)
        since = t - self.start
        along = self._along(np.clip(since, 0.0, self.length), order)
        if order == ACCELERATION:
            along = np.where((t >= self.start) & (t < self.duration), along, 0.0)
        elif order == DISPLACEMENT:
            first, last = self._along(np.array([0.0, self.length]), VELOCITY)
            along = along + first * np.minimum(since, 0.0) + last * np.maximum(since - self.length, 0.0)
        return math.cos(self.direction) * along, math.sin(self.direction) * along, self.vertical * along

    def peak_horizontal(self, since: float = 0.0) -> float:
        """Return a bound of |a_h| from `since` on [m/s²]: A, or the maximum of D√(Φ̇⁴ + Φ̈²); 0 after the end."""
        if since >= self.duration:
            return 0.0
        if self.quantity is SweepQuantity.ACCELERATION:
            return abs(self.amplitude)
        # Φ̇ and |Φ̈| increase or decrease together, or one is constant.
        times = np.array([min(max(since - self.start, 0.0), self.length), self.length])
        _, rate, change = self._rates(times)
        return float(abs(self.amplitude) * np.hypot(rate**2, change).max())

    def vertical_range(self, since: float = 0.0) -> tuple[float, float]:
        """Return bounds of a_z from `since` on [m/s²]: ± `vertical` times the bound of |a_h|."""
        largest = abs(self.vertical) * self.peak_horizontal(since)
        return -largest, largest

    def directions(self) -> tuple[tuple[float, float], ...]:
        """Return the peak acceleration along the line [m/s²]."""
        return along_azimuth(self.direction, self.peak_horizontal())

    @property
    def duration(self) -> float:
        """End of the sweep [s]."""
        return self.start + self.length

    @property
    def highest_frequency(self) -> float:
        """The higher of the two frequencies [rad/s]."""
        return 2.0 * math.pi * max(self.frequencies)

    @property
    def breaks(self) -> tuple[float, ...]:
        """Start, unless zero, and end [s]."""
        return (self.start, self.duration) if self.start > 0.0 else (self.duration,)

    def _along(self, since: Floats, order: int) -> Floats:
        """Return the derivative along the line between start and end."""
        a = self.amplitude
        if self.quantity is SweepQuantity.DISPLACEMENT:
            phase, rate, change = self._rates(since)
            if order == DISPLACEMENT:
                return np.asarray(a * np.cos(phase))
            if order == VELOCITY:
                return np.asarray(-a * rate * np.sin(phase))
            return np.asarray(-a * (rate**2 * np.cos(phase) + change * np.sin(phase)))
        if order == ACCELERATION:
            return self._acceleration(since)
        cycles = max(self.frequencies) * self.length
        velocity, displacement = self.course_at_start()
        if order == VELOCITY:
            return velocity + integral(self._acceleration, since, self.length, cycles)
        return displacement + velocity * since + double_integral(self._acceleration, since, self.length, cycles)

    def course_at_start(self) -> tuple[float, float]:
        """Return velocity [m/s] and displacement [m] along the line at the start of the sweep."""
        a, rate, phase = self.amplitude, 2.0 * math.pi * self.frequencies[0], self.start_phase
        if self.quantity is SweepQuantity.DISPLACEMENT:
            return -a * rate * math.sin(phase), a * math.cos(phase)
        return a / rate * math.sin(phase), -a / rate**2 * math.cos(phase)

    def _acceleration(self, since: Floats) -> Floats:
        return np.asarray(self.amplitude * np.cos(self._rates(since)[0]))

    def _rates(self, since: Floats) -> tuple[Floats, Floats, Floats]:
        """Return Φ, Φ̇ and Φ̈."""
        first, last = (2.0 * math.pi * frequency for frequency in self.frequencies)
        if self.law is SweepLaw.LINEAR:
            slope = (last - first) / self.length
            return (
                self.start_phase + since * (first + 0.5 * slope * since),
                first + slope * since,
                slope + 0.0 * since,
            )
        growth = math.log(last / first) / self.length
        turned = first * since if growth == 0.0 else first * np.expm1(growth * since) / growth
        rate = first * np.exp(growth * since)
        return self.start_phase + turned, rate, growth * rate


def _given(acceleration: float | None, displacement: float | None) -> float:
    """Return the one that is given, or raise ParameterError."""
    if acceleration is not None and displacement is None:
        return acceleration
    if displacement is not None and acceleration is None:
        return displacement
    raise ParameterError(
        f"acceleration or displacement must be given, one of them, got {acceleration!r} and {displacement!r}"
    )
