"""Velocity pulse of Mavroeidis and Papageorgiou: a harmonic with a cosine envelope."""

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from stylobate.base_motions.base import ACCELERATION, VELOCITY
from stylobate.base_motions.numbers import Bell, Frequency, Phase, Velocity
from stylobate.base_motions.pulses.waveform import Floats, Waveform, found_turning_points, unseen


@dataclass(frozen=True, slots=True, kw_only=True)
class MavroeidisPapageorgiou(Waveform):
    """The velocity ½A [1 + cos(2πft/γ)] cos(2πft + ν) at times t within ±γ/(2f) of the middle.

    Parameters
    ----------
    velocity
        A, the height of the envelope [m/s].
    frequency
        f, prevailing frequency [Hz].
    phase
        ν [rad]: 0 for a velocity peak in the middle, ±π/2 for a zero in the middle.
    oscillations
        γ, above 1 and at most 100: about the number of oscillations.

    Raises
    ------
    ParameterError
        If a number is not finite, the frequency not positive, or `oscillations` 1 or less or above 100.

    Notes
    -----
    G. P. Mavroeidis and A. S. Papageorgiou, "A mathematical representation of near-fault ground motions", Bulletin of
    the Seismological Society of America 93 (2003). Velocity, acceleration and displacement follow this paper, with zero
    initial displacement. The acceleration has no jumps; its slope jumps at both ends.
    """

    constructor: ClassVar[str] = "mavroeidis_papageorgiou"

    velocity: Velocity
    frequency: Frequency
    phase: Phase
    oscillations: Bell

    @property
    def duration(self) -> float:
        """γ/f [s]."""
        return self.oscillations / self.frequency

    @property
    def highest_frequency(self) -> float:
        """2πf (1 + 1/γ) [rad/s], the highest of its three harmonics."""
        return self._harmonics()[2][1]

    def derivative(self, time: Floats, order: int) -> Floats:
        """Return the displacement (`order` 0), velocity (1) or acceleration (2)."""
        values = self._differentiated(time, order - VELOCITY)
        return values if order == ACCELERATION else values - self._differentiated(np.array(0.0), order - VELOCITY)

    def turning_points(self) -> tuple[tuple[float, float], ...]:
        """Return time and acceleration at each sign change of the slope of the acceleration."""
        return found_turning_points(
            lambda t: self._differentiated(t, 1),
            lambda t: self._differentiated(t, 2),
            self.duration,
            self.highest_frequency,
        )

    @property
    def margin(self) -> float:
        """Maximum excess from two turning points in one cell [m/s²], below 1e-7 of 2πfA."""
        third = math.fsum(abs(amplitude) * rate**4 for amplitude, rate in self._harmonics())
        return unseen(third, self.duration, self.highest_frequency)

    def _harmonics(self) -> tuple[tuple[float, float], ...]:
        """Return amplitude [m/s] and angular frequency [rad/s] of the three harmonics of the velocity."""
        carrier = 2.0 * math.pi * self.frequency
        bell = carrier / self.oscillations
        whole, half = 0.5 * self.velocity, 0.25 * self.velocity
        return (half, carrier - bell), (whole, carrier), (half, carrier + bell)

    def _differentiated(self, time: Floats, times: int) -> Floats:
        """Differentiate the velocity `times` times; −1 integrates."""
        since_middle = time - 0.5 * self.duration
        total = np.zeros_like(since_middle)
        for amplitude, rate in self._harmonics():
            total = total + amplitude * rate**times * np.cos(rate * since_middle + self.phase + 0.5 * math.pi * times)
        return total
