"""Draw small faults in a room of the package and list those that the tests miss: `python tools/mutants.py earthquakes`.

A mutant is the package with one change of `tools/mutations.py`. A failing test kills it. A mutant that survives is
either equivalent (no input shows the change) or lacks a test: write the law that it breaks, and try its line again with
`python tools/mutants.py earthquakes/incremental.py:340 --tests tests/earthquakes/test_incremental.py`.

Tools that plant all mutants of a function behind a switch do not fit here. Kernels are compiled from the source text of
functions, so the switch itself would be compiled, or refused. Here each mutant is a text of its own, in a copy of the
tree under `.mutants` with its own cache of compiled kernels. The working tree is only read.

The tests of a room run once under coverage. A mutant gets the tests that reach its line, then the other tests of their
files, the shortest first. Coverage does not see lines that run as compiled code alone; their mutants get the tests
whose files name the module or the function most often. The sample depends on the seed and the source only.
"""

import argparse
import hashlib
import json
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import time
import xml.etree.ElementTree as ET
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import coverage
from mutations import Mutant, mutants_of

ROOT = Path(__file__).parents[1]
SOURCE = Path("src/stylobate")
# Tests of the rooms whose tests are not in the folder of the same name alone.
TESTS = {
    "earthquakes": (
        "tests/earthquakes",
        *(f"tests/cli/test_{one}_command.py" for one in ("assess", "fragility", "spectrum")),
    ),
    "models": ("tests/models", "tests/engine"),
    "engine/kernel/driver": ("tests/engine", "tests/models"),
    "compiler": ("tests/compiler", "tests/engine/kernel", "tests/engine/ensembles/test_own_models.py"),
}
_MARGIN = 120.0  # seconds that a mutant may take beyond three times its tests: each kernel is compiled again


# Copy of the tree, and the tests that reach a line


