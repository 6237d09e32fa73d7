"""Shape of the column in figures and animations, from the parameters of a run."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

from stylobate.column import Height, MassHeight, Radius, Slenderness, TopRadius
from stylobate.results import Response

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
    """

    radius: Radius
    top_radius: TopRadius
    height: Height
    mass_height: MassHeight
    slenderness: Slenderness

    @classmethod
    def of(cls, run: Response) -> Self:
        """Return the shape of the column of `run`."""
        return cls.of_column(run.provenance["column"])

    @classmethod
    def of_column(cls, column: Mapping[str, Any]) -> Self:
        """Return the shape of a column with these fields: a frustum if its inertia is that of a solid one, else a tube.

        A tube is drawn as a cylinder.
        """
        radius, mass_height = float(column["radius"]), float(column["mass_height"])
        return cls(
            radius=radius,
            top_radius=_top_radius(column),
            height=float(column.get("height") or 2.0 * mass_height),
            mass_height=mass_height,
            slenderness=radius / mass_height,
        )


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
