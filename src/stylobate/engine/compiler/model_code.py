"""A model's functions as code: compiled with all that they call, and told apart by what they say."""

import dis
import hashlib
import itertools
import types
from collections.abc import Callable, Iterator, Mapping
from enum import Enum
from typing import Any

import numpy as np

Function = Callable[..., Any]

# What stands in these packages is taken as it is.
_LIBRARIES = ("numpy",)

_number = itertools.count()


def fingerprint(function: Function) -> str:
    """Return a digest of what `function` computes: its code, the constants and the functions that it uses."""
    digest = hashlib.sha256()
    for said in _parts(plain_function(function), set()):
        digest.update(said.encode())
        digest.update(b"\0")
    return digest.hexdigest()


def _parts(function: types.FunctionType, seen: set[types.CodeType]) -> Iterator[str]:
    code = function.__code__
    if code in seen:
        return
    seen.add(code)
    yield from _code_parts(code)
    yield repr(function.__defaults__)
    for cell in function.__closure__ or ():
        yield from _value_parts(cell.cell_contents, seen)
    for name in code.co_names:
        value = function.__globals__.get(name)
        yield name
        if isinstance(value, types.ModuleType):
            for attribute in code.co_names:
                if hasattr(value, attribute):
                    yield from _value_parts(getattr(value, attribute), seen)
        else:
            yield from _value_parts(value, seen)
    for name, called in called_functions(function):
        yield name
        yield from _value_parts(called, seen)


def _value_parts(value: object, seen: set[types.CodeType]) -> Iterator[str]:
    plain = getattr(value, "py_func", value)
    if isinstance(plain, types.FunctionType):
        yield from _parts(plain, seen)
    else:
        yield _said(value)


def _said(value: object) -> str:
    """Return what tells a constant from another one; functions are told by what they say elsewhere."""
    if isinstance(value, np.ndarray):
        return f"{value.dtype} {value.shape} {value.tobytes().hex()}"
    if isinstance(value, tuple):
        return f"({', '.join(map(_said, value))})"
    said = isinstance(value, (bool, int, float, complex, str, np.generic, Enum))
    return repr(value) if said else type(value).__name__


def _code_parts(code: types.CodeType) -> Iterator[str]:
    yield code.co_code.hex()
    yield repr(code.co_names)
    yield repr(code.co_varnames)
    for constant in code.co_consts:
        if isinstance(constant, types.CodeType):
            yield from _code_parts(constant)
        else:
            yield repr(constant)


def called_functions(function: types.FunctionType) -> list[tuple[str, Function]]:
    """Return the plain functions that `function` calls, by names of its module such as f, module.f or Class.f."""
    found: dict[str, Function] = {}
    for name in _global_names(function.__code__):
        root, *path = name.split(".")
        value = function.__globals__.get(root)
        for attribute in path:
            value = getattr(value, attribute, None) if isinstance(value, (types.ModuleType, type)) else None
        plain = getattr(value, "py_func", value)
        if isinstance(plain, types.FunctionType) and plain.__module__.split(".")[0] not in _LIBRARIES:
            found[name] = plain
    return list(found.items())


def _global_names(code: types.CodeType) -> Iterator[str]:
    """Return the names that `code` looks up in its module, with the attributes that it takes of them: `math.pi`."""
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


def with_functions(names: Mapping[str, Any], functions: Mapping[str, Function], code: types.CodeType) -> dict[str, Any]:
    """Return `names` with these functions in their places.

    Numba looks into modules, not into classes: for a function called as Class.f, or as module.f, a module takes the
    place of what it stands in, with all that the `code` uses of it.
    """
    names = dict(names)
    spaces: dict[str, types.ModuleType] = {}

    def space(path: str) -> types.ModuleType:
        if path not in spaces:
            outer, _, name = path.rpartition(".")
            holder = vars(space(outer)) if outer else names
            original = holder.get(name)
            made = types.ModuleType(f"{name} {next(_number)}")
            vars(made).update((part, getattr(original, part)) for part in code.co_names if hasattr(original, part))
            holder[name] = spaces[path] = made
        return spaces[path]

    for dotted, function in functions.items():
        path, _, name = dotted.rpartition(".")
        (vars(space(path)) if path else names)[name] = function
    return names


def plain_function(function: Function) -> types.FunctionType:
    """Return the Python function behind one that the user compiled already."""
    plain = getattr(function, "py_func", function)
    assert isinstance(plain, types.FunctionType)
    return plain
