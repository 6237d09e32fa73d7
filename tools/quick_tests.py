"""Run the tests next to what has changed, for a minute: `python tools/quick_tests.py [--seconds 60] [room …]`.

Changed are the files that differ from the branch `origin/main`, or from the last commit where there is no such branch,
and the files that git does not know yet. A room, such as `earthquakes`, stands for all of its files. The tests of a
file are those of its room in `tests`, those that mention the file's name first; a page of the documentation and a file
of tests are tests themselves. No test starts after the time: the rest is counted, and `make test` runs it.
"""

import argparse
import subprocess
import sys
import time
from collections.abc import Iterable, Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
SOURCE, TESTS = Path("src/stylobate"), Path("tests")
ALWAYS = ("test_documented.py", "test_public_face.py", "test_declared_once.py", "test_no_circles.py")
"""Tests of the whole package that a change of any file can break."""


def changed_files(root: Path = ROOT) -> list[Path]:
    """Return the paths, relative to the root, of files that differ from the main branch or are not known to git."""

    def lines(*command: str) -> list[str]:
        return subprocess.run(("git", *command), cwd=root, capture_output=True, text=True, check=False).stdout.split(
            "\n"
        )

    base = next(filter(None, lines("merge-base", "HEAD", "origin/main")), "HEAD")
    names = {*lines("diff", "--name-only", base), *lines("ls-files", "--others", "--exclude-standard")} - {""}
    return sorted(path for path in map(Path, names) if (root / path).is_file())


def neighbours(changed: Iterable[Path], root: Path = ROOT) -> list[Path]:
    """Return the files of tests next to the changed files, those that mention a changed name first."""
    own, near, far = [], [], []
    for path in changed:
        if path.name.startswith("test_") or (path.suffix == ".md" and path.parts[0] in ("docs", "README.md")):
            own.append(path)
        elif path.suffix == ".py" and path.is_relative_to(SOURCE):
            room, stem = path.relative_to(SOURCE).parts[0], path.parent.name if path.stem == "__init__" else path.stem
            for test in _tests_in_room(room.removesuffix(".py"), root):
                (near if stem in test.name + (root / test).read_text(encoding="utf-8") else far).append(test)
    always = (TESTS / name for name in ALWAYS)
    return [path for path in dict.fromkeys((*own, *near, *always, *far)) if (root / path).is_file()]


def _tests_in_room(room: str, root: Path) -> Iterator[Path]:
    for pattern in (f"{room}/**/test_*.py", f"test_{room}*.py"):
        yield from sorted(path.relative_to(root) for path in (root / TESTS).glob(pattern))


class Deadline:
    """A plugin of pytest, in each process, that skips tests after a time."""

    def __init__(self, seconds: float) -> None:
        self.end = time.monotonic() + seconds

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtest_setup(self) -> None:
        """Skip a test that would start too late."""
        if time.monotonic() > self.end:
            pytest.skip("not started: the time is over, make test runs it")


def pytest_addoption(parser: pytest.Parser) -> None:
    """Declare the time, which processes that test side by side receive too."""
    parser.addoption("--seconds", type=float, default=60.0, help="no test starts after this time")


def pytest_configure(config: pytest.Config) -> None:
    """Count the time from here."""
    config.pluginmanager.register(Deadline(config.getoption("--seconds")))


def main(arguments: list[str]) -> int:
    """Run the tests and return the exit status of pytest."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("rooms", nargs="*", metavar="room", help="rooms whose files all count as changed")
    parser.add_argument("--seconds", type=float, default=60.0, help="no test starts after this time (default: 60)")
    asked = parser.parse_args(arguments)
    changed = [path.relative_to(ROOT) for room in asked.rooms for path in (ROOT / SOURCE / room).rglob("*.py")]
    tests = neighbours(changed or changed_files())
    command = (sys.executable, "-m", "pytest", "-n", "auto", "-p", "tools.quick_tests", f"--seconds={asked.seconds}")
    return subprocess.run((*command, *map(str, tests)), cwd=ROOT, check=False).returncode


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
