"""Values in the compiler: numbers that are computed at run time, arrays, lane indices, and known values.

All other Python objects, such as a known number, a tuple, a class or a module, represent themselves: an expression of
known values is evaluated at compile time.
"""

import struct
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from enum import IntEnum
from typing import Any

import numpy as np

Value = Any
"""A `Number`, `Array` or `LaneIndex`, a tuple of values, or any object that is known at compile time."""


Bounds = tuple[int, int]
"""Minimum and maximum of a whole number."""

BEYOND_FLOATS = 2**53
"""Floats represent all whole numbers up to this one."""


class Kind(IntEnum):
    """Kind of a number; each kind can represent the numbers of the kinds before it."""

    BOOLEAN = 0
    INTEGER = 1
    FLOAT = 2

    @property
    def type(self) -> str:
        """Type in LLVM."""
        return ("i1", "i64", "double")[self]


@dataclass(frozen=True, slots=True)
class Number:
    """Number that the compiled code computes.

    Parameters
    ----------
    kind
        Kind of the number.
    text
        Name of the number in instructions.
    lanes
        Number of lanes; 0 for a single number.
    bounds
        Bounds of a whole number, if they are known.
    """

    kind: Kind
    text: str
    lanes: int = 0
    bounds: Bounds | None = None

    @property
    def type(self) -> str:
        """Type in LLVM."""
        return type_of(self.kind, self.lanes)

    @property
    def operand(self) -> str:
        """Type and name."""
        return f"{self.type} {self.text}"


class Element(IntEnum):
    """Type of the elements of an array."""

    FLOAT = 8
    SIGNAL = 1
    """Bytes that another thread may set at any time: each access reads memory."""


@dataclass(frozen=True, slots=True)
class Array:
    """Array, or view into an array: a pointer, and for each axis the length and the stride in elements.

    Constants of a module are not writable.
    """

    pointer: str
    shape: tuple["int | Number", ...]
    strides: tuple["int | Number", ...]
    element: Element = Element.FLOAT
    writable: bool = True


@dataclass(frozen=True, slots=True)
class LaneIndex:
    """Index of a loop over lanes, with a constant offset."""

    first: Number
    offset: int = 0


@dataclass(frozen=True, slots=True)
class Slot:
    """Memory of a number whose name control flow assigns to; `bounds` are those of all whole numbers stored in it."""

    kind: Kind
    pointer: str
    bounds: Bounds | None = None


def type_of(kind: Kind, lanes: int = 0) -> str:
    """Return the type of a number in LLVM."""
    return f"<{lanes} x {kind.type}>" if lanes else kind.type


def is_known_number(value: Value) -> bool:
    """Return whether a value is a number that is known at compile time."""
    return isinstance(value, bool | int | float | np.bool_ | np.integer | np.floating)


def kind_of(value: Value) -> Kind:
    """Return the kind of a known or unknown number."""
    if isinstance(value, Number):
        return value.kind
    if isinstance(value, bool | np.bool_):
        return Kind.BOOLEAN
    return Kind.INTEGER if isinstance(value, int | np.integer) else Kind.FLOAT


def constant(value: float, kind: Kind, lanes: int = 0) -> Number:
    """Return a known number as a number of the compiled code."""
    if kind is Kind.FLOAT:
        text = f"0x{struct.unpack('<Q', struct.pack('<d', value))[0]:016X}"
    else:
        text = str(int(value)) if kind is Kind.INTEGER else str(bool(value)).lower()
    if lanes:
        text = f"<{', '.join([f'{kind.type} {text}'] * lanes)}>"
    return Number(kind, text, lanes, (int(value), int(value)) if kind is Kind.INTEGER else None)


def parts(value: Value) -> Iterator[Number]:
    """Yield the numbers of a value that are passed in calls and results."""
    if isinstance(value, Number):
        yield value
    elif isinstance(value, tuple):
        for part in value:
            yield from parts(part)
    elif isinstance(value, Array):
        for size in (*value.shape, *value.strides):
            yield from parts(size)


def rebuilt(value: Value, make: Callable[[Value], Value]) -> Value:
    """Apply `make` to each value of a nested tuple; return the same structure."""
    if not isinstance(value, tuple):
        return make(value)
    made = [rebuilt(part, make) for part in value]
    return type(value)(*made) if hasattr(value, "_fields") else tuple(made)
