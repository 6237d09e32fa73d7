"""The sections of the report, in order, with their introductory texts."""

from collections.abc import Mapping

from stylobate.earthquakes.assessment.report.record_tables import drifting
from stylobate.earthquakes.assessment.report.summary import column_findings, columns_of, how_to_read
from stylobate.earthquakes.assessment.report.texts import (
    ASSUMPTIONS,
    NOT_COVERED,
    PLANAR,
    REFERENCES,
    SLIP_AND_FLIGHT,
    VERDICT_CLASSES,
)
from stylobate.earthquakes.assessment.report.wording import listed, number, scales
from stylobate.plots.page import Picture, Section, Table
from stylobate.results.assessment import Assessment
from stylobate.results.few_records import few_records

Part = str | Picture | Table


def document_table(assessment: Assessment) -> Table:
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
    return Table(("document", ""), [(name, str(words)) for name, words in lines.items() if words])


def report_sections(
    assessment: Assessment, tables: Mapping[str, Table], pictures: Mapping[str, Picture]
) -> list[Section]:
    """Return the sections of the report that have content."""

    def drawn(name: str) -> list[Part]:
        return [picture for file, picture in pictures.items() if file.startswith(f"{name}-")]

    def shown(*names: str) -> list[Part]:
        return [tables[name] for name in names if name in tables]

    found = [
        Section("Verdicts", [*shown("verdicts"), Table(("class of verdict", "meaning"), VERDICT_CLASSES)]),
        Section(
            "The columns one by one",
            [*(column_findings(assessment, name) for name in columns_of(assessment)), how_to_read(assessment)],
        ),
        Section("Records", [_record_text(assessment), *shown("events"), *drawn("records"), *drawn("spectra")]),
        Section("Intensities of the records", [_intensity_text(assessment), *shown("records", "spectra")]),
        Section(
            "Margins",
            [
                _margin_text(assessment),
                *(*shown("margin-intensities", "governing"), *drawn("margins"), *drawn("history"), *shown("margins")),
            ],
        ),
        Section("Tilt and displacement", [_tilt_text(), *drawn("tilts"), *shown("tilts")]),
        Section(
            "Dissipation and vertical component",
            [_verdict_text(assessment), *shown("summary", "verdicts-by-record")],
        ),
        Section(
            "Contact demand",
            [_contact_text(assessment), *drawn("contact"), *shown("contact-by-record", "contact-to-margin", "sliding")],
        ),
        Section(
            "Small variations and near scales",
            [_variations_text(assessment), *drawn("variations"), *shown("variations", "near-scales")],
        ),
        Section("Comparison with the planar calculation", [*_planar_text(assessment), *shown("planar", "planar-bias")]),
        Section("Fragility", [_fragility_text(assessment), *drawn("fragility"), *shown("fragility")]),
        Section("Columns and damping", [_model_text(assessment), *shown("columns", "dissipation")]),
        Section("Assumptions", [_assumptions(assessment)]),
        Section("What is not covered", [not_covered(assessment)]),
        Section("References", [Table(("subject", "source"), REFERENCES)]),
        Section("Software", [_software(assessment)]),
        Section("Appendix: origin of the records", shown("record-provenance")),
        Section("Appendix: every run at the stated scales, with the given contact law", shown("runs")),
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


def _intensity_text(assessment: Assessment) -> str:
    del assessment
    return (
        "PGA, PGV and Sa (5 % damping) are RotD50: the median, over all horizontal directions, of the peak along a "
        "direction (Boore 2010). For a record along one axis they are the values of that component. “Vector” is the "
        "peak of the horizontal vector, which is never below RotD50. Compare hazard curves and design spectra with "
        "RotD50. A record drifts if its velocity at the end exceeds 5 % of its PGV along x, y or z."
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


def _tilt_text() -> str:
    return (
        "The tipping angle α_c = arctan(r/h) is the tilt at which the centre of mass stands above the rim. The "
        "displacement is horizontal and relative to the base: H sin θ + r (1 − cos θ) for a tilt θ and a point of the "
        "axis at the height H, with the contact point at rest. H is the height of the column, or the height of the "
        "centre of mass if only that is known. The edge of a wide top can move farther."
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


def _planar_text(assessment: Assessment) -> list[str]:
    return list(PLANAR) if "planar" in assessment.data else ["Not computed (planar = false)."]


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


def _model_text(assessment: Assessment) -> str:
    kinds = sorted({str(one["model"].get("kind", "own")) for one in assessment.setting["columns"].values()})
    return (
        f"Equations of motion: {', '.join(kinds)}. The damping of a column that rocks in three dimensions is not a "
        "material constant and is seldom measured. Therefore several levels were stated, and each verdict is given at "
        "all of them. R is the distance from the centre of mass to the rim, p the frequency parameter √(mgR/K) with "
        "the moment of inertia K about the rim."
    )


def _assumptions(assessment: Assessment) -> Table:
    notes = [
        ("records, as read" if note.startswith("Warning: ") else "stated by the author", note)
        for note in map(str, assessment.setting["notes"])
    ]
    return Table(("subject", "what is assumed"), [*ASSUMPTIONS, *notes])


def not_covered(assessment: Assessment) -> Table:
    """Tabulate the subjects that the assessment does not cover."""
    return Table(("subject", "why it matters"), [*NOT_COVERED, SLIP_AND_FLIGHT[bool(assessment.setting["sliding"])]])


def _software(assessment: Assessment) -> str:
    options = ", ".join(f"{name} = {value}" for name, value in assessment.setting["options"].items())
    versions = ", ".join(f"{name} {value}" for name, value in assessment.setting.get("software", {}).items())
    return (
        f"Computed with stylobate {assessment.setting['version']}. "
        + (f"Versions: {versions}. " if versions else "")
        + (f"Options of the runs: {options}. " if options else "")
        + "The file assessment.nc beside this page holds all numbers; stylobate assess writes the page from it again."
    )
