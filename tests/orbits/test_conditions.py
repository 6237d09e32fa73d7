"""Which signs may tell of bifurcations, and which are those of rounding."""

from types import SimpleNamespace

import numpy as np
import pytest

from stylobate.orbits.conditions import complex_pairs, conditions_between, neimark_sacker

ALONG = np.array([1.0])


def point(*multipliers):
    values = np.array(multipliers, dtype=complex)
    return SimpleNamespace(multipliers=values, map_multipliers=values)


def pair(size, angle=1.0):
    return size * np.exp(1j * angle), size * np.exp(-1j * angle)


SLOW = (50.0, *pair(0.6), 0.001)
FAST = (3e8, 5e6, 2e-8, 1e-9)


def test_modulated_motion_is_looked_for_among_all_pairs_where_multipliers_are_known():
    assert conditions_between(point(*SLOW), point(*SLOW))["Neimark-Sacker"] is neimark_sacker


def test_without_damping_no_modulated_motion_is_looked_for():
    neutral = point(2.0, 0.5, *pair(1.0))
    assert "Neimark-Sacker" not in conditions_between(neutral, point(*SLOW))


def test_the_rounding_of_a_large_multiplier_tells_of_no_bifurcation():
    assert "Neimark-Sacker" not in conditions_between(point(*FAST), point(*FAST))
    assert "Neimark-Sacker" not in conditions_between(point(*FAST), point(3e8, *pair(0.9), 1e-9))


@pytest.mark.parametrize(("sizes", "crosses"), [((0.9, 1.1), True), ((0.8, 0.9), False)])
def test_beside_a_large_multiplier_a_complex_pair_is_seen_to_cross_the_unit_circle(sizes, crosses):
    first, second = (point(3e8, *pair(size), rounding) for size, rounding in zip(sizes, (1e-9, -1e-9), strict=True))
    condition = conditions_between(first, second)["Neimark-Sacker"]
    assert condition is complex_pairs
    assert (condition(first, ALONG) * condition(second, ALONG) < 0.0) == crosses
