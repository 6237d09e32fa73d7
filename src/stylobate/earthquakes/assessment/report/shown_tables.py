"""The tables that the pages of a report show: one line for what a reader compares, without lines that say nothing.

The files beside the report have every row and column.
"""

import math
from collections.abc import Callable
from pathlib import PurePath

import xarray as xr

from stylobate.earthquakes.assessment.inputs import OTHER_LAW
from stylobate.earthquakes.assessment.margins import states_at_scales
from stylobate.earthquakes.assessment.report.column_verdict import acts_in, recorded_scale, rises, slides_at
from stylobate.earthquakes.assessment.report.tables import spectral_accelerations, spectral_period
from stylobate.earthquakes.assessment.report.wording import (
    CENTRAL,
    SMALLEST_TILT,
    TOO_FEW,
    UNDECIDED,
    at_most,
    cells,
    in_g,
    labels,
    near_share,
    number,
    stated_friction,
    tilt,
    tilt_cells,
)
from stylobate.plots.page import PageTable, Part
from stylobate.results.assessment import Assessment
from stylobate.results.verdict import LABELS, percent
from stylobate.text import plural

_PLACES = ("column", "record", "scale")
_ACTS = "with"
_NOTHING = "–"


def without_empty_rows(table: PageTable, says: Callable[[list[str]], bool], file: str, what: str) -> list[Part]:
    """Return a table without the rows that say nothing, and a remark that names the file with all rows.

    Parameters
    ----------
    table
        Table of all rows.
    says
        Whether a row says something.
    file
        Name of the file, in the folder `tables`, that has every row.
    what
        What the rows that are left out have in common.
    """
    kept = [row for row in table.rows if says(list(row))]
    left_out = len(table.rows) - len(kept)
    remark = f"{plural(left_out, 'more row')} with {what}: left out here, in tables/{file}.csv." if left_out else ""
    return [*([PageTable(table.header, kept)] if kept else []), *([remark] if remark else [])]


def outcomes(assessment: Assessment) -> list[Part]:
    """Tabulate the outcome of every case at the stated scales, both contact laws side by side, and under variations."""
    verdicts, margins = assessment.data["verdicts"], assessment.data["margins"]
    levels = labels(verdicts, "dissipation")
    others = [level for level in levels if f"{level}{OTHER_LAW}" in labels(margins, "case")]
    scanned = states_at_scales(margins, verdicts["scale"])
    vertical = any(rises(assessment, name) for name in labels(assessment.data["records"]))
    several = verdicts.sizes["scale"] > 1
    header = ["object", "record", *(["scale"] if several else []), *levels]
    header += [f"{level}, other law" for level in others]
    header += ["no vertical"] if vertical else []
    header += ["small variations", "decided most by"] if "variations" in assessment.data else []
    header.append("within 10 %")
    rows = []
    for where, one in cells(verdicts, *_PLACES):
        column, record, scale = where[0], where[1], float(where[2])
        if slides_at(assessment, column, scale):
            continue
        own = margins.sel(column=column, record=record)
        states = [_state(float(one["overturned"].sel(dissipation=level, vertical=_ACTS))) for level in levels]
        at_scale = scanned.sel(column=column, record=record, scale=scale)
        states += [_state(float(at_scale.sel(case=f"{level}{OTHER_LAW}"))) for level in others]
        if vertical:
            without = float(one["overturned"].sel(dissipation=CENTRAL).isel(vertical=-1))
            states.append(_state(without) if rises(assessment, record) else "none")
        varied = _varied(assessment, column, record, scale)
        share = float(own["band_share"].sel(scale=scale).max("case").fillna(0.0))
        found = bool((own["in_band"].sel(scale=scale) > 0).any())
        places = where if several else where[:2]
        rows.append((*places, *states, *varied, near_share(share) if found else _NOTHING))
    return without_empty_rows(
        PageTable(header, rows),
        lambda row: any(cell not in ("none", _NOTHING) for cell in row[3 if several else 2 :]),
        "verdicts-by-record",
        "no case that overturned or was not decided",
    )


def _state(overturned: float) -> str:
    return "yes" if overturned > 0.0 else _NOTHING if overturned == 0.0 else UNDECIDED


