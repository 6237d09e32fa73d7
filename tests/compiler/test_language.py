"""Each construct of the accepted language gives the bits that Python gives."""

import math
from collections import namedtuple
from enum import IntEnum
from typing import NamedTuple

import numpy as np
import pytest

from stylobate.compiler.marks import flat

from .calling import both_ways, call_compiled

X = np.array([0.7, -1.3, 2.0, 0.0, -0.0, 1e-300, 3.5, -2.5, math.inf, math.nan])
TABLE = np.array([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]])
LIMITS = (0.5, (1.5, 2.5))


class Color(IntEnum):
    RED = 3
    BLUE = 5


class Pair(NamedTuple):
    first: float
    second: tuple[float, float] = (1.0, 2.0)


Old = namedtuple("Old", "x y")  # noqa: PYI024


def arithmetic(x, out):
    for i in range(len(x)):
        a = x[i]
        out[i] = (a + 1.0) * a - a / 3.0 + 2 * a - -a + a**2 + +a
    return len(x)


def divisions_by_zero(x, out):
    for i in range(len(x)):
        out[i] = 1.0 / x[i]


NOTHING, NOT_A_NUMBER = np.float64(0.0), np.float64(math.nan)


def known_divisions_by_zero(x, out):
    out[0], out[1], out[2] = NOTHING / NOTHING, NOT_A_NUMBER / NOTHING, np.pi / NOTHING
    out[3], out[4] = -np.pi / NOTHING, np.pi / -NOTHING


def powers(x, out):
    for i in range(len(x)):
        out[i] = abs(x[i]) ** 2.5 + abs(x[i]) ** 0.125


def whole_numbers(x, out):
    total = 0
    for k in range(-7, 8):
        if k != 0:
            total += 7 // k + (7 % k) * 10 + k // 3 - (k % 3) * 100
    out[0] = total
    return (total * 3 - 5) // 2


def generators(x, out):
    j = 3.0
    for i in range(len(x)):
        squares = tuple(x[i] * k for k in range(4) if k != 2)
        out[i] = sum(weight * value for weight, value in zip(LIMITS[1], squares, strict=False)) + squares[-1]
        out[i] += max(sum(a - j for j in (x[i], 0.5)) for a in squares) + j
    return len(tuple(range(5)))


def conditions(x, out):
    for i in range(len(x)):
        if x[i] > 1.0:
            out[i] = 1.0
        elif x[i] < 0.0 or not x[i] != 0.0:  # noqa: SIM202
            out[i] = 2.0
        else:
            out[i] = 3.0


def chained_comparisons(x, out):
    count = 0
    for i in range(len(x)):
        count += 0.0 <= x[i] < 2.5
        out[i] = x[i] == x[i] and x[i] != 0.0
    return count


def conditional_expressions(x, out):
    for i in range(len(x)):
        out[i] = x[i - 1] if i > 0 else -1.0
        out[i] += 1 if x[i] > 0.0 else 0.5


def of_what_is_not_looked_at(x, out):
    # No element lies behind the last one: it is not read.
    for i in range(len(x)):
        out[i] = 1.0 if i + 1 < len(x) and x[i + 1] > 0.0 else 0.0


def loops(x, out):
    total, i = 0.0, 0
    while True:
        if i >= len(x):
            break
        i += 1
        if math.isnan(x[i - 1]) or math.isinf(x[i - 1]):
            continue
        for _ in range(i, i + 3):
            total += x[i - 1]
    out[0] = total
    while i > 3:
        i -= 1
    return i


def a_number_that_becomes_a_fraction(x, out):
    total = 0
    for i in range(3):
        total += x[i]
    out[0] = total
    count = 1
    if x[0] > 0.0:
        count = 2.5
    out[1] = count


def early_end(x):
    for i in range(len(x)):
        if x[i] < -2.0:
            return i
    return -1


def calls_early_end(x, out):
    out[0] = early_end(x)
    return early_end(x[:3]) + 10


def tuples(x, out):
    a, (b, c) = x[0], (x[1], x[2])
    a, b = b, a
    triple = (a, b, c)
    for k in range(3):
        out[k] = triple[k]
    for place, value in ((3, a * 2.0), (4, b * 3.0)):
        out[place] = value
    pair = Pair(c)
    out[5], out[6] = pair.second[1] + pair.first, Pair(1.0, second=(a, b)).second[0]
    out[7] = sum_of(*triple) + LIMITS[1][0]
    for place, (one, other) in enumerate(zip(triple, (1.0, 2.0, 3.0), strict=True)):
        out[place] += one * other
    old = turned(Old(a, b))
    out[8] = old.x - old.y
    return len(triple)


def sum_of(*numbers):
    total = 0.0
    for number in numbers:
        total = total + number
    return total


def turned(old):
    return Old(-old.y, old.x)


def chosen_from_a_tuple(x, out):
    values = (x[0], x[1], x[2])
    for i in range(len(x)):
        k = i % 3
        out[i] = values[k] + TABLE[k % 2, k]


def tuple_in_a_loop(x, out):
    state = (0.0, 1.0)
    for i in range(4):
        state = (state[1], state[0] + x[i])
    out[0], out[1] = state


def arguments(x, out):
    out[0] = with_defaults(x[0])
    out[1] = with_defaults(x[0], 3.0)
    out[2] = with_defaults(x[0], c=x[1])


def with_defaults(a, b=2.0, *, c=0.25):
    return a * b + c


