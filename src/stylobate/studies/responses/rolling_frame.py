"""The frame of equations (7) and (10), which turns with one circular component of a harmonic base motion."""

import math
from dataclasses import dataclass
from typing import Self

from stylobate.base_motions import Harmonic
from stylobate.errors import ParameterError
from stylobate.models import Model
from stylobate.theory.averaging import circular_components

Vector = tuple[float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class RollingFrame:
    """A frame that turns with the base: the azimuth of the lean is β = sense (ντ + ψ) + offset.

    Parameters
    ----------
    nu
        Dimensionless frequency ν.
    drive
        Amplitude a0 of the circular component that drives rolling in this sense [g].
    sense
        +1 anticlockwise, −1 clockwise.
    offset
        Azimuth of the frame at t = 0 [rad].
    time_scale
        Unit of dimensionless time, 1/ω0 [s].
    """

    nu: float
    drive: float
    sense: int
    offset: float
    time_scale: float

    @classmethod
    def of(cls, model: Model, motion: Harmonic, sense: int | None = None) -> Self:
        """Return the frame of `motion`; by default in the sense of its larger circular component.

        Raises
        ------
        ParameterError
            If the motion is not a horizontal harmonic motion, or the sense neither +1 nor −1.
        """
        if not isinstance(motion, Harmonic) or motion.amplitude[2] != 0.0:
            message = f"motion must be a horizontal Harmonic motion, got {motion!r}"
            raise ParameterError(message)
        if sense not in (None, 1, -1):
            message = f"sense must be +1 (anticlockwise) or -1 (clockwise), got {sense!r}"
            raise ParameterError(message)
        (a1, a2, _), (phi1, phi2, _) = motion.amplitude, motion.phase
        p, q = (complex(part) for part in circular_components(a1, a2, phi2 - phi1))
        turning = (1 if abs(p) >= abs(q) else -1) if sense is None else sense
        part = p if turning == 1 else q
        return cls(
            nu=motion.angular_frequency * model.time_scale,
            drive=abs(part) / model.column.gravity,
            sense=turning,
            # The components are given at the phase of axis 1.
            offset=math.atan2(part.imag, part.real) + turning * (motion.start_phase + phi1),
            time_scale=model.time_scale,
        )

    def azimuth(self, tau: float, psi: float) -> float:
        """Return β [rad] at dimensionless time τ for the phase ψ."""
        return self.sense * (self.nu * tau + psi) + self.offset

    def to_tilt(self, tilt: float, psi: float, tilt_rate: float, rolling_rate: float) -> tuple[Vector, Vector]:
        """Return tilt vector [rad] and rate [rad/s] at t = 0 of A, ψ, μ = Ȧ and ω (dimensionless)."""
        beta = self.azimuth(0.0, psi)
        x, y = math.cos(beta), math.sin(beta)
        radial, across = tilt_rate / self.time_scale, self.sense * rolling_rate * tilt / self.time_scale
        return (tilt * x, tilt * y), (radial * x - across * y, radial * y + across * x)

    def from_tilt(self, tilt: Vector, tilt_rate: Vector) -> tuple[float, float, float, float]:
        """Return (μ, ω, A, ψ) of a tilt vector [rad] and its rate [rad/s] at t = 0."""
        (x, y), (vx, vy) = tilt, tilt_rate
        size = math.hypot(x, y)
        if size == 0.0:
            message = f"tilt must differ from zero in the frame of rolling, got {tilt!r} rad"
            raise ParameterError(message)
        psi = self.sense * (math.atan2(y, x) - self.offset)
        mu = (x * vx + y * vy) / size * self.time_scale
        omega = self.sense * (x * vy - y * vx) / size**2 * self.time_scale
        return mu, omega, size, math.remainder(psi, 2.0 * math.pi)
