"""Taylor series of the equations of a model."""

from collections.abc import Collection, Iterable, Sequence
from functools import cache

from stylobate.engine.expressions import Expression, Recording, number_source, operation_source, recorded
from stylobate.engine.kernel.shape import SERIES_ORDER, Shape
from stylobate.errors import UnsupportedError
from stylobate.models import Model

_KNOWN = ("input", "constant", "add", "subtract", "multiply", "divide", "sqrt")


class Series:
    """Taylor series of expressions in time.

    Coefficient k of the input or expression `name` is `name_k` in the source. A constant has only one coefficient, with
    the name of the constant.

    Parameters
    ----------
    record
        Recording of the expressions.
    results
        Expressions whose series are needed.
    moving
        Names of the inputs that change with time; the others are fixed.

    Raises
    ------
    UnsupportedError
        If the expressions contain an operation without a recurrence.
    """

    def __init__(self, record: Recording, results: Sequence[Expression], moving: Collection[str]) -> None:
        self._results = [id(result) for result in results]
        self._expressions = record.in_order(results)
        self._moving: set[int] = set()
        self._names: dict[int, str] = {}
        self._aliases: dict[tuple[int, int], str | None] = {}
        self._reciprocals: set[str] = set()
        for expression in self._expressions:
            if expression.name in moving or any(self._moves(operand) for operand in expression.operands):
                self._moving.add(id(expression))
            if self._moves(expression) and expression.operation not in _KNOWN:
                raise UnsupportedError(
                    f"no recurrence is implemented for the Taylor coefficients of {expression.operation}"
                )
            self._names[id(expression)] = expression.name or f"v{len(self._names)}"

    def lines(self, k: int) -> list[str]:
        """Return lines that compute coefficient `k` of all expressions from the coefficients of lower orders."""
        out: list[str] = []
        for expression in self._expressions:
            out += self._coefficient_lines(expression, k)
        return out

    def result(self, index: int, k: int) -> str:
        """Return the name of coefficient `k` of a result, or its value."""
        return self._coefficient(self._results[index], k) or "0.0"

    def _moves(self, expression: Expression) -> bool:
        return id(expression) in self._moving

    def _of(self, expression: Expression, k: int) -> str | None:
        return self._coefficient(id(expression), k)

    def _coefficient(self, key: int, k: int) -> str | None:
        """Return the name of coefficient `k`, or None if it is zero."""
        if (key, k) in self._aliases:
            return self._aliases[key, k]
        name = self._names[key]
        if key not in self._moving:
            return name if k == 0 else None
        return f"{name}_{k}"

    def _coefficient_lines(self, expression: Expression, k: int) -> list[str]:
        key, operation = id(expression), expression.operation
        if operation == "input" or (k > 0 and not self._moves(expression)):
            return []
        if operation == "constant":
            self._aliases[key, 0] = number_source(expression.value)
            return []
        before: list[str] = []
        if operation in ("add", "subtract"):
            left, right = (self._of(operand, k) for operand in expression.operands)
            text = _added(left, right, "+" if operation == "add" else "-")
        elif operation == "multiply":
            text = self._product(expression, k)
        elif operation == "divide":
            before, text = self._quotient(expression, k)
        elif operation == "sqrt" and self._moves(expression):
            before, text = self._root(expression, k)
        else:  # a function of constants
            text = operation_source(expression, [str(self._of(operand, 0)) for operand in expression.operands])
        if text is None or text.removeprefix("-").replace("_", "").isalnum():  # zero, or another, or its negative
            text = f"({text})" if text and text.startswith("-") else text
            self._aliases[key, k] = text
            return before
        return [*before, f"{self._coefficient(key, k)} = {text}"]

    def _product(self, product: Expression, k: int) -> str | None:
        a, b = product.operands
        if not self._moves(a) or not self._moves(b):
            fixed, other = (b, a) if self._moves(a) else (a, b)
            factor, series = self._of(fixed, 0), self._of(other, k)
            return None if series is None else f"{factor} * {series}"
        if a is b:
            return self._square(a, range(k + 1))
        return _sum(self._pair(a, j, b, k - j) for j in _oldest_first(range(k + 1)))

    def _square(self, a: Expression, orders: range) -> str | None:
        """Return the source of Σ a_j a_l over the symmetric pairs of `orders`; equal pairs are computed once."""
        first, last = orders.start, orders.stop - 1
        pairs = _sum(self._pair(a, first + j, a, last - j) for j in reversed(range(len(orders) // 2)))
        middle = self._pair(a, (first + last) // 2, a, (first + last) // 2) if len(orders) % 2 else None
        return _sum((f"2.0 * ({pairs})" if pairs else None, middle))

    def _pair(self, a: Expression, j: int, b: Expression, k: int) -> str | None:
        left, right = self._of(a, j), self._of(b, k)
        return None if left is None or right is None else f"{left} * {right}"

    def _quotient(self, quotient: Expression, k: int) -> tuple[list[str], str | None]:
        # q d = n: q_k = (n_k − Σ_{j > 0} d_j q_{k−j})/d_0
        over, under = quotient.operands
        lines, per = self._reciprocal(under)
        orders = _oldest_first(range(1, k + 1)) if self._moves(under) else []
        below = _sum(self._pair(under, j, quotient, k - j) for j in orders)
        text = _added(self._of(over, k), below and f"({below})", "-")
        return lines, text and f"({text}) * {per}"

    def _root(self, root: Expression, k: int) -> tuple[list[str], str | None]:
        # r² = s: r_k = (s_k − Σ_{0 < j < k} r_j r_{k−j})/(2 r_0)
        (under,) = root.operands
        first = f"math.sqrt({self._of(under, 0)})"
        name = self._coefficient(id(root), 0)
        if k == 0:
            lines, per = self._reciprocal(root)
            return [f"{name} = {first}", *lines, f"half_{name} = 0.5 * {per}"], name
        inner = self._square(root, range(1, k))
        text = _added(self._of(under, k), inner and f"({inner})", "-")
        return [], text and f"({text}) * half_{name}"

    def _reciprocal(self, expression: Expression) -> tuple[list[str], str]:
        """Return the lines that compute 1/a_0 for the first time, and its name."""
        value = self._of(expression, 0)
        name = f"per_{self._names[id(expression)]}"
        if name in self._reciprocals:
            return [], name
        self._reciprocals.add(name)
        return [f"{name} = 1.0 / {value}"], name


def _oldest_first(orders: range) -> list[int]:
    """Return the orders from the middle outwards, so that sums do not wait for the latest coefficients."""
    middle = 0.5 * (orders.start + orders.stop - 1)
    return sorted(orders, key=lambda order: abs(order - middle))


def _sum(terms: Iterable[str | None]) -> str | None:
    return " + ".join(term for term in terms if term) or None


def _added(a: str | None, b: str | None, sign: str) -> str | None:
    """Return the source of a ± b; None means zero."""
    if a is None or b is None:
        return a or (b and (f"-{b}" if sign == "-" else b))
    return f"{a} {sign} {b}"


class Expansion:
    """Taylor series of the states of a model and of the square of its tilt.

    Variables: coefficient k of state j `s{j}_{k}`, coefficients of the base acceleration `ax_{k}` …, parameters `p{j}`.

    Parameters
    ----------
    model
        The class of the model.
    states, parameters
        Numbers of states and of parameters.
    vertical
        Whether the base moves vertically too.

    Raises
    ------
    UnsupportedError
        If the equations cannot be recorded, or contain operations without a recurrence.
    """

    def __init__(self, model: type[Model], states: int, parameters: int, *, vertical: bool) -> None:
        record = Recording()
        self._names = [f"s{j}" for j in range(states)]
        pushes = ["ax", "ay", *(["az"] if vertical else [])]
        moving = {name: record.input(name) for name in (*self._names, *pushes)}
        numbers = tuple(record.input(f"p{j}") for j in range(parameters))
        state = tuple(moving[name] for name in self._names)
        rates = recorded(model.rates, (*state, *(moving.get(name, 0.0) for name in ("ax", "ay", "az")), *numbers))
        self._rates: list[Expression] = [record.known(rate) for rate in rates]
        x, y, _, _ = recorded(model.tilt_of, (*state, *numbers))
        self._series = Series(record, [*self._rates, record.known(x * x + y * y)], moving)

    @property
    def integrals(self) -> tuple[int, ...]:
        """For each state the state whose rate it is, or itself; its coefficients determine those of both."""
        out = list(range(len(self._names)))
        for j, rate in enumerate(self._rates):
            if rate.name in self._names:
                rate_of = self._names.index(rate.name)
                if out[rate_of] == rate_of and self._rates[rate_of].name not in self._names:
                    out[rate_of] = j
        return tuple(out)

    def coefficient_lines(self, k: int) -> list[str]:
        """Return lines that compute coefficients `k` of rates and square, and the next coefficients of the states."""
        out = self._series.lines(k)
        if k == SERIES_ORDER:
            return out
        integrals = self.integrals
        for j, integral in enumerate(integrals):
            rate = self.rate(j, k)
            if integral != j:
                out.append(f"s{integral}_{k + 2} = {rate} * {1.0 / ((k + 1) * (k + 2))!r}")
                out.append(f"s{j}_{k + 1} = {float(k + 2)!r} * s{integral}_{k + 2}")
            elif j not in (integrals[:j] + integrals[j + 1 :]):
                out.append(f"s{j}_{k + 1} = {rate} * {1.0 / (k + 1)!r}")
        return out

    def rate(self, j: int, k: int) -> str:
        """Return coefficient `k` of the rate of state `j`."""
        return self._series.result(j, k)

    def square(self, k: int) -> str:
        """Return coefficient `k` of the square of the tilt."""
        return self._series.result(len(self._names), k)


@cache
def series_integrals(model: type[Model], states: int, parameters: int, *, vertical: bool) -> tuple[int, ...]:
    """Return the `integrals` of a model's equations.

    Raises
    ------
    UnsupportedError
        If the equations have no series.
    """
    try:
        return Expansion(model, states, parameters, vertical=vertical).integrals
    except UnsupportedError as error:
        raise UnsupportedError(
            f"the equations of model {model.name} hold more than sums, products, quotients and square roots, for which "
            "Taylor series are written; use method='dop853'"
        ) from error


def expand_source(model: type[Model], shape: Shape) -> str:
    """Return the source of `expand(start, pushes, numbers)`, which computes the Taylor coefficients of a step.

    Its arguments are the states at the start of the step, the coefficients of each acceleration component and the
    parameters. Its results are the coefficients of the states, of the rates and of the square of the tilt.

    Raises
    ------
    UnsupportedError
        If a change of values has given the equations another structure than `shape` has.
    """
    vertical = "az" in shape.forcing.components
    expansion = Expansion(model, shape.states, shape.parameters, vertical=vertical)
    if expansion.integrals != shape.series:
        raise UnsupportedError(
            f"the equations of model {model.name} have another structure since values that they read have changed; "
            "start again, or use method='dop853'"
        )
    states, orders = range(shape.states), range(SERIES_ORDER + 1)
    lines = [f"s{j}_0 = start[{j}]" for j in states]
    lines += [f"s{integral}_1 = s{j}_0" for j, integral in enumerate(shape.series) if integral != j]
    lines += [f"p{j} = numbers[{j}]" for j in range(shape.parameters)]
    lines += [f"{name}_{k} = pushes[{c}][{k}]" for c, name in enumerate(shape.forcing.components) for k in orders]
    for k in orders:
        lines += expansion.coefficient_lines(k)
    degrees = [shape.degree(j) if j in shape.expanded else SERIES_ORDER for j in states]
    results = (
        _nested([f"s{j}_{k}" for k in range(degrees[j] + 1)] for j in states),
        _nested([expansion.rate(j, k) for k in range(SERIES_ORDER)] for j in states),
        f"({', '.join(expansion.square(k) for k in orders)})",
    )
    body = "\n".join(f"    {line}" for line in [*lines, f"return {', '.join(results)}"])
    return f"import math\n\n\ndef expand(start, pushes, numbers):\n{body}\n"


def _nested(rows: Iterable[Iterable[str]]) -> str:
    tuples = (f"({', '.join(row)})" for row in rows)
    return f"({', '.join(tuples)})"
