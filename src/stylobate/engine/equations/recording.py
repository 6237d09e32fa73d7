"""Recording a model's equations: what its function computes, as expressions."""

import math
import types
from collections.abc import Callable
from typing import Any

import numpy as np

from stylobate.engine.compiler.model_code import called_functions, plain_function, with_functions
from stylobate.engine.equations.expressions import FUNCTIONS, Expression, Recording

Function = Callable[..., Any]


def recorded(function: Function, arguments: tuple[Any, ...]) -> Any:
    """Return what `function` returns for these expressions and numbers.

    Raises
    ------
    UnsupportedError
        If it compares expressions, or does with them what cannot be differentiated.
    """
    return _for_expressions(function)(*arguments)


def _for_expressions(function: Function) -> Function:
    """Return a copy of `function`, and of the functions it calls, whose mathematics takes expressions."""
    plain = plain_function(function)
    called = {name: _for_expressions(value) for name, value in called_functions(plain)}
    names = {name: _recording_value(value) for name, value in plain.__globals__.items()}
    names = with_functions(names, called, plain.__code__)
    return types.FunctionType(plain.__code__, names, plain.__name__, plain.__defaults__, plain.__closure__)


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