class Tree:
    """A copy of the tree in which mutants are tested, with the tests that reach each line of a room."""

    def __init__(self, room: str, tests: Sequence[str], workers: int) -> None:
        self.tests = tests or next(
            (beside for name, beside in TESTS.items() if room.startswith(name)), (f"tests/{room.partition('/')[0]}",)
        )
        digest = hashlib.sha256(repr(tests).encode()).hexdigest()[:8] if tests else ""
        self.folder = ROOT / ".mutants" / f"{room.replace('/', '-')}{digest}"
        self.room, self.cache = self.folder / SOURCE / room, self.folder / "cache"
        self.reached = self._prepare(workers)
        self._kept = {path for path in self.cache.rglob("*") if path.is_file()}

    def mutants(self, line: int | None) -> list[Mutant]:
        """Return all mutants of the room, or those of one line of a file, in the order of the source."""
        files = [self.room] if self.room.is_file() else self.room.rglob("*.py")
        found = sorted(one for file in files for one in mutants_of(file, self.folder))
        return [one for one in found if line in {None, one.line}]

    def _prepare(self, workers: int) -> dict[str, dict[str, list[str]]]:
        command = ["git", "-C", str(ROOT), "ls-files", "--cached", "--others", "--exclude-standard", "-z"]
        names = subprocess.run(command, check=True, capture_output=True, text=True).stdout.split("\0")
        texts = {name: (ROOT / name).read_bytes() for name in names if (ROOT / name).is_file()}
        digest = hashlib.sha256(repr(sorted(texts.items())).encode()).hexdigest()
        record = self.folder / "reached.json"
        if record.is_file() and (known := json.loads(record.read_text()))["digest"] == digest:
            self.seconds = known["seconds"]
            return dict(known["reached"])
        shutil.rmtree(self.folder, ignore_errors=True)
        for name, text in texts.items():
            (self.folder / name).parent.mkdir(parents=True, exist_ok=True)
            (self.folder / name).write_bytes(text)
        self.seconds, reached = self._measure(workers)
        record.write_text(json.dumps({"digest": digest, "seconds": self.seconds, "reached": reached}))
        return reached

    def _measure(self, workers: int) -> tuple[dict[str, float], dict[str, dict[str, list[str]]]]:
        """Run the tests of the room; return the seconds of each test that passes, and the tests of each line."""
        results = self.folder / "results.xml"
        options = ["-n", str(workers), "-o", "junit_family=xunit1", f"--junitxml={results}", "--cov-context=test"]
        options += [f"--cov={self.room if self.room.is_dir() else self.room.parent}", "--cov-report="]
        self.run([*options, *self.tests], None, writes_bytecode=True)
        seconds = {
            f"{case.get('file')}::{case.get('name')}": float(case.get("time", "0"))
            for case in ET.parse(results).iter("testcase")  # noqa: S314  written a moment ago
            if len(case) == 0 and case.get("file")
        }
        data = coverage.CoverageData(str(self.folder / ".coverage"))
        data.read()
        reached = {
            str(Path(file).relative_to(self.folder)): {
                str(line): sorted({name.rpartition("|")[0] for name in contexts} & seconds.keys())
                for line, contexts in data.contexts_by_lineno(file).items()
            }
            for file in data.measured_files()
        }
        return seconds, reached

    def run(self, arguments: Sequence[str], limit: float | None, *, writes_bytecode: bool = False) -> int | None:
        """Run pytest in the copy; return its status, None if it took more than `limit` seconds."""
        environment = {name: value for name, value in os.environ.items() if not name.startswith(("PYTEST", "COV"))}
        environment |= {"PYTHONPATH": str(self.folder / "src"), "XDG_CACHE_HOME": str(self.cache)}
        if not writes_bytecode:
            environment["PYTHONDONTWRITEBYTECODE"] = "1"
        command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "--tb=no", *arguments]
        quiet = subprocess.DEVNULL
        with subprocess.Popen(
            command, cwd=self.folder, env=environment, stdout=quiet, stderr=quiet, stdin=quiet, start_new_session=True
        ) as process:
            try:
                return process.wait(limit)
            except subprocess.TimeoutExpired:
                return None
            finally:
                if process.poll() is None:
                    os.killpg(process.pid, signal.SIGKILL)

    def chosen(self, mutant: Mutant, budget: float) -> list[str]:
        """Return the tests of a mutant: at most `budget` seconds of those that reach its line, and of the others."""
        direct = set(self.reached.get(mutant.file, {}).get(str(mutant.line), ()))
        files = {one.partition("::")[0] for one in direct}
        beside = {one for one in self.seconds if one.partition("::")[0] in files} - direct
        named = self._by_name(mutant) if not direct or _is_compiled((self.folder / mutant.file).read_text()) else []
        others = [*named, *sorted(beside, key=self.seconds.__getitem__)]
        ordered = sorted(direct, key=self.seconds.__getitem__)
        return list(dict.fromkeys([*self._within(budget, ordered), *self._within(budget, others)]))

    def _within(self, budget: float, tests: Sequence[str]) -> list[str]:
        """Return the first tests that take `budget` seconds together; those that would exceed it are left out."""
        chosen, spent = [], 0.0
        for one in tests:
            if spent + self.seconds[one] <= budget:
                chosen.append(one)
                spent += self.seconds[one]
        return chosen or list(tests[:1])

    def _by_name(self, mutant: Mutant) -> list[str]:
        words = re.findall(r"[a-z]{4,}", f"{Path(mutant.file).stem} {mutant.function}")
        counts: Counter[str] = Counter()
        for file in {one.partition("::")[0] for one in self.seconds}:
            text = file + (self.folder / file).read_text()
            exact = re.findall(rf"\b(?:{Path(mutant.file).stem}|{mutant.function or 'import'})\b", text)
            counts[file] = 10 * len(exact) + sum(min(text.count(word), 5) for word in words)
        return sorted(self.seconds, key=lambda one: (-counts[one.partition("::")[0]], self.seconds[one]))

    def passes_unchanged(self, mutant: Mutant, budget: float) -> bool:
        """Return whether the tests of a mutant pass without it."""
        original = (self.folder / mutant.file).read_bytes()[mutant.start : mutant.end].decode()
        return self.outcome(replace(mutant, text=original), self.chosen(mutant, budget)) == "survived"

    def outcome(self, mutant: Mutant, tests: Sequence[str]) -> str:
        """Return "killed", "survived" or "timeout"."""
        path = self.folder / mutant.file
        source, times = path.read_bytes(), path.stat()
        listed = self.folder / "tests.txt"
        listed.write_text("\n".join(tests))
        path.write_text(mutant.of(source.decode()))
        try:
            limit = _MARGIN + 3.0 * sum(self.seconds[one] for one in tests)
            status = self.run(["-x", "-n", "0", "--no-cov", f"@{listed}"], limit)
        finally:
            path.write_bytes(source)
            os.utime(path, ns=(times.st_atime_ns, times.st_mtime_ns))  # bytecode of the original is valid again
            for made in self.cache.rglob("*"):
                if made.is_file() and made not in self._kept:
                    made.unlink()
        return "timeout" if status is None else "survived" if status == 0 else "killed"


