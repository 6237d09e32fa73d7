"""Descriptions made from declared numbers: of each kind its name, what makes it, and the numbers that it takes."""

from collections.abc import Callable, Iterable, Mapping
from typing import Annotated, Any, Literal, TypeVar, Union

from pydantic import Field, create_model

from stylobate.config.description import Config
from stylobate.quantities import Parameter, parameters_of

_D = TypeVar("_D", bound=Config)


def configs_of(base: type[_D], tag: str, kinds: Mapping[str, Callable[..., Any]]) -> Mapping[str, type[_D]]:
    """Return a description for each of the `kinds`, told apart by the value of the key `tag`.

    Parameters
    ----------
    base
        What descriptions of all kinds share, with a `build` that makes the thing.
    tag
        The key that holds the kind.
    kinds
        By name, the class or named constructor whose declared numbers are described. Their bounds are checked when
        the thing is built.
    """
    return {kind: _description_of(base, tag, kind, make) for kind, make in kinds.items()}


def one_of(descriptions: Iterable[type[Config]], tag: str) -> Any:
    """Return the annotation of a field that holds one of the `descriptions`, told apart by the key `tag`."""
    union: Any = Union[tuple(descriptions)]  # noqa: UP007  the members are not known before
    return Annotated[union, Field(discriminator=tag)]


def _description_of(base: type[_D], tag: str, kind: str, make: Callable[..., Any]) -> type[_D]:
    numbers = {name: (_type_of(one), ... if one.required else one.default) for name, one in parameters_of(make).items()}
    fields: dict[str, Any] = {tag: (Literal[kind], kind), **numbers}
    name = f"{kind.title().replace('_', '')}{base.__name__.removeprefix('Described')}"
    first_sentence = (make.__doc__ or "").partition("\n")[0]
    return create_model(name, __base__=base, __doc__=first_sentence, __module__=base.__module__, **fields)


def _type_of(parameter: Parameter) -> Any:
    count = parameter.quantity.components
    return parameter.annotation if count == 1 else tuple[(float,) * count]  # type: ignore[misc]