def made_by(factor):
    def inner(a):
        return a * factor

    return inner


doubled = made_by(2.0)
tripled = lambda a: a * 3.0  # noqa: E731


def closures(x, out):
    out[0], out[1] = doubled(x[0]), tripled(x[0])


CLOSURES = (doubled, tripled)


def functions_of_a_tuple(x, out):
    backwards = (tripled, doubled)
    for k in range(2):
        out[k] = CLOSURES[k](x[k]) - backwards[k](x[2])


def enumerations(x, out):
    status = Color.BLUE if x[0] > 0.0 else Color.RED
    out[0] = status
    return status == Color.BLUE


def views(x, out):
    table = TABLE[1]
    part = x[2:]
    out[0], out[1], out[2] = table[2], part[1], part[len(part) - 1]
    out[3] = x[2:5][2] + x[-3]
    a, b, c = TABLE[:, 0][0], TABLE[0, 1:][1], TABLE[1, 2]
    out[4], out[5], out[6] = a, b, c
    chosen = TABLE[0]
    for i in range(3):
        if i == 1:
            chosen = TABLE[1]
        out[7] = chosen[i]
    return len(part)


def arrays_of_its_own(x, out):
    room = np.zeros((3, 2))
    for k in range(3):
        for j in range(2):
            room[k, j] += x[k] * (j + 1)
    room[0] = room[2]
    copy = np.zeros((3, 2))
    copy[:, :] = room
    whole = flat(copy)
    for k in range(6):
        out[k] = whole[k]
    first, second = copy[1]
    out[6] = first - second


def mathematics(x, out):
    for i in range(8):
        a = x[i]
        out[i] = math.sin(a) + math.cos(a) * math.exp(-abs(a)) + math.atan2(a, 1.5) + math.copysign(2.0, a)
        out[i] += math.sqrt(abs(a)) + np.sqrt(abs(a)) + math.log(abs(a) + 1.0) + math.asinh(a) + math.tanh(a)
        out[i] += math.floor(a) + math.ceil(a) + np.floor(a) + int(a * 1.5) + math.fabs(a) + math.pi
        out[i] += min(a, 0.5, 1) + max(0.25, a) + float(i) + bool(a) + min((a, 2.0)) + sum((a, 1.0, 2))
        out[i] += np.square(a) + np.sign(a) + np.where(a > 1.0, 2.0, a) + np.clip(a, -1.0, 0.5) + np.rint(a * 1.3)
        out[i] += np.maximum(a, 0.25) - np.minimum(a, 1.0) + math.log2(abs(a) + 1.0) + math.trunc(a)
        out[i] += math.fmod(a, 0.75) + math.degrees(a) - math.radians(a) + math.hypot(a) + math.log(abs(a) + 1.0, 3.0)


def of_what_is_no_number(x, out):
    nan = x[9]
    out[0], out[1], out[2], out[3] = min(nan, 1.0), min(1.0, nan), max(nan, 1.0), max(1.0, nan)
    out[4] = nan < 1.0 or nan > 1.0 or nan == nan  # noqa: PLR0124
    out[5] = math.isnan(nan) and math.isfinite(x[0]) and not math.isfinite(x[8])
    out[6] = abs(x[4])
    out[7] = x[4]


def what_is_known(x, out):
    if len(LIMITS) == 2 and LIMITS[0] < 1.0:
        out[0] = 1.0
    else:
        undefined_here(x)  # noqa: F821  never compiled
    out[1] = 3 if LIMITS is None else 4
    out[2] = 1.0 if Color.RED in (3, 4) else 0.0


def documented(x, out):
    """Do nothing."""
    total: float = x[0]
    pass  # noqa: PIE790
    out[0] = total


CONSTRUCTS = [
    *(
        arithmetic,
        divisions_by_zero,
        known_divisions_by_zero,
        powers,
        whole_numbers,
        generators,
        conditions,
        chained_comparisons,
        conditional_expressions,
    ),
    *(of_what_is_not_looked_at, loops, a_number_that_becomes_a_fraction, calls_early_end, tuples, chosen_from_a_tuple),
    *(tuple_in_a_loop, arguments, closures, functions_of_a_tuple, enumerations, views, arrays_of_its_own),
    *(mathematics, of_what_is_no_number, what_is_known, documented),
]


@pytest.mark.parametrize("function", CONSTRUCTS, ids=lambda function: function.__name__)
def test_compiled_functions_give_the_bits_of_python(function):
    (compiled, result), (plain, expected) = both_ways(function, X, np.full(10, 7.0))
    assert result == expected
    np.testing.assert_array_equal(compiled[1], plain[1])
    signed = ~np.isnan(plain[1])
    np.testing.assert_array_equal(np.signbit(compiled[1][signed]), np.signbit(plain[1][signed]))


def cubes(x, out):
    for i in range(len(x)):
        out[i] = x[i] ** 3 + x[i] ** 7


def test_whole_powers_are_products():
    (compiled, _), (plain, _) = both_ways(cubes, X, np.zeros(10))
    np.testing.assert_allclose(compiled[1], plain[1], rtol=1e-15)


def wait(signal, out):
    out[0] = 1.0 if signal[0] != 0 else 2.0


def test_signals_are_read():
    for byte, expected in ((0, 2.0), (1, 1.0)):
        out = np.zeros(1)
        call_compiled(wait, np.array([byte], dtype=np.uint8), out)
        assert out[0] == expected
