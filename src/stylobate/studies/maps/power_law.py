"""Power-law fit to counted shares, by maximum likelihood."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.optimize import minimize
from scipy.special import xlogy

from stylobate.studies.maps.stroboscopic import Floats

# Shares above this are near saturation, and the power law does not hold.
_LARGEST_SHARE = 0.5
# Tolerance of the simplex that maximises the likelihood, in log f.
_FIT_TOLERANCE = 1e-9
_LEAST_POINTS = 2


@dataclass(frozen=True, slots=True)
class PowerLaw:
    """The law f = prefactor · x^exponent.

    Attributes
    ----------
    exponent, prefactor
        Parameters of the law; NaN with fewer than two points.
    standard_error
        Standard error of the exponent, from the Fisher information of the binomial counts; multiplied by the root of
        `misfit` if the misfit is above 1.
    misfit
        Deviance per degree of freedom: about 1 if the law holds, far above 1 otherwise. NaN for two points.
    used
        Whether the fit uses each point.
    """

    exponent: float
    prefactor: float
    standard_error: float
    misfit: float
    used: npt.NDArray[np.bool_]

    def at(self, x: Floats) -> Floats:
        """Return f at `x`."""
        return np.asarray(self.prefactor * x**self.exponent)


def fit_power_law(x: Floats, count: npt.ArrayLike, total: npt.ArrayLike) -> PowerLaw:
    """Fit a power law to the shares `count`/`total` at `x` by maximum likelihood.

    Counts are binomial, so that points with a count of zero have the right weight. Points with more than half of the
    total are left out, because their share is near saturation.

    Parameters
    ----------
    x
        Positive numbers, shape (n,).
    count, total
        Count and total at each.
    """
    k, n = np.asarray(count, dtype=float), np.asarray(total, dtype=float)
    used = (n > 0.0) & (k <= _LARGEST_SHARE * n)
    if np.count_nonzero(used & (k > 0.0)) < _LEAST_POINTS:
        return PowerLaw(np.nan, np.nan, np.nan, np.nan, used)
    k, n, logs = k[used], n[used], np.log(x[used])
    middle = float(np.average(logs, weights=k))
    (level, slope), deviance = _most_likely(logs - middle, k, n)
    share = np.exp(level + slope * (logs - middle))
    # Fisher information of (level, slope): the variance of log(k/n) is (1 − f)/(n f).
    weight = n * share / (1.0 - share)
    offset = logs - middle
    information = np.array([[weight.sum(), weight @ offset], [weight @ offset, weight @ offset**2]])
    error = float(np.sqrt(np.linalg.inv(information)[1, 1]))
    freedom = k.size - _LEAST_POINTS
    misfit = deviance / freedom if freedom else np.nan
    spread = np.sqrt(max(1.0, misfit)) if freedom else 1.0
    return PowerLaw(slope, float(np.exp(level - slope * middle)), error * spread, misfit, used)


def _most_likely(x: Floats, k: Floats, n: Floats) -> tuple[tuple[float, float], float]:
    """Return level and slope of log f against `x` of maximum likelihood, and their deviance."""

    def deviance(law: Floats) -> float:
        share = np.exp(law[0] + law[1] * x)
        if np.any(share >= 1.0):
            return np.inf
        missed = n - k
        return float(2.0 * np.sum(xlogy(k, k / (n * share)) + xlogy(missed, missed / (n * (1.0 - share)))))

    found = k > 0.0
    slope, level = np.polyfit(x[found], np.log(k[found] / n[found]), 1, w=np.sqrt(k[found]))
    # If the law through the counts would exceed 1, the search starts lower.
    level -= max(0.0, float(np.max(level + slope * x)) + 0.1)
    best = minimize(
        deviance,
        (level, slope),
        method="Nelder-Mead",
        options={"xatol": _FIT_TOLERANCE, "fatol": _FIT_TOLERANCE, "maxiter": 10_000},
    )
    return (float(best.x[0]), float(best.x[1])), float(best.fun)
