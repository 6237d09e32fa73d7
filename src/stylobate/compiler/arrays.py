"""Elements of arrays, and views into arrays."""

import ast
import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from stylobate.compiler.arithmetic import Arithmetic
from stylobate.compiler.refusal import LanesRefusal, Refusal
from stylobate.compiler.values import Array, Element, Kind, LaneIndex, Number, Value, constant, is_known_number, type_of
from stylobate.compiler.whole_numbers import bounds_of, ends_of_index

MOST_IN_FUNCTION = 4096
"""Maximum number of elements of an array that a function creates."""


def view(arithmetic: Arithmetic, array: Array, indices: Sequence[Value]) -> Array:
    """Return the view of an array for indices and slices of its first axes."""
    if len(indices) > len(array.shape):
        message = f"an array of {len(array.shape)} axes is indexed with {len(indices)} indices"
        raise Refusal(message)
    if any(isinstance(index, Number) and index.lanes for index in indices):
        message = "an index that differs between lanes; write a function of single numbers"
        raise LanesRefusal(message)
    if any(_is_truth(index) for index in indices):
        message = "an index of an array is a truth value, which selects in NumPy; write int(...)"
        raise Refusal(message)
    known, pointer = 0, array.pointer
    shape, strides = [], []
    for axis, index in enumerate(indices):
        length, stride = array.shape[axis], array.strides[axis]
        if isinstance(index, slice):
            step, end = _ends(arithmetic, index, length)
            shape.append(arithmetic.binary(ast.Sub(), end, step))
            strides.append(stride)
        else:
            step = counted(arithmetic, index, length)
        step = step if stride == 1 else arithmetic.binary(ast.Mult(), step, stride)
        if isinstance(step, int):
            known += step
        else:
            pointer = _moved(arithmetic, pointer, arithmetic.number(step, Kind.INTEGER), array.element)
    if known:
        pointer = _moved(arithmetic, pointer, constant(known, Kind.INTEGER), array.element)
    rest = len(indices)
    shape, strides = [*shape, *array.shape[rest:]], [*strides, *array.strides[rest:]]
    return replace(array, pointer=pointer, shape=tuple(shape), strides=tuple(strides))


def room(arithmetic: Arithmetic, shape: Value) -> Array:
    """Return a small array of zeros with the lifetime of the function call."""
    shape = shape if isinstance(shape, tuple) else (shape,)
    if not _is_known(shape) or math.prod(shape) > MOST_IN_FUNCTION:
        message = (
            f"arrays made in a function have a known shape and at most {MOST_IN_FUNCTION} numbers; pass it instead"
        )
        raise Refusal(message)
    array = Array(arithmetic.text.allocated(f"[{math.prod(shape)} x double]"), shape, _without_gaps(shape))
    clear = arithmetic.module.declared("llvm.memset.p0.i64", "void", ["ptr", "i8", "i64", "i1"])
    arithmetic.text.line(f"call void {clear}(ptr {array.pointer}, i8 0, i64 {_bytes(array)}, i1 false)")
    return array


def copy(arithmetic: Arithmetic, target: Array, source: Value) -> None:
    """Copy an array into another array of the same shape, both contiguous."""
    alike = isinstance(source, Array) and source.shape == target.shape and source.strides == target.strides
    if not alike or not target.writable or target.strides != _without_gaps(target.shape):
        message = "arrays are copied as a whole where shapes are known and equal, without gaps; write a loop"
        raise Refusal(message)
    move = arithmetic.module.declared("llvm.memmove.p0.p0.i64", "void", ["ptr", "ptr", "i64", "i1"])
    operands = f"ptr {target.pointer}, ptr {source.pointer}, i64 {_bytes(target)}, i1 false"
    arithmetic.text.line(f"call void {move}({operands})")


def elements(arithmetic: Arithmetic, array: Array) -> tuple[Value, ...]:
    """Return the elements of an array of known length."""
    if len(array.shape) != 1 or not isinstance(array.shape[0], int):
        message = "only a row of known length can be unpacked; write a loop"
        raise Refusal(message)
    return tuple(load(arithmetic, *place(arithmetic, array, [index])) for index in range(array.shape[0]))


def flat(arithmetic: Arithmetic, array: Array) -> Array:
    """Return a contiguous array as one row."""
    size: Value = 1
    for length in array.shape:
        size = arithmetic.binary(ast.Mult(), size, length)
    if _is_known(array.shape) and array.strides != _without_gaps(array.shape):
        message = "only an array without gaps is one row"
        raise Refusal(message)
    return replace(array, shape=(size,), strides=(1,))


