"""A model's functions as code: compiled with all that they call, and told apart by what they say."""

import dis
import hashlib
import inspect
import itertools
import types
from collections.abc import Callable, Iterator, Mapping
from enum import Enum
from typing import Any

import numpy as np

from stylobate.engine.compiling.arithmetic import part

Function = Callable[..., Any]

# Numba has its own versions of what stands in these packages.
_KNOWN_TO_NUMBA = ("numpy", "numba")

# Numba takes two modules of one name for the same.
_number = itertools.count()


def for_compiling(
    function: Function,
    compiled: Callable[[Function], Function],
    within: tuple[types.CodeType, ...] = (),
    known: dict[tuple[types.FunctionType, Callable[[Function], Function]], Function] | None = None,
) -> Function:
    """Return `function` compiled, and with it the plain functions that it calls, each of them once.

    Raises
    ------
    RecursionError
        If it calls itself, one of the functions that it is called `within`.
    """
    plain = plain_function(function)
    if plain.__code__ in within:
        message = f"{plain.__name__} calls itself; write it as a loop"
        raise RecursionError(message)
    within = (*within, plain.__code__)
    if plain.__code__.co_flags & inspect.CO_VARARGS:
        compiled = part  # Numba's own inlining knows no *arguments: left to the compiler behind it
    known = {} if known is None else known
    if (plain, compiled) in known:
        return known[plain, compiled]
    called = {name: for_compiling(value, compiled, within, known) for name, value in called_functions(plain)}
    # A process that reads the machine code imports the modules of its functions: this one is there in all of them.
    names = with_functions({**plain.__globals__, "__name__": __name__}, called, plain.__code__)
    copy = types.FunctionType(plain.__code__, names, plain.__name__, plain.__defaults__, plain.__closure__)
    copy.__module__ = __name__
    known[plain, compiled] = compiled(copy)
    return known[plain, compiled]


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
        if isinstance(plain, types.FunctionType) and plain.__module__.split(".")[0] not in _KNOWN_TO_NUMBA:
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