def _varied(assessment: Assessment, column: str, record: str, scale: float) -> tuple[str, ...]:
    if "variations" not in assessment.data:
        return ()
    own = assessment.data["variations"].sel(column=column, record=record, scale=scale)
    if int(own["overturned"]) == int(own["open"]) == 0:
        return _NOTHING, _NOTHING
    deciding = str(own["deciding"].item())
    interval = f"{percent(float(own['share_low'])).removesuffix(' %')} to {percent(float(own['share_high']))}"
    return f"{percent(float(own['share']))} ({interval})", LABELS.get(deciding, deciding) or "none alone"


def margins(assessment: Assessment) -> PageTable:
    """Tabulate the smallest overturning scales, both contact laws side by side, and the record at the central one."""
    own = assessment.data["margins"]
    period = spectral_period(assessment)
    every = labels(own, "case")
    header = ("object", "record", *every, "PGA [g]", "PGV [m/s]", f"Sa({period:g} s) [g]")
    rows = []
    for (column, record), one in cells(own, "column", "record"):
        if slides_at(assessment, column, recorded_scale(assessment)):
            continue
        scales = [_smallest(assessment, one, record, case) for case in every]
        least = float(one["least_overturning"].sel(case=CENTRAL))
        rows.append((column, record, *scales, *_at_scale(assessment, record, least)))
    return PageTable(header, rows)


def _smallest(assessment: Assessment, margins: xr.Dataset, record: str, case: str) -> str:
    """State the smallest overturning scale of a case; without one, the largest decided scale after a ">"."""
    if not acts_in(assessment, record, case):
        return "none"
    least, decided = (float(margins[name].sel(case=case)) for name in ("least_overturning", "decided_to"))
    if math.isnan(least):
        return f"> {number(decided)}" if math.isfinite(decided) else UNDECIDED
    return at_most(least)


def _at_scale(assessment: Assessment, record: str, scale: float) -> tuple[str, str, str]:
    own = assessment.data["records"].sel(record=record)
    peak, velocity = (scale * float(own[f"median_peak_{what}"]) for what in ("acceleration", "velocity"))
    spectral = scale * spectral_accelerations(assessment).get(record, math.nan)
    return in_g(peak), number(velocity), in_g(spectral)


def tilts(assessment: Assessment) -> list[Part]:
    """Tabulate the peak tilts at central dissipation, the largest of all cases, and those of the planar column."""
    header = ["object", "record", "scale", "tilt / α_c", "tilt [°]", "displacement [mm]", "largest of all cases / α_c"]
    planar = "planar" in assessment.data
    header += ["planar calculation / α_c"] if planar else []
    rows, still = [], []
    for where, one in cells(assessment.data["verdicts"], *_PLACES):
        column, record, scale = where[0], where[1], float(where[2])
        if slides_at(assessment, column, scale):
            continue
        body = assessment.data["columns"].sel(column=column)
        most = float(one["tilt_ratio"].max())
        row = (*where, *tilt_cells(float(one["tilt_ratio"].sel(dissipation=CENTRAL, vertical=_ACTS)), body), tilt(most))
        if planar:
            flat = assessment.data["planar"]["planar_tilt_ratio"].sel(column=column, record=record, scale=scale)
            row = (*row, tilt(float(flat)))
            most = max(most, float(flat))
        rows.append(row)
        if most < SMALLEST_TILT:
            still.append(list(row))
    return without_empty_rows(
        PageTable(header, rows), lambda row: row not in still, "tilts", f"tilts below {SMALLEST_TILT:g} α_c"
    )


def contact(assessment: Assessment) -> PageTable:
    """Tabulate the friction that each column needs, beside the stated coefficient."""
    header = (
        *("object", "contact law", "friction needed at the stated scales", "stated", "sufficient"),
        *("smallest scale run that needs more", "with the other contact law", "slides before it rocks"),
    )
    rows = []
    for (column,), own in cells(assessment.data["summary"], "column"):
        need, stated = float(own["friction_demand"].max()), stated_friction(assessment, column)
        slipping, other = (float(own[name]) for name in ("least_slipping", "least_slipping_other_law"))
        law = str(assessment.setting["columns"][column]["model"].get("kind", "own"))
        slides = float(assessment.data["margins"]["standing_slip"].sel(column=column).min())
        rows.append(
            (
                *(column, law, number(need), number(stated)),
                _NOTHING if math.isnan(need) else "yes" if need <= stated else "no",
                *("none" if math.isnan(value) else number(value) for value in (slipping, other)),
                "no" if math.isnan(slides) else f"yes, from scale {number(slides)} on",
            )
        )
    return PageTable(header, rows)


