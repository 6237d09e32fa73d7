"""Descriptions of models, told apart by their `kind`."""

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field

from stylobate.column import Column
from stylobate.errors import UnsupportedError
from stylobate.models import Model, PlanarRocking, Rolling, Slender, SlenderRolling, Sliding, Wobbling
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


class WobblingModel(Description):
    """The column at finite tilt that cannot turn."""

    kind: Literal["wobbling"] = "wobbling"
    damping: float = 0.0
    rolling_resistance: float = 0.0
    restitution: float = 1.0
    passage_tilt: float | None = None
    constraint: Literal["pure_tilt", "rubber"] = "pure_tilt"

    def build(self, column: Column) -> Model:
        """Return the model of `column`."""
        return Wobbling(column, **self.model_dump(exclude={"kind"}))


class RollingModel(Description):
    """The column at finite tilt that rolls and may turn."""

    kind: Literal["rolling"] = "rolling"
    damping: float = 0.0
    spin_friction: float = 0.0
    rolling_resistance: float = 0.0
    restitution: float = 1.0
    passage_tilt: float | None = None

    def build(self, column: Column) -> Model:
        """Return the model of `column`."""
        return Rolling(column, **self.model_dump(exclude={"kind"}))


class SlidingModel(Description):
    """The column that can slip, pivot, lift off and land."""

    kind: Literal["sliding"] = "sliding"
    friction_coefficient: float = 0.5
    static_friction_coefficient: float | None = None
    patch: float = 0.0
    restitution: float = 0.0
    damping: float = 0.0
    spin_friction: float = 0.0
    rolling_resistance: float = 0.0
    passage_tilt: float | None = None
    incline: float = 0.0
    incline_direction: float = 0.0

    def build(self, column: Column) -> Model:
        """Return the model of `column`."""
        return Sliding(column, **self.model_dump(exclude={"kind"}))


class PlanarRockingModel(Description):
    """The column that rocks in a vertical plane; `restitution` is Housner's where it is not given."""

    kind: Literal["planar_rocking"] = "planar_rocking"
    damping: float = 0.0
    rolling_resistance: float = 0.0
    restitution: float | None = None

    def build(self, column: Column) -> Model:
        """Return the model of `column`."""
        return PlanarRocking(column, **self.model_dump(exclude={"kind"}))


def _with_kind(described: Any) -> Any:
    """Return the values of a model with its kind; it is the slender one where none is told."""
    return {"kind": "slender", **described} if isinstance(described, dict) else described


ModelDescription = Annotated[
    Annotated[
        SlenderModel | SlenderRollingModel | WobblingModel | RollingModel | SlidingModel | PlanarRockingModel,
        Field(discriminator="kind"),
    ],
    BeforeValidator(_with_kind),
]


def known_values(described: Mapping[str, Any], kind: str) -> dict[str, Any]:
    """Return those of the `described` values of a model that one of this `kind` knows, all if there is no such kind."""
    one = _BY_KIND.get(kind)
    return {name: value for name, value in described.items() if one is None or name in one.model_fields}


def kinds_with(name: str) -> tuple[str, ...]:
    """Return the kinds of model that have a number of this `name`."""
    return tuple(kind for kind, one in _BY_KIND.items() if name in one.model_fields)


def default_values(kind: str) -> dict[str, Any]:
    """Return what a description of this `kind` has where nothing is given; nothing if there is no such kind."""
    one = _BY_KIND.get(kind)
    return {} if one is None else one().model_dump()


def describe_model(model: Model) -> Description:
    """Return the description of `model`, its column apart.

    Raises
    ------
    UnsupportedError
        If the model is of a class that descriptions do not know.
    """
    described = _DESCRIPTIONS.get(type(model))  # a subclass is another model
    if described is not None:
        return described(**{name: getattr(model, name) for name in described.model_fields if name != "kind"})
    message = f"a model of class {type(model).__name__} has no description; results keep its repr only"
    raise UnsupportedError(message)


_DESCRIPTIONS: Mapping[type[Model], type[Description]] = {
    Slender: SlenderModel,
    SlenderRolling: SlenderRollingModel,
    Wobbling: WobblingModel,
    Rolling: RollingModel,
    Sliding: SlidingModel,
    PlanarRocking: PlanarRockingModel,
}

DESCRIBED_MODELS: tuple[type[Description], ...] = tuple(_DESCRIPTIONS.values())
"""The descriptions of all models."""

_BY_KIND: Mapping[str, type[Description]] = {one.model_fields["kind"].default: one for one in DESCRIBED_MODELS}
