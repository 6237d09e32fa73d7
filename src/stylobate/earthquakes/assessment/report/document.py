"""The report of an assessment: a page, the same as a PDF, and a file for each table and figure."""

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

from stylobate.earthquakes.assessment.report.answers import answer_table
from stylobate.earthquakes.assessment.report.column_verdict import recorded_scale
from stylobate.earthquakes.assessment.report.figures import Pictures, report_pictures
from stylobate.earthquakes.assessment.report.findings import summary_text, verdict_table
from stylobate.earthquakes.assessment.report.sections import document_table, first_page, report_sections
from stylobate.earthquakes.assessment.report.sketch import OBJECTS
from stylobate.earthquakes.assessment.report.tables import assessment_tables
from stylobate.errors import FileError, UnsupportedError
from stylobate.files import csv_text, write_whole, write_workbook
from stylobate.plots.page import PageTable, page, pdf_of, png_of, style_text
from stylobate.progress import Progress, Report, report_of, shows_progress
from stylobate.results.assessment import Assessment
from stylobate.text import printable

# Tables of a dozen columns fit a wide screen; a narrow screen scrolls tables and figures. Pages of paper have a running
# title and numbers; tables break between rows.
_STYLE = """
.wide + .wide { margin-top: 1.4rem; } nav a { display: inline-block; }
body > .wide td:nth-child(-n+2) { font-weight: 600; } ul { padding-left: 1.2rem; }
@page { size: A4; margin: 17mm 15mm 17mm;
  @top-left { content: TITLE; font: 8pt sans-serif; color: #555; overflow-wrap: anywhere; }
  @top-right { content: NAMED; font: 8pt sans-serif; color: #555; overflow-wrap: anywhere; }
  @bottom-right { content: "Page " counter(page) " of " counter(pages); font: 8pt sans-serif; color: #555; } }
@page :first { @top-left { content: none; } @top-right { content: none; } }
@media screen { body { max-width: 68rem; } .wide table { font-size: .84rem; line-height: 1.4; }
  th, td { padding: .35rem .45rem; min-width: 2.6rem; } }
@media screen and (max-width: 48rem) { .wide table { width: max-content; } .wide td { max-width: 15rem; }
  .wide th { max-width: 7rem; } figure { overflow-x: auto; } figure img { max-width: none; width: 44rem; } }
@media print { body { font-size: 9pt; line-height: 1.35; padding: 0; } h1 { font-size: 17pt; margin: 0 0 .4rem; }
  h2 { margin: 1rem 0 .3rem; font-size: 12pt; } p { margin: .35rem 0; orphans: 3; widows: 3; }
  ul { margin: .4rem 0; padding-left: 1rem; } table { font-size: 7.6pt; line-height: 1.25; }
  th, td { padding: .1rem .3rem; overflow-wrap: break-word; }
  body > figure img { max-height: 8.6cm; }
  .many table { font-size: 6.8pt; } .wide + .wide { margin-top: .6rem; } figure { margin: .5rem 0; }
  figure img { width: 100%; max-height: 10cm; object-fit: contain; } figcaption { font-size: 8pt; }
  section:first-of-type { break-before: BREAK; } }
"""


@shows_progress("figures")
def assessment_report(
    assessment: Assessment, folder: str | Path, *, pdf: bool = False, progress: Progress = None
) -> Path:
    """Write report, tables and figures of an assessment; return the path of the report.

    Parameters
    ----------
    assessment
        From `stylobate.earthquakes.assess`, or loaded.
    folder
        Folder for `report.html` (which needs no other file and no network), `summary.txt`, `tables/*.csv`,
        `tables.xlsx` if openpyxl is installed, `figures/*.png` and `assessment.nc`.
    pdf
        Whether to write `report.pdf` too, with page numbers and bookmarks (`pip install "stylobate[pdf]"`).
    progress
        A function that is called with the number of figures drawn and their total; a bar by default, False for none.

    Raises
    ------
    FileError
        If the folder cannot be written.
    UnsupportedError
        If a PDF is asked for, and WeasyPrint is not installed.
    """
    target = Path(folder)
    tables = assessment_tables(assessment)
    pictures = _drawn(report_pictures(assessment), report_of(progress))
    text = _page(assessment, tables, pictures)
    printed = pdf_of(text) if pdf else b""
    heads = [
        document_table(assessment),
        verdict_table(assessment),
        answer_table(assessment, recorded_scale(assessment)),
    ]
    try:
        for part in ("tables", "figures"):
            (target / part).mkdir(parents=True, exist_ok=True)
        for name, table in tables.items():
            write_whole(target / "tables" / f"{name}.csv", csv_text(table.header, table.rows))
        for stale in (*(target / "figures").glob("*.png"), *(target / "tables").glob("*.csv")):
            if stale.stem not in {*pictures, *tables}:
                stale.unlink()
        for name, picture in pictures.items():
            write_whole(target / "figures" / f"{name}.png", picture.drawn)
        write_whole(target / "summary.txt", printable(summary_text(assessment, heads)))
        report = target / "report.html"
        write_whole(report, text)
        if pdf:
            write_whole(target / "report.pdf", printed)
    except OSError as error:
        raise FileError(f"cannot write into {target}: {error.strerror or error}") from error
    with suppress(UnsupportedError):  # without openpyxl; the CSV files have the same cells
        write_workbook(target / "tables.xlsx", {name: [table.header, *table.rows] for name, table in tables.items()})
    assessment.save(target / "assessment.nc")
    return report


def report_style(title: str, named: str, *, breaks: str = "auto") -> str:
    """Return the style of a report with its running heads, and with a page break or none before its first section."""
    style = _STYLE.replace("BREAK", breaks)
    return style.replace("TITLE", style_text(title)).replace("NAMED", style_text(named))


def _page(assessment: Assessment, tables: Mapping[str, PageTable], pictures: Pictures) -> str:
    """Return the page of an assessment, with its running title for paper."""
    title, details = str(assessment.setting["title"]), assessment.setting.get("details", {})
    author = str(details.get("author", ""))
    named = " · ".join(
        words for words in (str(details.get("project", "")), author, str(details.get("date", ""))) if words
    )
    alone = assessment.data["columns"].sizes["column"] <= OBJECTS  # the answer to many flows over a page
    style = report_style(title, named, breaks="page" if alone else "auto")
    sections = report_sections(assessment, tables, pictures)
    return page(title, first_page(assessment, pictures), sections, style=style, author=author)


def _drawn(pictures: Pictures, progress: Report) -> Pictures:
    drawn: Pictures = {}
    for name, one in pictures.items():
        progress(len(drawn), len(pictures))
        drawn[name] = replace(one, drawn=png_of(one.figure))
    progress(len(drawn), len(pictures))
    return drawn
