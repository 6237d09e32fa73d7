"""The report of an assessment: one page with all tables and figures, and a file for each table and figure."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import xarray as xr

from stylobate.earthquakes.assessment.report.column_verdict import (
    column_verdict,
    largest_decided,
    least_overturning_scale,
    level_words,
    recorded_scale,
)
from stylobate.earthquakes.assessment.report.figures import Pictures, report_pictures
from stylobate.earthquakes.assessment.report.tables import assessment_tables, drifting, margin_intensities
from stylobate.earthquakes.assessment.report.wording import (
    ASSUMPTIONS,
    CENTRAL,
    INTENSITIES,
    NOT_COVERED,
    PLANAR,
    REFERENCES,
    RULES,
    SLIP_AND_FLIGHT,
    SMALLEST_TILT,
    TILT,
    VERDICT_CLASSES,
    at_most,
    labels,
    listed,
    number,
    records,
    scales,
    stated_friction,
    tilt_words,
)
from stylobate.errors import FileError
from stylobate.files import csv_text, write_whole
from stylobate.plots.page import PageSection, PageTable, Picture, page, png_of
from stylobate.progress import Progress, Report, report_of, shows_progress
from stylobate.results.assessment import Assessment
from stylobate.results.verdict import few_records, yardstick_text
from stylobate.text import plural

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


_APART = 2.0
"""Smallest factor between the highest and the lowest level of damping that tests whether it decides."""


def verdict_table(assessment: Assessment) -> PageTable:
    """Tabulate the verdict on each column in one line, at the scale nearest to 1."""
    rows = []
    for name in labels(assessment.data["columns"], "column"):
        found = column_verdict(assessment, name, recorded_scale(assessment))
        margin = f" {least_overturning_scale(assessment, name)}" if found.describes else ""
        sentence = f"{found.sentence[0].upper()}{found.sentence[1:]}{margin}{_levels_remark(assessment, name)}"
        rows.append((name, found.verdict.value, sentence))
    return PageTable(("column", "verdict", "in one line"), rows)


def column_findings(assessment: Assessment, name: str) -> PageTable:
    """Tabulate the findings on one column, one row for each subject."""
    own = assessment.data["summary"].sel(column=name)
    first = recorded_scale(assessment)
    described = column_verdict(assessment, name, first).describes
    subjects = {f"tilt, {level_words(first)}": _tilt(assessment, name, first) if described else ""}
    for scale in (float(one) for one in own["scale"].to_numpy() if one != first):
        found = column_verdict(assessment, name, scale)
        words = f"{found.line} {_tilt(assessment, name, scale) if found.describes else ''}"
        subjects[level_words(scale)] = words.strip()
    subjects["margin"] = _margin(assessment, name, own) if described else ""
    subjects["contact"] = _contact(assessment, name, own)
    subjects["damping"] = _damping(assessment, name)
    return PageTable((name, ""), [(subject, words) for subject, words in subjects.items() if words])


def summary_text(assessment: Assessment, heads: Sequence[PageTable]) -> str:
    """Write the summary as plain text: the tables `heads`, the findings on each column, and a guide to them."""
    blocks = ["\n".join(": ".join(row) for row in table.rows) for table in heads]
    for name in labels(assessment.data["columns"], "column"):
        findings = column_findings(assessment, name)
        blocks.append("\n".join([findings.header[0], *(": ".join(row) for row in findings.rows)]))
    return "\n\n".join([str(assessment.setting["title"]), *blocks, _how_to_read(assessment)]) + "\n"


def _tilt(assessment: Assessment, name: str, scale: float) -> str:
    """State the peak tilt of the central runs that did not overturn."""
    runs = assessment.data["verdicts"].sel(column=name, scale=scale, dissipation=CENTRAL, vertical="with")
    ratios = runs["tilt_ratio"].where(runs["overturned"] == 0).dropna("record")
    if ratios.size == 0:
        return ""
    most = ratios.isel(record=int(np.argmax(ratios.to_numpy())))
    if float(most) == 0.0:
        others = ratios.size < runs.sizes["record"]
        return "It did not rock under the records that did not overturn it." if others else "It did not rock."
    if float(most) < SMALLEST_TILT:
        return f"It hardly rocked: the peak tilt without overturning is below {SMALLEST_TILT:g} α_c."
    words = tilt_words(float(most), assessment.data["columns"].sel(column=name))
    return f"Peak tilt at {CENTRAL} dissipation without overturning: {words} ({most['record'].item()})."


def _margin(assessment: Assessment, name: str, own: xr.Dataset) -> str:
    low, high = float(assessment.setting["margin_scales"][0]), largest_decided(assessment, name, case=CENTRAL)
    record = str(own["least_record"].item())
    least, least_of_all = float(own["least_overturning"]), float(own["least_of_all"])
    if math.isnan(least) and math.isnan(high):
        sentence = f"At central dissipation the smallest scale factor, {number(low)}, was not decided."
    elif math.isnan(least):
        sentence = f"No scale factor from {number(low)} to {number(high)} overturned it at central dissipation."
    else:
        sentence = (
            f"At central dissipation the smallest overturning scale is at most {at_most(least)} ({record})"
            f"{_lasting(assessment, name, record)}. {_intensity(assessment, name, record)}"
        )
    if not math.isnan(least_of_all) and least_of_all != least:
        sentence += f" {least_overturning_scale(assessment, name)}"
    again = int(own["stands_again"])
    if again:
        under = records(again, assessment.data["records"].sizes["record"])
        sentence += (
            f" Under {under}, it survived some scales above one that overturned it: overturning is not monotonic in "
            "the scale."
        )
    return sentence


def _intensity(assessment: Assessment, column: str, record: str) -> str:
    """State PGA, PGV and Sa of a record at the smallest overturning scale of a column."""
    table = margin_intensities(assessment)
    row = next(row for row in table.rows if tuple(row[:2]) == (column, record))
    cells = dict(zip(table.header, row, strict=True))
    spectral = next(name for name in table.header if name.startswith("Sa") and name.endswith("[g]"))
    scale = cells["smallest overturning scale, at most"]
    return (
        f"At scale {scale} PGA is {cells['PGA [g]']} g, PGV {cells['PGV [m/s]']} m/s and "
        f"{spectral.removesuffix(' [g]')} {cells[spectral]} g ({cells['definition']})."
    )


def _lasting(assessment: Assessment, column: str, record: str) -> str:
    """Remark on an isolated smallest overturning scale, with survival just below and above; else empty."""
    margins = assessment.data["margins"].sel(column=column, record=record, case=CENTRAL)
    least, lasting = float(margins["least_overturning"]), float(margins["least_lasting"])
    if lasting == least:
        return ""
    alone = ", in an overturning interval so narrow that another scan may not find it"
    return alone if math.isnan(lasting) else f"{alone}; the first wider interval begins at {number(lasting, 4)}"


def _contact(assessment: Assessment, name: str, own: xr.Dataset) -> str:
    need = float(own["friction_demand"].max())
    if math.isnan(need):
        return ""
    stated = stated_friction(assessment, name)
    law = str(assessment.setting["columns"][name]["model"].get("kind", "the given model"))
    if need <= stated:
        scales = assessment.setting["scales"]
        where = f"scale {scales[0]:g}" if len(scales) == 1 else "the stated scales"
        at_stated = (
            f"The runs at {where} with {law} needed a friction coefficient of up to "
            f"{number(need)}; the stated coefficient is {number(stated)}."
        )
    else:
        at_stated = (
            f"Some run with {law} needed a friction coefficient of {number(need)}, above the stated {number(stated)}: "
            "the base would slip, which the run does not describe."
        )
    return f"{at_stated} {_contact_to_margin(own)}{_contact_of_other_law(own)}"


def _contact_to_margin(own: xr.Dataset) -> str:
    """State the smallest scale that needs more friction than stated with the given contact law."""
    need, slipping = (float(own[name]) for name in ("friction_to_margin", "least_slipping"))
    if math.isnan(need) and math.isnan(slipping):
        return "The friction needed at other scales was not computed."
    if math.isnan(slipping):
        return "No run for the margin needed more friction than stated."
    sentence = f"The smallest scale run that needs more friction than stated is {number(slipping, 3)}"
    if math.isnan(float(own["least_of_all"])):
        return f"{sentence}: beyond it the base would slip, and these runs do not describe the column."
    if int(own["slips_first"]):
        return (
            f"{sentence}. With some damping the base would slip at a scale below the smallest that overturns the "
            "column, and these runs do not give the margin."
        )
    return f"{sentence}, above the smallest overturning scale: the column overturns before its base would slip."


def _contact_of_other_law(own: xr.Dataset) -> str:
    """State the smallest scale at which the other contact law needs more friction; empty if none does."""
    slipping = float(own["least_slipping_other_law"])
    if math.isnan(slipping):
        return ""
    return (
        f" With the other contact law some run needs more from scale {number(slipping)} on. At close passages of the "
        "vertical the friction needed is that of a rigid rim, which a real edge does not reach; therefore the class "
        "of the verdict considers the given law only."
    )


def _damping(assessment: Assessment, name: str) -> str:
    """State the damping that loses as much as Housner's impacts, and on which side of it the levels lie."""
    own = assessment.data["columns"].sel(column=name)
    sentence = f"Housner's impacts lose as much as {yardstick_text(own['housner_damping'].to_numpy())}."
    return f"{sentence}{_levels_remark(assessment, name)}"


