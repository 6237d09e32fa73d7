"""The tables of an assessment, for the report and for files."""

import math
import re
from collections.abc import Callable, Iterator

import numpy as np
import xarray as xr

from stylobate.earthquakes.assessment.report.column_verdict import (
    NO_COMPONENT,
    acts_in,
    case_name,
    cases_of,
    column_verdict,
    largest_decided,
    rises,
    slides_at,
)
from stylobate.earthquakes.assessment.report.rate_tables import fragility_table, rate_table
from stylobate.earthquakes.assessment.report.sliding_tables import limit_table, slip_summary_table, slip_table
from stylobate.earthquakes.assessment.report.wording import (
    CENTRAL,
    TILT_HEADER,
    TOO_FEW,
    at_most,
    cells,
    cells_of,
    counts,
    degrees,
    in_g,
    intervals,
    labels,
    least_scale,
    listed,
    near_share,
    number,
    numbers,
    shown_point,
    stated_friction,
    tilt,
    tilt_cells,
    verdict,
)
from stylobate.plots.page import PageTable
from stylobate.results.assessment import Assessment
from stylobate.results.verdict import LABELS, interval_text, percent

_ACTS = "with"
_PLACES = ("column", "record", "scale")
# The damping of the spectra of the records.
_DAMPING = 0.05
# If there are more records, the table of spectra has only the smallest and the largest value.
_FEW = 6
_SHOWN_PERIODS = (0.1, 0.2, 0.3, 0.5, 1.0, 2.0, 3.0)
# Provenance line of a record file: its name, its unit, and the title in its header.
_READ = re.compile(r"read from (?P<file>.+?), in [^:]+(?:: (?P<title>.+))?")


def _verdicts(assessment: Assessment) -> PageTable:
    """Tabulate the class of each verdict, and the records that decide it."""
    header = (
        *("column", "scale", "verdict", "overturned it (central dissipation)", "only at another dissipation"),
        *("only with the other contact law", "only without the vertical component"),
        *("overturned it within 10 % of the scale", "overturned it in some small variations"),
        *("small variation not decided", "not decided", "more friction needed than stated, given contact law"),
    )
    rows = []
    for column, scale in _columns_and_scales(assessment):
        cases = cases_of(assessment, column, scale)
        at_other, with_other_law, without = (
            [f"{name} ({listed(levels, 'and')})" for name, levels in one.items()]
            for one in (cases.at_other_dissipation, cases.with_other_law, cases.without_vertical)
        )
        in_band = [f"{name} ({near_share(share)})" for name, share in cases.in_band.items()]
        varied = [f"{name} ({percent(share)})" for name, share in cases.varied.items()]
        undecided = (*cases.undecided, *cases.undecided_elsewhere)
        nearby = (in_band, varied, cases.variations_open)
        names = (cases.overturned, at_other, with_other_law, without, *nearby, undecided, tuple(cases.slipping))
        label = column_verdict(assessment, column, scale).verdict.value
        rows.append((column, f"{scale:g}", label, *(", ".join(one) or "none" for one in names)))
    return PageTable(header, rows)


def _summary(assessment: Assessment) -> PageTable:
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
        if slides_at(assessment, where[0], float(where[1])):  # runs without slip do not describe it
            rows.append((*where, *(["slides"] * (len(header) - 2))))
            continue
        tilted = tilt_cells(float(one["peak_tilt_ratio"]), assessment.data["columns"].sel(column=where[0]))
        rows.append((*where, *counts(one, *names, *optional), *tilted, number(float(one["friction_demand"]))))
    return PageTable(header, rows)


def _events(assessment: Assessment) -> PageTable:
    """Tabulate event, station and files of each record."""
    about = assessment.setting.get("details", {}).get("about_records", {})
    rows = []
    for name in labels(assessment.data["records"]):
        lines = assessment.setting["records"][name]["processing"]
        read = [found for found in map(_READ.fullmatch, lines) if found]
        titles = list(dict.fromkeys(_without_component(found["title"]) for found in read if found["title"]))
        if not titles and lines and not _READ.fullmatch(lines[0]):
            titles = lines[:1]
        stated = [str(about[name])] if name in about else []
        rows.append((name, "; ".join([*stated, *titles]) or "–", ", ".join(found["file"] for found in read) or "–"))
    return PageTable(("record", "event and station, as stated and in the files", "files"), rows)


def _without_component(title: str) -> str:
    """Remove the last field of a title that has several: "event, date, station, component"."""
    return title.rpartition(",")[0] if title.count(",") > 1 else title


