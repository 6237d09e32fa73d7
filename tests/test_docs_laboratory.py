"""Pages of the documentation open their cases in the laboratory."""

import sys
from io import StringIO
from pathlib import Path

import pytest

application = pytest.importorskip("sphinx.application", reason="the tools of the documentation are not installed")

from sphinx.util.docutils import docutils_namespace  # noqa: E402

pytestmark = pytest.mark.system

EXTENSIONS = Path(__file__).parents[1] / "docs" / "extensions"
PAGE = """
Title
=====

.. code-block:: python

   import stylobate as sb

   column = sb.Column.dimensionless(slenderness=0.1)
   circle = sb.Harmonic.circular(acceleration=0.05, angular_frequency=2.0)
   run = sb.simulate(sb.Slender(column, damping=0.1), circle, tilt=(0.03, 0.0), duration=3.0)

.. laboratory::

.. laboratory:: Watch it

   duration = 9.0
   tilt = [0.05, 0.0]
   column = { slenderness = 0.2 }

.. laboratory::
   :lesson: critical
"""
OF_CODE = (
    "column=dimensionless,slenderness:0.1&amp;model=slender,damping:0.1"
    "&amp;motion=circular,acceleration:0.05,angular_frequency:2&amp;tilt=0.03,0&amp;duration=3"
)
OF_TOML = "column=dimensionless,slenderness:0.2&amp;model=wobbling&amp;motion=rest&amp;tilt=0.05,0&amp;duration=9"


@pytest.fixture
def build(tmp_path, monkeypatch):
    """Build a site of one page in a folder, with the static laboratory or without it."""
    if not EXTENSIONS.is_dir():
        pytest.skip("the documentation is not here")
    monkeypatch.setattr(sys, "path", [str(EXTENSIONS), *sys.path])
    for name in ("source/in", "static/answers"):
        (tmp_path / name).mkdir(parents=True)
    (tmp_path / "static/index.html").write_text("the laboratory", encoding="utf-8")
    (tmp_path / "static/answers/one.json").write_text("{}", encoding="utf-8")
    (tmp_path / "source/index.rst").write_text("Start\n=====\n\n.. toctree::\n\n   in/page\n", encoding="utf-8")

    def built(text, laboratory):
        (tmp_path / "source/in/page.rst").write_text(text, encoding="utf-8")
        settings = {"extensions": ["laboratory_links"], "static_laboratory": laboratory, "html_theme": "basic"}
        problems = StringIO()
        folders = (tmp_path / "source", None, tmp_path / "site", tmp_path / "trees")
        with docutils_namespace():
            app = application.Sphinx(*folders, "html", settings, status=None, warning=problems)
            app.build()
        return (tmp_path / "site/in/page.html").read_text(encoding="utf-8"), problems.getvalue()

    return built


def test_links_lead_to_the_case_of_the_code_of_a_description_and_of_a_lesson(build, tmp_path):
    page, problems = build(PAGE, str(tmp_path / "static"))
    assert problems == ""
    for link, label in (
        (OF_CODE, "Open this case in the laboratory"),
        (OF_TOML, "Watch it"),
        ("lesson=critical", "Open the lesson “The critical frequency” in the laboratory"),
    ):
        assert f'href="../laboratory/index.html#{link}">{label}</a>' in page
    assert (tmp_path / "site/laboratory/answers/one.json").is_file()


def test_a_site_without_the_laboratory_has_no_links(build, tmp_path):
    page, problems = build(PAGE, "")
    assert problems == ""
    assert "index.html#" not in page
    assert not (tmp_path / "site/laboratory").exists()


@pytest.mark.parametrize(
    ("directive", "words"),
    [
        ("   :case: tempel", "did you mean temple"),
        ("\n   duration = 9.0\n   column = { slenderness = -0.2 }", "slenderness must be positive"),
        ("\n   duration = 9.0\n   column = { slenderness = 0.2 }\n   tilt_limit = 1.0", "without a server"),
        ("", "there is no Python block before"),
    ],
)
def test_a_case_that_the_page_cannot_open_is_reported(directive, words, build):
    _, problems = build(f"Title\n=====\n\n.. laboratory::\n{directive}\n", "")
    assert words in problems
