"""Tables of single runs: verdicts, tilts, friction, small changes, and the planar column."""

import math
from collections.abc import Iterator

from stylobate.earthquakes.assessment.report.cases import NO_COMPONENT, acts_in, case_name, cases_of, rises
from stylobate.earthquakes.assessment.report.cells import cells
from stylobate.earthquakes.assessment.report.column_verdict import column_verdict
from stylobate.earthquakes.assessment.report.displacements import TILT_HEADER, shown_point, tilt_cells
from stylobate.earthquakes.assessment.report.wording import CENTRAL, listed, near_share, number, tilt, verdict
from stylobate.plots.page import Table
from stylobate.results.assessment import Assessment
from stylobate.results.verdict import LABELS, interval_text, percent

_ACTS = "with"
_PLACES = ("column", "record", "scale")


def verdicts(assessment: Assessment) -> Table:
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
    return Table(header, rows)


def tilts(assessment: Assessment) -> Table:
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
    return Table(header, rows)


def verdicts_by_record(assessment: Assessment) -> Table:
    """Tabulate the outcome under each record at each dissipation, with and without the vertical component."""
    own = assessment.data["verdicts"]
    levels, acting = (own[dim].to_numpy() for dim in ("dissipation", "vertical"))
    cases = [(level, acts) for acts in acting for level in levels if acts == _ACTS or level == CENTRAL]
    header = (*_PLACES, *(case_name(str(level), str(acts)) for level, acts in cases))
    rows = [
        (*where, *(verdict(float(runs["overturned"].sel(dissipation=level, vertical=acts))) for level, acts in cases))
        for where, runs in cells(own, *_PLACES)
    ]
    return Table(header, rows)


def friction_by_record(assessment: Assessment) -> Table:
    """Tabulate the largest friction that the runs under each record needed."""
    header, rows = (*_PLACES, "largest friction needed, given contact law", "stated friction", "sufficient"), []
    for where, one in cells(assessment.data["summary"], *_PLACES) if assessment.setting["contact"] else ():
        need, stated = float(one["friction_by_record"]), _stated_friction(assessment, where[0])
        rows.append((*where, number(need), number(stated), _enough(need, stated)))
    return Table(header, rows)


def _stated_friction(assessment: Assessment, column: str) -> float:
    return float(assessment.setting["friction_coefficient"][column])


def _enough(need: float, stated: float) -> str:
    return "–" if math.isnan(need) else "yes" if need <= stated else "no"


def every_run(assessment: Assessment) -> Table:
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
        friction = (number(need), _enough(need, _stated_friction(assessment, column)))
        more = (number(float(one[name])) for name in ("pivoting_demand", "minimum_normal_force"))
        tilted = tilt_cells(float(one["tilt_ratio"]), assessment.data["columns"].sel(column=column))
        vertical = ("yes" if acts == _ACTS else "no") if rises(assessment, record) else NO_COMPONENT
        state = (vertical, verdict(float(one["overturned"])))
        rows.append((*where[:-1], *state, *tilted, *friction, *more))
    return Table(header, rows)


def sliding(assessment: Assessment) -> Table:
    """Tabulate the runs with the sliding model, for the columns that slide before they rock."""
    header = (
        *("column", "record", "scale", "verdict with the sliding model", "peak slip [mm]", "residual slip [mm]"),
        "time sliding [s]",
    )
    if "sliding" not in assessment.data:
        return Table(header, [])
    rows = []
    for where, run in cells(assessment.data["sliding"], *_PLACES):
        if not math.isnan(float(run["time_sliding"])):
            slips = (number(1000.0 * float(run[name])) for name in ("peak_slip", "residual_slip"))
            rows.append((*where, verdict(float(run["overturned"])), *slips, number(float(run["time_sliding"]))))
    return Table(header, rows)


def small_variations(assessment: Assessment) -> Table:
    """Tabulate the share of small variations that overturn each column, and the word that follows from it."""
    header = (
        *("column", "record", "scale", "under small variations", "share that overturns it", "90 % sampling interval"),
        *("by contact law", "decided most by", "not decided", "median tilt / α_c", "95 % of tilts / α_c below"),
    )
    if "variations" not in assessment.data:
        return Table(header, [])
    rows = []
    for where, one in cells(assessment.data["variations"], *_PLACES):
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
    return Table(header, rows)


def near_scales(assessment: Assessment) -> Table:
    """Tabulate the share of overturning scales within 10 % of each stated scale, by case."""
    own = assessment.data["margins"][["band_share"]]
    cases = [str(case) for case in own["case"].to_numpy()]
    rows = [
        (*where, *(percent(float(one["band_share"].sel(case=case))) for case in cases))
        for where, one in cells(own, *_PLACES)
    ]
    return Table((*_PLACES, *cases), rows)


def planar(assessment: Assessment) -> Table:
    """Tabulate the verdicts in three dimensions beside those of the planar column."""
    header = (
        *("column", "record", "scale", "three-dimensional", "peak tilt / α_c", "planar (worse component)"),
        "planar peak tilt / α_c",
    )
    if "planar" not in assessment.data:
        return Table(header, [])
    spatial = assessment.data["verdicts"].sel(dissipation=CENTRAL, vertical=_ACTS)
    runs = spatial.assign(planar_tilt_ratio=assessment.data["planar"]["planar_tilt_ratio"])
    rows = []
    for where, run in cells(runs, *_PLACES):
        flat = float(run["planar_tilt_ratio"])
        state = "not decided" if math.isnan(flat) else verdict(float(math.isinf(flat)))
        rows.append((*where, verdict(float(run["overturned"])), tilt(float(run["tilt_ratio"])), state, tilt(flat)))
    return Table(header, rows)


def planar_bias(assessment: Assessment) -> Table:
    """Tabulate the mean logarithm of the tilts in three dimensions over those of the planar column."""
    header = (
        *("column", "scale", "mean ln(tilt in three dimensions / planar)", "standard error", "records compared"),
        *("overturned in three dimensions only", "overturned in the planar calculation only"),
    )
    if "planar" not in assessment.data:
        return Table(header, [])
    rows = []
    for where, one in cells(assessment.data["planar"], "column", "scale"):
        counts = (f"{int(one[name])}" for name in ("compared", "only_space", "only_planar"))
        mean = float(one["bias"])
        words = "too few records" if math.isnan(mean) else number(mean)
        rows.append((*where, words, number(float(one["standard_error"])), *counts))
    return Table(header, rows)


def _columns_and_scales(assessment: Assessment) -> Iterator[tuple[str, float]]:
    for column in assessment.data["columns"]["column"].to_numpy():
        for scale in assessment.setting["scales"]:
            yield str(column), float(scale)
