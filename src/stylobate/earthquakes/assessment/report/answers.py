"""The answer of an assessment: how probable it is that a record overturns a column, and with what interval."""

import math
from dataclasses import dataclass

import numpy as np

from stylobate.earthquakes.assessment.report.column_verdict import (
    column_verdict,
    least_overturning_scale,
    share_that_rocks,
)
from stylobate.earthquakes.assessment.report.sliding_tables import sliding_columns, stated_limits
from stylobate.earthquakes.assessment.report.wording import CENTRAL, OVERTURNING, labels, number
from stylobate.earthquakes.fragility.empirical_rate import compared_with_target
from stylobate.plots.page import PageTable
from stylobate.results.assessment import Assessment
from stylobate.results.verdict import percent
from stylobate.studies.proportions import Floats, clustered_interval
from stylobate.text import plural

CONFIDENCE = 0.95
"""Confidence level of the intervals of probabilities."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Probability:
    """Probability that a record of the kind of those assessed overturns a column at a scale.

    Attributes
    ----------
    share
        Mean over the records of the share of runs that overturned the column; NaN if no run was decided.
    low, high
        Ends of the interval at `CONFIDENCE`: the lower end counts no undecided run, the upper end counts all of them.
    records, runs
        Number of records, and of runs under each.
    """

    share: float
    low: float
    high: float
    records: int
    runs: int

    def __str__(self) -> str:
        """Return the probability with its interval."""
        return _stated(self.share, self.low, self.high)


def probability_over_records(reached: Floats, undecided: Floats) -> tuple[float, float, float]:
    """Estimate a probability from the shares of runs under each record, with its `clustered_interval`.

    Parameters
    ----------
    reached, undecided
        Shares of the runs under each record that overturned the column, or reached another limit state, and of those
        that were not decided.

    Returns
    -------
    tuple
        Estimate, lower end and upper end; the estimate is NaN if no run was decided.
    """
    low, _ = clustered_interval(reached, confidence=CONFIDENCE)
    _, high = clustered_interval(reached + undecided, confidence=CONFIDENCE)
    decided = undecided < 1.0
    known = reached[decided] / (1.0 - undecided[decided])
    return float(known.mean()) if known.size else math.nan, float(low), float(high)


def overturning_probability(assessment: Assessment, column: str, scale: float) -> Probability:
    """Estimate the probability that a record overturns a column at a scale.

    The runs are the small variations of each record; without variations the runs at each stated dissipation, with the
    vertical component.
    """
    if "variations" in assessment.data:
        own = assessment.data["variations"].sel(column=column, scale=scale)
        total = own["runs"].to_numpy()
        overturned, undecided = own["overturned"].to_numpy() / total, own["open"].to_numpy() / total
        runs = int(total.max())
    else:
        verdicts = assessment.data["verdicts"]["overturned"].sel(column=column, scale=scale, vertical="with")
        states = verdicts.transpose("record", "dissipation").to_numpy()
        overturned, undecided, runs = (states == 1).mean(axis=1), (states < 0).mean(axis=1), states.shape[1]
    share, low, high = probability_over_records(overturned, undecided)
    return Probability(share=share, low=low, high=high, records=overturned.size, runs=runs)


def answer_table(assessment: Assessment, scale: float) -> PageTable:
    """Tabulate the answer on each column: class, probability at `scale`, smallest overturning scale, annual rate."""
    slip = " or slip" if sliding_columns(assessment) else ""
    header = ["object", "verdict", f"probability of overturning{slip} ({100.0 * CONFIDENCE:g} % interval)"]
    header.append("smallest scale that overturned it, at most")
    rated = "rates" in assessment.data
    years = assessment.setting.get("years", 50.0)
    header += [f"annual rate of overturning; in {years:g} years"] if rated else []
    rows = []
    for name in labels(assessment.data["columns"], "column"):
        found = column_verdict(assessment, name, scale)
        row = [name, found.verdict.value]
        if found.describes:
            row += [str(overturning_probability(assessment, name, scale)), _least_words(assessment, name)]
            row += [_rate_words(assessment, name)] if rated else []
        else:
            computed = name in sliding_columns(assessment)
            row += [_slip_words(assessment, name, scale) if computed else "–", "–", *(["–"] if rated else [])]
        rows.append(row)
    return PageTable(header, rows)


def _slip_words(assessment: Assessment, name: str, scale: float) -> str:
    """State the largest slip of a column, the probability of its limit states, and what friction leaves open."""
    own = assessment.data["sliding"].sel(column=name, scale=scale)
    worst = own.isel(record=int(own["peak_slip"].fillna(-1.0).argmax("record")))
    low, high = (1000.0 * float(worst[f"peak_slip_{end}"]) for end in ("low", "high"))
    stated = 1000.0 * float(worst["peak_slip"])
    interval = "" if math.isnan(low) else f" ({number(low)} to {number(high)}, 90 % of its variations)"
    phrases = [f"slips up to {number(stated)} mm{interval} under {worst['record'].item()}"]
    for state in stated_limits(assessment, name):
        one = own.sel(limit_state=state)
        single, varied = (one["reached"] == 1).to_numpy(), one["reached_share"].to_numpy()
        shares = np.where(np.isnan(varied), single, varied)
        unknown = np.where(np.isnan(varied) & (one["reached"] < 0).to_numpy(), 1.0, 0.0)
        phrases.append(f"{state}: {_stated(*probability_over_records(shares, unknown))}")
    if share := share_that_rocks(assessment, name, scale):
        rocks = str(overturning_probability(assessment, name, scale))
        phrases.append(
            f"but in {percent(share)} of the variations friction reaches r/h, and it may rock: overturns {rocks}"
        )
    return "; ".join(phrases)


def _stated(share: float, low: float, high: float) -> str:
    interval = f"{percent(low).removesuffix(' %')} to {percent(high)}"
    return f"not known ({interval})" if math.isnan(share) else f"{percent(share)} ({interval})"


def _least_words(assessment: Assessment, name: str) -> str:
    """State the smallest overturning scale of the central case and of all cases."""
    words = least_overturning_scale(assessment, name)
    return words.removeprefix("Smallest overturning scale of all cases: at most ").rstrip(".")


def _rate_words(assessment: Assessment, name: str) -> str:
    rates = assessment.data["rates"].sel(column=name)
    if OVERTURNING not in rates["limit_state"].to_numpy():
        return "–"
    own = rates.sel(limit_state=OVERTURNING)
    rate, low, high = (float(own[end]) for end in ("annual_rate", "rate_low", "rate_high"))
    interval = f" ({low:.1e} to {high:.1e})" if np.isfinite([low, high]).all() else ""
    target = assessment.setting.get("target_rate")
    against = "" if target is None else f"; {compared_with_target(rate, low, high, float(target))}"
    return f"{rate:.1e} per year{interval}; {100.0 * float(own['probability']):.2g} %{against}"


def answer_text(assessment: Assessment, scale: float) -> str:
    """Explain the probability of the answer."""
    first = labels(assessment.data["columns"], "column")[0]
    one = overturning_probability(assessment, first, scale)
    several = one.records > 1
    each = "each record" if several else "the record"
    population = (
        f"The probability is that of a record drawn from the population of these {one.records} records"
        if several
        else "One record hardly bounds the probability under others like it"
    )
    varied = (
        f"{each} was run {one.runs} times with everything varied at once that is not known exactly: record, "
        "column, base, damping and contact law"
        if "variations" in assessment.data
        else f"{each} was run at {plural(one.runs, 'level')} of dissipation"
    )
    return (
        f"{population}: {varied}. Runs under one record count as one trial, so the interval is wide if records are "
        "few. Read the smallest scale as “at most”: narrower intervals may lie below. Named are its record, its "
        f"dissipation and, if not the given one, contact law; the {CENTRAL} case stands in the section on margins."
    )
