"""Annual rates straight from runs, without a fitted curve: each run stands for the intensities around its own.

    rate = (1/n) Σ_r ∫ 1_r(x) |dλ(x)|                                                                      (1)

over the n records r, with 1_r(x) = 1 where the run nearest to x on a logarithmic axis reached the limit state. The
boundaries between runs are geometric means of neighbouring intensities, so that with these boundaries e_i

    ∫ 1_r |dλ| = Σ_i 1_r(x_i) (λ(e_i) − λ(e_i+1))                                                         (2)

Survival above an intensity that overturned the column counts as survival, which no lognormal curve can show.
"""

import math
from dataclasses import dataclass
from typing import Self

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate.earthquakes.fragility.annual_rate import HazardCurve, require_same_component, require_same_unit
from stylobate.earthquakes.fragility.observations import LIMIT_STATE, NOT_KNOWN, Data, Floats, Integers, Observations
from stylobate.errors import ParameterError, require_positive, require_whole
from stylobate.studies.proportions import require_confidence

_FEWEST = 2


def empirical_rate(
    intensity: Data,
    reached: Data,
    hazard: HazardCurve,
    *,
    record: Data | None = None,
    property_sample: Data | None = None,
    years: float = 50.0,
    confidence: float = 0.95,
    resamples: int = 1000,
    rng: np.random.Generator | None = None,
    bins: int = 40,
) -> xr.Dataset:
    """Compute the annual rate at which each limit state is reached from the runs alone, (1), with an interval.

    Parameters
    ----------
    intensity, reached, record, property_sample
        Runs, as for `fit_fragility`; a record is needed.
    hazard
        Annual rates of exceedance of this intensity; beyond its ends it is continued with the slopes it has there.
    years
        Time for which the probability of one or more failures is stated, for a Poisson process.
    confidence
        Confidence level of the interval.
    resamples
        Number of bootstrap samples of the records; 0 for no interval.
    rng
        Random numbers of the bootstrap.
    bins
        Number of intervals of the intensity, of one ratio, in which contributions are summed.

    Returns
    -------
    xarray.Dataset
        Of kind "empirical annual rate". Over `limit_state`: `annual_rate` [1/a]; `rate_low` and `rate_high`, its
        interval by percentiles of the resamples of the records, NaN for fewer than two records; `rate_least` and
        `rate_most`, bounds for what happens beyond the scales of the runs: above the last scale of a record the column
        always stands or always falls, and it always falls below a first scale that reached the limit state;
        `probability` in `years` years. Over `record` too: `record_rate`. Over `bin` too: `contribution` [1/a], with
        `bin_from`, `bin_to` and `bin_intensity` from the lowest to the highest intensity of the runs; `rate_above` is
        the contribution above. Also the hazard curve, over `point`.

    Raises
    ------
    ParameterError
        If no record is named, unit or horizontal component of intensity and hazard differ, or a number is out of range.

    Notes
    -----
    Above its last scale a record counts as there; below its first scale it counts as not reached. Runs that are not
    known are left out. Samples of properties count alike within their record, and records alike. Below about twenty
    records an interval by percentiles is too narrow: of three records it is at most their range.

    Examples
    --------
    >>> hazard = HazardCurve(intensity=[0.1, 10.0], rate=[1e-1, 1e-5])  # 1e-3/x²
    >>> found = empirical_rate([1.0, 4.0, 9.0], [False, True, False], hazard, record=[1, 1, 1])
    >>> round(found["annual_rate"].item() / 1e-3, 12) == round(1 / 2**2 - 1 / 6**2, 12)
    True
    """
    time, level = require_positive("years", years, "a"), require_confidence(confidence)
    count, pieces = require_whole("resamples", resamples, least=0), require_whole("bins", bins, least=1)
    seen = Observations.of(intensity, reached, record, property_sample)
    if seen.record is None or seen.series is None:
        raise ParameterError("record: missing. Name the record of each run, for example record=names")
    require_same_unit(str(seen.attributes.get("units", "1")), hazard)
    require_same_component(seen.attributes.get("component"), hazard.component)
    of_record = seen.record[np.unique(seen.series, return_index=True)[1]]
    parts = np.array([_series_rates(seen.intensity, state, seen.series, hazard) for state in seen.reached])
    # (limit states, series, 3)
    records = np.arange(len(seen.records))
    each = np.stack([_mean(parts[:, of_record == one], axis=1) for one in records], axis=1)
    rate, least, most = _mean(each, axis=1).T
    lowest, highest = math.log(seen.intensity.min()), math.log(seen.intensity.max())
    edges = np.linspace(lowest, highest, pieces + 1)
    below = [
        _rate_below(_Stretches.of(seen.intensity, state, seen.series), weights, hazard, edges)
        for state, weights in zip(seen.reached, _weights(parts[:, :, 0], of_record), strict=True)
    ]
    contribution = np.diff(below, axis=1)
    low, high = _interval(each[:, :, 0], level, count, rng)
    per_year = {"units": "a-1"}
    percent = f"{100.0 * level:g} %"
    data = {
        "annual_rate": (rate, "annual rate, counted"),
        "rate_low": (low, f"lower end of its {percent} interval over records"),
        "rate_high": (high, f"upper end of its {percent} interval over records"),
        "rate_least": (least, "lower bound beyond the scales"),
        "rate_most": (most, "upper bound beyond the scales"),
        "rate_above": (rate - contribution.sum(axis=1), "contribution above the highest intensity of the runs"),
    }
    component = {} if hazard.component is None else {"component": str(hazard.component)}
    about = {"units": hazard.units, "long_name": ", ".join([hazard.quantity, *component.values()]), **component}
    ends = np.exp(edges)
    return xr.Dataset(
        {name: (LIMIT_STATE, values, {**per_year, "long_name": text}) for name, (values, text) in data.items()}
        | {
            "record_rate": ((LIMIT_STATE, "record"), each[:, :, 0], {**per_year, "long_name": "annual rate, counted"}),
            "probability": (
                LIMIT_STATE,
                -np.expm1(-rate * time),
                {"units": "1", "long_name": f"probability in {time:g} years"},
            ),
            "contribution": (
                (LIMIT_STATE, "bin"),
                contribution,
                {**per_year, "long_name": "contribution to the annual rate"},
            ),
            "bin_from": ("bin", ends[:-1], about),
            "bin_to": ("bin", ends[1:], about),
            "hazard_rate": ("point", np.exp(hazard.log_rate), {**per_year, "long_name": "annual rate of exceedance"}),
        },
        coords={
            LIMIT_STATE: list(seen.names),
            "record": list(seen.records),
            "bin_intensity": ("bin", np.sqrt(ends[:-1] * ends[1:]), about),
            "hazard_intensity": ("point", np.exp(hazard.log_intensity), about),
        },
        attrs={
            "kind": "empirical annual rate",
            "years": time,
            "confidence": level,
            "resamples": count,
            "hazard_origin": hazard.origin,
        },
    )


