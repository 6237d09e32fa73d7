"""Ricker wavelets: second and third derivative of a Gaussian."""

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.polynomial import HermiteE

from stylobate.base_motions.base import ACCELERATION, DISPLACEMENT
from stylobate.base_motions.numbers import Acceleration, AngularFrequency
from stylobate.base_motions.pulses.waveform import Floats, Waveform

# Distance from the middle in standard deviations at which the Gaussian, e⁻³² = 1.3e-14 of its height, is cut.
CUT = 8.0
# Above this angular frequency [1/standard deviation] a spectrum falls below 1/2000 of its peak.
BAND = 5.0


@dataclass(frozen=True, slots=True, kw_only=True)
class _BellDerivative(Waveform):
    """An acceleration that is a derivative of −exp(−x²/2), x the time from the middle in standard deviations σ."""

    acceleration: Acceleration
    angular_frequency: AngularFrequency

    degree: ClassVar[int]
    turns: ClassVar[tuple[float, ...]]  # x of the turning points: zeros of the next Hermite polynomial

    @property
    def deviation(self) -> float:
        """σ [s]: the spectrum ωⁿ exp(−ω²σ²/2) of the n-th derivative has its peak at ω = √n/σ."""
        return math.sqrt(self.degree) / self.angular_frequency

    @property
    def duration(self) -> float:
        """16 σ [s]."""
        return 2.0 * CUT * self.deviation

    @property
    def highest_frequency(self) -> float:
        """5/σ [rad/s], above which the spectrum is below 1/2000 of its peak."""
        return BAND / self.deviation

    def derivative(self, time: Floats, order: int) -> Floats:
        """Return the displacement (`order` 0), velocity (1) or acceleration (2)."""
        x = time / self.deviation - CUT
        values = self._bell(x, order) - (0.0 if order == ACCELERATION else self._bell(np.array(-CUT), order))
        if order == DISPLACEMENT:
            values = values - (x + CUT) * self._bell(np.array(-CUT), order + 1)
        return np.asarray(self.acceleration / self._height * self.deviation ** (ACCELERATION - order) * values)

    def turning_points(self) -> tuple[tuple[float, float], ...]:
        """Return time and acceleration at each zero of the next derivative of the Gaussian."""
        heights = self._bell(np.array(self.turns), ACCELERATION) / self._height
        return tuple(
            (self.deviation * (x + CUT), self.acceleration * float(height))
            for x, height in zip(self.turns, heights, strict=True)
        )

    @property
    def _height(self) -> float:
        """Peak of the derivative of the Gaussian that gives the acceleration."""
        return float(np.abs(self._bell(np.array(self.turns), ACCELERATION)).max())

    def _bell(self, x: Floats, order: int) -> Floats:
        # −dⁿ/dxⁿ exp(−x²/2) = −(−1)ⁿ Heₙ(x) exp(−x²/2)
        n = self.degree - (ACCELERATION - order)
        return np.asarray(-((-1.0) ** n) * HermiteE.basis(n)(x) * np.exp(-0.5 * x**2))


@dataclass(frozen=True, slots=True, kw_only=True)
class Ricker(_BellDerivative):
    """The symmetric Ricker wavelet, A (1 − x²) exp(−x²/2) with x = ωt/√2 from its middle.

    Parameters
    ----------
    acceleration
        Peak A in the middle [m/s²], between two troughs of −2e^(−3/2) A = −0.446 A.
    angular_frequency
        ω at the peak of the spectrum [rad/s], 2π over the period of the literature.

    Raises
    ------
    ParameterError
        If a number is not finite, or the frequency not positive.

    Notes
    -----
    N. Ricker, "The form and laws of propagation of seismic wavelets", Geophysics 18 (1953); for rocking: M. F.
    Vassiliou and N. Makris, "Estimating time scales and length scales in pulselike earthquake acceleration records with
    wavelet analysis", Bulletin of the Seismological Society of America 101 (2011).
    """

    constructor: ClassVar[str] = "ricker"
    degree: ClassVar[int] = 2
    turns: ClassVar[tuple[float, ...]] = (-math.sqrt(3.0), 0.0, math.sqrt(3.0))


@dataclass(frozen=True, slots=True, kw_only=True)
class AntisymmetricRicker(_BellDerivative):
    """The antisymmetric Ricker wavelet, (A/β) (x³ − 3x) exp(−x²/2) with x = ωt/√3 from its middle.

    Parameters
    ----------
    acceleration
        Peak A [m/s²], at x = −√(3 − √6), with β = 1.380. A trough of the same depth follows after the middle.
    angular_frequency
        ω at the peak of the spectrum [rad/s].

    Raises
    ------
    ParameterError
        If a number is not finite, or the frequency not positive.

    Notes
    -----
    Vassiliou and Makris (2011), see `Ricker`.
    """

    constructor: ClassVar[str] = "antisymmetric_ricker"
    degree: ClassVar[int] = 3
    turns: ClassVar[tuple[float, ...]] = tuple(
        side * math.sqrt(3.0 + inner * math.sqrt(6.0)) for side, inner in ((-1, 1), (-1, -1), (1, -1), (1, 1))
    )
