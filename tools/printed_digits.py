"""Run the examples of README and documentation in other ways, and report each printed line that changes.

    python tools/printed_digits.py [PAGE ...] [--ways default tenth moved no-fma] [--processes 2]

A page prints what any machine and any finer tolerance print. The ways are:

default
    As the tests run the pages.
tenth
    With a tenth of the relative tolerance of every run.
moved
    With initial conditions and slendernesses larger by 1e-12 of themselves; a changed slenderness moves columns that
    start at rest.
no-fma
    With code for a processor that does not fuse products with sums, `STYLOBATE_CPU=x86-64-v2`.

Each page runs in a process of its own in each way. Runs in further processes are those of the way "default". Periodic
orbits keep their tolerance, which is close to rounding.

Compared are the results of doctests, the output of a block that a block of text follows, and blocks that raise. Lines
of the page that quote a changed number are listed with it. The exit status is 1 if something changed.
"""

import argparse
import contextlib
import doctest
import io
import json
import os
import re
import subprocess
import sys
import time
import traceback
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import Any
from unittest import SkipTest

ROOT = Path(__file__).parents[1]
WAYS = ("default", "tenth", "moved", "no-fma")
FINER = 0.1
MOVED = 1.0 + 1e-12
LIMIT = 1800.0
"""Maximum duration of a page [s]."""

SHOWN = re.compile(r"\n\n```text\n(.*?)```\n", re.DOTALL)
"""End of a block of code, and a block of text that shows what the code prints."""

NUMBER = re.compile(r"\d[\d.]*(?:e[-+]?\d+)?")


def pages() -> list[str]:
    """Return the pages with examples, relative to the root."""
    found = [ROOT / "README.md", *sorted((ROOT / "docs").glob("**/*.md"))]
    named = [path.relative_to(ROOT).as_posix() for path in found if "```python" in path.read_text("utf-8")]
    # The page of the HTTP interface needs a server; its answers are those of other pages.
    return [name for name in named if not name.startswith("docs/_build") and name != "docs/reference/http-api.md"]


def change_runs(way: str) -> None:
    """Change all runs of this process."""
    from stylobate.engine.ensembles import batch

    made = batch.Batch.of.__func__  # type: ignore[attr-defined]

    def finer(cls: Any, plan: Any, runs: Any) -> Any:
        options = {**plan.options, "rtol": max(FINER * plan.options["rtol"], 1e-13)}
        # Results state the tolerance that was asked for, and repeat themselves by it.
        return replace(made(cls, replace(plan, options=options), runs), plan=plan)

    def moved(cls: Any, plan: Any, runs: Any) -> Any:
        found = made(cls, plan, replace(runs, tilt=runs.tilt * MOVED, tilt_rate=runs.tilt_rate * MOVED))
        found.table[:, plan.layout.parameters_at] *= MOVED
        return found

    if way in ("tenth", "moved"):
        batch.Batch.of = classmethod(finer if way == "tenth" else moved)  # type: ignore[assignment,method-assign]


def changed_lines(page: str, way: str) -> list[dict[str, Any]]:
    """Run the examples of a page; return the line, the printed text and the new one of each that changes."""
    from sybil.evaluators.doctest import OutputChecker

    sys.path[:0] = [str(ROOT)]
    from conftest import PAGES

    change_runs(way)
    found: list[dict[str, Any]] = []
    line, compared = 0, OutputChecker.check_output
    flags_of_text = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE

    def check(checker: OutputChecker, want: str, got: str, flags: int) -> bool:
        if not compared(checker, want, got, flags):
            found.append({"line": line, "printed": want, "got": got})
        return True

    OutputChecker.check_output = check  # type: ignore[method-assign]
    document = PAGES.parse(ROOT / page)
    PAGES.setup(document.namespace)
    try:
        for example in document.examples():
            line = example.line
            try:
                with contextlib.redirect_stdout(io.StringIO()) as output:
                    example.evaluate()
            except SkipTest:
                continue
            except Exception as error:  # noqa: BLE001  the examples after it may hold
                found.append({"line": line, "printed": "", "got": traceback.format_exception_only(error)[-1]})
            shown = SHOWN.match(document.text, example.region.end)
            if shown and output.getvalue():
                check(OutputChecker(), shown[1], output.getvalue(), flags_of_text)
    finally:
        PAGES.teardown(document.namespace)
    return found


