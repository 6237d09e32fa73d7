"""The likelihood of lognormal fragilities P = Φ(ln(x/m)/β): fits, and intervals by profile or by resampling records.

Fits: probit regression on u = ln x, many at once. With a = −ln(m)/β and b = 1/β, η = a + bu, the log-likelihood of hits
and misses

    ℓ = Σ hits ln Φ(η) + misses ln Φ(−η)                                                               (1)

is concave in (a, b), so Newton's method finds its only maximum. No maximum exists if one intensity separates hits from
misses (Albert and Anderson, "On the existence of maximum likelihood estimates in logistic regression models",
Biometrika 71, 1984).

Profile likelihood: an interval contains each value that a likelihood-ratio test does not reject, that is, whose
log-likelihood, maximized over the other parameter, is less than half the quantile of χ² with one degree of freedom
below the maximum. A maximum need not exist: if the data do not bound the median or the dispersion on one side, that end
is 0 or infinite.

Resampling: a cluster bootstrap over records, because runs of one record are dependent. Field and Welsh, "Bootstrapping
clustered data", J. R. Stat. Soc. B 69 (2007). The percentiles are corrected for the median bias of the resamples
(Efron, "Nonparametric standard errors and confidence intervals", Can. J. Stat. 9, 1981) and widened as in Student's t
for small numbers of records (Hesterberg, "What teachers should know about the bootstrap", Am. Stat. 69, 2015).
"""

from collections.abc import Callable
from dataclasses import dataclass
from enum import IntEnum

import numpy as np
import numpy.typing as npt
from scipy.optimize import brentq
from scipy.special import log_ndtr, ndtr, ndtri
from scipy.stats import chi2
from scipy.stats import t as student

from stylobate.earthquakes.fragility.observations import Floats, Integers, Observations
from stylobate.errors import Named

# Newton's method ends if a step gains less than this fraction of ℓ, far below any standard error.
_GAIN = 1e-14
_STEPS = 60
_HALVINGS = 40
_LOG_ROOT_2PI = 0.5 * np.log(2.0 * np.pi)


