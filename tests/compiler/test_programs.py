"""Programs: modules as they stand, whose open names are bound, and what their machine code depends on."""

import sys
import types

import pytest

from stylobate.compiler.programs import Bound, Unbound, Written
from stylobate.compiler.sources import CompileError
from stylobate.compiler.unit import ArrayArgument, Unit

LAW = """
from law_names import RATE, growth

LIMIT = 3.0


def later(x):
    return min(growth(x) * RATE, LIMIT)
"""
DRIVER = """
from law import later


def into(x, out):
    for k in range(len(x)):
        out[k] = later(x[k])
"""


@pytest.fixture
def modules(tmp_path, monkeypatch):
    """Return two modules of files: the second one calls the first."""
    names = types.ModuleType("law_names")
    names.RATE, names.growth = Unbound("RATE"), Unbound("growth")
    monkeypatch.setitem(sys.modules, "law_names", names)
    monkeypatch.syspath_prepend(tmp_path)
    for name, text in (("law", LAW), ("driver", DRIVER)):
        (tmp_path / f"{name}.py").write_text(text, encoding="utf-8")
        monkeypatch.delitem(sys.modules, name, raising=False)
    found = [__import__(name) for name in ("law", "driver")]
    yield found
    for name in ("law", "driver"):
        sys.modules.pop(name, None)


def squared(x):
    return x * x


def made(program):
    out = [0.0, 0.0]
    program.module("made", {"growth": squared}).into([1.0, 0.5], out)
    return out


def test_functions_of_bound_modules_call_each_other_and_what_is_bound(modules):
    assert made(Bound(modules, {"RATE": 2.0})) == [2.0, 0.5]
    assert made(Bound(modules, {"RATE": 4.0})) == [3.0, 1.0]
    assert isinstance(modules[0].RATE, Unbound)  # the modules are as they were


def test_constants_of_a_module_can_be_bound_too(modules):
    assert made(Bound(modules, {"RATE": 4.0, "LIMIT": 3.5})) == [3.5, 1.0]


def test_functions_of_a_written_part_are_bound(modules):
    written = Written("def growth(x):\n    return x + 1.0\n")
    out = [0.0]
    Bound(modules, {"RATE": 1.0}, written).module("made", {}).into([1.0], out)
    assert out == [2.0]


def test_lines_are_those_of_the_files(modules):
    functions = Bound(modules, {"RATE": 2.0}).module("made", {"growth": squared})
    assert functions.into.__code__.co_filename == modules[1].__file__
    with pytest.raises(TypeError) as caught:
        functions.into([None], [0.0])
    assert [entry.name for entry in caught.traceback][-3:-1] == ["into", "later"]


def test_code_depends_on_the_texts_and_on_what_is_bound(modules):
    texts = [Bound(modules, {"RATE": rate}).texts for rate in (2.0, 3.0)]
    assert texts[0] != texts[1]
    assert texts[0][1:] == texts[1][1:] == [LAW, DRIVER]


def test_a_name_that_nothing_binds_is_refused_by_the_compiler(modules):
    functions = Bound(modules, {}).module("made", {"growth": squared})
    with pytest.raises(CompileError, match="later"):
        Unit(lanes=4, trusted=True).export(functions.into, "into", [ArrayArgument((None,)), ArrayArgument((None,))])
