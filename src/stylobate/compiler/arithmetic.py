"""Arithmetic on numbers of compiled code, single or in lanes, with the results of Python.

Differences: division by zero gives infinity or NaN instead of an error, and whole numbers have 64 bits.
"""

import ast
import math
import operator
import types
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from enum import Enum
from typing import Any

from stylobate.compiler.sources import LanesRefusal, Refusal
from stylobate.compiler.text import FunctionText, ModuleText
from stylobate.compiler.values import (
    ANY,
    BEYOND_FLOATS,
    Array,
    Bounds,
    LaneIndex,
    Number,
    NumberKind,
    Value,
    after,
    bounds_of,
    constant,
    is_known_number,
    joined,
    kind_of,
    rebuilt,
    type_of,
)

FAST = "contract arcp nsz afn "
"""Flags of fast arithmetic: neither "nnan" nor "ninf", so that NaN and infinity are kept."""

_KNOWN: dict[type, Callable[[Any, Any], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Pow: operator.pow,
    ast.FloorDiv: operator.floordiv,
    ast.Mod: operator.mod,
    ast.BitAnd: operator.and_,
    ast.BitOr: operator.or_,
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
    ast.Is: operator.is_,
    ast.IsNot: operator.is_not,
}
_BINARY = (ast.Add, ast.Sub, ast.Mult, ast.Div, ast.Pow, ast.FloorDiv, ast.Mod)
_FLOAT = {ast.Add: "fadd", ast.Sub: "fsub", ast.Mult: "fmul", ast.Div: "fdiv"}
_INTEGER = {ast.Add: "add", ast.Sub: "sub", ast.Mult: "mul"}
_COMPARED = {
    ast.Lt: ("olt", "slt"),
    ast.LtE: ("ole", "sle"),
    ast.Gt: ("ogt", "sgt"),
    ast.GtE: ("oge", "sge"),
    ast.Eq: ("oeq", "eq"),
    ast.NotEq: ("une", "ne"),
}

_COMPARABLE = (str, bytes, tuple, list, range, Enum, types.ModuleType)
"""Known values, besides numbers, that can be compared and be conditions."""

_BEYOND = 2**63
MOST_FACTORS = 16
"""Maximum known whole exponent for which a power is a product."""


class Arithmetic:
    """Writer of the arithmetic instructions of a function.

    Parameters
    ----------
    module, text
        Module and function that receive the instructions.
    fast
        Whether results may be rounded differently, see `marks.fast`.
    """

    def __init__(self, module: ModuleText, text: FunctionText, *, fast: bool) -> None:
        self.module, self.text = module, text
        self.flags = FAST if fast else ""
        self.lanes = 0
        self.checked = False
        """Whether whole numbers must have bounds, see `values`."""

    @contextmanager
    def checking(self, checked: bool) -> Iterator[None]:
        """Make whole numbers have bounds, or not, within the context."""
        before, self.checked = self.checked, checked
        try:
            yield
        finally:
            self.checked = before

    # Numbers and their kinds

    def number(self, value: Value, kind: NumberKind | None = None) -> Number:
        """Return a value as a number of the compiled code, of the kind `kind`.

        Raises
        ------
        Refusal
            If the value is not a number, or the kind cannot represent it.
        """
        if isinstance(value, Number):
            return value if kind is None or value.kind is kind else self._converted(value, kind)
        if not is_known_number(value):
            raise Refusal(f"expected a number, got {_described(value)}")
        own = kind_of(value)
        if own is NumberKind.INTEGER and abs(value) >= _BEYOND:
            raise Refusal(f"whole numbers have 64 bits, {value} has more")
        if kind is not None and kind < own and kind is NumberKind.INTEGER:
            raise Refusal(f"expected a whole number, got {value}")
        return constant(value, own if kind is None else kind)

    def _converted(self, number: Number, kind: NumberKind) -> Number:
        if kind is NumberKind.BOOLEAN:
            return self.number(self.compared(ast.NotEq(), number, 0))
        if kind < number.kind:
            raise Refusal("expected a whole number, got one with a fraction; write int(...)")
        instruction = (
            "sitofp" if number.kind is NumberKind.INTEGER else "uitofp" if kind is NumberKind.FLOAT else "zext"
        )
        text = self.text.value(f"{instruction} {number.operand} to {type_of(kind, number.lanes)}")
        return Number(kind, text, number.lanes, (0, 1) if kind is NumberKind.INTEGER else None)

    def truth(self, value: Value) -> Number:
        """Return whether a number is not zero."""
        return self.number(value, NumberKind.BOOLEAN)

    def wide(self, number: Number) -> Number:
        """Repeat a number in each lane."""
        if number.lanes or not self.lanes:
            return number
        kind = type_of(number.kind, self.lanes)
        one = self.text.value(f"insertelement {kind} poison, {number.operand}, i32 0")
        text = self.text.value(f"shufflevector {kind} {one}, {kind} poison, <{self.lanes} x i32> zeroinitializer")
        return replace(number, text=text, lanes=self.lanes)

    def alike(self, *values: Value, kind: NumberKind | None = None) -> list[Number]:
        """Convert values to one kind, by default the smallest common kind, in lanes if any value is in lanes."""
        kind = max(map(kind_of, values)) if kind is None else kind
        if any(isinstance(value, Number) and value.lanes for value in values):
            return [
                constant(value, kind, self.lanes)
                if not isinstance(value, Number) and is_known_number(value)
                else self.wide(self.number(value, kind))
                for value in values
            ]
        return [self.number(value, kind) for value in values]

    # Operations

    def binary(self, operation: ast.operator, a: Value, b: Value) -> Value:
        """Return the result of a binary operation."""
        if type(operation) not in (*_BINARY, ast.BitAnd, ast.BitOr):
            raise Refusal(f"{type(operation).__name__} is not compiled; write it with +, -, *, /, //, % and **")
        if isinstance(a, LaneIndex) or isinstance(b, LaneIndex):
            return _moved(operation, a, b)
        if isinstance(a, tuple) and isinstance(b, tuple | int) and isinstance(operation, ast.Add | ast.Mult):
            return (*a, *b) if isinstance(b, tuple) else a * b
        if is_known_number(a) and is_known_number(b):
            return _quotient(a, b) if isinstance(operation, ast.Div) else _KNOWN[type(operation)](a, b)
        if isinstance(operation, ast.Pow | ast.BitAnd | ast.BitOr):
            return self._power(a, b) if isinstance(operation, ast.Pow) else self._joined_conditions(operation, a, b)
        least = NumberKind.FLOAT if isinstance(operation, ast.Div) else NumberKind.INTEGER
        x, y = self.alike(a, b, kind=max(least, *map(self._kind, (a, b))))
        bounds = self._bounds(operation, x, y) if x.kind is NumberKind.INTEGER and self.checked else None
        if x.kind is NumberKind.INTEGER and isinstance(operation, ast.FloorDiv | ast.Mod):
            with self.checking(False):
                return replace(self._divided(operation, x, y), bounds=bounds)
        names = _FLOAT if x.kind is NumberKind.FLOAT else _INTEGER
        if type(operation) not in names:
            raise Refusal(f"{type(operation).__name__} of numbers with a fraction; write a - b * math.floor(a / b)")
        flags = self.flags if x.kind is NumberKind.FLOAT else ""
        text = self.text.value(f"{names[type(operation)]} {flags}{x.operand}, {y.text}")
        return Number(x.kind, text, x.lanes, bounds)

    def _joined_conditions(self, operation: ast.operator, a: Value, b: Value) -> Value:
        """Return `a & b` or `a | b` of conditions."""
        if any(kind_of(one) is not NumberKind.BOOLEAN for one in (a, b)):
            raise Refusal("& and | join conditions; bits of whole numbers are not compiled")
        return self.both(a, b) if isinstance(operation, ast.BitAnd) else self.either(a, b)

    @staticmethod
    def _bounds(operation: ast.operator, x: Number, y: Number) -> Bounds:
        return after(operation, bounds_of(x), bounds_of(y))

    def _kind(self, value: Value) -> NumberKind:
        return self.number(value).kind

    def _divided(self, operation: ast.operator, x: Number, y: Number) -> Number:
        # LLVM rounds quotients of whole numbers towards zero, Python rounds down.
        y = self.number(self.chosen(self.compared(ast.Eq(), y, 0), 1, y))  # division by zero would trap
        rest = Number(NumberKind.INTEGER, self.text.value(f"srem {x.operand}, {y.text}"), x.lanes)
        apart = self.text.value(f"xor {rest.operand}, {y.text}")
        opposite = self.compared(ast.Lt(), Number(NumberKind.INTEGER, apart, x.lanes), 0)
        one_off = self.both(self.compared(ast.NotEq(), rest, 0), opposite)
        if isinstance(operation, ast.Mod):
            return self.number(self.chosen(one_off, self.binary(ast.Add(), rest, y), rest))
        whole = Number(NumberKind.INTEGER, self.text.value(f"sdiv {x.operand}, {y.text}"), x.lanes)
        return self.number(self.chosen(one_off, self.binary(ast.Sub(), whole, 1), whole))

    def _power(self, base: Value, exponent: Value) -> Value:
        whole = is_known_number(exponent) and exponent == int(exponent) and 0 < exponent <= MOST_FACTORS
        if not whole:
            if (
                isinstance(exponent, Number)
                and max(kind_of(base), kind_of(exponent)) < NumberKind.FLOAT
                and self.checked
            ):
                raise Refusal(
                    "a power of whole numbers is a whole number or not, as the exponent is; write float(a) ** b"
                )
            return self.called("llvm.pow", base, exponent)
        base = self.number(base, max(kind_of(base), kind_of(exponent), NumberKind.INTEGER))
        left, square, result = int(exponent), base, None
        while left:
            if left % 2:
                result = square if result is None else self.binary(ast.Mult(), result, square)
            left //= 2
            if left:
                square = self.binary(ast.Mult(), square, square)
        return result

    def negative(self, value: Value) -> Value:
        """Return the negative of a number."""
        if is_known_number(value):
            return -value
        number = self.number(value)
        if number.kind is not NumberKind.FLOAT:
            return self.binary(ast.Sub(), 0, number)
        return Number(NumberKind.FLOAT, self.text.value(f"fneg {self.flags}{number.operand}"), number.lanes)

    def opposite(self, value: Value) -> Value:
        """Return the negation of a condition."""
        _refuse_lanes(value)
        if not isinstance(value, Number):
            return not truth_of_known(value)
        number = self.truth(value)
        always = constant(1, NumberKind.BOOLEAN, number.lanes)
        return Number(NumberKind.BOOLEAN, self.text.value(f"xor {number.operand}, {always.text}"), number.lanes)

    def compared(self, operation: ast.cmpop, a: Value, b: Value) -> Value:
        """Return the result of a comparison."""
        _refuse_lanes(a, b)
        if isinstance(operation, ast.Is | ast.IsNot) and (a is None or b is None):
            return (a is b) is isinstance(operation, ast.Is)
        if isinstance(a, tuple) and isinstance(b, tuple):
            return self._compared_tuples(operation, a, b)
        if not isinstance(a, Number) and not isinstance(b, Number):
            _refuse_own_laws(a, b)
            return _KNOWN[type(operation)](a, b)
        if type(operation) not in _COMPARED:
            raise Refusal(f"{type(operation).__name__} of numbers; write == or !=")
        least = (
            NumberKind.BOOLEAN if isinstance(operation, ast.Eq | ast.NotEq) else NumberKind.INTEGER
        )  # of one bit, 1 is below 0
        x, y = self.alike(a, b, kind=max(least, kind_of(a), kind_of(b)))
        of_floats, of_integers = _COMPARED[type(operation)]
        if x.kind is NumberKind.FLOAT:
            text = self.text.value(f"fcmp {self.flags}{of_floats} {x.operand}, {y.text}")
        else:
            text = self.text.value(f"icmp {of_integers} {x.operand}, {y.text}")
        return Number(NumberKind.BOOLEAN, text, x.lanes)

    def _compared_tuples(self, operation: ast.cmpop, a: tuple[Value, ...], b: tuple[Value, ...]) -> Value:
        if not isinstance(operation, ast.Eq | ast.NotEq):
            raise Refusal("tuples are compared by == and != only")
        equal: Value = len(a) == len(b)
        for one, other in zip(a, b, strict=False):
            equal = self.both(equal, self.compared(ast.Eq(), one, other))
        return equal if isinstance(operation, ast.Eq) else self.opposite(equal)

    def both(self, a: Value, b: Value) -> Value:
        """Return whether both conditions hold."""
        return self._joined("and", a, b)

    def either(self, a: Value, b: Value) -> Value:
        """Return whether one of two conditions holds."""
        return self._joined("or", a, b)

    def _joined(self, instruction: str, a: Value, b: Value) -> Value:
        decided = instruction == "or"
        for one, other in ((a, b), (b, a)):
            if not isinstance(one, Number):
                return decided if truth_of_known(one) is decided else other
        x, y = self.alike(a, b, kind=NumberKind.BOOLEAN)
        return Number(NumberKind.BOOLEAN, self.text.value(f"{instruction} {x.operand}, {y.text}"), x.lanes)

    def chosen(self, condition: Value, a: Value, b: Value) -> Value:
        """Return `a` if the condition holds, else `b`; both are computed."""
        if not isinstance(condition, Number):
            return a if truth_of_known(condition) else b
        if isinstance(a, tuple) or isinstance(b, tuple):
            if type(a) is not type(b) or len(a) != len(b):
                raise Refusal("a choice between two tuples of different length or class; use tuples of one structure")
            made = [self.chosen(condition, *pair) for pair in zip(a, b, strict=True)]
            return type(a)(*made) if hasattr(a, "_fields") else tuple(made)
        if a is None or isinstance(a, str):
            if a != b:
                raise Refusal(f"a choice between {a!r} and {b!r} at run time; use numbers")
            return a
        x, y = self.alike(a, b)
        bounds = None
        if x.kind is NumberKind.INTEGER and self.checked:
            bounds = joined(bounds_of(x), bounds_of(y))
        condition = self.truth(condition)
        if condition.lanes:
            x, y = self.wide(x), self.wide(y)
        text = self.text.value(f"select {condition.operand}, {x.operand}, {y.operand}")
        return Number(x.kind, text, x.lanes, bounds)

    # Functions

    def called(self, name: str, *values: Value) -> Number:
        """Return the result of an LLVM intrinsic such as `llvm.sqrt`."""
        numbers = self.alike(*values, kind=NumberKind.FLOAT)
        kind, lanes = numbers[0].type, numbers[0].lanes
        suffix = f"v{lanes}f64" if lanes else "f64"
        function = self.module.declared(f"{name}.{suffix}", kind, [kind] * len(numbers))
        text = self.text.value(f"call {self.flags}{kind} {function}({', '.join(one.operand for one in numbers)})")
        return Number(NumberKind.FLOAT, text, lanes)

    def called_in_library(self, name: str, *values: Value) -> Number:
        """Return the result of a function of the C library, called for one lane after the other."""
        numbers = self.alike(*values, kind=NumberKind.FLOAT)
        lanes = numbers[0].lanes
        function = self.module.declared(name, "double", ["double"] * len(numbers))
        if not lanes:
            operands = ", ".join(one.operand for one in numbers)
            return Number(NumberKind.FLOAT, self.text.value(f"call double {function}({operands})"))
        kind, result = numbers[0].type, "poison"
        for lane in range(lanes):
            singles = [self.text.value(f"extractelement {one.operand}, i32 {lane}") for one in numbers]
            single = self.text.value(f"call double {function}({', '.join(f'double {one}' for one in singles)})")
            result = self.text.value(f"insertelement {kind} {result}, double {single}, i32 {lane}")
        return Number(NumberKind.FLOAT, result, lanes)

    def of_lane(self, value: Value, lane: int) -> Value:
        """Return the value of one lane."""

        def single(part: Value) -> Value:
            if isinstance(part, LaneIndex):
                return self.binary(ast.Add(), part.first, part.offset + lane)
            if not isinstance(part, Number) or not part.lanes:
                return part
            return Number(part.kind, self.text.value(f"extractelement {part.operand}, i32 {lane}"), bounds=part.bounds)

        return rebuilt(value, single)

    def in_lanes(self, values: list[Value]) -> Value:
        """Join values of one structure, one for each lane, to one value."""
        first = values[0]
        if isinstance(first, tuple):
            made = [self.in_lanes(list(parts)) for parts in zip(*values, strict=True)]
            return type(first)(*made) if hasattr(first, "_fields") else tuple(made)
        if not isinstance(first, Number):
            return first
        kind, result = type_of(first.kind, len(values)), "poison"
        for lane, value in enumerate(values):
            result = self.text.value(f"insertelement {kind} {result}, {value.operand}, i32 {lane}")
        bounds = None
        if first.kind is NumberKind.INTEGER and self.checked:
            bounds = joined(*map(bounds_of, values))
        return Number(first.kind, result, len(values), bounds)

    def whole(self, value: Value) -> Value:
        """Return a number without its fraction, as `int` does; saturated at 64 bits, or at its bounds, 0 for NaN."""
        if not isinstance(value, Number):
            return int(value)
        if value.kind is not NumberKind.FLOAT:
            return self.number(value, NumberKind.INTEGER)
        if not self.checked and value.lanes:
            raise LanesRefusal("int(...) in a loop over lanes; write math.floor")
        kind, suffix = type_of(NumberKind.INTEGER, value.lanes), f"v{value.lanes}" if value.lanes else ""
        function = self.module.declared(f"llvm.fptosi.sat.{suffix}i64.{suffix}f64", kind, [value.type])
        text = self.text.value(f"call {kind} {function}({value.operand})")
        if not self.checked:
            return Number(NumberKind.INTEGER, text)
        for name, end in (("llvm.smax", -BEYOND_FLOATS), ("llvm.smin", BEYOND_FLOATS)):
            function = self.module.declared(f"{name}.{suffix}i64", kind, [kind, kind])
            limit = constant(end, NumberKind.INTEGER, value.lanes)
            text = self.text.value(f"call {kind} {function}({kind} {text}, {limit.operand})")
        return Number(NumberKind.INTEGER, text, value.lanes, ANY)


def _refuse_lanes(*values: Value) -> None:
    if any(isinstance(value, LaneIndex) for value in values):
        raise Refusal("a condition on the index of a loop over lanes; keep it in a row of the array")


def truth_of_known(value: Value) -> bool:
    """Return the truth of a known value."""
    _refuse_own_laws(value)
    return bool(value)


def _refuse_own_laws(*values: Value) -> None:
    """Refuse objects whose class decides when they are true or equal."""
    for value in values:
        if not (is_known_number(value) or value is None or isinstance(value, _COMPARABLE) or callable(value)):
            raise Refusal(f"{value!r} is compared, or is a condition, by a law of its class; use its numbers")


def _moved(operation: ast.operator, a: Value, b: Value) -> LaneIndex:
    index, step = (a, b) if isinstance(a, LaneIndex) else (b, a)
    if not isinstance(operation, ast.Add) or not isinstance(step, int):
        raise Refusal(
            "the index of a loop over lanes may only be added to known whole numbers, to find its place in a row"
        )
    return LaneIndex(index.first, index.offset + step)


def _quotient(a: float, b: float) -> float:
    if b != 0:
        return a / b
    return math.nan if a == 0 or math.isnan(a) else math.copysign(math.inf, a) * math.copysign(1.0, b)


def _described(value: Value) -> str:
    if isinstance(value, LaneIndex):
        return "the index of a loop over lanes"
    if isinstance(value, Array):
        return "an array"
    return f"a {type(value).__name__}" if isinstance(value, tuple) else repr(value)
