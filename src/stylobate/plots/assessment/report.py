"""The report of an assessment: one page with all tables and figures, and each of them as a file."""

import csv
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from matplotlib.figure import Figure

from stylobate.errors import FileError
from stylobate.plots.assessment.figures import (
    contact_figure,
    history_figure,
    margins_figure,
    robustness_figure,
    tilts_figure,
)
from stylobate.plots.assessment.summary import summary_paragraphs
from stylobate.plots.assessment.tables import assessment_tables
from stylobate.plots.assessment.texts import ASSUMPTIONS, NOT_COVERED
from stylobate.plots.assessment.wording import number, scales
from stylobate.plots.fragility import plot_fragility
from stylobate.plots.page import Picture, Section, Table, page, png_of
from stylobate.results.assessment import Assessment
from stylobate.results.few_records import few_records

# Tables of a dozen columns, wanted whole on a screen and legible on a narrow one, where figures are scrolled too.
_STYLE = """
.wide + .wide { margin-top: 1.8rem; } nav a { display: inline-block; }
@media screen { body { max-width: 68rem; } .wide table { font-size: .84rem; line-height: 1.4; }
  th, td { padding: .35rem .45rem; min-width: 2.6rem; } }
@media screen and (max-width: 48rem) { .wide table { width: max-content; } .wide td { max-width: 15rem; }
  .wide th { max-width: 7rem; } figure { overflow-x: auto; } figure img { max-width: none; width: 44rem; } }
"""

Pictures = dict[str, Picture]
Part = str | Picture | Table


def assessment_report(
    assessment: Assessment, folder: str | Path, *, progress: Callable[[int, int], None] | None = None
) -> Path:
    """Write report, tables and figures of an assessment; return the path of the report.

    Parameters
    ----------
    assessment
        From `stylobate.studies.assess`, or loaded.
    folder
        Gets `report.html`, which needs no other file and no network; `summary.txt`; `tables/*.csv`;
        `figures/*.png`; and `assessment.nc`.
    progress
        Told the figures drawn and the figures in all.

    Raises
    ------
    FileError
        If the folder cannot be written.
    """
    target = Path(folder)
    tables = assessment_tables(assessment)
    pictures = _drawn(_pictures(assessment), progress or _silence)
    lead = summary_paragraphs(assessment)
    title = str(assessment.setting["title"])
    try:
        for part in ("tables", "figures"):
            (target / part).mkdir(parents=True, exist_ok=True)
        for name, table in tables.items():
            _write_csv(table, target / "tables" / f"{name}.csv")
        for stale in (target / "figures").glob("*.png"):
            if stale.stem not in pictures:
                stale.unlink()
        for name, picture in pictures.items():
            (target / "figures" / f"{name}.png").write_bytes(picture.drawn)
        (target / "summary.txt").write_text("\n\n".join([title, *lead]) + "\n", encoding="utf-8")
        report = target / "report.html"
        text = page(title, lead, _sections(assessment, tables, pictures))
        report.write_text(text.replace("</style>", f"{_STYLE}</style>", 1), encoding="utf-8")
    except OSError as error:
        message = f"cannot write into {target}: {error.strerror or error}"
        raise FileError(message) from error
    assessment.save(target / "assessment.nc")
    return report


def _drawn(pictures: Pictures, progress: Callable[[int, int], None]) -> Pictures:
    drawn: Pictures = {}
    for name, one in pictures.items():
        progress(len(drawn), len(pictures))
        drawn[name] = replace(one, drawn=png_of(one.figure))
    progress(len(drawn), len(pictures))
    return drawn


def _silence(done: int, total: int) -> None:
    del done, total


def _write_csv(table: Table, path: Path) -> None:
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(table.header)
        writer.writerows(table.rows)