def compared_with_target(rate: float, low: float, high: float, target: float) -> str:
    """Return whether an annual rate is below a target, above it, or not decided by its interval, in words.

    Parameters
    ----------
    rate, low, high
        Annual rate with its interval [1/a]; NaN for a rate or an interval that is not known.
    target
        Annual rate that is accepted [1/a].

    Examples
    --------
    >>> compared_with_target(1e-5, 5e-6, 5e-5, 1e-4)
    'below the target of 1.0e-04 per year'
    """
    stated = f"the target of {target:.1e} per year"
    if math.isnan(rate):
        return "not known: no run of it is decided"
    if not math.isfinite(low):
        return f"{'below' if rate < target else 'above'} {stated}, without an interval"
    if low <= target <= high:
        return f"not decided: {stated} lies in the interval. Add records"
    return f"{'below' if high < target else 'above'} {stated}"


def _mean(values: Floats, axis: int) -> Floats:
    """Return the mean of the known values along an axis, NaN where none is known."""
    known = ~np.isnan(values)
    count, total = known.sum(axis=axis), values.sum(axis=axis, where=known)
    return np.asarray(np.divide(total, count, out=np.full(total.shape, np.nan), where=count > 0))


@dataclass(frozen=True, slots=True, kw_only=True)
class _Stretches:
    """The known runs of several series, each with the stretch of intensity that it stands for; all in logarithms.

    Attributes
    ----------
    at, low, high
        Intensity of each run, and the ends of its stretch; the last one of a series has no end. Shape (runs,).
    hit
        Whether the run reached the limit state.
    group
        Series of each run; runs are sorted by series and intensity.
    begins, ends
        Whether the run is the first or the last one of its series.
    """

    at: Floats
    low: Floats
    high: Floats
    hit: npt.NDArray[np.bool_]
    group: Integers
    begins: npt.NDArray[np.bool_]
    ends: npt.NDArray[np.bool_]

    @classmethod
    def of(cls, intensity: Floats, state: Integers, series: Integers) -> Self:
        """Sort the known runs; there may be none."""
        known = state != NOT_KNOWN
        u, group, hit = np.log(intensity[known]), series[known], state[known] == 1
        order = np.lexsort((u, group))
        u, group, hit = u[order], group[order], hit[order]
        begins = np.diff(group, prepend=-1) > 0
        ends = np.append(begins[1:], True)[: u.size]
        between = 0.5 * (u[1:] + u[:-1])
        low = np.where(begins, u, np.insert(between, 0, 0.0)[: u.size])
        high = np.where(ends, np.inf, np.append(between, np.inf)[: u.size])
        return cls(at=u, low=low, high=high, hit=hit, group=group, begins=begins, ends=ends)


