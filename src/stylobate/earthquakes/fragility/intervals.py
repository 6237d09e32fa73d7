"""Intervals of median and dispersion by profile likelihood: what a likelihood-ratio test does not reject.

An interval holds each value at which the likelihood, made as large as the other number allows, is above its greatest by
no less than half the quantile of χ² with one degree of freedom. It needs no maximum: where the data leave the median or
the dispersion open to one side, that end is 0 or infinite.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq
from scipy.special import log_ndtr, ndtri
from scipy.stats import chi2

from stylobate.earthquakes.fragility.observations import Floats
from stylobate.earthquakes.fragility.probit import Fits, FitStatus, score

# Ends of intervals are found to this part, in the logarithm of the intensity and of the dispersion.
_TOLERANCE = 1e-9
# Beyond this slope, times the range of the logarithms, a curve is a step.
_STEP = 1e5
_DOUBLINGS = 60
# Where one intensity parts the data, and has both, a median this part of the range away determines its share.
_ASIDE = 1e-3


@dataclass(frozen=True, slots=True, kw_only=True)
class Likelihood:
    """The likelihood of one set of counts.

    Parameters
    ----------
    u
        Logarithms of the intensities, shape (n,).
    hits, misses
        How often each was reached and was not, shape (n,).
    best
        The greatest log-likelihood, or its least upper bound.
    """

    u: Floats
    hits: Floats
    misses: Floats
    best: float

    def at(self, intercept: float, slope: float) -> float:
        """Return the log-likelihood."""
        eta = intercept + slope * self.u
        return float(np.sum(self.hits * log_ndtr(eta) + self.misses * log_ndtr(-eta)))

    def of_median(self, log_median: float) -> float:
        """Return the log-likelihood with the dispersion that is most likely for a median."""
        z = self.u - log_median

        def rises(slope: float) -> float:
            return float(np.sum(score(slope * z, self.hits, self.misses) * z))

        slope = _zero(rises, 0.0, 1.0 / self.range, _STEP / self.range)
        return self.at(-slope * log_median, slope)

    def of_slope(self, slope: float) -> float:
        """Return the log-likelihood with the median that is most likely for a dispersion 1/slope."""

        def rises(intercept: float) -> float:
            return float(np.sum(score(intercept + slope * self.u, self.hits, self.misses)))

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
        """Return the log-likelihood of a share that does not depend on the intensity, at most or at least 1/2."""
        hits, misses = float(self.hits.sum()), float(self.misses.sum())
        share = hits / (hits + misses)
        share = min(share, 0.5) if below_half else max(share, 0.5)
        eta = float(ndtri(share))
        return sum(n * float(log_ndtr(sign * eta)) for n, sign in ((hits, 1.0), (misses, -1.0)) if n)


def profile_ends(
    likelihood: Likelihood, status: FitStatus, fits: Fits, confidence: float
) -> tuple[float, float, float, float]:
    """Return the ends of the intervals of median and dispersion of a set of counts and its fit."""
    if status in {FitStatus.NO_RUNS, FitStatus.NOT_INCREASING}:
        return 0.0, np.inf, 0.0, np.inf
    drop = 0.5 * float(chi2.ppf(confidence, 1))
    median = _median_interval(likelihood, _likely_median(likelihood, status, fits), drop)
    if status in {FitStatus.FITTED, FitStatus.SEPARATED}:
        return *median, *_dispersion_interval(likelihood, status, float(fits.slope[0]), drop)
    return *median, 0.0, np.inf


def _likely_median(likelihood: Likelihood, status: FitStatus, fits: Fits) -> float:
    """Return the logarithm of a median that is as likely as any, or nearly."""
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
    """Return the interval of the median.

    Parameters
    ----------
    likelihood
        Of the data.
    start
        Logarithm of a median whose likelihood is near the best one.
    drop
        How far below the best the log-likelihood is at the ends.
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
    """Return the interval of the dispersion; arguments as of `_median_interval`, and the most likely slope 1/β."""

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
    """Return where `above`, not negative at `start`, changes its sign in the direction of `step`."""
    near, far = start, start + step
    for _ in range(_DOUBLINGS):
        if above(far) < 0.0:
            return float(brentq(above, near, far, xtol=_TOLERANCE)) if above(near) > 0.0 else near
        near, far = far, far + 2.0 * (far - near)
    return float(np.copysign(np.inf, step))


def _zero(falls: Callable[[float], float], low: float, guess: float, high: float) -> float:
    """Return where a falling function is 0 between `low` and `high`, or the end that is nearest to it."""
    if falls(low) <= 0.0:
        return low
    near, far = low, guess
    while falls(far) > 0.0:
        if far >= high:
            return high
        near, far = far, min(4.0 * far, high)
    return float(brentq(falls, near, far))
