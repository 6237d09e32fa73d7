"""Waveforms of pulses: acceleration along a line over time, of the literature."""

import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from stylobate.base_motions.base import (
    ACCELERATION,
    DISPLACEMENT,
    VELOCITY,
    Acceleration,
    AngularFrequency,
    Bell,
    Cycles,
    Frequency,
    Oscillations,
    Phase,
    Velocity,
)
from stylobate.quantities import Declared

Floats = npt.NDArray[np.float64]

# Cells per shortest period in the search of turning points, and bisections of a cell with a turning point.
_CELLS_PER_PERIOD = 1024
_HALVINGS = 60


class Waveform(Declared, ABC):
    """An acceleration along a line from the time 0 to `duration`, with its integrals and extremes.

    Notes
    -----
    For developers: a custom waveform is a frozen dataclass that implements `duration`, `highest_frequency`,
    `derivative` and `turning_points`. Pulse(waveform=…) then converts it to a base motion.
    """

    __slots__ = ()

    constructor: ClassVar[str] = ""
    """The constructor of `Pulse` with the parameters of this waveform; empty for a custom waveform."""

    @property
    @abstractmethod
    def duration(self) -> float:
        """Duration of the waveform [s]."""

    @property
    @abstractmethod
    def highest_frequency(self) -> float:
        """Highest angular frequency in the acceleration [rad/s]."""

    @abstractmethod
    def derivative(self, time: Floats, order: int) -> Floats:
        """Compute the displacement (`order` 0) [m], velocity (1) [m/s] or acceleration (2) [m/s²].

        Parameters
        ----------
        time
            Times from 0 to `duration` [s].
        order
            0, 1 or 2. Displacement and velocity begin with 0; the acceleration at `duration` is the last one.
        """

    @abstractmethod
    def turning_points(self) -> tuple[tuple[float, float], ...]:
        """Return time [s] and acceleration [m/s²] of the extremes between start and end, in order."""

    @property
    def margin(self) -> float:
        """Maximum excess of the acceleration over its values at `turning_points` and the ends [m/s²]."""
        return 0.0


def found_turning_points(
    acceleration: Callable[[Floats], Floats], slope: Callable[[Floats], Floats], duration: float, frequency: float
) -> tuple[tuple[float, float], ...]:
    """Find time and acceleration at sign changes of the `slope`, by bisection of 1024 cells per shortest period.

    Two turning points in one cell are missed; see `unseen`.
    """
    edges = np.linspace(0.0, duration, _cells(duration, frequency) + 1)
    rising = slope(edges) > 0.0
    turns = np.flatnonzero(rising[1:] != rising[:-1])
    low, high = edges[turns], edges[turns + 1]
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        before = (slope(middle) > 0.0) == rising[turns]
        low, high = np.where(before, middle, low), np.where(before, high, middle)
    times = 0.5 * (low + high)
    return tuple(zip(times.tolist(), acceleration(times).tolist(), strict=True))


def unseen(third: float, duration: float, frequency: float) -> float:
    """Return the maximum excess of two turning points in a cell of width h over its ends: h³/12 sup |d³a/dt³|.

    Between the turning points t1 and t2 the slope is bounded by ½(t − t1)(t2 − t) times `third` = sup |d³a/dt³|, since
    it vanishes at both.
    """
    return third * (duration / _cells(duration, frequency)) ** 3 / 12.0


def _cells(duration: float, frequency: float) -> int:
    return math.ceil(_CELLS_PER_PERIOD * frequency * duration / (2.0 * math.pi))


# On an interval of a quarter of the shortest period the Gauss rule of this order is exact to rounding.
_ORDER = 12
_STRETCHES_PER_PERIOD = 4


def integral(function: Callable[[Floats], Floats], time: Floats, end: float, cycles: float) -> Floats:
    """Compute ∫₀ᵗ f ds at `time` from 0 to `end`, an interval of at most `cycles` shortest periods of `function`."""
    return _integrals(function, time, end, cycles)[0]


