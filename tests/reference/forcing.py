"""The base motion as the reference sees it: at single times too, with its bounds and rates."""

import math
from dataclasses import dataclass

from stylobate.base_motions.base import ACCELERATION
from stylobate.engine.forcing import Floats
from stylobate.engine.forcing import Forcing as Along

__all__ = ["Floats", "Forcing"]

# Over this part of the shortest time in a motion that is linear its slope is taken.
_AHEAD = 1e-6


@dataclass(frozen=True, slots=True)
class Forcing(Along):
    """A base motion in the units of a model."""

    def at(self, tau: float) -> tuple[float, float, float]:
        """Return ax, ay, az [g] at one dimensionless time."""
        x, y, z = self.motion.derivative(tau * self.time_scale, ACCELERATION)
        return float(x) / self.gravity, float(y) / self.gravity, float(z) / self.gravity

    def peak_horizontal(self, since: float) -> float:
        """Return a bound of |a_h| [g] from `since` on."""
        return self.motion.peak_horizontal(since * self.time_scale) / self.gravity

    def minimum_vertical(self, since: float) -> float:
        """Return a bound of a_z [g] from `since` on."""
        return self.vertical_range(since)[0]

    def vertical_range(self, since: float) -> tuple[float, float]:
        """Return bounds of a_z [g] from `since` on."""
        low, high = self.motion.vertical_range(since * self.time_scale)
        return low / self.gravity, high / self.gravity

    @property
    def mean_frequency(self) -> float:
        """Mean dimensionless frequency; 0 for a base at rest."""
        return self.motion.mean_frequency * self.time_scale

    def largest_rate(self, tau: float, slenderness: float) -> float:
        """Return how fast the force on a column near rest may change about `tau`; exactly, where it is linear."""
        if self.motion.degree is not None and self.motion.degree <= 1:
            ahead = _AHEAD / max(self.highest_frequency, 1.0)
            x, y, z = ((b - a) / ahead for a, b in zip(self.at(tau), self.at(tau + ahead), strict=True))
            return math.hypot(x, y) + slenderness * abs(z)
        vertical = max(map(abs, self.vertical_range(tau)))
        return self.highest_frequency * (self.peak_horizontal(tau) + slenderness * vertical)
