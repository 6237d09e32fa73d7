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


def stands_for(function: _F, compiled: Callable[..., Any]) -> _F:
    """Let the compiler compile another function in place of `function`, such as one without checks."""
    function.__dict__["compiled"] = compiled
    return function


def compiled_for(function: Any) -> Any:
    """Return the function that the compiler compiles in place of this one, see `stands_for`."""
    own = getattr(function, "__dict__", {})
    return compiled_for(own["compiled"]) if "compiled" in own else function


def advice(function: _F) -> _F:
    """Mark a function that only speaks to the user, such as by a warning: compiled code leaves its calls out."""
    function.__dict__["advice"] = True
    return function


def is_advice(function: object) -> bool:
    """Return whether a function is marked as advice."""
    return bool(getattr(function, "advice", False))


def is_fast(function: Callable[..., Any]) -> bool:
    """Return whether a function is marked as fast."""
    return bool(getattr(function, "fast", False))