class FitStatus(Named, IntEnum):
    """Whether the data determine a lognormal fragility, and if not, the reason."""

    FITTED = 0
    """Median and dispersion have the maximum likelihood."""
    NO_RUNS = 1
    """Every run is undecided."""
    NONE_REACHED = 2
    """No run reached it: the median lies above, the dispersion is unknown."""
    ALL_REACHED = 3
    """Every run reached it: the median lies below, the dispersion is unknown."""
    ONE_INTENSITY = 4
    """All runs have one intensity: only the fraction reached there is known."""
    SEPARATED = 5
    """All runs above some intensity reached it, no run below: the median lies in the gap, the dispersion may be 0."""
    NOT_INCREASING = 6
    """It is reached no more often at higher intensities: no lognormal fragility describes the data."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Fits:
    """Fits of one set of intensities with several sets of counts, arrays of shape (fits,).

    Parameters
    ----------
    status
        Values of FitStatus.
    intercept, slope
        a and b; NaN if the status is not FITTED.
    log_likelihood
        Maximum of (1), or its supremum if there is no maximum.
    information
        Observed information of (a, b), shape (fits, 2, 2).
    """

    status: Integers
    intercept: Floats
    slope: Floats
    log_likelihood: Floats
    information: Floats


def fit_probit(u: Floats, hits: Floats, misses: Floats) -> Fits:
    """Compute the maximum-likelihood fits.

    Parameters
    ----------
    u
        Logarithms of the intensities, shape (n,).
    hits, misses
        Numbers of runs that reached the limit state, and that did not, shape (fits, n).
    """
    status = _existence(u, hits, misses)
    solved = status == FitStatus.FITTED
    middle, width = float(u.mean()), float(u.std()) or 1.0
    z = (u - middle) / width
    theta = np.full((len(hits), 2), np.nan)
    theta[solved] = _newton(z, hits[solved], misses[solved])
    falling = solved & ~(theta[:, 1] > 0.0)
    status[falling] = FitStatus.NOT_INCREASING
    fitted = status == FitStatus.FITTED
    theta[~fitted] = np.nan
    slope = theta[:, 1] / width
    intercept = theta[:, 0] - slope * middle
    likelihood = np.array([_supremum(*one) for one in zip(hits, misses, strict=True)])
    likelihood[fitted] = log_likelihood(theta[fitted, 0], theta[fitted, 1], z, hits[fitted], misses[fitted])
    information = np.full((len(hits), 2, 2), np.nan)
    eta = intercept[fitted, np.newaxis] + slope[fitted, np.newaxis] * u
    information[fitted] = _derivatives(eta, u, hits[fitted], misses[fitted])[1]
    return Fits(status=status, intercept=intercept, slope=slope, log_likelihood=likelihood, information=information)


def log_likelihood(intercept: Floats, slope: Floats, u: Floats, hits: Floats, misses: Floats) -> Floats:
    """Compute (1), of shape (fits,)."""
    eta = intercept[:, np.newaxis] + slope[:, np.newaxis] * u
    return np.asarray((hits * log_ndtr(eta) + misses * log_ndtr(-eta)).sum(axis=-1))


def _score(eta: Floats, hits: Floats, misses: Floats) -> Floats:
    """Compute dℓ/dη of each run."""
    return np.asarray(hits * _mills(eta) - misses * _mills(-eta))


def _mills(z: Floats) -> Floats:
    """Compute φ(z)/Φ(z)."""
    return np.asarray(np.exp(-0.5 * z * z - _LOG_ROOT_2PI - log_ndtr(z)))


def _derivatives(eta: Floats, u: Floats, hits: Floats, misses: Floats) -> tuple[Floats, Floats]:
    """Compute gradient and negative Hessian of (1) in (a, b)."""
    up, down = _mills(eta), _mills(-eta)
    first = hits * up - misses * down
    second = hits * up * (up + eta) + misses * down * (down - eta)
    design = np.stack([np.ones_like(u), u])
    return first @ design.T, np.einsum("fn,in,jn->fij", second, design, design)


def _newton(u: Floats, hits: Floats, misses: Floats) -> Floats:
    """Find (a, b) at the maximum of (1), for counts that have a maximum."""
    theta: Floats = np.zeros((len(hits), 2))
    value = log_likelihood(theta[:, 0], theta[:, 1], u, hits, misses)
    active = np.arange(len(hits))
    for _ in range(_STEPS):
        if not active.size:
            break
        eta = theta[active, :1] + theta[active, 1:] * u
        gradient, curvature = _derivatives(eta, u, hits[active], misses[active])
        step = np.asarray(np.linalg.solve(curvature, gradient[..., np.newaxis])[..., 0], dtype=np.float64)
        gain = np.einsum("fi,fi->f", gradient, step)
        theta[active], value[active] = _climb(theta[active], step, value[active], u, hits[active], misses[active])
        active = active[gain > _GAIN * (1.0 + np.abs(value[active]))]
    return theta


def _climb(
    theta: Floats, step: Floats, value: Floats, u: Floats, hits: Floats, misses: Floats
) -> tuple[Floats, Floats]:
    """Take steps, each halved until it does not lower the likelihood."""
    part = np.ones(len(theta))
    for _ in range(_HALVINGS):
        trial = theta + part[:, np.newaxis] * step
        reached = log_likelihood(trial[:, 0], trial[:, 1], u, hits, misses)
        worse = ~(reached >= value - _GAIN * (1.0 + np.abs(value)))
        if not worse.any():
            return trial, reached
        part = np.where(worse, 0.5 * part, part)
    return np.where(worse[:, np.newaxis], theta, trial), np.where(worse, value, reached)


def _existence(u: Floats, hits: Floats, misses: Floats) -> Integers:
    """Return FITTED if (1) has a maximum, else the status that states the reason."""
    hit, miss = hits > 0.0, misses > 0.0
    least_hit, largest_hit = _range(u, hit)
    least_miss, largest_miss = _range(u, miss)
    none, all_of_them = ~hit.any(axis=1), ~miss.any(axis=1)
    single = np.minimum(least_hit, least_miss) == np.maximum(largest_hit, largest_miss)
    cases = {
        FitStatus.NO_RUNS: none & all_of_them,
        FitStatus.NONE_REACHED: none,
        FitStatus.ALL_REACHED: all_of_them,
        FitStatus.ONE_INTENSITY: single,
        FitStatus.SEPARATED: largest_miss <= least_hit,
        FitStatus.NOT_INCREASING: largest_hit <= least_miss,
    }
    found = np.select([np.asarray(case) for case in cases.values()], [int(one) for one in cases], FitStatus.FITTED)
    return found.astype(np.int64)


def _range(u: Floats, chosen: npt.NDArray[np.bool_]) -> tuple[Floats, Floats]:
    level = np.broadcast_to(u, chosen.shape)
    least = np.min(level, axis=1, where=chosen, initial=np.inf)
    return np.asarray(least), np.asarray(np.max(level, axis=1, where=chosen, initial=-np.inf))


def _supremum(hits: Floats, misses: Floats) -> float:
    """Compute the supremum of (1) for counts that an intensity separates: only intensities with both counts add to it.

    All counts of an intensity are in one entry.
    """
    total = hits + misses
    both = (hits > 0.0) & (misses > 0.0)
    k, n = hits[both], total[both]
    return float(np.sum(k * np.log(k / n) + (n - k) * np.log1p(-k / n)))


# Tolerance of the ends of intervals, in the logarithm of the intensity and of the dispersion.
_TOLERANCE = 1e-9
# Beyond this slope, times the range of the logarithms, a curve is a step.
_STEP = 1e5
_DOUBLINGS = 60
# If one intensity separates the data and has hits and misses, a median at this fraction of the range from it fits them.
_ASIDE = 1e-3


@dataclass(frozen=True, slots=True, kw_only=True)
class Likelihood:
    """The likelihood of one set of counts.

    Parameters
    ----------
    u
        Logarithms of the intensities, shape (n,).
    hits, misses
        Numbers of runs that reached the limit state, and that did not, shape (n,).
    best
        Maximum of the log-likelihood, or its supremum.
    """

    u: Floats
    hits: Floats
    misses: Floats
    best: float

    def at(self, intercept: float, slope: float) -> float:
        """Compute the log-likelihood."""
        eta = intercept + slope * self.u
        return float(np.sum(self.hits * log_ndtr(eta) + self.misses * log_ndtr(-eta)))

    def of_median(self, log_median: float) -> float:
        """Maximize the log-likelihood of a median over the dispersion."""
        z = self.u - log_median

        def rises(slope: float) -> float:
            return float(np.sum(_score(slope * z, self.hits, self.misses) * z))

        slope = _zero(rises, 0.0, 1.0 / self.range, _STEP / self.range)
        return self.at(-slope * log_median, slope)

    def of_slope(self, slope: float) -> float:
        """Maximize the log-likelihood of a dispersion 1/slope over the median."""

        def rises(intercept: float) -> float:
            return float(np.sum(_score(intercept + slope * self.u, self.hits, self.misses)))

        low = -slope * float(self.u.max()) - 1.0
        high = -slope * float(self.u.min()) + 1.0
        while rises(low) < 0.0:
            low -= high - low
        while rises(high) > 0.0:
            high += high - low
        return self.at(float(brentq(rises, low, high)), slope)

    @property
    def range(self) -> float:
        """Range of the logarithms."""
        return float(np.ptp(self.u)) or 1.0

    def without_slope(self, *, below_half: bool) -> float:
        """Maximize the log-likelihood of a probability that is the same at all intensities, at most or at least 1/2."""
        hits, misses = float(self.hits.sum()), float(self.misses.sum())
        share = hits / (hits + misses)
        share = min(share, 0.5) if below_half else max(share, 0.5)
        eta = float(ndtri(share))
        return sum(n * float(log_ndtr(sign * eta)) for n, sign in ((hits, 1.0), (misses, -1.0)) if n)


def profile_ends(
    likelihood: Likelihood, status: FitStatus, fits: Fits, confidence: float
) -> tuple[float, float, float, float]:
    """Compute the intervals of median and dispersion for a set of counts and its fit."""
    if status in {FitStatus.NO_RUNS, FitStatus.NOT_INCREASING}:
        return 0.0, np.inf, 0.0, np.inf
    drop = 0.5 * float(chi2.ppf(confidence, 1))
    median = _median_interval(likelihood, _likely_median(likelihood, status, fits), drop)
    if status in {FitStatus.FITTED, FitStatus.SEPARATED}:
        return *median, *_dispersion_interval(likelihood, status, float(fits.slope[0]), drop)
    return *median, 0.0, np.inf


def _likely_median(likelihood: Likelihood, status: FitStatus, fits: Fits) -> float:
    """Return the logarithm of a median with the maximum likelihood, or nearly."""
    u, hits, misses = likelihood.u, likelihood.hits, likelihood.misses
    if status is FitStatus.FITTED:
        return float(-fits.intercept[0] / fits.slope[0])
    safe = float(np.max(u, where=misses > 0.0, initial=-np.inf))
    least = float(np.min(u, where=hits > 0.0, initial=np.inf))
    if status is FitStatus.NONE_REACHED:
        return safe
    if status is FitStatus.ALL_REACHED:
        return least
    shared = u == safe
    more = float(np.sum(hits[shared] - misses[shared])) if safe == least else 0.0
    return 0.5 * (safe + least) - float(np.sign(more)) * _ASIDE * likelihood.range


def _median_interval(likelihood: Likelihood, start: float, drop: float) -> tuple[float, float]:
    """Compute the interval of the median.

    Parameters
    ----------
    likelihood
        Likelihood of the data.
    start
        Logarithm of a median whose likelihood is near the maximum.
    drop
        Difference between the maximum log-likelihood and that at the ends.
    """
    ends = []
    for sense in (-1.0, 1.0):
        if likelihood.best - likelihood.without_slope(below_half=sense > 0.0) < drop:
            ends.append(sense * np.inf)
            continue

        def above(log_median: float) -> float:
            return likelihood.of_median(log_median) - likelihood.best + drop

        ends.append(_outwards(above, start, sense * 0.1 * likelihood.range))
    return float(np.exp(ends[0])), float(np.exp(ends[1]))


def _dispersion_interval(likelihood: Likelihood, status: FitStatus, slope: float, drop: float) -> tuple[float, float]:
    """Compute the interval of the dispersion; arguments as for `_median_interval`, and the most likely slope 1/β."""

    def above(log_slope: float) -> float:
        return likelihood.of_slope(float(np.exp(log_slope))) - likelihood.best + drop

    separated = status is FitStatus.SEPARATED
    start = np.log(_STEP / likelihood.range if separated else slope)
    total = float(likelihood.hits.sum() + likelihood.misses.sum())
    flat = max(likelihood.without_slope(below_half=half) for half in (True, False)) if total else 0.0
    high = np.inf if likelihood.best - flat < drop else float(np.exp(-_outwards(above, start, -0.5)))
    low = 0.0 if separated else float(np.exp(-_outwards(above, start, 0.5)))
    return low, high


def _outwards(above: Callable[[float], float], start: float, step: float) -> float:
    """Find the zero of `above`, which is not negative at `start`, in the direction of `step`."""
    near, far = start, start + step
    for _ in range(_DOUBLINGS):
        if above(far) < 0.0:
            return float(brentq(above, near, far, xtol=_TOLERANCE)) if above(near) > 0.0 else near
        near, far = far, far + 2.0 * (far - near)
    return float(np.copysign(np.inf, step))


def _zero(falls: Callable[[float], float], low: float, guess: float, high: float) -> float:
    """Find the zero of a falling function between `low` and `high`, or the end nearest to it."""
    if falls(low) <= 0.0:
        return low
    near, far = low, guess
    while falls(far) > 0.0:
        if far >= high:
            return high
        near, far = far, min(4.0 * far, high)
    return float(brentq(falls, near, far))


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
