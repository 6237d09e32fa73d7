"""From metres to pixels: a view of space, its scale, and where it lies in the picture."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from stylobate.plots.axonometry import View, direction
from stylobate.plots.pose import Floats


@dataclass(frozen=True, slots=True, kw_only=True)
class Lens:
    """A parallel projection onto a picture whose pixels are counted from its upper left corner.

    Parameters
    ----------
    view
        Where one looks from.
    scale
        Pixels per metre.
    origin
        Pixel of the origin of space, shape (2,).
    """

    view: View
    scale: float
    origin: Floats

    @classmethod
    def fitting(cls, view: View, points: Floats, low: tuple[float, float], high: tuple[float, float]) -> Self:
        """Return the lens that shows all `points`, shape (n, 3), as large as they fit between two corners [pixels]."""
        paper = view.project(points)
        least, most = paper.min(axis=0), paper.max(axis=0)
        room = np.subtract(high, low)
        scale = float(np.min(room / (most - least)))
        middle = 0.5 * (least + most)
        origin = 0.5 * np.add(low, high) - scale * middle * _DOWN
        return cls(view=view, scale=scale, origin=origin)

    def pixels(self, points: Floats) -> Floats:
        """Return where points in space are seen, shape (…, 2)."""
        return np.asarray(self.origin + self.scale * self.view.project(points) * _DOWN)

    def shift(self, displacement: Floats) -> Floats:
        """Return by how many pixels a displacement in space, shape (3,), moves what is seen: everywhere the same."""
        return np.asarray(self.scale * self.view.project(displacement) * _DOWN)

    @property
    def eye(self) -> Floats:
        """Unit vector towards the eye."""
        return direction(self.view.azimuth, self.view.elevation)


# Pixels are counted downwards.
_DOWN = np.array([1.0, -1.0])