def damping(assessment: Assessment) -> PageTable:
    """Tabulate the stated levels of dissipation beside the damping that loses as much as Housner's impacts."""
    own = assessment.data["columns"]
    levels = list(next(iter(assessment.setting["dissipation"].values())))
    amplitudes = own["amplitude"].to_numpy().tolist()
    header = ("object", *levels, *(f"Housner's impacts, at {amplitude:g} α_c" for amplitude in amplitudes))
    rows = []
    for column in labels(own, "column"):
        stated = assessment.setting["dissipation"][column]
        yardstick = own["housner_damping"].sel(column=column).to_numpy()
        rows.append((column, *(_parameters(stated[level]) for level in levels), *map(_two_digits, yardstick)))
    return PageTable(header, rows)


def _parameters(stated: dict[str, float]) -> str:
    """State the dissipation parameters of a level; damping alone is η."""
    if set(stated) == {"damping"}:
        return f"η\u00a0=\u00a0{_two_digits(stated['damping'])}"
    return ", ".join(f"{name} {number(value)}" for name, value in stated.items())


def _two_digits(value: float) -> str:
    return f"{value:.2g}"


def records(assessment: Assessment, table: PageTable) -> PageTable:
    """Return the intensities that decide, of the `table` of all intensities of the records."""
    period = spectral_period(assessment)
    names = ["record", "definition", "PGA [g]", "PGV [m/s]", f"Sa({period:g} s) [g]", "PGA, vector [g]"]
    return _selected(table, [*names, "PGA up [g]", "duration [s]", "step [s]", "drift"])


def _selected(table: PageTable, columns: list[str]) -> PageTable:
    places = [list(table.header).index(name) for name in columns]
    return PageTable(columns, [[row[at] for at in places] for row in table.rows])


def rules(assessment: Assessment, table: PageTable) -> list[Part]:
    """Tabulate the answers of rules of practice, rules side by side, and their clauses, from the `table` of all."""
    scale = f"{recorded_scale(assessment):g}"
    clauses: dict[str, tuple[str, str]] = {}
    of_each: dict[str, dict[str, str]] = {}
    for column, at, rule, unsafe, survives, safe, overturns, clause, checked in table.rows:
        clauses[rule] = (clause, checked)
        if at == scale:
            slides = slides_at(assessment, column, float(at))
            answer = f"{unsafe} / {safe}" if slides else f"{unsafe} ({survives}) / {safe} ({overturns})"
            of_each.setdefault(column, {})[rule] = answer
    rows = [(column, *(answers[rule] for rule in clauses)) for column, answers in of_each.items()]
    stated = [(rule, *one) for rule, one in clauses.items()]
    return [PageTable(("object", *clauses), rows), PageTable(("rule", "formula or clause", "clause checked"), stated)]


def bias(assessment: Assessment, table: PageTable) -> list[Part]:
    """Return the rows of the `table` of planar against three-dimensional tilts that compare some records."""
    known = [row for row in table.rows if row[2] != TOO_FEW and not slides_at(assessment, row[0], float(row[1]))]
    return [PageTable(table.header, known)] if known else []


def inputs(assessment: Assessment) -> PageTable:
    """Tabulate origin and processing of each record in one row, with the digests of its files and numbers."""
    rows = []
    for name in labels(assessment.data["records"]):
        record = assessment.setting["records"][name]
        files = record["motion"].get("file_sha256", {})
        digests = [f"SHA-256 of {PurePath(path).name}: {digest}" for path, digest in files.items()]
        digests += [f"SHA-256 of the numbers: {record['digest']}"] if record["digest"] else []
        rows.append((name, ". ".join(["; ".join(record["processing"]), *digests])))
    return PageTable(("record", "origin, processing and digests"), rows)