def _intensities(assessment: Assessment) -> PageTable:
    """Tabulate the intensities of each record as recorded."""
    own, period = assessment.data["records"], spectral_period(assessment)
    spectral = spectral_accelerations(assessment)
    header = (
        *("record", "definition", "PGA [g]", "PGA [m/s²]", "PGV [m/s]", f"Sa({period:g} s) [g]", "PGA, vector [g]"),
        *("PGA along x [g]", "PGA along y [g]", "PGA up [g]", "PGV, vector [m/s]", "duration [s]", "step [s]"),
        *("velocity at the end [m/s]", "drift"),
    )
    rows = []
    for name in labels(assessment.data["records"]):
        one = own.sel(record=name)
        in_g_too = [f"peak_acceleration{which}" for which in ("", "_x", "_y", "_z")]
        rows.append(
            (
                name,
                str(one["definition"].item()),
                in_g(float(one["median_peak_acceleration"])),
                *numbers(one, "median_peak_acceleration", "median_peak_velocity"),
                in_g(spectral.get(name, math.nan)),
                *(in_g(float(one[which])) for which in in_g_too[:-1]),
                in_g(float(one[in_g_too[-1]])) if rises(assessment, name) else NO_COMPONENT,
                *numbers(one, "peak_velocity", "length", "step", "residual_velocity"),
                "yes" if name in drifting(assessment) else "no",
            )
        )
    return PageTable(header, rows)


def _spectra(assessment: Assessment) -> PageTable:
    """Tabulate spectral accelerations of the records at some periods, their mean and the design spectrum.

    The spectra of the records have 5 % damping: their mean is divided only by a design spectrum of the same damping.
    """
    if "spectra" not in assessment.data:
        return PageTable((), [])
    own = assessment.data["spectra"]["spectral_acceleration"]
    design = assessment.setting.get("details", {}).get("design_spectrum")
    alike = design is not None and math.isclose(design["damping"], _DAMPING)
    each = labels(assessment.data["records"]) if own.sizes["record"] <= _FEW else ["smallest", "largest"]
    header = ["period [s]", *(f"{name} [g]" for name in each), "mean [g]"]
    header += [f"{design['name']} [g]", "mean / design"] if design else []
    rows = []
    for period in sorted({*_SHOWN_PERIODS, spectral_period(assessment)}):
        values = np.array([_at(own.sel(record=name), period) for name in labels(assessment.data["records"])])
        shown = values if len(each) == values.size else (values.min(), values.max())
        row = [f"{period:g}", *map(in_g, shown), in_g(values.mean())]
        if design:
            inside = design["period"][0] <= period <= design["period"][-1]
            aim = float(np.interp(period, design["period"], design["acceleration"])) if inside else math.nan
            row += [in_g(aim), number(values.mean() / aim) if aim and alike else "–"]
        rows.append(tuple(row))
    return PageTable(tuple(header), rows)


def margin_intensities(assessment: Assessment) -> PageTable:
    """Tabulate PGA, PGV and Sa of each record times the smallest overturning scale of a column.

    One row has the smallest scale of the central case; another has the smallest scale of all cases if that is smaller.
    """
    period = spectral_period(assessment)
    header = (
        *(
            "column",
            "record",
            "governs",
            "case",
            "smallest overturning scale, at most",
            "definition",
            "PGA [g]",
            "PGA [m/s²]",
        ),
        *("PGV [m/s]", f"Sa({period:g} s) [g]", f"Sa({period:g} s) [m/s²]", "PGA, vector [g]"),
    )
    least = assessment.data["margins"]["least_overturning"]
    rows = []
    for column in assessment.data["columns"]["column"].to_numpy():
        governing = str(assessment.data["summary"]["governing"].sel(column=column).item())
        for name in labels(assessment.data["records"]):
            one = least.sel(column=column, record=name)
            scales = {CENTRAL: float(one.sel(case=CENTRAL))}
            if bool(one.min() < scales[CENTRAL]) or (math.isnan(scales[CENTRAL]) and bool(one.notnull().any())):
                scales[str(one["case"].to_numpy()[np.nanargmin(one.to_numpy())])] = float(one.min())
            for case, scale in scales.items():
                where = (str(column), name, "yes" if name == governing else "", case)
                highest = largest_decided(assessment, str(column), name, case)
                rows.append((*where, *_at_scale(assessment, name, scale, highest)))
    return PageTable(header, rows)


