"""The tables of an assessment: the same in the report and as files."""

import math
from collections.abc import Callable, Iterator

import numpy as np
import xarray as xr

from stylobate.plots.assessment.wording import CENTRAL, bands, degrees, least_scale, number, tilt, verdict
from stylobate.plots.page import Table
from stylobate.results.assessment import Assessment

_VERTICAL = {"with": "yes", "without": "no"}


def assessment_tables(assessment: Assessment) -> dict[str, Table]:
    """Return the tables by name: all numbers that the report tells, as text."""
    made = {name: make(assessment) for name, make in _TABLES.items()}
    return {name: table for name, table in made.items() if table.rows}


def _names(data: xr.Dataset, dim: str) -> list[str]:
    return [str(name) for name in data[dim].to_numpy()]


def _columns(assessment: Assessment) -> Table:
    header = (
        *("column", "radius [m]", "height [m]", "mass centre [m]", "mass [kg]", "c = r/h", "α [°]", "R [m]", "p [1/s]"),
        *("rocks above [m/s²]", "stated friction"),
    )
    own = assessment.data["columns"]
    names = (
        *("radius", "height", "mass_height", "mass", "slenderness", "tipping_angle", "rim_distance"),
        *("frequency_parameter", "uplift_acceleration", "friction_coefficient"),
    )
    rows = []
    for column in _names(own, "column"):
        values = {name: float(own[name].sel(column=column)) for name in names}
        values["tipping_angle"] = math.degrees(values["tipping_angle"])
        rows.append((column, *(number(value, 4) for value in values.values())))
    return Table(header, rows)


def _records(assessment: Assessment) -> Table:
    header = (
        "record",
        "PGA [m/s²]",
        "along x",
        "along y",
        "up",
        "PGV [m/s]",
        "length [s]",
        "step [s]",
        "velocity left [m/s]",
    )
    own = assessment.data["records"]
    names = (
        *("peak_acceleration", *(f"peak_acceleration_{axis}" for axis in "xyz")),
        *("peak_velocity", "length", "step", "residual_velocity"),
    )
    return Table(
        header,
        [(name, *(number(float(own[one].sel(record=name))) for one in names)) for name in _names(own, "record")],
    )


def _provenance(assessment: Assessment) -> Table:
    rows = []
    for name, record in assessment.setting["records"].items():
        rows += [(name, f"{place + 1}. {line}") for place, line in enumerate(record["processing"])]
        rows += [
            (name, f"SHA-256 of {path}: {digest}") for path, digest in record["motion"].get("file_sha256", {}).items()
        ]
        if record["digest"]:
            rows.append((name, f"SHA-256 of its numbers: {record['digest']}"))
    return Table(("record", "where it comes from, and what was done"), rows)


def _summary(assessment: Assessment) -> Table:
    own = assessment.data["summary"]
    names = ("stood", "overturned", "undecided", "overturned_in_some", "on_dissipation", "on_vertical")
    optional = tuple(name for name in ("not_robust", "planar_differs") if name in own)
    told = {"not_robust": "flip under small changes", "planar_differs": "planar column differs"}
    header = (
        *(
            "column",
            "scale",
            "did not overturn it",
            "overturned it",
            "not decided",
            "overturned it in some run",
        ),
        *("depend on dissipation", "depend on vertical", *(told[name] for name in optional)),
        *("largest tilt / α", "largest friction needed"),
    )
    rows = [
        (
            column,
            f"{scale:g}",
            *(f"{int(own[name].sel(column=column, scale=scale))}" for name in (*names, *optional)),
            tilt(float(own["largest_tilt_ratio"].sel(column=column, scale=scale))),
            number(float(own["friction_demand"].sel(column=column, scale=scale))),
        )
        for column in _names(own, "column")
        for scale in own["scale"].to_numpy()
    ]
    return Table(header, rows)


def _margins(assessment: Assessment) -> Table:
    own = assessment.data["margins"]
    header = (
        "column",
        "record",
        "case of dissipation",
        "least scale that overturned",
        "bands found that overturned",
        "runs not told",
    )
    rows = []
    for column in _names(own, "column"):
        for record in _names(own, "record"):
            for case in _names(own, "case"):
                one = own.sel(column=column, record=record, case=case)
                rows.append((column, record, case, least_scale(one), bands(one), f"{int(one['unknown'])}"))
    return Table(header, rows)


