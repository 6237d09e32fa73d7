"""Recording of the equations of a model as expressions."""

import itertools
import math
import types
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from stylobate.compiler.fingerprint import global_names
from stylobate.compiler.sources import plain_function
from stylobate.engine.equations.expressions import FUNCTIONS, Expression, Recording
from stylobate.errors import UnsupportedError

Function = Callable[..., Any]

# Functions of these packages are not copied.
_LIBRARIES = ("numpy",)

_number = itertools.count()


def recorded(function: Function, arguments: tuple[Any, ...]) -> Any:
    """Return the value of `function` for these expressions and numbers.

    Raises
    ------
    UnsupportedError
        If the function compares expressions, or uses an operation that cannot be differentiated.
    """
    try:
        return _for_expressions(function)(*arguments)
    except TypeError as error:  # such as an array of NumPy
        message = f"the equations cannot be differentiated: {error}; write them with numbers and functions of math"
        raise UnsupportedError(message) from error


def _for_expressions(function: Function) -> Function:
    """Return a copy of `function`, and of the functions that it calls, whose mathematics accepts expressions."""
    plain = plain_function(function)
    called = {name: _for_expressions(value) for name, value in _called_functions(plain)}
    names = {name: _recording_value(value) for name, value in plain.__globals__.items()}
    names = _with_functions(names, called, plain.__code__)
    return types.FunctionType(plain.__code__, names, plain.__name__, plain.__defaults__, plain.__closure__)


def _called_functions(function: types.FunctionType) -> list[tuple[str, Function]]:
    """Return the plain functions that `function` calls, by their names in its module: f, module.f or Class.f."""
    found: dict[str, Function] = {}
    for name in global_names(function.__code__):
        root, *path = name.split(".")
        value = function.__globals__.get(root)
        for attribute in path:
            value = getattr(value, attribute, None) if isinstance(value, (types.ModuleType, type)) else None
        plain = getattr(value, "py_func", value)
        if isinstance(plain, types.FunctionType) and plain.__module__.split(".")[0] not in _LIBRARIES:
            found[name] = plain
    return list(found.items())


def _with_functions(
    names: Mapping[str, Any], functions: Mapping[str, Function], code: types.CodeType
) -> dict[str, Any]:
    """Return `names` with these functions in place of the originals.

    For a function called as Class.f or module.f, a new module with all names that the `code` uses replaces the class or
    module, which is not modified.
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


def _recording_value(value: Any) -> Any:
    if value is math or value is np:
        return _MATHEMATICS[value.__name__]
    return _BY_FUNCTION.get(value, value) if isinstance(value, types.BuiltinFunctionType) else value


def _recording_function(name: str, usual: Function) -> Function:
    def applied(*arguments: Any) -> Any:
        for argument in arguments:
            if isinstance(argument, Expression):
                record: Recording = argument.record
                return record.applied(name, *arguments)
        return usual(*arguments)

    return applied


def _power(base: Any, exponent: Any) -> Any:
    return base**exponent


def _logarithm(value: Any, base: Any = math.e) -> Any:
    if not isinstance(value, Expression):
        return math.log(value, base) if base != math.e else math.log(value)
    natural = value.record.applied("log", value)
    return natural if base == math.e else natural / math.log(base)


def _length(*components: Any) -> Any:
    if not any(isinstance(component, Expression) for component in components):
        return math.hypot(*components)
    square = sum(component * component for component in components)
    return square.record.applied("sqrt", square)


def _mathematics(module: types.ModuleType, names: dict[str, str]) -> types.ModuleType:
    made = types.ModuleType(module.__name__)
    vars(made).update(vars(module))
    for theirs, name in names.items():
        setattr(made, theirs, _recording_function(name, getattr(module, theirs)))
    return made


_NUMPY_NAMES = {"arcsin": "asin", "arccos": "acos", "arctan": "atan", "arctan2": "atan2", "arcsinh": "asinh"}
_MATHEMATICS = {
    "math": _mathematics(math, {name: name for name in FUNCTIONS}),
    "numpy": _mathematics(
        np, {name: name for name in FUNCTIONS if hasattr(np, name)} | _NUMPY_NAMES | {"abs": "fabs", "absolute": "fabs"}
    ),
}
for _module in _MATHEMATICS.values():
    vars(_module).update(pow=_power, power=_power, log=_logarithm, hypot=_length)
_BY_FUNCTION = {math.pow: _power} | {getattr(math, name): getattr(_MATHEMATICS["math"], name) for name in FUNCTIONS}
