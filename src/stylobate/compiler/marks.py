"""What a function that is to be compiled says of itself; in plain Python these marks do nothing."""

from collections.abc import Callable
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt

_F = TypeVar("_F", bound=Callable[..., Any])


def lanes(count: int) -> range:
    """Return `range(count)`: the passes of the loop depend on nothing of each other, and are made side by side."""
    return range(count)


def flat(array: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Return an array without gaps as one row, without copying."""
    return array.reshape(array.size)


def fast(function: _F) -> _F:
    """Allow products and sums to be fused and quotients to be products with reciprocals, in a function and its calls.

    Not a number remains what it is: a step that ran into one is seen.
    """
    function.__dict__["fast"] = True
    return function


def is_fast(function: Callable[..., Any]) -> bool:
    """Return whether a function is marked as fast."""
    return bool(getattr(function, "fast", False))
