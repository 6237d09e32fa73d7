"""Draws the figures of the page "Assessing columns under records" into docs/_static/assess.

Run it with `python docs/figures/assess.py`; it runs the study examples/assess/study.toml, some minutes on one core.
"""

import sys
import tempfile
import textwrap
from io import BytesIO
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.image import imread

import stylobate as sb
from stylobate.plots.assessment.figures import margins_figure, robustness_figure
from stylobate.plots.assessment.summary import summary_paragraphs
from stylobate.results import Assessment

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "docs" / "_static" / "assess"
STUDY = ROOT / "examples" / "assess" / "study.toml"
SHOWN = ("column", "scale", "did not overturn it", "overturned it", "not decided", "flip under small changes")
_LINE = 108


def assessed(store: Path) -> Assessment:
    """Return the assessment of the example."""
    setup = sb.spec.AssessDescription.parse(sb.spec.read_description(STUDY)).build()
    return sb.studies.assess(setup.columns, setup.records, **setup.options, store=store)


def head(found: Assessment, margins: Figure) -> Figure:
    """Return how the report begins: title, summary, table, margins; drawn, for the page itself needs a browser."""
    figure = Figure(figsize=(7.4, 9.4))
    words, table, below = figure.subplots(3, 1, height_ratios=(4.7, 1.3, 3.4))
    for axes in (words, table, below):
        axes.set_axis_off()
    words.text(0.0, 1.02, found.setting["title"], fontsize=14, fontweight="bold", va="bottom")
    text = "\n\n".join(textwrap.fill(paragraph, _LINE) for paragraph in summary_paragraphs(found))
    words.text(0.0, 0.98, text, fontsize=8.4, va="top", linespacing=1.35)
    table.text(0.0, 1.0, "Verdicts in short", fontsize=11, fontweight="bold", va="bottom")
    _table(table, found)
    buffer = BytesIO()
    margins.savefig(buffer, format="png", dpi=180)
    buffer.seek(0)
    below.text(
        0.0, 1.0, "Margin and governing record", fontsize=11, fontweight="bold", va="bottom", transform=below.transAxes
    )
    inner = below.inset_axes((0.0, 0.0, 1.0, 0.97))
    inner.imshow(imread(buffer))
    inner.set_axis_off()
    figure.subplots_adjust(left=0.03, right=0.98, top=0.94, bottom=0.01, hspace=0.14)
    return figure


def _table(axes: Axes, found: Assessment) -> None:
    told = sb.plots.assessment_tables(found)["summary"]
    places = [list(told.header).index(name) for name in SHOWN]
    rows = [[row[place] for place in places] for row in told.rows]
    drawn = axes.table(rows, colLabels=list(SHOWN), bbox=(0.0, 0.0, 1.0, 0.95), edges="horizontal", cellLoc="left")
    drawn.auto_set_font_size(False)
    drawn.set_fontsize(7.4)
    drawn.auto_set_column_width(list(range(len(SHOWN))))


def main(store: Path) -> None:
    """Draw all of them."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    found = assessed(store)
    margins = margins_figure(found, "slim column")
    head(found, margins).savefig(FOLDER / "report.png", dpi=130)
    margins.savefig(FOLDER / "margins.png", dpi=180)
    robustness_figure(found, "slim column", 1.0).savefig(FOLDER / "robustness.png", dpi=180)


if __name__ == "__main__":
    if len(sys.argv) > 1:
        main(Path(sys.argv[1]))
    else:
        with tempfile.TemporaryDirectory() as folder:
            main(Path(folder))
