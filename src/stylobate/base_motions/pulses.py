"""Pulses of the literature as base motions: sinusoidal, Ricker, Gabor, Mavroeidis–Papageorgiou."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, ClassVar, Self

import numpy as np
import numpy.typing as npt

from stylobate.base_motions.base import (
    ACCELERATION,
    DISPLACEMENT,
    VELOCITY,
    Acceleration,
    AngularFrequency,
    Bell,
    Components,
    Cycles,
    Direction,
    Frequency,
    Oscillations,
    Phase,
    Start,
    Velocity,
    VerticalRatio,
    WholeCycles,
    along_azimuth,
)
from stylobate.base_motions.combined import BaseMotion
from stylobate.base_motions.pulse_waveforms import (
    AntisymmetricRicker,
    Gabor,
    MavroeidisPapageorgiou,
    Ricker,
    Sinusoid,
    Waveform,
    closing_phase,
)
from stylobate.errors import ParameterError
from stylobate.quantities import checked_arguments, parameters_of

__all__ = ["AntisymmetricRicker", "Gabor", "MavroeidisPapageorgiou", "Pulse", "Ricker", "Sinusoid", "Waveform"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Pulse(BaseMotion):
    """A pulse along a line: a `waveform` that begins at the time `start`.

    The named constructors create the pulses of the literature. All take `direction`, `start` and `vertical`.

    Parameters
    ----------
    waveform
        Acceleration along the line.
    direction
        Azimuth of the line [rad] from x.
    start
        Time at which the pulse begins [s]. The middle of a wavelet follows half its duration later.
    vertical
        Vertical acceleration over the horizontal one.

    Notes
    -----
    The base is at rest until the pulse begins: velocity and displacement are the integrals of the acceleration. A pulse
    with residual velocity, such as half a sine, is followed by uniform motion, which does not affect the column.

    Ricker and Gabor wavelets never end. They are cut 8 standard deviations of their envelope from the middle, where
    the envelope is 1.3e-14 of its height. The acceleration there is below 1e-11 of its peak, and the remaining
    velocity is below 1e-12 of the peak velocity.

    Raises
    ------
    ParameterError
        If a number is not finite, or `start` negative.

    Examples
    --------
    >>> pulse = Pulse.half_sine(acceleration=2.0, angular_frequency=math.pi, direction=math.pi / 2.0)
    >>> pulse.acceleration(0.5).round(12), pulse.duration
    (array([0., 2., 0.]), 1.0)
    >>> print(pulse.velocity(7.0).round(4))  # 2 A/ω is left
    [0.     1.2732 0.    ]
    """

    ends: ClassVar[bool] = True

    waveform: Waveform
    direction: Direction = 0.0
    start: Start = 0.0
    vertical: VerticalRatio = 0.0

    def validate(self) -> None:
        """Raise ParameterError unless `waveform` is a Waveform."""
        if not isinstance(self.waveform, Waveform):
            raise ParameterError(f"waveform must be a Waveform such as Ricker(...), got {self.waveform!r}")

    def derivative(self, time: npt.ArrayLike, order: int) -> Components:
        """Return the displacement (`order` 0), velocity (1) or acceleration (2) along x, y and z."""
        t = np.asarray(time, dtype=float)
        length = self.waveform.duration
        running = np.clip(t - self.start, 0.0, length)
        along = self.waveform.derivative(running, order)
        if order == ACCELERATION:
            along = np.where((t >= self.start) & (t < self.duration), along, 0.0)
        elif order == DISPLACEMENT:
            left = float(self.waveform.derivative(np.array(length), VELOCITY))
            along = along + left * np.maximum(t - self.start - length, 0.0)
        return math.cos(self.direction) * along, math.sin(self.direction) * along, self.vertical * along

    def peak_horizontal(self, since: float = 0.0) -> float:
        """Return sup |a_h| from `since` on [m/s²]: exact, or above it by the margin of the waveform."""
        return max(map(abs, self._range(since)))

    def vertical_range(self, since: float = 0.0) -> tuple[float, float]:
        """Return inf a_z and sup a_z from `since` on [m/s²], 0 included."""
        low, high = (self.vertical * bound for bound in self._range(since))
        return min(low, high), max(low, high)

    def directions(self) -> tuple[tuple[float, float], ...]:
        """Return the peak acceleration along the line [m/s²]."""
        return along_azimuth(self.direction, self.peak_horizontal())

    @property
    def duration(self) -> float:
        """End of the pulse [s]; the base then moves uniformly or rests."""
        return self.start + self.waveform.duration

    @property
    def highest_frequency(self) -> float:
        """Highest angular frequency of the waveform [rad/s]."""
        return self.waveform.highest_frequency

    @property
    def breaks(self) -> tuple[float, ...]:
        """Start, unless zero, and end [s]."""
        return (self.start, self.duration) if self.start > 0.0 else (self.duration,)

    def _range(self, since: float) -> tuple[float, float]:
        """Return inf and sup of the acceleration along the line from `since` on, and 0 [m/s²]."""
        if since >= self.duration:
            return 0.0, 0.0
        length = self.waveform.duration
        begun = min(max(since - self.start, 0.0), length)
        ends = self.waveform.derivative(np.array([begun, length]), ACCELERATION).tolist()
        values = (*ends, *(value for time, value in _turning_points(self.waveform) if time >= begun))
        margin = self.waveform.margin
        return min(0.0, min(values) - margin), max(0.0, max(values) + margin)

    def made_by(self) -> tuple[Callable[..., BaseMotion], Mapping[str, Any]]:
        """Return the constructor of the waveform and the numbers of both; `Pulse` for other waveforms."""
        make = getattr(Pulse, self.waveform.constructor, Pulse)
        line = {name: getattr(self, name) for name in parameters_of(Pulse)}
        wave = {name: getattr(self.waveform, name) for name in parameters_of(type(self.waveform))}
        return make, {**wave, **line}

    @classmethod
    @checked_arguments
    def sinusoidal(
        cls,
        *,
        acceleration: Acceleration,
        angular_frequency: AngularFrequency,
        phase: Phase = 0.0,
        cycles: Cycles = 1.0,
        direction: Direction = 0.0,
        start: Start = 0.0,
        vertical: VerticalRatio = 0.0,
    ) -> Self:
        """Create the acceleration A sin(ωt + φ) over `cycles` periods; A [m/s²], ω [rad/s], φ = `phase` [rad]."""
        waveform = Sinusoid(acceleration=acceleration, angular_frequency=angular_frequency, phase=phase, cycles=cycles)
        return cls(waveform=waveform, direction=direction, start=start, vertical=vertical)

    @classmethod
    @checked_arguments
    def half_sine(
        cls,
        *,
        acceleration: Acceleration,
        angular_frequency: AngularFrequency,
        direction: Direction = 0.0,
        start: Start = 0.0,
        vertical: VerticalRatio = 0.0,
    ) -> Self:
        """Create half a sine of acceleration, A sin ωt over π/ω (Housner 1963); it leaves the velocity 2A/ω."""
        return cls.sinusoidal(
            acceleration=acceleration,
            angular_frequency=angular_frequency,
            cycles=0.5,
            direction=direction,
            start=start,
            vertical=vertical,
        )

    @classmethod
    @checked_arguments
    def half_cosine(
        cls,
        *,
        acceleration: Acceleration,
        angular_frequency: AngularFrequency,
        direction: Direction = 0.0,
        start: Start = 0.0,
        vertical: VerticalRatio = 0.0,
    ) -> Self:
        """Create half a cosine of acceleration, A cos ωt over π/ω: half a sine of velocity; the base moves by 2A/ω²."""
        return cls.sinusoidal(
            acceleration=acceleration,
            angular_frequency=angular_frequency,
            phase=0.5 * math.pi,
            cycles=0.5,
            direction=direction,
            start=start,
            vertical=vertical,
        )

    @classmethod
    @checked_arguments
    def one_sine(
        cls,
        *,
        acceleration: Acceleration,
        angular_frequency: AngularFrequency,
        direction: Direction = 0.0,
        start: Start = 0.0,
        vertical: VerticalRatio = 0.0,
    ) -> Self:
        """Create one sine of acceleration, A sin ωt over 2π/ω (Zhang and Makris 2001); the base moves by 2πA/ω²."""
        return cls.sinusoidal(
            acceleration=acceleration,
            angular_frequency=angular_frequency,
            direction=direction,
            start=start,
            vertical=vertical,
        )

    @classmethod
    @checked_arguments
    def one_cosine(
        cls,
        *,
        acceleration: Acceleration,
        angular_frequency: AngularFrequency,
        direction: Direction = 0.0,
        start: Start = 0.0,
        vertical: VerticalRatio = 0.0,
    ) -> Self:
        """Create one cosine of acceleration, A cos ωt over 2π/ω (Zhang and Makris 2001): forward and back."""
        return cls.sinusoidal(
            acceleration=acceleration,
            angular_frequency=angular_frequency,
            phase=0.5 * math.pi,
            direction=direction,
            start=start,
            vertical=vertical,
        )

    @classmethod
    @checked_arguments
    def type_a(
        cls,
        *,
        velocity: Velocity,
        angular_frequency: AngularFrequency,
        direction: Direction = 0.0,
        start: Start = 0.0,
        vertical: VerticalRatio = 0.0,
    ) -> Self:
        """Create the forward pulse of velocity ½V(1 − cos ωt), one sine of acceleration ½ωV (Makris 1997)."""
        return cls.one_sine(
            acceleration=0.5 * angular_frequency * velocity,
            angular_frequency=angular_frequency,
            direction=direction,
            start=start,
            vertical=vertical,
        )

    @classmethod
    @checked_arguments
    def type_b(
        cls,
        *,
        velocity: Velocity,
        angular_frequency: AngularFrequency,
        direction: Direction = 0.0,
        start: Start = 0.0,
        vertical: VerticalRatio = 0.0,
    ) -> Self:
        """Create the forward-and-back pulse of velocity V sin ωt, one cosine of acceleration ωV (Makris 1997)."""
        return cls.one_cosine(
            acceleration=angular_frequency * velocity,
            angular_frequency=angular_frequency,
            direction=direction,
            start=start,
            vertical=vertical,
        )

    @classmethod
    @checked_arguments
    def type_c(
        cls,
        *,
        velocity: Velocity,
        angular_frequency: AngularFrequency,
        cycles: WholeCycles = 1,
        direction: Direction = 0.0,
        start: Start = 0.0,
        vertical: VerticalRatio = 0.0,
    ) -> Self:
        """Create the pulse Cₙ of velocity V[sin(ωt + φ) − sin φ], n = `cycles` ≥ 1, over (n + ½ − φ/π) periods.

        φ is such that the base ends where it began, without velocity (Makris 1997; Zhang and Makris 2001): 0.0697 π
        for n = 1, 0.0410 π for n = 2.
        """
        phase = closing_phase(cycles)
        return cls.sinusoidal(
            acceleration=angular_frequency * velocity,
            angular_frequency=angular_frequency,
            phase=phase + 0.5 * math.pi,
            cycles=cycles + 0.5 - phase / math.pi,
            direction=direction,
            start=start,
            vertical=vertical,
        )

    @classmethod
    @checked_arguments
    def ricker(
        cls,
        *,
        acceleration: Acceleration,
        angular_frequency: AngularFrequency,
        direction: Direction = 0.0,
        start: Start = 0.0,
        vertical: VerticalRatio = 0.0,
    ) -> Self:
        """Create a symmetric Ricker wavelet with this peak [m/s²]; see `stylobate.base_motions.pulses.Ricker`."""
        waveform = Ricker(acceleration=acceleration, angular_frequency=angular_frequency)
        return cls(waveform=waveform, direction=direction, start=start, vertical=vertical)

    @classmethod
    @checked_arguments
    def antisymmetric_ricker(
        cls,
        *,
        acceleration: Acceleration,
        angular_frequency: AngularFrequency,
        direction: Direction = 0.0,
        start: Start = 0.0,
        vertical: VerticalRatio = 0.0,
    ) -> Self:
        """Create an antisymmetric Ricker wavelet; see `stylobate.base_motions.pulses.AntisymmetricRicker`."""
        waveform = AntisymmetricRicker(acceleration=acceleration, angular_frequency=angular_frequency)
        return cls(waveform=waveform, direction=direction, start=start, vertical=vertical)

    @classmethod
    @checked_arguments
    def gabor(
        cls,
        *,
        velocity: Velocity,
        frequency: Frequency,
        phase: Phase = 0.0,
        oscillations: Oscillations,
        direction: Direction = 0.0,
        start: Start = 0.0,
        vertical: VerticalRatio = 0.0,
    ) -> Self:
        """Create a Gabor wavelet of `velocity` [m/s] and `frequency` [Hz]; see `base_motions.pulses.Gabor`."""
        waveform = Gabor(velocity=velocity, frequency=frequency, phase=phase, oscillations=oscillations)
        return cls(waveform=waveform, direction=direction, start=start, vertical=vertical)

    @classmethod
    @checked_arguments
    def mavroeidis_papageorgiou(
        cls,
        *,
        velocity: Velocity,
        frequency: Frequency,
        phase: Phase = 0.0,
        oscillations: Bell,
        direction: Direction = 0.0,
        start: Start = 0.0,
        vertical: VerticalRatio = 0.0,
    ) -> Self:
        """Create a near-fault pulse by its `velocity` A [m/s], `frequency` f [Hz], `phase` ν and `oscillations` γ > 1.

        See `stylobate.base_motions.pulses.MavroeidisPapageorgiou`.
        """
        waveform = MavroeidisPapageorgiou(
            velocity=velocity, frequency=frequency, phase=phase, oscillations=oscillations
        )
        return cls(waveform=waveform, direction=direction, start=start, vertical=vertical)


@lru_cache(maxsize=64)
def _turning_points(waveform: Waveform) -> tuple[tuple[float, float], ...]:
    return waveform.turning_points()