def _levels_remark(assessment: Assessment, name: str) -> str:
    """Remark on levels of damping on one side of Housner's, or too near each other to test anything; else empty."""
    side = str(assessment.data["columns"]["damping_side"].sel(column=name).item())
    remark = (
        f" All stated levels of damping lie {side} Housner's: state why, or add a level near it."
        if side in ("below", "above")
        else ""
    )
    levels = [one["damping"] for one in assessment.setting["dissipation"][name].values() if "damping" in one]
    if levels and min(levels) > 0.0 and max(levels) < _APART * min(levels):
        factor = number(max(levels) / min(levels))
        remark += f" The stated levels of damping differ by a factor of {factor} only; the recipe has half and twice."
    return remark


def _how_to_read(assessment: Assessment) -> str:
    """Explain the meaning and the limits of a verdict."""
    repeated = (
        "Verdicts were therefore repeated under small variations: read their shares, not single runs."
        if assessment.setting["variations"]
        else "No verdict was repeated under small variations here, so it is not known whether any is repeatable."
    )
    return (
        "How to read this: a verdict reports runs of a rigid column under these records only. “Did not overturn” does "
        "not prove that the column cannot overturn. Near the overturning limit, a single rocking run is barely "
        f"repeatable. {repeated}"
    )


Part = str | Picture | PageTable


