"""Draws the figures that pages make with their own code: runs each page's Python blocks and keeps what they save.

Run it with `python docs/figures/from_pages.py [PAGE …]`, such as `getting-started/first-steps`; it takes a minute.
"""

import os
import re
import sys
import tempfile
from pathlib import Path

import matplotlib as mpl
from PIL import Image

DOCS = Path(__file__).parents[1].resolve()
PAGES = (
    "getting-started/first-steps",
    "how-to/choose-damping",
    "how-to/fragility",
    "how-to/inventory",
    "how-to/kitchen-experiments",
    "how-to/sliding-limits",
    "how-to/square-bases",
    "how-to/tanks",
)
_BLOCK = re.compile(
    r"(% skip: next\n\n)?^```python\n(.*?)^```$", re.DOTALL | re.MULTILINE
)


def shown(page: str, text: str) -> set[str]:
    """Return the names of the pictures that the page shows from its own folder."""
    return set(re.findall(rf"_static/{Path(page).name}/([\w-]+\.png)", text))


def draw(page: str) -> None:
    """Run the code of one page and keep each figure that it saves and shows."""
    text = (DOCS / f"{page}.md").read_text(encoding="utf-8")
    kept = DOCS / "_static" / Path(page).name
    kept.mkdir(parents=True, exist_ok=True)
    names, namespace = shown(page, text), {}
    for skipped, code in _BLOCK.findall(text):
        if not skipped and not code.startswith(">>>"):
            exec(compile(code, f"{page}.md", "exec"), namespace)  # noqa: S102  the code of our own page
    for name in sorted(names):
        picture = (
            Image.open(name).convert("RGB").quantize(256, dither=Image.Dither.NONE)
        )
        picture.save(kept / name, optimize=True)
        print(f"{page}: {name}, {picture.width} x {picture.height}")


if __name__ == "__main__":
    mpl.rcParams["savefig.dpi"] = 200
    for page in sys.argv[1:] or PAGES:
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            draw(page)
