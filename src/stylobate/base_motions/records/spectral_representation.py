"""Random vibration with a given power spectral density, by spectral representation."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from stylobate.base_motions.records.record import AXES, Floats, Record
from stylobate.errors import ParameterError, require_positive, require_whole

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
        message = f"components must be 1, 2 or 3, got {components!r}"
        raise ParameterError(message)
    count = 2 * math.ceil(require_positive("duration", duration, "s") / step / 2.0 - 1e-9)
    count = max(count, 4)
    frequency = np.arange(1.0, count // 2) / (count * step)
    power = np.asarray(density(frequency), dtype=float)
    if power.shape != frequency.shape or not np.all(np.isfinite(power) & (power >= 0.0)):
        message = "density must give finite numbers of zero or above, one for each frequency"
        raise ParameterError(message)
    amplitude = np.sqrt(2.0 * power / (count * step))
    phase = rng.uniform(0.0, 2.0 * math.pi, size=(components, len(frequency)))
    spectrum = np.zeros((components, count // 2 + 1), dtype=complex)
    spectrum[:, 1:-1] = 0.5 * count * amplitude * np.exp(1j * phase)
    samples = np.fft.irfft(spectrum, count, axis=1).T
    return Record(samples=samples, step=step, name=name, provenance=(f"random vibration of the density {density!r}",))
