"""Tables of margins: overturning intervals, governing records, friction up to the margin."""

import math

import xarray as xr

from stylobate.earthquakes.assessment.report.cases import acts_in
from stylobate.earthquakes.assessment.report.cells import cells
from stylobate.earthquakes.assessment.report.displacements import tilt_cells
from stylobate.earthquakes.assessment.report.wording import CENTRAL, at_most, degrees, intervals, least_scale, number
from stylobate.plots.page import Table
from stylobate.results.assessment import Assessment


def intervals_by_record(assessment: Assessment) -> Table:
    """Tabulate the overturning intervals of each column, by record and case."""
    own = assessment.data["margins"]
    header = (
        "column",
        "record",
        "case",
        "smallest overturning scale",
        "overturning intervals found",
        "runs not decided",
    )
    rows = [
        (*where, least_scale(one), intervals(one), f"{int(one['unknown'])}")
        for where, one in cells(own, "column", "record", "case")
        if acts_in(assessment, *where[1:])
    ]
    return Table(header, rows)


def governing(assessment: Assessment) -> Table:
    """Tabulate the governing record of each column, and the peak tilt of each run that is drawn."""
    own, runs = assessment.data["summary"], assessment.data["histories"]
    header = (
        *("column", "governing record", "smallest overturning scale", "smallest of all cases, at most"),
        "scale of the run",
        *("peak tilt / α_c", "tilt [°]", "displacement [mm]", "azimuth, from x to y", "time of peak [s]"),
    )
    rows = []
    for column in own["column"].to_numpy():
        one, body = own.sel(column=column), assessment.data["columns"].sel(column=column)
        record = str(one["governing"].item())
        margins = assessment.data["margins"].sel(column=column, case=CENTRAL, record=record)
        first = (str(column), record, least_scale(margins), at_most(float(one["least_of_all"])))
        for scale, run in drawn_runs(runs.sel(column=column)):
            ratio = float(run["peak_tilt_ratio"])
            azimuth = degrees(float(run["azimuth"])) if ratio > 0.0 else "–"
            at = number(float(run["time_of_peak_tilt"]))
            rows.append((*first, number(scale, 4), *tilt_cells(ratio, body), azimuth, at))
    return Table(header, rows)


def drawn_runs(histories: xr.Dataset) -> list[tuple[float, xr.Dataset]]:
    """Return the runs of one column whose histories are drawn, each with the scale of its record."""
    runs = [histories.sel(run=run) for run in histories["run"].to_numpy()]
    return [(float(run["scale"]), run) for run in runs if math.isfinite(float(run["scale"]))]


def friction_to_margin(assessment: Assessment) -> Table:
    """Tabulate the friction needed below the smallest overturning scale, and the smallest scale that needs too much."""
    header = (
        *("column", "record", "case", "smallest overturning scale", "friction needed below it"),
        *("stated friction", "smallest scale run that needs more"),
    )
    margins, rows = assessment.data["margins"], []
    for where, one in cells(margins, "column", "record", "case") if assessment.setting["contact"] else ():
        need, slipping = (float(one[name]) for name in ("friction_to_margin", "least_slipping"))
        if not acts_in(assessment, *where[1:]) or (math.isnan(need) and math.isnan(slipping)):
            continue
        stated = float(assessment.setting["friction_coefficient"][where[0]])
        first = "none that was run" if math.isnan(slipping) else number(slipping)
        rows.append((*where, least_scale(one), number(need), number(stated), first))
    return Table(header, rows)
