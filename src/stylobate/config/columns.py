"""Describe columns by the declarations of their numbers; the key `shape` chooses the shape."""

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Annotated, Any

from pydantic import BeforeValidator

from stylobate.column import SHAPES, Column
from stylobate.config.declared import configs_of, one_of
from stylobate.config.description import Config
from stylobate.quantities import parameters_of


class DescribedColumn(Config):
    """A column by the numbers of its shape."""

    shape: str

    def build(self) -> Column:
        """Return the column."""
        column: Column = self.make(**self.model_dump(exclude={"shape"}))
        return column


_BY_SHAPE = configs_of(DescribedColumn, "shape", SHAPES)


def implied_shape(names: Iterable[str]) -> str | None:
    """Return the shape to which one of these `names` belongs exclusively, or None."""
    given = set(names)
    for shape, make in SHAPES.items():
        others = {name for other in SHAPES.values() if other is not make for name in parameters_of(other)}
        if given & (parameters_of(make).keys() - others):
            return shape
    return None


def is_dimensionless(described: Any) -> bool:
    """Return whether plain values describe a column with m = g = ω0 = 1."""
    return isinstance(described, Mapping) and _with_shape(described)["shape"] == "dimensionless"


def _with_shape(described: Any) -> Any:
    """Add the shape that the numbers imply to the values of a column without one; solid by default."""
    return {"shape": implied_shape(described) or "solid", **described} if isinstance(described, Mapping) else described


if TYPE_CHECKING:
    ColumnConfig = DescribedColumn
else:
    ColumnConfig = Annotated[one_of(_BY_SHAPE.values(), "shape"), BeforeValidator(_with_shape)]

ANY_COLUMN = Column.dimensionless(0.1)
"""Substitute for a column that cannot be built, so that mistakes in the model are reported too."""
