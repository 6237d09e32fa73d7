"""A base motion with what an inclined plane adds to it."""

import math
from dataclasses import dataclass

import numpy as np

from stylobate.base_motions import BaseMotion
from stylobate.models import Model

from .forcing import Floats, Forcing


@dataclass(frozen=True, slots=True)
class InclinedForcing(Forcing):
    """`Forcing` with the constant acceleration by which a plane is inclined [g].

    The equations of a model with an inclined plane add it themselves; this is for what looks at a column at rest.
    """

    slope: tuple[float, float, float] = (0.0, 0.0, 0.0)

    @classmethod
    def of(cls, model: Model, motion: BaseMotion) -> "InclinedForcing":
        """Return `motion` as a column at rest feels it."""
        return cls(motion, model.time_scale, model.column.gravity, model.slope)

    def at(self, tau: float) -> tuple[float, float, float]:
        """Return ax, ay, az [g] at one dimensionless time."""
        ax, ay, az = Forcing.at(self, tau)
        return ax + self.slope[0], ay + self.slope[1], az + self.slope[2]

    def along(self, tau: Floats) -> Floats:
        """Return ax, ay, az [g], shape (3, n), at dimensionless times."""
        felt: Floats = Forcing.along(self, tau) + np.array(self.slope)[:, np.newaxis]
        return felt

    def peak_horizontal(self, since: float) -> float:
        """Return a bound of |a_h| [g] from `since` on."""
        return Forcing.peak_horizontal(self, since) + math.hypot(*self.slope[:2])

    def vertical_range(self, since: float) -> tuple[float, float]:
        """Return bounds of a_z [g] from `since` on."""
        low, high = Forcing.vertical_range(self, since)
        return low + self.slope[2], high + self.slope[2]
