"""Draws the figures of the page "Assess columns under records and write a report" into docs/_static/assess.

Run it with `python docs/figures/assess.py`; it runs the study examples/assess/study.toml, some minutes on one core.
"""

import sys
import tempfile
import textwrap
from io import BytesIO
from pathlib import Path

from matplotlib.figure import Figure
from matplotlib.image import imread
from saving import save

import stylobate as sb
from stylobate.earthquakes.assessment.report.document import summary_text, verdict_table
from stylobate.earthquakes.assessment.report.figures import (
    margins_figure,
    shares_figure,
    spectra_figure,
)
from stylobate.results import Assessment

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "docs" / "_static" / "assess"
STUDY = ROOT / "examples" / "assess" / "study.toml"
_LINE = 122  # characters
_FONT = 8.0  # points


def assessed(store: Path) -> Assessment:
    """Return the assessment of the example."""
    setup = sb.earthquakes.AssessConfig.parse(sb.config.read_config(STUDY)).build()
    return sb.earthquakes.assess(
        setup.columns, setup.records, **setup.options, store=store
    )


def head(found: Assessment, spectra: Figure) -> Figure:
    """Draw the first page of the report: title, verdicts, findings, spectra; the page itself needs a browser."""
    title, *lines = summary_text(found, [verdict_table(found)]).splitlines()
    text = "\n".join(textwrap.fill(line, _LINE) for line in lines)
    height = (text.count("\n") + 2) * 1.35 * _FONT / 72  # inches
    figure = Figure(figsize=(7.4, height + 0.6 + 3.2))
    words, below = figure.subplots(2, 1, height_ratios=(height, 3.2))
    for axes in (words, below):
        axes.set_axis_off()
    words.text(0.0, 1.02, title, fontsize=14, fontweight="bold", va="bottom")
    words.text(0.0, 1.0, text, fontsize=_FONT, va="top", linespacing=1.35)
    buffer = BytesIO()
    spectra.savefig(buffer, format="png", dpi=300)
    buffer.seek(0)
    below.imshow(imread(buffer))
    figure.subplots_adjust(left=0.03, right=0.98, top=0.95, bottom=0.01, hspace=0.0)
    return figure


def main(store: Path) -> None:
    """Draw all of them."""
    found = assessed(store)
    margins = margins_figure(found, "slim column")
    save(head(found, spectra_figure(found)), FOLDER / "report.png")
    save(margins, FOLDER / "margins.png")
    save(shares_figure(found, "slim column", 1.0), FOLDER / "variations.png")


if __name__ == "__main__":
    if len(sys.argv) > 1:
        main(Path(sys.argv[1]))
    else:
        with tempfile.TemporaryDirectory() as folder:
            main(Path(folder))
