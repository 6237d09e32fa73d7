"""Mass, centre and inertia of rigid bodies that a column is made of: joined coaxial bodies and regular prisms."""

import math
from collections.abc import Iterable
from typing import NamedTuple


class MassProperties(NamedTuple):
    """Mass properties of a body whose inertia is the same about all horizontal axes through its centre of mass.

    Attributes
    ----------
    mass
        Mass m [kg].
    mass_height
        Height of the centre of mass [m].
    transverse_inertia
        Moment of inertia about a horizontal axis through the centre of mass [kg m²].
    axial_inertia
        Moment of inertia about the vertical axis through the centre of mass [kg m²].
    """

    mass: float
    mass_height: float
    transverse_inertia: float
    axial_inertia: float

    def raised(self, elevation: float) -> "MassProperties":
        """Return the mass properties of the body at a height larger by `elevation` [m]."""
        return self._replace(mass_height=self.mass_height + elevation)


def joined(bodies: Iterable[MassProperties]) -> MassProperties:
    """Join coaxial `bodies`, whose heights have one origin, into one rigid body by the parallel-axis theorem."""
    bodies = tuple(bodies)
    mass = math.fsum(one.mass for one in bodies)
    centre = math.fsum(one.mass * one.mass_height for one in bodies) / mass
    transverse = math.fsum(one.transverse_inertia + one.mass * (one.mass_height - centre) ** 2 for one in bodies)
    return MassProperties(mass, centre, transverse, math.fsum(one.axial_inertia for one in bodies))


def inscribed_radius(sides: int, side: float) -> float:
    """Compute the radius of the inscribed circle of a regular polygon: the distance of its sides from the centre."""
    return side / (2.0 * math.tan(math.pi / sides))


def circumscribed_radius(sides: int, side: float) -> float:
    """Compute the radius of the circumscribed circle of a regular polygon: the distance of its corners."""
    return side / (2.0 * math.sin(math.pi / sides))


def prism(sides: int, side: float, height: float, density: float) -> MassProperties:
    """Compute the mass properties of an upright prism on a regular polygon.

    Notes
    -----
    The second moments of area of a regular polygon are equal about all axes in its plane, with a the radius of the
    inscribed circle and R that of the circumscribed circle:

        ∫ x² dA = ∫ y² dA = A (R² + 2a²)/12.
    """
    a, corner = inscribed_radius(sides, side), circumscribed_radius(sides, side)
    mass = density * height * 0.5 * sides * side * a
    spread = (corner * corner + 2.0 * a * a) / 12.0
    return MassProperties(mass, height / 2.0, mass * (spread + height * height / 12.0), 2.0 * mass * spread)
