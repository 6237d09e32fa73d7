"""Intervals of median and dispersion by profile likelihood: values that a likelihood-ratio test does not reject.

An interval contains each value whose log-likelihood, maximized over the other parameter, is less than half the quantile
of χ² with one degree of freedom below the maximum. A maximum need not exist: if the data do not bound the median or the
dispersion on one side, that end is 0 or infinite.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq
from scipy.special import log_ndtr, ndtri
from scipy.stats import chi2

from stylobate.earthquakes.fragility.observations import Floats
from stylobate.earthquakes.fragility.probit import Fits, FitStatus, score

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
            return float(np.sum(score(slope * z, self.hits, self.misses) * z))

        slope = _zero(rises, 0.0, 1.0 / self.range, _STEP / self.range)
        return self.at(-slope * log_median, slope)

    def of_slope(self, slope: float) -> float:
        """Maximize the log-likelihood of a dispersion 1/slope over the median."""

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
