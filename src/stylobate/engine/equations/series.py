"""Taylor series of recorded expressions: source code of the recurrences of their coefficients.

The coefficients of a sum, product, quotient or square root follow from those of its operands order by order: R. E.
Moore, "Methods and Applications of Interval Analysis" (SIAM, 1979), section 3.4; À. Jorba, M. Zou, "A software package
for the numerical integration of ODEs by means of high-order Taylor methods", Experimental Mathematics 14 (2005).
"""

from collections.abc import Collection, Iterable, Sequence

from stylobate.engine.equations.expressions import Expression, Recording, number_source, operation_source
from stylobate.errors import UnsupportedError

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
                message = f"no recurrence is implemented for the Taylor coefficients of {expression.operation}"
                raise UnsupportedError(message)
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