def _series_rates(intensity: Floats, state: Integers, series: Integers, hazard: HazardCurve) -> Floats:
    """Return (2) of each series and its bounds beyond the scales, shape (series, 3); NaN without known runs."""
    runs, count = _Stretches.of(intensity, state, series), int(series.max()) + 1
    rates = np.full((count, 3), np.nan)
    if runs.at.size == 0:
        return rates
    own, of_series = _exceedance(hazard, runs.at), runs.group[runs.ends]
    fall = _exceedance(hazard, runs.low) - np.where(
        runs.ends, 0.0, _exceedance(hazard, np.where(runs.ends, 0.0, runs.high))
    )
    rate = np.bincount(runs.group, weights=np.where(runs.hit, fall, 0.0), minlength=count)[of_series]
    first, last = runs.hit[runs.begins], runs.hit[runs.ends]
    beyond = np.where(first & (hazard.slopes[0] > 0.0), np.inf, 0.0) + np.where(last, 0.0, own[runs.ends])
    least = rate - np.where(last, own[runs.ends], 0.0)
    rates[of_series] = np.stack([rate, least, rate + beyond], axis=-1)
    return rates


def _weights(rates: Floats, of_record: Integers) -> Floats:
    """Return the weight of each series in the mean over records, shape (limit states, series); 0 if it is not known."""
    known = ~np.isnan(rates)
    each = np.array([np.bincount(of_record, weights=one)[of_record] for one in known])  # known series of its record
    share = np.divide(known, each, out=np.zeros(rates.shape), where=known)
    records = share.sum(axis=1, keepdims=True)
    return np.asarray(np.divide(share, records, out=np.zeros(rates.shape), where=records > 0.0))


def _rate_below(runs: _Stretches, weights: Floats, hazard: HazardCurve, edges: Floats) -> Floats:
    """Return the part of (1) below each of the `edges`, in logarithms; `weights` are those of the series."""
    low, high, weight = runs.low[runs.hit], runs.high[runs.hit], weights[runs.group[runs.hit]]
    begun = _exceedance(hazard, low)
    parts = [float(weight @ (begun - _exceedance(hazard, np.clip(edge, low, high)))) for edge in edges]
    return np.array(parts)


def _exceedance(hazard: HazardCurve, u: Floats) -> Floats:
    """Return λ at exp(u), beyond the ends of the curve continued with its slopes there."""
    ends, slopes, known = hazard.log_intensity, hazard.slopes, hazard.log_rate
    inside = np.interp(u, ends, known)
    below = np.where(u < ends[0], known[0] - slopes[0] * (u - ends[0]), inside)
    return np.asarray(np.exp(np.where(u > ends[-1], known[-1] - slopes[-1] * (u - ends[-1]), below)))


def _interval(each: Floats, level: float, count: int, rng: np.random.Generator | None) -> tuple[Floats, Floats]:
    """Return the percentiles of the mean over resampled records; `each` has the shape (limit states, records)."""
    low, high = np.full((2, len(each)), np.nan)
    if count > 0 and each.shape[1] >= _FEWEST and rng is None:
        raise ParameterError(f"rng: missing, needed for resamples={count}. Pass np.random.default_rng(0)")
    tails = 0.5 * (1.0 - level)
    for place, state in enumerate(each):
        known = state[~np.isnan(state)]
        if rng is not None and count > 0 and known.size >= _FEWEST:
            means = known[rng.integers(known.size, size=(count, known.size))].mean(axis=1)
            low[place], high[place] = np.quantile(means, [tails, 1.0 - tails])
    return low, high
