"""Points and bodies in space drawn on paper: parallel projection, seen from above and from a side."""

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from stylobate.plots.pose import Floats, base_centres, frames, quaternions

_CIRCLE = np.linspace(0.0, 2.0 * np.pi, 181)


@dataclass(frozen=True, slots=True)
class View:
    """Where one looks from.

    Parameters
    ----------
    azimuth
        Of the eye about the vertical [rad].
    elevation
        Of the eye above the ground [rad].
    """

    azimuth: float = math.radians(-60.0)
    elevation: float = math.radians(22.0)

    def project(self, points: npt.ArrayLike) -> Floats:
        """Return the places on paper, shape (…, 2), of `points` in space, shape (…, 3)."""
        x, y, z = np.moveaxis(np.asarray(points, dtype=float), -1, 0)
        sine, cosine = math.sin(self.azimuth), math.cos(self.azimuth)
        right = cosine * y - sine * x
        back = -(cosine * x + sine * y)
        return np.stack([right, z * math.cos(self.elevation) + back * math.sin(self.elevation)], axis=-1)

    def outline(self, solid: "Cylinder") -> Floats:
        """Return the corners of what a cylinder covers on paper, in order."""
        return hull(self.project(np.concatenate([solid.circle(0.0), solid.circle(1.0)])))

    def sees(self, normal: Floats) -> bool:
        """Return whether a face with this outward `normal` is seen."""
        return float(np.dot(normal, direction(self.azimuth, self.elevation))) > 0.0


@dataclass(frozen=True, slots=True)
class Cylinder:
    """A round column in space.

    Parameters
    ----------
    base
        Centre of its base [m].
    frame
        Columns: the body's own x and y, which turn with it, and its axis.
    radius, height
        [m].
    """

    base: Floats
    frame: Floats
    radius: float
    height: float

    @classmethod
    def leaning(cls, tilt: Floats, twist: float, footprint: Floats, radius: float, height: float) -> "Cylinder":
        """Return the column that leans by the `tilt` vector [rad] and stands on its rim, or upright.

        Parameters
        ----------
        twist
            Angle of turn about its axis [rad].
        footprint
            Centre of the circle on the ground about which the contact point lies [m].
        """
        return cls(base_centres(tilt, footprint, radius), frames(quaternions(tilt, twist)), radius, height)

    @property
    def axis(self) -> Floats:
        """Unit vector along the axis, upwards."""
        return self.frame[:, 2]

    def circle(self, part: float) -> Floats:
        """Return the circle at this `part` of the height, shape (n, 3)."""
        around = np.cos(_CIRCLE)[:, None] * self.frame[:, 0] + np.sin(_CIRCLE)[:, None] * self.frame[:, 1]
        return np.asarray(self.base + part * self.height * self.axis + self.radius * around)

    def mark(self) -> Floats:
        """Return a radius of the top that turns with the column, shape (2, 3)."""
        centre = self.base + self.height * self.axis
        return np.stack([centre, centre + self.radius * self.frame[:, 0]])


def direction(azimuth: float, elevation: float) -> Floats:
    """Return the unit vector towards this azimuth and elevation [rad]."""
    level = math.cos(elevation)
    return np.array([level * math.cos(azimuth), level * math.sin(azimuth), math.sin(elevation)])


def hull(points: Floats) -> Floats:
    """Return the convex hull of points on paper, anticlockwise: Andrew's monotone chain."""
    ordered = sorted(points.tolist())

    def chain(given: list[list[float]]) -> list[list[float]]:
        kept: list[list[float]] = []
        for point in given:
            while len(kept) > 1 and _turn(kept[-2], kept[-1], point) <= 0.0:
                kept.pop()
            kept.append(point)
        return kept[:-1]

    return np.array(chain(ordered) + chain(ordered[::-1]))


def _turn(first: list[float], second: list[float], third: list[float]) -> float:
    (x, y), (ax, ay), (bx, by) = first, second, third
    return (ax - x) * (by - y) - (ay - y) * (bx - x)
