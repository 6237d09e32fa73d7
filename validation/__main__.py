"""Compute all comparisons, write their tables and the document for a reviewer: `python -m validation [name ...]`."""

import argparse
import importlib
import time
from pathlib import Path

from . import document
from .finding import FOLDER, table

PARTS = (
    *("problems", "frozen", "round_bodies", "practice", "engines", "opensees", "hybrid_orbit", "shake_table"),
    *("cylinders", "intensities", "objects"),
)
"""Modules of this folder; each has a function `findings`."""


def main() -> None:
    """Compute the chosen comparisons."""
    parser = argparse.ArgumentParser(prog="python -m validation", description=__doc__)
    parser.add_argument("parts", nargs="*", choices=[[], *PARTS], help="which comparisons; all by default")
    parser.add_argument("--document", type=Path, default=Path("validation-report.html"), help="document for a reviewer")
    arguments = parser.parse_args()
    computed = []
    for name in arguments.parts or PARTS:
        begun = time.perf_counter()
        found = list(importlib.import_module(f"validation.{name}").findings())
        if found:
            computed.append(name)
            (FOLDER / f"{name}.txt").write_text(table(found), encoding="utf-8")
        judged = [one for one in found if one.judged]
        agree = sum(one.agrees for one in judged)
        took = time.perf_counter() - begun
        print(f"{name}: {agree} of {len(judged)} agree, {len(found) - len(judged)} without a bound, {took:.0f} s")
    print(f"wrote {document.write(arguments.document, FOLDER, computed)}")


if __name__ == "__main__":
    main()
