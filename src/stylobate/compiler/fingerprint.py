"""Fingerprints of functions: digests of their code and of the constants and functions that they use."""

import dis
import hashlib
import types
from collections.abc import Callable, Iterator, Mapping
from enum import Enum
from typing import Any

import numpy as np

from stylobate.compiler.marks import is_fast
from stylobate.compiler.sources import plain_function

Function = Callable[..., Any]

_VERSIONED = ("stylobate", "builtins", "abc", "typing", "enum", "numpy")
"""Packages whose classes a user does not change."""


def fingerprint(function: Function) -> str:
    """Return a digest of `function`: its code, and the constants and functions that it uses."""
    digest = hashlib.sha256()
    for part in _parts(plain_function(function), set()):
        digest.update(part.encode())
        digest.update(b"\0")
    return digest.hexdigest()


def _parts(function: types.FunctionType, seen: set[int]) -> Iterator[str]:
    if id(function) in seen:
        return
    seen.add(id(function))
    code = function.__code__
    yield from code_parts(code)
    yield f"fast {is_fast(function)}"
    yield from _value_parts(function.__defaults__ or (), seen)
    yield from _value_parts(tuple(sorted((function.__kwdefaults__ or {}).items())), seen)
    for cell in function.__closure__ or ():
        yield from _value_parts(cell.cell_contents, seen)
    for dotted in global_names(code):
        yield dotted
        for value in _along(function.__globals__, dotted):
            yield from _value_parts(value, seen)


def _along(names: Mapping[str, Any], dotted: str) -> Iterator[object]:
    """Yield the objects along a name such as f, module.f or Class.constant."""
    root, *path = dotted.split(".")
    value = names.get(root)
    yield value
    for attribute in path:
        value = getattr(value, attribute, None)
        yield value


def _value_parts(value: object, seen: set[int]) -> Iterator[str]:
    plain = getattr(value, "py_func", value)
    if isinstance(plain, types.FunctionType):
        yield from _parts(plain, seen)
    elif isinstance(plain, tuple | list):
        yield f"{type(plain).__name__} of {len(plain)}"
        for part in plain:
            yield from _value_parts(part, seen)
    elif isinstance(plain, type) and hasattr(plain, "_fields"):
        yield f"{plain.__name__} {plain._fields}"
        yield from _value_parts(tuple(plain._field_defaults.items()), seen)  # type: ignore[attr-defined]
    else:
        yield _described(plain)
        yield from _attribute_parts(plain, seen)


def _attribute_parts(thing: object, seen: set[int]) -> Iterator[str]:
    """Yield the values that belong to an object or class of the user; functions count where they are called."""
    kind = thing if isinstance(thing, type) else type(thing)
    if id(thing) in seen or isinstance(thing, types.ModuleType) or kind.__module__.split(".")[0] in _VERSIONED:
        return
    seen.add(id(thing))
    for name, value in sorted(getattr(thing, "__dict__", {}).items()):
        if not (name.startswith("__") or callable(value) or isinstance(value, staticmethod | classmethod | property)):
            yield name
            yield from _value_parts(value, seen)


def _described(value: object) -> str:
    """Return a text that differs between different constants."""
    if isinstance(value, np.ndarray):
        return f"{value.dtype} {value.shape} {value.tobytes().hex()}"
    if isinstance(value, Enum):
        return f"{value!r} {value.value!r}"
    if isinstance(value, bool | int | float | complex | str | np.generic | range | None):
        return repr(value)
    return str(getattr(value, "__qualname__", type(value).__qualname__))


def code_parts(code: types.CodeType) -> Iterator[str]:
    """Yield texts that differ between different codes, without the names of file and function."""
    yield code.co_code.hex()
    yield repr((code.co_names, code.co_varnames, code.co_freevars, code.co_cellvars))
    yield repr((code.co_argcount, code.co_posonlyargcount, code.co_kwonlyargcount, code.co_flags))
    for constant in code.co_consts:
        if isinstance(constant, types.CodeType):
            yield from code_parts(constant)
        else:
            yield repr(constant)


def global_names(code: types.CodeType) -> Iterator[str]:
    """Yield the names that `code`, generators included, looks up in its module, with attributes, such as `math.pi`."""
    name = ""
    for instruction in dis.get_instructions(code):
        if instruction.opname == "LOAD_GLOBAL":
            if name:
                yield name
            name = instruction.argval
        elif name and instruction.opname in ("LOAD_ATTR", "LOAD_METHOD"):
            name += f".{instruction.argval}"
        elif name:
            yield name
            name = ""
    for constant in code.co_consts:
        if isinstance(constant, types.CodeType):
            yield from global_names(constant)
