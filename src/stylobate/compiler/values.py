"""Values in the compiler: numbers that are computed at run time, arrays, lane indices, known values, and bounds.

All other Python objects, such as a known number, a tuple, a class or a module, represent themselves: an expression of
known values is evaluated at compile time.

Whole numbers of Python have any number of digits, an index beyond a tuple is an error, and −1 is the last element. In
compiled code nothing of this can be seen while it runs. Therefore each whole number of a model's function has bounds
that are known when it is compiled. All of them lie within ±2^53, where conversions to floats are exact.
"""

import ast
import operator
import struct
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from enum import IntEnum
from itertools import product
from typing import Any

import numpy as np

from stylobate.compiler.sources import Refusal

Value = Any
"""A `Number`, `Array` or `LaneIndex`, a tuple of values, or any object that is known at compile time."""


Bounds = tuple[int, int]
"""Minimum and maximum of a whole number."""

BEYOND_FLOATS = 2**53
"""Floats represent all whole numbers up to this one."""


class NumberKind(IntEnum):
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

    kind: NumberKind
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

    kind: NumberKind
    pointer: str
    bounds: Bounds | None = None


def type_of(kind: NumberKind, lanes: int = 0) -> str:
    """Return the type of a number in LLVM."""
    return f"<{lanes} x {kind.type}>" if lanes else kind.type


def is_known_number(value: Value) -> bool:
    """Return whether a value is a number that is known at compile time."""
    return isinstance(value, bool | int | float | np.bool_ | np.integer | np.floating)


def kind_of(value: Value) -> NumberKind:
    """Return the kind of a known or unknown number."""
    if isinstance(value, Number):
        return value.kind
    if isinstance(value, bool | np.bool_):
        return NumberKind.BOOLEAN
    return NumberKind.INTEGER if isinstance(value, int | np.integer) else NumberKind.FLOAT


def constant(value: float, kind: NumberKind, lanes: int = 0) -> Number:
    """Return a known number as a number of the compiled code."""
    if kind is NumberKind.FLOAT:
        text = f"0x{struct.unpack('<Q', struct.pack('<d', value))[0]:016X}"
    else:
        text = str(int(value)) if kind is NumberKind.INTEGER else str(bool(value)).lower()
    if lanes:
        text = f"<{', '.join([f'{kind.type} {text}'] * lanes)}>"
    return Number(kind, text, lanes, (int(value), int(value)) if kind is NumberKind.INTEGER else None)


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


ANY: Bounds = (-BEYOND_FLOATS, BEYOND_FLOATS)
"""Bounds of a whole number of which nothing is known."""

TOO_LARGE = "a whole number may exceed 2**53 here; limit it, as in min(max(k, 0), 1000), or write float(...)"

_STEP = 1024
"""Maximum step of a counter: with such steps no loop reaches 2^53 in a lifetime."""

_OPERATIONS: dict[type[ast.operator], Callable[[int, int], int]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.FloorDiv: operator.floordiv,
}


def bounds_of(value: Value) -> Bounds:
    """Return the bounds of a whole number or truth value."""
    if is_known_number(value):
        return int(value), int(value)
    assert isinstance(value, Number)
    if value.kind is NumberKind.BOOLEAN:
        return 0, 1
    return value.bounds or ANY


def joined(*bounds: Bounds) -> Bounds:
    """Return the bounds of a number that lies within one of several bounds."""
    lows, highs = zip(*bounds, strict=True)
    return min(lows), max(highs)


def contains(outer: Bounds, inner: Bounds) -> bool:
    """Return whether the inner bounds lie within the outer ones."""
    return outer[0] <= inner[0] and inner[1] <= outer[1]


def widened(bounds: Bounds, beyond: Bounds) -> Bounds:
    """Return bounds without a limit on each side where others lie beyond."""
    return ANY[0] if beyond[0] < bounds[0] else bounds[0], ANY[1] if beyond[1] > bounds[1] else bounds[1]


def after(operation: ast.operator, a: Bounds, b: Bounds) -> Bounds:
    """Return the bounds of the result of an operation.

    Raises
    ------
    Refusal
        If the result may lie beyond ±2^53, or the divisor may be 0.
    """
    if isinstance(operation, ast.FloorDiv | ast.Mod) and b[0] <= 0 <= b[1]:
        raise Refusal(f"a whole number between {b[0]} and {b[1]} is a divisor, and may be 0; limit it, as in max(k, 1)")
    if isinstance(operation, ast.Mod):
        return (0, b[1] - 1) if b[0] > 0 else (b[0] + 1, 0)
    corners = [_OPERATIONS[type(operation)](x, y) for x, y in product(a, b)]
    bounds = min(corners), max(corners)
    if contains(ANY, bounds):
        return bounds
    if isinstance(operation, ast.Add | ast.Sub) and contains(ANY, joined(a, b)) and min(map(_size, (a, b))) <= _STEP:
        return max(bounds[0], ANY[0]), min(bounds[1], ANY[1])
    raise Refusal(TOO_LARGE)


def _size(bounds: Bounds) -> int:
    return max(map(abs, bounds))


def ends_of_index(bounds: Bounds, length: Value) -> tuple[bool, bool]:
    """Return whether an index may lie at least at 0, and below it, counted from the end.

    Raises
    ------
    Refusal
        If it may lie outside an array or tuple of this length.
    """
    if not isinstance(length, int):
        raise Refusal("an index that is not known, of an array whose length is not known; use an array of the module")
    if not contains((-length, length - 1), bounds):
        between = "any whole number" if contains(bounds, ANY) else f"between {bounds[0]} and {bounds[1]}"
        raise Refusal(
            f"the index may lie outside, it is {between} and the length is {length}; "
            f"limit it, as in min(max(k, 0), {length - 1})"
        )
    return bounds[1] >= 0, bounds[0] < 0
