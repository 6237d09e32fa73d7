"""A power law through counted shares, by maximum likelihood."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.optimize import minimize
from scipy.special import xlogy

from stylobate.studies.maps.stroboscopic import Floats

# Shares above this are near saturation, where no power law holds.
_LARGEST_SHARE = 0.5
# Of the simplex that finds the largest likelihood, in log f.
_FIT_TOLERANCE = 1e-9
_LEAST_POINTS = 2


@dataclass(frozen=True, slots=True)
class PowerLaw:
    """The law f = prefactor · x^exponent.

    Attributes
    ----------
    exponent, prefactor
        Of the law; NaN with fewer than two points.
    standard_error
        Of the exponent, from the Fisher information of the binomial counts, times the root of `misfit` where that is
        above 1.
    misfit
        Deviance to a degree of freedom: about 1 if the law holds, far above where it does not. NaN for two points.
    used
        Which points the fit rests on.
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
    """Return the power law that makes the shares `count`/`total` at `x` most likely.

    Counts are binomial, so that points where nothing was counted weigh as much as they inform. Points where more than
    half were counted are left out: there the share is near saturation.

    Parameters
    ----------
    x
        Positive, shape (n,).
    count, total
        How many of how many at each.
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
    """Return level and slope of log f against `x` of the largest likelihood, and the deviance there."""

    def deviance(law: Floats) -> float:
        share = np.exp(law[0] + law[1] * x)
        if np.any(share >= 1.0):
            return np.inf
        missed = n - k
        return float(2.0 * np.sum(xlogy(k, k / (n * share)) + xlogy(missed, missed / (n * (1.0 - share)))))

    found = k > 0.0
    slope, level = np.polyfit(x[found], np.log(k[found] / n[found]), 1, w=np.sqrt(k[found]))
    # Where the law through the counts would pass 1, it begins lower.
    level -= max(0.0, float(np.max(level + slope * x)) + 0.1)
    best = minimize(
        deviance,
        (level, slope),
        method="Nelder-Mead",
        options={"xatol": _FIT_TOLERANCE, "fatol": _FIT_TOLERANCE, "maxiter": 10_000},
    )
    return (float(best.x[0]), float(best.x[1])), float(best.fun)
