"""Gabor wavelet: harmonic velocity with a Gaussian envelope."""

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from stylobate.base_motions.base import ACCELERATION, VELOCITY
from stylobate.base_motions.numbers import Frequency, Oscillations, Phase, Velocity
from stylobate.base_motions.pulses.quadrature import integral
from stylobate.base_motions.pulses.ricker import BAND, CUT
from stylobate.base_motions.pulses.waveform import Floats, Waveform, found_turning_points, unseen


@dataclass(frozen=True, slots=True, kw_only=True)
class Gabor(Waveform):
    """The velocity A exp(−u²/2) cos(γu + ν) with u = 2πft/γ and t from the middle.

    Parameters
    ----------
    velocity
        A, the height of the envelope [m/s].
    frequency
        f [Hz].
    phase
        ν [rad]: 0 for a velocity peak in the middle, ±π/2 for a zero in the middle.
    oscillations
        γ, at most 100: the standard deviation of the envelope is γ/(2πf).

    Raises
    ------
    ParameterError
        If a number is not finite, the frequency or `oscillations` not positive, or `oscillations` above 100.

    Notes
    -----
    D. Gabor, "Theory of communication", Journal of the IEE 93 (1946); as ground velocity: G. P. Mavroeidis and A. S.
    Papageorgiou (2003), see `MavroeidisPapageorgiou`. The displacement is integrated from the velocity by Gauss
    quadrature, to 1e-13 of A/f. The residual displacement of the base is √(2π) γ/(2πf) exp(−γ²/2) cos ν A.
    """

    constructor: ClassVar[str] = "gabor"

    velocity: Velocity
    frequency: Frequency
    phase: Phase
    oscillations: Oscillations

    @property
    def deviation(self) -> float:
        """Standard deviation of the envelope, γ/(2πf) [s]."""
        return self.oscillations / (2.0 * math.pi * self.frequency)

    @property
    def duration(self) -> float:
        """16 standard deviations of the envelope [s]."""
        return 2.0 * CUT * self.deviation

    @property
    def highest_frequency(self) -> float:
        """2πf plus the width of the spectrum, five times its standard deviation [rad/s]."""
        return (self.oscillations + BAND) / self.deviation

    def derivative(self, time: Floats, order: int) -> Floats:
        """Return the displacement (`order` 0), velocity (1) or acceleration (2)."""
        if order == ACCELERATION:
            return self._velocity(time, 1)
        if order == VELOCITY:
            return self._velocity(time, 0) - self._velocity(np.array(0.0), 0)
        cycles = self.highest_frequency * self.duration / (2.0 * math.pi)
        return integral(lambda t: self.derivative(t, VELOCITY), time, self.duration, cycles)

    def turning_points(self) -> tuple[tuple[float, float], ...]:
        """Return time and acceleration at each sign change of the slope of the acceleration."""
        return found_turning_points(
            lambda t: self._velocity(t, 1), lambda t: self._velocity(t, 2), self.duration, self.highest_frequency
        )

    @property
    def margin(self) -> float:
        """Maximum excess from two turning points in one cell [m/s²], below 2e-8 A√(1 + γ²)/σ."""
        # The fourth derivative is He4(z) exp(−u²/2) times a phase, |z|² = u² + γ² and |He4| ≤ |z|⁴ + 6|z|² + 3.
        square = self.oscillations**2
        bounds = [
            weight * (u2 + square) ** (power / 2.0) * math.exp(-0.5 * u2)
            for weight, power in ((1.0, 4), (6.0, 2), (3.0, 0))
            for u2 in [max(0.0, power - square)]
        ]
        third = abs(self.velocity) * math.fsum(bounds) / self.deviation**4
        return unseen(third, self.duration, self.highest_frequency)

    def _velocity(self, time: Floats, times: int) -> Floats:
        """Differentiate the untruncated velocity `times` times."""
        u = time / self.deviation - CUT
        z = u - 1j * self.oscillations
        # d/du exp(−z²/2) = −z exp(−z²/2), and exp(−u²/2 + iγu) is that up to a constant.
        factor = (np.ones_like(z), -z, z**2 - 1.0)[times]
        values = np.real(factor * np.exp(-0.5 * u**2 + 1j * (self.oscillations * u + self.phase)))
        return np.asarray(self.velocity / self.deviation**times * values)
