"""Whole numbers and indices of model functions: their bounds are known, or the function is refused."""

import ctypes
import math

import numpy as np
import pytest

from stylobate.compiler import machine
from stylobate.compiler.marks import lanes
from stylobate.compiler.sources import CompileError
from stylobate.compiler.unit import ArrayArgument, Unit

X = np.array([0.7, -1.3, 2.0, 0.0, -0.0, 1e-300, 3.5, -2.5])
TABLE = np.array([1.0, 2.0, 4.0])
SQUARE = np.arange(9.0).reshape(3, 3)
COUNTS, EIGHT, SINGLE = np.array([1, 2]), np.uint8(100), np.float32(0.1)
T3 = (10.0, 20.0, 40.0)


def compiled(function, width=8):
    """Compile a function of two rows of eight numbers as that of a model."""
    unit = Unit(lanes=width)
    unit.export(function, "exported", [ArrayArgument((8,))] * 2)
    engine = machine.linked(machine.native().object_code(unit.module.text(machine.native().attributes)))
    call = ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.c_void_p, ctypes.c_void_p)(engine.get_function_address("exported"))
    return lambda x, out: (call(x.ctypes.data, out.ctypes.data), engine)[0]


def clamped(x, out):
    for i in range(8):
        k = int(x[i])
        out[i] = TABLE[min(max(k, 0), 2)] + T3[max(min(k, 2), -3)] + SQUARE[k % 3, abs(k) % 3]


def negative(x, out):
    for i in range(8):
        out[i] = TABLE[-1 - i % 3] + T3[i % 3 - 3] + T3[i % 5 - 2 if i % 5 < 2 else -1] + x[i - 8] + x[-1]


def of_conditions(x, out):
    for i in range(8):
        k = 0
        if x[i] > 0.0:
            k = 1
        elif x[i] < 0.0:
            k = 2
        out[i] = TABLE[k] + TABLE[int(x[i] > 0.0)] + T3[x[i] > 0.0] + T3[1 if x[i] > 1.0 else k]


def helper(k, x):
    return T3[k] * x, k + 1


def passed(x, out):
    for k in range(3):
        a, j = helper(k, x[k])
        out[k] = a + x[j]


def counter(x, out):
    n, f = 0, 1
    while n < 5 and x[0] > 0.0:
        n += 1
    for k in range(1, 6):
        n += k * k
    for k in range(4):
        out[k] = (n - k) // 3 + n % (k + 1) - 7 // (k - 4) + f
    return n


def powers(x, out):
    for k in range(8):
        out[k] = k**3 + k**2.0 + (x[k] > 0.0) ** 2 + 2**4 + (k - 4) ** 1


def wholes(x, out):
    for k in range(8):
        out[k] = math.copysign(1.0, math.ceil(-0.5 * abs(x[k]))) + 1.0 / (math.floor(x[k]) + 0.25)


def wholes_in_lanes(x, out):
    for i in lanes(8):
        a = math.copysign(1.0, math.ceil(-0.5 * abs(x[i]))) + int(x[i] * 1.5) + T3[int(abs(x[i])) % 3]
        out[i] = a + of_a_table(math.trunc(x[i])) + min(max(int(x[i]), -1), 1) * 3


def of_a_table(k):
    return TABLE[min(abs(k), 2)]


RIGHT = [clamped, negative, of_conditions, passed, counter, powers, wholes, wholes_in_lanes]


@pytest.mark.parametrize("function", RIGHT, ids=lambda function: function.__name__)
def test_whole_numbers_and_indices_are_those_of_python(function):
    out, expected = np.zeros(8), np.zeros(8)
    result = compiled(function)(X, out)
    assert result == (function(X.tolist(), expected) or 0)
    np.testing.assert_array_equal(out, expected)


def index_is_the_length(x, out):
    out[0] = TABLE[3]


def index_is_the_length_of_a_row(x, out):
    out[0] = SQUARE[3][0]


def index_below_the_first(x, out):
    out[0] = TABLE[-4]


def loop_beyond_a_tuple(x, out):
    for i in range(4):
        out[i] = T3[i - 3 + i]


