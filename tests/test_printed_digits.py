"""The tool that finds printed digits which other tolerances and processors change."""

import importlib.util
from pathlib import Path

import pytest

import stylobate as sb

ROOT = Path(__file__).parents[1]
RUN = """run = sb.simulate(
    sb.Slender(sb.Column.dimensionless(slenderness=0.1)), tilt=(0.06, 0.01), duration=20.0
)"""
PAGE = """# Page

```python
import stylobate as sb

{run}
print(run.measures["peak_tilt"])
```

```text
{peak!r}
```

The end is at {tilt!r}.

```python
>>> run.outcome.name
'STILL_MOVING'
>>> float(run.data["amplitude"][-1])
{tilt!r}
>>> round(float(run.data["amplitude"][-1]), 4)
{rounded}
```
"""


@pytest.fixture(scope="module")
def tool():
    spec = importlib.util.spec_from_file_location("printed_digits", ROOT / "tools" / "printed_digits.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_a_digit_that_a_finer_tolerance_changes_is_reported_with_its_line(tool, tmp_path, capsys):
    names = {"sb": sb}
    exec(RUN, names)  # noqa: S102  the program of the page
    tilt = float(names["run"].data["amplitude"][-1])
    page = tmp_path / "page.md"
    text = PAGE.format(run=RUN, peak=names["run"].measures["peak_tilt"], tilt=tilt, rounded=round(tilt, 4))
    page.write_text(text, encoding="utf-8")

    changes = tool.run_page(str(page), "tenth")

    (changed,) = changes  # neither the rounded tilt, nor the peak, which is the start
    lines = text.splitlines()
    assert lines[changed["line"] - 1] == '>>> float(run.data["amplitude"][-1])'
    assert changed["printed"].strip() == repr(tilt)
    assert float(changed["got"]) == pytest.approx(tilt, abs=1e-7)
    tool.report(str(page), "tenth", changes)
    quoted = lines.index(f"The end is at {tilt!r}.") + 1
    assert f"quoted  in lines {quoted}\n" in capsys.readouterr().out


def test_lines_that_differ_are_shown_alone(tool):
    assert list(tool.differing("a 1\nb 2\n", "a 1\nb 3\n")) == [("b 2", "b 3")]
    assert list(tool.differing("a 1\n", "a 1\nb 3\n")) == [("a 1", "a 1\nb 3")]


def test_every_page_with_examples_is_run_but_the_one_that_needs_a_server(tool):
    found = tool.pages()
    assert {"README.md", "docs/index.md", "docs/how-to/casks.md"} <= {*found}
    assert "docs/reference/http-api.md" not in found
