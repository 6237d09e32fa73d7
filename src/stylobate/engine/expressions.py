"""Symbolic expressions, and the equations of a model recorded as such."""

from __future__ import annotations

import itertools
import math
import types
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from stylobate.compiler.reads import global_names
from stylobate.compiler.sources import plain_function
from stylobate.errors import UnsupportedError

if TYPE_CHECKING:
    from collections.abc import Sequence

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
            raise UnsupportedError(
                "an exponent must be a number for its power to be differentiated; use math.exp and math.log"
            )
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
        raise UnsupportedError(
            "equations that choose between cases by a comparison cannot be differentiated automatically; "
            "give the model a `jacobian`"
        )

    __le__ = __gt__ = __ge__ = __eq__ = __ne__ = __lt__
    __hash__ = object.__hash__

    def __bool__(self) -> bool:
        return self < 0.0

    def __float__(self) -> float:
        raise UnsupportedError(
            "equations that use a function that cannot be recorded cannot be differentiated automatically; use "
            f"{', '.join(FUNCTIONS)} of math, or give the model a `jacobian`"
        )

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


Function = Callable[..., Any]

# Functions of these packages are not copied.
_LIBRARIES = ("numpy",)

_number = itertools.count()


def recorded(function: Function, arguments: tuple[Any, ...]) -> Any:
    """Return the value of `function` for these expressions and numbers.

    Raises
    ------
    UnsupportedError
        If the function compares expressions, or uses an operation that cannot be differentiated.
    """
    try:
        return _for_expressions(function)(*arguments)
    except TypeError as error:  # such as an array of NumPy
        raise UnsupportedError(
            f"the equations cannot be differentiated: {error}; write them with numbers and functions of math"
        ) from error


def _for_expressions(function: Function) -> Function:
    """Return a copy of `function`, and of the functions that it calls, whose mathematics accepts expressions."""
    plain = plain_function(function)
    called = {name: _for_expressions(value) for name, value in _called_functions(plain)}
    names = {name: _recording_value(value) for name, value in plain.__globals__.items()}
    names = _with_functions(names, called, plain.__code__)
    return types.FunctionType(plain.__code__, names, plain.__name__, plain.__defaults__, plain.__closure__)


def _called_functions(function: types.FunctionType) -> list[tuple[str, Function]]:
    """Return the plain functions that `function` calls, by their names in its module: f, module.f or Class.f."""
    found: dict[str, Function] = {}
    for name in global_names(function.__code__):
        root, *path = name.split(".")
        value = function.__globals__.get(root)
        for attribute in path:
            value = getattr(value, attribute, None) if isinstance(value, (types.ModuleType, type)) else None
        plain = getattr(value, "py_func", value)
        if isinstance(plain, types.FunctionType) and plain.__module__.split(".")[0] not in _LIBRARIES:
            found[name] = plain
    return list(found.items())


def _with_functions(
    names: Mapping[str, Any], functions: Mapping[str, Function], code: types.CodeType
) -> dict[str, Any]:
    """Return `names` with these functions in place of the originals.

    For a function called as Class.f or module.f, a new module with all names that the `code` uses replaces the class or
    module, which is not modified.
    """
    names = dict(names)
    spaces: dict[str, types.ModuleType] = {}

    def space(path: str) -> types.ModuleType:
        if path not in spaces:
            outer, _, name = path.rpartition(".")
            holder = vars(space(outer)) if outer else names
            original = holder.get(name)
            made = types.ModuleType(f"{name} {next(_number)}")
            vars(made).update((part, getattr(original, part)) for part in code.co_names if hasattr(original, part))
            holder[name] = spaces[path] = made
        return spaces[path]

    for dotted, function in functions.items():
        path, _, name = dotted.rpartition(".")
        (vars(space(path)) if path else names)[name] = function
    return names


def _recording_value(value: Any) -> Any:
    if value is math or value is np:
        return _MATHEMATICS[value.__name__]
    return _BY_FUNCTION.get(value, value) if isinstance(value, types.BuiltinFunctionType) else value


def _recording_function(name: str, usual: Function) -> Function:
    def applied(*arguments: Any) -> Any:
        for argument in arguments:
            if isinstance(argument, Expression):
                record: Recording = argument.record
                return record.applied(name, *arguments)
        return usual(*arguments)

    return applied


def _power(base: Any, exponent: Any) -> Any:
    return base**exponent


def _logarithm(value: Any, base: Any = math.e) -> Any:
    if not isinstance(value, Expression):
        return math.log(value, base) if base != math.e else math.log(value)
    natural = value.record.applied("log", value)
    return natural if base == math.e else natural / math.log(base)


def _length(*components: Any) -> Any:
    if not any(isinstance(component, Expression) for component in components):
        return math.hypot(*components)
    square = sum(component * component for component in components)
    return square.record.applied("sqrt", square)


def _mathematics(module: types.ModuleType, names: dict[str, str]) -> types.ModuleType:
    made = types.ModuleType(module.__name__)
    vars(made).update(vars(module))
    for theirs, name in names.items():
        setattr(made, theirs, _recording_function(name, getattr(module, theirs)))
    return made


_NUMPY_NAMES = {"arcsin": "asin", "arccos": "acos", "arctan": "atan", "arctan2": "atan2", "arcsinh": "asinh"}
_MATHEMATICS = {
    "math": _mathematics(math, {name: name for name in FUNCTIONS}),
    "numpy": _mathematics(
        np, {name: name for name in FUNCTIONS if hasattr(np, name)} | _NUMPY_NAMES | {"abs": "fabs", "absolute": "fabs"}
    ),
}
for _module in _MATHEMATICS.values():
    vars(_module).update(pow=_power, power=_power, log=_logarithm, hypot=_length)
_BY_FUNCTION = {math.pow: _power} | {getattr(math, name): getattr(_MATHEMATICS["math"], name) for name in FUNCTIONS}
