"""The tables of an assessment, for the report and for files."""

import math
from collections.abc import Callable

from stylobate.earthquakes.assessment.report import margin_tables, record_tables, run_tables
from stylobate.earthquakes.assessment.report.cells import cells
from stylobate.earthquakes.assessment.report.displacements import TILT_HEADER, shown_point, tilt_cells
from stylobate.earthquakes.assessment.report.wording import number
from stylobate.plots.page import Table
from stylobate.results.assessment import Assessment


def assessment_tables(assessment: Assessment) -> dict[str, Table]:
    """Format all tables of an assessment, by name."""
    made = {name: make(assessment) for name, make in _TABLES.items()}
    return {name: table for name, table in made.items() if table.rows}


def _columns(assessment: Assessment) -> Table:
    header = (
        *("column", "radius [m]", "height [m]", "centre of mass [m]", "mass [kg]", "c = r/h", "α_c [°]", "R [m]"),
        *("p [1/s]", "rocks above [m/s²]", "stated friction", "displaced point"),
    )
    names = (
        *("radius", "height", "mass_height", "mass", "slenderness", "tipping_angle", "rim_distance"),
        *("frequency_parameter", "uplift_acceleration", "friction_coefficient"),
    )
    rows = []
    for where, one in cells(assessment.data["columns"], "column"):
        values = {name: float(one[name]) for name in names}
        values["tipping_angle"] = math.degrees(values["tipping_angle"])
        rows.append((*where, *(number(value, 4) for value in values.values()), shown_point(one)[1]))
    return Table(header, rows)


def _summary(assessment: Assessment) -> Table:
    own = assessment.data["summary"]
    names = ("stood", "overturned", "undecided", "overturned_in_some", "on_dissipation", "on_vertical")
    optional = {
        "overturned_other_law": "overturned it with the other contact law",
        "in_band": "overturned it within 10 % of the scale",
        "variations_disagree": "small variations disagree",
        "undecided_word": "undecided under small variations",
        "planar_differs": "planar verdict differs",
    }
    optional = {name: words for name, words in optional.items() if name in own}
    header = (
        *("column", "scale", "did not overturn it", "overturned it", "not decided", "overturned it in some case"),
        *("verdict depends on dissipation", "verdict depends on vertical component", *optional.values()),
        *(f"peak {name}" for name in TILT_HEADER),
        "largest friction needed",
    )
    rows = []
    for where, one in cells(own, "column", "scale"):
        counts = (f"{int(one[name])}" for name in (*names, *optional))
        tilted = tilt_cells(float(one["peak_tilt_ratio"]), assessment.data["columns"].sel(column=where[0]))
        rows.append((*where, *counts, *tilted, number(float(one["friction_demand"]))))
    return Table(header, rows)


def _fragility(assessment: Assessment) -> Table:
    header = (
        *("column", "limit state", "median PGA, RotD50 [m/s²]", "median from", "median to", "dispersion β_f"),
        *("β_f from", "β_f to", "runs", "runs that reached it", "records with survival above an overturning scale"),
    )
    if "fragility" not in assessment.data:
        return Table(header, [])
    numbers = ("median", "median_low", "median_high", "dispersion", "dispersion_low", "dispersion_high")
    rows = []
    for where, one in cells(assessment.data["fragility"], "column", "limit_state"):
        counts = (f"{int(one[name])}" for name in ("runs", "runs_reached", "non_monotone_records"))
        column, state = where
        rows.append((column, _limit_state(state), *(number(float(one[name])) for name in numbers), *counts))
    return Table(header, rows)


def _limit_state(name: str) -> str:
    """Return a limit state such as "tilt 0.5 α" with the symbol α_c of the report."""
    return name.replace("α", "α_c")


def _dissipation(assessment: Assessment) -> Table:
    rows = [
        (column, level, name, number(value, 4))
        for column, levels in assessment.setting["dissipation"].items()
        for level, numbers in levels.items()
        for name, value in numbers.items()
    ]
    own = assessment.data["columns"]
    rows += [
        (str(column), f"Housner's impacts at {amplitude:g} α_c", "damping", number(float(value), 3))
        for column in own["column"].to_numpy()
        for amplitude, value in zip(
            own["amplitude"].to_numpy(), own["housner_damping"].sel(column=column).to_numpy(), strict=True
        )
    ]
    return Table(("column", "level", "parameter of the model", "value"), rows)


_TABLES: dict[str, Callable[[Assessment], Table]] = {
    "verdicts": run_tables.verdicts,
    "summary": _summary,
    "events": record_tables.events,
    "records": record_tables.intensities,
    "spectra": record_tables.spectra,
    "margin-intensities": record_tables.margin_intensities,
    "governing": margin_tables.governing,
    "margins": margin_tables.intervals_by_record,
    "tilts": run_tables.tilts,
    "verdicts-by-record": run_tables.verdicts_by_record,
    "contact-by-record": run_tables.friction_by_record,
    "contact-to-margin": margin_tables.friction_to_margin,
    "sliding": run_tables.sliding,
    "variations": run_tables.small_variations,
    "near-scales": run_tables.near_scales,
    "planar": run_tables.planar,
    "planar-bias": run_tables.planar_bias,
    "fragility": _fragility,
    "columns": _columns,
    "dissipation": _dissipation,
    "record-provenance": record_tables.provenance,
    "runs": run_tables.every_run,
}
