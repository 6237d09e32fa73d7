"""The law by which a run counts as converged to a known orbit, on sequences of distances."""

import math

import numpy as np
import pytest

from stylobate.engine.kernel.driver.loop import NEAR, ON_ORBIT, approach_after, is_certain

PERIODS = 400
REPEATS = 1e-6


def periods_until_certain(distances, multiplier):
    """Return after how many distances the law is satisfied, in a run that is judged after the last one; or None."""
    window = max(4, math.ceil(math.log(2.0) / -math.log(multiplier)))
    approach = (math.inf, 0.0, 0.0, 0.0)
    for number, distance in enumerate(distances, start=1):
        approach = approach_after(approach, distance, window, multiplier**window)
        if is_certain(approach, multiplier ** (len(distances) - number), REPEATS):
            return number
    return None


@pytest.mark.parametrize("multiplier", [0.05, 0.5, 0.84, 0.95, 0.99])
@pytest.mark.parametrize("first", [1.0, 0.01])
def test_distances_that_fall_at_the_rate_of_the_multiplier_are_certain(multiplier, first):
    length = 40 + math.ceil(2.0 * math.log(0.05 * REPEATS) / math.log(multiplier))
    distances = np.maximum(first * multiplier ** np.arange(length), 1e-9)  # no integrator falls further
    found = periods_until_certain(distances, multiplier)
    assert found is not None
    assert found < 0.7 * length
    assert distances[found - 1] < NEAR


def test_complex_multipliers_let_distances_oscillate():
    k = np.arange(PERIODS)
    distances = 0.9**k * (1.0 + 0.5 * np.cos(1.3 * k))
    assert periods_until_certain(distances, 0.9) is not None


def test_distances_that_stall_grow_or_fall_at_another_rate_are_never_certain():
    k = np.arange(PERIODS)
    assert periods_until_certain(np.full(PERIODS, 1e-3), 0.9) is None
    assert periods_until_certain(1e-5 * 1.02**k, 0.9) is None
    assert periods_until_certain(0.98**k, 0.9) is None
    assert periods_until_certain(0.6**k + 1e-4, 0.9) is None
    # A passage near a saddle: it comes near as fast as the multiplier demands, and leaves.
    assert periods_until_certain(0.9**k + 1e-4 * 1.1**k, 0.9) is None


def test_a_run_that_will_not_repeat_in_time_is_not_certain():
    multiplier = 0.9
    # Its distance is to fall to a twentieth of what counts as repeating.
    needed = math.log(0.05 * REPEATS / 1.0) / math.log(multiplier)
    assert periods_until_certain(multiplier ** np.arange(math.floor(needed) - 10), multiplier) is None
    assert periods_until_certain(multiplier ** np.arange(math.ceil(needed) + 10), multiplier) is not None


def test_a_run_on_the_orbit_is_certain_though_rounding_keeps_its_distance():
    scatter = ON_ORBIT * np.random.default_rng(0).uniform(0.01, 0.5, PERIODS)
    assert periods_until_certain(scatter, 0.84) is not None
