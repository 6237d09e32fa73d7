"""Columns, models and base motions in descriptions, from the declarations of their numbers; a key chooses the kind."""

import inspect
from collections.abc import Callable, Iterable, Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, TypeVar, Union

from pydantic import BeforeValidator, Field, SerializeAsAny, TypeAdapter, ValidationError, WrapValidator, create_model
from pydantic_core import PydanticCustomError

from stylobate.base_motions import BaseMotion, Record
from stylobate.base_motions.declared import MOTIONS
from stylobate.column import Column, Profile
from stylobate.column.shapes import SHAPES, SHAPES_IN_FILES, SHAPES_OF_PROFILES
from stylobate.config.description import Config, Metres
from stylobate.config.profile_table import Corners, is_table
from stylobate.config.records import RecordMotion
from stylobate.errors import ParameterError
from stylobate.kinds import Place, with_places
from stylobate.models import Model
from stylobate.models.declared import MODELS
from stylobate.provenance import values_of_motion
from stylobate.quantities import Parameter, Quantity, parameters_of, states
from stylobate.units import is_number, split

_D = TypeVar("_D", bound=Config)


def config_of_kind(base: type[_D], tag: str, kind: str, make: Callable[..., Any]) -> type[_D]:
    """Create the description class of a kind from the declared numbers of its class or constructor.

    Parameters
    ----------
    base
        Base class of the descriptions of all kinds, with a `build` that calls `make`.
    tag
        Key that holds the kind.
    kind
        Value of the key: a name, or the place of a user's own class.
    make
        Class or named constructor whose declared numbers are described. `build` checks their bounds.
    """
    numbers = {name: (_type_of(one), ... if one.required else one.default) for name, one in parameters_of(make).items()}
    fields: dict[str, Any] = {tag: (Literal[str(kind)], str(kind)), **numbers}
    room = next(one.__name__ for one in base.__mro__ if one.__name__.startswith("Described")).removeprefix("Described")
    name = f"{kind.rpartition(':')[2].title().replace('_', '')}{room}"
    first_sentence = (make.__doc__ or "").partition("\n")[0]
    found = create_model(name, __base__=base, __doc__=first_sentence, __module__=base.__module__, **fields)
    found.make = staticmethod(make)
    return found


def configs_of(base: type[_D], tag: str, kinds: Mapping[str, Callable[..., Any]]) -> Mapping[str, type[_D]]:
    """Create a description class for each of the `kinds`, told apart by the value of the key `tag`."""
    return {kind: config_of_kind(base, tag, kind, make) for kind, make in kinds.items()}


def one_of(descriptions: Iterable[type[Config]], tag: str, own: Callable[[Place], type[Config]] | None = None) -> Any:
    """Return the annotation of a field that holds one of the `descriptions`, told apart by the key `tag`.

    With `own`, which describes a user's own class, the key can also hold the place of such a class.
    """
    union: Any = Union[tuple(descriptions)]  # noqa: UP007  the members are known only at run time

    def read(value: Any, registered: Callable[[Any], Any]) -> Any:
        kind = value.get(tag) if isinstance(value, Mapping) else None
        if own is None or not isinstance(kind, Place):
            return registered(value)
        try:
            return own(kind).model_validate({**value, tag: str(kind)})
        except ValidationError as error:
            raise _under(kind, error) from None

    return Annotated[union, Field(discriminator=tag), WrapValidator(read), SerializeAsAny()]  # type: ignore[type-arg]


def _under(kind: str, error: ValidationError) -> ValidationError:
    """Return the error with its lines under the kind, as for a registered kind."""
    lines: list[Any] = [
        {"type": one["type"], "loc": (kind, *one["loc"]), "input": one["input"], "ctx": one.get("ctx", {})}
        for one in error.errors()
    ]
    return ValidationError.from_exception_data(error.title, lines)


def _type_of(parameter: Parameter) -> Any:
    quantity = parameter.quantity
    kind = tuple[(float,) * quantity.components] if quantity.components > 1 else parameter.annotation  # type: ignore[misc]
    return Annotated[number_or_word(quantity) if quantity.by_word else kind, quantity]


