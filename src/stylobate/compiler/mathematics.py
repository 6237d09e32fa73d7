"""Mathematical functions of `math`, NumPy and Python that compiled functions can call."""

import ast
import math
from collections.abc import Callable
from dataclasses import replace
from enum import EnumType
from typing import Any

import numpy as np

from stylobate.compiler.arithmetic import Arithmetic
from stylobate.compiler.refusal import Refusal
from stylobate.compiler.values import Array, Kind, Number, Value, is_known_number
from stylobate.compiler.whole_numbers import bounds_of

_OF_LLVM = (
    *("sqrt", "fabs", "sin", "cos", "exp", "exp2", "log", "log2", "log10", "pow", "copysign", "floor", "ceil", "trunc"),
    *("rint", "minimum", "maximum"),
)
_OF_C_LIBRARY = (
    *("tan", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh", "asinh", "acosh", "atanh"),
    *("hypot", "expm1", "log1p", "cbrt", "erf", "erfc", "fmod"),
)
_NAMES_OF_NUMPY = {
    "arcsin": "asin",
    "arccos": "acos",
    "arctan": "atan",
    "arctan2": "atan2",
    "arcsinh": "asinh",
    "arccosh": "acosh",
    "arctanh": "atanh",
    "power": "pow",
    "absolute": "fabs",
}
_WHOLE_IN_PYTHON = ("floor", "ceil", "trunc")


def is_mathematics(function: Any) -> bool:
    """Return whether the compiler supports this function."""
    return _name_of(function) is not None


def call(arithmetic: Arithmetic, function: Callable[..., Any], values: list[Value]) -> Value:
    """Return the result of a mathematical function, see `is_mathematics`."""
    if function is len:
        return _length(values[0])
    if all(is_known_number(value) for value in values):
        return function(*values)
    name = _name_of(function) or ""
    own = _OWN.get(name)
    if own is not None:
        return own(arithmetic, *values)
    if name in _OF_C_LIBRARY:
        return arithmetic.called_in_library(name, *values)
    result = arithmetic.called(f"llvm.{name}", *values)
    if name in _WHOLE_IN_PYTHON and not isinstance(function, np.ufunc) and (arithmetic.checked or not result.lanes):
        return arithmetic.whole(result)
    return result


def _name_of(function: Any) -> str | None:
    """Return the name of a function in the compiler, or None."""
    own = getattr(function, "__name__", "")
    if isinstance(function, np.ufunc):
        name = _NAMES_OF_NUMPY.get(own, own)
        return name if name in _OF_LLVM or name in _OF_C_LIBRARY or name in ("square", "sign") else None
    if function in (np.where, np.clip):
        return str(own)
    if getattr(math, own, None) is function:
        return own if own in _OF_LLVM or own in _OF_C_LIBRARY or own in _OWN else None
    return own if function in _OF_PYTHON else None


def _length(value: Value) -> Value:
    if isinstance(value, Array):
        return value.shape[0]
    if isinstance(value, tuple | list | range | str | EnumType):
        return len(value)
    message = "len(...) needs an array, or a value that is known at compile time"
    raise Refusal(message)


def _absolute(arithmetic: Arithmetic, value: Value) -> Value:
    number = arithmetic.number(value)
    if number.kind is Kind.FLOAT:
        return arithmetic.called("llvm.fabs", number)
    negative = arithmetic.compared(ast.Lt(), number, 0)
    result = arithmetic.chosen(negative, arithmetic.negative(number), arithmetic.number(number, Kind.INTEGER))
    low, high = bounds_of(number)
    return replace(result, bounds=(max(low, -high, 0), max(-low, high))) if arithmetic.checked else result


def _extreme(comparison: ast.cmpop, extreme: Callable[..., int]) -> Callable[..., Value]:
    def found(arithmetic: Arithmetic, *values: Value) -> Value:
        if len(values) == 1:
            (values,) = values
        if not isinstance(values, tuple) or not values:
            message = "min and max need two numbers, or a tuple of numbers"
            raise Refusal(message)
        result, *others = values
        for value in others:
            before = result
            result = arithmetic.chosen(arithmetic.compared(comparison, value, before), value, before)
            if arithmetic.checked and isinstance(result, Number) and result.kind is Kind.INTEGER:
                low, high = map(extreme, bounds_of(value), bounds_of(before))
                result = replace(result, bounds=(low, high))
        return result

    return found


def _is_none(arithmetic: Arithmetic, value: Value) -> Value:
    return arithmetic.compared(ast.NotEq(), value, value)


def _is_infinite(arithmetic: Arithmetic, value: Value) -> Value:
    return arithmetic.compared(ast.Eq(), _absolute(arithmetic, value), math.inf)


def _is_finite(arithmetic: Arithmetic, value: Value) -> Value:
    return arithmetic.compared(ast.Lt(), _absolute(arithmetic, value), math.inf)


def _float(arithmetic: Arithmetic, value: Value) -> Number:
    if isinstance(value, str):
        message = f"float({value!r}) is not compiled; write math.inf, math.nan or the number"
        raise Refusal(message)
    return arithmetic.number(value, Kind.FLOAT)


def _scaled(factor: float) -> Callable[[Arithmetic, Value], Value]:
    return lambda arithmetic, value: arithmetic.binary(ast.Mult(), value, factor)


def _sum(arithmetic: Arithmetic, values: Value, start: Value = 0) -> Value:
    for value in values:
        start = arithmetic.binary(ast.Add(), start, value)
    return start


def _length_of_vector(arithmetic: Arithmetic, *values: Value) -> Value:
    result, *others = values
    for value in others:
        result = arithmetic.called_in_library("hypot", result, value)
    return result if others else _absolute(arithmetic, result)


def _logarithm(arithmetic: Arithmetic, value: Value, base: Value = None) -> Value:
    result = arithmetic.called("llvm.log", value)
    return result if base is None else arithmetic.binary(ast.Div(), result, arithmetic.called("llvm.log", base))


def _square(arithmetic: Arithmetic, value: Value) -> Value:
    return arithmetic.binary(ast.Mult(), value, value)


def _sign(arithmetic: Arithmetic, value: Value) -> Value:
    negative, positive = (arithmetic.compared(operation, value, 0.0) for operation in (ast.Lt(), ast.Gt()))
    # The sign of NaN is NaN, that of both zeros is 0.0.
    neither = arithmetic.binary(ast.Mult(), _absolute(arithmetic, value), 0.0)
    return arithmetic.chosen(positive, 1.0, arithmetic.chosen(negative, -1.0, neither))


def _clipped(arithmetic: Arithmetic, value: Value, low: Value, high: Value) -> Value:
    return arithmetic.called("llvm.minimum", arithmetic.called("llvm.maximum", value, low), high)


_OF_PYTHON = (abs, min, max, sum, int, float, bool, len)
_OWN: dict[str, Callable[..., Value]] = {
    "sum": _sum,
    "hypot": _length_of_vector,
    "log": _logarithm,
    "square": _square,
    "sign": _sign,
    "clip": _clipped,
    "where": Arithmetic.chosen,
    "abs": _absolute,
    "min": _extreme(ast.Lt(), min),
    "max": _extreme(ast.Gt(), max),
    "int": Arithmetic.whole,
    "float": _float,
    "bool": Arithmetic.truth,
    "isnan": _is_none,
    "isinf": _is_infinite,
    "isfinite": _is_finite,
    "radians": _scaled(math.pi / 180.0),
    "degrees": _scaled(180.0 / math.pi),
}
