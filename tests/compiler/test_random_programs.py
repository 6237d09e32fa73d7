"""Random programs: compiled ones give the bits that plain Python gives, and what Python refuses is refused."""

import ctypes
import math
from collections import Counter

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings

from stylobate.compiler import machine
from stylobate.compiler.sources import CompileError, written_module
from stylobate.compiler.unit import ArrayArgument, Unit

from .random_programs import LENGTH, Floats, names_of, programs

X = (0.7, -1.3, 2.0, 0.0, -0.0, 1e-300, 3.5, -2.5)
INFINITE = ZeroDivisionError, OverflowError, ValueError
"""Errors of Python where compiled code goes on with infinity or NaN."""


def plain(text):
    """Return the array that a program of plain Python leaves and its result, or its error."""
    out = Floats([7.0] * LENGTH)
    names = names_of(plain=True)
    exec(compile(text, "<program>", "exec"), names)  # noqa: S102
    try:
        result = names["program"](Floats(list(X)), out)
    except (*INFINITE, IndexError, NameError, TypeError) as error:
        return None, error
    return out.tolist(), result


def compiled(text):
    """Return the array that a compiled program leaves and its result."""
    module = written_module("random_program", text, names_of(plain=False))
    unit = Unit(lanes=LENGTH, exact=True)
    unit.export(module.program, "program", [ArrayArgument((LENGTH,))] * 2)
    engine = machine.linked(machine.native().object_code(unit.module.text(machine.native().attributes)))
    x, out = np.array(X), np.full(LENGTH, 7.0)
    call = ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.c_void_p, ctypes.c_void_p)(engine.get_function_address("program"))
    result = call(x.ctypes.data, out.ctypes.data)
    return out.tolist(), result


def bits(numbers):
    return ["nan" if math.isnan(number) else float(number).hex() for number in numbers]


def require_same(text):
    """Compare a program with its twin; return what became of it."""
    expected, result = plain(text)
    try:
        found = compiled(text)
    except CompileError as refusal:
        return f"refused: {str(refusal).partition(': in ')[2]}"
    if isinstance(result, INFINITE):
        return "infinite"
    assert not isinstance(result, Exception), f"{result!r}\n{text}"
    same = (bits(found[0]), found[1]) == (bits(expected), result)
    assert same or found == (expected, result), text  # 0.0 equals -0.0
    return "same" if same else "sign of zero"


def require_all_explained(count):
    """Compare as many programs with their twins.

    A name that is a whole number on one path and a fraction on another is a fraction when compiled: zero times a
    negative number is then -0.0. It takes such a name, such a product and no sum afterwards.
    """
    kinds = Counter()

    @settings(max_examples=count, suppress_health_check=list(HealthCheck))
    @given(programs())
    def compare(text):
        kinds[require_same(text).partition(":")[0]] += 1

    compare()
    assert kinds["same"] > 0.5 * count
    assert kinds["sign of zero"] <= 0.001 * count


@pytest.mark.parametrize("count", [60, pytest.param(20_000, marks=pytest.mark.slow)])
def test_random_programs_give_the_bits_of_python(count):
    require_all_explained(count)
