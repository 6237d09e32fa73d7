"""Values that were read while compiling: code is used only as long as all of them are what they were."""

import importlib.util
import sys
from itertools import count

import numpy as np
import pytest

from stylobate.compiler.compiled import Compiled
from stylobate.compiler.programs import Written
from stylobate.compiler.unit import ArrayArgument
from stylobate.errors import UnsupportedError

PROGRAM = """
def advance(x, out):
    out[0] = rates(x[0])
"""
HEAD = """
from collections import namedtuple
from enum import Enum
from types import SimpleNamespace

import numpy as np

K = 2.0
WEIGHTS = (0.25, 0.5)
TABLE = np.array([1.0, 2.0, 3.0])
LIST = [1.0, 2.0]
LIMITS = SimpleNamespace(low=SimpleNamespace(k=2.0))
NESTED = (SimpleNamespace(k=2.0),)
Pair = namedtuple("Pair", "first second", defaults=(2.0,))


class Const:
    K = 2.0


class Calibrated:
    factor = 2.0

    @property
    def k(self):
        return 2.0 * self.factor


CALIBRATED = Calibrated()


class Rule(Enum):
    SOFT = 2.0


class Jit:
    def __init__(self, function):
        self.py_func = function

    def __call__(self, x):
        return self.py_func(x)


def of_class(constants, x):
    return constants.K * x


def made(numbers):
    k = numbers.k

    def plain(x):
        return k * x

    def inner(x):
        return numbers.k * x

    def change(value):
        nonlocal k
        k = value

    return plain, inner, change


CFG = SimpleNamespace(k=2.0)
of_cell, of_object, change_cell = made(CFG)


def with_default(x, numbers=CFG, *, shift=0.5):
    return numbers.k * x + shift


def helper(x):
    return 2.0 * x


def other(x):
    return 5.0 * x


jitted = Jit(helper)
"""
READ = {  # the result, and a statement that changes it
    "global": ("K * x", "K = 40.0"),
    "global in a generator": ("sum(K * w for w in WEIGHTS) * x", "K = 40.0"),
    "tuple": ("sum(w for w in WEIGHTS) * x", "WEIGHTS = (0.25, 0.75)"),
    "attribute of a class": ("Const.K * x", "Const.K = 40.0"),
    "local name of a class": ("sum((c.K for c in (Const,))) * x", "Const.K = 40.0"),
    "class as an argument": ("of_class(Const, x)", "Const.K = 40.0"),
    "cell of a closure": ("of_cell(x)", "change_cell(40.0)"),
    "object in a closure": ("of_object(x)", "CFG.k = 40.0"),
    "object in a default": ("with_default(x)", "CFG.k = 40.0"),
    "default": ("with_default(x)", "with_default.__kwdefaults__ = {'shift': 7.0}"),
    "object in a tuple": ("NESTED[0].k * x", "NESTED[0].k = 40.0"),
    "object in an object": ("LIMITS.low.k * x", "LIMITS.low = SimpleNamespace(k=40.0)"),
    "property": ("CALIBRATED.k * x", "CALIBRATED.factor = 40.0"),
    "element of an array": ("TABLE[1] * x", "TABLE[1] = 40.0"),
    "length of a list": ("len(LIST) * x", "LIST.append(3.0)"),
    "elements of a list": ("sum(w for _, w in enumerate(LIST)) * x", "LIST[0] = 40.0"),
    "constant of NumPy": ("np.pi * K * x", "np = SimpleNamespace(pi=3.0)"),
    "function": ("helper(x)", "helper = other"),
    "code of a function": ("helper(x)", "helper.__code__ = other.__code__"),
    "code of the only function": ("2.0 * x", "rates.__code__ = other.__code__"),
    "function within a compiler's": ("jitted(x)", "jitted.py_func = other"),
    "member of an enumeration": ("Rule.SOFT.value * x", "Rule = SimpleNamespace(SOFT=SimpleNamespace(value=40.0))"),
    "default of a tuple": ("Pair(x).second", "Pair = namedtuple('Pair', 'first second', defaults=(40.0,))"),
    "built-in function": ("max(x, 2.0 * x)", "max = min"),
}


