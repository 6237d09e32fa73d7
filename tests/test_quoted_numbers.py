"""Pages quote measured numbers as their sources state them."""

import importlib.util
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
DOCS = ROOT / "docs"

if not (DOCS / "results").is_dir():
    pytest.skip("the documentation is not here", allow_module_level=True)

BENCHMARKS = (DOCS / "results" / "benchmarks.md").read_text("utf-8")
VERIFICATION = (DOCS / "results" / "validation.md").read_text("utf-8")
CLOSED_FORMS = (DOCS / "results" / "validation-closed-forms.md").read_text("utf-8")
ACCURACY = (DOCS / "explanation" / "numerics.md").read_text("utf-8")
NUMBER = re.compile(r"(?<![\w.])\d{1,3}(?: \d{3})+(?!\d)|(?<![\w.])\d+(?:\.\d+)?(?:e-?\d+)?")


@pytest.fixture(scope="module")
def page():
    """The program that puts measured tables into the page of the benchmarks."""
    spec = importlib.util.spec_from_file_location("page", ROOT / "benchmarks" / "page.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def numbers(text):
    """Return the numbers of a text; digits may stand in groups of three."""
    return set(NUMBER.findall(re.sub(r"\s+", " ", text)))


def section(text, title):
    """Return a section of a page, without addresses of links."""
    return re.sub(r"\]\([^)]*\)", "]", text.partition(f"\n## {title}\n")[2].partition("\n## ")[0])


def test_the_page_of_benchmarks_shows_each_table_as_it_was_measured(page):
    assert page.with_tables(BENCHMARKS) == BENCHMARKS
    assert sorted(page.names(BENCHMARKS)) == sorted(path.stem for path in page.TABLES.glob("*.txt"))


@pytest.mark.parametrize("name", ["README.md", "docs/index.md"])
def test_the_front_pages_quote_speed_and_accuracy_as_they_were_measured(name):
    quoted = section((ROOT / name).read_text("utf-8"), "How accurate, how fast")
    accuracy, _, speed = quoted.partition("\n- One simulation")
    assert numbers(accuracy)
    assert numbers(accuracy) <= numbers(section(VERIFICATION, "Error of a run"))
    assert numbers(speed)
    assert numbers(speed) <= numbers(BENCHMARKS)


def test_the_errors_of_runs_are_those_of_the_table_of_accuracy():
    rows = re.findall(r"\d\.\de-\d+", section(VERIFICATION, "Error of a run"))
    assert rows
    assert set(rows) <= set(re.findall(r"\d\.\de-\d+", section(ACCURACY, "Accuracy")))


def test_the_page_of_validation_quotes_the_frozen_scan_as_it_was_computed():
    quoted = section(CLOSED_FORMS, "Numbers frozen by others")
    computed = (DOCS / "_static" / "validation" / "frozen.txt").read_text("utf-8")
    assert {number.replace(" ", "") for number in numbers(quoted)} == {"2505", "13"}
    assert {"2505", "13"} <= numbers(computed)
