"""Python that is easily compiled wrong: its result is that of Python, or it is refused."""

import functools
import math
from collections import namedtuple

import numpy as np
import pytest
from llvmlite import binding as llvm

from stylobate.compiler import machine
from stylobate.compiler.marks import lanes
from stylobate.compiler.sources import CompileError

from .calling import both_ways, text_of

X = np.array([0.7, -1.3, 2.0, 0.0, -0.0, 1e-300, 3.5, -2.5, 0.25, 9.0])
LIMIT = 2.5
TABLE = np.arange(6.0).reshape(2, 3)
A, B = namedtuple("A", "one other"), namedtuple("B", "other one")  # noqa: PYI024


def loop_left_early(x, out):
    k = -1
    for k in (0, 1, 2):
        if x[k] < 0.0:
            break
    out[0] = k
    for k in (0, 1, 2):
        out[k + 1] = k
    out[4] = k


def target_assigned_in_the_body(x, out):
    for k in (0, 1, 2):
        if x[k] < 0.0:
            k = 9  # noqa: PLW2901
        out[k] = 1.0
    for k in (0, 1):
        while k < 3 and x[k] < 5.0:
            k += 1  # noqa: PLW2901
        out[4] += k


def slices_are_cut(x, out):
    row = TABLE[0]
    out[0], out[1] = len(row[1:50]), len(row[-50:])
    out[2] = len(row[2:1])


def enumerated_from_one(x, out):
    for place, value in enumerate((x[0], x[1]), start=1):
        out[place] = value


def tuples_compared(x, out):
    out[0] = (x[0], x[3]) == (0.7, 0.0)
    out[1] = (x[0], 1.0) in ((0.5, 1.0), (0.7, 1.0))
    out[2] = (x[0], x[1]) != (x[0], x[1])


def division_beside_zero(x, out):
    k = int(x[3])
    out[0] = 6 // k if k != 0 else -1
    out[1] = 6 % k if k != 0 else -1


def doubled(function):
    @functools.wraps(function)
    def inner(a):
        return function(a) * 2.0

    return inner


@doubled
def raised(a):
    return a + 1.0


def decorated(x, out):
    out[0] = raised(x[0])


def of_none(x, out):
    out[0] = with_none(x[0])
    out[1] = with_none(x[0], x[1])


def with_none(a, b=None):
    if b is None:
        b = 2.5
    return a * b


def conditions_of_numbers(x, out):
    count = 0
    for i in range(10):
        if x[i] and not (x[i] > 1.0 or count):
            count += 1
    out[0] = count
    known = None or 3.0  # noqa: SIM222
    out[1] = known


def conditions_as_numbers(x, out):
    for i in range(10):
        a, b = float(x[i]) > 0.5, float(x[i]) < 2.0  # of NumPy, True + True is True
        out[i] = (a > b) + 2 * (a >= b) + 4 * (a < b) + 8 * (a == b) + 16 * max(a, b) + 32 * ((a and not b) or b)
        out[i] += (LIMIT and x[i]) + (0.0 or x[i] * 2.0) + (None or LIMIT) + 100 * (a and True) - (a + b) ** 2


def signs(x, out):
    for i in range(10):
        out[i] = 1.0 / (np.sign(x[i]) + 0.25) + math.copysign(1.0, np.sign(x[i]))


RIGHT = [
    conditions_as_numbers,
    signs,
    *(loop_left_early, target_assigned_in_the_body, slices_are_cut, enumerated_from_one, tuples_compared),
    *(division_beside_zero, decorated, of_none, conditions_of_numbers),
]


@pytest.mark.parametrize("function", RIGHT, ids=lambda function: function.__name__)
def test_the_result_is_that_of_python(function):
    (compiled, _), (plain, _) = both_ways(function, X, np.zeros(12))
    np.testing.assert_array_equal(compiled[1], plain[1])


def of_four(x, k):
    return x[k] + 1.0, x[k] * 2.0, x[k] - x[9 - k], x[9 - k] / 3.0


def many_calls(x, out):
    for k in range(10):
        a, b, _, d = of_four(x, k)
        for _ in range(k):
            _, e, f, _ = of_four(x, 9 - k)
            a += e * f
        out[k] = a - b * d


