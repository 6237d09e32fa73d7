"""Descriptions of models, told apart by their `kind`."""

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field

from stylobate.column import Column
from stylobate.errors import UnsupportedError
from stylobate.models import Model, Slender, SlenderRolling
from stylobate.spec.description import Description


class SlenderModel(Description):
    """The slender column that cannot turn; `damping` is the dimensionless η."""

    kind: Literal["slender"] = "slender"
    damping: float = 0.0

    def build(self, column: Column) -> Model:
        """Return the model of `column`."""
        return Slender(column, damping=self.damping)


class SlenderRollingModel(Description):
    """The slender column that rolls and may turn; `spin_friction` is the dimensionless ζ."""

    kind: Literal["slender_rolling"] = "slender_rolling"
    damping: float = 0.0
    spin_friction: float = 0.0
    couples: Literal["contact", "isotropic"] = "contact"

    def build(self, column: Column) -> Model:
        """Return the model of `column`."""
        return SlenderRolling(column, damping=self.damping, spin_friction=self.spin_friction, couples=self.couples)


def _with_kind(described: Any) -> Any:
    """Return the values of a model with its kind; it is the slender one where none is told."""
    return {"kind": "slender", **described} if isinstance(described, dict) else described


ModelDescription = Annotated[
    Annotated[SlenderModel | SlenderRollingModel, Field(discriminator="kind")], BeforeValidator(_with_kind)
]


def describe_model(model: Model) -> Description:
    """Return the description of `model`, its column apart.

    Raises
    ------
    UnsupportedError
        If the model is of a class that descriptions do not know.
    """
    if type(model) is Slender:  # a subclass is another model
        return SlenderModel(damping=model.damping)
    if type(model) is SlenderRolling:
        return SlenderRollingModel(damping=model.damping, spin_friction=model.spin_friction, couples=model.couples)
    message = f"a model of class {type(model).__name__} has no description; results keep its repr only"
    raise UnsupportedError(message)
