"""Loops over lanes: passes side by side give what passes one after the other give."""

import math
import re

import numpy as np
import pytest

from stylobate.compiler import machine
from stylobate.compiler.marks import fast, lanes

from .calling import both_ways, text_of

WIDTH = 24
GENERATOR = np.random.default_rng(4)
X = GENERATOR.normal(size=(3, WIDTH)) * 3.0
OFFSETS = np.array([0.5, -0.25, 2.0, 1.0] * 6)


def helper(a, b=2.0):
    scaled = a * b
    return scaled, -scaled if a > 0.0 else a


def straight(x, out):
    factor = x[0, 0] * 2.0
    for i in lanes(WIDTH):
        a, b = helper(x[0, i])
        a, c = helper(b, a)
        for k in range(3):
            a = a + k * x[k, i]
        chosen = a if b < c and not c > 1.0 else b / factor
        out[0, i] = chosen
        out[1, i] = 3.0
        out[2, i] += min(a, b, 1.0) + max(abs(c), 0.5) + OFFSETS[i]
        out[2, i] = out[2, i] * (1.0 if a > 0.0 or b > 0.0 else 0.0)
    out[0, 0] = factor


def of_rows(x, out):
    flat = x.shape[0]
    for i in lanes(WIDTH):
        out[flat - 1, i] = math.sqrt(x[0, i] * x[0, i]) + np.floor(x[1, i]) + math.floor(x[2, i])


def of_the_library(x, out):
    for i in lanes(WIDTH):
        out[0, i] = math.sin(x[0, i]) + math.atan2(x[1, i], x[2, i]) + math.hypot(x[1, i], x[2, i])
        out[1, i] = abs(x[1, i]) ** 1.5


@pytest.mark.parametrize("count", [2, 4, 8, 24])
@pytest.mark.parametrize("function", [straight, of_rows])
def test_lanes_of_any_number_give_the_bits_of_python(function, count):
    (compiled, _), (plain, _) = both_ways(function, X, np.ones((3, WIDTH)), lanes=count)
    np.testing.assert_array_equal(compiled[1], plain[1])


def test_functions_of_the_library_are_called_for_each_lane():
    (compiled, _), (plain, _) = both_ways(of_the_library, X, np.ones((3, WIDTH)))
    np.testing.assert_allclose(compiled[1], plain[1], rtol=4e-16)


def branching(a, b):
    if a > b:
        return a, 1
    while b < 4.0:
        b = abs(b) * 2.0 + 1.0
    return helper(b)[0], 2


def calls_what_branches(x, out):
    for i in lanes(WIDTH):
        a, kind = branching(x[0, i], x[1, i])
        out[0, i] = a + 1.0
        out[1, i] = kind


@pytest.mark.parametrize("count", [2, 8])
def test_functions_with_branches_are_called_for_each_lane(count):
    (compiled, _), (plain, _) = both_ways(calls_what_branches, X, np.ones((3, WIDTH)), lanes=count)
    np.testing.assert_array_equal(compiled[1], plain[1])


@fast
def fused(x, out):
    for i in lanes(WIDTH):
        out[0, i] = (x[0, i] * x[1, i] + x[2, i]) / x[1, i]


def test_fast_functions_differ_by_rounding_only_and_keep_what_is_no_number():
    x = X.copy()
    x[0, 3], x[1, 5] = math.nan, 0.0
    (compiled, _), (plain, _) = both_ways(fused, x, np.zeros((3, WIDTH)))
    np.testing.assert_allclose(compiled[1], plain[1], rtol=1e-13)
    assert math.isnan(compiled[1][0, 3])
    assert math.isinf(compiled[1][0, 5])


# Floating arithmetic on all lanes of a register, and on one number.
PACKED, SINGLE = (rf"^\s+v?(?:add|sub|mul|div|sqrt|min|max|fn?m(?:add|sub)\d*)(?:{kind})\s" for kind in ("pd", "sd"))


@pytest.mark.skipif(machine.native().vector_bits < 256, reason="the machine has no AVX")
@pytest.mark.parametrize(("function", "packed"), [(fused, True), (of_the_library, False)])
def test_lanes_are_vector_code(function, packed):
    assembly = machine.native().assembly(text_of(function, X, X, lanes=machine.native().lanes))
    assert re.search(PACKED, assembly, re.MULTILINE)
    assert bool(re.search(SINGLE, assembly, re.MULTILINE)) is not packed or function is of_the_library
    assert ("sin" in assembly) is not packed
