"""The tutorials run as notebooks, and their outputs contain the pictures."""

import ast
import re
from pathlib import Path

import nbformat
import pytest
from nbclient import NotebookClient

TUTORIALS = sorted((Path(__file__).parents[1] / "examples" / "tutorials").glob("plot_*.py"))


def cells(program):
    """Split a program with cells into the source of its cells of code; comments between them are text."""
    parts = re.split(r"^# %%.*$", program, flags=re.MULTILINE)
    return [part.strip() for part in parts if ast.parse(part).body]


def shows_a_figure(cell):
    """Whether a cell ends with a figure or an animation, or draws with pyplot."""
    last = ast.unparse(ast.parse(cell).body[-1])
    return last.startswith(("sb.plot", "sb.animate")) or ".plot_" in last.split("(")[0] or "plt.subplots" in cell


@pytest.mark.slow  # the documentation runs them too, as programs
@pytest.mark.parametrize("tutorial", TUTORIALS, ids=lambda one: one.stem)
def test_a_tutorial_runs_as_a_notebook_with_its_pictures(tutorial, tmp_path):
    notebook = nbformat.v4.new_notebook()
    notebook.cells = [nbformat.v4.new_code_cell(cell) for cell in cells(tutorial.read_text(encoding="utf-8"))]
    NotebookClient(notebook, timeout=900, kernel_name="python3", resources={"metadata": {"path": tmp_path}}).execute()
    expected = [cell for cell in notebook.cells if shows_a_figure(cell.source)]
    assert expected
    for cell in expected:
        pictures = {kind for output in cell.outputs for kind in output.get("data", {})}
        assert pictures & {"image/png", "image/gif", "text/html"}, cell.source
