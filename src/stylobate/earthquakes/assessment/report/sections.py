"""The pages of a report: the first page with question and answer, then short texts with tables and figures."""

from collections.abc import Mapping

from stylobate.earthquakes.assessment.report import shown_tables
from stylobate.earthquakes.assessment.report.answers import answer_table, answer_text
from stylobate.earthquakes.assessment.report.column_verdict import cases_of, level_words, recorded_scale, slides_at
from stylobate.earthquakes.assessment.report.findings import column_findings
from stylobate.earthquakes.assessment.report.sketch import OBJECTS
from stylobate.earthquakes.assessment.report.tables import drifting
from stylobate.earthquakes.assessment.report.wording import (
    ASSUMPTIONS,
    INTENSITIES,
    NOT_COVERED,
    PLANAR,
    REFERENCES,
    RULES,
    SLIP_AND_FLIGHT,
    TILT,
    VERDICT_CLASSES,
    how_to_read,
    labels,
    listed,
    number,
    scales,
)
from stylobate.plots.page import PageList, PageSection, PageTable, Part, Picture
from stylobate.results.assessment import Assessment
from stylobate.results.verdict import few_records
from stylobate.text import headings_in_words, plural


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


def first_page(assessment: Assessment, pictures: Mapping[str, Picture]) -> list[Part]:
    """Return question, objects, answer and assumptions."""
    scale = recorded_scale(assessment)
    return [
        _document_line(assessment),
        _question(assessment, scale),
        answer_table(assessment, scale),
        answer_text(assessment, scale),
        *([pictures["objects-1"]] if "objects-1" in pictures else []),
        "What is assumed:",
        PageList(_assumed(assessment)),
    ]


def _document_line(assessment: Assessment) -> str:
    """Return project, author, date and program in one line."""
    rows = [row for row in document_table(assessment).rows if row[0] != "study file"]
    return " · ".join(f"{name}: {words}" for name, words in rows)


def _question(assessment: Assessment, scale: float) -> str:
    names = labels(assessment.data["columns"], "column")
    what = f"{listed(names, 'and')} stand" if len(names) > 1 else f"{names[0]} stands"
    count = plural(assessment.data["records"].sizes["record"], "record")
    return (
        f"Question: {what} free, without anchorage. {'Do they' if len(names) > 1 else 'Does it'} remain standing under "
        f"{count} {level_words(scale)}, and what would overturn {'them' if len(names) > 1 else 'it'}?"
    )


def _assumed(assessment: Assessment) -> list[str]:
    """List the assumptions that decide the answer, and those of the author."""
    setting = assessment.setting
    frictions = _by_object({name: number(float(one)) for name, one in setting["friction_coefficient"].items()})
    damping = shown_tables.damping(assessment)
    levels = [name for name in damping.header[1:] if "Housner" not in name]
    stated = _by_object({row[0]: ", ".join(row[1 : 1 + len(levels)]) for row in damping.rows})
    sides = assessment.data["columns"]["damping_side"]
    one_sided = [f"{name} {sides.sel(column=name).item()}" for name in labels(sides, "column")]
    one_sided = [words for words in one_sided if words.endswith((" below", " above"))]
    flag = f" All levels lie on one side of Housner's impacts: {listed(one_sided, 'and')} them." if one_sided else ""
    headings = headings_in_words(setting.get("details", {}).get("table_read_as", {}))
    return [
        "Body: rigid, in one piece, on a flat circular base on level rigid ground, upright and at rest at the start. "
        "The "
        "radius is that of the foot, which may be narrower than the belly.",
        *_estimated(assessment),
        f"Contact: {_laws(assessment)}; friction coefficient as stated: {frictions}.{_of_other_law(assessment)}",
        f"Damping ({', '.join(levels)}): {stated}. Not measured, see the section on damping.{flag}",
        *([f"Table of objects: {headings}."] if headings else []),
        f"Records: scaled by {scales(setting['scales'])}, with a vertical component where they have one, then "
        f"{_followed(assessment)}.",
        *(f"Stated by the author: {note}" for note in map(str, setting["notes"]) if not note.startswith("Warning: ")),
        *(note for note in map(str, setting["notes"]) if note.startswith("Warning: ")),
    ]


