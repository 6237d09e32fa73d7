"""Geometry of columns in pictures: shape, pose on the rim, and parallel projection."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
import numpy.typing as npt

from stylobate.column.numbers import Height, MassHeight, Radius, Slenderness, TopRadius
from stylobate.results import Run

# Relative tolerance of the axial inertia of a frustum with the same centre of mass.
_SAME = 1e-9


@dataclass(frozen=True, slots=True, kw_only=True)
class Shape:
    """A column as a body with a round base and top.

    Attributes
    ----------
    radius, top_radius
        Radii of base and top [m].
    height
        Height [m]; twice the height of the centre of mass for a column given by its inertia.
    mass_height
        Height of the centre of mass [m].
    slenderness
        c.
    corners
        Heights and radii of the outline from the base up [m]; by default those of base and top.
    """

    radius: Radius
    top_radius: TopRadius
    height: Height
    mass_height: MassHeight
    slenderness: Slenderness
    corners: tuple[tuple[float, float], ...] = ()

    def __post_init__(self) -> None:
        """Complete the outline."""
        if not self.corners:
            object.__setattr__(self, "corners", ((0.0, self.radius), (self.height, self.top_radius)))

    @classmethod
    def of(cls, run: Run) -> Self:
        """Return the shape of the column of `run`."""
        return cls.of_column(run.provenance["column"])

    @classmethod
    def of_column(cls, column: Mapping[str, Any]) -> Self:
        """Return the shape of a column with these fields: its profile, else a frustum if its inertia is that of one.

        Others, such as a tube, are drawn as a cylinder.
        """
        radius, mass_height = float(column["radius"]), float(column["mass_height"])
        top, height = _top_radius(column), float(column.get("height") or 2.0 * mass_height)
        profile = column.get("profile") or {}
        drawn = tuple(dict.fromkeys(zip(profile.get("heights", ()), profile.get("radii", ()), strict=True)))
        return cls(
            radius=radius,
            top_radius=top,
            height=height,
            mass_height=mass_height,
            slenderness=radius / mass_height,
            corners=drawn,
        )

    @property
    def largest_radius(self) -> float:
        """Largest radius of the outline [m]."""
        return max(radius for _, radius in self.corners)

    @property
    def side(self) -> npt.NDArray[np.float64]:
        """The outline seen from the side: corners x, z of a closed polygon, shape (n, 2) [m]."""
        right = [(radius, height) for height, radius in self.corners]
        return np.array([*right, *((-x, z) for x, z in right[::-1])])


def _top_radius(column: Mapping[str, Any]) -> float:
    """Return the top radius of the solid frustum with these parameters, or the base radius if there is none."""
    radius = float(column["radius"])
    if not column.get("height"):
        return radius
    part = float(column["mass_height"]) / float(column["height"])
    # Centre of mass of a frustum whose top is q times as wide: 4 part (1 + q + q²) = 1 + 2q + 3q², with 0 < q.
    a, b, c = 3.0 - 4.0 * part, 2.0 - 4.0 * part, 1.0 - 4.0 * part
    if not (a > 0.0 > c):
        return radius
    q = (math.sqrt(b * b - 4.0 * a * c) - b) / (2.0 * a)
    axial = 0.3 * radius**2 * (1.0 + q + q**2 + q**3 + q**4) / (1.0 + q + q**2)
    same = math.isclose(axial, float(column["axial_inertia"]) / float(column["mass"]), rel_tol=_SAME)
    return q * radius if same else radius


Floats = npt.NDArray[np.float64]


def quaternions(tilt: npt.ArrayLike, twist: npt.ArrayLike) -> Floats:
    """Return the rotations Rz(β) Ry(θ) Rz(χ − β) of leaning columns as unit quaternions w, x, y, z.

    The quaternions are smooth functions of tilt vector and twist, also through the vertical: their sign never jumps.

    Parameters
    ----------
    tilt
        Tilt vectors θ(cosβ, sinβ), shape (…, 2) [rad].
    twist
        Angles of turn χ about the axis, shape (…) [rad].

    Returns
    -------
    numpy.ndarray
        Shape (…, 4).
    """
    lean, half = np.asarray(tilt, dtype=float), 0.5 * np.asarray(twist, dtype=float)
    angle = np.hypot(lean[..., 0], lean[..., 1])
    # sin(θ/2)/θ, ½ at θ = 0; np.sinc(u) is sin(πu)/(πu).
    share = 0.5 * np.sinc(angle / (2.0 * np.pi))
    sine, cosine = np.sin(half), np.cos(half)
    return np.stack(
        [
            np.cos(0.5 * angle) * cosine,
            share * (lean[..., 0] * sine - lean[..., 1] * cosine),
            share * (lean[..., 0] * cosine + lean[..., 1] * sine),
            np.cos(0.5 * angle) * sine,
        ],
        axis=-1,
    )


def frames(rotation: npt.ArrayLike) -> Floats:
    """Return the matrices of unit quaternions, shape (…, 3, 3), with the body's x, y and axis as columns."""
    w, x, y, z = np.moveaxis(np.asarray(rotation, dtype=float), -1, 0)
    rows = [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
        [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
    ]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def base_centres(
    tilt: npt.ArrayLike, footprint: npt.ArrayLike, radius: float, clearance: npt.ArrayLike = 0.0
) -> Floats:
    """Return the centres of the bottom circles of columns that stand on their rims, or upright [m].

    Parameters
    ----------
    tilt
        Tilt vectors, shape (…, 2) [rad].
    footprint
        Centres of the circles on the ground about which the contact points lie, shape (…, 2) [m].
    radius
        Base radius [m].
    clearance
        Heights of the lowest points above the ground [m].

    Returns
    -------
    numpy.ndarray
        Shape (…, 3).
    """
    lean = np.asarray(tilt, dtype=float)
    angle = np.hypot(lean[..., 0], lean[..., 1])
    # (1 − cosθ)/θ along the lean, 0 at θ = 0.
    share = np.sin(0.5 * angle) * np.sinc(angle / (2.0 * np.pi))
    along = np.asarray(footprint, dtype=float) + radius * share[..., None] * lean
    return np.concatenate([along, (radius * np.sin(angle) + clearance)[..., None]], axis=-1)


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

    @property
    def eye(self) -> Floats:
        """Unit vector towards the viewer."""
        return direction(self.azimuth, self.elevation)


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
