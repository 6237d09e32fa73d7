"""Draws the figures of the page "Assess columns under records and write a report" into docs/_static/assess.

Run it with `python docs/figures/assess.py`; it runs the study examples/assess/study.toml, some minutes on one core.
"""

import sys
import tempfile
from pathlib import Path

from playwright.sync_api import sync_playwright
from saving import save

import stylobate as sb
from stylobate.earthquakes.assessment.report.figures import (
    margins_figure,
    shares_figure,
)
from stylobate.results import Assessment

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "docs" / "_static" / "assess"
STUDY = ROOT / "examples" / "assess" / "study.toml"
# Width of the type area of A4 and margin of the picture [CSS pixels]; points per CSS pixel of the picture.
_WIDTH, _MARGIN, _DENSITY = 680, 24, 2


def assessed(store: Path) -> Assessment:
    """Return the assessment of the example."""
    setup = sb.earthquakes.AssessConfig.parse(sb.config.read_config(STUDY)).build()
    return sb.earthquakes.assess(
        setup.columns, setup.records, **setup.options, store=store
    )


def photograph(report: Path, into: Path) -> None:
    """Draw the first page of the report as a browser prints it."""
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path="/usr/bin/chromium", args=["--no-sandbox"]
        )
        page = browser.new_page(
            viewport={"width": _WIDTH + 2 * _MARGIN, "height": 1200},
            device_scale_factor=_DENSITY,
        )
        page.goto(report.as_uri())
        page.emulate_media(media="print")
        page.add_style_tag(content=f"body {{ padding: {_MARGIN}px !important; }}")
        end = page.locator("section").first.bounding_box()
        assert end is not None
        clip = {"x": 0, "y": 0, "width": _WIDTH + 2 * _MARGIN, "height": end["y"]}
        page.screenshot(path=into, clip=clip, full_page=True)
        browser.close()


def main(store: Path) -> None:
    """Draw all of them."""
    found = assessed(store)
    report = sb.earthquakes.assessment_report(found, store / "report")
    photograph(report, FOLDER / "report.png")
    save(margins_figure(found, "slim column"), FOLDER / "margins.png")
    save(shares_figure(found, "slim column", 1.0), FOLDER / "variations.png")


if __name__ == "__main__":
    if len(sys.argv) > 1:
        main(Path(sys.argv[1]))
    else:
        with tempfile.TemporaryDirectory() as folder:
            main(Path(folder))
