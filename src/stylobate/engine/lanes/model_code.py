"""A model's functions as code: compiled with all that they call, and told apart by what they say."""

import hashlib
import inspect
import types
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from stylobate.engine.lanes.arithmetic import part

Function = Callable[..., Any]


def for_compiling(function: Function, compiled: Callable[[Function], Function]) -> Function:
    """Return `function` compiled, and with it the plain functions that it calls by a name of its module."""
    plain = plain_function(function)
    if plain.__code__.co_flags & inspect.CO_VARARGS:
        compiled = part  # Numba's own inlining knows no *arguments: left to the compiler behind it
    called = {name: for_compiling(value, compiled) for name, value in called_functions(plain)}
    # A process that reads the machine code imports the modules of its functions: this one is there in all of them.
    names = {**plain.__globals__, **called, "__name__": __name__}
    copy = types.FunctionType(plain.__code__, names, plain.__name__, plain.__defaults__, plain.__closure__)
    copy.__module__ = __name__
    return compiled(copy)


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
        yield _said(cell.cell_contents)
    for name in code.co_names:
        value = function.__globals__.get(name)
        if isinstance(value, types.ModuleType):
            yield from (
                f"{name}.{part} = {_said(getattr(value, part))}" for part in code.co_names if hasattr(value, part)
            )
        elif name in function.__globals__:
            yield f"{name} = {_said(value)}"
    for _, called in called_functions(function):
        yield from _parts(plain_function(called), seen)


def _said(value: object) -> str:
    """Return what tells a constant from another one; functions are told by what they say elsewhere."""
    if isinstance(value, np.ndarray):
        return f"{value.dtype} {value.shape} {value.tobytes().hex()}"
    return repr(value) if isinstance(value, (bool, int, float, complex, str, tuple)) else type(value).__name__


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
    """Return the plain functions that `function` calls by a name of its module."""
    values = ((name, function.__globals__.get(name)) for name in function.__code__.co_names)
    return [(name, value) for name, value in values if isinstance(value, types.FunctionType)]


def plain_function(function: Function) -> types.FunctionType:
    """Return the Python function behind one that the user compiled already."""
    plain = getattr(function, "py_func", function)
    assert isinstance(plain, types.FunctionType)
    return plain
