"""Probit regression on u = ln x for the lognormal fragility P = Φ(ln(x/m)/β): many fits at once.

With a = −ln(m)/β and b = 1/β, η = a + bu, the log-likelihood of hits and misses

    ℓ = Σ hits ln Φ(η) + misses ln Φ(−η)                                                               (1)

is concave in (a, b), so Newton's method finds its only maximum. No maximum exists if one intensity separates hits from
misses (Albert and Anderson, "On the existence of maximum likelihood estimates in logistic regression models",
Biometrika 71, 1984).
"""

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
import numpy.typing as npt
from scipy.special import log_ndtr

from stylobate.earthquakes.fragility.observations import Floats, Integers
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


def score(eta: Floats, hits: Floats, misses: Floats) -> Floats:
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