def number_or_word(quantity: Quantity) -> Any:
    """Return the annotation of a number in place of which a description can state one of the quantity's words."""
    words = tuple(quantity.by_word)

    def read(value: Any, _: object) -> Any:
        if isinstance(value, str) and value in words:
            return value
        try:
            return _NUMBER.validate_python(value)
        except ValidationError:
            raise PydanticCustomError(
                "number_or_word", f"must be a number or {' or '.join(map(repr, words))}"
            ) from None

    return Annotated[float | Literal[words], WrapValidator(read)]


_NUMBER: TypeAdapter[float] = TypeAdapter(float)


class DescribedColumn(Config):
    """A column by the numbers of its shape."""

    shape: str

    @property
    def constructor(self) -> Callable[..., Column]:
        """The constructor, which takes the numbers."""
        return self.make

    def numbers(self) -> dict[str, Any]:
        """Return the arguments of the constructor."""
        return self.model_dump(exclude={"shape"})

    def build(self) -> Column:
        """Return the column."""
        return self.constructor(**self.numbers())


class ProfileConfig(Config):
    """The profile of a column that is stated by its mass and inertia, as results keep it."""

    name: str = ""
    heights: tuple[float, ...] = ()
    radii: tuple[float, ...] = ()
    transverse_spread: float = 0.0
    axial_spread: float = 0.0


class ColumnOfInertia(DescribedColumn):
    """A column by its mass and inertia, with its profile if results know it."""

    profile: ProfileConfig | None = None

    def numbers(self) -> dict[str, Any]:
        """Return the arguments of the constructor."""
        own = self.profile
        numbers = self.model_dump(exclude={"shape", "profile"})
        return numbers if own is None else {**numbers, "profile": Profile(**own.model_dump())}


class ColumnOfProfile(DescribedColumn):
    """A column by the corners of its profile, from a file or listed, and numbers."""

    heights: tuple[Metres, ...] = ()
    radii: tuple[Metres, ...] = ()
    inner_radii: tuple[Metres, ...] | None = None
    profile: str = ""

    @property
    def constructor(self) -> Callable[..., Column]:
        """The constructor with its corners; raise FileError if the file of the profile cannot be read."""
        if self.heights or self.radii:
            return Corners(self.heights, self.radii, self.inner_radii).constructor(self.profile)
        if not self.profile:
            raise ParameterError("profile: missing. Name the file of its table, or list heights and radii.")
        path = Path(self.profile)
        return Corners.read(path).constructor(path.name)

    def numbers(self) -> dict[str, Any]:
        """Return the arguments that the constructor still needs."""
        return self.model_dump(exclude={"shape", "heights", "radii", "inner_radii", "profile"})


class ColumnOfColumns(DescribedColumn):
    """Several columns as one rigid body, and numbers."""

    parts: tuple["ColumnConfig", ...]
    elevations: tuple[Annotated[float, Quantity(unit="m")], ...] | None = None

    def build(self) -> Column:
        """Return the column."""
        numbers = self.model_dump(exclude={"shape", "parts"})
        column: Column = self.make([one.build() for one in self.parts], **numbers)
        return column


def _column_config(shape: str, make: Callable[..., Column]) -> type[Config]:
    """Return the description class of a shape; one that is made of columns describes them too."""
    named = inspect.signature(make).parameters
    bases: dict[str, type[DescribedColumn]] = {
        "parts": ColumnOfColumns,
        "radii": ColumnOfProfile,
        "transverse_inertia": ColumnOfInertia,
    }
    base: type[DescribedColumn] = next((one for name, one in bases.items() if name in named), DescribedColumn)
    return config_of_kind(base, "shape", shape, make)


_BY_SHAPE = {
    shape: _column_config(shape, make) for shape, make in {**SHAPES, **SHAPES_OF_PROFILES, **SHAPES_IN_FILES}.items()
}


