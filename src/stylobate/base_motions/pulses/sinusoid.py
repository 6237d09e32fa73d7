"""Sinusoidal waveform of any number of cycles."""

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from stylobate.base_motions.base import ACCELERATION, VELOCITY
from stylobate.base_motions.numbers import Acceleration, AngularFrequency, Cycles, Phase
from stylobate.base_motions.pulses.waveform import Floats, Waveform


@dataclass(frozen=True, slots=True, kw_only=True)
class Sinusoid(Waveform):
    """The acceleration A sin(ωt + φ) from t = 0 over n periods.

    Parameters
    ----------
    acceleration
        Amplitude A [m/s²].
    angular_frequency
        ω [rad/s].
    phase
        φ [rad]; π/2 for a cosine.
    cycles
        Number n of periods, integer or not; at most 1000.

    Raises
    ------
    ParameterError
        If a number is not finite, the frequency or `cycles` not positive, or `cycles` above 1000.
    """

    constructor: ClassVar[str] = "sinusoidal"

    acceleration: Acceleration
    angular_frequency: AngularFrequency
    phase: Phase
    cycles: Cycles

    @property
    def duration(self) -> float:
        """2πn/ω [s]."""
        return 2.0 * math.pi * self.cycles / self.angular_frequency

    @property
    def highest_frequency(self) -> float:
        """ω [rad/s]."""
        return self.angular_frequency

    def derivative(self, time: Floats, order: int) -> Floats:
        """Return the displacement (`order` 0), velocity (1) or acceleration (2)."""
        a, w, phase = self.acceleration, self.angular_frequency, self.phase
        if order == ACCELERATION:
            return np.asarray(a * np.sin(w * time + phase))
        if order == VELOCITY:
            return np.asarray(a / w * (math.cos(phase) - np.cos(w * time + phase)))
        return np.asarray(a / w**2 * (w * time * math.cos(phase) + math.sin(phase) - np.sin(w * time + phase)))

    def turning_points(self) -> tuple[tuple[float, float], ...]:
        """Return the times at which ωt + φ is an odd multiple of π/2, with the acceleration ±A."""
        first = math.ceil(self.phase / math.pi - 0.5)
        last = math.floor((self.phase + 2.0 * math.pi * self.cycles) / math.pi - 0.5)
        return tuple(
            (((k + 0.5) * math.pi - self.phase) / self.angular_frequency, self.acceleration * (-1.0) ** k)
            for k in range(first, last + 1)
        )
