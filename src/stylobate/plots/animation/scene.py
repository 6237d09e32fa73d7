"""Scene of an animation: the slab that moves with the base, the ground below, and the extent of the frames."""

import math
from dataclasses import dataclass
from typing import Self

import numpy as np
import numpy.typing as npt

from stylobate.plots.animation.motion import DrawnMotion
from stylobate.plots.pose import Floats, frames, quaternions

# Half the minimum width of the slab: in base radii, and in heights of the column.
_LEAST, _OF_HEIGHT = 2.3, 0.16
# Margin of the slab about the path [base radii], its thickness in half widths, number of lines across it.
_MARGIN, _THICKNESS, _LINES = 1.7, 0.09, 8
# Number of poses that set the extent of the frames.
_SEEN = 240


@dataclass(frozen=True, slots=True, kw_only=True)
class Scene:
    """A slab on the ground, and the plane on it in which positions of a motion are given.

    Attributes
    ----------
    turned
        Rotation matrix from the frame of the inclined plane to the frame of gravity, shape (3, 3).
    low, high
        Corners of the slab in its plane, shape (2,) [m].
    thickness, ground
        Thickness of the slab, and height of the ground [m].
    grid
        Distance between lines on the slab and marks on the ground [m].
    """

    turned: Floats
    low: Floats
    high: Floats
    thickness: float
    ground: float
    grid: float

    @classmethod
    def of(cls, motion: DrawnMotion) -> Self:
        """Return the scene that contains all of a motion."""
        shape = motion.shape
        least, most = motion.footprint.min(axis=0), motion.footprint.max(axis=0)
        middle, reach = 0.5 * (least + most), 0.5 * float(np.max(most - least))
        half = max(reach + _MARGIN * shape.radius, _LEAST * shape.radius, _OF_HEIGHT * shape.height)
        lean = motion.incline * np.array([math.cos(motion.incline_direction), math.sin(motion.incline_direction)])
        turned = frames(quaternions(lean, 0.0))
        thickness = _THICKNESS * half
        corners = _corners(middle - half, middle + half, -thickness) @ turned.T
        lowest = corners[:, 2].min() + (motion.base @ turned.T)[:, 2].min()
        return cls(
            turned=turned,
            low=middle - half,
            high=middle + half,
            thickness=thickness,
            ground=float(lowest),
            grid=round_length(2.0 * half / _LINES),
        )

    def slab(self, height: float) -> Floats:
        """Return the corners of the slab at a `height` above its upper face, anticlockwise, in its own frame."""
        return _corners(self.low, self.high, height)

    def lines(self) -> Floats:
        """Return the ends of the lines on the slab, in its own frame, shape (n, 2, 3)."""
        found = []
        for along in (0, 1):
            first, last = math.ceil(self.low[along] / self.grid), math.floor(self.high[along] / self.grid)
            for number in range(first, last + 1):
                ends = np.zeros((2, 3))
                ends[:, along] = number * self.grid
                ends[:, 1 - along] = self.low[1 - along], self.high[1 - along]
                found.append(ends)
        return np.stack(found)

    @property
    def normal(self) -> Floats:
        """Unit vector upwards from the plane, in the frame of gravity."""
        return self.turned[:, 2]

    def everything(self, motion: DrawnMotion) -> Floats:
        """Return points whose hull contains slab and column at all times, shape (n, 3)."""
        shape, chosen = motion.shape, _spread(motion.time.size)
        poses, base = frames(motion.rotation[chosen]), motion.base[chosen]
        around = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)
        rings = [
            np.stack([radius * np.cos(around), radius * np.sin(around), np.full(around.size, height)], axis=-1)
            for radius, height in ((shape.radius, 0.0), (shape.top_radius, shape.height))
        ]
        columns = np.concatenate(rings) @ np.swapaxes(poses, -1, -2) + (base + motion.centre[chosen])[:, None]
        slabs = np.concatenate([self.slab(0.0), self.slab(-self.thickness)]) + base[:, None]
        return np.concatenate([columns.reshape(-1, 3), slabs.reshape(-1, 3)]) @ self.turned.T


def round_length(length: float) -> float:
    """Return the largest of 1, 2 and 5 times a power of ten that is no longer than `length`.

    >>> round_length(0.34), round_length(7.0)
    (0.2, 5.0)
    """
    power = 10.0 ** math.floor(math.log10(length))
    return max(step * power for step in (1.0, 2.0, 5.0) if step * power <= length)


def _spread(count: int) -> npt.NDArray[np.intp]:
    return np.unique(np.linspace(0, count - 1, min(count, _SEEN)).round().astype(int))


def _corners(low: Floats, high: Floats, height: float) -> Floats:
    return np.array(
        [[low[0], low[1], height], [high[0], low[1], height], [high[0], high[1], height], [low[0], high[1], height]]
    )
