"""Bounds of whole numbers in the functions of models: what could leave 64 bits or an array is refused.

Whole numbers of Python have any number of digits, an index beyond a tuple is an error, and −1 is the last element. In
compiled code nothing of this can be seen while it runs. Therefore each whole number of a model's function has bounds
that are known when it is compiled. All of them lie within ±2^53, where conversions to floats are exact.
"""

import ast
import operator
from collections.abc import Callable
from itertools import product

from stylobate.compiler.refusal import Refusal
from stylobate.compiler.values import BEYOND_FLOATS, Bounds, Kind, Number, Value, is_known_number

ANY: Bounds = (-BEYOND_FLOATS, BEYOND_FLOATS)
"""Bounds of a whole number of which nothing is known."""

TOO_LARGE = "a whole number may exceed 2**53 here; limit it, as in min(max(k, 0), 1000), or write float(...)"

_STEP = 1024
"""Maximum step of a counter: with such steps no loop reaches 2^53 in a lifetime."""

_OPERATIONS: dict[type[ast.operator], Callable[[int, int], int]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.FloorDiv: operator.floordiv,
}


def bounds_of(value: Value) -> Bounds:
    """Return the bounds of a whole number or truth value."""
    if is_known_number(value):
        return int(value), int(value)
    assert isinstance(value, Number)
    if value.kind is Kind.BOOLEAN:
        return 0, 1
    return value.bounds or ANY


def joined(*bounds: Bounds) -> Bounds:
    """Return the bounds of a number that lies within one of several bounds."""
    lows, highs = zip(*bounds, strict=True)
    return min(lows), max(highs)


def contains(outer: Bounds, inner: Bounds) -> bool:
    """Return whether the inner bounds lie within the outer ones."""
    return outer[0] <= inner[0] and inner[1] <= outer[1]


def widened(bounds: Bounds, beyond: Bounds) -> Bounds:
    """Return bounds without a limit on each side where others lie beyond."""
    return ANY[0] if beyond[0] < bounds[0] else bounds[0], ANY[1] if beyond[1] > bounds[1] else bounds[1]


def after(operation: ast.operator, a: Bounds, b: Bounds) -> Bounds:
    """Return the bounds of the result of an operation.

    Raises
    ------
    Refusal
        If the result may lie beyond ±2^53, or the divisor may be 0.
    """
    if isinstance(operation, ast.FloorDiv | ast.Mod) and b[0] <= 0 <= b[1]:
        message = f"a whole number between {b[0]} and {b[1]} is a divisor, and may be 0; limit it, as in max(k, 1)"
        raise Refusal(message)
    if isinstance(operation, ast.Mod):
        return (0, b[1] - 1) if b[0] > 0 else (b[0] + 1, 0)
    corners = [_OPERATIONS[type(operation)](x, y) for x, y in product(a, b)]
    bounds = min(corners), max(corners)
    if contains(ANY, bounds):
        return bounds
    if isinstance(operation, ast.Add | ast.Sub) and contains(ANY, joined(a, b)) and min(map(_size, (a, b))) <= _STEP:
        return max(bounds[0], ANY[0]), min(bounds[1], ANY[1])
    raise Refusal(TOO_LARGE)


def _size(bounds: Bounds) -> int:
    return max(map(abs, bounds))


def ends_of_index(bounds: Bounds, length: Value) -> tuple[bool, bool]:
    """Return whether an index may lie at least at 0, and below it, counted from the end.

    Raises
    ------
    Refusal
        If it may lie outside an array or tuple of this length.
    """
    if not isinstance(length, int):
        message = "an index that is not known, of an array whose length is not known; use an array of the module"
        raise Refusal(message)
    if not contains((-length, length - 1), bounds):
        between = "any whole number" if contains(bounds, ANY) else f"between {bounds[0]} and {bounds[1]}"
        message = (
            f"the index may lie outside, it is {between} and the length is {length}; "
            f"limit it, as in min(max(k, 0), {length - 1})"
        )
        raise Refusal(message)
    return bounds[1] >= 0, bounds[0] < 0
