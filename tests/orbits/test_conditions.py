"""Which signs may tell of bifurcations, and which are those of rounding."""

from types import SimpleNamespace

import numpy as np
import pytest

from stylobate.engine.flow.integration import FlowStatus
from stylobate.orbits import arclength
from stylobate.orbits.arclength import Family, corrected
from stylobate.orbits.bifurcations import branching, complex_pairs, conditions_between, neimark_sacker

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


def normal_form(slope, push, arcs):
    """A point of the map (x, y) → (x + slope · (x − x0) + push · (λ − λ0), y/2); span and unit are 2."""
    matrix = np.diag([1.0 + slope, 0.5])
    sensitivity = np.array([push, 0.0])
    # The family goes along the null vector of (slope, push), in (x/unit, λ/span); y stands still.
    x, value = np.array([push, -slope]) / np.hypot(push, slope)
    tangent = np.array([x, 0.0] * arcs + [value])
    return SimpleNamespace(
        chain=SimpleNamespace(states=np.zeros((arcs, 2)), map_sensitivity=sensitivity),
        map_derivative=matrix,
        family=SimpleNamespace(span=2.0, system=SimpleNamespace(scale=2.0)),
        along=lambda direction: tangent if tangent @ direction >= 0.0 else -tangent,
    )


@pytest.mark.parametrize("arcs", [1, 2])
def test_the_determinant_of_a_branch_point_keeps_its_sign_where_the_family_turns_back(arcs):
    ahead = np.array([1.0, 0.0] * arcs + [0.0])
    # x² = λ: the slope of the map changes its sign on the way, the determinant does not: −½ · −(slope² + push²).
    found = [branching(normal_form(-2.0 * x, 1.0, arcs), ahead) for x in (-0.3, 0.0, 0.2)]
    assert found == pytest.approx([0.5 * np.hypot(2.0 * x, 1.0) for x in (-0.3, 0.0, 0.2)])


@pytest.mark.parametrize("arcs", [1, 2])
def test_the_determinant_of_a_branch_point_changes_its_sign_where_another_family_crosses(arcs):
    ahead = np.array([0.0, 0.0] * arcs + [1.0])
    # x³ = λx on the family x = 0: the map has the slope λ, and the parameter moves nothing.
    found = [branching(normal_form(value, 0.0, arcs), ahead) for value in (-0.2, 0.3)]
    assert found == pytest.approx([-0.5 * value for value in (-0.2, 0.3)])


@pytest.mark.parametrize(("miss", "reaches"), [(0.9, True), (1.1, False)])
def test_newtons_step_is_refused_if_it_is_longer_than_the_range_of_the_parameter(monkeypatch, miss, reaches):
    """Equations that are linear in (x, λ): the first step reaches the point, however far away."""

    def linear(system, states, *_, **__):
        return SimpleNamespace(
            status=FlowStatus.DONE, states=states, matrix=np.eye(1), by_parameter=np.zeros(1), residual=states - miss
        )

    monkeypatch.setattr(arclength, "shots", linear)
    system = SimpleNamespace(order=1, scale=1.0, derivative=lambda *_: None)
    system.changed = lambda **_: system
    found = corrected(Family(system, 1, "a", 1.0), np.zeros(2), np.array([0.0, 1.0]))
    if reaches:
        point, steps = found
        assert (point.chain.states[0, 0], steps) == (pytest.approx(miss), 2)
    else:
        assert found is FlowStatus.FAILED
