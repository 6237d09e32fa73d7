"""A number is declared once: no other list of names stands beside the declarations."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

import stylobate
from stylobate.base_motions.declared import MOTIONS, motion_quantities
from stylobate.column.shapes import SHAPES
from stylobate.models.declared import MODELS, column_quantities, model_quantities
from stylobate.run_arguments import run_numbers

ROOT = Path(stylobate.__file__).parent
NUMBERS = {
    *motion_quantities(),
    *model_quantities(),
    *column_quantities(),
    *run_numbers(),
}
KINDS = {*MODELS, *MOTIONS, *SHAPES}

# Names in one display, or in one signature, from which they are a list of names; and the share of names in a display.
LEAST, LEAST_OF_A_SIGNATURE, SHARE = 3, 12, 0.8

REGISTRIES = {"base_motions/declared.py", "models/declared.py", "column/shapes.py"}
"""Here kinds are registered: a name and the place of what makes one."""

WRITTEN = {"lab/web/src/page/server/declared.ts"}
"""Files that tools/page_types.py writes from the declarations; a test checks them."""

REMAINING: dict[str, int] = {
    "column/body.py": 1,  # numbers that change with the size
    "engine/ensemble.py": 1,  # arguments of `simulate_ensemble` by name
    "engine/ensembles/runs.py": 1,  # numbers of a column that are masses
    "engine/parameters.py": 1,  # numbers of a column, and two by which it scales
    "engine/starts.py": 1,  # the start of a run by name
    "plots/labels.py": 1,  # ratios on the axes of dimensionless columns
}
"""Lists that are still kept by hand, by file: none may be added, and what goes is taken off here."""


def displays(tree: ast.AST) -> Iterator[list[str]]:
    """Yield the strings of each dict, tuple, list, set and Literal."""
    in_subscripts = {id(node.slice) for node in ast.walk(tree) if isinstance(node, ast.Subscript)}
    for node in ast.walk(tree):
        match node:
            case ast.Tuple() if id(node) in in_subscripts:
                continue
            case ast.Dict(keys=parts) | ast.Tuple(elts=parts) | ast.List(elts=parts) | ast.Set(elts=parts):
                pass
            case ast.Subscript(value=ast.Name(id="Literal"), slice=ast.Tuple(elts=parts)):
                pass
            case _:
                continue
        yield [one.value for one in parts if isinstance(one, ast.Constant) and isinstance(one.value, str)]


def signatures(tree: ast.AST) -> Iterator[list[str]]:
    """Yield the names of the arguments of each function."""
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef):
            yield [argument.arg for argument in (*node.args.args, *node.args.kwonlyargs)]


def is_a_list_of_names(strings: list[str]) -> bool:
    return any(
        len(strings) >= LEAST and sum(one in names for one in strings) >= max(LEAST, SHARE * len(strings))
        for names in (NUMBERS, KINDS)
    )


def lists_in(path: Path) -> int:
    """Return how many lists of names a file holds."""
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".ts":
        found = re.findall(r"\[((?:\s*\"[a-z_]+\",?)+)\s*\]", text)
        return sum(is_a_list_of_names(re.findall(r"\"([a-z_]+)\"", one)) for one in found)
    tree = ast.parse(text)
    long = sum(sum(name in NUMBERS for name in names) >= LEAST_OF_A_SIGNATURE for names in signatures(tree))
    return long + sum(map(is_a_list_of_names, displays(tree)))


def test_no_list_of_names_is_kept_beside_the_declarations():
    sources = [*ROOT.rglob("*.py"), *(ROOT / "lab/web/src").rglob("*.ts")]
    places = {path.relative_to(ROOT).as_posix(): path for path in sources}
    counted = {name: lists_in(path) for name, path in places.items()}
    found = {name: count for name, count in counted.items() if count and name not in {*REGISTRIES, *WRITTEN}}
    assert found == REMAINING


@pytest.mark.parametrize(
    ("text", "count"),
    [
        ('NAMES = ("damping", "restitution", "patch")', 1),
        ('NAMES = {"damping": 1, "restitution": 2, "patch": 3}', 1),
        ('NAMES = ("damping", "restitution")', 0),
        ('Kind = Literal["slender", "rolling", "wobbling"]', 1),
        ('WORDS = ("damping", "restitution", "patch", "one", "two", "three")', 0),
        (f"def run(*, {', '.join(sorted(NUMBERS)[:12])}): ...", 1),
    ],
)
def test_lists_of_names_are_recognised(tmp_path, text, count):
    path = tmp_path / "module.py"
    path.write_text(text, encoding="utf-8")
    assert lists_in(path) == count
