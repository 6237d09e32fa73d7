"""What the compiler knows of a value: numbers that are computed later, arrays, lanes, and all that is known now.

Whatever else Python can hold, such as a number that is known, a tuple, a class or a module, stands for itself: an
expression of known values is evaluated while the compiler reads it.
"""

import struct
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from enum import IntEnum
from typing import Any

import numpy as np

Value = Any
"""A `Number`, `Array` or `LaneIndex`, a tuple of values, or anything that is known while compiling."""


class Kind(IntEnum):
    """Kinds of numbers; of two that meet, the later one holds both."""

    BOOLEAN = 0
    INTEGER = 1
    FLOAT = 2

    @property
    def type(self) -> str:
        """Its type in LLVM."""
        return ("i1", "i64", "double")[self]


@dataclass(frozen=True, slots=True)
class Number:
    """A number that the compiled code computes.

    Parameters
    ----------
    kind
        Its kind.
    text
        How instructions name it.
    lanes
        How many numbers it is, one beside the other; 0 for a single one.
    """

    kind: Kind
    text: str
    lanes: int = 0

    @property
    def type(self) -> str:
        """Its type in LLVM."""
        return type_of(self.kind, self.lanes)

    @property
    def operand(self) -> str:
        """Its type and its name."""
        return f"{self.type} {self.text}"


class Element(IntEnum):
    """What an array holds."""

    FLOAT = 8
    SIGNAL = 1
    """Bytes that another thread may set meanwhile: read each time."""


@dataclass(frozen=True, slots=True)
class Array:
    """An array, or a view into one: a pointer, and for each axis the length and the stride in elements.

    Constants of a module are not writable.
    """

    pointer: str
    shape: tuple["int | Number", ...]
    strides: tuple["int | Number", ...]
    element: Element = Element.FLOAT
    writable: bool = True


@dataclass(frozen=True, slots=True)
class LaneIndex:
    """The index of a loop over lanes, with what is added to it."""

    first: Number
    offset: int = 0


@dataclass(frozen=True, slots=True)
class Slot:
    """A place in memory that holds a number under a name which control flow assigns to."""

    kind: Kind
    pointer: str


def type_of(kind: Kind, lanes: int = 0) -> str:
    """Return the type of a number in LLVM."""
    return f"<{lanes} x {kind.type}>" if lanes else kind.type


def is_known_number(value: Value) -> bool:
    """Return whether a value is a number that is known while compiling."""
    return isinstance(value, bool | int | float | np.bool_ | np.integer | np.floating)


def kind_of(value: Value) -> Kind:
    """Return the kind of a number, known or not."""
    if isinstance(value, Number):
        return value.kind
    if isinstance(value, bool | np.bool_):
        return Kind.BOOLEAN
    return Kind.INTEGER if isinstance(value, int | np.integer) else Kind.FLOAT


def constant(value: float, kind: Kind, lanes: int = 0) -> Number:
    """Return a known number as one of the compiled code."""
    if kind is Kind.FLOAT:
        text = f"0x{struct.unpack('<Q', struct.pack('<d', value))[0]:016X}"
    else:
        text = str(int(value)) if kind is Kind.INTEGER else str(bool(value)).lower()
    if lanes:
        text = f"<{', '.join([f'{kind.type} {text}'] * lanes)}>"
    return Number(kind, text, lanes)


def parts(value: Value) -> Iterator[Number]:
    """Yield the numbers of a value that are passed when it is an argument or a result."""
    if isinstance(value, Number):
        yield value
    elif isinstance(value, tuple):
        for part in value:
            yield from parts(part)
    elif isinstance(value, Array):
        for size in (*value.shape, *value.strides):
            yield from parts(size)


def rebuilt(value: Value, make: Callable[[Value], Value]) -> Value:
    """Return a tuple of the same structure, each value in it replaced by what `make` returns of it."""
    if not isinstance(value, tuple):
        return make(value)
    made = [rebuilt(part, make) for part in value]
    return type(value)(*made) if hasattr(value, "_fields") else tuple(made)
