"""What a standing column does first: against the instantaneous law sampled over a period, and in known cases."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from stylobate import theory
from stylobate.errors import ParameterError
from stylobate.theory import FirstMotion, first_motion, start_of_motion

EPS = float(np.finfo(float).eps)
TURN = 2.0 * math.pi

angles = st.floats(-math.pi, math.pi)
shapes = st.tuples(st.floats(-2.0, 2.0), st.floats(-2.0, 2.0), angles)
grounds = st.fixed_dictionaries(
    {"c": st.floats(0.02, 1.5), "friction": st.floats(0.02, 1.5), "incline": st.floats(-0.5, 0.5)}
)


def over_a_period(shape, factor, ground, phase):
    """What the column does in a motion `factor` times the shape, at the given phases."""
    along, normal, lag = shape
    return first_motion(factor * along * np.cos(phase), factor * normal * np.cos(phase + lag), **ground)


@given(shape=shapes, ground=grounds)
def test_it_stays_below_the_amplitude_and_moves_as_told_at_the_phase_above_it(shape, ground):
    found = start_of_motion(shape[0], shape[1], phase=shape[2], **ground)
    assume(math.isfinite(found.amplitude) and 0.0 < found.amplitude < 1e6)
    below = over_a_period(shape, 0.9999 * found.amplitude, ground, np.linspace(0.0, TURN, 721))
    assert np.all(below == FirstMotion.NONE)
    if found.first != FirstMotion.LIFT_OFF:  # it may do so at once if the cone closes with little load on the friction
        assume(found.lift_off > 1.01 * found.amplitude)
    above = int(over_a_period(shape, 1.0001 * found.amplitude, ground, found.phase))
    assert above == found.first


@given(shape=shapes, ground=grounds)
def test_at_the_start_the_tangential_force_is_the_lesser_coefficient_of_the_normal_force(shape, ground):
    found = start_of_motion(shape[0], shape[1], phase=shape[2], **ground)
    assume(math.isfinite(found.amplitude) and 0.0 < found.amplitude < 1e6)
    force = math.sin(ground["incline"]) + found.amplitude * shape[0] * math.cos(found.phase)
    load = math.cos(ground["incline"]) + found.amplitude * shape[1] * math.cos(found.phase + shape[2])
    scale = 1.0 + found.amplitude * (abs(shape[0]) + abs(shape[1]))
    assert abs(force) == pytest.approx(min(ground["c"], ground["friction"]) * load, abs=16.0 * EPS * scale)


@given(shape=shapes, ground=grounds)
def test_friction_against_slenderness_alone_tells_rocking_from_sliding(shape, ground):
    # Both limits are a multiple of N: neither N nor what makes it decides which is met first.
    assume(abs(shape[0]) > 1e-3)
    found = start_of_motion(shape[0], shape[1], phase=shape[2], **ground)
    rocks = ground["c"] <= ground["friction"]
    assert found.first == (FirstMotion.ROCK if rocks else FirstMotion.SLIDE)
    assert (found.rock <= found.slide) == rocks or found.amplitude == 0.0
    assert found.amplitude == min(found.rock, found.slide)


@given(shape=shapes, ground=grounds)
def test_it_never_lifts_off_before_it_leaves_the_friction_cone(shape, ground):
    found = start_of_motion(shape[0], shape[1], phase=shape[2], **ground)
    assert min(found.slide, found.rock) <= found.lift_off * (1.0 + 8.0 * EPS)


def test_it_rocks_where_both_limits_are_one():
    assert start_of_motion(c=0.2, friction=0.2).first == FirstMotion.ROCK
    assert start_of_motion(c=0.2, friction=np.nextafter(0.2, 0.0)).first == FirstMotion.SLIDE


def test_known_amplitudes():
    # Horizontal: min(μ, c). Vertical: 1 g, without sliding or rocking. In a vertical circle: |T| = kN with R² = 1 + k².
    k = 0.25
    level = start_of_motion([1.0, 0.0, 1.0], [0.0, 1.0, 1.0], c=k, friction=0.7, phase=0.5 * np.pi)
    np.testing.assert_allclose(level.amplitude, [k, 1.0, k / math.sqrt(1.0 + k**2)], rtol=4.0 * EPS)
    assert level.first.tolist() == [FirstMotion.ROCK, FirstMotion.LIFT_OFF, FirstMotion.ROCK]
    # Along a line at the angle δ, in phase: k/(cos δ + k sin δ), where the base pulls down and away.
    delta = 0.6
    oblique = start_of_motion(math.cos(delta), math.sin(delta), c=k, friction=0.7)
    assert float(oblique.amplitude) == pytest.approx(k / (math.cos(delta) + k * math.sin(delta)), rel=4.0 * EPS)
    assert float(oblique.phase) == pytest.approx(math.pi)
    # On an incline: tan of the difference of the friction angle and the incline, over cos.
    steep = start_of_motion(c=1.0, friction=k, incline=0.1)
    expected = math.sin(math.atan(k) - 0.1) / math.cos(math.atan(k))
    assert float(steep.amplitude) == pytest.approx(expected, rel=16.0 * EPS)
    assert float(steep.phase) == 0.0  # the base accelerates uphill, the column stays behind


def test_a_plane_too_steep_moves_the_column_at_rest_and_no_motion_moves_none():
    steep = start_of_motion(c=0.3, friction=[0.1, 0.5], incline=0.4)
    np.testing.assert_array_equal(steep.amplitude, 0.0)
    assert steep.first.tolist() == [FirstMotion.SLIDE, FirstMotion.ROCK]
    assert np.isnan(steep.phase).all()
    still = start_of_motion(0.0, 0.0, c=0.3, friction=0.5, incline=0.1)
    assert still.first == FirstMotion.NONE
    assert still.amplitude == math.inf
    assert np.isnan(still.phase)
    assert start_of_motion(0.0, 0.0, c=0.3, friction=0.0).amplitude == math.inf  # on ice


def test_uphill_and_downhill_mirror_each_other():
    there = start_of_motion(1.0, 0.4, c=0.3, friction=0.2, phase=0.3, incline=0.1)
    back = start_of_motion(-1.0, 0.4, c=0.3, friction=0.2, phase=0.3, incline=-0.1)
    assert there.amplitude == back.amplitude
    assert there.phase == pytest.approx(float(back.phase))


def test_arguments_broadcast():
    found = start_of_motion(1.0, np.zeros((3, 1)), c=[0.1, 0.2], friction=0.15)
    assert found.amplitude.shape == found.first.shape == found.phase.shape == found.lift_off.shape == (3, 2)


def test_the_throw_number_is_one_where_a_normal_motion_lifts_off():
    incline = np.array([0.0, 0.3, -0.5])
    lift = start_of_motion(0.0, 1.0, c=2.0, friction=2.0, incline=incline).lift_off
    np.testing.assert_allclose(theory.throw_number(lift, incline=incline), 1.0, rtol=2.0 * EPS)


def test_nothing_stands_on_a_wall():
    with pytest.raises(ParameterError, match="incline must lie between"):
        start_of_motion(c=0.1, friction=0.3, incline=2.0)
    with pytest.raises(ParameterError, match="friction must be zero or positive"):
        first_motion(0.1, c=0.1, friction=-0.3)