def _is_compiled(text: str) -> bool:
    return re.search(r"^@(?:fast|scalar)", text, re.MULTILINE) is not None or "/kernel/" in text


def drawn(found: Sequence[Mutant], seed: int) -> list[Mutant]:
    """Return the mutants in the order in which they are tested."""
    sample = list(found)
    random.Random(seed).shuffle(sample)  # noqa: S311
    return sample


def main() -> int:
    """Test a sample of the mutants of a room, and print those that survive."""
    parser = argparse.ArgumentParser(description="List small faults in a room that the tests miss.")
    parser.add_argument(
        "room", help="folder or file of the package, such as earthquakes or engine/history.py, or file:line"
    )
    parser.add_argument("--count", type=int, default=50, help="number of mutants (default: 50)")
    parser.add_argument("--first", type=int, default=0, help="number of mutants of the sample to skip (default: 0)")
    parser.add_argument("--seed", type=int, default=1, help="seed of the sample (default: 1)")
    parser.add_argument("--budget", type=float, default=60.0, help="seconds of tests for each mutant (default: 60)")
    parser.add_argument("--workers", type=int, default=2, help="processes that measure the tests once (default: 2)")
    parser.add_argument("--tests", nargs="+", default=(), help="files of tests (default: those of the room)")
    given = parser.parse_args()
    room, _, line = given.room.strip("/").partition(":")
    if not (ROOT / SOURCE / room).exists():
        parser.error(f"room: no folder or file of the package (got {room!r}). Name one below {SOURCE}.")
    tree = Tree(room, given.tests, given.workers)
    found = tree.mutants(int(line) if line else None)
    sample = drawn(found, given.seed)[given.first : given.first + given.count]
    print(f"{given.room}: {len(sample)} of {len(found)} mutants, {len(tree.seconds)} tests", flush=True)
    if not tree.seconds or not tree.passes_unchanged(sample[0], given.budget):
        parser.error(f"tests: without a mutant no test of {given.room} passes. Repair them first.")
    outcomes: Counter[str] = Counter()
    for number, mutant in enumerate(sample, given.first + 1):
        started = time.monotonic()
        tests = tree.chosen(mutant, given.budget)
        outcome = tree.outcome(mutant, tests)
        outcomes[outcome] += 1
        elapsed = time.monotonic() - started
        print(f"{number:4} {outcome:8} {elapsed:5.0f} s  {len(tests):3} tests  {mutant.file}:{mutant.line}", flush=True)
        print(
            mutant.diff((tree.folder / mutant.file).read_text()) + "\n" if outcome == "survived" else "",
            end="",
            flush=True,
        )
    print(", ".join(f"{count} {outcome}" for outcome, count in sorted(outcomes.items())))
    return 0


if __name__ == "__main__":
    sys.exit(main())