def document_table(assessment: Assessment) -> PageTable:
    """Tabulate project, author, date, study file and program, if stated."""
    details = assessment.setting.get("details", {})
    study = details.get("study_file", "")
    lines = {
        "project": details.get("project", ""),
        "author": details.get("author", ""),
        "date": details.get("date", ""),
        "study file": f"{study}, SHA-256 {details.get('study_sha256', '')}" if study else "",
        "computed with": f"stylobate {assessment.setting['version']}",
    }
    return PageTable(("document", ""), [(name, str(words)) for name, words in lines.items() if words])


def report_sections(
    assessment: Assessment, tables: Mapping[str, PageTable], pictures: Mapping[str, Picture]
) -> list[PageSection]:
    """Return the sections of the report that have content."""

    def drawn(name: str) -> list[Part]:
        return [picture for file, picture in pictures.items() if file.startswith(f"{name}-")]

    def shown(*names: str) -> list[Part]:
        return [tables[name] for name in names if name in tables]

    columns = labels(assessment.data["columns"], "column")
    planar = PLANAR if "planar" in assessment.data else ["Not computed (planar = false)."]
    found = [
        PageSection("Verdicts", [*shown("verdicts"), PageTable(("class of verdict", "meaning"), VERDICT_CLASSES)]),
        PageSection(
            "The columns one by one",
            [
                *(column_findings(assessment, name) for name in columns),
                _how_to_read(assessment),
            ],
        ),
        PageSection("Records", [_record_text(assessment), *shown("events"), *drawn("records"), *drawn("spectra")]),
        PageSection("Intensities of the records", [INTENSITIES, *shown("records", "spectra")]),
        PageSection(
            "Margins",
            [
                _margin_text(assessment),
                *(*shown("margin-intensities", "governing"), *drawn("margins"), *drawn("history"), *shown("margins")),
            ],
        ),
        PageSection("Tilt and displacement", [TILT, *drawn("tilts"), *shown("tilts")]),
        PageSection(
            "Dissipation and vertical component",
            [_verdict_text(assessment), *shown("summary", "verdicts-by-record")],
        ),
        PageSection(
            "Contact demand",
            [_contact_text(assessment), *drawn("contact"), *shown("contact-by-record", "contact-to-margin", "sliding")],
        ),
        PageSection(
            "Small variations and near scales",
            [_variations_text(assessment), *drawn("variations"), *shown("variations", "near-scales")],
        ),
        PageSection("Comparison with the planar calculation", [*planar, *shown("planar", "planar-bias")]),
        PageSection("Rules of practice", [RULES, *rules] if (rules := shown("rules-of-practice")) else []),
        PageSection("Fragility", [_fragility_text(assessment), *drawn("fragility"), *shown("fragility")]),
        PageSection("Annual rates", [_rates_text(assessment), *rates] if (rates := shown("rates")) else []),
        PageSection("Columns and damping", [_model_text(assessment), *shown("columns", "dissipation")]),
        PageSection("Assumptions", [_assumptions(assessment)]),
        PageSection("What is not covered", [not_covered(assessment)]),
        PageSection("References", [PageTable(("subject", "source"), REFERENCES)]),
        PageSection("Software", [_software(assessment)]),
        PageSection("Appendix: origin of the records", shown("record-provenance")),
        PageSection("Appendix: every run at the stated scales, with the given contact law", shown("runs")),
    ]
    return [section for section in found if section.content]


