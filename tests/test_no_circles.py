"""Modules of one room import each other one way, also inside functions and for types alone."""

import ast
from collections import defaultdict
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

import stylobate

SOURCE = Path(stylobate.__file__).parent


def name_of(path):
    parts = path.relative_to(SOURCE.parent).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


MODULES = {name_of(path): path for path in sorted(SOURCE.rglob("*.py"))}


def room_of(module):
    return module.split(".")[1] if module.count(".") else "stylobate"


ROOMS = sorted({room_of(name) for name in MODULES})


def imports_of(tree):
    """Return the modules of the package that a module imports, wherever in it."""
    found = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            found.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            names = (f"{node.module}.{alias.name}" for alias in node.names)
            found.update(name if name in MODULES else node.module for name in names)
    return found & MODULES.keys()


def circle_in(graph):
    """Return one circle of a graph as a list of its nodes; none where there is none."""
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        return error.args[1]
    return None


@pytest.mark.parametrize("room", ROOMS)
def test_no_modules_of_a_room_import_each_other_in_a_circle(room):
    graph = defaultdict(set)
    for name, path in MODULES.items():
        if room_of(name) == room:
            reached = imports_of(ast.parse(path.read_text(encoding="utf-8")))
            graph[name] = {other for other in reached if room_of(other) == room}
    circle = circle_in(graph)
    assert circle is None, " imports ".join(reversed(circle))


def test_the_search_sees_imports_in_functions_and_for_types():
    source = (
        "import stylobate.models.model\n"
        "if TYPE_CHECKING:\n    from stylobate.models import slender\n"
        "def f():\n    from stylobate.models.rolling import Rolling\n"
    )
    names = ("model", "slender", "rolling")
    assert imports_of(ast.parse(source)) == {f"stylobate.models.{name}" for name in names}
    assert circle_in({"a": {"b"}, "b": {"c"}, "c": {"a"}}) is not None
    assert circle_in({"a": {"b", "c"}, "b": {"c"}}) is None