def implied_shape(numbers: Mapping[str, Any]) -> str | None:
    """Return the shape to which a name of these `numbers` belongs exclusively, or None; shapes of files come first.

    A profile implies one of its shapes: a file is drawn, and a kind is estimated.
    """
    given = set(numbers)
    if isinstance(profile := numbers.get("profile"), str):
        return "profile" if is_table(profile) or given & _CORNERS else "estimated"
    for shape, make in SHAPES_OF_PROFILES.items():
        others = {name for other in _OTHERS for name in _names_of(other)}
        others |= {name for other in SHAPES_OF_PROFILES.values() if other is not make for name in _names_of(other)}
        if given & (_names_of(make) - others):
            return shape
    for shapes, among in ((SHAPES_IN_FILES, {**SHAPES, **SHAPES_IN_FILES}), (SHAPES, SHAPES)):
        for shape, make in shapes.items():
            others = {name for other in among.values() if other is not make for name in _names_of(other)}
            if given & (_names_of(make) - others):
                return shape
    return None


_OTHERS = (*SHAPES.values(), *SHAPES_IN_FILES.values())
_CORNERS = {"heights", "radii"}


def _names_of(make: Callable[..., Column]) -> set[str]:
    return set(inspect.signature(make).parameters)


def is_dimensionless(described: Any) -> bool:
    """Return whether plain values describe a column with m = g = ω0 = 1."""
    return isinstance(described, Mapping) and _with_shape(described)["shape"] == "dimensionless"


def _with_shape(described: Any) -> Any:
    """Add the shape that the numbers imply to the values of a column without one, solid by default; halve diameters."""
    if not isinstance(described, Mapping):
        return described
    numbers = {name: value for name, value in described.items() if name not in DIAMETERS}
    for name, radius in DIAMETERS.items():
        if name in described and radius in described:
            raise ParameterError(f"column: {name} and {radius} must not both be given. Remove one")
        if name in described:
            numbers[radius] = _half(described[name])
    return {"shape": implied_shape(numbers) or "solid", **numbers}


DIAMETERS = {
    "diameter": "radius",
    "inner_diameter": "inner_radius",
    "top_diameter": "top_radius",
    "max_diameter": "max_radius",
}
"""Lengths that files may state in place of radii."""


def _half(length: Any) -> Any:
    """Return half of a length; text with a unit keeps it, and what is no number is left to the check of radii."""
    if isinstance(length, str) and is_number(length):
        number, unit = split(length)
        return f"{0.5 * float(number)!r} {unit}".strip()
    return 0.5 * length if isinstance(length, (int, float)) and not isinstance(length, bool) else length


if TYPE_CHECKING:
    ColumnConfig = DescribedColumn
else:
    ColumnConfig = Annotated[one_of(_BY_SHAPE.values(), "shape"), BeforeValidator(_with_shape)]

ANY_COLUMN = Column.dimensionless(0.1)
"""Substitute for a column that cannot be built, so that mistakes in the model are reported too."""


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


_MODELS_BY_KIND = configs_of(DescribedModel, "kind", MODELS)

DESCRIBED_MODELS: tuple[type[Config], ...] = tuple(_MODELS_BY_KIND.values())
"""The descriptions of all models."""


DEFAULT_MODEL = "wobbling"
"""Kind of a model that states none."""

STEADY_MODEL = "slender"
"""Kind of a model that states none where closed forms of steady rolling are compared with it."""


def _with_kind(kind: str, described: Any) -> Any:
    """Return the values of a model with its kind, which is `kind` if they state none."""
    return {"kind": kind, **described} if isinstance(described, Mapping) else described


def _own_model(place: Place) -> type[DescribedModel]:
    """Return the description class of a user's own model."""
    return config_of_kind(DescribedModel, "kind", place, MODELS[place])


if TYPE_CHECKING:
    ModelConfig = DescribedModel
    SteadyModelConfig = DescribedModel
else:
    _Any = one_of(DESCRIBED_MODELS, "kind", _own_model)
    ModelConfig = Annotated[_Any, BeforeValidator(partial(_with_kind, DEFAULT_MODEL))]
    SteadyModelConfig = Annotated[_Any, BeforeValidator(partial(_with_kind, STEADY_MODEL))]


