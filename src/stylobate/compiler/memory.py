"""Memory in compiled code: elements of arrays, views into arrays, and slots of names."""

import ast
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from stylobate.compiler.arithmetic import Arithmetic
from stylobate.compiler.objects import is_object
from stylobate.compiler.sources import LanesRefusal, Refusal
from stylobate.compiler.values import (
    ANY,
    TOO_LARGE,
    Array,
    Bounds,
    Element,
    LaneIndex,
    Number,
    NumberKind,
    Slot,
    Value,
    bounds_of,
    constant,
    contains,
    ends_of_index,
    is_known_number,
    joined,
    kind_of,
    rebuilt,
    type_of,
    widened,
)

MOST_IN_FUNCTION = 4096
"""Maximum number of elements of an array that a function creates."""


def view(arithmetic: Arithmetic, array: Array, indices: Sequence[Value]) -> Array:
    """Return the view of an array for indices and slices of its first axes."""
    if len(indices) > len(array.shape):
        raise Refusal(f"an array of {len(array.shape)} axes is indexed with {len(indices)} indices")
    if any(isinstance(index, Number) and index.lanes for index in indices):
        raise LanesRefusal("an index that differs between lanes; write a function of single numbers")
    if any(_is_truth(index) for index in indices):
        raise Refusal("an index of an array is a truth value, which selects in NumPy; write int(...)")
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
            pointer = _moved(arithmetic, pointer, arithmetic.number(step, NumberKind.INTEGER), array.element)
    if known:
        pointer = _moved(arithmetic, pointer, constant(known, NumberKind.INTEGER), array.element)
    rest = len(indices)
    shape, strides = [*shape, *array.shape[rest:]], [*strides, *array.strides[rest:]]
    return replace(array, pointer=pointer, shape=tuple(shape), strides=tuple(strides))


def room(arithmetic: Arithmetic, shape: Value) -> Array:
    """Return a small array of zeros with the lifetime of the function call."""
    shape = shape if isinstance(shape, tuple) else (shape,)
    if not _is_known(shape) or math.prod(shape) > MOST_IN_FUNCTION:
        raise Refusal(
            f"arrays made in a function have a known shape and at most {MOST_IN_FUNCTION} numbers; pass it instead"
        )
    array = Array(arithmetic.text.allocated(f"[{math.prod(shape)} x double]"), shape, _without_gaps(shape))
    clear = arithmetic.module.declared("llvm.memset.p0.i64", "void", ["ptr", "i8", "i64", "i1"])
    arithmetic.text.line(f"call void {clear}(ptr {array.pointer}, i8 0, i64 {_bytes(array)}, i1 false)")
    return array


def copy(arithmetic: Arithmetic, target: Array, source: Value) -> None:
    """Copy an array into another array of the same shape, both contiguous."""
    alike = isinstance(source, Array) and source.shape == target.shape and source.strides == target.strides
    if not alike or not target.writable or target.strides != _without_gaps(target.shape):
        raise Refusal("arrays are copied as a whole where shapes are known and equal, without gaps; write a loop")
    move = arithmetic.module.declared("llvm.memmove.p0.p0.i64", "void", ["ptr", "ptr", "i64", "i1"])
    operands = f"ptr {target.pointer}, ptr {source.pointer}, i64 {_bytes(target)}, i1 false"
    arithmetic.text.line(f"call void {move}({operands})")


def elements(arithmetic: Arithmetic, array: Array) -> tuple[Value, ...]:
    """Return the elements of an array of known length."""
    if len(array.shape) != 1 or not isinstance(array.shape[0], int):
        raise Refusal("only a row of known length can be unpacked; write a loop")
    return tuple(load_element(arithmetic, *place(arithmetic, array, [index])) for index in range(array.shape[0]))


def flat(arithmetic: Arithmetic, array: Array) -> Array:
    """Return a contiguous array as one row."""
    size: Value = 1
    for length in array.shape:
        size = arithmetic.binary(ast.Mult(), size, length)
    if _is_known(array.shape) and array.strides != _without_gaps(array.shape):
        raise Refusal("only an array without gaps is one row")
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
        raise Refusal("the index of a loop over lanes belongs in the last axis")
    if last.offset < 0:
        raise Refusal("the first lanes would lie before the array")
    if arithmetic.checked:
        low, high = bounds_of(last.first)
        ends_of_index((low + last.offset, high + last.offset), array.shape[len(outer)])
    row = view(arithmetic, array, outer)
    shifted = arithmetic.binary(ast.Add(), last.first, last.offset) if last.offset else last.first
    return replace(row, pointer=_moved(arithmetic, row.pointer, shifted, array.element), shape=()), arithmetic.lanes