def _estimated(assessment: Assessment) -> list[str]:
    """State of which objects the moments of inertia are estimated, from which profile and how surely; none for none."""
    found: dict[str, list[str]] = {}
    for name, one in assessment.setting["columns"].items():
        own = one["column"].get("profile", {})
        spread = own.get("transverse_spread", 0.0), own.get("axial_spread", 0.0)
        if max(spread) > 0.0:
            words = f"{own['name']}, ±{100.0 * spread[0]:.3g} %, about the axis ±{100.0 * spread[1]:.3g} %"
            found.setdefault(words, []).append(name)
    if not found:
        return []
    objects = "; ".join(f"{listed(tuple(names), 'and')} (profile {words})" for words, names in found.items())
    varied = "the small variations vary them" if assessment.setting["variations"] else "nothing varies them here"
    return [f"Moments of inertia: estimated from a kind of profile for {objects}; {varied}."]


def _by_object(words: Mapping[str, str]) -> str:
    """State what differs between objects by object; once if it does not, and by a reference for many objects."""
    if len(set(words.values())) == 1:
        return next(iter(words.values()))
    if len(words) > OBJECTS:
        return "one for each object, listed below"
    return "; ".join(f"{name} {one}" for name, one in words.items())


def _laws(assessment: Assessment) -> str:
    """Name the given contact laws, and the other ones that were assessed."""
    given = sorted({str(one["model"].get("kind", "own")) for one in assessment.setting["columns"].values()})
    if not assessment.setting["contact_laws"]:
        return listed(given, "and")
    if "variations" not in assessment.data:
        return f"{listed(given, 'and')}, and the other contact law"
    others = [name for name in labels(assessment.data["variations"], "contact_law") if name not in given]
    return f"{listed(given, 'and')}, and {listed(others, 'and')} as the other contact law"


def _of_other_law(assessment: Assessment) -> str:
    """State which columns only the other contact law overturned at the stated scale nearest to 1."""
    if not assessment.setting["contact_laws"]:
        return ""
    scale = recorded_scale(assessment)
    names = [
        name
        for name in labels(assessment.data["columns"], "column")
        if not slides_at(assessment, name, scale) and cases_of(assessment, name, scale).with_other_law
    ]
    if not names:
        return " No record overturned an object with the other law only."
    return f" With the other law only, some record overturned {listed(names, 'and')}."


def _followed(assessment: Assessment) -> str:
    tail = assessment.setting["tail"]
    if isinstance(tail, str):
        return f"{tail} of free vibration, with the frequency parameter p of the column"
    return f"{number(tail)} s of free vibration"


