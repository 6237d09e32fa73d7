"""Fingerprints of objects without a description: models and motions of user-defined classes."""

import hashlib
import inspect
import re
from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from types import ModuleType
from typing import Any

import numpy as np

from stylobate.compiler.reads import fingerprint
from stylobate.models import Model
from stylobate.quantities import exact_repr

# Packages whose classes are identified by their versions.
_NOT_ITS_OWN = ("stylobate", "builtins", "abc", "typing", "numpy")
# The functions of the protocol `Model` that ensembles compile and single runs call.
_STATIC_FUNCTIONS = (
    "rates",
    "lean",
    "planar_rates",
    "from_plane",
    "rest_energy",
    "no_return_tilt",
    "departure",
    "passage",
    "at_rest",
)
_ADDRESS = re.compile(r" at 0x[0-9a-f]+")


def identity_of(thing: object) -> dict[str, Any]:
    """Return an identity of `thing`, the same in every process: repr, class, hashes of its state and source.

    The source is that of all involved classes outside stylobate. Functions that these classes call are not included,
    except for a model's static functions: their code, and the code of functions that they call, is its equations.
    """
    equations = {"equations_sha256": _hash(_equations(thing))} if isinstance(thing, Model) else {}
    return {
        "kind": "other",
        "repr": _stable_repr(thing),
        "class": _name_of(type(thing)),
        "state_sha256": _hash(_state(thing)),
        "source_sha256": _hash(_sources(thing)),
        **equations,
    }


def _equations(model: Model) -> Iterator[str]:
    """Yield the fingerprints of the static functions with a model's physics."""
    for name in _STATIC_FUNCTIONS:
        if (function := getattr(model, name, None)) is not None:
            yield name
            yield fingerprint(function)


def _state(thing: Any, above: tuple[int, ...] = ()) -> Iterator[str]:
    """Yield the values of which `thing` consists; `above` are the objects that contain it."""
    if id(thing) in above:  # part of itself
        return
    above = (*above, id(thing))
    if isinstance(thing, np.ndarray) and thing.dtype != object:
        yield f"array {thing.dtype.str} {thing.shape}"
        yield hashlib.sha256(np.ascontiguousarray(thing).tobytes()).hexdigest()
    elif isinstance(thing, (list, tuple)):
        yield f"{type(thing).__name__} of {len(thing)}"
        for part in thing:
            yield from _state(part, above)
    elif isinstance(thing, Mapping):
        for name in sorted(thing, key=repr):
            yield f"{name!r}:"
            yield from _state(thing[name], above)
    elif isinstance(thing, type) or inspect.isroutine(thing):
        yield _name_of(thing)
        yield _source(thing)
    elif values := _values(thing):
        yield _name_of(type(thing))
        yield from _state(values, above)
    else:
        yield _stable_repr(thing.item() if isinstance(thing, np.generic) else thing)


def _values(thing: Any) -> dict[str, Any]:
    if isinstance(thing, (type, ModuleType)) or inspect.isroutine(thing):
        return {}
    if is_dataclass(thing):
        return {field.name: getattr(thing, field.name) for field in fields(thing)}
    return dict(getattr(thing, "__dict__", {}))


def _sources(thing: Any, above: tuple[int, ...] = ()) -> Iterator[str]:
    """Yield the sources of the classes of `thing` and of its parts, except classes of stylobate and of Python."""
    if id(thing) in above:
        return
    above = (*above, id(thing))
    for cls in type(thing).__mro__:
        if cls.__module__.partition(".")[0] not in _NOT_ITS_OWN:
            yield _source(cls)
    for part in thing if isinstance(thing, (list, tuple)) else _values(thing).values():
        yield from _sources(part, above)


def _source(thing: Any) -> str:
    try:
        return inspect.getsource(thing)
    except (OSError, TypeError):
        return ""


def _name_of(thing: Any) -> str:
    return f"{getattr(thing, '__module__', '')}.{getattr(thing, '__qualname__', '')}"


def _stable_repr(thing: object) -> str:
    return _ADDRESS.sub("", exact_repr(thing))


def _hash(parts: Iterator[str]) -> str:
    total = hashlib.sha256()
    for part in parts:
        total.update(part.encode())
        total.update(b"\0")
    return total.hexdigest()