def _pictures(assessment: Assessment) -> Pictures:
    """Return the pictures by the name of their file, which begins with that of their section."""
    found: Pictures = {}
    for place, name in enumerate(assessment.data["columns"]["column"].to_numpy()):
        column, number_of = str(name), place + 1
        found[f"margins-{number_of}"] = Picture(
            margins_figure(assessment, column),
            f"{column}: scale factors of each record that overturned it (hatched) and did not, at each dissipation. A "
            "band, or a gap, narrower than the step of the scan may have been missed; the table counts runs that do "
            "not tell.",
        )
        found[f"history-{number_of}"] = Picture(
            history_figure(assessment, column),
            f"{column} under the record that governs it: tilt and base acceleration against time; right, where it "
            "leans. Dashed: α, at which the mass centre stands above the rim.",
        )
        if not assessment.data["verdicts"]["friction_demand"].isnull().all():
            found[f"contact-{number_of}"] = Picture(
                contact_figure(assessment, column), f"{column}: friction needed in each run; dashed, what is stated."
            )
        for scale in assessment.setting["scales"]:
            found[f"tilts-{number_of}-scale-{scale:g}"] = Picture(
                tilts_figure(assessment, column, scale),
                f"{column}, records times {scale:g}: largest tilts at each dissipation, vertical component included, "
                "and of the planar column where it was asked.",
            )
            if "robustness" in assessment.data:
                found[f"robustness-{number_of}-scale-{scale:g}"] = Picture(
                    robustness_figure(assessment, column, scale),
                    f"{column}, records times {scale:g}: the verdict under each small change, at the central "
                    "dissipation.",
                )
        if "fragility" in assessment.data:
            found[f"fragility-{number_of}"] = Picture(_fragility(assessment, column), f"{column}: fragility.")
    return found


def _fragility(assessment: Assessment, column: str) -> Figure:
    return plot_fragility(assessment.data["fragility"].sel(column=column))


def _sections(assessment: Assessment, tables: dict[str, Table], pictures: Pictures) -> list[Section]:
    def drawn(name: str) -> list[Part]:
        return [picture for file, picture in pictures.items() if file.startswith(f"{name}-")]

    def listed(*names: str) -> list[Part]:
        return [tables[name] for name in names if name in tables]

    return [
        Section("Verdicts in short", listed("summary")),
        Section(
            "Margin and governing record",
            [_margin_text(assessment), *listed("governing"), *drawn("margins"), *listed("margins")],
        ),
        Section("The governing run", drawn("history")),
        Section(
            "Verdicts, dissipation and vertical component",
            [_verdict_text(assessment), *drawn("tilts"), *listed("verdicts-by-record")],
        ),
        Section(
            "What the contact must bear",
            [_contact_text(assessment), *drawn("contact"), *listed("contact-by-record", "contact-to-margin")],
        ),
        Section(
            "Does the verdict stand under small changes",
            [_robust_text(assessment), *drawn("robustness"), *listed("robustness")],
        ),
        Section("Against the planar calculation", [_planar_text(assessment), *listed("planar", "planar-bias")]),
        Section("Fragility", [_fragility_text(assessment), *drawn("fragility"), *listed("fragility")]),
        Section("Columns and dissipation", [_model_text(assessment), *listed("columns", "dissipation")]),
        Section("Records and scale factors", [_record_text(assessment), *listed("records", "record-provenance")]),
        Section("Assumptions", _assumptions(assessment)),
        Section("What is not covered", [Table(("subject", "why it matters"), NOT_COVERED)]),
        Section("Software", [_software(assessment)]),
        Section("Appendix: every run", listed("verdicts", "contact")),
    ]


def _margin_text(assessment: Assessment) -> str:
    low, high, count = assessment.setting["margin_scales"]
    return (
        f"Every record was run at {count} scale factors from {number(low)} to {number(high)}, and every change of the "
        f"answer was halved to {100.0 * assessment.setting['width']:g} %. Overturning is not monotonic: above a factor "
        "that overturns, a column may stand again, so all bands found are told, and the margin is the least factor. "
        "Near the limit the answer is erratic: a scan at other factors finds other narrow bands. "
        f"{assessment.setting['resolution'][0].upper()}{assessment.setting['resolution'][1:]}. The governing record is "
        "the one with the least factor; where none overturned, the one of the largest tilt."
    )