def load_element(arithmetic: Arithmetic, element: Array, lanes: int) -> Number:
    """Load the number at a `place`."""
    if element.element is Element.SIGNAL:
        byte = arithmetic.text.value(f"load volatile i8, ptr {element.pointer}")
        return Number(NumberKind.INTEGER, arithmetic.text.value(f"zext i8 {byte} to i64"), bounds=(0, 255))
    kind = type_of(NumberKind.FLOAT, lanes)
    return Number(NumberKind.FLOAT, arithmetic.text.value(f"load {kind}, ptr {element.pointer}, align 8"), lanes)


def store_element(arithmetic: Arithmetic, element: Array, lanes: int, value: Value) -> None:
    """Store a number at a `place`."""
    if element.element is Element.SIGNAL or not element.writable:
        raise Refusal("signals, and arrays of a module, are read only")
    number = arithmetic.number(value, NumberKind.FLOAT)
    if number.lanes and not lanes:
        raise Refusal("lanes are stored in one element; store each lane in its own element")
    number = arithmetic.wide(number) if lanes else number
    arithmetic.text.line(f"store {number.operand}, ptr {element.pointer}, align 8")


def table(arithmetic: Arithmetic, values: np.ndarray) -> Array:
    """Return a constant array of the compiled module."""
    numbers = [constant(float(value), NumberKind.FLOAT).operand for value in values.ravel()]
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
        raise Refusal("slices take every element; write a loop")
    if isinstance(length, int) and not any(isinstance(end, Number) for end in (index.start, index.stop)):
        start, end, _ = index.indices(length)
        return start, max(start, end)
    if arithmetic.checked:
        raise Refusal("the ends of a slice, and the length of what is cut, must be known; write a loop")
    start = 0 if index.start is None else _from_the_start(arithmetic, index.start, length)
    end = length if index.stop is None else _from_the_start(arithmetic, index.stop, length)
    return start, end


def counted(arithmetic: Arithmetic, index: Value, length: Value) -> Value:
    """Return an index of an array or tuple, counted from its start."""
    if isinstance(length, int) and is_known_number(index) and not -length <= index < length:
        raise Refusal(f"index {index} lies beyond the length {length}; count from 0 to {length - 1}")
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
    return isinstance(index, bool) or (isinstance(index, Number) and index.kind is NumberKind.BOOLEAN)


def _from_the_start(arithmetic: Arithmetic, index: Value, length: Value) -> Value:
    if isinstance(index, Number):
        return arithmetic.number(index, NumberKind.INTEGER)
    if isinstance(index, LaneIndex):
        raise Refusal("the index of a loop over lanes belongs in the last axis")
    if not isinstance(index, int | np.integer):
        raise Refusal(f"an index is a whole number, not {index!r}")
    return int(index) if index >= 0 else arithmetic.binary(ast.Add(), length, int(index))


def _moved(arithmetic: Arithmetic, pointer: str, by: Number, element: Element) -> str:
    kind = "double" if element is Element.FLOAT else "i8"
    return arithmetic.text.value(f"getelementptr {kind}, ptr {pointer}, {by.operand}")


_MOST_UNIONS = 2
"""Times for which the bounds of a name are those of all its values; then a loop changes it, and it has no bounds."""


@dataclass(frozen=True, slots=True)
class Need:
    """Kind of the numbers, and bounds of the whole numbers, that the slots of a name must hold."""

    kind: NumberKind = NumberKind.BOOLEAN
    bounds: Bounds | None = None
    times: int = 0

    def together(self, other: "Need") -> "Need":
        """Return the need of both; a name whose bounds grow each time, such as a counter, has none."""
        kind = max(self.kind, other.kind)
        if other.bounds is None:
            return replace(self, kind=kind)
        before = self.bounds or other.bounds
        unite = joined if self.times < _MOST_UNIONS else widened
        return Need(kind, unite(before, other.bounds), self.times + 1)


class WiderSlotError(Exception):
    """Slots of names are too narrow: the function is compiled again with wider slots."""

    def __init__(self, needs: Mapping[str, Need]) -> None:
        super().__init__(needs)
        self.needs = needs


class WiderKindError(Exception):
    """A slot is too narrow for the kind of a number."""

    def __init__(self, kind: NumberKind) -> None:
        super().__init__(kind)
        self.kind = kind


def can_be_stored(value: Value) -> bool:
    """Return whether a value consists of numbers and views, so that it can be chosen at run time."""
    if isinstance(value, tuple):
        return all(can_be_stored(part) or (is_object(value) and _is_fixed(part)) for part in value)
    return isinstance(value, Number | Array) or is_known_number(value)