def _record_text(assessment: Assessment) -> str:
    drift = drifting(assessment)
    remark = (
        f" Drift: at the end of {listed(drift, 'and')} the velocity exceeds 5 % of PGV. Filter the record or correct "
        "its baseline, or state why the drift is acceptable."
        if drift
        else ""
    )
    return (
        f"Verdicts are given at the scale factors {scales(assessment.setting['scales'])}. Scale 1 is the record as "
        f"processed; the appendix on the origin of the records lists the processing.{remark}"
    )


def _margin_text(assessment: Assessment) -> str:
    low, high, count = assessment.setting["margin_scales"]
    resolution = assessment.setting["resolution"]
    return (
        f"Every record was run at {count} scale factors from {number(low)} to {number(high)}, including 41 within "
        "10 % of each stated one, and every change of the "
        f"outcome was located by bisection to {100.0 * assessment.setting['width']:g} %. The margin is the smallest "
        "scale factor found that overturned the column; below it 2000 scale factors over the range are run. Narrower "
        "intervals may lie below, so read each margin as “at most”. A case is a level of dissipation, the central one "
        "without the vertical component, or a level with the other contact law. Overturning is not monotonic: a column "
        "may survive above the margin, so the last table lists every overturning interval found. Near the limit the "
        "outcome is erratic: a scan at other factors finds other narrow intervals. "
        f"{resolution[0].upper()}{resolution[1:]}. “Governs” marks the record whose runs are "
        "drawn. “>” marks a record that overturned the column at no scale; its values are those at the largest decided "
        "scale."
    )


def _verdict_text(assessment: Assessment) -> str:
    tail = assessment.setting["tail"]
    followed = (
        f"{tail} of free vibration (p is the frequency parameter in the table of columns)"
        if isinstance(tail, str)
        else f"{number(tail)} s of free vibration"
    )
    return (
        f"Each record was run at the scale factors {scales(assessment.setting['scales'])} and at every stated "
        "dissipation, with its vertical component and, if it has one, without it. The first table counts records, at "
        f"central dissipation unless its heading says otherwise. Each run continued for {followed} after its record; a "
        "column that had not overturned by then counts as not overturned; under small variations it is not decided if "
        "it still moves and may overturn later. A run that could not be completed, for instance because it needed too "
        "many steps, is not decided."
    )


def _contact_text(assessment: Assessment) -> str:
    if not assessment.setting["contact"]:
        return "The friction needed was not computed (contact = false): it is not known whether the base would slip."
    return (
        "The friction needed is the peak ratio of horizontal to normal force in a run, up to overturning if the "
        "column overturned. If it exceeds the stated coefficient, the base would slip, and the run no longer "
        "describes the column. A normal force of zero would mean lift-off. The first table and the classes of verdicts "
        "hold for the given contact law. The second table gives the friction needed at the scale factors that were run "
        "for the margin, with both contact laws. A column that passes close to the vertical rolls fast round its rim: "
        "the friction that it needs there is that of a rigid rim in one point, and ∞ means that the contact would have "
        "to pull. A real edge yields, so such a value does not show that the base slips."
    )


