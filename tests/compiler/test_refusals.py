"""What is not of the accepted language is refused with file, line and a remedy."""

import re

import numpy as np
import pytest

from stylobate.compiler.marks import lanes
from stylobate.compiler.sources import CompileError

from .calling import text_of

X = np.ones(8)
UNKNOWN = {"a": 1.0}


def comprehension(x):
    x[0] = sum([x[k] for k in range(3)])


def a_dictionary(x):
    x[0] = UNKNOWN["a"]


def of_another_kind(x):
    y = 1.0
    if x[0] > 0.0:
        y = (1.0, 2.0)
    x[1] = y


def text(x):
    y = 0.0
    if x[0] > 0.0:
        y = "a"
    x[1] = y


def not_assigned(x):
    x[0] = y  # noqa: F821
    y = 1.0  # noqa: F841


def not_defined(x):
    x[0] = nothing_here(x[0])  # noqa: F821


def recursive(x):
    deep(x, 1.0)


def deep(x, a):
    if a > 0.0:
        deep(x, a - x[0])


def opens_a_file(x):
    open("x")  # noqa: PTH123, SIM115
    x[0] = 1.0


def some_ways(x):
    x[0] = sometimes(x[0])


def sometimes(a):  # noqa: RET503
    if a > 0.0:
        return 1.0


def wrong_arguments(x):
    x[0] = sometimes(x[0], 2.0)


def condition_in_lanes(x):
    for i in lanes(8):
        if x[i] > 0.0:
            x[i] = 1.0


def left_early_in_lanes(x):
    for i in lanes(8):
        for k in range(3):
            x[i] = x[i] + k
            break


def number_of_a_lane(x):
    for i in lanes(8):
        x[i] = i


def first_axis(x):
    for i in lanes(8):
        x[i] = np.zeros((8, 2))[i, 0]


def lanes_into_one_place(x):
    for i in lanes(8):
        x[0] = x[i]


def uneven(x):
    for i in lanes(7):
        x[i] = 1.0


def after_the_lanes(x):
    for i in lanes(8):
        a = x[i]
    x[0] = a


def fraction_as_index(x):
    x[0] = x[1.5]


def too_many_indices(x):
    x[0] = x[0, 1]


def whole_of_a_fraction(x):
    x[0] = x[int(x[0] * 1.0)] + x[x[0] * 1.0]


def steps(x):
    for k in range(0, 8, 2):
        x[k] = 1.0


def with_a_block(x):
    with x[0]:
        pass


def of_unknown_length(x):
    a, b = x
    x[0] = a + b


def bits(x):
    x[0] = float(int(x[0]) & 1)


def shifted(x):
    k = int(x[0])
    k <<= 1
    x[0] = float(k)


def else_after_while(x):
    while x[0] > 2.0:
        x[0] -= 1.0
        if x[1] > 0.0:
            break
    else:
        x[1] = 1.0


def else_after_for(x):
    for k in range(3):
        x[k] = 2.0
        if x[1] > 0.0:
            break
    else:
        x[1] = 1.0


def spelled_infinity(x):
    x[0] = min(x[0], float("inf"))


REFUSED = {
    comprehension: "ListComp is not compiled; write it with loops",
    a_dictionary: "is not an element of an array or a tuple",
    of_another_kind: "values of different structure",
    text: "a number, a view into an array, or a tuple of them|different structure",
    not_assigned: "y has no value here",
    not_defined: "nothing_here is not defined",
    recursive: "deep calls itself; write it as a loop",
    opens_a_file: "open is not a function written in Python",
    some_ways: "some paths return a value, others do not",
    wrong_arguments: "too many positional arguments",
    condition_in_lanes: "a condition on lanes; write a if condition else b",
    left_early_in_lanes: "break and continue within lanes",
    number_of_a_lane: "expected a number, got the index of a loop over lanes",
    first_axis: "belongs in the last axis",
    lanes_into_one_place: "lanes are stored in one element",
    uneven: "a multiple of 8 passes",
    after_the_lanes: "a has no value here; a loop over",
    fraction_as_index: "an index is a whole number, not 1.5",
    too_many_indices: "an array of 1 axes is indexed with 2 indices",
    whole_of_a_fraction: r"expected a whole number, got one with a fraction; write int\(...\)",
    steps: "a range whose step is not 1",
    with_a_block: "With is not compiled",
    of_unknown_length: "only a row of known length",
    bits: "& and | join conditions; bits of whole numbers are not compiled$",
    shifted: r"LShift is not compiled; write it with \+",
    else_after_while: "else after a loop is not compiled; set a truth value",
    else_after_for: "else after a loop is not compiled; set a truth value",
    spelled_infinity: r"float\('inf'\) is not compiled; write math.inf",
}


@pytest.mark.parametrize("function", REFUSED, ids=lambda function: function.__name__)
def test_what_is_not_compiled_is_refused_with_its_line(function):
    with pytest.raises(CompileError, match=REFUSED[function]) as caught:
        text_of(function, X)
    message = str(caught.value)
    assert "\n" not in message
    assert re.match(rf"{re.escape(__file__)}:\d+: in \w+: ", message)


def test_a_function_without_text_is_refused_with_a_remedy():
    names = {}
    exec("def hidden(x):\n    x[0] = 1.0\n", names)  # noqa: S102
    with pytest.raises(CompileError, match="the text of hidden cannot be found in <string>; write it in a file"):
        text_of(names["hidden"], X)


def test_a_file_that_changed_after_it_was_imported_is_refused(tmp_path, monkeypatch):
    path = tmp_path / "changing_functions.py"
    path.write_text("def changed(x):\n    x[0] = 1.0\n")
    monkeypatch.syspath_prepend(tmp_path)
    from changing_functions import changed

    path.write_text("ONE = 1.0\n\n\ndef changed(x):\n    x[0] = 2.0 * ONE\n")
    with pytest.raises(CompileError, match="if the file has changed since it was imported, start again"):
        text_of(changed, X)
    path.write_text("def changed(x):\n    x[0] = 2.0\n\n")
    with pytest.raises(CompileError, match="if the file has changed since it was imported, start again"):
        text_of(changed, X)


def test_a_function_in_a_document_that_is_no_program_is_refused_with_its_line(tmp_path):
    path = tmp_path / "page.md"
    lines = [
        "# A page",
        "",
        "It has words first.",
        "",
        "def on_a_page(x):",
        "    x[0] = 1.0",
        "    x[1] = {}[x[0]]",
        "",
        "End.",
    ]
    path.write_text("\n".join(lines))
    names = {}
    # As tools do that run the blocks of a page: the block is compiled at its place in the file.
    exec(compile("\n" * 4 + "\n".join(lines[4:7]), str(path), "exec"), names)  # noqa: S102
    with pytest.raises(CompileError, match=rf"^{re.escape(str(path))}:7: in on_a_page: "):
        text_of(names["on_a_page"], X)
