"""The tool that runs the tests next to a change: which tests it takes, and when it stops."""

import importlib.util
from pathlib import Path

import pytest

TOOL = Path(__file__).parents[1] / "tools" / "quick_tests.py"


@pytest.fixture(scope="module")
def tool():
    spec = importlib.util.spec_from_file_location("quick_tests", TOOL)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def tree(tmp_path):
    for name, text in {
        "tests/models/test_other.py": "from stylobate.models import other",
        "tests/models/test_slender.py": "from stylobate.models import slender",
        "tests/test_column.py": "",
        "tests/test_public_face.py": "",
        "docs/how-to/maps.md": "",
    }.items():
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    return tmp_path


@pytest.mark.parametrize(
    ("changed", "tests"),
    [
        (
            "src/stylobate/models/slender.py",
            ["tests/models/test_slender.py", "tests/test_public_face.py", "tests/models/test_other.py"],
        ),
        ("src/stylobate/column.py", ["tests/test_column.py", "tests/test_public_face.py"]),
        ("tests/models/test_other.py", ["tests/models/test_other.py", "tests/test_public_face.py"]),
        ("docs/how-to/maps.md", ["docs/how-to/maps.md", "tests/test_public_face.py"]),
        ("docs/how-to/deleted.md", ["tests/test_public_face.py"]),
    ],
)
def test_a_file_has_the_tests_of_its_room_and_those_that_mention_it_first(tool, tree, changed, tests):
    assert tool.neighbours([Path(changed)], tree) == [Path(test) for test in tests]


def test_no_test_starts_after_the_time(tool):
    tool.Deadline(60.0).pytest_runtest_setup()
    with pytest.raises(pytest.skip.Exception, match="the time is over"):
        tool.Deadline(-1.0).pytest_runtest_setup()
