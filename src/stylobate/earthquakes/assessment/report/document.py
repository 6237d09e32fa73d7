"""The report of an assessment: one page with all tables and figures, and a file for each table and figure."""

from dataclasses import replace
from pathlib import Path

from stylobate.earthquakes.assessment.report.pictures import Pictures, report_pictures
from stylobate.earthquakes.assessment.report.sections import document_table, report_sections
from stylobate.earthquakes.assessment.report.summary import summary_text, verdict_table
from stylobate.earthquakes.assessment.report.tables import assessment_tables
from stylobate.errors import FileError
from stylobate.files import csv_text, write_whole
from stylobate.plots.page import page, png_of
from stylobate.progress import Progress, Report, report_of, shows_progress
from stylobate.results.assessment import Assessment

# Tables of a dozen columns fit a wide screen; a narrow screen scrolls tables and figures. In print, figures are only as
# wide as legibility needs, so that a page holds two or three.
_STYLE = """
.wide + .wide { margin-top: 1.8rem; }
body > .wide:nth-of-type(2) td:nth-child(2) { font-weight: 600; } nav a { display: inline-block; }
@page { size: A4; margin: 16mm 15mm 18mm; }
@media screen { body { max-width: 68rem; } .wide table { font-size: .84rem; line-height: 1.4; }
  th, td { padding: .35rem .45rem; min-width: 2.6rem; } }
@media screen and (max-width: 48rem) { .wide table { width: max-content; } .wide td { max-width: 15rem; }
  .wide th { max-width: 7rem; } figure { overflow-x: auto; } figure img { max-width: none; width: 44rem; } }
@media print { h2 { margin-top: 1.4rem; font-size: 13pt; } p { orphans: 3; widows: 3; }
  figure { margin: .6rem 0; text-align: center; } figcaption { font-size: 8pt; text-align: left; }
  figure img { max-width: 82%; max-height: 11.4cm; } th, td { padding: .12rem .3rem; overflow-wrap: break-word; }
  .wide + .wide { margin-top: .8rem; } .wide + figure { margin-top: 1rem; } }
"""


@shows_progress("figures")
def assessment_report(assessment: Assessment, folder: str | Path, *, progress: Progress = None) -> Path:
    """Write report, tables and figures of an assessment; return the path of the report.

    Parameters
    ----------
    assessment
        From `stylobate.earthquakes.assess`, or loaded.
    folder
        Folder for `report.html` (which needs no other file and no network), `summary.txt`, `tables/*.csv`,
        `figures/*.png` and `assessment.nc`.
    progress
        A function that is called with the number of figures drawn and their total; a bar by default, False for none.

    Raises
    ------
    FileError
        If the folder cannot be written.
    """
    target = Path(folder)
    tables = assessment_tables(assessment)
    pictures = _drawn(report_pictures(assessment), report_of(progress))
    title, document = str(assessment.setting["title"]), document_table(assessment)
    verdicts = verdict_table(assessment)
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
        write_whole(target / "summary.txt", summary_text(assessment, [document, verdicts]))
        report = target / "report.html"
        text = page(title, [document, verdicts], report_sections(assessment, tables, pictures))
        write_whole(report, text.replace("</style>", f"{_STYLE}</style>", 1))
    except OSError as error:
        raise FileError(f"cannot write into {target}: {error.strerror or error}") from error
    assessment.save(target / "assessment.nc")
    return report


def _drawn(pictures: Pictures, progress: Report) -> Pictures:
    drawn: Pictures = {}
    for name, one in pictures.items():
        progress(len(drawn), len(pictures))
        drawn[name] = replace(one, drawn=png_of(one.figure))
    progress(len(drawn), len(pictures))
    return drawn
