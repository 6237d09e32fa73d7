"""Base motion of a planar column: the component along one horizontal direction, and the vertical component."""

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from stylobate.base_motions import BaseMotion, Record
from stylobate.base_motions.base import Components, Direction
from stylobate.base_motions.combined import Transformed
from stylobate.errors import require_finite


@dataclass(frozen=True, slots=True, kw_only=True)
class InOneDirection(Transformed):
    """`motion` without its horizontal acceleration across the `direction` [rad from x, anticlockwise]."""

    direction: Direction

    def derivative(self, time: npt.ArrayLike, order: int) -> Components:
        """Return the displacement (`order` 0), velocity (1) or acceleration (2)."""
        x, y, z = self.motion.derivative(time, order)
        along = self._along(x, y)
        return math.cos(self.direction) * along, math.sin(self.direction) * along, z

    def directions(self) -> tuple[tuple[float, float], ...]:
        """Return the only direction; none if the motion is perpendicular to it."""
        longest = max((abs(float(self._along(x, y))) for x, y in self.motion.directions()), default=0.0)
        return ((longest * math.cos(self.direction), longest * math.sin(self.direction)),) if longest > 0.0 else ()

    def _along(self, x: npt.ArrayLike, y: npt.ArrayLike) -> npt.NDArray[np.float64]:
        return np.asarray(math.cos(self.direction) * np.asarray(x) + math.sin(self.direction) * np.asarray(y))


def in_one_direction(motion: BaseMotion, direction: float) -> BaseMotion:
    """Keep only the horizontal component of `motion` along `direction` [rad], rotated to x; a record stays a record."""
    direction = require_finite("direction", direction, "rad")
    if not isinstance(motion, Record):
        return InOneDirection(motion=motion.rotated(-direction) if direction else motion, direction=0.0)
    turned = motion.rotated(-direction) if direction else motion
    note = f"component along {direction!r} rad only"
    return turned.changed(note, samples=turned.samples * [1.0, 0.0, 1.0])