def double_integral(function: Callable[[Floats], Floats], time: Floats, end: float, cycles: float) -> Floats:
    """Compute ∫₀ᵗ (t − s) f ds, the integral of the integral, in the same way."""
    return _integrals(function, time, end, cycles)[1]


def _integrals(function: Callable[[Floats], Floats], time: Floats, end: float, cycles: float) -> tuple[Floats, Floats]:
    edges = np.linspace(0.0, end, int(np.ceil(_STRETCHES_PER_PERIOD * cycles)) + 1)
    whole, moments = _gauss(function, edges[:-1], edges[1:])
    first = np.concatenate([[0.0], np.cumsum(whole)])
    # Over an interval the double integral grows by the first integral times the length plus its own part.
    second = np.concatenate([[0.0], np.cumsum(first[:-1] * np.diff(edges) + moments)])
    stretch = np.clip(np.searchsorted(edges, time, side="right") - 1, 0, edges.size - 2)
    low = edges[stretch]
    part, moment = _gauss(function, low, time)
    return first[stretch] + part, second[stretch] + first[stretch] * (time - low) + moment


def _gauss(function: Callable[[Floats], Floats], low: Floats, high: Floats) -> tuple[Floats, Floats]:
    """Compute ∫ f ds and ∫ (high − s) f ds from `low` to `high`."""
    nodes, weights = np.polynomial.legendre.leggauss(_ORDER)
    half = 0.5 * (high - low)
    times = low[..., np.newaxis] + half[..., np.newaxis] * (1.0 + nodes)
    values = weights * function(times)
    moment = np.sum(values * (1.0 - nodes), axis=-1)
    return half * np.sum(values, axis=-1), half**2 * moment


def closing_phase(cycles: int) -> float:
    """Compute φ [rad] of the pulse Cₙ, n = `cycles`: its displacement ends with 0.

    Notes
    -----
    cos[(2n + 1)π − φ] + [(2n + 1)π − 2φ] sin φ − cos φ = 0, that is [(n + ½)π − φ] tan φ = 1; the left side grows
    from 0 to beyond 1 between 0 and π/4. N. Makris, "Rigidity–plasticity–viscosity: can electrorheological dampers
    protect base-isolated structures from near-source ground motions?", Earthquake Engineering and Structural Dynamics
    26 (1997).
    """
    low, high = 0.0, 0.25 * math.pi
    for _ in range(_HALVINGS):
        phase = 0.5 * (low + high)
        if ((cycles + 0.5) * math.pi - phase) * math.tan(phase) < 1.0:
            low = phase
        else:
            high = phase
    return 0.5 * (low + high)


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
        return float(max(abs(self._bell(x, ACCELERATION)) for x in self.turns))

    def _bell(self, x: Any, order: int) -> Any:
        # −dⁿ/dxⁿ exp(−x²/2) = −(−1)ⁿ Heₙ(x) exp(−x²/2)
        n = self.degree - (ACCELERATION - order)
        return -((-1.0) ** n) * _hermite(n, x) * np.exp(-0.5 * x**2)


def _hermite(n: int, x: Any) -> Any:
    """Evaluate the probabilists' Hermite polynomial Heₙ(x) by its recurrence."""
    before, value = 0.0 * x, 1.0 + 0.0 * x
    for k in range(n):
        before, value = value, x * value - k * before
    return value


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
        u, gamma = time / self.deviation - CUT, self.oscillations
        # d/du exp(−z²/2) = −z exp(−z²/2) with z = u − iγ, and exp(−u²/2 + iγu) is that up to a constant: factors 1, −z
        # and z² − 1, here their real and imaginary parts.
        real, imaginary = ((1.0, 0.0), (-u, gamma), (u**2 - gamma**2 - 1.0, -2.0 * gamma * u))[times]
        angle = gamma * u + self.phase
        values = np.exp(-0.5 * u**2) * (real * np.cos(angle) - imaginary * np.sin(angle))
        return np.asarray(self.velocity / self.deviation**times * values)


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
        total = 0.0 * since_middle
        for amplitude, rate in self._harmonics():
            total = total + amplitude * rate**times * np.cos(rate * since_middle + self.phase + 0.5 * math.pi * times)
        return total
