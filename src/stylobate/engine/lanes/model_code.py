"""A model's functions as code: compiled with all that they call, and told apart by what they say."""

import hashlib
import inspect
import types
from collections.abc import Callable, Iterator
from typing import Any

from stylobate.engine.lanes.arithmetic import part

Function = Callable[..., Any]


def for_compiling(function: Function, compiled: Callable[[Function], Function]) -> Function:
    """Return `function` compiled, and with it the plain functions that it calls by a name of its module."""
    plain = _plain(function)
    if plain.__code__.co_flags & inspect.CO_VARARGS:
        compiled = part  # Numba's own inlining knows no *arguments: left to the compiler behind it
    called = {name: for_compiling(value, compiled) for name, value in _called(plain)}
    if not called:
        return compiled(plain)
    copy = types.FunctionType(
        plain.__code__, {**plain.__globals__, **called}, plain.__name__, plain.__defaults__, plain.__closure__
    )
    copy.__module__ = plain.__module__
    return compiled(copy)


def fingerprint(function: Function) -> str:
    """Return a digest of what `function` computes: its code, the constants and the functions that it uses."""
    digest = hashlib.sha256()
    for said in _parts(_plain(function), set()):
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
    for name in code.co_names:
        value = function.__globals__.get(name)
        if isinstance(value, (bool, int, float, tuple, str)):
            yield f"{name} = {value!r}"
    for _, called in _called(function):
        yield from _parts(_plain(called), seen)


def _code_parts(code: types.CodeType) -> Iterator[str]:
    yield code.co_code.hex()
    yield repr(code.co_names)
    yield repr(code.co_varnames)
    for constant in code.co_consts:
        if isinstance(constant, types.CodeType):
            yield from _code_parts(constant)
        else:
            yield repr(constant)


def _called(function: types.FunctionType) -> list[tuple[str, Function]]:
    values = ((name, function.__globals__.get(name)) for name in function.__code__.co_names)
    return [(name, value) for name, value in values if isinstance(value, types.FunctionType)]


def _plain(function: Function) -> types.FunctionType:
    """Return the Python function behind one that the user compiled already."""
    plain = getattr(function, "py_func", function)
    assert isinstance(plain, types.FunctionType)
    return plain