@pytest.mark.parametrize("threshold", [0, 225])
def test_results_of_calls_that_are_not_inlined_are_those_of_python(threshold, monkeypatch):
    def tuned(**options):
        tuning = own(**options)
        tuning.inlining_threshold = threshold
        return tuning

    own = llvm.create_pipeline_tuning_options
    monkeypatch.setattr(llvm, "create_pipeline_tuning_options", tuned)
    (compiled, _), (plain, _) = both_ways(many_calls, X, np.zeros(12))
    np.testing.assert_array_equal(compiled[1], plain[1])
    assert "fld" not in machine.native().assembly(text_of(many_calls, X, np.zeros(12)))


def value_of_or(x):
    x[0] = x[1] or 5.0


def value_of_and_with_a_known_number(x):
    x[0] = ((x[1] > 0.0) and 3.0) or 1.0


def value_of_and_with_a_global(x):
    x[0] = x[0] * ((x[0] > 0.0) and LIMIT)


def value_of_or_with_a_known_number(x):
    x[0] = (x[0] > 0.0) or 5


def value_of_and_with_none(x):
    x[0] = 1.0 if ((x[0] > 0.0) and None) is None else 2.0


def value_of_or_in_lanes(x):
    for i in lanes(8):
        x[i] = (x[i] > 0.0) or 5.0


def extreme_of_one_number(x):
    x[0] = max(x[1])


def none_before_a_loop(x):
    found = None
    for i in range(10):
        if x[i] > 1.0:
            found = i + 1
    if found:
        x[0] = found


def chosen_function(x):
    law = abs
    for k in (max, min):
        if x[0] > 0.0:
            break
        law = k
    x[0] = law(x[0], 1.0)


def index_of_lanes_in_a_condition(x):
    for i in lanes(8):
        x[i] = 1.0 if i == 0 else 2.0


def before_the_row(x):
    for i in lanes(8):
        x[i] = x[i + -1]


def sum_over_lanes(x):
    total = 0.0
    for i in lanes(8):
        total += x[i]
    x[0] = total


def return_in_lanes(x):
    for i in lanes(8):
        x[i] = 1.0
        return


def array_in_a_loop(x):
    for i in range(3):
        room = np.zeros(2)
        room[0] = x[i]


def sometimes_nothing(x):
    if maybe(x):
        x[0] = 1.0


def maybe(x):
    if x[0] > 0.0:
        return None
    return 1


def returned_array(x):
    x[0] = row_of(x)[0]


def row_of(x):
    return x[1:]


def constant_written(x):
    TABLE[0, 0] = x[0]


def another_tuple(x):
    pair = A(x[0], x[1])
    if x[0] > 0.0:
        pair = B(x[1], x[0])
    x[2] = pair.one


def enumerated_array(x):
    for k, value in enumerate(x):
        x[k + 1] = value


def mistake_in_what_is_known(x):
    x[0] = (1.0, 2.0)[5]  # noqa: PLE0643


def number_too_large(x):
    x[0] = x[1] + 10**20


REFUSED = {
    value_of_or: r"the value of and, or is used: x\[1\] is no condition; write a if condition else b",
    value_of_and_with_a_known_number: "the value of and, or is used: 3.0 is no condition",
    value_of_and_with_a_global: "the value of and, or is used: LIMIT is no condition",
    value_of_or_with_a_known_number: "the value of and, or is used: 5 is no condition",
    value_of_and_with_none: "the value of and, or is used: None is no condition",
    value_of_or_in_lanes: "the value of and, or is used: 5.0 is no condition",
    extreme_of_one_number: "min and max need two numbers, or a tuple of numbers",
    none_before_a_loop: "found means None, and control flow assigns to it",
    chosen_function: "law means .*, and control flow assigns to it",
    index_of_lanes_in_a_condition: "a condition on the index of a loop over lanes",
    before_the_row: "the first lanes would lie before the array",
    sum_over_lanes: "total has no value here; a loop over a tuple or over lanes does not keep",
    return_in_lanes: "return within lanes",
    array_in_a_loop: "an array made in each pass of a loop",
    sometimes_nothing: "some paths return a value, others do not",
    returned_array: "arrays are not returned",
    constant_written: "arrays of a module, are read only",
    another_tuple: "values of different structure",
    enumerated_array: "only tuples are enumerated",
    mistake_in_what_is_known: "IndexError",
    number_too_large: "whole numbers have 64 bits",
}


