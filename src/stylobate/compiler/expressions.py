"""Compilation of expressions: known values are evaluated, all others become instructions."""

import ast
import dataclasses
import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import replace
from enum import EnumType
from functools import cache
from types import MethodType
from typing import Any

import numpy as np

from stylobate.compiler import marks, memory, objects
from stylobate.compiler.arithmetic import Arithmetic, truth_of_known
from stylobate.compiler.reads import Reads, is_plain
from stylobate.compiler.sources import Refusal
from stylobate.compiler.values import (
    Array,
    LaneIndex,
    Number,
    NumberKind,
    Value,
    bounds_of,
    is_known_number,
    joined,
    kind_of,
)

_OF_LLVM = (
    *("sqrt", "fabs", "sin", "cos", "exp", "exp2", "log", "log2", "log10", "pow", "copysign", "floor", "ceil", "trunc"),
    *("rint", "minimum", "maximum"),
)
_OF_C_LIBRARY = (
    *("tan", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh", "asinh", "acosh", "atanh"),
    *("hypot", "expm1", "log1p", "cbrt", "erf", "erfc", "fmod"),
)
_NAMES_OF_NUMPY = {
    "arcsin": "asin",
    "arccos": "acos",
    "arctan": "atan",
    "arctan2": "atan2",
    "arcsinh": "asinh",
    "arccosh": "acosh",
    "arctanh": "atanh",
    "power": "pow",
    "absolute": "fabs",
}
_WHOLE_IN_PYTHON = ("floor", "ceil", "trunc")


def is_mathematics(function: Any) -> bool:
    """Return whether the compiler supports this function."""
    return _name_of(function) is not None


def call(arithmetic: Arithmetic, function: Callable[..., Any], values: list[Value]) -> Value:
    """Return the result of a mathematical function, see `is_mathematics`."""
    if function is len:
        return _length(values[0])
    if all(is_known_number(value) for value in values):
        known = function(*values)
        return known.item() if isinstance(known, np.ndarray | np.generic) else known
    name = _name_of(function) or ""
    own = _OWN.get(name)
    if own is not None:
        return own(arithmetic, *values)
    if name in _OF_C_LIBRARY:
        return arithmetic.called_in_library(name, *values)
    result = arithmetic.called(f"llvm.{name}", *values)
    if name in _WHOLE_IN_PYTHON and not isinstance(function, np.ufunc) and (arithmetic.checked or not result.lanes):
        return arithmetic.whole(result)
    return result


def _name_of(function: Any) -> str | None:
    """Return the name of a function in the compiler, or None."""
    own = getattr(function, "__name__", "")
    if isinstance(function, np.ufunc):
        name = _NAMES_OF_NUMPY.get(own, own)
        return name if name in _OF_LLVM or name in _OF_C_LIBRARY or name in _OWN_OF_NUMPY else None
    if function in (np.where, np.clip, np.any, np.all):
        return str(own)
    if getattr(math, own, None) is function:
        return own if own in _OF_LLVM or own in _OF_C_LIBRARY or own in _OWN else None
    return own if function in _OF_PYTHON else None


def _length(value: Value) -> Value:
    if isinstance(value, Array):
        return value.shape[0]
    if isinstance(value, tuple | list | range | str | EnumType):
        return len(value)
    raise Refusal("len(...) needs an array, or a value that is known at compile time")


def _absolute(arithmetic: Arithmetic, value: Value) -> Value:
    number = arithmetic.number(value)
    if number.kind is NumberKind.FLOAT:
        return arithmetic.called("llvm.fabs", number)
    negative = arithmetic.compared(ast.Lt(), number, 0)
    result = arithmetic.chosen(negative, arithmetic.negative(number), arithmetic.number(number, NumberKind.INTEGER))
    low, high = bounds_of(number)
    return replace(result, bounds=(max(low, -high, 0), max(-low, high))) if arithmetic.checked else result


def _extreme(comparison: ast.cmpop, extreme: Callable[..., int]) -> Callable[..., Value]:
    def found(arithmetic: Arithmetic, *values: Value) -> Value:
        if len(values) == 1:
            (values,) = values
        if not isinstance(values, tuple) or not values:
            raise Refusal("min and max need two numbers, or a tuple of numbers")
        result, *others = values
        for value in others:
            before = result
            result = arithmetic.chosen(arithmetic.compared(comparison, value, before), value, before)
            if arithmetic.checked and isinstance(result, Number) and result.kind is NumberKind.INTEGER:
                low, high = map(extreme, bounds_of(value), bounds_of(before))
                result = replace(result, bounds=(low, high))
        return result

    return found


def _is_none(arithmetic: Arithmetic, value: Value) -> Value:
    return arithmetic.compared(ast.NotEq(), value, value)


def _is_infinite(arithmetic: Arithmetic, value: Value) -> Value:
    return arithmetic.compared(ast.Eq(), _absolute(arithmetic, value), math.inf)


def _is_finite(arithmetic: Arithmetic, value: Value) -> Value:
    return arithmetic.compared(ast.Lt(), _absolute(arithmetic, value), math.inf)


def _float(arithmetic: Arithmetic, value: Value) -> Number:
    if isinstance(value, str):
        raise Refusal(f"float({value!r}) is not compiled; write math.inf, math.nan or the number")
    return arithmetic.number(value, NumberKind.FLOAT)


def _scaled(factor: float) -> Callable[[Arithmetic, Value], Value]:
    return lambda arithmetic, value: arithmetic.binary(ast.Mult(), value, factor)


def _sum(arithmetic: Arithmetic, values: Value, start: Value = 0) -> Value:
    for value in values:
        start = arithmetic.binary(ast.Add(), start, value)
    return start


def _length_of_vector(arithmetic: Arithmetic, *values: Value) -> Value:
    result, *others = values
    for value in others:
        result = arithmetic.called_in_library("hypot", result, value)
    return result if others else _absolute(arithmetic, result)


def _logarithm(arithmetic: Arithmetic, value: Value, base: Value = None) -> Value:
    result = arithmetic.called("llvm.log", value)
    return result if base is None else arithmetic.binary(ast.Div(), result, arithmetic.called("llvm.log", base))


def _square(arithmetic: Arithmetic, value: Value) -> Value:
    return arithmetic.binary(ast.Mult(), value, value)


def _sign(arithmetic: Arithmetic, value: Value) -> Value:
    negative, positive = (arithmetic.compared(operation, value, 0.0) for operation in (ast.Lt(), ast.Gt()))
    # The sign of NaN is NaN, that of both zeros is 0.0.
    neither = arithmetic.binary(ast.Mult(), _absolute(arithmetic, value), 0.0)
    return arithmetic.chosen(positive, 1.0, arithmetic.chosen(negative, -1.0, neither))


def _not_nan(comparison: ast.cmpop) -> Callable[..., Value]:
    """Return the function for the larger or smaller of two numbers, or the one that is not NaN."""

    def found(arithmetic: Arithmetic, a: Value, b: Value) -> Value:
        chosen = arithmetic.chosen(arithmetic.compared(comparison, b, a), b, a)
        return arithmetic.chosen(_is_none(arithmetic, a), b, chosen)

    return found


def _clipped(arithmetic: Arithmetic, value: Value, low: Value, high: Value) -> Value:
    return arithmetic.called("llvm.minimum", arithmetic.called("llvm.maximum", value, low), high)


_OWN_OF_NUMPY = ("square", "sign", "fmax", "fmin", "isnan", "isinf", "isfinite")
_OF_PYTHON = (abs, min, max, sum, int, float, bool, len)
_OWN: dict[str, Callable[..., Value]] = {
    "sum": _sum,
    "hypot": _length_of_vector,
    "log": _logarithm,
    "square": _square,
    "sign": _sign,
    "clip": _clipped,
    "where": Arithmetic.chosen,
    "any": Arithmetic.truth,
    "all": Arithmetic.truth,
    "fmax": _not_nan(ast.Gt()),
    "fmin": _not_nan(ast.Lt()),
    "abs": _absolute,
    "min": _extreme(ast.Lt(), min),
    "max": _extreme(ast.Gt(), max),
    "int": Arithmetic.whole,
    "float": _float,
    "bool": Arithmetic.truth,
    "isnan": _is_none,
    "isinf": _is_infinite,
    "isfinite": _is_finite,
    "radians": _scaled(math.pi / 180.0),
    "degrees": _scaled(180.0 / math.pi),
}


_OVER_TUPLES = (zip, enumerate, reversed, tuple)
_OF_ARRAYS: dict[Any, Callable[..., Array]] = {marks.flat: memory.flat, np.zeros: memory.room}


class Expressions(ABC):
    """Compiler of the expressions of one function.

    Parameters
    ----------
    arithmetic
        Writer of its instructions.
    reads
        Log of the values that it reads.
    followed
        Whether the function belongs to a model, so that changes of these values must be noticed.
    """

    def __init__(self, arithmetic: Arithmetic, reads: Reads, *, followed: bool) -> None:
        self.arithmetic, self.reads, self.followed = arithmetic, reads, followed
        self.text = arithmetic.text

    @property
    @abstractmethod
    def in_loop(self) -> bool:
        """Whether the current instructions are inside a loop."""

    @abstractmethod
    def read(self, name: str) -> Value:
        """Return the value of a name."""

    @abstractmethod
    def call(self, function: Callable[..., Any], values: list[Value], keywords: dict[str, Value]) -> Value:
        """Return the result of a function written in Python."""

    @abstractmethod
    def generated(self, node: ast.GeneratorExp) -> tuple[Value, ...]:
        """Return the values of a generator, as a tuple."""

    def value(self, node: ast.expr) -> Value:  # noqa: C901, PLR0911, PLR0912  one case for each form
        """Return the value of an expression."""
        match node:
            case ast.Constant():
                return node.value
            case ast.Name():
                return self._usable(self.read(node.id))
            case ast.Attribute():
                return self._attribute(node)
            case ast.Tuple():
                return tuple(self._items(node.elts))
            case ast.UnaryOp():
                return self._unary(node)
            case ast.BinOp():
                return self.arithmetic.binary(node.op, self.value(node.left), self.value(node.right))
            case ast.BoolOp():
                return self._all_or_any(node, condition=False)
            case ast.Compare():
                return self._comparison(node)
            case ast.IfExp():
                return self._conditional(node)
            case ast.Subscript():
                return self._element(node)
            case ast.Call():
                return self._called(node)
            case ast.GeneratorExp():
                return self.generated(node)
            case _:
                raise Refusal(f"{type(node).__name__} is not compiled; write it with loops, conditions and calls")

    def indices(self, node: ast.Subscript) -> list[Value]:
        """Return the indices of a subscript."""
        parts = node.slice.elts if isinstance(node.slice, ast.Tuple) else [node.slice]
        return [self._index(part) for part in parts]

    def _index(self, node: ast.expr) -> Value:
        if not isinstance(node, ast.Slice):
            return self.value(node)
        ends = (None if end is None else self.value(end) for end in (node.lower, node.upper, node.step))
        return slice(*ends)

    def _usable(self, value: Value) -> Value:
        if isinstance(value, np.ndarray):
            if value.dtype != np.float64:
                raise Refusal(f"arrays hold floats, not {value.dtype}; write np.array(..., dtype=float)")
            return memory.table(self.arithmetic, value)
        if isinstance(value, np.generic) and not isinstance(value, np.float64 | np.int64):
            raise Refusal(f"numbers of the type {value.dtype} follow rules of their own; write float(...) or int(...)")
        return value.item() if isinstance(value, np.generic) else value

    def _attribute(self, node: ast.Attribute) -> Value:
        owner = self.value(node.value)
        if objects.is_object(owner):
            return self._member(owner, node.attr)
        if isinstance(owner, Array) and node.attr == "shape":
            return owner.shape
        foreign = isinstance(owner, tuple) and node.attr not in getattr(owner, "_fields", ())
        if isinstance(owner, Array | Number | LaneIndex) or foreign or not hasattr(owner, node.attr):
            raise Refusal(f"{ast.unparse(node)} is not known at compile time")
        value = getattr(owner, node.attr)
        if self.followed and not (isinstance(owner, tuple) or is_plain(owner) or self.reads.logs(owner)):
            raise Refusal(f"a change of {ast.unparse(node)} would not be noticed; keep it in a variable of the module")
        self.reads.log(owner, "attribute", node.attr, value)
        return self._usable(value)

    def _member(self, owner: Value, name: str) -> Value:
        """Return a field, a property or a method of an object."""
        if name in owner._fields:
            return getattr(owner, name)
        meaning, found = objects.member(owner, name)
        return self.call(found, [owner], {}) if meaning == "property" else self._usable(found)

    def _items(self, nodes: list[ast.expr]) -> list[Value]:
        out: list[Value] = []
        for node in nodes:
            if isinstance(node, ast.Starred):
                out += self.items(self.value(node.value))
            else:
                out.append(self.value(node))
        return out

    def items(self, value: Value) -> tuple[Value, ...]:
        """Return the parts of a tuple, or the elements of a row of known length."""
        if isinstance(value, Array):
            return memory.elements(self.arithmetic, value)
        if not isinstance(value, tuple | range):
            raise Refusal("expected a tuple whose length is known at compile time")
        return tuple(value)

    @staticmethod
    def _tuple(value: Value) -> Value:
        if not isinstance(value, tuple | list | range):
            raise Refusal("only tuples are enumerated, zipped and reversed; write a loop over range(len(...))")
        return value

    def _unary(self, node: ast.UnaryOp) -> Value:
        match node.op:
            case ast.USub():
                return self.arithmetic.negative(self.value(node.operand))
            case ast.Not():
                return self.arithmetic.opposite(self.condition(node.operand))
            case ast.Invert():
                value = self.value(node.operand)
                if kind_of(value) is not NumberKind.BOOLEAN:
                    raise Refusal("~ is the opposite of a condition; bits of whole numbers are not compiled")
                return self.arithmetic.opposite(value)
            case ast.UAdd():
                return self.value(node.operand)
            case _:
                raise Refusal("bits of whole numbers are not compiled")

    def condition(self, node: ast.expr) -> Value:
        """Return the truth value of an expression; nonzero is true."""
        if isinstance(node, ast.BoolOp):
            return self._all_or_any(node, condition=True)
        value = self.value(node)
        if isinstance(value, Array | LaneIndex):
            raise Refusal(f"{ast.unparse(node)} is not a condition")
        return self.arithmetic.truth(value) if isinstance(value, Number) else truth_of_known(value)

    def _all_or_any(self, node: ast.BoolOp, *, condition: bool) -> Value:
        """Evaluate `and` or `or`, outside lanes with the short circuit of Python."""
        decisive = isinstance(node.op, ast.Or)
        part = self.condition if condition else self.value
        value: Value = not decisive
        for position, one in enumerate(node.values):
            value, others = part(one), node.values[position + 1 :]
            if isinstance(value, Number | Array | LaneIndex):
                return self._in_turn(one, value, others, condition=condition, decisive=decisive) if others else value
            if truth_of_known(value) is decisive:
                return value
        return value

    def _boolean(self, node: ast.expr, value: Value) -> Value:
        """Return an operand of `and` or `or` whose value is used; refuse numbers: Python returns them as they are."""
        if not (isinstance(value, bool) or (isinstance(value, Number) and value.kind is NumberKind.BOOLEAN)):
            raise Refusal(
                f"the value of and, or is used: {ast.unparse(node)} is no condition; write a if condition else b"
            )
        return value

    def _in_turn(
        self, one: ast.expr, first: Value, others: list[ast.expr], *, condition: bool, decisive: bool
    ) -> Value:
        """Evaluate operands whose truth is known at run time only; without lanes the first decisive one is the last."""

        def part(node: ast.expr) -> Value:
            return self.condition(node) if condition else self._boolean(node, self.value(node))

        first = first if condition else self._boolean(one, first)
        if self.arithmetic.lanes:
            joined = self.arithmetic.either if decisive else self.arithmetic.both
            for other in others:
                first = joined(first, part(other))
            return first
        result, done = self.text.allocated("i1"), self.text.new_block()
        value = self.arithmetic.truth(first)
        for other in others:
            self.text.line(f"store {value.operand}, ptr {result}")
            more = self.text.new_block()
            self.text.branch(value.text, *((done, more) if decisive else (more, done)))
            self.text.begin(more)
            value = self.arithmetic.truth(part(other))
        self.text.line(f"store {value.operand}, ptr {result}")
        self.text.jump(done)
        self.text.begin(done)
        return Number(NumberKind.BOOLEAN, self.text.value(f"load i1, ptr {result}"))

    def _comparison(self, node: ast.Compare) -> Value:
        left, result = self.value(node.left), True
        for operation, right_node in zip(node.ops, node.comparators, strict=True):
            right = self.value(right_node)
            result = self.arithmetic.both(result, self._compared(operation, left, right))
            left = right
        return result

    def _compared(self, operation: ast.cmpop, left: Value, right: Value) -> Value:
        if not isinstance(operation, ast.In | ast.NotIn):
            return self.arithmetic.compared(operation, left, right)
        found: Value = False
        for item in self.items(right):
            found = self.arithmetic.either(found, self.arithmetic.compared(ast.Eq(), left, item))
        return self.arithmetic.opposite(found) if isinstance(operation, ast.NotIn) else found

    def _conditional(self, node: ast.IfExp) -> Value:
        condition = self.condition(node.test)
        if not isinstance(condition, Number):
            return self.value(node.body if condition else node.orelse)
        if self.arithmetic.lanes or not (_is_costly(node.body) or _is_costly(node.orelse)):
            return self.arithmetic.chosen(condition, self.value(node.body), self.value(node.orelse))
        yes, no, done = (self.text.new_block() for _ in range(3))
        self.text.branch(condition.text, yes, no)
        self.text.begin(yes)
        first = self.value(node.body)
        end_of_yes = self.text.block
        self.text.begin(no)
        second = self.value(node.orelse)
        slot = memory.slot_for(self.arithmetic, _wider(first, second))
        memory.store_slot(self.arithmetic, slot, second)
        self.text.jump(done)
        self.text.block = end_of_yes
        memory.store_slot(self.arithmetic, slot, first)
        self.text.jump(done)
        self.text.begin(done)
        return memory.load_slot(self.arithmetic, slot)

    def _element(self, node: ast.Subscript) -> Value:
        owner, indices = self.value(node.value), self.indices(node)
        if isinstance(owner, tuple | range):
            return self._of_tuple(tuple(owner), indices[0])
        if not isinstance(owner, Array):
            raise Refusal(f"{ast.unparse(node)} is not an element of an array or a tuple")
        if len(indices) < len(owner.shape) or any(isinstance(index, slice) for index in indices):
            return memory.view(self.arithmetic, owner, indices)
        return memory.load_element(self.arithmetic, *memory.place(self.arithmetic, owner, indices))

    def _of_tuple(self, items: tuple[Value, ...], index: Value) -> Value:
        if isinstance(index, LaneIndex):
            raise Refusal("the index of a loop over lanes cannot select from a tuple")
        if not isinstance(index, Number):
            return items[index]
        index = memory.counted(self.arithmetic, index, len(items))
        result = items[-1]
        for position, item in reversed(list(enumerate(items[:-1]))):
            result = self.arithmetic.chosen(self.arithmetic.compared(ast.Eq(), index, position), item, result)
        return result

    def _called(self, node: ast.Call) -> Value:
        function = self.value(node.func)
        values = self._items(node.args)
        keywords = {keyword.arg or "": self.value(keyword.value) for keyword in node.keywords}
        if isinstance(function, objects.Method | MethodType):
            values = [function.owner if isinstance(function, objects.Method) else function.__self__, *values]
            function = function.function if isinstance(function, objects.Method) else function.__func__
        function = marks.compiled_for(function)
        if is_mathematics(function) and not keywords:
            return call(self.arithmetic, function, values)
        make = _maker_of(function)
        return self._of_python(function, values, keywords) if make is None else make(*values, **keywords)

    def _of_python(self, function: Any, values: list[Value], keywords: dict[str, Value]) -> Value:
        """Return the result of a function of arrays or of tuples, or of one that is written in Python."""
        if function is np.asarray:
            return self.arithmetic.number(values[0])
        if function in _OF_ARRAYS and not keywords:
            if function is np.zeros and self.in_loop:
                raise Refusal("an array made in each pass of a loop; make one before it")
            return _OF_ARRAYS[function](self.arithmetic, *values)
        if function is range and all(isinstance(value, int) for value in values):
            return range(*values)
        if function in _OVER_TUPLES:
            return tuple(function(*map(self._tuple, values), **keywords))
        return self.call(function, values, keywords)


def _maker_of(function: Any) -> Callable[..., Value] | None:
    """Return the function that makes a named tuple or an object at compile time; None for other functions."""
    if _is_named_tuple(function):
        make: Callable[..., Value] = function
        return make
    if objects.is_class(function):
        return lambda *values, **keywords: objects.made(function, values, keywords)
    return objects.changed if function is dataclasses.replace else None


def _is_named_tuple(function: Any) -> bool:
    """Return whether this is the class of a named tuple, whose creation does nothing else."""
    if not isinstance(function, type) or not issubclass(function, tuple) or function.__init__ is not tuple.__init__:
        return False
    names = getattr(function.__new__, "__globals__", {})  # of `collections.namedtuple`
    return str(names.get("__name__", "")).startswith("namedtuple_")


@cache
def _is_costly(node: ast.expr) -> bool:
    """Return whether an expression is costly, so that only the chosen branch is evaluated."""
    return any(isinstance(part, ast.Call | ast.Subscript) for part in ast.walk(node))


def _wider(a: Value, b: Value) -> Value:
    """Return a value with the wider kinds of two values of one structure."""
    if isinstance(a, tuple) and isinstance(b, tuple) and type(a) is type(b) and len(a) == len(b):
        made = [_wider(*pair) for pair in zip(a, b, strict=True)]
        return type(a)(*made) if hasattr(a, "_fields") else tuple(made)
    if isinstance(a, Array | tuple) or isinstance(b, Array | tuple):
        return a
    wider = max(a, b, key=kind_of)
    if isinstance(wider, Number) and wider.kind is NumberKind.INTEGER:
        return replace(wider, bounds=joined(bounds_of(a), bounds_of(b)))
    return wider
