"""Points and bodies in space drawn on paper: parallel projection, seen from above and from a side."""

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]

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
        return _hull(self.project(np.concatenate([solid.circle(0.0), solid.circle(1.0)])))

    def sees(self, normal: Floats) -> bool:
        """Return whether a face with this outward `normal` is seen."""
        cosine = math.cos(self.elevation)
        eye = (
            cosine * math.cos(self.azimuth),
            cosine * math.sin(self.azimuth),
            math.sin(self.elevation),
        )
        return float(np.dot(normal, eye)) > 0.0


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
        angle, azimuth = math.hypot(*tilt), math.atan2(tilt[1], tilt[0])
        frame = _about_z(azimuth) @ _about_y(angle) @ _about_z(twist - azimuth)
        lean = np.array([math.cos(azimuth), math.sin(azimuth), 0.0])
        down = math.cos(angle) * lean - np.array([0.0, 0.0, math.sin(angle)])
        return cls(np.array([*footprint, 0.0]) + radius * (lean - down), frame, radius, height)

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


def _about_z(angle: float) -> Floats:
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def _about_y(angle: float) -> Floats:
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])


def _hull(points: Floats) -> Floats:
    """Return the convex hull of points on paper, anticlockwise: Andrew's monotone chain."""
    ordered = points[np.lexsort((points[:, 1], points[:, 0]))]

    def chain(given: Floats) -> list[Floats]:
        kept: list[Floats] = []
        for point in given:
            while len(kept) > 1 and _turn(kept[-2], kept[-1], point) <= 0.0:
                kept.pop()
            kept.append(point)
        return kept[:-1]

    return np.array(chain(ordered) + chain(ordered[::-1]))


def _turn(first: Floats, second: Floats, third: Floats) -> float:
    (ax, ay), (bx, by) = second - first, third - first
    return float(ax * by - ay * bx)
