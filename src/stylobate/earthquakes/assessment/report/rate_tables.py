"""The tables of fragility and annual rates of an assessment."""

import math

from stylobate.earthquakes.assessment.report.wording import cells_of, counts, numbers
from stylobate.earthquakes.fragility.empirical_rate import compared_with_target
from stylobate.plots.page import PageTable
from stylobate.results.assessment import Assessment


def fragility_table(assessment: Assessment) -> PageTable:
    """Tabulate median and dispersion of the fitted curves, with their intervals."""
    header = (
        *("column", "limit state", "median PGA, RotD50 [m/s²]", "median from", "median to", "dispersion β_f"),
        *("β_f from", "β_f to", "runs", "runs that reached it", "records with survival above an overturning scale"),
    )
    fitted = ("median", "median_low", "median_high", "dispersion", "dispersion_low", "dispersion_high")
    seen = ("runs", "runs_reached", "non_monotone_records")
    rows = []
    for where, one in cells_of(assessment, "fragility", "column", "limit_state"):
        if int(one["runs"]) == 0:
            continue
        column, state = where[0], where[1].replace("α", "α_c")  # the symbol of the report
        rows.append((column, state, *numbers(one, *fitted), *counts(one, *seen)))
    return PageTable(header, rows)


def rate_table(assessment: Assessment) -> PageTable:
    """Tabulate the annual rates of each column, counted and fitted, and compare them with the target."""
    years, target = assessment.setting.get("years", 50.0), assessment.setting.get("target_rate")
    header = (
        *("column", "limit state", "annual rate, counted [1/a]", "from", "to", "annual rate, fitted [1/a]"),
        *(f"probability in {years:g} years", *(["against the target"] if target is not None else [])),
    )
    rows = []
    for where, one in cells_of(assessment, "rates", "column", "limit_state"):
        rate, low, high = (float(one[name]) for name in ("annual_rate", "rate_low", "rate_high"))
        if math.isnan(rate):  # runs without slip do not describe it, or it is a limit of another column
            continue
        fitted = float(one["fitted_rate"]) if "fitted_rate" in one else math.nan
        said = [] if target is None else [_against(where[1], rate, low, high, float(target))]
        written = (f"{value:.2e}" if math.isfinite(value) else "" for value in (rate, low, high, fitted))
        chance = f"{100.0 * float(one['probability']):.2g} %"
        rows.append((where[0], where[1].replace("α", "α_c"), *written, chance, *said))
    return PageTable(header, rows)


def _against(limit_state: str, rate: float, low: float, high: float, target: float) -> str:
    """Compare the rate of a limit state with its target; a tilt is no failure, and has none."""
    return "–" if limit_state.startswith("tilt") else compared_with_target(rate, low, high, target)
