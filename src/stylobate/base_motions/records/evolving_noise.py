"""Synthetic ground motions: modulated, high-passed white noise through a time-varying filter.

The model of S. Rezaeian and A. Der Kiureghian, "A stochastic ground motion model with separable temporal and spectral
nonstationarity", Earthquake Engng Struct. Dyn. 37, 2008, and "Simulation of synthetic ground motions for specified
earthquake and site characteristics", 39, 2010::

    x(t) = q(t)/σ(t) ∫ h(t − τ, τ) w(τ) dτ,    σ² = ∫ h(t − τ, τ)² dτ                   (1)
    h(s, τ) = ω_f/√(1 − ζ_f²) exp(−ζ_f ω_f s) sin(ω_f √(1 − ζ_f²) s),  ω_f = ω_f(τ)      (2)
    ω_f(τ) = ω_mid + ω' (τ − t_mid)                                                      (3)
    q(t) = α1 t^(α2 − 1) exp(−α3 t)                                                      (4)
    z̈ + 2 ω_c ż + ω_c² z = x(t)                                                          (5)

The accelerogram is z̈: the critically damped oscillator (5) removes the residual velocity.
"""

import math
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import brentq
from scipy.special import gammaincinv, gammaln

from stylobate.base_motions.records.oscillator import oscillator_response
from stylobate.base_motions.records.record import AXES, Floats, Record
from stylobate.column import STANDARD_GRAVITY
from stylobate.errors import ParameterError, require_finite, require_positive, require_whole

# Fractions of the Arias intensity at the start, end and middle of the strong motion.
_BEGIN, _MIDDLE, _END = 0.05, 0.45, 0.95
# q² is the density of a gamma distribution of the shape 2α2 − 1; these bounds limit its middle time.
_SHAPES = (1.0, 1e4)
# Remaining fraction of the intensity at which the noise ends, and of the motion at which the high-pass ends.
_REST_OF_INTENSITY, _REST_OF_SWING = 1e-5, 1e-5
# Damping factor below which the filter neglects earlier noise.
_FORGOTTEN = 1e-12
# Minimum of the filter frequency [rad/s], as a fraction of its value at t_mid.
_LEAST_FREQUENCY = 0.05
_ROWS = 256