def _verdict_text(assessment: Assessment) -> str:
    tail = assessment.setting["tail"]
    followed = f"{tail} of free motion" if isinstance(tail, str) else f"{number(tail)} s of free motion"
    return (
        f"Records at the scale factors {scales(assessment.setting['scales'])}, at every stated dissipation, with the "
        f"vertical component and without where a record has one. Each run went on for {followed} after its record; "
        "what had not overturned by then counts as not overturned. A run that could not be followed to its end, for "
        "instance because it would have taken too many steps, is not decided."
    )


def _contact_text(assessment: Assessment) -> str:
    if not assessment.setting["contact"]:
        return "What the contact must bear was not asked for (contact = false): it is not known whether it would slip."
    return (
        "The friction needed is the largest ratio of horizontal to normal force while the column moved, up to its "
        "overturning if it did. Where it exceeds the stated coefficient the base would slip, and the run is no longer "
        "what would happen. A normal force of zero would be lift-off. The last table tells it of the scale factors "
        "that were run for the margin: what those below the least that overturned needed, and which is the least that "
        "needs more than is stated."
    )


def _robust_text(assessment: Assessment) -> str:
    changes = assessment.setting["changes"]
    if not changes:
        return "Not asked for: no verdict was repeated under small changes, so none of them is known to be repeatable."
    return (
        "Each verdict at the central dissipation again under small changes of record, dissipation, size and "
        f"integration, one at a time: {', '.join(changes)}. Dashes: the change does not apply to the record."
    )


def _planar_text(assessment: Assessment) -> str:
    if "planar" not in assessment.data:
        return "Not asked for."
    return (
        "The usual calculation takes each horizontal component alone, in its plane, with the loss of energy at impacts "
        "after Housner. It is shown for comparison and decides nothing here: a round column hardly rocks in a plane. A "
        "positive mean logarithm says that it tilts more in space. The mean is over records under which the column "
        "rocks by more than 0.001 α in both and overturns in neither; what the others do is told, and in no mean."
    )


def _fragility_text(assessment: Assessment) -> str:
    count, least = assessment.data["records"].sizes["record"], assessment.setting["least_records"]
    few = few_records(count)
    if "fragility" not in assessment.data:
        why = few or "few records cannot tell a probability"
        return f"Not fitted: at least {least} records are asked for (least_records). {why[0].upper()}{why[1:]}."
    return (f"{few}. " if few else "") + (
        f"Lognormal curves by maximum likelihood over the peak ground acceleration of {count} scaled records, at the "
        "central dissipation; intervals by drawing records anew. Records that are safe again at a higher scale are "
        "counted run by run. The curves speak of these records, not of a site."
    )


def _model_text(assessment: Assessment) -> str:
    kinds = sorted({str(one["model"].get("kind", "own")) for one in assessment.setting["columns"].values()})
    return (
        f"Equations of motion: {', '.join(kinds)}. The dissipation of a column that rocks in space is not a material "
        "constant and is seldom measured; so three levels were stated and each verdict is given at all of them."
    )


def _record_text(assessment: Assessment) -> str:
    return (
        f"Verdicts are given at the scale factors {scales(assessment.setting['scales'])}; 1 is the record as described "
        "below. PGA and PGV are of the horizontal vector. The list tells each record's files and what was done, in "
        "order."
    )


def _assumptions(assessment: Assessment) -> list[Part]:
    notes = [("stated by the author", str(note)) for note in assessment.setting["notes"]]
    return [Table(("subject", "what is assumed"), [*ASSUMPTIONS, *notes])]


def _software(assessment: Assessment) -> str:
    options = ", ".join(f"{name} = {value}" for name, value in assessment.setting["options"].items())
    return (
        f"Computed with stylobate {assessment.setting['version']}. "
        + (f"Options of the runs: {options}. " if options else "")
        + "All numbers are in assessment.nc beside this page, from which the page can be made again."
    )
