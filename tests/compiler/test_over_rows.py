"""Functions at many places: compiled, called as they are where that cannot be, and the same either way."""

import numpy as np
import pytest

from stylobate.compiler import compiled as module
from stylobate.compiler.compiled import over_rows

ROWS = np.random.default_rng(2).normal(size=(200, 2))


def swapped(x, y):
    return y, x * x + y, 1.0 if x > y else -1.0


def sorted_by_list(x, y):
    return tuple(sorted([x, y]))


@pytest.mark.parametrize("function", [swapped, sorted_by_list])
@pytest.mark.parametrize("count", [1, 200])
def test_rows_have_what_the_function_gives_for_each(function, count):
    expected = [function(*row) for row in ROWS[:count].tolist()]
    np.testing.assert_array_equal(over_rows(function, ROWS[:count], name="test"), expected)


def test_many_rows_are_compiled():
    over_rows(swapped, ROWS, name="compiled")
    assert module._compiled(swapped, 2, 3, "compiled")._code()
