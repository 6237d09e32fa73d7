"""Compute all comparisons and write their tables: `python -m validation [name ...]`, `make validation`."""

import argparse
import importlib
import time
from pathlib import Path

from .finding import table

_FOLDER = Path(__file__).parents[1] / "docs" / "_static" / "validation"
PARTS = ("frozen", "practice", "engines", "shake_table", "round_bodies")
"""Modules of this folder; each has a function `findings`."""


def main() -> None:
    """Compute the chosen comparisons."""
    parser = argparse.ArgumentParser(prog="python -m validation", description=__doc__)
    parser.add_argument("parts", nargs="*", choices=[[], *PARTS], help="which comparisons; all by default")
    parser.add_argument("--into", type=Path, default=_FOLDER, help="folder for the tables")
    arguments = parser.parse_args()
    arguments.into.mkdir(parents=True, exist_ok=True)
    for name in arguments.parts or PARTS:
        begun = time.perf_counter()
        found = list(importlib.import_module(f"validation.{name}").findings())
        (arguments.into / f"{name}.txt").write_text(table(found), encoding="utf-8")
        judged = [one for one in found if one.judged]
        agree = sum(one.agrees for one in judged)
        others = len(found) - len(judged)
        took = time.perf_counter() - begun
        print(f"{name}: {agree} of {len(judged)} agree, {others} without a bound, {took:.0f} s")


if __name__ == "__main__":
    main()
