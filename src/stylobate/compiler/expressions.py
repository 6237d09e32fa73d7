"""Compilation of expressions: known values are evaluated, all others become instructions."""

import ast
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np

from stylobate.compiler import arrays, marks, mathematics, slots
from stylobate.compiler.arithmetic import Arithmetic, truth_of_known
from stylobate.compiler.reads import Reads, is_plain
from stylobate.compiler.refusal import Refusal
from stylobate.compiler.values import Array, Kind, LaneIndex, Number, Value, kind_of
from stylobate.compiler.whole_numbers import bounds_of, joined

_OVER_TUPLES = (zip, enumerate, reversed, tuple)
_OF_ARRAYS: dict[Any, Callable[..., Array]] = {marks.flat: arrays.flat, np.zeros: arrays.room}


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
                message = f"{type(node).__name__} is not compiled; write it with loops, conditions and calls"
                raise Refusal(message)

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
                message = f"arrays hold floats, not {value.dtype}; write np.array(..., dtype=float)"
                raise Refusal(message)
            return arrays.table(self.arithmetic, value)
        if isinstance(value, np.generic) and not isinstance(value, np.float64 | np.int64):
            message = f"numbers of the type {value.dtype} follow rules of their own; write float(...) or int(...)"
            raise Refusal(message)
        return value.item() if isinstance(value, np.generic) else value

    def _attribute(self, node: ast.Attribute) -> Value:
        owner = self.value(node.value)
        if isinstance(owner, Array) and node.attr == "shape":
            return owner.shape
        foreign = isinstance(owner, tuple) and node.attr not in getattr(owner, "_fields", ())
        if isinstance(owner, Array | Number | LaneIndex) or foreign or not hasattr(owner, node.attr):
            message = f"{ast.unparse(node)} is not known at compile time"
            raise Refusal(message)
        value = getattr(owner, node.attr)
        if self.followed and not (isinstance(owner, tuple) or is_plain(owner) or self.reads.logs(owner)):
            message = f"a change of {ast.unparse(node)} would not be noticed; keep it in a variable of the module"
            raise Refusal(message)
        self.reads.log(owner, "attribute", node.attr, value)
        return self._usable(value)

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
            return arrays.elements(self.arithmetic, value)
        if not isinstance(value, tuple | range):
            message = "expected a tuple whose length is known at compile time"
            raise Refusal(message)
        return tuple(value)

    @staticmethod
    def _tuple(value: Value) -> Value:
        if not isinstance(value, tuple | list | range):
            message = "only tuples are enumerated, zipped and reversed; write a loop over range(len(...))"
            raise Refusal(message)
        return value

    def _unary(self, node: ast.UnaryOp) -> Value:
        match node.op:
            case ast.USub():
                return self.arithmetic.negative(self.value(node.operand))
            case ast.Not():
                return self.arithmetic.opposite(self.condition(node.operand))
            case ast.UAdd():
                return self.value(node.operand)
            case _:
                message = "bits of whole numbers are not compiled"
                raise Refusal(message)

    def condition(self, node: ast.expr) -> Value:
        """Return the truth value of an expression; nonzero is true."""
        if isinstance(node, ast.BoolOp):
            return self._all_or_any(node, condition=True)
        value = self.value(node)
        if isinstance(value, Array | LaneIndex):
            message = f"{ast.unparse(node)} is not a condition"
            raise Refusal(message)
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
        if not (isinstance(value, bool) or (isinstance(value, Number) and value.kind is Kind.BOOLEAN)):
            message = f"the value of and, or is used: {ast.unparse(node)} is no condition; write a if condition else b"
            raise Refusal(message)
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
        return Number(Kind.BOOLEAN, self.text.value(f"load i1, ptr {result}"))

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
        slot = slots.slot_for(self.arithmetic, _wider(first, second))
        slots.store(self.arithmetic, slot, second)
        self.text.jump(done)
        self.text.block = end_of_yes
        slots.store(self.arithmetic, slot, first)
        self.text.jump(done)
        self.text.begin(done)
        return slots.load(self.arithmetic, slot)

    def _element(self, node: ast.Subscript) -> Value:
        owner, indices = self.value(node.value), self.indices(node)
        if isinstance(owner, tuple | range):
            return self._of_tuple(tuple(owner), indices[0])
        if not isinstance(owner, Array):
            message = f"{ast.unparse(node)} is not an element of an array or a tuple"
            raise Refusal(message)
        if len(indices) < len(owner.shape) or any(isinstance(index, slice) for index in indices):
            return arrays.view(self.arithmetic, owner, indices)
        return arrays.load(self.arithmetic, *arrays.place(self.arithmetic, owner, indices))

    def _of_tuple(self, items: tuple[Value, ...], index: Value) -> Value:
        if isinstance(index, LaneIndex):
            message = "the index of a loop over lanes cannot select from a tuple"
            raise Refusal(message)
        if not isinstance(index, Number):
            return items[index]
        index = arrays.counted(self.arithmetic, index, len(items))
        result = items[-1]
        for position, item in reversed(list(enumerate(items[:-1]))):
            result = self.arithmetic.chosen(self.arithmetic.compared(ast.Eq(), index, position), item, result)
        return result

    def _called(self, node: ast.Call) -> Value:
        function = self.value(node.func)
        values = self._items(node.args)
        keywords = {keyword.arg or "": self.value(keyword.value) for keyword in node.keywords}
        if mathematics.is_mathematics(function) and not keywords:
            return mathematics.call(self.arithmetic, function, values)
        if _is_named_tuple(function):
            return function(*values, **keywords)
        if function in _OF_ARRAYS and not keywords:
            if function is np.zeros and self.in_loop:
                message = "an array made in each pass of a loop; make one before it"
                raise Refusal(message)
            return _OF_ARRAYS[function](self.arithmetic, *values)
        if function is range and all(isinstance(value, int) for value in values):
            return range(*values)
        if function in _OVER_TUPLES:
            return tuple(function(*map(self._tuple, values), **keywords))
        return self.call(function, values, keywords)


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
    if isinstance(wider, Number) and wider.kind is Kind.INTEGER:
        return replace(wider, bounds=joined(bounds_of(a), bounds_of(b)))
    return wider
