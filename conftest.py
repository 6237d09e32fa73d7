"""The code blocks of README.md and of the documentation run as tests, each file in a folder of its own."""

import os
import re
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from doctest import ELLIPSIS, NORMALIZE_WHITESPACE
from pathlib import Path
from typing import Any

import pytest
from sybil import Document, Example, Region, Sybil
from sybil.parsers.myst import PythonCodeBlockParser, SkipParser

# pytest puts a module that it imports first in the place of the function of that name in its package.
import stylobate.studies  # noqa: F401

# Programs of the documentation run while the site is built.
collect_ignore_glob = ["docs/*.py"]


def _enter_folder(namespace: dict[str, Any]) -> None:
    namespace["_folder"] = tempfile.TemporaryDirectory(prefix="stylobate-")
    namespace["_home"] = Path.cwd()
    os.chdir(namespace["_folder"].name)


def _leave_folder(namespace: Mapping[str, Any]) -> None:
    os.chdir(namespace["_home"])
    namespace["_folder"].cleanup()


@pytest.fixture(scope="session")
def laboratory() -> Iterator[str]:
    """The address of a laboratory that is served."""
    from tests.lab.conftest import laboratory as served

    with served() as address:
        yield address


@pytest.fixture(scope="session")
def token() -> str:
    """The token of that laboratory."""
    from tests.lab.browser import TOKEN

    return TOKEN


_NAMED = re.compile(r"(?<![`}])`(?!\w+\.(?:csv|html|nc|toml|zarr)`)([a-z]\w*)((?:\.[a-z_]\w*|\[\"[^\"`]+\"\])+)`(?!`)")
_BLOCK = re.compile(r"^(```+|:::+).*?^\1", re.DOTALL | re.MULTILINE)


def _named_values(document: Document) -> Iterator[Region]:
    """Find where the text of a page names attributes or items of the page's own variables: `run.measures["turns"]`."""
    blocks = [match.span() for match in _BLOCK.finditer(document.text)]
    code = "\n".join(document.text[begin:end] for begin, end in blocks)
    for match in _NAMED.finditer(document.text):
        inside = any(begin <= match.start() < end for begin, end in blocks)
        if not inside and re.search(rf"^{match[1]}(, \w+)* = ", code, re.MULTILINE):
            yield Region(match.start(), match.end(), (match[1], match[2]), _look_up)


def _look_up(example: Example) -> str | None:
    """Evaluate what the text names, if its variable exists where the text stands; return the problem, if any."""
    name, path = example.parsed
    if name not in example.namespace:
        return None
    try:
        eval(name + path, example.namespace)  # noqa: S307  the text of our own page
    except Exception as error:  # noqa: BLE001  whatever a wrong name raises
        return f"{name}{path}: {error!r}"
    return None


def _pages(patterns: Sequence[str], excludes: Sequence[str] = (), fixtures: Sequence[str] = ()) -> Sybil:
    return Sybil(
        parsers=[
            PythonCodeBlockParser(doctest_optionflags=ELLIPSIS | NORMALIZE_WHITESPACE),
            SkipParser(),
            _named_values,
        ],
        patterns=patterns,
        excludes=["docs/_build/*", *excludes],
        setup=_enter_folder,
        teardown=_leave_folder,
        fixtures=fixtures,
    )


_OF_MINUTES = ("docs/how-to/bifurcation-studies.md", "docs/results/earthquakes.md")
"""Pages whose programs take a minute and more: they run with the slow tests."""

_OF_SECONDS = tuple(
    f"docs/how-to/{name}.md"
    for name in (
        "assess",
        "calibrate",
        "casks",
        "conveyors",
        "did-it-survive",
        "fragility",
        "kitchen-experiments",
        "orbits",
        "square-bases",
    )
)
"""Pages whose programs take five seconds and more: they run with the long tests."""


_OF_A_BROWSER = {"browser", "written"}
"""Fixtures that start the browser of the system, or write the files that a browser is shown."""


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark the programs of some pages as slow or long, and tests in a browser, before such tests are left out."""
    for item in items:
        page = item.path.as_posix() if item.path.is_relative_to(item.config.rootpath) else ""
        if page.endswith(_OF_MINUTES):
            item.add_marker(pytest.mark.slow)
        if page.endswith(_OF_SECONDS):
            item.add_marker(pytest.mark.long)
        if _OF_A_BROWSER.intersection(getattr(item, "fixturenames", ())):
            item.add_marker(pytest.mark.system)


_OF_THE_LABORATORY = "docs/reference/http-api.md"

PAGES = _pages(["README.md", "docs/*.md", "docs/*/*.md", "docs/*/*/*.md"], excludes=[_OF_THE_LABORATORY])
"""All pages but one; `tools/printed_digits.py` runs their examples in other ways."""

pytest_collect_file = (PAGES + _pages([_OF_THE_LABORATORY], fixtures=["laboratory", "token"])).pytest()
