"""Checks of ranges and lists of numbers in arguments of studies of orbits."""

import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from stylobate.errors import ParameterError, as_numbers, require_positive, require_size
from stylobate.parameter_quantities import quantity_of


def require_frequencies(ends: Sequence[float]) -> tuple[float, float]:
    """Return the lowest and highest frequency [rad/s]; raise ParameterError unless positive and increasing."""
    low, high = _two("angular_frequency", as_numbers("angular_frequency", ends, "rad/s"), "rad/s")
    if not 0.0 < low < high < math.inf:
        message = f"angular_frequency must rise from above zero, got {low!r} to {high!r} rad/s"
        raise ParameterError(message)
    require_positive("angular_frequency", low, "rad/s")
    require_positive("angular_frequency", high, "rad/s")
    return low, high


def require_bounds(ends: Sequence[float], parameter: str) -> tuple[float, float]:
    """Return the lowest and highest value of a parameter; raise ParameterError unless they are valid and increasing."""
    low, high = _two("bounds", as_numbers("bounds", ends, quantity_of(parameter).unit), parameter)
    if not -math.inf < low < high < math.inf:
        message = f"bounds must rise from one number to another, got {low!r} to {high!r}"
        raise ParameterError(message)
    require_size(f"bounds of {parameter}", low)
    require_size(f"bounds of {parameter}", high)
    _require_inside("bounds", (low, high), parameter)
    return low, high


def require_values(values: Sequence[float], parameter: str) -> npt.NDArray[np.float64]:
    """Return the values of a parameter as an array; raise ParameterError unless the parameter can have these values."""
    found = _numbers("values", values, quantity_of(parameter).unit)
    if found.size == 0:
        message = f"values must hold a value of {parameter} at least, got {values!r}"
        raise ParameterError(message)
    _require_inside("values", found, parameter)
    return found


def _require_inside(name: str, values: Sequence[float] | npt.NDArray[np.float64], parameter: str) -> None:
    known = quantity_of(parameter)
    outside = [float(value) for value in values if not known.accepts(value)]
    if outside:
        message = f"{name}: values of {parameter} must {known.demand} (got {outside[0]!r}). Leave them out."
        raise ParameterError(message)


def require_rising_frequencies(frequencies: Sequence[float]) -> npt.NDArray[np.float64]:
    """Return frequencies [rad/s] as an array; raise ParameterError unless two or more, positive and increasing."""
    found = _numbers("angular_frequency", frequencies, "rad/s")
    if found.size < _LEAST or found[0] <= 0.0 or np.any(np.diff(found) <= 0.0):
        message = (
            f"angular_frequency must be two or more frequencies that rise from above zero [rad/s], got {frequencies!r}"
        )
        raise ParameterError(message)
    return found


_LEAST = 2


def _numbers(name: str, values: Sequence[float], unit: str) -> npt.NDArray[np.float64]:
    values = as_numbers(name, values, unit)
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
        shown = f"{len(ends)} values" if isinstance(ends, np.ndarray) else repr(ends)
        message = f"{name} must be two numbers, the lowest and the highest ({of}), got {shown}"
        raise ParameterError(message) from None
    return low, high
