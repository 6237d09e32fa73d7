"""Memory slots for names that control flow assigns to; LLVM keeps most of them in registers."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

from stylobate.compiler.arithmetic import Arithmetic
from stylobate.compiler.refusal import Refusal
from stylobate.compiler.values import (
    Array,
    Bounds,
    Kind,
    LaneIndex,
    Number,
    Slot,
    Value,
    is_known_number,
    kind_of,
    rebuilt,
)
from stylobate.compiler.whole_numbers import ANY, TOO_LARGE, bounds_of, contains, joined, widened

_MOST_UNIONS = 2
"""Times for which the bounds of a name are those of all its values; then a loop changes it, and it has no bounds."""


@dataclass(frozen=True, slots=True)
class Need:
    """Kind of the numbers, and bounds of the whole numbers, that the slots of a name must hold."""

    kind: Kind = Kind.BOOLEAN
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

    def __init__(self, kind: Kind) -> None:
        super().__init__(kind)
        self.kind = kind


def can_be_stored(value: Value) -> bool:
    """Return whether a value consists of numbers and views, so that it can be chosen at run time."""
    if isinstance(value, tuple):
        return all(map(can_be_stored, value))
    return isinstance(value, Number | Array) or is_known_number(value)


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
        kind, bounds = max(kind_of(part), need.kind), None
        if arithmetic.checked and kind_of(part) < Kind.FLOAT:
            bounds = joined(bounds_of(part), *([] if need.bounds is None else [need.bounds]))
        return Slot(kind, arithmetic.text.allocated(kind.type), bounds)

    if not can_be_stored(value) or _in_lanes(value):
        message = "what control flow assigns to a name is a number, a view into an array, or a tuple of them"
        raise Refusal(message)
    return rebuilt(value, room)


def store(arithmetic: Arithmetic, slot: Value, value: Value) -> None:
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
                store(arithmetic, room, part)
        case Array(), Array() if (len(slot.shape), slot.element, slot.writable) == (
            len(value.shape),
            value.element,
            value.writable,
        ):
            arithmetic.text.line(f"store ptr {value.pointer}, ptr {slot.pointer}")
            for room, size in zip((*slot.shape, *slot.strides), (*value.shape, *value.strides), strict=True):
                if isinstance(room, Slot):
                    store(arithmetic, room, size)
                elif room != size:
                    _refuse_other_structure()
        case _:
            _refuse_other_structure()


def bounds_beyond(slot: Value, value: Value) -> Bounds | None:
    """Return the bounds of the whole numbers of a value that exceed those of their slots, None if none does."""
    if isinstance(value, tuple):
        beyond = [found for pair in zip(slot, value, strict=True) if (found := bounds_beyond(*pair)) is not None]
        return joined(*beyond) if beyond else None
    if not isinstance(slot, Slot) or slot.bounds is None or slot.kind is not Kind.INTEGER:
        return None
    bounds = bounds_of(value)
    if not contains(ANY, bounds):
        raise Refusal(TOO_LARGE)
    return None if contains(slot.bounds, bounds) else joined(slot.bounds, bounds)


def load(arithmetic: Arithmetic, slot: Value) -> Value:
    """Load the value of a slot."""

    def found(part: Value) -> Value:
        if isinstance(part, Slot):
            text = arithmetic.text.value(f"load {part.kind.type}, ptr {part.pointer}")
            return Number(part.kind, text, bounds=part.bounds if part.kind is Kind.INTEGER else None)
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
    message = "a name, or a result, is given values of different structure; give it numbers, or tuples of one length"
    raise Refusal(message)
