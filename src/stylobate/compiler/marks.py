"""Marks in functions for the compiler; in plain Python they have no effect."""

from collections.abc import Callable
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt

_F = TypeVar("_F", bound=Callable[..., Any])


def lanes(count: int) -> range:
    """Return `range(count)`, and mark a loop whose passes are independent and can be vectorised."""
    return range(count)


def flat(array: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Return a contiguous array as one row, without a copy."""
    return array.reshape(array.size)


def fast(function: _F) -> _F:
    """Allow products and sums to be fused and quotients to be products with reciprocals, in a function and its calls.

    NaN is kept, so that failed steps are detected.
    """
    function.__dict__["fast"] = True
    return function


def is_fast(function: Callable[..., Any]) -> bool:
    """Return whether a function is marked as fast."""
    return bool(getattr(function, "fast", False))