def _at_scale(assessment: Assessment, record: str, scale: float, highest: float) -> tuple[str, ...]:
    """Return the cells of a record times a scale; if that is NaN, times the highest decided scale, marked with ">"."""
    own = assessment.data["records"].sel(record=record)
    above = "> " if math.isnan(scale) and not math.isnan(highest) else ""
    scale = highest if math.isnan(scale) else scale
    peak, velocity = (scale * float(own[f"median_peak_{what}"]) for what in ("acceleration", "velocity"))
    spectral = scale * spectral_accelerations(assessment).get(record, math.nan)
    vector = scale * float(own["peak_acceleration"])
    shown = (in_g(peak), number(peak), number(velocity), in_g(spectral), number(spectral), in_g(vector))
    stated = f"{above}{number(scale, 4)}" if above else at_most(scale)
    return (stated, str(own["definition"].item()), *(f"{above}{value}" for value in shown))


def _governing(assessment: Assessment) -> PageTable:
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
        for scale, run in _drawn_runs(runs.sel(column=column)):
            ratio = float(run["peak_tilt_ratio"])
            azimuth = degrees(float(run["azimuth"])) if ratio > 0.0 else "–"
            at = number(float(run["time_of_peak_tilt"]))
            rows.append((*first, number(scale, 4), *tilt_cells(ratio, body), azimuth, at))
    return PageTable(header, rows)


def _drawn_runs(histories: xr.Dataset) -> list[tuple[float, xr.Dataset]]:
    """Return the runs of one column whose histories are drawn, each with the scale of its record."""
    runs = [histories.sel(run=run) for run in histories["run"].to_numpy()]
    return [(float(run["scale"]), run) for run in runs if math.isfinite(float(run["scale"]))]


def _intervals_by_record(assessment: Assessment) -> PageTable:
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
    return PageTable(header, rows)


def _tilts(assessment: Assessment) -> PageTable:
    """Tabulate the peak tilts by record: at the central dissipation, and the largest of all cases."""
    header = (
        *("column", "record", "scale", *(f"{name}, central" for name in TILT_HEADER)),
        *(*(f"{name}, largest of all cases" for name in TILT_HEADER), "displaced point"),
    )
    rows = []
    for where, one in cells(assessment.data["verdicts"], *_PLACES):
        body = assessment.data["columns"].sel(column=where[0])
        central = tilt_cells(float(one["tilt_ratio"].sel(dissipation=CENTRAL, vertical=_ACTS)), body)
        rows.append((*where, *central, *tilt_cells(float(one["tilt_ratio"].max()), body), shown_point(body)[1]))
    return PageTable(header, rows)


def _verdicts_by_record(assessment: Assessment) -> PageTable:
    """Tabulate the outcome under each record at each dissipation, with and without the vertical component."""
    own = assessment.data["verdicts"]
    levels, acting = (own[dim].to_numpy() for dim in ("dissipation", "vertical"))
    cases = [(level, acts) for acts in acting for level in levels if acts == _ACTS or level == CENTRAL]
    header = (*_PLACES, *(case_name(str(level), str(acts)) for level, acts in cases))
    rows = [
        (*where, *(verdict(float(runs["overturned"].sel(dissipation=level, vertical=acts))) for level, acts in cases))
        for where, runs in cells(own, *_PLACES)
    ]
    return PageTable(header, rows)


def _friction_by_record(assessment: Assessment) -> PageTable:
    """Tabulate the largest friction that the runs under each record needed."""
    header, rows = (*_PLACES, "largest friction needed, given contact law", "stated friction", "sufficient"), []
    for where, one in cells(assessment.data["summary"], *_PLACES) if assessment.setting["contact"] else ():
        need, stated = float(one["friction_by_record"]), stated_friction(assessment, where[0])
        rows.append((*where, number(need), number(stated), _enough(need, stated)))
    return PageTable(header, rows)


def _enough(need: float, stated: float) -> str:
    return "–" if math.isnan(need) else "yes" if need <= stated else "no"


def _friction_to_margin(assessment: Assessment) -> PageTable:
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
        stated = stated_friction(assessment, where[0])
        first = "none that was run" if math.isnan(slipping) else number(slipping)
        rows.append((*where, least_scale(one), number(need), number(stated), first))
    return PageTable(header, rows)