def _verdicts_by_record(assessment: Assessment) -> Table:
    own = assessment.data["verdicts"]
    levels, acting = _names(own, "dissipation"), _names(own, "vertical")
    cases = [(level, acts) for acts in acting for level in levels if acts == "with" or level == CENTRAL]
    header = (
        "column",
        "record",
        "scale",
        *(level if acts == "with" else f"{level}, no vertical" for level, acts in cases),
    )
    rows = []
    for column in _names(own, "column"):
        for record in _names(own, "record"):
            for scale in own["scale"].to_numpy():
                runs = own["overturned"].sel(column=column, record=record, scale=scale)
                said = (verdict(float(runs.sel(dissipation=level, vertical=acts))) for level, acts in cases)
                rows.append((column, record, f"{scale:g}", *said))
    return Table(header, rows)


def _contact_by_record(assessment: Assessment) -> Table:
    header = ("column", "record", "scale", "largest friction needed", "stated", "enough")
    own = assessment.data["summary"]["friction_by_record"]
    rows = []
    for column in _names(assessment.data["columns"], "column"):
        stated = float(assessment.setting["friction_coefficient"][column])
        for record in _names(assessment.data["records"], "record"):
            for scale in own["scale"].to_numpy():
                need = float(own.sel(column=column, record=record, scale=scale))
                told = "–" if math.isnan(need) else "yes" if need <= stated else "no"
                rows.append((column, record, f"{scale:g}", number(need), number(stated), told))
    return Table(header, rows if assessment.setting["contact"] else [])


def _contact_to_margin(assessment: Assessment) -> Table:
    header = (
        *("column", "record", "case of dissipation", "least scale that overturned", "friction needed below it"),
        *("stated", "least scale that needs more"),
    )
    own = assessment.data["margins"]
    rows = []
    for column in _names(own, "column") if assessment.setting["contact"] else []:
        stated = float(assessment.setting["friction_coefficient"][column])
        for record in _names(own, "record"):
            for case in _names(own, "case"):
                one = own.sel(column=column, record=record, case=case)
                need, slipping = (float(one[name]) for name in ("friction_to_margin", "least_slipping"))
                if math.isnan(need) and math.isnan(slipping):
                    continue
                first = "none that was run" if math.isnan(slipping) else number(slipping, 4)
                rows.append((column, record, case, least_scale(one), number(need), number(stated), first))
    return Table(header, rows)


def _verdicts(assessment: Assessment) -> Table:
    header = ("column", "record", "scale", "dissipation", "vertical", "verdict", "largest tilt / α")
    return Table(
        header,
        [
            (*where, verdict(float(one["overturned"])), tilt(float(one["tilt_ratio"])))
            for where, one in _runs(assessment.data["verdicts"])
        ],
    )


def _contact(assessment: Assessment) -> Table:
    header = (
        *("column", "record", "scale", "dissipation", "vertical", "friction needed", "stated", "enough"),
        *("pivoting moment / (N r)", "least normal force / weight"),
    )
    rows = []
    for where, one in _runs(assessment.data["verdicts"]):
        need, stated = float(one["friction_demand"]), float(assessment.setting["friction_coefficient"][where[0]])
        if math.isnan(need):
            continue
        more = (number(float(one["pivoting_demand"])), number(float(one["least_normal_force"])))
        rows.append((*where, number(need), number(stated), "yes" if need <= stated else "no", *more))
    return Table(header, rows)


def _runs(verdicts: xr.Dataset) -> Iterator[tuple[tuple[str, ...], xr.Dataset]]:
    for column in _names(verdicts, "column"):
        for record in _names(verdicts, "record"):
            for scale in verdicts["scale"].to_numpy():
                for level in _names(verdicts, "dissipation"):
                    for acts in _names(verdicts, "vertical"):
                        one = verdicts.sel(column=column, record=record, scale=scale, dissipation=level, vertical=acts)
                        yield (column, record, f"{scale:g}", level, _VERTICAL[acts]), one


def _governing(assessment: Assessment) -> Table:
    own, runs = assessment.data["summary"], assessment.data["histories"]
    header = (
        *("column", "governing record", "least scale that overturned", "least of all cases"),
        *("largest tilt / α there", "azimuth of it, from x to y", "at [s]"),
    )
    rows = []
    for column in _names(own, "column"):
        one, run = own.sel(column=column), runs.sel(column=column)
        margins = assessment.data["margins"].sel(column=column, case=CENTRAL, record=str(one["governing"].item()))
        rows.append(
            (
                column,
                str(one["governing"].item()),
                least_scale(margins),
                number(float(one["least_of_all"]), 4),
                tilt(float(run["largest_tilt_ratio"])),
                degrees(float(run["azimuth"])) if float(run["largest_tilt_ratio"]) > 0.0 else "–",
                number(float(run["time_of_largest_tilt"])),
            )
        )
    return Table(header, rows)


