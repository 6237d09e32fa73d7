"""Descriptions of models, told apart by their `kind`."""

from typing import Annotated, Literal

from pydantic import Field

from stylobate.column import Column
from stylobate.errors import UnsupportedError
from stylobate.models import Model, Slender
from stylobate.spec.description import Description


class SlenderModel(Description):
    """The slender column that cannot turn; `damping` is the dimensionless η."""

    kind: Literal["slender"] = "slender"
    damping: float = 0.0

    def build(self, column: Column) -> Model:
        """Return the model of `column`."""
        return Slender(column, damping=self.damping)


# One kind so far: the discriminator is there for those to come.
ModelDescription = Annotated[SlenderModel, Field()]


def describe_model(model: Model) -> Description:
    """Return the description of `model`, its column apart.

    Raises
    ------
    UnsupportedError
        If the model is of a class that descriptions do not know.
    """
    if type(model) is Slender:  # a subclass is another model
        return SlenderModel(damping=model.damping)
    message = f"a model of class {type(model).__name__} has no description; results keep its repr only"
    raise UnsupportedError(message)