def _small_variations(assessment: Assessment) -> PageTable:
    """Tabulate the share of small variations that overturn each column, and the word that follows from it."""
    header = (
        *("column", "record", "scale", "under small variations", "share that overturns it", "90 % sampling interval"),
        *("by contact law", "decided most by", "not decided", "median tilt / α_c", "95 % of tilts / α_c below"),
    )
    rows = []
    for where, one in cells_of(assessment, "variations", *_PLACES):
        low, high = (float(one[f"share_{end}"]) for end in ("low", "high"))
        laws = zip(one["contact_law"].to_numpy(), one["law_share"].to_numpy(), strict=True)
        deciding = str(one["deciding"].item())
        rows.append(
            (
                *(*where, str(one["word"].item()), percent(float(one["share"])), interval_text(low, high)),
                ", ".join(f"{law} {percent(float(share))}" for law, share in laws),
                LABELS.get(deciding, deciding) or "none alone",
                f"{int(one['open'])} of {int(one['runs'])}",
                *(tilt(float(one[f"tilt_ratio_{end}"])) for end in ("median", "high")),
            )
        )
    return PageTable(header, rows)


def _near_scales(assessment: Assessment) -> PageTable:
    """Tabulate the share of overturning scales within 10 % of each stated scale, by case."""
    own = assessment.data["margins"][["band_share"]]
    cases = labels(own, "case")
    rows = [
        (*where, *(percent(float(one["band_share"].sel(case=case))) for case in cases))
        for where, one in cells(own, *_PLACES)
    ]
    return PageTable((*_PLACES, *cases), rows)


def _planar(assessment: Assessment) -> PageTable:
    """Tabulate the verdicts in three dimensions beside those of the planar column."""
    header = (
        *("column", "record", "scale", "three-dimensional", "peak tilt / α_c", "planar (worse component)"),
        "planar peak tilt / α_c",
    )
    if "planar" not in assessment.data:
        return PageTable(header, [])
    spatial = assessment.data["verdicts"].sel(dissipation=CENTRAL, vertical=_ACTS)
    runs = spatial.assign(planar_tilt_ratio=assessment.data["planar"]["planar_tilt_ratio"])
    rows = []
    for where, run in cells(runs, *_PLACES):
        flat = float(run["planar_tilt_ratio"])
        state = "not decided" if math.isnan(flat) else verdict(float(math.isinf(flat)))
        rows.append((*where, verdict(float(run["overturned"])), tilt(float(run["tilt_ratio"])), state, tilt(flat)))
    return PageTable(header, rows)


def _planar_bias(assessment: Assessment) -> PageTable:
    """Tabulate the mean logarithm of the tilts in three dimensions over those of the planar column."""
    header = (
        *("column", "scale", "mean ln(tilt in three dimensions / planar)", "standard error", "records compared"),
        *("overturned in three dimensions only", "overturned in the planar calculation only"),
    )
    rows = []
    for where, one in cells_of(assessment, "planar", "column", "scale"):
        mean = float(one["bias"])
        words = TOO_FEW if math.isnan(mean) else number(mean)
        compared = counts(one, "compared", "only_space", "only_planar")
        rows.append((*where, words, *numbers(one, "standard_error"), *compared))
    return PageTable(header, rows)


def _practice(assessment: Assessment) -> PageTable:
    """Count the answers of each rule of practice over the records, and the central verdicts that contradict them."""
    header = (
        *("column", "scale", "rule", "records called unsafe", "of these it survives", "records called safe"),
        *("of these it overturns", "clause", "clause checked"),
    )
    if "practice" not in assessment.data:
        return PageTable(header, [])
    overturned = assessment.data["verdicts"]["overturned"].sel(dissipation=CENTRAL, vertical=_ACTS)
    rows = []
    for where, one in cells(assessment.data["practice"].assign(overturned=overturned), "column", "scale", "rule"):
        safe, state = one["safe"].to_numpy().astype(bool), one["overturned"].to_numpy()
        found = (~safe, ~safe & (state == 0), safe, safe & (state == 1))
        checked = "yes" if one["checked"] else "no"
        rows.append((*where, *(str(int(records.sum())) for records in found), str(one["clause"].item()), checked))
    return PageTable(header, rows)