def described_model(kind: str, **values: Any) -> DescribedModel:
    """Return the description of a model of this `kind`, with defaults for missing values."""
    return _MODELS_BY_KIND[kind](**{"kind": kind, **values})


def default_values(kind: str) -> dict[str, Any]:
    """Return the default values of a description of this `kind`; empty if there is no such kind."""
    return described_model(kind).model_dump() if kind in MODELS else {}


class DescribedMotion(Config):
    """A base motion by the numbers of its kind."""

    kind: str

    def build(self) -> BaseMotion:
        """Return the motion."""
        motion: BaseMotion = self.make(**self._numbers())
        return motion

    def _numbers(self) -> dict[str, Any]:
        return {name: value for name, value in self if name not in ("kind", "motion", "motions")}


class MotionOfMotions(DescribedMotion):
    """Several motions, and numbers."""

    motions: tuple["MotionConfig", ...]

    def build(self) -> BaseMotion:
        """Return the motion."""
        motion: BaseMotion = self.make(motions=tuple(one.build() for one in self.motions), **self._numbers())
        return motion


class ChangedMotion(DescribedMotion):
    """Another motion, and numbers of its change: by a method of the motion, or by a user's own class."""

    motion: "MotionConfig"

    def build(self) -> BaseMotion:
        """Return the motion."""
        inner = self.motion.build()
        change = self.make if isinstance(self.make, type) else getattr(inner, self.make.__name__)
        of = {"motion": inner} if isinstance(self.make, type) else {}
        motion: BaseMotion = change(**of, **self._numbers())
        return motion


def _config(kind: str, make: Callable[..., Any]) -> type[Config]:
    """Return the description class of a kind of motion; that of a record reads files."""
    if make is Record:
        return RecordMotion
    arguments = inspect.signature(make).parameters
    several, changed = "motions" in arguments, "motion" in arguments or "self" in arguments
    base = MotionOfMotions if several else ChangedMotion if changed else DescribedMotion
    return config_of_kind(base, "kind", kind, make)


def _own_motion(place: Place) -> type[Config]:
    """Return the description class of a user's own motion."""
    return _config(place, MOTIONS[place])


_MOTIONS_BY_KIND = {kind: _config(kind, make) for kind, make in MOTIONS.items()}

if TYPE_CHECKING:
    MotionConfig = DescribedMotion
else:
    MotionConfig = one_of(_MOTIONS_BY_KIND.values(), "kind", _own_motion)

AT_REST: Any = _MOTIONS_BY_KIND["rest"].parse({"kind": "rest"})
"""The description of a base at rest."""


def is_to_end(motion: object) -> bool:
    """Return whether a `motion`, described or in plain values, ends.

    Its class states so by `ends`; a motion made of motions ends if all of them end.
    """
    values = dict(motion) if isinstance(motion, (Mapping, Config)) else {}
    members = values.get("motions", [values["motion"]] if "motion" in values else None)
    if members is not None:
        return isinstance(members, (list, tuple)) and bool(members) and all(is_to_end(one) for one in members)
    make = motion.make if isinstance(motion, Config) else made_by(values.get("kind"))
    return states(make, "ends")


def moves(motion: object) -> bool:
    """Return whether a `motion`, described or in plain values, is not a base at rest."""
    values = dict(motion) if isinstance(motion, (Mapping, Config)) else {}
    return str(values.get("kind", "rest")) != "rest"


def made_by(kind: object) -> Callable[..., Any] | None:
    """Return the class or constructor of a kind of motion in plain values; None for an unknown kind."""
    return MOTIONS[kind] if isinstance(kind, Place) or (isinstance(kind, str) and kind in MOTIONS) else None


def describe_motion(motion: BaseMotion) -> Config:
    """Return the description of `motion`; raise UnsupportedError if there is none."""
    values = with_places(values_of_motion(motion))
    kind = values["kind"]
    config = _MOTIONS_BY_KIND[kind] if kind in _MOTIONS_BY_KIND else _own_motion(kind)
    return config.parse({**values, "kind": str(kind)})
