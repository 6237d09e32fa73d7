"""Draws the figures of the page "The source paper checked" into docs/_static/paper.

Run it with `python docs/figures/paper.py`; it runs the whole check, some minutes on one core. They are those of the
report that `stylobate paper` writes.
"""

import shutil
import tempfile
from pathlib import Path

from saving import STATIC

import stylobate as sb

FOLDER = STATIC / "paper"
SHOWN = (
    "averaging-in-time",
    "figure-2-circular",
    "figure-2-straight",
    "figure-3-circular",
    "free-twist",
    "free-twist-boundary",
    "modulated-rolling",
    "runaway-azimuth",
    "stability-boundary",
)

if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        sb.paper.paper_report(sb.paper.check_paper(), folder)
        for name in SHOWN:
            shutil.copy(Path(folder) / f"{name}.png", FOLDER / f"{name}.png")
            print(f"paper/{name}.png")
