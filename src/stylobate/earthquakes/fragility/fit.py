"""Lognormal fragility curves by maximum likelihood, with intervals."""

import numpy as np
import xarray as xr
from scipy.special import ndtr, ndtri

from stylobate.earthquakes.fragility.curves import CURVE_POINTS, Curve, curves_table
from stylobate.earthquakes.fragility.intervals import Likelihood, profile_ends
from stylobate.earthquakes.fragility.observations import LIMIT_STATE, Counting, Data, Floats, Observations
from stylobate.earthquakes.fragility.probit import Fits, FitStatus, fit_probit
from stylobate.earthquakes.fragility.resampling import Replicates, resampled
from stylobate.earthquakes.fragility.stripes import observed_shares
from stylobate.errors import ParameterError, require_whole
from stylobate.results.random_numbers import Rng, generator_of
from stylobate.studies.proportions import require_confidence


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
    x = np.geomspace(seen.intensity.min(), seen.intensity.max(), CURVE_POINTS)
    curves = [
        _curve(seen, place, x, level, replicates[place] if replicates else None) for place in range(len(seen.names))
    ]
    return (
        xr.merge([curves_table(seen, x, curves), observed_shares(seen, level)], combine_attrs="override")
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
