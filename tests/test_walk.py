"""The walk through the code leads where the page says: the command passes each stop, in this order."""

import ast
import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

SOURCE = Path(__file__).parents[1] / "src" / "stylobate"
PAGE = Path(__file__).parents[1] / "docs" / "about" / "walk.md"

# Records the first call of each function of the package, in plain Python.
SCRIPT = """
import json, sys, threading
from stylobate.cli.main import run

passed = {}

def note(frame, event, argument):
    place = frame.f_code.co_filename.replace("\\\\", "/").rpartition("/stylobate/")[2]
    if event == "call":
        passed.setdefault((place, frame.f_code.co_qualname), len(passed))

threading.setprofile(note)
sys.setprofile(note)
status = run(sys.argv[1:])
sys.setprofile(None)
print(json.dumps([status, list(passed)]))
"""


def stops():
    rows = re.findall(r"^\| \d+ \| `([^`]+)` \| `([^`]+)` \|", PAGE.read_text(encoding="utf-8"), flags=re.MULTILINE)
    return [tuple(row) for row in rows]


def command(figure):
    line = re.search(r"\$ stylobate (.*?)```", PAGE.read_text(encoding="utf-8"), flags=re.DOTALL)[1]
    words = line.replace("\\\n", " ").split()
    return [figure if word == "map.png" else word for word in words]


def test_the_page_has_ten_stops_and_each_is_a_function_of_its_file():
    assert len(stops()) == 10
    for file, name in stops():
        tree = ast.parse((SOURCE / file).read_text(encoding="utf-8"))
        for part in name.split("."):
            (tree,) = (one for one in tree.body if getattr(one, "name", None) == part)


@pytest.mark.slow  # a map by plain Python
def test_a_map_passes_the_ten_stops_in_their_order(tmp_path):
    figure = tmp_path / "map.png"
    ended = subprocess.run(
        [sys.executable, "-c", SCRIPT, *command(str(figure))],
        capture_output=True,
        text=True,
        check=True,
        env={**os.environ, "STYLOBATE_PLAIN": "1"},
    )
    status, passed = json.loads(ended.stdout.splitlines()[-1])
    order = {tuple(one): place for place, one in enumerate(passed)}
    assert status == 0
    assert figure.stat().st_size > 0
    assert [stop for stop in stops() if stop not in order] == []
    assert sorted(stops(), key=order.get) == stops()
