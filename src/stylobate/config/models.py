"""Describe models by the declarations of their numbers; the key `kind` chooses the model."""

from collections.abc import Mapping
from functools import partial
from typing import TYPE_CHECKING, Annotated, Any

from pydantic import BeforeValidator

from stylobate.column import Column
from stylobate.config.declared import config_of_kind, configs_of, one_of
from stylobate.config.description import Config
from stylobate.kinds import Place
from stylobate.models import Model
from stylobate.models.declared import MODELS
from stylobate.quantities import parameters_of


class DescribedModel(Config):
    """A model without its column."""

    kind: str

    def build(self, column: Column) -> Model:
        """Build the model of `column`, for which words in place of numbers are computed."""
        declared = parameters_of(self.make)
        stated = self.model_dump(exclude={"kind"})
        model: Model = self.make(
            column, **{name: declared[name].quantity.for_column(one, column) for name, one in stated.items()}
        )
        return model


_BY_KIND = configs_of(DescribedModel, "kind", MODELS)

DESCRIBED_MODELS: tuple[type[Config], ...] = tuple(_BY_KIND.values())
"""The descriptions of all models."""


DEFAULT_MODEL = "wobbling"
"""Kind of a model that states none."""

STEADY_MODEL = "slender"
"""Kind of a model that states none where closed forms of steady rolling are compared with it."""


def _with_kind(kind: str, described: Any) -> Any:
    """Return the values of a model with its kind, which is `kind` if they state none."""
    return {"kind": kind, **described} if isinstance(described, Mapping) else described


def _of_own(place: Place) -> type[DescribedModel]:
    """Return the description class of a user's own model."""
    return config_of_kind(DescribedModel, "kind", place, MODELS[place])


if TYPE_CHECKING:
    ModelConfig = DescribedModel
    SteadyModelConfig = DescribedModel
else:
    _Any = one_of(DESCRIBED_MODELS, "kind", _of_own)
    ModelConfig = Annotated[_Any, BeforeValidator(partial(_with_kind, DEFAULT_MODEL))]
    SteadyModelConfig = Annotated[_Any, BeforeValidator(partial(_with_kind, STEADY_MODEL))]


def described_model(kind: str, **values: Any) -> DescribedModel:
    """Return the description of a model of this `kind`, with defaults for missing values."""
    return _BY_KIND[kind](**{"kind": kind, **values})


def default_values(kind: str) -> dict[str, Any]:
    """Return the default values of a description of this `kind`; empty if there is no such kind."""
    return described_model(kind).model_dump() if kind in MODELS else {}
