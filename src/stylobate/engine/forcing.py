"""Base motion in the units of a model: dimensionless time, accelerations in g."""

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from stylobate.base_motions import BaseMotion
from stylobate.base_motions.base import ACCELERATION
from stylobate.engine.tolerances import PARALLEL_ULP
from stylobate.models import Model

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Forcing:
    """Base motion in the units of a model."""

    motion: BaseMotion
    time_scale: float
    gravity: float

    @classmethod
    def of(cls, model: Model, motion: BaseMotion) -> "Forcing":
        """Return `motion` in the units of `model`."""
        return cls(motion, model.time_scale, model.column.gravity)

    def along(self, tau: Floats) -> Floats:
        """Return ax, ay, az [g], shape (3, n), at dimensionless times."""
        return np.stack(self.motion.derivative(tau * self.time_scale, ACCELERATION)) / self.gravity

    @property
    def highest_frequency(self) -> float:
        """Highest dimensionless frequency; 0 for a base at rest."""
        return self.motion.highest_frequency * self.time_scale

    def stops(self, end: float) -> tuple[float, ...]:
        """Return the times up to `end` at which an integration must stop: breaks of the acceleration, and `end`."""
        breaks = (time / self.time_scale for time in self.motion.breaks)
        return (*(tau for tau in breaks if 0.0 < tau < end), end)


def common_line(*vectors: tuple[float, float]) -> tuple[float, float] | None:
    """Return the unit vector parallel to all `vectors` to 8 ulp, or None; zero vectors are parallel to any line."""
    longest = max(vectors, key=lambda vector: math.hypot(*vector), default=(0.0, 0.0))
    length = math.hypot(*longest)
    if length == 0.0:
        return None
    ux, uy = longest[0] / length, longest[1] / length
    for x, y in vectors:
        if abs(ux * y - uy * x) > PARALLEL_ULP * np.finfo(float).eps * math.hypot(x, y):
            return None
    return ux, uy
