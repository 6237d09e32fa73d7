"""Lognormal fragility curves by maximum likelihood, with intervals: fits to any runs, or to an incremental analysis."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr
from scipy.special import ndtr, ndtri

from stylobate.earthquakes.fragility.likelihood import (
    Fits,
    FitStatus,
    Likelihood,
    Replicates,
    fit_probit,
    profile_ends,
    resampled,
)
from stylobate.earthquakes.fragility.observations import LIMIT_STATE, Counting, Data, Floats, Integers, Observations
from stylobate.errors import ParameterError, require_positive, require_whole
from stylobate.records.intensities import HorizontalComponent
from stylobate.results.outcomes import flag_attributes
from stylobate.results.random_numbers import Rng, generator_of
from stylobate.studies.proportions import require_confidence, wilson_interval

_CURVE_POINTS = 121
# Half-width of a curve without data, in dispersions.
_REACH = 3.5


@dataclass(frozen=True, slots=True, kw_only=True)
class Curve:
    """The fragility of one limit state.

    Parameters
    ----------
    numbers
        Numbers by the names of the variables.
    covariance
        Covariance of (ln median, ln dispersion).
    shares
        Probabilities along the curve, by the names of the variables.
    """

    numbers: dict[str, float]
    covariance: Floats
    shares: dict[str, Floats]


def fit_fragility(
    intensity: Data,
    reached: Data,
    *,
    record: Data | None = None,
    property_sample: Data | None = None,
    counting: Counting = Counting.AS_COMPUTED,
    confidence: float = 0.95,
    resamples: int = 0,
    rng: Rng | None = None,
) -> xr.Dataset:
    """Fit the lognormal fragility curve P = Φ(ln(x/median)/dispersion) by maximum likelihood.

    The likelihood uses binomial counts: Baker, "Efficient analytical fragility function fitting using dynamic
    structural analysis", Earthquake Spectra 31 (2015). It treats runs as independent. Runs of one record are not, least
    of all one record at many scales, and its intervals are then too narrow. With `resamples` the intervals come from a
    bootstrap over records.

    Parameters
    ----------
    intensity
        Intensity of each run, positive; a DataArray keeps its unit and name.
    reached
        Whether each run reached the limit state: True, False, or 1, 0 and −1 for not known. A DataArray may have the
        dimension `limit_state`, as from `limit_states`; each is fitted by itself. Plain arrays have one shape,
        DataArrays are broadcast by the names of their dimensions.
    record
        The record of each run, numbers or names; by default the dimension or coordinate `record` of `reached`.
    property_sample
        The sample of the column's properties of each run. It separates the runs of a record for `counting`.
    counting
        How runs above the first that reached the limit state count, if the column survives there.
    confidence
        Confidence level of the intervals.
    resamples
        Number of bootstrap samples of the records; 0 for intervals by profile likelihood.
    rng
        The seed or numpy.random.Generator that draws them.

    Returns
    -------
    xarray.Dataset
        Of kind "fragility", over `limit_state`: `median`, `dispersion`, each with `_low` and `_high`; `status`, a
        FitStatus: unless it is FITTED, median and dispersion are NaN, and their intervals contain what the data show;
        `covariance` of (ln median, ln dispersion) over `parameter` and `other_parameter`, from the observed
        information, or of the resamples; `log_likelihood`; `runs`, `runs_reached`, `runs_not_known`; `largest_safe` and
        `least_reached` intensity; `records`, and `non_monotone_records`, under which the column survives above an
        intensity that reached the limit state (−1 if no record is named); `resamples_without_fit`. Over `curve`:
        `curve_intensity`, within the data, and there `probability` with the ends of its interval at each. Over
        `stripe`: what was observed, see `stripe_share`, with intervals of Wilson, which treat runs as independent.

    Raises
    ------
    ParameterError
        If shapes differ, an intensity is not positive, or resamples lack records or an rng.

    Notes
    -----
    The band of the curve is that of a + b ln x, normal with the covariance of the fit, or from the percentiles of the
    resamples, corrected for bias and for few records. Below about 20 records the interval of the dispersion is still
    too narrow. A resample without a fit counts beyond both ends of an interval; one that an intensity separates has the
    dispersion 0 and its median in the middle of the gap. If the data themselves have no fit, the intervals are by
    profile likelihood even with resamples.

    Examples
    --------
    >>> found = fit_fragility([1.0, 2.0, 2.0, 3.0, 4.0, 4.0, 6.0], [0, 0, 1, 0, 1, 1, 1])
    >>> print(f"{found['median'].item():.3f} {found['dispersion'].item():.3f}")
    2.461 0.443
    """
    level = require_confidence(confidence)
    given = Observations.of(intensity, reached, record, property_sample)
    draws = require_whole("resamples", resamples, least=0)
    seen = given.counted(counting)
    non_monotone = given.non_monotone()
    replicates = _replicates(seen, draws, rng)
    x = np.geomspace(seen.intensity.min(), seen.intensity.max(), _CURVE_POINTS)
    curves = [
        _curve(seen, place, x, level, replicates[place] if replicates else None) for place in range(len(seen.names))
    ]
    return (
        xr.merge([_curves_table(seen, x, curves), _observed_shares(seen, level)], combine_attrs="override")
        .assign(
            non_monotone_records=(
                LIMIT_STATE,
                non_monotone,
                {"long_name": "records with survival above an intensity that reached it"},
            )
        )
        .assign_attrs(
            kind="fragility",
            confidence=level,
            counting=counting.value,
            resamples=draws,
            records=0 if seen.record is None else int(seen.record.max()) + 1,
            intervals=f"{draws} resamples of the records" if draws else "profile likelihood, runs taken as independent",
            band=f"{draws} resamples of the records" if draws else "normal, runs taken as independent",
        )
    )


def _replicates(seen: Observations, draws: int, rng: Rng | None) -> list[Replicates]:
    if not draws:
        return []
    if seen.record is None or seen.record.max() < 1:
        raise ParameterError(
            f"resamples: requires two or more records (got {draws} resamples). Add records, or pass resamples=0."
        )
    if rng is None:
        raise ParameterError("rng: required to resample the records (got None). Pass a seed, for example rng=0.")
    return resampled(seen, draws, generator_of(rng))


def _curve(seen: Observations, place: int, x: Floats, confidence: float, replicates: Replicates | None) -> Curve:
    decided = seen.reached[place] >= 0
    u, where = np.unique(np.log(seen.intensity[decided]), return_inverse=True)
    hits, misses = (
        np.bincount(where, weights=seen.reached[place][decided] == one, minlength=u.size).astype(float)
        for one in (1, 0)
    )
    if not u.size:
        u, hits, misses = np.log(seen.intensity[:1]), np.zeros(1), np.zeros(1)
    fits = fit_probit(u, hits[np.newaxis], misses[np.newaxis])
    status = FitStatus(fits.status[0])
    fitted = status is FitStatus.FITTED
    eta = fits.intercept[0] + fits.slope[0] * np.log(x)
    # Resamples of data without a fit may agree by chance, so the intervals come from the likelihood.
    if replicates is None or not fitted:
        likelihood = Likelihood(u=u, hits=hits, misses=misses, best=float(fits.log_likelihood[0]))
        covariance, ends = _covariance(fits), profile_ends(likelihood, status, fits, confidence)
        low, high = _band(fits, np.log(x), eta, confidence)
    else:
        covariance, ends = replicates.covariance(), replicates.ends(confidence)
        low, high = replicates.band(np.log(x), confidence)
    return Curve(
        numbers={
            "median": float(np.exp(-fits.intercept[0] / fits.slope[0])),
            "median_low": ends[0],
            "median_high": ends[1],
            "dispersion": float(1.0 / fits.slope[0]),
            "dispersion_low": ends[2],
            "dispersion_high": ends[3],
            "status": int(status),
            "log_likelihood": float(fits.log_likelihood[0]) if fitted else np.nan,
            "runs": int(np.count_nonzero(decided)),
            "runs_reached": int(hits.sum()),
            "runs_not_known": int(np.count_nonzero(~decided)),
            "largest_safe": float(np.max(seen.intensity, where=seen.reached[place] == 0, initial=0.0)),
            "least_reached": float(np.min(seen.intensity, where=seen.reached[place] == 1, initial=np.inf)),
            "resamples_without_fit": replicates.without_fit() if replicates else 0,
        },
        covariance=covariance,
        shares={"probability": ndtr(eta), "probability_low": low, "probability_high": high},
    )


def _covariance(fits: Fits) -> Floats:
    """Compute the covariance of (ln median, ln dispersion), with ln m = −a/b, ln β = −ln b."""
    if fits.status[0] != FitStatus.FITTED:
        return np.full((2, 2), np.nan)
    a, b = float(fits.intercept[0]), float(fits.slope[0])
    jacobian = np.array([[-1.0 / b, a / b**2], [0.0, -1.0 / b]])
    return np.asarray(jacobian @ np.linalg.inv(fits.information[0]) @ jacobian.T)


def _band(fits: Fits, u: Floats, eta: Floats, confidence: float) -> tuple[Floats, Floats]:
    """Compute the interval of the probability at each `u`, normal in η = a + bu."""
    if fits.status[0] != FitStatus.FITTED:
        return np.full(u.shape, np.nan), np.full(u.shape, np.nan)
    design = np.stack([np.ones_like(u), u])
    variance = np.einsum("in,ij,jn->n", design, np.linalg.inv(fits.information[0]), design)
    half = ndtri(0.5 + 0.5 * confidence) * np.sqrt(variance)
    return ndtr(eta - half), ndtr(eta + half)


_PROBABILITY = {"units": "1", "long_name": "probability of reaching the limit state"}


def _status_attributes() -> dict[str, object]:
    return flag_attributes("status of the fit", [status.name for status in FitStatus], dtype=np.int64)


def _curves_table(seen: Observations, x: Floats, curves: list[Curve]) -> xr.Dataset:
    """Collect the fits of all limit states, and their curves at intensities `x`."""
    about: dict[str, object] = {
        name: seen.attributes[name] for name in ("units", "component") if name in seen.attributes
    }
    names = {
        "median": {**about, "long_name": f"median {seen.attributes['long_name']}"},
        "median_low": {**about, "long_name": "lower end of the interval of the median"},
        "median_high": {**about, "long_name": "upper end of the interval of the median"},
        "dispersion": {"units": "1", "long_name": "dispersion"},
        "dispersion_low": {"units": "1", "long_name": "lower end of the interval of the dispersion"},
        "dispersion_high": {"units": "1", "long_name": "upper end of the interval of the dispersion"},
        "status": _status_attributes(),
        "log_likelihood": {"units": "1", "long_name": "log-likelihood"},
        "runs": {"units": "1", "long_name": "runs decided for the limit state"},
        "runs_reached": {"units": "1", "long_name": "runs that reached it"},
        "runs_not_known": {"units": "1", "long_name": "undecided runs"},
        "largest_safe": {**about, "long_name": "largest intensity that did not reach it"},
        "least_reached": {**about, "long_name": "smallest intensity that reached it"},
        "resamples_without_fit": {"units": "1", "long_name": "resamples without a fit"},
    }
    shares = {
        "probability": _PROBABILITY,
        "probability_low": {"units": "1", "long_name": "lower end of the interval of the probability"},
        "probability_high": {"units": "1", "long_name": "upper end of the interval of the probability"},
    }
    parameters = ["log median", "log dispersion"]
    return xr.Dataset(
        {
            **{name: (LIMIT_STATE, [one.numbers[name] for one in curves], attrs) for name, attrs in names.items()},
            "covariance": (
                (LIMIT_STATE, "parameter", "other_parameter"),
                np.array([one.covariance for one in curves]),
                {"units": "1", "long_name": "covariance of the logarithms of median and dispersion"},
            ),
            **{
                name: ((LIMIT_STATE, "curve"), np.array([one.shares[name] for one in curves]), attrs)
                for name, attrs in shares.items()
            },
        },
        coords={
            LIMIT_STATE: list(seen.names),
            "parameter": parameters,
            "other_parameter": parameters,
            "curve_intensity": ("curve", x, seen.attributes),
        },
    )


# Maximum number of separate intensities; more are grouped into bins with equal numbers of runs.
_MOST_STRIPES = 25
_BINS = 10


def _observed_shares(seen: Observations, confidence: float) -> xr.Dataset:
    """Compute fractions over `stripe`: runs of one intensity, or bins with equal numbers of runs.

    Each stripe has the geometric mean `stripe_intensity` of its intensities, and their range.
    """
    bins = _bins(seen.intensity)
    count = int(bins.max()) + 1
    logs = np.log(seen.intensity)
    mean = np.exp(np.bincount(bins, weights=logs) / np.bincount(bins))
    ends = np.array([[part.min(), part.max()] for part in (seen.intensity[bins == one] for one in range(count))])
    hits, decided = (
        np.array([np.bincount(bins, weights=state, minlength=count) for state in chosen])
        for chosen in (seen.reached == 1, seen.reached >= 0)
    )
    low, high = wilson_interval(hits, decided, confidence=confidence)
    dims = (LIMIT_STATE, "stripe")
    share = np.where(decided > 0.0, hits / np.maximum(decided, 1.0), np.nan)
    return xr.Dataset(
        {
            "stripe_runs": (dims, decided.astype(np.int64), {"units": "1", "long_name": "runs"}),
            "stripe_reached": (dims, hits.astype(np.int64), {"units": "1", "long_name": "runs that reached it"}),
            "stripe_share": (dims, share, {"units": "1", "long_name": "share of runs that reached it"}),
            "stripe_share_low": (dims, low, {"units": "1", "long_name": "lower end of its interval"}),
            "stripe_share_high": (dims, high, {"units": "1", "long_name": "upper end of its interval"}),
            "stripe_from": ("stripe", ends[:, 0], {**seen.attributes, "long_name": "least intensity"}),
            "stripe_to": ("stripe", ends[:, 1], {**seen.attributes, "long_name": "largest intensity"}),
        },
        coords={"stripe_intensity": ("stripe", mean, seen.attributes), LIMIT_STATE: list(seen.names)},
    )


def _bins(intensity: Floats) -> Integers:
    different, place = np.unique(intensity, return_inverse=True)
    if different.size <= _MOST_STRIPES:
        return np.asarray(place, dtype=np.int64)
    # Runs of one intensity stay together.
    first = np.searchsorted(np.sort(intensity), intensity)
    return np.asarray(np.unique(_BINS * first // intensity.size, return_inverse=True)[1], dtype=np.int64)


def lognormal_fragility(
    median: float,
    dispersion: float,
    *,
    name: str = "given",
    units: str = "1",
    component: str | HorizontalComponent | None = None,
) -> xr.Dataset:
    """Build a fragility from a known median and dispersion, without data or intervals.

    Parameters
    ----------
    median
        Intensity at which the limit state is reached with probability 1/2, in `units`.
    dispersion
        Standard deviation β of the logarithm of the capacity.
    name, units
        Name of the limit state, and unit of the intensity.
    component
        Definition of the horizontal component of the intensity, such as "RotD50"; None if it has none.

    Returns
    -------
    xarray.Dataset
        Of kind "fragility": `median`, `dispersion` and the curve.

    Raises
    ------
    ParameterError
        If a number is not positive, or the component is unknown.

    Examples
    --------
    >>> lognormal_fragility(3.0, 0.4)["median"].item()
    3.0
    """
    m, beta = require_positive("median", median), require_positive("dispersion", dispersion)
    x = m * np.exp(np.linspace(-_REACH * beta, _REACH * beta, _CURVE_POINTS))
    definition = {} if component is None else {"component": HorizontalComponent.named(component).value}
    about = {"units": units, "long_name": ", ".join(["intensity", *definition.values()]), **definition}
    return xr.Dataset(
        {
            "median": (LIMIT_STATE, [m], {**about, "long_name": f"median {about['long_name']}"}),
            "dispersion": (LIMIT_STATE, [beta], {"units": "1", "long_name": "dispersion"}),
            "status": (LIMIT_STATE, [int(FitStatus.FITTED)], _status_attributes()),
            "probability": ((LIMIT_STATE, "curve"), ndtr(np.log(x / m) / beta)[np.newaxis], _PROBABILITY),
        },
        coords={LIMIT_STATE: [name], "curve_intensity": ("curve", x, about)},
        attrs={"kind": "fragility", "intervals": "none"},
    )


# For fixed values of these dimensions and a fixed record, the intensity depends on the scale only.
_SERIES = ("rotation", "vertical", "property_sample")


_KINDS = ("incremental dynamic analysis", "slip analysis")


def fragility_of_runs(
    runs: xr.Dataset,
    *,
    counting: Counting = Counting.AS_COMPUTED,
    confidence: float = 0.95,
    resamples: int = 0,
    rng: Rng | None = None,
) -> xr.Dataset:
    """Fit fragility curves to an incremental dynamic analysis, one for each limit state.

    Parameters
    ----------
    runs
        From `incremental_dynamic_analysis`, complete or partial; after an interruption some runs are not known. Or
        from `slip_analysis`.
    counting
        How runs above the first that reached the limit state count, if the column survives there.
    confidence, resamples, rng
        As for `fit_fragility`. Without `resamples` the intervals treat runs as independent.

    Returns
    -------
    xarray.Dataset
        As from `fit_fragility`, with `record` and `property_sample` set from the runs: rotations, choices of the
        vertical component and property samples are series of their own within a record.

    Raises
    ------
    ParameterError
        If `runs` are of another kind, or an argument is out of range.

    Examples
    --------
    >>> import numpy as np
    >>> import stylobate as sb
    >>> from stylobate.earthquakes import incremental_dynamic_analysis
    >>> model = sb.Slender(sb.Column.solid(radius=0.2, height=2.0, density=2700.0), damping=0.02)
    >>> pulses = [sb.Pulse.one_sine(acceleration=1.0, angular_frequency=w) for w in (4.0, 5.0, 6.0, 8.0)]
    >>> runs = incremental_dynamic_analysis(model, pulses, scales=np.linspace(1.2, 4.2, 7))
    >>> found = fragility_of_runs(runs)
    >>> fallen = found.sel(limit_state="overturning")
    >>> int(fallen["runs"]), int(fallen["runs_reached"])
    (28, 16)
    """
    if not isinstance(runs, xr.Dataset) or runs.attrs.get("kind") not in _KINDS:
        got = runs.attrs.get("kind") if isinstance(runs, xr.Dataset) else repr(runs)
        raise ParameterError(f"runs must be an incremental dynamic analysis, got {got}")
    reached: Any = runs["reached"]
    series = [name for name in _SERIES if name in reached.dims]
    sample = xr.DataArray(0)
    for name in series:
        sample = sample * reached.sizes[name] + xr.DataArray(np.arange(reached.sizes[name]), dims=name)
    plain = reached.drop_vars([name for name in reached.coords if name not in ("record", "limit_state")])
    return fit_fragility(
        runs["intensity"].drop_vars(list(runs["intensity"].coords)),
        plain.drop_vars("record"),
        record=runs["record"].drop_vars("record") if "record" in runs.coords else None,
        property_sample=sample if series else None,
        counting=counting,
        confidence=confidence,
        resamples=resamples,
        rng=rng,
    ).assign_attrs(provenance=runs.attrs["provenance"])
