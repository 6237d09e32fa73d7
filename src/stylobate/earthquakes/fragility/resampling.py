"""Intervals by bootstrap over records: a cluster bootstrap, because runs of one record are dependent.

Field and Welsh, "Bootstrapping clustered data", J. R. Stat. Soc. B 69 (2007). The percentiles are corrected for the
median bias of the resamples (Efron, "Nonparametric standard errors and confidence intervals", Can. J. Stat. 9, 1981)
and widened as in Student's t for small numbers of records (Hesterberg, "What teachers should know about the bootstrap",
Am. Stat. 69, 2015).
"""

from dataclasses import dataclass

import numpy as np
from scipy.special import ndtr, ndtri
from scipy.stats import t as student

from stylobate.earthquakes.fragility.observations import Floats, Observations
from stylobate.earthquakes.fragility.probit import FitStatus, fit_probit


@dataclass(frozen=True, slots=True, kw_only=True)
class Replicates:
    """Fits to resamples of the records, arrays of shape (resamples,).

    Parameters
    ----------
    log_median, dispersion
        Fits; NaN without a fit; dispersion 0 if an intensity separates the resample.
    own
        Logarithm of the median, and dispersion, of the original data.
    records
        Number of records.
    """

    log_median: Floats
    dispersion: Floats
    own: tuple[float, float]
    records: int

    def without_fit(self) -> int:
        """Count the resamples without a fit."""
        return int(np.count_nonzero(np.isnan(self.log_median)))

    def covariance(self) -> Floats:
        """Compute the covariance of (ln median, ln dispersion) over the resamples with a fit."""
        used = self.dispersion > 0.0
        if np.count_nonzero(used) < 2:  # noqa: PLR2004  a covariance needs two
            return np.full((2, 2), np.nan)
        return np.asarray(np.cov(self.log_median[used], np.log(self.dispersion[used])))

    def ends(self, confidence: float) -> tuple[float, float, float, float]:
        """Compute the intervals of median and dispersion."""
        median = self._percentiles(np.exp(self.log_median), float(np.exp(self.own[0])), confidence, (0.0, np.inf))
        dispersion = self._percentiles(self.dispersion, self.own[1], confidence, (0.0, np.inf))
        return float(median[0]), float(median[1]), float(dispersion[0]), float(dispersion[1])

    def band(self, u: Floats, confidence: float) -> tuple[Floats, Floats]:
        """Compute the interval of the probability at each `u`."""
        ends = [
            self._percentiles(
                _shares(one, self.log_median, self.dispersion), float(_shares(one, *self.own)), confidence, (0.0, 1.0)
            )
            for one in u
        ]
        low, high = np.array(ends).T
        return low, high

    def _percentiles(
        self, values: Floats, own: float, confidence: float, extremes: tuple[float, float]
    ) -> tuple[float, float]:
        """Compute the ends of an interval; NaN values count beyond both ends."""
        if np.isnan(own):
            return extremes
        none = np.isnan(values)
        # Half of the ties and half of the NaN values count as lower.
        below = np.mean(np.where(none, 0.5, 0.5 * (values < own) + 0.5 * (values <= own)))
        bias = float(ndtri(np.clip(below, 0.5 / values.size, 1.0 - 0.5 / values.size)))
        free = self.records - 1.0
        reach = float(student.ppf(0.5 + 0.5 * confidence, free)) * np.sqrt(self.records / free)
        low = np.quantile(np.where(none, extremes[0], values), ndtr(2.0 * bias - reach), method="lower")
        high = np.quantile(np.where(none, extremes[1], values), ndtr(2.0 * bias + reach), method="higher")
        return float(low), float(high)


def _shares(u: float, log_median: Floats | float, dispersion: Floats | float) -> Floats:
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(ndtr(np.divide(np.subtract(u, log_median), dispersion)))


def resampled(seen: Observations, count: int, rng: np.random.Generator) -> list[Replicates]:
    """Fit `count` resamples for each limit state; all limit states share the drawn records."""
    record = seen.record
    if record is None:
        raise AssertionError("record: resampling needs the record of each run. Pass `record=`.")
    records = int(record.max()) + 1
    u, place = np.unique(np.log(seen.intensity), return_inverse=True)
    drawn = rng.multinomial(records, np.full(records, 1.0 / records), size=count).astype(float)
    found = []
    for state in seen.reached:
        counts = np.zeros((2, records, u.size))
        decided = state >= 0
        np.add.at(counts, (state[decided], record[decided], place[decided]), 1.0)
        weights = np.concatenate([np.ones((1, records)), drawn])
        found.append(_fitted(u, weights @ counts[1], weights @ counts[0], records))
    return found


def _fitted(u: Floats, hits: Floats, misses: Floats, records: int) -> Replicates:
    """Fit counts; the first set is that of the original data."""
    fits = fit_probit(u, hits, misses)
    log_median, dispersion = -fits.intercept / fits.slope, 1.0 / fits.slope
    separated = fits.status == FitStatus.SEPARATED
    level = np.broadcast_to(u, hits.shape)
    safe = np.max(level, axis=1, where=misses > 0.0, initial=-np.inf)
    least = np.min(level, axis=1, where=hits > 0.0, initial=np.inf)
    log_median[separated] = 0.5 * (safe[separated] + least[separated])
    dispersion[separated] = 0.0
    return Replicates(
        log_median=log_median[1:],
        dispersion=dispersion[1:],
        own=(float(log_median[0]), float(dispersion[0])),
        records=records,
    )