@pytest.mark.parametrize("function", REFUSED, ids=lambda function: function.__name__)
def test_what_would_be_compiled_wrong_is_refused(function):
    with pytest.raises(CompileError, match=REFUSED[function]):
        text_of(function, X)


class Doubled:
    """A decorator whose objects are called instead of the function."""

    def __init__(self, function):
        functools.update_wrapper(self, function)
        self.function = function

    def __call__(self, a):
        return self.function(a) * 2.0


@Doubled
def called_twice(a):
    return a + 1.0


@functools.partial
def partial_function(a):
    return a + 1.0


@functools.cache
def remembered(a):
    return a + 1.0


def of_an_object(x):
    x[0] = called_twice(x[0])


def of_a_partial_function(x):
    x[0] = partial_function(x[0])


def of_a_method(x):
    x[0] = Doubled(remembered).__call__(x[0])


def of_a_cache(x):
    x[0] = remembered(x[0])


@pytest.mark.parametrize(
    ("function", "message"),
    [
        (of_an_object, "called_twice is an object of the class Doubled, made by a decorator; write a decorator that"),
        (of_a_partial_function, "is not a function written in Python"),
        (of_a_method, "is not a function written in Python"),
    ],
)
def test_decorators_that_are_not_understood_are_refused(function, message):
    with pytest.raises(CompileError, match=message):
        text_of(function, X)


def test_a_cache_of_results_computes_what_its_function_computes():
    (compiled, _), (plain, _) = both_ways(of_a_cache, X)
    np.testing.assert_array_equal(compiled[0], plain[0])


def assigned_if_positive(x):
    if x[0] > 0.0:
        k = 0.3
    x[1] = k


def assigned_before_a_return(x):
    if x[0] > 0.0:
        k = 0.3
    elif x[1] > 0.0:
        return
    x[1] = k


def assigned_in_a_loop_of_unknown_length(x, out):
    for i in range(int(x[0])):
        k = x[i]
    out[0] = k


def index_of_a_loop_of_unknown_length(x, out):
    for i in range(int(x[0])):
        out[i] = 1.0
    out[0] = i


def assigned_after_a_break(x):
    while True:
        if x[0] > 0.0:
            break
        k = 2.0
    x[1] = k


def assigned_after_a_continue(x):
    for i in range(3):
        if x[i] > 0.0:
            continue
        k = 2.0
    x[1] = k


def changed_before_it_is_assigned(x):
    if x[0] > 0.0:
        k = 1.0
    k += 1.0
    x[0] = k


UNASSIGNED = [
    *(assigned_if_positive, assigned_before_a_return, assigned_in_a_loop_of_unknown_length),
    *(index_of_a_loop_of_unknown_length, assigned_after_a_break, assigned_after_a_continue),
    changed_before_it_is_assigned,
]


@pytest.mark.parametrize("function", UNASSIGNED, ids=lambda function: function.__name__)
def test_a_name_without_a_value_on_some_path_is_refused(function):
    name = "i" if function is index_of_a_loop_of_unknown_length else "k"
    with pytest.raises(CompileError, match=f"{name} is not assigned on every path to its use; assign it before the"):
        text_of(function, *[X] * function.__code__.co_argcount)


def assigned_on_each_path(x, out):
    if x[0] > 0.0:  # noqa: SIM108
        k = 1.0
    else:
        k = 2.0
    for i in range(3):
        if x[i] > 5.0:
            m = 1.0
            break
        m = 2.0
    while True:
        n = 3.0
        if x[0] > 0.0 or n > 5.0:
            break
    if x[1] > 0.0:
        j = 1.0
    else:
        out[0] = 1.0
        return
    if len(out) > 2:  # noqa: SIM108
        p = 5.0
    else:
        p = 6.0
    out[1] = k + m + n + j + i + p


@pytest.mark.parametrize("second", [1.0, -1.0])
def test_a_name_with_a_value_on_each_path_has_it(second):
    x = X.copy()
    x[1] = second
    (compiled, _), (plain, _) = both_ways(assigned_on_each_path, x, np.zeros(12))
    np.testing.assert_array_equal(compiled[1], plain[1])
