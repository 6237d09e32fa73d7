"""Arguments and results of the closed forms: finite numbers or arrays of the required sign, and numbers for numbers."""

from collections.abc import Callable
from dataclasses import fields, is_dataclass, replace
from functools import wraps
from typing import Any, ParamSpec, TypeAlias, TypeVar

import numpy as np
import numpy.typing as npt

from stylobate.errors import ParameterError, as_numbers, require_finite, require_not_negative, require_positive

_P = ParamSpec("_P")
_T = TypeVar("_T")

Real: TypeAlias = npt.ArrayLike
FloatArray: TypeAlias = npt.NDArray[np.float64]
ComplexArray: TypeAlias = npt.NDArray[np.complex128]
BoolArray: TypeAlias = npt.NDArray[np.bool_]

Values: TypeAlias = Any
"""A result: a float for numbers, a FloatArray for arrays."""
Truths: TypeAlias = Any
"""A result: True or False for numbers, a BoolArray for arrays."""


def finite(name: str, value: Real) -> FloatArray:
    """Return `value` as an array of floats, or raise ParameterError at its first entry that is not finite."""
    array = _floats(name, value)
    bad = array[~np.isfinite(array)]
    if bad.size:
        require_finite(name, bad[0])
    return array


def positive(name: str, value: Real) -> FloatArray:
    """Return `value` as an array of floats, or raise ParameterError at its first entry that is not positive."""
    array = _floats(name, value)
    bad = array[~(np.isfinite(array) & (array > 0.0))]
    if bad.size:
        require_positive(name, bad[0])
    return array


def not_negative(name: str, value: Real) -> FloatArray:
    """Return `value` as an array of floats, or raise ParameterError at its first entry that is below zero."""
    array = _floats(name, value)
    bad = array[~(np.isfinite(array) & (array >= 0.0))]
    if bad.size:
        require_not_negative(name, bad[0])
    return array


def plain_results(closed_form: Callable[_P, _T]) -> Callable[_P, _T]:
    """Return Python numbers in place of arrays without dimensions, the results for numbers; a decorator."""

    @wraps(closed_form)
    def evaluated(*arguments: _P.args, **named: _P.kwargs) -> _T:
        result: _T = _plain(closed_form(*arguments, **named))
        return result

    return evaluated


def _plain(value: Any) -> Any:
    if isinstance(value, np.generic) or (isinstance(value, np.ndarray) and value.ndim == 0):
        return value.item()
    if type(value) is tuple:
        return tuple(map(_plain, value))
    if is_dataclass(value) and not isinstance(value, type):
        return replace(value, **{one.name: _plain(getattr(value, one.name)) for one in fields(value) if one.init})
    return value


def not_negative_or_infinite(name: str, value: Real) -> FloatArray:
    """Return `value` as an array of floats, or raise ParameterError at its first entry that is below zero or NaN."""
    array = _floats(name, value)
    not_negative(name, np.where(np.isposinf(array), 0.0, array))
    return array


def _floats(name: str, value: Real) -> FloatArray:
    value = as_numbers(name, value, "1")  # a quantity must be a pure number or an angle
    try:
        array = np.asarray(value)
        if array.dtype.kind in "iuf":
            return array.astype(np.float64)
    except ValueError:
        pass
    raise ParameterError(f"{name} must be a real number or an array of them, got {value!r}")
