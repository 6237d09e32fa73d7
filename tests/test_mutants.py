"""The tool that draws small faults: its changes, its sample, and what it does with tests and trees."""

import ast
import subprocess
import sys
from pathlib import Path

import pytest

TOOLS = Path(__file__).parents[1] / "tools"

ROOM = '''\
"""A room of one law and one function without one."""


def doubled(x: float) -> float:
    """Return 2x."""
    if not x > 0.0:
        message = f"x must be positive, got {x - 1.0}"
        raise ValueError(message)
    return 2.0 * x


def forgotten(x: float) -> float:
    return x + 0.5
'''
LAW = """\
import pytest
from stylobate.room import doubled, forgotten


def test_twice_the_half_is_the_whole():
    assert doubled(1.5) == 3.0 == doubled(1.0) + 1.0
    with pytest.raises(ValueError):
        doubled(0.0)
    forgotten(1.0)
"""


@pytest.fixture
def tools(monkeypatch):
    """Return the two modules of the tool."""
    monkeypatch.syspath_prepend(TOOLS)
    for name in ("mutants", "mutations"):
        monkeypatch.delitem(sys.modules, name, raising=False)
    import mutants
    import mutations

    yield mutants, mutations
    for name in ("mutants", "mutations"):
        sys.modules.pop(name, None)


def changed(mutations, folder, text):
    """Return what stands in the place of the code that each mutant changes, with this code."""
    path = folder / "a.py"
    path.write_text(text)
    raw = text.encode()
    return [(raw[one.start : one.end].decode(), one.text) for one in mutations.mutants_of(path, folder)]


@pytest.mark.parametrize(
    ("line", "others"),
    [
        ("x = a + b", {"(a - b)"}),
        ("x = a / b", {"(a * b)"}),
        ("x = a < b", {"(a <= b)", "(a >= b)"}),
        ("x = a is b", {"(a is not b)"}),
        ("x = a and b", {"(a or b)"}),
        ("x = -a", {"(a)"}),
        ("x = 0.5", {"(1.5)"}),
        ("x = True", {"(False)"}),
        ("x = f(a, b, k=c)", {"(f(b, a, k=c))"}),
        ("x = max(a, b)", set()),
        ("x = f(*a, b)", set()),
        ("x += a", {"pass"}),
        ("x[a] = b", {"pass"}),
        ("f(a)", {"pass"}),
        ("raise ValueError(a + b)", {"pass"}),
        ("def f() -> float:\n    return g(a)", {"return -g(a)"}),
        ("def f() -> bool:\n    return g(a)", {"return not g(a)"}),
        ("def f() -> A | None:\n    return g(a)", {"return None"}),
        ("def f() -> tuple[A, B]:\n    return a, b", {"return (b, a)"}),
        ("def f() -> A:\n    return g(a)", set()),
    ],
)
def test_each_kind_of_change_is_made(tools, tmp_path, line, others):
    assert {text for _, text in changed(tools[1], tmp_path, line)} == others


@pytest.mark.parametrize(
    "text",
    [
        '"""1 + 1"""',
        "import a.b as c",
        "x: Annotated[float, 1 + 1]",
        "@decorated(1, 2)\ndef f(x: g(1, 2)) -> h(1, 2): ...",
        'message = f"{a + b} of {1}" + "more"',
        "plot(a, alpha=0.5, linewidth=1.0)",
        "zip(a, strict=True)",
    ],
)
def test_texts_and_looks_stay(tools, tmp_path, text):
    assert changed(tools[1], tmp_path, text) in ([], [(text, "pass")], [("zip(a, strict=True)", "pass")])


@pytest.mark.slow
def test_each_mutant_of_a_module_is_another_program_with_one_place_changed(tools):
    folder = TOOLS.parent
    path = folder / "src/stylobate/engine/kernel/driver/stages.py"
    source = path.read_text()
    found = list(tools[1].mutants_of(path, folder))
    assert len(found) > 20
    programs = {ast.dump(ast.parse(one.of(source))) for one in found}
    assert len(programs) == len({one.of(source) for one in found})
    assert ast.dump(ast.parse(source)) not in programs
    for one in found:
        lines = one.diff(source).splitlines()
        assert lines[2].startswith(f"@@ -{one.line}")
        assert source.encode()[: one.start].count(b"\n") + 1 == one.line


def test_the_sample_depends_on_the_seed_and_a_longer_one_begins_with_a_shorter_one(tools):
    found = list(range(300))
    assert tools[0].drawn(found, 1) == tools[0].drawn(found, 1) != tools[0].drawn(found, 2)
    assert sorted(tools[0].drawn(found, 1)) == found


@pytest.mark.slow
def test_a_law_kills_the_mutants_that_break_it_and_the_others_survive(tools, tmp_path, monkeypatch):
    mutants = tools[0]
    files = {"src/stylobate/__init__.py": "", "src/stylobate/room.py": ROOM, "tests/test_room.py": LAW}
    plugins = " ".join(f"-p no:{name}" for name in ("schemathesis", "hypothesispytest", "benchmark", "anyio"))
    files |= {".gitignore": ".mutants\n", "pytest.ini": f"[pytest]\naddopts = {plugins}\n"}
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    subprocess.run(["git", "init", "--quiet", str(tmp_path)], check=True)
    monkeypatch.setattr(mutants, "ROOT", tmp_path)
    tree = mutants.Tree("room.py", ["tests"], workers=0)
    assert list(tree.seconds) == ["tests/test_room.py::test_twice_the_half_is_the_whole"]
    by_text = {one.text: one for one in tree.mutants(None)}
    outcomes = {text: tree.outcome(by_text[text], tree.chosen(by_text[text], 60.0)) for text in ("pass", "(x - 0.5)")}
    assert outcomes == {"pass": "killed", "(x - 0.5)": "survived"}
    # Both trees are as they were.
    assert (
        (tmp_path / "src/stylobate/room.py").read_text() == (tree.folder / "src/stylobate/room.py").read_text() == ROOM
    )
