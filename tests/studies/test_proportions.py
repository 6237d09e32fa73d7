"""Intervals of counted proportions."""

import numpy as np
import pytest

from stylobate.errors import ParameterError
from stylobate.studies.proportions import wilson_interval


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
