"""Axonometry: parallel projection of three-dimensional points and bodies."""

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from stylobate.plots.pose import Floats, base_centres, frames, quaternions

_CIRCLE = np.linspace(0.0, 2.0 * np.pi, 181)


@dataclass(frozen=True, slots=True)
class View:
    """Direction of view.

    Parameters
    ----------
    azimuth
        Azimuth of the viewer about the vertical [rad].
    elevation
        Elevation of the viewer above the ground [rad].
    """

    azimuth: float = math.radians(-60.0)
    elevation: float = math.radians(22.0)

    def project(self, points: npt.ArrayLike) -> Floats:
        """Return the projections, shape (…, 2), of `points`, shape (…, 3)."""
        x, y, z = np.moveaxis(np.asarray(points, dtype=float), -1, 0)
        sine, cosine = math.sin(self.azimuth), math.cos(self.azimuth)
        right = cosine * y - sine * x
        back = -(cosine * x + sine * y)
        return np.stack([right, z * math.cos(self.elevation) + back * math.sin(self.elevation)], axis=-1)

    def outline(self, solid: "Cylinder") -> Floats:
        """Return the corners of the outline of a projected cylinder, in order."""
        return hull(self.project(np.concatenate([solid.circle(0.0), solid.circle(1.0)])))

    def sees(self, normal: Floats) -> bool:
        """Return whether a face with this outward `normal` is visible."""
        return float(np.dot(normal, direction(self.azimuth, self.elevation))) > 0.0


@dataclass(frozen=True, slots=True)
class Cylinder:
    """A round column in three dimensions.

    Parameters
    ----------
    base
        Centre of its base [m].
    frame
        Matrix with columns: the body's own x and y, which turn with the body, and its axis.
    radius, height
    Base radius and height [m].
    """

    base: Floats
    frame: Floats
    radius: float
    height: float

    @classmethod
    def leaning(cls, tilt: Floats, twist: float, footprint: Floats, radius: float, height: float) -> "Cylinder":
        """Return a column that leans by the `tilt` vector [rad] and stands on its rim, or upright.

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
        """Return the circle at this fraction of the height, shape (n, 3)."""
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
    """Return the convex hull of points in the plane, anticlockwise: Andrew's monotone chain."""
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
