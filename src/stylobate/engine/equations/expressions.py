"""Symbolic expressions of straight-line arithmetic: recording from a function, differentiation, and source code.

The equations of a model are plain Python functions of floats. A call with expressions in place of floats records their
operations, which give partial derivatives that are exact up to rounding.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from stylobate.errors import UnsupportedError

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

Number = float | int


@dataclass(frozen=True, slots=True, eq=False)
class Expression:
    """Symbolic number: an input, or an operation on other expressions.

    Equal expressions of one recording are the same object.
    """

    record: Recording
    operation: str
    operands: tuple[Expression, ...] = ()
    value: float = math.nan
    name: str = ""

    def __add__(self, other: Expression | Number) -> Expression:
        return self.record.sum(self, other)

    __radd__ = __add__

    def __sub__(self, other: Expression | Number) -> Expression:
        return self.record.difference(self, other)

    def __rsub__(self, other: Number) -> Expression:
        return self.record.difference(other, self)

    def __mul__(self, other: Expression | Number) -> Expression:
        return self.record.product(self, other)

    __rmul__ = __mul__

    def __truediv__(self, other: Expression | Number) -> Expression:
        return self.record.quotient(self, other)

    def __rtruediv__(self, other: Number) -> Expression:
        return self.record.quotient(other, self)

    def __neg__(self) -> Expression:
        return self.record.product(-1.0, self)

    def __pos__(self) -> Expression:
        return self

    def __pow__(self, exponent: Number) -> Expression:
        if isinstance(exponent, Expression):
            message = "an exponent must be a number for its power to be differentiated; use math.exp and math.log"
            raise UnsupportedError(message)
        if self.operation == "constant":
            return self.record.known(self.value**exponent)
        if exponent == int(exponent) and 0 <= exponent <= _LARGEST_POWER:
            result: Any = 1.0
            for _ in range(int(exponent)):
                result = result * self
            return self.record.known(result)
        return self.record.made("power", (self,), float(exponent))

    def __rpow__(self, base: Number) -> Expression:
        return self.record.applied("exp", self * math.log(base))

    def __abs__(self) -> Expression:
        return self.record.applied("fabs", self)

    def __lt__(self, other: object) -> bool:
        message = (
            "equations that choose between cases by a comparison cannot be differentiated automatically; "
            "give the model a `jacobian`"
        )
        raise UnsupportedError(message)

    __le__ = __gt__ = __ge__ = __eq__ = __ne__ = __lt__
    __hash__ = object.__hash__

    def __bool__(self) -> bool:
        return self < 0.0

    def __float__(self) -> float:
        message = (
            "equations that use a function that cannot be recorded cannot be differentiated automatically; use "
            f"{', '.join(FUNCTIONS)} of math, or give the model a `jacobian`"
        )
        raise UnsupportedError(message)

    def __mod__(self, other: object) -> float:
        return float(self)

    __rmod__ = __floordiv__ = __rfloordiv__ = __divmod__ = __mod__

    def __floor__(self) -> int:
        return int(float(self))

    __ceil__ = __trunc__ = __round__ = __floor__


_LARGEST_POWER = 8


@dataclass(slots=True)
class Recording:
    """Expressions of one function, each stored once."""

    kept: dict[tuple[Any, ...], Expression] = field(default_factory=dict)

    def input(self, name: str) -> Expression:
        """Return the input of this name."""
        return self.made("input", (), name=name)

    def made(
        self, operation: str, operands: tuple[Expression, ...], value: float = math.nan, name: str = ""
    ) -> Expression:
        """Return the expression for this operation on these operands."""
        key = (operation, tuple(map(id, operands)), repr(value), name)
        if key not in self.kept:
            self.kept[key] = Expression(self, operation, operands, value, name)
        return self.kept[key]

    def known(self, value: Expression | Number) -> Expression:
        """Return `value` as an expression."""
        if isinstance(value, Expression):
            return value
        return self.made("constant", (), float(value) + 0.0)

    def sum(self, a: Expression | Number, b: Expression | Number) -> Expression:
        """Return a + b."""
        a, b = self.known(a), self.known(b)
        if _is(a, 0.0):
            return b
        if _is(b, 0.0):
            return a
        return self._folded("add", a, b, lambda x, y: x + y)

    def difference(self, a: Expression | Number, b: Expression | Number) -> Expression:
        """Return a − b."""
        a, b = self.known(a), self.known(b)
        if _is(b, 0.0):
            return a
        return self._folded("subtract", a, b, lambda x, y: x - y)

    def product(self, a: Expression | Number, b: Expression | Number) -> Expression:
        """Return ab."""
        a, b = self.known(a), self.known(b)
        if _is(a, 0.0) or _is(b, 0.0):
            return self.known(0.0)
        if _is(a, 1.0):
            return b
        if _is(b, 1.0):
            return a
        return self._folded("multiply", a, b, lambda x, y: x * y)

    def quotient(self, a: Expression | Number, b: Expression | Number) -> Expression:
        """Return a/b."""
        a, b = self.known(a), self.known(b)
        if _is(a, 0.0) or _is(b, 1.0):
            return a
        return self._folded("divide", a, b, lambda x, y: x / y)

    def _folded(
        self, operation: str, a: Expression, b: Expression, fold: Callable[[float, float], float]
    ) -> Expression:
        if a.operation == b.operation == "constant":
            return self.known(fold(a.value, b.value))
        return self.made(operation, (a, b))

    def applied(self, name: str, *arguments: Expression | Number) -> Expression:
        """Return the expression for a function of the mathematical library."""
        return self.made(name, tuple(self.known(argument) for argument in arguments))

    def derivatives(self, results: Sequence[Expression], by: Sequence[Expression]) -> list[list[Expression]]:
        """Return the partial derivatives of `results` (rows) with respect to the inputs `by` (columns)."""
        columns = []
        for wanted in by:
            found: dict[int, Expression] = {}
            for expression in self.in_order(results):
                found[id(expression)] = self._derivative(expression, wanted, found)
            columns.append([found[id(result)] for result in results])
        return [[column[row] for column in columns] for row in range(len(results))]

    def _derivative(self, expression: Expression, by: Expression, found: dict[int, Expression]) -> Expression:
        if expression is by:
            return self.known(1.0)
        inner = [found[id(operand)] for operand in expression.operands]
        if all(_is(one, 0.0) for one in inner):
            return self.known(0.0)
        partials = _PARTIALS[expression.operation](expression, *expression.operands)
        total = self.known(0.0)
        for partial, change in zip(partials, inner, strict=True):
            total = total + change * partial
        return total

    def in_order(self, results: Sequence[Expression]) -> list[Expression]:
        """Return all expressions that `results` depend on, operands first."""
        ordered: dict[int, Expression] = {}
        waiting = [(result, False) for result in reversed(results)]
        while waiting:
            expression, entered = waiting.pop()
            if id(expression) in ordered:
                continue
            if entered:
                ordered[id(expression)] = expression
                continue
            waiting.append((expression, True))
            waiting.extend((operand, False) for operand in expression.operands)
        return list(ordered.values())

    def source(self, results: Sequence[Expression]) -> tuple[list[str], list[str]]:
        """Return lines of source that compute `results`, and the names of the results in the source."""
        names: dict[int, str] = {}
        lines: list[str] = []
        for expression in self.in_order(results):
            if expression.operation == "constant":
                names[id(expression)] = number_source(expression.value)
            elif expression.operation == "input":
                names[id(expression)] = expression.name
            else:
                name = f"v{len(lines)}"
                lines.append(f"{name} = {operation_source(expression, [names[id(o)] for o in expression.operands])}")
                names[id(expression)] = name
        return lines, [names[id(result)] for result in results]


def _is(expression: Expression, value: float) -> bool:
    return expression.operation == "constant" and expression.value == value


def number_source(value: float) -> str:
    """Return the source of a number."""
    return repr(value) if math.isfinite(value) else f"math.{value!r}".replace("math.-inf", "-math.inf")


_SIGNS = {"add": "+", "subtract": "-", "multiply": "*", "divide": "/"}


def operation_source(expression: Expression, operands: list[str]) -> str:
    """Return the source of an operation on these operands."""
    if expression.operation in _SIGNS:
        # Brackets around a negative number, for readability.
        left, right = (f"({o})" if o.startswith("-") else o for o in operands)
        return f"{left} {_SIGNS[expression.operation]} {right}"
    if expression.operation == "power":
        return f"{operands[0]} ** {expression.value!r}"
    return f"math.{expression.operation}({', '.join(operands)})"


def _of(name: str, argument: Expression) -> Expression:
    return argument.record.applied(name, argument)


# Partial derivatives of each operation with respect to its operands; arguments: the result, then the operands.
_PARTIALS: dict[str, Callable[..., tuple[Any, ...]]] = {
    "input": lambda _: (),
    "constant": lambda _: (),
    "add": lambda _, __, ___: (1.0, 1.0),
    "subtract": lambda _, __, ___: (1.0, -1.0),
    "multiply": lambda _, a, b: (b, a),
    "divide": lambda e, _, b: (1.0 / b, -e / b),
    "power": lambda e, a: (e.value * a ** (e.value - 1.0),),
    "fabs": lambda e, a: (a / e,),
    "sqrt": lambda e, _: (0.5 / e,),
    "exp": lambda e, _: (e,),
    "log": lambda _, a: (1.0 / a,),
    "sin": lambda _, a: (_of("cos", a),),
    "cos": lambda _, a: (-_of("sin", a),),
    "tan": lambda e, _: (1.0 + e * e,),
    "asin": lambda _, a: (1.0 / _of("sqrt", 1.0 - a * a),),
    "acos": lambda _, a: (-1.0 / _of("sqrt", 1.0 - a * a),),
    "atan": lambda _, a: (1.0 / (1.0 + a * a),),
    "atan2": lambda _, y, x: (x / (x * x + y * y), -y / (x * x + y * y)),
    "hypot": lambda e, x, y: (x / e, y / e),
    "sinh": lambda _, a: (_of("cosh", a),),
    "cosh": lambda _, a: (_of("sinh", a),),
    "tanh": lambda e, _: (1.0 - e * e,),
    "asinh": lambda _, a: (1.0 / _of("sqrt", a * a + 1.0),),
}

FUNCTIONS = tuple(name for name in _PARTIALS if hasattr(math, name))
"""Functions of `math` that can be recorded."""