def _is_fixed(value: Value) -> bool:
    """Return whether a value is None or a text: a part of an object that is the same on all paths."""
    return value is None or isinstance(value, str)


def has_array(value: Value) -> bool:
    """Return whether a value is an array or contains one."""
    return any(map(has_array, value)) if isinstance(value, tuple) else isinstance(value, Array)


def slot_for(arithmetic: Arithmetic, value: Value, need: Need = Need()) -> Value:
    """Return slots for a value of this structure, and for what else they need to hold."""

    def room(part: Value) -> Value:
        if isinstance(part, Array):
            numbers = ((size if isinstance(size, int) else room(size)) for size in (*part.shape, *part.strides))
            sizes = tuple(numbers)
            axes = len(part.shape)
            return replace(part, pointer=arithmetic.text.allocated("ptr"), shape=sizes[:axes], strides=sizes[axes:])
        if _is_fixed(part):
            return part
        kind, bounds = max(kind_of(part), need.kind), None
        if arithmetic.checked and kind_of(part) < NumberKind.FLOAT:
            bounds = joined(bounds_of(part), *([] if need.bounds is None else [need.bounds]))
        return Slot(kind, arithmetic.text.allocated(kind.type), bounds)

    if not can_be_stored(value) or _in_lanes(value):
        raise Refusal("what control flow assigns to a name is a number, a view into an array, or a tuple of them")
    return rebuilt(value, room)


def store_slot(arithmetic: Arithmetic, slot: Value, value: Value) -> None:
    """Store a value in its slot.

    Raises
    ------
    WiderKindError
        If a number does not fit.
    Refusal
        If the value has another structure.
    """
    match slot, value:
        case Slot(), _ if isinstance(value, Number) or is_known_number(value):
            if kind_of(value) > slot.kind:
                raise WiderKindError(kind_of(value))
            arithmetic.text.line(f"store {arithmetic.number(value, slot.kind).operand}, ptr {slot.pointer}")
        case tuple(), tuple() if len(slot) == len(value) and type(slot) is type(value):
            for room, part in zip(slot, value, strict=True):
                store_slot(arithmetic, room, part)
        case Array(), Array() if (len(slot.shape), slot.element, slot.writable) == (
            len(value.shape),
            value.element,
            value.writable,
        ):
            arithmetic.text.line(f"store ptr {value.pointer}, ptr {slot.pointer}")
            for room, size in zip((*slot.shape, *slot.strides), (*value.shape, *value.strides), strict=True):
                if isinstance(room, Slot):
                    store_slot(arithmetic, room, size)
                elif room != size:
                    _refuse_other_structure()
        case _ if not (_is_fixed(slot) and slot == value):
            _refuse_other_structure()


def bounds_beyond(slot: Value, value: Value) -> Bounds | None:
    """Return the bounds of the whole numbers of a value that exceed those of their slots, None if none does."""
    if isinstance(value, tuple):
        beyond = [found for pair in zip(slot, value, strict=True) if (found := bounds_beyond(*pair)) is not None]
        return joined(*beyond) if beyond else None
    if not isinstance(slot, Slot) or slot.bounds is None or slot.kind is not NumberKind.INTEGER:
        return None
    bounds = bounds_of(value)
    if not contains(ANY, bounds):
        raise Refusal(TOO_LARGE)
    return None if contains(slot.bounds, bounds) else joined(slot.bounds, bounds)


def load_slot(arithmetic: Arithmetic, slot: Value) -> Value:
    """Load the value of a slot."""

    def found(part: Value) -> Value:
        if isinstance(part, Slot):
            text = arithmetic.text.value(f"load {part.kind.type}, ptr {part.pointer}")
            return Number(part.kind, text, bounds=part.bounds if part.kind is NumberKind.INTEGER else None)
        if isinstance(part, Array):
            pointer = arithmetic.text.value(f"load ptr, ptr {part.pointer}")
            return replace(
                part, pointer=pointer, shape=tuple(map(found, part.shape)), strides=tuple(map(found, part.strides))
            )
        return part

    return rebuilt(slot, found)


def _in_lanes(value: Value) -> bool:
    if isinstance(value, tuple):
        return any(map(_in_lanes, value))
    return isinstance(value, LaneIndex) or (isinstance(value, Number) and value.lanes > 0)


def _refuse_other_structure() -> None:
    raise Refusal(
        "a name, or a result, is given values of different structure; give it numbers, or tuples of one length"
    )
