"""Tables of the records: events, intensities, spectra, intensities at the margin, provenance."""

import math
import re

import numpy as np
import xarray as xr

from stylobate.earthquakes.assessment.report.cases import NO_COMPONENT, rises
from stylobate.earthquakes.assessment.report.column_verdict import largest_decided
from stylobate.earthquakes.assessment.report.wording import CENTRAL, at_most, in_g, number
from stylobate.plots.page import Table
from stylobate.results.assessment import Assessment

# The damping of the spectra of the records.
_DAMPING = 0.05
# If there are more records, the table of spectra has only the smallest and the largest value.
_FEW = 6
_SHOWN_PERIODS = (0.1, 0.2, 0.3, 0.5, 1.0, 2.0, 3.0)
# Provenance line of a record file: its name, its unit, and the title in its header.
_READ = re.compile(r"read from (?P<file>.+?), in [^:]+(?:: (?P<title>.+))?")


def names(assessment: Assessment) -> list[str]:
    """Return the names of the records."""
    return [str(name) for name in assessment.data["records"]["record"].to_numpy()]


def drifting(assessment: Assessment) -> list[str]:
    """Return the names of the records that end with a velocity above 5 % of their PGV along some axis."""
    own = assessment.data["records"]
    return [str(name) for name in own["record"].to_numpy()[own["drifts"].to_numpy() == 1]]


def events(assessment: Assessment) -> Table:
    """Tabulate event, station and files of each record."""
    about = assessment.setting.get("details", {}).get("about_records", {})
    rows = []
    for name in names(assessment):
        lines = assessment.setting["records"][name]["processing"]
        read = [found for found in map(_READ.fullmatch, lines) if found]
        titles = list(dict.fromkeys(_without_component(found["title"]) for found in read if found["title"]))
        if not titles and lines and not _READ.fullmatch(lines[0]):
            titles = lines[:1]
        stated = [str(about[name])] if name in about else []
        rows.append((name, "; ".join([*stated, *titles]) or "–", ", ".join(found["file"] for found in read) or "–"))
    return Table(("record", "event and station, as stated and in the files", "files"), rows)


def _without_component(title: str) -> str:
    """Remove the last field of a title that has several: "event, date, station, component"."""
    return title.rpartition(",")[0] if title.count(",") > 1 else title


def intensities(assessment: Assessment) -> Table:
    """Tabulate the intensities of each record as recorded."""
    own, period = assessment.data["records"], _period(assessment)
    spectral = _spectral(assessment)
    header = (
        *("record", "definition", "PGA [g]", "PGA [m/s²]", "PGV [m/s]", f"Sa({period:g} s) [g]", "PGA, vector [g]"),
        *("PGA along x [g]", "PGA along y [g]", "PGA up [g]", "PGV, vector [m/s]", "duration [s]", "step [s]"),
        *("velocity at the end [m/s]", "drift"),
    )
    rows = []
    for name in names(assessment):
        one = own.sel(record=name)
        in_g_too = [f"peak_acceleration{which}" for which in ("", "_x", "_y", "_z")]
        rows.append(
            (
                name,
                str(one["definition"].item()),
                in_g(float(one["median_peak_acceleration"])),
                number(float(one["median_peak_acceleration"])),
                number(float(one["median_peak_velocity"])),
                in_g(spectral.get(name, math.nan)),
                *(in_g(float(one[which])) for which in in_g_too[:-1]),
                in_g(float(one[in_g_too[-1]])) if rises(assessment, name) else NO_COMPONENT,
                *(number(float(one[which])) for which in ("peak_velocity", "length", "step", "residual_velocity")),
                "yes" if name in drifting(assessment) else "no",
            )
        )
    return Table(header, rows)


