"""Descriptions of columns, told apart by their `shape`."""

from collections.abc import Iterable, Mapping
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field

from stylobate.column import STANDARD_GRAVITY, Column
from stylobate.spec.description import Description


class SolidColumn(Description):
    """A solid cylinder; lengths in m, density in kg/m³."""

    shape: Literal["solid"] = "solid"
    radius: float
    height: float
    density: float
    gravity: float = STANDARD_GRAVITY

    def build(self) -> Column:
        """Return the column."""
        return Column.solid(radius=self.radius, height=self.height, density=self.density, gravity=self.gravity)


class HollowColumn(Description):
    """A tube; lengths in m, density in kg/m³."""

    shape: Literal["hollow"]
    radius: float
    inner_radius: float
    height: float
    density: float
    gravity: float = STANDARD_GRAVITY

    def build(self) -> Column:
        """Return the column."""
        return Column.hollow(
            radius=self.radius,
            inner_radius=self.inner_radius,
            height=self.height,
            density=self.density,
            gravity=self.gravity,
        )


class FrustumColumn(Description):
    """A frustum of a cone; lengths in m, density in kg/m³."""

    shape: Literal["frustum"]
    radius: float
    top_radius: float
    height: float
    density: float
    gravity: float = STANDARD_GRAVITY

    def build(self) -> Column:
        """Return the column."""
        return Column.frustum(
            radius=self.radius,
            top_radius=self.top_radius,
            height=self.height,
            density=self.density,
            gravity=self.gravity,
        )


class DimensionlessColumn(Description):
    """A column with m = g = ω0 = 1."""

    shape: Literal["dimensionless"]
    slenderness: float
    inertia_ratio: float = 0.75
    axial_ratio: float = 0.5

    def build(self) -> Column:
        """Return the column."""
        return Column.dimensionless(self.slenderness, self.inertia_ratio, self.axial_ratio)


class GivenColumn(Description):
    """Any body of revolution by its numbers, in SI units."""

    shape: Literal["given"]
    radius: float
    mass_height: float
    mass: float
    transverse_inertia: float
    axial_inertia: float
    height: float | None = None
    gravity: float = STANDARD_GRAVITY

    def build(self) -> Column:
        """Return the column."""
        return Column(**self.model_dump(exclude={"shape"}))

    @classmethod
    def of(cls, column: Column) -> "GivenColumn":
        """Return the description of `column`."""
        return cls(shape="given", **{name: getattr(column, name) for name in cls.model_fields if name != "shape"})


_SHAPES = {"slenderness": "dimensionless", "inner_radius": "hollow", "top_radius": "frustum", "mass_height": "given"}


def implied_shape(names: Iterable[str]) -> str | None:
    """Return the only shape that has one of the numbers of these `names`, or None."""
    return next((shape for name, shape in _SHAPES.items() if name in names), None)


def _with_shape(described: Any) -> Any:
    """Add the shape that the numbers imply to the values of a column without one; solid by default."""
    return {"shape": implied_shape(described) or "solid", **described} if isinstance(described, Mapping) else described


ColumnDescription = Annotated[
    Annotated[
        SolidColumn | HollowColumn | FrustumColumn | DimensionlessColumn | GivenColumn, Field(discriminator="shape")
    ],
    BeforeValidator(_with_shape),
]

ANY_COLUMN = Column.dimensionless(0.1)
"""Stands in for a column that cannot be built, so that mistakes in the model are told with it."""
