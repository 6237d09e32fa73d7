"""Intervals of counted proportions."""

from statistics import NormalDist

import numpy as np
import pytest

from stylobate.errors import ParameterError
from stylobate.studies.proportions import clustered_interval, wilson_interval


def test_the_ends_of_the_interval_are_just_rejected_by_the_score_test():
    count, total = np.array([1, 7, 50, 99]), np.array([10, 20, 1000, 100])
    normal_95 = 1.959963984540054  # quantile of the normal distribution for 97.5 %
    for end in wilson_interval(count, total):
        deviation = np.abs(count / total - end) / np.sqrt(end * (1.0 - end) / total)
        np.testing.assert_allclose(deviation, normal_95, rtol=1e-12)


def test_the_interval_stays_within_0_and_1_and_holds_all_of_it_for_no_run():
    low, high = wilson_interval([0, 10, 0], [10, 10, 0])
    assert (low[0], high[1]) == (0.0, 1.0)
    assert 0.0 < high[0] < 1.0
    assert 0.0 < low[1] < 1.0
    assert (low[2], high[2]) == (0.0, 1.0)


def test_more_confidence_is_a_wider_interval():
    narrow, wide = (wilson_interval(3, 10, confidence=level) for level in (0.8, 0.99))
    assert wide[0] < narrow[0] < narrow[1] < wide[1]


@pytest.mark.parametrize("confidence", [0.0, 1.0, 95.0])
def test_a_confidence_outside_0_and_1_is_refused(confidence):
    with pytest.raises(ParameterError, match="confidence"):
        wilson_interval(1, 2, confidence=confidence)


def test_a_clustered_interval_of_single_runs_is_that_of_agresti_and_coull():
    n, k, z = 40, 7, NormalDist().inv_cdf(0.975)
    low, high = clustered_interval(np.repeat([1.0, 0.0], [k, n - k]))
    middle = (k + z**2 / 2) / (n + z**2)
    half = z * np.sqrt(middle * (1 - middle) / (n + z**2))
    assert [low, high] == pytest.approx([middle - half, middle + half], rel=1e-12)


@pytest.mark.parametrize("alike", [1.0, 0.5, 0.05])  # correlation of two runs of one cluster
@pytest.mark.parametrize("mean", [0.05, 0.3])
def test_a_clustered_interval_covers_the_mean_although_runs_of_a_cluster_are_not_independent(mean, alike):
    rng, trials, clusters, runs = np.random.default_rng(1), 2000, 30, 20
    if alike == 1.0:
        own = (rng.random((trials, clusters)) < mean).astype(float)
    else:
        size = 1.0 / alike - 1.0
        own = rng.beta(mean * size, (1.0 - mean) * size, size=(trials, clusters))
    shares = rng.binomial(runs, own) / runs
    low, high = clustered_interval(shares)
    # Three standard errors of the count of trials below the level.
    least = 0.95 - 3.0 * np.sqrt(0.95 * 0.05 / trials)
    assert np.mean((low <= mean) & (mean <= high)) >= least
    naive_low, naive_high = wilson_interval(shares.sum(axis=-1) * runs, clusters * runs)
    if alike >= 0.5:  # where runs were counted as independent, the interval fails
        assert np.mean((naive_low <= mean) & (mean <= naive_high)) < 0.75
