"""Synthetic ground motions: accelerograms of an evolving noise, and random vibration with a given density.

`EvolvingNoise` is modulated, high-passed white noise through a time-varying filter, the model of S. Rezaeian and A. Der
Kiureghian, "A stochastic ground motion model with separable temporal and spectral nonstationarity", Earthquake Engng
Struct. Dyn. 37, 2008, and "Simulation of synthetic ground motions for specified earthquake and site characteristics",
39, 2010::

    x(t) = q(t)/σ(t) ∫ h(t − τ, τ) w(τ) dτ,    σ² = ∫ h(t − τ, τ)² dτ                   (1)
    h(s, τ) = ω_f/√(1 − ζ_f²) exp(−ζ_f ω_f s) sin(ω_f √(1 − ζ_f²) s),  ω_f = ω_f(τ)      (2)
    ω_f(τ) = ω_mid + ω' (τ − t_mid)                                                      (3)
    q(t) = α1 t^(α2 − 1) exp(−α3 t)                                                      (4)
    z̈ + 2 ω_c ż + ω_c² z = x(t)                                                          (5)

The accelerogram is z̈: the critically damped oscillator (5) removes the residual velocity.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import brentq
from scipy.special import gammaincinv, gammaln

from stylobate.base_motions.oscillator import oscillator_response
from stylobate.base_motions.record import AXES, Record
from stylobate.base_motions.signal_processing import Floats, samples_within_limit
from stylobate.column.numbers import STANDARD_GRAVITY
from stylobate.errors import ParameterError, require_finite, require_positive, require_whole

Density = Callable[[Floats], Floats]
"""One-sided power spectral density G(f) [(m/s²)²/Hz] of frequencies [Hz]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CloughPenzien:
    """One-sided power spectral density of Kanai and Tajimi, with the high-pass of Clough and Penzien.

    With f_g and ζ_g of the ground and f_c and ζ_c of the high-pass::

        G(f) = G0 (1 + (2ζ_g f/f_g)²)/((1 − (f/f_g)²)² + (2ζ_g f/f_g)²) · (f/f_c)⁴/((1 − (f/f_c)²)² + (2ζ_c f/f_c)²)

    Parameters
    ----------
    level
        G0 [(m/s²)²/Hz].
    ground_frequency, ground_damping
        f_g [Hz] and ζ_g of the soil; 2.5 Hz and 0.6 stand for firm soil.
    high_pass_frequency, high_pass_damping
        f_c [Hz] and ζ_c.

    Raises
    ------
    ParameterError
        If a number is not positive.

    Notes
    -----
    H. Tajimi, Proc. 2nd World Conf. on Earthquake Engineering, 1960; R. W. Clough and J. Penzien, Dynamics of
    Structures, 1975.
    """

    level: float
    ground_frequency: float = 2.5
    ground_damping: float = 0.6
    high_pass_frequency: float = 0.25
    high_pass_damping: float = 0.6

    def __post_init__(self) -> None:
        for name in ("level", "ground_frequency", "ground_damping", "high_pass_frequency", "high_pass_damping"):
            object.__setattr__(self, name, require_positive(name, getattr(self, name)))

    def __call__(self, frequency: Floats) -> Floats:
        """Compute G at frequencies [Hz] of any shape, [(m/s²)²/Hz]."""
        u, w = np.asarray(frequency) / self.ground_frequency, np.asarray(frequency) / self.high_pass_frequency
        soft, slow = (2.0 * self.ground_damping * u) ** 2, (2.0 * self.high_pass_damping * w) ** 2
        ground = (1.0 + soft) / ((1.0 - u**2) ** 2 + soft)
        return np.asarray(self.level * ground * w**4 / ((1.0 - w**2) ** 2 + slow))


def random_vibration(
    density: Density, *, duration: float, step: float, rng: np.random.Generator, components: int = 1, name: str = ""
) -> Record:
    """Generate stationary random vibration with a given power spectral density.

    Parameters
    ----------
    density
        One-sided G(f) [(m/s²)²/Hz]: called with an array of frequencies up to half the sampling rate [Hz].
    duration
        Length [s], rounded up to an even number of steps.
    step
        Time between samples [s].
    rng
        Generator of the phases.
    components
        Number of independent components along x, y and z: 1, 2 or 3.
    name
        Name of the record.

    Raises
    ------
    ParameterError
        If a number is not positive, or the density is negative or not finite somewhere.

    Notes
    -----
    Spectral representation with random phases φ_k (M. Shinozuka and G. Deodatis, "Simulation of stochastic processes by
    spectral representation", Appl. Mech. Rev. 44, 1991), by a fast Fourier transform::

        a(t) = Σ_{k=1}^{N/2−1} √(2 G(f_k) Δf) cos(2π f_k t + φ_k),    f_k = k Δf,  Δf = 1/(N step)

    The mean square of every realization is Σ G(f_k) Δf, its periodogram at f_k is G(f_k), and it repeats after N steps.
    The motion is Gaussian in the limit of many frequencies. Linear interpolation between samples reduces the power near
    half the sampling rate: choose steps that resolve more than the highest frequency of interest. The motion begins at
    full strength, with a jump of the acceleration.
    """
    step = require_positive("step", step, "s")
    components = require_whole("components", components, least=1)
    if components > len(AXES):
        raise ParameterError(f"components must be 1, 2 or 3, got {components!r}")
    count = 2 * math.ceil(require_positive("duration", duration, "s") / step / 2.0 - 1e-9)
    count = max(count, 4)
    frequency = np.arange(1.0, count // 2) / (count * step)
    power = np.asarray(density(frequency), dtype=float)
    if power.shape != frequency.shape or not np.all(np.isfinite(power) & (power >= 0.0)):
        raise ParameterError("density must give finite numbers of zero or above, one for each frequency")
    amplitude = np.sqrt(2.0 * power / (count * step))
    phase = rng.uniform(0.0, 2.0 * math.pi, size=(components, len(frequency)))
    spectrum = np.zeros((components, count // 2 + 1), dtype=complex)
    spectrum[:, 1:-1] = 0.5 * count * amplitude * np.exp(1j * phase)
    samples = np.fft.irfft(spectrum, count, axis=1).T
    return Record(samples=samples, step=step, name=name, provenance=(f"random vibration of the density {density!r}",))


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
            raise ParameterError(f"bandwidth must be below 1, got {self.bandwidth!r}")
        least, most = (_spread(shape) for shape in _SHAPES[::-1])
        if not least < self.duration_5_95 / self.middle_time < most:
            raise ParameterError(
                f"duration_5_95 must be between {least:.3g} and {most:.3g} of middle_time = {self.middle_time!r} s, "
                f"got {self.duration_5_95!r} s"
            )

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
            raise ParameterError(f"components must be 1, 2 or 3, got {components!r}")
        shape, scale = self._modulation()
        length = scale * float(gammaincinv(shape, 1.0 - _REST_OF_INTENSITY))
        noisy = samples_within_limit("step", f"{step!r} s", length / step, "Choose a longer step") + 1
        time = step * np.arange(float(noisy))
        noise = rng.standard_normal((noisy, components))
        x = self.envelope(time)[:, np.newaxis] * self._unit_process(time, noise)  # (1)
        rest = _swing_forgotten() / (2.0 * math.pi * self.corner)
        silent = samples_within_limit("corner", f"{self.corner!r} Hz", rest / step, "Raise the corner")
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
