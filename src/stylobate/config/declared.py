"""Descriptions made from declared numbers: the kind, its class or constructor, and the numbers that it takes."""

from collections.abc import Callable, Iterable, Mapping
from typing import Annotated, Any, Literal, TypeVar, Union

from pydantic import Field, SerializeAsAny, TypeAdapter, ValidationError, WrapValidator, create_model
from pydantic_core import PydanticCustomError

from stylobate.config.description import Config
from stylobate.kinds import Place
from stylobate.quantities import Parameter, Quantity, parameters_of

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