def run_page(page: str, way: str) -> list[dict[str, Any]]:
    """Run a page in a process of its own."""
    environment = {**os.environ, "MPLBACKEND": "Agg"}
    if way == "no-fma":
        environment["STYLOBATE_CPU"] = "x86-64-v2"
    command = [sys.executable, __file__, "--only", page, way]
    try:
        ended = subprocess.run(
            command, env=environment, capture_output=True, text=True, timeout=LIMIT, check=False, cwd=ROOT
        )
    except subprocess.TimeoutExpired:
        return [{"line": 0, "printed": "", "got": f"no end within {LIMIT:.0f} s"}]
    if ended.returncode:
        return [{"line": 0, "printed": "", "got": ended.stderr[-300:]}]
    return list(json.loads(ended.stdout.splitlines()[-1]))


def differing(printed: str, got: str) -> Iterator[tuple[str, str]]:
    """Yield the lines that differ; all lines if their numbers differ."""
    before, after = printed.strip().splitlines(), got.strip().splitlines()
    if len(before) != len(after):
        yield printed.strip(), got.strip()
        return
    yield from ((one, other) for one, other in zip(before, after, strict=True) if one.split() != other.split())


def quoted(page: str, line: int, printed: str, got: str) -> list[int]:
    """Return the other lines of a page that have a changed number with at least two digits."""
    changed = set(NUMBER.findall(printed)) - set(NUMBER.findall(got))
    sought = {number.rstrip(".") for number in changed if sum(map(str.isdigit, number)) > 1}
    text = (ROOT / page).read_text("utf-8").splitlines()
    near = range(line, line + 20)
    return [
        k
        for k, one in enumerate(text, start=1)
        if k not in near and sought & {number.rstrip(".") for number in NUMBER.findall(one)}
    ]


def report(page: str, way: str, changes: Sequence[dict[str, Any]]) -> None:
    """Print the changes of a page."""
    for change in changes:
        for printed, got in differing(change["printed"], change["got"]):
            print(f"{page}:{change['line']}  [{way}]\n    printed {printed}\n    got     {got}")
            if others := quoted(page, change["line"], printed, got):
                print(f"    quoted  in lines {', '.join(map(str, others))}")
    sys.stdout.flush()


def main() -> int:
    """Run the pages that the command line names, and return the exit status."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0] if __doc__ else None)
    parser.add_argument("pages", nargs="*", metavar="PAGE", help="pages, or parts of their names; all by default")
    parser.add_argument("--ways", nargs="+", choices=WAYS, default=WAYS, help="ways to run them; all by default")
    parser.add_argument("--processes", type=int, default=2, help="pages that run at the same time")
    parser.add_argument("--only", nargs=2, metavar=("PAGE", "WAY"), help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.only:
        with contextlib.redirect_stdout(io.StringIO()):
            found = changed_lines(*options.only)
        print(json.dumps(found))
        return 0
    chosen = [one for one in pages() if not options.pages or any(part in one for part in options.pages)]
    work = [(page, way) for page in chosen for way in options.ways]
    changed: dict[str, int] = dict.fromkeys(options.ways, 0)
    begun = time.monotonic()
    with ThreadPoolExecutor(options.processes) as pool:
        for k, ((page, way), changes) in enumerate(zip(work, pool.map(lambda one: run_page(*one), work), strict=True)):
            report(page, way, changes)
            changed[way] += len(changes)
            print(f"{k + 1}/{len(work)}  {time.monotonic() - begun:.0f} s  {page} {way}", file=sys.stderr)
    counts = ", ".join(f"{way} {count}" for way, count in changed.items())
    print(f"{len(chosen)} pages; examples that changed: {counts}")
    return int(any(changed.values()))


if __name__ == "__main__":
    sys.exit(main())