@pytest.fixture
def imported(tmp_path, monkeypatch):
    """Write a module and import it; returns its function `rates`."""
    monkeypatch.setenv("STYLOBATE_CACHE", str(tmp_path / "cache"))
    number = count()

    def write(result, change=""):
        name = f"changing_{next(number)}"
        path = tmp_path / f"{name}.py"
        path.write_text(f"{HEAD}\n\ndef rates(x):\n    return {result}\n\n\n{change}\n", encoding="utf-8")
        spec = importlib.util.spec_from_file_location(name, path)
        module = importlib.util.module_from_spec(spec)
        monkeypatch.setitem(sys.modules, name, module)
        spec.loader.exec_module(module)
        return module.rates

    return write


def compiled(rates, program=PROGRAM):
    argument = ArrayArgument((1,))
    return Compiled(
        "advance", lambda: Written(program), {"rates": rates}, (argument, argument), model="model", description="values"
    )


def result_of(function):
    out = np.zeros(1)
    function(np.array([1.5]), out)
    return out[0]


@pytest.mark.parametrize(("result", "change"), READ.values(), ids=READ)
def test_a_changed_value_is_seen_in_the_same_process(imported, result, change):
    rates = imported(result)
    function = compiled(rates)
    before = rates(1.5)
    assert result_of(function) == result_of(function) == before
    exec(change, rates.__globals__)  # noqa: S102  our own text
    assert result_of(function) == rates(1.5) != before


@pytest.mark.parametrize(("result", "change"), READ.values(), ids=READ)
def test_kept_code_is_not_used_for_other_values(imported, result, change):
    rates, changed = imported(result), imported(result, change)
    assert result_of(compiled(rates)) == rates(1.5)
    assert result_of(compiled(changed)) == changed(1.5) != rates(1.5)
    assert result_of(compiled(rates)) == rates(1.5)


def test_code_for_values_that_return_is_not_compiled_again(imported, caplog):
    rates = imported("K * x")
    function = compiled(rates)
    for k in (2.0, 40.0, 2.0, 40.0):
        rates.__globals__["K"] = k
        assert result_of(function) == 1.5 * k
    assert sum("compiling values" in line for line in caplog.messages) == 2


def test_plain_python_sees_a_changed_text(imported):
    rates, texts = imported("K * x"), [PROGRAM]
    function = compiled(rates)
    function = Compiled("advance", lambda: Written(texts[0]), {"rates": rates}, function.arguments, "model", "values")
    out = np.zeros(1)
    function.plain([1.5], out)
    texts[0] = PROGRAM.replace("x[0])", "x[0]) + 1.0")
    function.plain([1.5], out)
    assert out[0] == rates(1.5) + 1.0
    assert result_of(function) == rates(1.5) + 1.0


def test_a_value_that_differs_at_each_reading_is_refused(imported):
    clock = "CLOCK = type('Clock', (), {'now': property(lambda self, n=iter(range(9)): float(next(n)))})()"
    with pytest.raises(UnsupportedError, match=r"CLOCK.now has another value at each reading; keep it in a variable"):
        result_of(compiled(imported("(CLOCK.now + CLOCK.now) * x", clock)))


def test_a_value_whose_change_would_be_missed_is_refused(imported):
    program = "class Own:\n    K = 2.0\n\n" + PROGRAM.replace("x[0])", "x[0], Own)")
    rates = imported("K * x").__globals__["of_class"]
    with pytest.raises(UnsupportedError, match=r"a change of constants.K would not be noticed; keep it in a variable"):
        result_of(compiled(lambda x, own: rates(own, x), program))


@pytest.mark.parametrize("result", ["x * (TRUTH == 1)", "x if TRUTH else 2.0 * x"])
def test_objects_that_compare_by_a_law_of_their_class_are_refused(imported, result):
    law = "Law = type('Law', (), {'__eq__': lambda a, b: True, '__hash__': None, '__bool__': lambda a: True})"
    with pytest.raises(UnsupportedError, match="is compared, or is a condition, by a law of its class"):
        result_of(compiled(imported(result, f"{law}\nTRUTH = Law()")))