def _variations_text(assessment: Assessment) -> str:
    runs = assessment.setting["variations"]
    near = (
        "The share of overturning scales is counted at 41 scales within 10 % of each stated one, in every case; it "
        "shows intervals that a single run misses."
    )
    if not runs:
        return (
            "No verdict was repeated under small variations (variations = 0), so it is not known which verdicts are "
            f"repeatable. {near}"
        )
    laws = ", and the contact law" if assessment.setting["contact_laws"] else ""
    return (
        f"Each verdict was repeated {runs} times with everything varied at once: scale, clock, low-pass and direction "
        "of the record; size and slenderness of the column; dissipation from the lowest to the highest stated level; a "
        f"base out of level by a tenth of a degree; a small disturbance at the start; the tolerance{laws}. A column "
        "stands if the interval of the share of overturning lies below 5 %, overturns if it lies above 95 %, and is "
        f"undecided otherwise. {near}"
    )


def _fragility_text(assessment: Assessment) -> str:
    count, least = assessment.data["records"].sizes["record"], assessment.setting["least_records"]
    few = few_records(count)
    if "fragility" not in assessment.data:
        why = few or "a probability needs more records"
        return f"Not fitted: at least {least} records are required (least_records). {why[0].upper()}{why[1:]}."
    return (f"{few}. " if few else "") + (
        f"Lognormal curves by maximum likelihood over the peak ground acceleration (RotD50) of {count} "
        "scaled records, at the central dissipation; intervals by bootstrap over the records. Records with survival "
        "above an overturning scale are counted run by run. The curves describe these records, not a site."
    )


def _rates_text(assessment: Assessment) -> str:
    hazard = assessment.setting["hazard"]
    component = f", {hazard['component']}" if hazard["component"] else ""
    origin = f" Its rates come from {hazard['origin']}." if hazard["origin"] else ""
    count = assessment.data["records"].sizes["record"]
    few = f"; with {plural(count, 'record')} it is too narrow" if few_records(count) else ""
    return (
        f"The hazard curve of the site states the annual rate at which each {hazard['quantity']}{component} is "
        f"exceeded.{origin} The counted rate needs no fragility curve: each run of the scan stands for the intensities "
        "around its own, and survival above an overturning scale counts as survival. Its interval is a bootstrap over "
        f"the records, at 95 % confidence{few}. The fitted rate is that of a lognormal curve; it is left out with few "
        "records. Both are at the central dissipation."
    )


def _model_text(assessment: Assessment) -> str:
    kinds = sorted({str(one["model"].get("kind", "own")) for one in assessment.setting["columns"].values()})
    return (
        f"Equations of motion: {', '.join(kinds)}. The damping of a column that rocks in three dimensions is not a "
        "material constant and is seldom measured. Therefore several levels were stated, and each verdict is given at "
        "all of them. R is the distance from the centre of mass to the rim, p the frequency parameter √(mgR/K) with "
        "the moment of inertia K about the rim."
    )


def _assumptions(assessment: Assessment) -> PageTable:
    notes = [
        ("records, as read" if note.startswith("Warning: ") else "stated by the author", note)
        for note in map(str, assessment.setting["notes"])
    ]
    return PageTable(("subject", "what is assumed"), [*ASSUMPTIONS, *notes])


def not_covered(assessment: Assessment) -> PageTable:
    """Tabulate the subjects that the assessment does not cover."""
    return PageTable(
        ("subject", "why it matters"), [*NOT_COVERED, SLIP_AND_FLIGHT[bool(assessment.setting["sliding"])]]
    )


def _software(assessment: Assessment) -> str:
    options = ", ".join(f"{name} = {value}" for name, value in assessment.setting["options"].items())
    versions = ", ".join(f"{name} {value}" for name, value in assessment.setting.get("software", {}).items())
    return (
        f"Computed with stylobate {assessment.setting['version']}. "
        + (f"Versions: {versions}. " if versions else "")
        + (f"Options of the runs: {options}. " if options else "")
        + "The file assessment.nc beside this page holds all numbers; stylobate assess writes the page from it again."
    )