def margin_intensities(assessment: Assessment) -> Table:
    """Tabulate PGA, PGV and Sa of each record times the smallest overturning scale of a column.

    One row has the smallest scale of the central case; another has the smallest scale of all cases if that is smaller.
    """
    period = _period(assessment)
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
        for name in names(assessment):
            one = least.sel(column=column, record=name)
            scales = {CENTRAL: float(one.sel(case=CENTRAL))}
            if bool(one.min() < scales[CENTRAL]) or (math.isnan(scales[CENTRAL]) and bool(one.notnull().any())):
                scales[str(one["case"].to_numpy()[np.nanargmin(one.to_numpy())])] = float(one.min())
            for case, scale in scales.items():
                where = (str(column), name, "yes" if name == governing else "", case)
                highest = largest_decided(assessment, str(column), name, case)
                rows.append((*where, *_at_scale(assessment, name, scale, highest)))
    return Table(header, rows)


def _at_scale(assessment: Assessment, record: str, scale: float, highest: float) -> tuple[str, ...]:
    """Return the cells of a record times a scale; if that is NaN, times the highest decided scale, marked with ">"."""
    own = assessment.data["records"].sel(record=record)
    above = "> " if math.isnan(scale) and not math.isnan(highest) else ""
    scale = highest if math.isnan(scale) else scale
    peak, velocity = (scale * float(own[f"median_peak_{what}"]) for what in ("acceleration", "velocity"))
    spectral = scale * _spectral(assessment).get(record, math.nan)
    vector = scale * float(own["peak_acceleration"])
    shown = (in_g(peak), number(peak), number(velocity), in_g(spectral), number(spectral), in_g(vector))
    stated = f"{above}{number(scale, 4)}" if above else at_most(scale)
    return (stated, str(own["definition"].item()), *(f"{above}{value}" for value in shown))


def spectra(assessment: Assessment) -> Table:
    """Tabulate spectral accelerations of the records at some periods, their mean and the design spectrum.

    The spectra of the records have 5 % damping: their mean is divided only by a design spectrum of the same damping.
    """
    if "spectra" not in assessment.data:
        return Table((), [])
    own = assessment.data["spectra"]["spectral_acceleration"]
    design = assessment.setting.get("details", {}).get("design_spectrum")
    alike = design is not None and math.isclose(design["damping"], _DAMPING)
    each = names(assessment) if own.sizes["record"] <= _FEW else ["smallest", "largest"]
    header = ["period [s]", *(f"{name} [g]" for name in each), "mean [g]"]
    header += [f"{design['name']} [g]", "mean / design"] if design else []
    rows = []
    for period in sorted({*_SHOWN_PERIODS, _period(assessment)}):
        values = np.array([_at(own.sel(record=name), period) for name in names(assessment)])
        shown = values if len(each) == values.size else (values.min(), values.max())
        row = [f"{period:g}", *map(in_g, shown), in_g(values.mean())]
        if design:
            inside = design["period"][0] <= period <= design["period"][-1]
            aim = float(np.interp(period, design["period"], design["acceleration"])) if inside else math.nan
            row += [in_g(aim), number(values.mean() / aim) if aim and alike else "–"]
        rows.append(tuple(row))
    return Table(tuple(header), rows)


def provenance(assessment: Assessment) -> Table:
    """Tabulate origin, processing and digests of each record."""
    rows = []
    for name, record in assessment.setting["records"].items():
        rows += [(name, f"{place + 1}. {line}") for place, line in enumerate(record["processing"])]
        rows += [
            (name, f"SHA-256 of {path}: {digest}") for path, digest in record["motion"].get("file_sha256", {}).items()
        ]
        if record["digest"]:
            rows.append((name, f"SHA-256 of its numbers: {record['digest']}"))
    return Table(("record", "origin and processing"), rows)


def _period(assessment: Assessment) -> float:
    return float(assessment.setting.get("details", {}).get("spectral_period", 1.0))


def _spectral(assessment: Assessment) -> dict[str, float]:
    """Return the spectral acceleration of each record at the stated period [m/s²]; empty if there are no spectra."""
    if "spectra" not in assessment.data:
        return {}
    own = assessment.data["spectra"]["spectral_acceleration"]
    return {name: _at(own.sel(record=name), _period(assessment)) for name in names(assessment)}


def _at(spectrum: xr.DataArray, period: float) -> float:
    """Interpolate a spectrum linearly in the logarithm of the period."""
    return float(np.interp(math.log(period), np.log(spectrum["period"].to_numpy()), spectrum.to_numpy()))