@dataclass(frozen=True, slots=True, kw_only=True)
class EvolvingNoise:
    """Stochastic model of an accelerogram, with six numbers and the corner of a high-pass filter.

    Parameters
    ----------
    arias
        Expected Arias intensity of x [m/s], before the high-pass, which reduces it slightly.
    duration_5_95
        Expected time between 5 % and 95 % of the Arias intensity [s].
    middle_time
        Expected time t_mid of 45 % of the Arias intensity [s].
    frequency
        Frequency of the filter at t_mid, ω_mid/2π [Hz].
    frequency_rate
        ω'/2π, usually negative [Hz/s]; the frequency stays above a twentieth of its value at t_mid.
    bandwidth
        Damping ratio ζ_f of the filter, below 1.
    corner
        Corner frequency ω_c/2π of the high-pass [Hz].

    Raises
    ------
    ParameterError
        If a number is out of its range, or no modulating function (4) that begins at zero has these times.

    Examples
    --------
    >>> model = EvolvingNoise(arias=0.6, duration_5_95=12.0, middle_time=8.0, frequency=5.0, bandwidth=0.3)
    >>> model.record(np.random.default_rng(1), components=2).axes
    ('x', 'y')
    """

    arias: float
    duration_5_95: float
    middle_time: float
    frequency: float
    frequency_rate: float = 0.0
    bandwidth: float = 0.3
    corner: float = 0.1

    def __post_init__(self) -> None:
        units = {"arias": "m/s", "duration_5_95": "s", "middle_time": "s", "frequency": "Hz", "corner": "Hz"}
        for name in (*units, "bandwidth"):
            object.__setattr__(self, name, require_positive(name, getattr(self, name), units.get(name, "")))
        require_finite("frequency_rate", self.frequency_rate, "Hz/s")
        if self.bandwidth >= 1.0:
            message = f"bandwidth must be below 1, got {self.bandwidth!r}"
            raise ParameterError(message)
        least, most = (_spread(shape) for shape in _SHAPES[::-1])
        if not least < self.duration_5_95 / self.middle_time < most:
            message = (
                f"duration_5_95 must be between {least:.3g} and {most:.3g} of middle_time = {self.middle_time!r} s, "
                f"got {self.duration_5_95!r} s"
            )
            raise ParameterError(message)

    def record(
        self, rng: np.random.Generator, *, step: float = 0.01, components: int = 1, name: str | None = None
    ) -> Record:
        """Generate one realization.

        Parameters
        ----------
        rng
            Generator of the white noise.
        step
            Time between samples [s].
        components
            Number of independent components along x, y and z: 1, 2 or 3; x and y are the principal axes.
        name
            Name of the record; by default "synthetic" and six digits of its digest, so that realizations differ in
            name.

        Returns
        -------
        Record
            Contains all but 1e-5 of the intensity, then rest until the motion of (5) has decayed.
        """
        step = require_positive("step", step, "s")
        components = require_whole("components", components, least=1)
        if components > len(AXES):
            message = f"components must be 1, 2 or 3, got {components!r}"
            raise ParameterError(message)
        shape, scale = self._modulation()
        noisy = math.ceil(scale * gammaincinv(shape, 1.0 - _REST_OF_INTENSITY) / step) + 1
        time = step * np.arange(float(noisy))
        noise = rng.standard_normal((noisy, components))
        x = self.envelope(time)[:, np.newaxis] * self._unit_process(time, noise)  # (1)
        silent = math.ceil(_swing_forgotten() / (2.0 * math.pi * self.corner) / step)
        x = np.pad(x, ((0, silent), (0, 0)))
        record = Record(
            samples=self._without_drift(x, step), step=step, name="", provenance=(f"realization of {self!r}",)
        )
        return replace(record, name=f"synthetic {record.digest[:6]}" if name is None else name)

    def envelope(self, time: Floats) -> Floats:
        """Compute q(t), the standard deviation of x at times of any shape [m/s²]."""
        shape, scale = self._modulation()
        t = np.maximum(np.asarray(time, dtype=float), 0.0) / scale
        with np.errstate(divide="ignore", invalid="ignore"):
            density = np.exp((shape - 1.0) * np.log(t) - t - gammaln(shape)) / scale
        # ∫ q² dt = 2 g I/π
        return np.asarray(np.sqrt(2.0 * STANDARD_GRAVITY * self.arias / math.pi * np.nan_to_num(density)))

    def angular_frequency(self, time: Floats) -> Floats:
        """Compute ω_f(τ), (3), at times of any shape [rad/s]."""
        f = self.frequency + self.frequency_rate * (np.asarray(time, dtype=float) - self.middle_time)
        return 2.0 * math.pi * np.maximum(f, _LEAST_FREQUENCY * self.frequency)

    def _modulation(self) -> tuple[float, float]:
        """Return shape 2α2 − 1 and scale 1/(2α3) of the gamma distribution whose density q² follows."""
        wanted = self.duration_5_95 / self.middle_time
        shape = float(brentq(lambda k: _spread(k) - wanted, *_SHAPES, xtol=1e-12, rtol=1e-14))
        return shape, float(self.middle_time / gammaincinv(shape, _MIDDLE))

    def _unit_process(self, time: Floats, noise: Floats) -> Floats:
        """Compute the factor of q in (1): unit variance at every time but the first, shape of `noise`."""
        omega = self.angular_frequency(time)
        memory = math.ceil(-math.log(_FORGOTTEN) / (self.bandwidth * omega.min()) / float(time[1]))
        process = np.zeros_like(noise)
        for begin in range(1, len(time), _ROWS):
            rows = slice(begin, min(begin + _ROWS, len(time)))
            past = slice(max(0, begin - memory), rows.stop)
            since = np.maximum(time[rows, np.newaxis] - time[np.newaxis, past], 0.0)
            # (2), without a factor that σ cancels for constant ω_f; zero for future noise
            damped = math.sqrt(1.0 - self.bandwidth**2) * omega[past]
            weight = omega[past] * np.exp(-self.bandwidth * omega[past] * since) * np.sin(damped * since)
            deviation = np.sqrt(np.sum(weight**2, axis=1, keepdims=True))
            process[rows] = weight @ noise[past] / deviation
        return process

    def _without_drift(self, x: Floats, step: float) -> Floats:
        """Compute z̈ of (5)."""
        omega = 2.0 * math.pi * self.corner
        z, rate = oscillator_response(-x, step, 1.0 / self.corner, 1.0)
        return np.asarray(x - 2.0 * omega * rate - omega**2 * z)


def _spread(shape: float) -> float:
    """Return (t95 − t5)/t45 of a gamma distribution."""
    begin, middle, end = (float(gammaincinv(shape, part)) for part in (_BEGIN, _MIDDLE, _END))
    return (end - begin) / middle


def _swing_forgotten() -> float:
    """Return the ω_c t at which (1 + ω_c t) exp(−ω_c t) is negligible."""
    return float(brentq(lambda u: math.log1p(u) - u - math.log(_REST_OF_SWING), 1.0, 100.0))
