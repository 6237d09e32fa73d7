"""Confidence intervals of proportions counted in a sample."""

from statistics import NormalDist

import numpy as np
import numpy.typing as npt

from stylobate.errors import ParameterError, require_positive

Floats = npt.NDArray[np.float64]


def wilson_interval(count: npt.ArrayLike, total: npt.ArrayLike, *, confidence: float = 0.95) -> tuple[Floats, Floats]:
    """Return the confidence interval of a proportion `count`/`total`.

    The score interval of Wilson, "Probable inference, the law of succession, and statistical inference", J. Am. Stat.
    Assoc. 22 (1927). It lies within 0…1 and remains valid for counts of none and of all.

    Parameters
    ----------
    count, total
        Count and total, of any shapes that broadcast.
    confidence
        Confidence level: share of such intervals that contain the true proportion, between 0 and 1.

    Returns
    -------
    tuple
        Lower and upper end; 0 and 1 if `total` is 0.

    Raises
    ------
    ParameterError
        If `confidence` does not lie between 0 and 1.

    Examples
    --------
    >>> low, high = wilson_interval(0, 100)
    >>> float(low), round(float(high), 4)
    (0.0, 0.037)
    """
    z = NormalDist().inv_cdf((1.0 + require_confidence(confidence)) / 2.0)
    n = np.asarray(total, dtype=float)
    k, n = np.broadcast_arrays(np.asarray(count, dtype=float), n)
    some = np.maximum(n, 1.0)
    share, weight = k / some, z * z / some
    middle = (share + weight / 2.0) / (1.0 + weight)
    half = z * np.sqrt(share * (1.0 - share) / some + weight / (4.0 * some)) / (1.0 + weight)
    # At counts of none and of all, middle and half are equal except for rounding.
    low = np.where((n > 0.0) & (k > 0.0), np.maximum(middle - half, 0.0), 0.0)
    high = np.where((n > 0.0) & (k < n), np.minimum(middle + half, 1.0), 1.0)
    return low, high


def clustered_interval(shares: npt.ArrayLike, *, confidence: float = 0.95) -> tuple[Floats, Floats]:
    """Return the confidence interval of the mean of shares of clusters of runs, such as all runs under one record.

    Clusters are independent, runs of one cluster need not be. With the quantile z of the normal distribution, z²/2
    clusters of share 0 and as many of share 1 are added to the n clusters s_i::

        p = (Σ s_i + z²/2)/(n + z²),    σ² = [Σ (s_i − p)² + z²/2 (p² + (1 − p)²)]/(n + z²)²,    p ± zσ

    If each cluster has one run, this is the interval of Agresti and Coull, "Approximate is better than exact for
    interval estimation of binomial proportions", Am. Stat. 52 (1998).

    Parameters
    ----------
    shares
        Share of each cluster, between 0 and 1, along the last axis, shape (…, n).
    confidence
        Confidence level, between 0 and 1.

    Returns
    -------
    tuple
        Lower and upper end, shape (…), within 0…1.

    Raises
    ------
    ParameterError
        If `confidence` does not lie between 0 and 1.

    Examples
    --------
    >>> low, high = clustered_interval([0.0] * 100)
    >>> float(low), round(float(high), 3)
    (0.0, 0.044)
    """
    z = NormalDist().inv_cdf((1.0 + require_confidence(confidence)) / 2.0)
    each, added = np.asarray(shares, dtype=float), z * z / 2.0
    total = each.shape[-1] + 2.0 * added
    middle = (each.sum(axis=-1) + added) / total
    squares = ((each - middle[..., np.newaxis]) ** 2).sum(axis=-1)
    half = z * np.sqrt(squares + added * (middle**2 + (1.0 - middle) ** 2)) / total
    return np.maximum(middle - half, 0.0), np.minimum(middle + half, 1.0)


def require_confidence(confidence: float) -> float:
    """Return `confidence`, or raise ParameterError unless it lies between 0 and 1."""
    value = require_positive("confidence", confidence)
    if value >= 1.0:
        raise ParameterError(f"confidence must lie between 0 and 1, got {confidence!r}; 0.95 is usual")
    return value


def fraction_interval(
    count: npt.ArrayLike, unsettled: npt.ArrayLike, total: npt.ArrayLike, *, confidence: float = 0.95
) -> tuple[Floats, Floats]:
    """Return the confidence interval of a fraction of runs, some of which are still `unsettled`.

    The lower end counts no unsettled run, the upper end counts all of them; see `wilson_interval`.
    """
    low, _ = wilson_interval(count, total, confidence=confidence)
    _, high = wilson_interval(np.add(count, unsettled), total, confidence=confidence)
    return low, high
