"""Mass, centre and inertia of rigid bodies that a column is made of: joined, revolved and prismatic bodies."""

import math
from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise
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


class Frustum(NamedTuple):
    """A slice of a body of revolution between two heights [m], with the radii at both [m]."""

    bottom: float
    top: float
    radius: float
    top_radius: float

    def of_density(self, density: float) -> MassProperties:
        """Compute the mass properties exactly; a negative `density` takes the slice out of a body.

        Notes
        -----
        With R linear from a to b over the height L of the slice, ∫ R² zⁿ dz and ∫ R⁴ dz are polynomials:

            m = π ρ L (a² + ab + b²)/3,  I_a = (π ρ L/2) (a⁴ + a³b + a²b² + ab³ + b⁴)/5.
        """
        a, b, length = self.radius, self.top_radius, self.top - self.bottom
        area = (a * a + a * b + b * b) / 3.0
        first = (a * a + 2.0 * a * b + 3.0 * b * b) / 12.0
        second = (a * a + 3.0 * a * b + 6.0 * b * b) / 30.0
        line_density, share = density * math.pi * length, first / area
        axial = line_density * (a**4 + a**3 * b + a * a * b * b + a * b**3 + b**4) / 10.0
        about_centre = line_density * length * length * (second - first * share)
        height = self.bottom + length * share
        return MassProperties(line_density * area, height, axial / 2.0 + about_centre, axial)


def frustums(heights: Sequence[float], radii: Sequence[float], *, above: float = -math.inf) -> Iterator[Frustum]:
    """Yield the slices of the body that an outline encloses, without those below a height `above` [m].

    Parameters
    ----------
    heights
        Heights of the corners of the outline, not falling [m]; two corners at one height are a step.
    radii
        Radii there [m]. The outline encloses nothing where it is negative.
    """
    for (bottom, a), (top, b) in pairwise(zip(heights, radii, strict=True)):
        if top <= max(bottom, above):
            continue
        rise = (b - a) / (top - bottom)
        ends = sorted({max(bottom, above), top, *([bottom - a / rise] if a * b < 0.0 else [])})
        for low, high in pairwise(one for one in ends if one >= above):
            first, last = (b if at == top else a + rise * (at - bottom) for at in (low, high))
            if first + last > 0.0:
                yield Frustum(low, high, max(first, 0.0), max(last, 0.0))