def _columns(assessment: Assessment) -> PageTable:
    header = (
        *("column", "radius [m]", "height [m]", "centre of mass [m]", "mass [kg]", "mass / (π r² height) [kg/m³]"),
        *("c = r/h", "α_c [°]", "R [m]"),
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
        shown = [number(value, 4) for value in values.values()]
        density = values["mass"] / (math.pi * values["radius"] ** 2 * values["height"])
        rows.append((*where, *shown[:4], number(density), *shown[4:], shown_point(one)[1]))
    return PageTable(header, rows)


def _dissipation(assessment: Assessment) -> PageTable:
    rows = [
        (column, level, name, number(value, 4))
        for column, levels in assessment.setting["dissipation"].items()
        for level, stated in levels.items()
        for name, value in stated.items()
    ]
    own = assessment.data["columns"]
    rows += [
        (str(column), f"Housner's impacts at {amplitude:g} α_c", "damping", number(float(value), 3))
        for column in own["column"].to_numpy()
        for amplitude, value in zip(
            own["amplitude"].to_numpy(), own["housner_damping"].sel(column=column).to_numpy(), strict=True
        )
    ]
    return PageTable(("column", "level", "parameter of the model", "value"), rows)


def _provenance(assessment: Assessment) -> PageTable:
    """Tabulate origin, processing and digests of each record."""
    rows = []
    for name, record in assessment.setting["records"].items():
        rows += [(name, f"{place + 1}. {line}") for place, line in enumerate(record["processing"])]
        rows += [
            (name, f"SHA-256 of {path}: {digest}") for path, digest in record["motion"].get("file_sha256", {}).items()
        ]
        if record["digest"]:
            rows.append((name, f"SHA-256 of its numbers: {record['digest']}"))
    return PageTable(("record", "origin and processing"), rows)


def _every_run(assessment: Assessment) -> PageTable:
    """Tabulate every run at the stated scales."""
    header = (
        *("column", "record", "scale", "dissipation", "vertical", "verdict", *TILT_HEADER),
        *("friction needed", "sufficient", "pivoting moment / (N r)", "minimum normal force / weight"),
    )
    rows = []
    for where, one in cells(assessment.data["verdicts"], *_PLACES, "dissipation", "vertical"):
        column, record, _, level, acts = where
        if not acts_in(assessment, record, case_name(level, acts)):
            continue
        need = float(one["friction_demand"])
        friction = (number(need), _enough(need, stated_friction(assessment, column)))
        more = numbers(one, "pivoting_demand", "minimum_normal_force")
        tilted = tilt_cells(float(one["tilt_ratio"]), assessment.data["columns"].sel(column=column))
        vertical = ("yes" if acts == _ACTS else "no") if rises(assessment, record) else NO_COMPONENT
        state = (vertical, verdict(float(one["overturned"])))
        rows.append((*where[:-1], *state, *tilted, *friction, *more))
    return PageTable(header, rows)


# What several tables need


def drifting(assessment: Assessment) -> list[str]:
    """Return the names of the records that end with a velocity above 5 % of their PGV along some axis."""
    own = assessment.data["records"]
    return [str(name) for name in own["record"].to_numpy()[own["drifts"].to_numpy() == 1]]


def spectral_period(assessment: Assessment) -> float:
    """Return the natural period of the spectral acceleration that tables show [s]."""
    return float(assessment.setting.get("details", {}).get("spectral_period", 1.0))


def spectral_accelerations(assessment: Assessment) -> dict[str, float]:
    """Return the spectral acceleration of each record at the stated period [m/s²]; empty if there are no spectra."""
    if "spectra" not in assessment.data:
        return {}
    own = assessment.data["spectra"]["spectral_acceleration"]
    return {name: _at(own.sel(record=name), spectral_period(assessment)) for name in labels(assessment.data["records"])}


def _at(spectrum: xr.DataArray, period: float) -> float:
    """Interpolate a spectrum linearly in the logarithm of the period."""
    return float(np.interp(math.log(period), np.log(spectrum["period"].to_numpy()), spectrum.to_numpy()))


def _columns_and_scales(assessment: Assessment) -> Iterator[tuple[str, float]]:
    for column in assessment.data["columns"]["column"].to_numpy():
        for scale in assessment.setting["scales"]:
            yield str(column), float(scale)


_TABLES: dict[str, Callable[[Assessment], PageTable]] = {
    "verdicts": _verdicts,
    "summary": _summary,
    "events": _events,
    "records": _intensities,
    "spectra": _spectra,
    "margin-intensities": margin_intensities,
    "governing": _governing,
    "margins": _intervals_by_record,
    "tilts": _tilts,
    "verdicts-by-record": _verdicts_by_record,
    "contact-by-record": _friction_by_record,
    "contact-to-margin": _friction_to_margin,
    "slip": slip_table,
    "slip-summary": slip_summary_table,
    "slip-limits": limit_table,
    "variations": _small_variations,
    "near-scales": _near_scales,
    "planar": _planar,
    "planar-bias": _planar_bias,
    "rules-of-practice": _practice,
    "fragility": fragility_table,
    "rates": rate_table,
    "columns": _columns,
    "dissipation": _dissipation,
    "record-provenance": _provenance,
    "runs": _every_run,
}


def assessment_tables(assessment: Assessment) -> dict[str, PageTable]:
    """Format all tables of an assessment, by name."""
    made = {name: make(assessment) for name, make in _TABLES.items()}
    return {name: table for name, table in made.items() if table.rows}
