"""Argument checks of the closed forms: finite numbers or arrays of the required sign, without unit."""

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from stylobate.errors import ParameterError, as_numbers, require_finite, require_not_negative, require_positive

Real: TypeAlias = npt.ArrayLike
FloatArray: TypeAlias = npt.NDArray[np.float64]
ComplexArray: TypeAlias = npt.NDArray[np.complex128]
BoolArray: TypeAlias = npt.NDArray[np.bool_]


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
    message = f"{name} must be a real number or an array of them, got {value!r}"
    raise ParameterError(message)