def place(arithmetic: Arithmetic, array: Array, indices: Sequence[Value]) -> tuple[Array, int]:
    """Return one element as an array without axes, and the number of lanes that address it.

    Raises
    ------
    Refusal
        If the elements of the lanes are not adjacent.
    """
    *outer, last = indices
    if not isinstance(last, LaneIndex):
        return view(arithmetic, array, indices), 0
    if array.strides[len(outer)] != 1:
        message = "the index of a loop over lanes belongs in the last axis"
        raise Refusal(message)
    if last.offset < 0:
        message = "the first lanes would lie before the array"
        raise Refusal(message)
    if arithmetic.checked:
        low, high = bounds_of(last.first)
        ends_of_index((low + last.offset, high + last.offset), array.shape[len(outer)])
    row = view(arithmetic, array, outer)
    shifted = arithmetic.binary(ast.Add(), last.first, last.offset) if last.offset else last.first
    return replace(row, pointer=_moved(arithmetic, row.pointer, shifted, array.element), shape=()), arithmetic.lanes


def load(arithmetic: Arithmetic, element: Array, lanes: int) -> Number:
    """Load the number at a `place`."""
    if element.element is Element.SIGNAL:
        byte = arithmetic.text.value(f"load volatile i8, ptr {element.pointer}")
        return Number(Kind.INTEGER, arithmetic.text.value(f"zext i8 {byte} to i64"), bounds=(0, 255))
    kind = type_of(Kind.FLOAT, lanes)
    return Number(Kind.FLOAT, arithmetic.text.value(f"load {kind}, ptr {element.pointer}, align 8"), lanes)


def store(arithmetic: Arithmetic, element: Array, lanes: int, value: Value) -> None:
    """Store a number at a `place`."""
    if element.element is Element.SIGNAL or not element.writable:
        message = "signals, and arrays of a module, are read only"
        raise Refusal(message)
    number = arithmetic.number(value, Kind.FLOAT)
    if number.lanes and not lanes:
        message = "lanes are stored in one element; store each lane in its own element"
        raise Refusal(message)
    number = arithmetic.wide(number) if lanes else number
    arithmetic.text.line(f"store {number.operand}, ptr {element.pointer}, align 8")


def table(arithmetic: Arithmetic, values: np.ndarray) -> Array:
    """Return a constant array of the compiled module."""
    numbers = [constant(float(value), Kind.FLOAT).operand for value in values.ravel()]
    return Array(arithmetic.module.table(numbers), values.shape, _without_gaps(values.shape), writable=False)


def _is_known(shape: tuple[Value, ...]) -> bool:
    return all(isinstance(length, int) for length in shape)


def _without_gaps(shape: tuple[Value, ...]) -> tuple[int, ...]:
    """Return the strides of a contiguous array of known shape, or nothing."""
    return tuple(math.prod(shape[axis + 1 :]) for axis in range(len(shape))) if _is_known(shape) else ()


def _bytes(array: Array) -> int:
    lengths: tuple[Value, ...] = array.shape
    return int(array.element) * math.prod(lengths)


def _ends(arithmetic: Arithmetic, index: slice, length: Value) -> tuple[Value, Value]:
    if index.step is not None:
        message = "slices take every element; write a loop"
        raise Refusal(message)
    if isinstance(length, int) and not any(isinstance(end, Number) for end in (index.start, index.stop)):
        start, end, _ = index.indices(length)
        return start, max(start, end)
    if arithmetic.checked:
        message = "the ends of a slice, and the length of what is cut, must be known; write a loop"
        raise Refusal(message)
    start = 0 if index.start is None else _from_the_start(arithmetic, index.start, length)
    end = length if index.stop is None else _from_the_start(arithmetic, index.stop, length)
    return start, end


def counted(arithmetic: Arithmetic, index: Value, length: Value) -> Value:
    """Return an index of an array or tuple, counted from its start."""
    if isinstance(length, int) and is_known_number(index) and not -length <= index < length:
        message = f"index {index} lies beyond the length {length}; count from 0 to {length - 1}"
        raise Refusal(message)
    index = _from_the_start(arithmetic, index, length)
    if not isinstance(index, Number) or not arithmetic.checked:
        return index
    from_start, from_end = ends_of_index(bounds_of(index), length)
    if not from_end:
        return index
    backwards = arithmetic.binary(ast.Add(), index, length)
    if not from_start:
        return backwards
    return arithmetic.chosen(arithmetic.compared(ast.Lt(), index, 0), backwards, index)


def _is_truth(index: Value) -> bool:
    return isinstance(index, bool) or (isinstance(index, Number) and index.kind is Kind.BOOLEAN)


def _from_the_start(arithmetic: Arithmetic, index: Value, length: Value) -> Value:
    if isinstance(index, Number):
        return arithmetic.number(index, Kind.INTEGER)
    if isinstance(index, LaneIndex):
        message = "the index of a loop over lanes belongs in the last axis"
        raise Refusal(message)
    if not isinstance(index, int | np.integer):
        message = f"an index is a whole number, not {index!r}"
        raise Refusal(message)
    return int(index) if index >= 0 else arithmetic.binary(ast.Add(), length, int(index))


def _moved(arithmetic: Arithmetic, pointer: str, by: Number, element: Element) -> str:
    kind = "double" if element is Element.FLOAT else "i8"
    return arithmetic.text.value(f"getelementptr {kind}, ptr {pointer}, {by.operand}")
