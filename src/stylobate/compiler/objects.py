"""Objects in the compiler: values of dataclasses, whose fields are numbers, texts and other objects.

In compiled code an object is a named tuple of its fields, so that it is passed, returned and chosen like any tuple. Its
properties and methods are those of its class, compiled with the object as first argument. `__post_init__` is not
called: the numbers of an object have been checked before.
"""

import inspect
from collections import namedtuple
from collections.abc import Callable, Mapping, Sequence
from dataclasses import MISSING, dataclass, fields, is_dataclass
from functools import cache
from typing import Any

from stylobate.compiler.sources import Refusal


@dataclass(frozen=True, slots=True)
class Method:
    """A method of an object, or a class method, with its first argument."""

    function: Callable[..., Any]
    owner: Any


@cache
def structure_of(kind: type) -> Any:
    """Return the named tuple of the fields of a dataclass; its attribute `object_of` is the class."""
    structure: Any = namedtuple(kind.__name__, [one.name for one in fields(kind)])  # type: ignore[misc]  # noqa: PYI024
    structure.object_of = kind  # type: ignore[attr-defined]
    return structure


def is_object(value: object) -> bool:
    """Return whether a value is an object."""
    return isinstance(value, tuple) and hasattr(type(value), "object_of")


def is_class(value: object) -> bool:
    """Return whether a value is a dataclass that can be called for an object."""
    return isinstance(value, type) and is_dataclass(value)


def made(kind: type, values: Sequence[Any], keywords: Mapping[str, Any]) -> Any:
    """Return the object that a dataclass makes of these arguments."""
    declared = fields(kind)
    given = dict(zip((one.name for one in declared if one.init), values, strict=False)) | dict(keywords)
    found = {}
    for one in declared:
        if one.name in given:
            found[one.name] = given.pop(one.name)
        elif one.default is not MISSING:
            found[one.name] = one.default
        elif one.default_factory is not MISSING:
            found[one.name] = one.default_factory()
        else:
            raise Refusal(f"{kind.__name__} needs {one.name}")
    if given:
        raise Refusal(f"{kind.__name__} has no {next(iter(given))}")
    return structure_of(kind)(**found)


def changed(value: Any, **numbers: Any) -> Any:
    """Return an object with other values of some fields, as `dataclasses.replace` does."""
    if not is_object(value):
        raise Refusal(f"replace needs an object, not {value!r}")
    return value._replace(**numbers)


def member(owner: Any, name: str) -> tuple[str, Any]:
    """Return the meaning of a name in the class of an object: "property", "method" or "value", with function or value.

    Raises
    ------
    Refusal
        If the class has no such member.
    """
    kind = type(owner).object_of
    try:
        found = inspect.getattr_static(kind, name)
    except AttributeError:
        raise Refusal(f"{kind.__name__} has no {name}") from None
    if isinstance(found, property):
        return "property", found.fget
    if isinstance(found, classmethod):
        return "method", Method(found.__func__, kind)
    if inspect.isfunction(found):
        return "method", Method(found, owner)
    return "value", getattr(kind, name)
