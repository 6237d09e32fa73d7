"""Equality by content, for frozen dataclasses that hold arrays or Datasets."""

import math
from collections.abc import Mapping
from dataclasses import fields
from typing import Any, ClassVar

import numpy as np


class ByContent:
    """A frozen dataclass that equals another of its class with the same contents; it has no hash.

    Its class is decorated by `dataclass(frozen=True, eq=False)`. Arrays are equal if shapes and values are, Datasets if
    they are identical, NaN equals NaN. Fields with `compare=False` do not count.
    """

    __slots__ = ()

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        names = (one.name for one in fields(self) if one.compare)  # type: ignore[arg-type]
        return all(same_content(getattr(self, name), getattr(other, name)) for name in names)

    __hash__: ClassVar[None]  # type: ignore[assignment]  # __eq__ sets it


def same_content(first: Any, second: Any) -> bool:
    """Return whether two values have the same content, at any depth of mappings and tuples."""
    match first, second:
        case np.ndarray(), np.ndarray():
            same: Any = np.array_equal(first, second, equal_nan=True)
        case Mapping(), Mapping() if not hasattr(first, "identical"):
            same = first.keys() == second.keys() and all(same_content(first[name], second[name]) for name in first)
        case (tuple(), tuple()) | (list(), list()):
            same = len(first) == len(second) and all(map(same_content, first, second))
        case float(), float() if math.isnan(first):
            same = math.isnan(second)
        case _:  # Datasets state their equality by `identical`
            same = first is second or (first.identical(second) if hasattr(first, "identical") else first == second)
    return bool(same)
