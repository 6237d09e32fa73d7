"""The findings on each column of an assessment, in sentences."""

import math
from collections.abc import Sequence

import numpy as np
import xarray as xr

from stylobate.earthquakes.assessment.report.column_verdict import (
    column_verdict,
    largest_decided,
    least_overturning_scale,
    level_words,
    recorded_scale,
)
from stylobate.earthquakes.assessment.report.tables import margin_intensities
from stylobate.earthquakes.assessment.report.wording import (
    CENTRAL,
    SMALLEST_TILT,
    at_most,
    how_to_read,
    labels,
    number,
    records,
    stated_friction,
    tilt_words,
)
from stylobate.plots.page import PageTable
from stylobate.results.assessment import Assessment
from stylobate.results.verdict import yardstick_text

_APART = 2.0
"""Smallest factor between the highest and the lowest level of damping that tests whether it decides."""


def verdict_table(assessment: Assessment) -> PageTable:
    """Tabulate the verdict on each column in one line, at the scale nearest to 1."""
    rows = []
    for name in labels(assessment.data["columns"], "column"):
        found = column_verdict(assessment, name, recorded_scale(assessment))
        margin = f" {least_overturning_scale(assessment, name)}" if found.describes else ""
        first = found.sentence[0].upper() if found.sentence[0].isascii() else found.sentence[0]
        sentence = f"{first}{found.sentence[1:]}{margin}{_levels_remark(assessment, name)}"
        rows.append((name, found.verdict.value, sentence))
    return PageTable(("column", "verdict", "in one line"), rows)


def column_findings(assessment: Assessment, name: str) -> PageTable:
    """Tabulate the findings on one column, one row for each subject."""
    own = assessment.data["summary"].sel(column=name)
    first = recorded_scale(assessment)
    verdict = column_verdict(assessment, name, first)
    described = verdict.describes
    about = assessment.setting.get("details", {}).get("about_columns", {}).get(name, "")
    subjects = {
        "object": str(about),
        "verdict": f"{verdict.line}{_levels_remark(assessment, name)}",
        f"tilt, {level_words(first)}": _tilt(assessment, name, first) if described else "",
    }
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
    blocks = ["\n".join(_line(table.header, row) for row in table.rows) for table in heads]
    for name in labels(assessment.data["columns"], "column"):
        findings = column_findings(assessment, name)
        blocks.append("\n".join([findings.header[0], *(": ".join(row) for row in findings.rows)]))
    return (
        "\n\n".join([str(assessment.setting["title"]), *blocks, f"How to read this: {how_to_read(assessment)}"]) + "\n"
    )


def _line(header: Sequence[str], row: Sequence[str]) -> str:
    """Write a row as a line: its subject, and the other cells, each with its heading unless it is a verdict."""
    first, *cells = row
    if len(cells) == 1 or header[-1] == "in one line":
        return f"{first}: {'. '.join(cells)}"
    labelled = [cell if name == "verdict" else f"{name} {cell}" for name, cell in zip(header[1:], cells, strict=True)]
    return f"{first}: {'; '.join(labelled)}"


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
        f" With the other contact law some run needs more from scale {number(slipping)} on; the class of the verdict "
        "considers the given law only."
    )


def _damping(assessment: Assessment, name: str) -> str:
    """State the damping that loses as much as Housner's impacts."""
    own = assessment.data["columns"].sel(column=name)
    return f"Housner's impacts lose as much as {yardstick_text(own['housner_damping'].to_numpy())}."


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