def loop_beyond_an_array(x, out):
    for i in range(8):
        out[i + 4] = x[i]


def lanes_beyond_an_array(x, out):
    for i in lanes(8):
        out[i + 4] = x[i]


def index_of_any_size(x, out):
    out[0] = TABLE[int(x[0])]


def index_with_a_fraction(x, out):
    out[0] = TABLE[x[0]]


def index_with_a_fraction_in_a_tuple(x, out):
    out[0] = T3[x[0]]


def known_index_with_a_fraction(x, out):
    out[0] = TABLE[1.0]


def truth_value_as_index(x, out):
    out[0] = TABLE[x[0] > 0.0]


def known_truth_value_as_index(x, out):
    out[0] = TABLE[True]


def array_of_whole_numbers(x, out):
    out[0] = COUNTS[0] * x[0]


def number_of_eight_bits(x, out):
    out[0] = EIGHT + 200


def number_of_single_precision(x, out):
    out[0] = x[0] * SINGLE


def product_of_any_size(x, out):
    k = int(x[0])
    out[0] = k * k


def factorial(x, out):
    f = 1
    for k in range(1, 40):
        f *= k
    out[0] = f


def sum_of_large_numbers(x, out):
    n = 0
    while x[0] > n:
        n += 2**40
    out[0] = n


def quotient_by_zero(x, out):
    for k in range(3):
        out[k] = 7 // k


def rest_of_zero(x, out):
    out[0] = 7 % (int(x[0]) % 3)


def power_of_whole_numbers(x, out):
    for k in range(3):
        out[k] = 2**k


def large_constants(x, out):
    k = 0
    for i in range(3):
        if x[i] > 0.0:
            k = 10**17 * (i + 1)
    out[0] = k


def slice_that_is_not_known(x, out):
    for k in range(3):
        out[k] = x[k:][0]


BEYOND = "the index may lie outside, it is between"
TOO_LARGE = r"a whole number may exceed 2\*\*53 here; limit it"
REFUSED = {
    index_is_the_length: "index 3 lies beyond the length 3; count from 0 to 2",
    index_is_the_length_of_a_row: "index 3 lies beyond the length 3",
    index_below_the_first: "index -4 lies beyond the length 3",
    loop_beyond_a_tuple: rf"{BEYOND} -3 and 3 and the length is 3; limit it, as in min\(max\(k, 0\), 2\)",
    loop_beyond_an_array: f"{BEYOND} 4 and 11 and the length is 8",
    lanes_beyond_an_array: f"{BEYOND} 4 and 11 and the length is 8",
    index_of_any_size: "the index may lie outside, it is any whole number and the length is 3",
    index_with_a_fraction: "expected a whole number, got one with a fraction; write int",
    index_with_a_fraction_in_a_tuple: "expected a whole number, got one with a fraction; write int",
    known_index_with_a_fraction: "an index is a whole number, not 1.0",
    truth_value_as_index: "an index of an array is a truth value, which selects in NumPy; write int",
    known_truth_value_as_index: "an index of an array is a truth value",
    array_of_whole_numbers: r"arrays hold floats, not int64; write np.array\(..., dtype=float\)",
    number_of_eight_bits: "numbers of the type uint8 follow rules of their own; write float",
    number_of_single_precision: "numbers of the type float32 follow rules of their own",
    product_of_any_size: TOO_LARGE,
    factorial: TOO_LARGE,
    sum_of_large_numbers: TOO_LARGE,
    large_constants: TOO_LARGE,
    quotient_by_zero: r"a whole number between 0 and 2 is a divisor, and may be 0; limit it, as in max\(k, 1\)",
    rest_of_zero: "a whole number between 0 and 2 is a divisor",
    power_of_whole_numbers: r"a power of whole numbers .*; write float\(a\) \*\* b",
    slice_that_is_not_known: "the ends of a slice, and the length of what is cut, must be known",
}


@pytest.mark.parametrize("function", REFUSED, ids=lambda function: function.__name__)
def test_what_may_leave_its_bounds_is_refused_with_its_line(function):
    with pytest.raises(CompileError, match=rf"{__file__}:\d+: in {function.__name__}: {REFUSED[function]}"):
        compiled(function)
