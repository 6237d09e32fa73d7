"""Numbers for JSON: lists of rounded floats, with null for numbers that are not finite."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from stylobate.results.plain import plain_numbers

_DIGITS = 9
"""Significant digits in answers; the page shows fewer."""


def numbers(values: npt.ArrayLike) -> list[Any]:
    """Return an array as lists, with None for numbers that are not finite."""
    return plain_numbers(values, _DIGITS)


def number(value: float) -> float | None:
    """Return a number, or None if it is not finite."""
    return float(value) if math.isfinite(value) else None


def table(values: Mapping[str, Any]) -> dict[str, Any]:
    """Return named values with numbers that are not finite as None, at any depth."""
    return {str(name): _plain(value) for name, value in values.items()}


def _plain(value: Any) -> Any:
    if isinstance(value, Mapping):
        return table(value)
    if isinstance(value, (list, tuple)):
        return [_plain(one) for one in value]
    if isinstance(value, float | np.floating):
        return number(float(value))
    return value.item() if isinstance(value, np.generic) else value
