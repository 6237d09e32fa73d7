"""The figures of the report with their captions; figures of a column that hardly moved are left out."""

from dataclasses import replace

import numpy as np
from matplotlib.figure import Figure

from stylobate.earthquakes.assessment.report.cases import rises
from stylobate.earthquakes.assessment.report.displacements import SMALLEST_TILT
from stylobate.earthquakes.assessment.report.figures import (
    contact_figure,
    history_figure,
    margins_figure,
    shares_figure,
    tilts_figure,
)
from stylobate.earthquakes.assessment.report.record_figures import RECORDS_A_FIGURE, records_figure, spectra_figure
from stylobate.earthquakes.figures.fragility import plot_fragility
from stylobate.plots.labels import with_literal_names
from stylobate.plots.page import Picture
from stylobate.results.assessment import Assessment

Pictures = dict[str, Picture]


def report_pictures(assessment: Assessment) -> Pictures:
    """Return the pictures by file name; each name begins with the name of the section."""
    drawn = replace(assessment, data={name: with_literal_names(data) for name, data in assessment.data.items()})
    found = _of_records(drawn)
    names = (assessment.data["columns"]["column"], drawn.data["columns"]["column"])
    for place, (name, column) in enumerate(zip(*(one.to_numpy() for one in names), strict=True)):
        found |= _of_column(drawn, str(column), str(name), place + 1)
    return found


def _of_records(assessment: Assessment) -> Pictures:
    if "ground_motions" not in assessment.data:
        return {}
    names = [str(name) for name in assessment.data["ground_motions"]["record"].to_numpy()]
    found = {}
    for first in range(0, len(names), RECORDS_A_FIGURE):
        some = names[first : first + RECORDS_A_FIGURE]
        found[f"records-{first // RECORDS_A_FIGURE + 1}"] = Picture(
            records_figure(assessment, some), "Ground accelerations as recorded (scale 1) along x, y and up."
        )
    design = assessment.setting.get("details", {}).get("design_spectrum")
    over = f" Dashed: {design['name']}, {100.0 * design['damping']:g} % damping." if design else ""
    found["spectra-1"] = Picture(
        spectra_figure(assessment),
        "Pseudo-acceleration spectra of the records and their mean. They are RotD50; the spectrum of a record along "
        f"one axis is that of its component.{over}",
    )
    return found


def _of_column(assessment: Assessment, column: str, called: str, place: int) -> Pictures:
    """Return the pictures of a `column`, which is `called` otherwise outside figures."""
    found = {}
    if bool((assessment.data["margins"]["intervals"].sel(column=column) > 0).any()):
        found[f"margins-{place}"] = Picture(
            margins_figure(assessment, column),
            f"{called}: scale factors of each record at which it overturned (hatched) or did not, at each dissipation. "
            "An interval narrower than the step of the scan may have been missed.",
        )
    if bool((assessment.data["histories"]["peak_tilt_ratio"].sel(column=column) > SMALLEST_TILT).any()):
        found[f"history-{place}"] = Picture(
            history_figure(assessment, column),
            f"{called} under its governing record. Left: tilt and base acceleration against time. Right: path of the "
            "tilt. Dashed: the tipping angle α_c, at which the centre of mass stands above the rim.",
        )
    if bool((assessment.data["verdicts"]["friction_demand"].sel(column=column) > 0.0).any()):
        found[f"contact-{place}"] = Picture(
            contact_figure(assessment, column),
            f"{called}: friction needed in each run. Dashed: the stated coefficient.",
        )
    with_vertical = any(rises(assessment, str(name)) for name in assessment.data["records"]["record"].to_numpy())
    vertical = " (vertical component included)" if with_vertical else ""
    for scale in assessment.setting["scales"]:
        if not _rocked(assessment, column, scale):
            continue
        found[f"tilts-{place}-scale-{scale:g}"] = Picture(
            tilts_figure(assessment, column, scale),
            f"{called} at scale {scale:g}: peak tilts at each dissipation{vertical}, and those of the planar column if "
            "it was computed.",
        )
        if "variations" in assessment.data:
            found[f"variations-{place}-scale-{scale:g}"] = Picture(
                shares_figure(assessment, column, scale),
                f"{called} at scale {scale:g}: share of small variations that overturn it, with its 90 % sampling "
                "interval (bar), and share of the scales within 10 % that do so (marks, one for each case). Between "
                "the dashed limits the case is undecided.",
            )
    if "fragility" in assessment.data:
        found[f"fragility-{place}"] = Picture(_fragility(assessment, column), f"{called}: fragility.")
    return found


def _rocked(assessment: Assessment, column: str, scale: float) -> bool:
    """Return whether any run at a scale tilted the column, or was not decided."""
    runs = assessment.data["verdicts"].sel(column=column, scale=scale)
    return bool(np.any((runs["tilt_ratio"].to_numpy() > SMALLEST_TILT) | (runs["overturned"].to_numpy() != 0)))


def _fragility(assessment: Assessment, column: str) -> Figure:
    return plot_fragility(assessment.data["fragility"].sel(column=column))