def _robustness(assessment: Assessment) -> Table:
    header = (
        "column",
        "record",
        "scale",
        "verdict",
        "changes that flip it",
        "changes tried",
        "tilt / α from",
        "to",
        "which flip it",
    )
    if "robustness" not in assessment.data:
        return Table(header, [])
    own, verdicts = assessment.data["robustness"], assessment.data["verdicts"]
    changes = np.array(_names(own, "change"))
    rows = []
    for column in _names(own, "column"):
        for record in _names(own, "record"):
            for scale in own["scale"].to_numpy():
                one = own.sel(column=column, record=record, scale=scale)
                state = verdicts["overturned"].sel(
                    column=column, record=record, scale=scale, dissipation=CENTRAL, vertical="with"
                )
                flipping = ", ".join(changes[one["flips"].to_numpy() == 1]) or "none"
                ends = (tilt(float(one[f"tilt_ratio_{end}"])) for end in ("low", "high"))
                counts = (f"{int(one['flipped'])}", f"{int(one['compared'])}")
                rows.append((column, record, f"{scale:g}", verdict(float(state)), *counts, *ends, flipping))
    return Table(header, rows)


def _planar(assessment: Assessment) -> Table:
    header = (
        "column",
        "record",
        "scale",
        "in space",
        "largest tilt / α",
        "planar (worse component)",
        "largest tilt / α",
    )
    if "planar" not in assessment.data:
        return Table(header, [])
    own, verdicts = assessment.data["planar"], assessment.data["verdicts"].sel(dissipation=CENTRAL, vertical="with")
    rows = []
    for column in _names(own, "column"):
        for record in _names(own, "record"):
            for scale in own["scale"].to_numpy():
                place = {"column": column, "record": record, "scale": scale}
                space, flat = verdicts.sel(place), float(own["planar_tilt_ratio"].sel(place))
                planar = "not decided" if math.isnan(flat) else verdict(float(math.isinf(flat)))
                said = verdict(float(space["overturned"]))
                rows.append((column, record, f"{scale:g}", said, tilt(float(space["tilt_ratio"])), planar, tilt(flat)))
    return Table(header, rows)


def _bias(assessment: Assessment) -> Table:
    header = (
        "column",
        "scale",
        "mean ln(tilt in space / planar)",
        "standard error",
        "records compared",
        "overturn in space only",
        "planar only",
    )
    if "planar" not in assessment.data:
        return Table(header, [])
    own = assessment.data["planar"]
    rows = []
    for column in _names(own, "column"):
        for scale in own["scale"].to_numpy():
            one = own.sel(column=column, scale=scale)
            counts = (f"{int(one[name])}" for name in ("compared", "only_space", "only_planar"))
            bias = float(one["bias"])
            told = "too few records" if math.isnan(bias) else number(bias)
            rows.append((column, f"{scale:g}", told, number(float(one["standard_error"])), *counts))
    return Table(header, rows)


def _fragility(assessment: Assessment) -> Table:
    header = (
        "column",
        "limit state",
        "median PGA [m/s²]",
        "from",
        "to",
        "dispersion β",
        "from",
        "to",
        "runs",
        "reached",
        "records safe again",
    )
    if "fragility" not in assessment.data:
        return Table(header, [])
    own = assessment.data["fragility"]
    numbers = ("median", "median_low", "median_high", "dispersion", "dispersion_low", "dispersion_high")
    rows = []
    for column in _names(own, "column"):
        for state in _names(own, "limit_state"):
            one = own.sel(column=column, limit_state=state)
            counts = (f"{int(one[name])}" for name in ("runs", "runs_reached", "non_monotone_records"))
            rows.append((column, state, *(number(float(one[name])) for name in numbers), *counts))
    return Table(header, rows)


def _dissipation(assessment: Assessment) -> Table:
    rows = [
        (level, name, number(value, 4))
        for level, numbers in assessment.setting["dissipation"].items()
        for name, value in numbers.items()
    ]
    return Table(("level", "number of the model", "value"), rows)


_TABLES: dict[str, Callable[[Assessment], Table]] = {
    "summary": _summary,
    "governing": _governing,
    "margins": _margins,
    "verdicts-by-record": _verdicts_by_record,
    "verdicts": _verdicts,
    "contact-by-record": _contact_by_record,
    "contact-to-margin": _contact_to_margin,
    "contact": _contact,
    "robustness": _robustness,
    "planar": _planar,
    "planar-bias": _bias,
    "fragility": _fragility,
    "columns": _columns,
    "dissipation": _dissipation,
    "records": _records,
    "record-provenance": _provenance,
}
