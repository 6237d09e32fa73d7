"""Ranges and lists of numbers that studies of orbits are asked for."""

import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from stylobate.errors import ParameterError

# A parameter that is a size of the motion or of the column, of which none is negative; zero is the end of motion.
_NOT_NEGATIVE = ("acceleration", "damping", "spin_friction")


def require_frequencies(ends: Sequence[float]) -> tuple[float, float]:
    """Return the lowest and highest frequency [rad/s], or raise ParameterError unless they rise from above zero."""
    low, high = _two("angular_frequency", ends, "rad/s")
    if not 0.0 < low < high < math.inf:
        message = f"angular_frequency must rise from above zero, got {low!r} to {high!r} rad/s"
        raise ParameterError(message)
    return low, high


def require_bounds(ends: Sequence[float], parameter: str) -> tuple[float, float]:
    """Return the lowest and highest value of a parameter, or raise ParameterError unless they are such a pair."""
    low, high = _two("bounds", ends, parameter)
    if not -math.inf < low < high < math.inf:
        message = f"bounds must rise from one number to another, got {low!r} to {high!r}"
        raise ParameterError(message)
    if low < 0.0 and parameter in _NOT_NEGATIVE:
        message = f"bounds must not be negative for {parameter}, got {low!r} to {high!r}; begin at zero or above"
        raise ParameterError(message)
    return low, high


def require_values(values: Sequence[float], parameter: str) -> npt.NDArray[np.float64]:
    """Return the values of a parameter as an array, or raise ParameterError unless they are numbers it can have."""
    found = _numbers("values", values)
    if found.size == 0:
        message = f"values must hold a value of {parameter} at least, got {values!r}"
        raise ParameterError(message)
    if parameter in _NOT_NEGATIVE and found.min() < 0.0:
        message = f"values must not be negative for {parameter}, got {float(found.min())!r}"
        raise ParameterError(message)
    return found


def require_rising_frequencies(frequencies: Sequence[float]) -> npt.NDArray[np.float64]:
    """Return frequencies [rad/s] as an array, or raise ParameterError unless two or more rise from above zero."""
    found = _numbers("angular_frequency", frequencies)
    if found.size < _LEAST or found[0] <= 0.0 or np.any(np.diff(found) <= 0.0):
        message = (
            f"angular_frequency must be two or more frequencies that rise from above zero [rad/s], got {frequencies!r}"
        )
        raise ParameterError(message)
    return found


_LEAST = 2


def _numbers(name: str, values: Sequence[float]) -> npt.NDArray[np.float64]:
    try:
        found = np.asarray(values, dtype=float)
    except (TypeError, ValueError):
        found = np.full(1, np.nan)
    if found.ndim != 1 or not np.all(np.isfinite(found)):
        message = f"{name} must be a list of finite numbers, got {values!r}"
        raise ParameterError(message)
    return found


def _two(name: str, ends: Sequence[float], of: str) -> tuple[float, float]:
    try:
        low, high = (float(end) for end in ends)
    except (TypeError, ValueError):
        told = f"{len(ends)} values" if isinstance(ends, np.ndarray) else repr(ends)
        message = f"{name} must be two numbers, the lowest and the highest ({of}), got {told}"
        raise ParameterError(message) from None
    return low, high