def report_sections(
    assessment: Assessment, tables: Mapping[str, PageTable], pictures: Mapping[str, Picture]
) -> list[PageSection]:
    """Return the sections of the report that have content."""

    def drawn(name: str) -> list[Part]:
        return [picture for file, picture in pictures.items() if file.startswith(f"{name}-")]

    def shown(*names: str) -> list[Part]:
        return [tables[name] for name in names if name in tables]

    columns = labels(assessment.data["columns"], "column")
    more_objects = [picture for picture in drawn("objects") if picture is not pictures.get("objects-1")]
    planar = PLANAR if "planar" in assessment.data else ["No planar calculation was asked for (planar = false)."]
    biases = shown_tables.bias(assessment, tables["planar-bias"]) if "planar-bias" in tables else []
    slips = shown("slip-summary", "slip-limits", "slip")
    found = [
        PageSection(
            "Objects one by one",
            [*more_objects, *shown("columns"), *(column_findings(assessment, name) for name in columns)],
        ),
        PageSection(
            "Records",
            [
                _record_text(assessment),
                *shown("events"),
                shown_tables.records(assessment, tables["records"]),
                *drawn("records"),
                *drawn("spectra"),
            ],
        ),
        PageSection(
            "Outcomes at the stated scales",
            [f"{_outcome_text(assessment)}{_left_out(assessment)}", *shown_tables.outcomes(assessment)],
        ),
        PageSection(
            "Margins",
            [f"{_margin_text(assessment)}{_left_out(assessment)}", shown_tables.margins(assessment), *drawn("margins")],
        ),
        PageSection("Tilt and displacement", [TILT, *shown_tables.tilts(assessment), *planar, *biases]),
        PageSection("Contact demand", [_contact_text(assessment), shown_tables.contact(assessment)]),
        PageSection("Slip", [_slip_text(assessment), *slips, *drawn("slip")] if slips else []),
        PageSection("Damping", [_damping_text(assessment), shown_tables.damping(assessment)]),
        PageSection("Rules of practice", _rules(assessment, tables)),
        PageSection("Fragility", [_fragility_text(assessment), *drawn("fragility"), *shown("fragility")]),
        PageSection(
            "Annual rates", [_rates_text(assessment), *rates, *drawn("rates")] if (rates := shown("rates")) else []
        ),
        PageSection(
            "How to read the verdicts",
            [how_to_read(assessment), PageTable(("class of verdict", "meaning"), VERDICT_CLASSES)],
        ),
        PageSection("Assumptions", [_assumptions(assessment)]),
        PageSection("What is not covered", [not_covered(assessment)]),
        PageSection("How to repeat this assessment", [_repeat(assessment), shown_tables.inputs(assessment)]),
        PageSection("References", [PageTable(("subject", "source"), REFERENCES)]),
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
    return f"Scale 1 is the record as processed; the section on repetition lists the processing. {INTENSITIES}{remark}"


def _outcome_text(assessment: Assessment) -> str:
    runs = assessment.setting["variations"]
    laws = ", and the contact law" if assessment.setting["contact_laws"] else ""
    inertia = ", estimated moments of inertia" if _estimated(assessment) else ""
    varied = (
        f"Each verdict was repeated {runs} times with everything varied at once: scale, clock, low-pass and direction "
        f"of the record; size{inertia} and slenderness of the column; dissipation from the lowest to the highest "
        "stated level; a base out of level by a tenth of a degree; a small disturbance at the start; the "
        f"tolerance{laws}. The table states the share that overturned the column, and what decided most. Below 5 % "
        "with its whole interval the column stands, above 95 % it overturns, between it is undecided."
        if runs
        else "No verdict was repeated under small variations (variations = 0), so it is not known which verdicts are "
        "repeatable."
    )
    return (
        f"Each record was run at scale {scales(assessment.setting['scales'])} and every stated dissipation with "
        f"{_laws(assessment)}; also, at central dissipation, without its vertical component. Each run continued for "
        f"{_followed(assessment)}; a column that had not overturned by then counts as not overturned. {varied} The "
        "last column counts overturning scales among 41 within 10 % of the stated one, the largest share of all cases. "
        "“Yes” marks a case that overturned the column, “none” a record without a vertical component."
    )


def _left_out(assessment: Assessment) -> str:
    """Name the columns that slide before they rock, which runs without slip do not describe; empty if none does."""
    scale = recorded_scale(assessment)
    names = [name for name in labels(assessment.data["columns"], "column") if slides_at(assessment, name, scale)]
    if not names:
        return ""
    return f" Left out: {listed(names, 'and')}, which {'slides before it rocks' if len(names) == 1 else 'slide first'}."


def _margin_text(assessment: Assessment) -> str:
    low, high, count = assessment.setting["margin_scales"]
    resolution = assessment.setting["resolution"]
    return (
        f"The table has the smallest scale factor that overturned the column, by level of dissipation and contact law. "
        f"Every record was run at {count} scale factors from {number(low)} to {number(high)} and, below the first "
        "overturning one, at 2000 more; each change of the outcome was located by bisection to "
        f"{100.0 * assessment.setting['width']:g} %. Narrower intervals may lie below, so read each margin as “at "
        "most”. Overturning is not monotonic: a column may survive above the margin, and near the limit the outcome is "
        f"erratic. {resolution[0].upper()}{resolution[1:]}. “>” marks a record that overturned the column at no scale "
        "up to this one. PGA, PGV and Sa are those of the record at its central margin. tables/margins.csv has all "
        "overturning intervals."
    )


def _contact_text(assessment: Assessment) -> str:
    if not assessment.setting["contact"]:
        return "The friction needed was not computed (contact = false): it is not known whether the base would slip."
    return (
        "The friction needed is the peak ratio of horizontal to normal force in a run, up to overturning if the "
        "column overturned. If it exceeds the stated coefficient, the base would slip, and the run no longer "
        "describes the column. The class of a verdict considers the given contact law only: with the other law, a "
        "column that passes close to the vertical rolls fast round its rim, and the friction that it needs there is "
        "that of a rigid rim in one point, which a real edge does not reach. tables/contact-by-record.csv and "
        "tables/contact-to-margin.csv have the demand of each record and case. The smallest scale that needs "
        "more is that of any run of the scan, at any level of dissipation: it can lie below a stated scale whose own "
        "runs need less."
    )


def _slip_text(assessment: Assessment) -> str:
    dispersion = number(float(assessment.setting["friction_dispersion"]))
    return (
        "A column whose friction coefficient is below r/h slides before it rocks. While it stands on its whole base it "
        "moves as Newmark's sliding block in two horizontal directions, at its stated friction. Intervals have 90 % of "
        f"{assessment.setting['variations']} small variations: scale, clock and direction of the record, and the "
        f"friction coefficient with a dispersion of {dispersion} (logarithm). Slip need not grow with the scale, so "
        "every scale was computed. Not known are runs in which the base falls faster than g, and variations whose "
        "friction reaches r/h."
    )


def _damping_text(assessment: Assessment) -> str:
    kinds = sorted({str(one["model"].get("kind", "own")) for one in assessment.setting["columns"].values()})
    return (
        f"Equations of motion: {', '.join(kinds)}. The damping of a column that rocks in three dimensions is not a "
        "material constant and is seldom measured. The yardstick is the damping that loses as much energy per cycle as "
        "the impacts of a planar block by Housner's formula, at three peak tilts. Levels on both sides of it are the "
        "recipe; each verdict is given at all of them."
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


def _rules(assessment: Assessment, tables: Mapping[str, PageTable]) -> list[Part]:
    if "rules-of-practice" not in tables:
        return []
    return [RULES, *shown_tables.rules(assessment, tables["rules-of-practice"])]


def _assumptions(assessment: Assessment) -> PageTable:
    notes = [
        ("inputs, as read" if note.startswith("Warning: ") else "stated by the author", note)
        for note in map(str, assessment.setting["notes"])
    ]
    read_as = headings_in_words(assessment.setting.get("details", {}).get("table_read_as", {}))
    headings = [("table of objects", f"The headings of the table: {read_as}.")] if read_as else []
    return PageTable(("subject", "what is assumed"), [*ASSUMPTIONS, *headings, *notes])


def not_covered(assessment: Assessment) -> PageTable:
    """Tabulate the subjects that the assessment does not cover."""
    return PageTable(
        ("subject", "why it matters"), [*NOT_COVERED, SLIP_AND_FLIGHT[bool(assessment.setting["sliding"])]]
    )


def _repeat(assessment: Assessment) -> PageList:
    """State command, inputs with their SHA-256, versions and options."""
    setting = assessment.setting
    details = setting.get("details", {})
    study, digest = (str(details.get(f"study_{what}", "")) for what in ("file", "sha256"))
    stated = str(details.get("command", "")) or f"stylobate assess {study}"
    command = f"Command: {stated}" if study else "Called from Python: stylobate.earthquakes.assess"
    table = str(details.get("table_file", ""))
    versions = {"stylobate": setting["version"], **setting.get("software", {})}
    options = {"seed of the small variations": setting["seed"], **setting["options"]}
    return PageList(
        [
            command,
            *([f"Study file: {study}, SHA-256 {digest}"] if study and study != table else []),
            *([f"Table of objects: {table}, SHA-256 {details['table_sha256']}"] if table else []),
            f"Versions: {', '.join(f'{name} {value}' for name, value in versions.items())}",
            f"Options: {', '.join(f'{name} {value}' for name, value in options.items())}",
            "Files beside this report: tables/*.csv with every table, tables.xlsx where openpyxl is installed, "
            "figures/*.png, summary.txt, and assessment.nc with all numbers, from which stylobate assess writes this "
            "report again.",
        ]
    )
