"""Sums, and scaled, turned and delayed copies."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import stylobate as sb
from stylobate.base_motions import BASE_AT_REST
from stylobate.base_motions.combined import Delayed, Rotated, Scaled, Sum
from stylobate.errors import ParameterError

TIME = np.linspace(0.0, 7.0, 71)
ONE = sb.Harmonic(amplitude=(0.3, 0.4, 0.2), phase=(0.1, 0.7, 2.0), angular_frequency=2.0, start_phase=0.3, ramp=2.5)
TWO = sb.Harmonic.elliptic(amplitude=(0.1, 0.5), phase=-0.4, angular_frequency=3.0)
KINDS = ["acceleration", "velocity", "displacement"]


@pytest.mark.parametrize("name", KINDS)
def test_a_sum_is_the_sum_of_its_parts(name):
    total = getattr(ONE + TWO, name)(TIME)
    np.testing.assert_allclose(total, getattr(ONE, name)(TIME) + getattr(TWO, name)(TIME), rtol=1e-15)


@pytest.mark.parametrize("name", KINDS)
def test_scaling_multiplies_and_may_treat_the_vertical_apart(name):
    plain = getattr(ONE, name)(TIME)
    np.testing.assert_allclose(getattr(-1.5 * ONE, name)(TIME), -1.5 * plain, rtol=1e-15)
    np.testing.assert_allclose(getattr(ONE * 2, name)(TIME), 2.0 * plain, rtol=1e-15)
    apart = getattr(ONE.scaled(3.0, vertical=0.0), name)(TIME)
    np.testing.assert_allclose(apart, plain * [3.0, 3.0, 0.0], rtol=1e-15)


@pytest.mark.parametrize("name", KINDS)
def test_turning_turns_anticlockwise_about_the_vertical(name):
    x, y, z = getattr(ONE, name)(TIME).T
    quarter = getattr(ONE.rotated(math.pi / 2.0), name)(TIME)
    np.testing.assert_allclose(quarter, np.stack([-y, x, z], axis=-1), rtol=0.0, atol=1e-15)


@pytest.mark.parametrize("delay", [1.7, -1.7, 0.0])
def test_a_delay_shifts_the_motion_and_the_base_does_not_accelerate_before(delay):
    late = ONE.delayed(delay)
    running = delay <= TIME
    for name in KINDS:
        shifted = getattr(ONE, name)(TIME[running] - delay)
        np.testing.assert_allclose(getattr(late, name)(TIME[running]), shifted, rtol=1e-13, atol=1e-16)
    assert np.all(late.acceleration(TIME[~running]) == 0.0)
    assert late.breaks == tuple(t for t in ((delay, 2.5 + delay) if delay > 0.0 else (2.5 + delay,)) if t > 0.0)


def test_displacement_and_velocity_are_continuous_at_the_onset_of_a_delayed_motion():
    late = TWO.delayed(2.0)
    before, after = 2.0 - 1e-9, 2.0 + 1e-9
    np.testing.assert_allclose(late.velocity(before), late.velocity(after), rtol=0.0, atol=2e-9)
    np.testing.assert_allclose(late.displacement(before), late.displacement(after), rtol=0.0, atol=2e-9)
    step = np.array([0.5, 1.0, 1.5])
    np.testing.assert_allclose(np.diff(late.displacement(step), axis=0) / 0.5, late.velocity(step[:2]), atol=1e-15)


def test_an_offset_is_a_constant_acceleration_from_rest():
    leaning = ONE.offset(0.3, -0.2)
    for name, share in (("acceleration", np.ones_like(TIME)), ("velocity", TIME), ("displacement", TIME**2 / 2.0)):
        added = np.outer(share, [0.3, -0.2, 0.0])
        np.testing.assert_allclose(getattr(leaning, name)(TIME), getattr(ONE, name)(TIME) + added, rtol=1e-14)


@given(
    factor=st.floats(-3.0, 3.0),
    vertical=st.floats(-3.0, 3.0),
    angle=st.floats(-7.0, 7.0),
    delay=st.floats(-4.0, 4.0),
    offset=st.floats(-1.0, 1.0),
    since=st.floats(0.0, 6.0),
)
def test_the_bounds_hold_for_combinations_from_any_time_on(factor, vertical, angle, delay, offset, since):
    motion = (ONE + TWO.delayed(delay)).scaled(factor, vertical=vertical).rotated(angle).delayed(-delay)
    motion = motion.offset(offset, 0.5)
    acceleration = motion.acceleration(since + np.linspace(0.0, 20.0, 2001))
    low, high = motion.vertical_range(since)
    assert np.hypot(*acceleration.T[:2]).max() <= motion.peak_horizontal(since) * (1.0 + 1e-12)
    assert low - 1e-12 <= acceleration[:, 2].min()
    assert acceleration[:, 2].max() <= high + 1e-12


def test_scaled_and_turned_bounds_are_exact():
    assert ONE.scaled(-2.0).peak_horizontal() == pytest.approx(2.0 * ONE.peak_horizontal(), rel=1e-15)
    assert ONE.scaled(1.0, vertical=-0.5).vertical_range() == (-0.1, 0.1)
    assert ONE.rotated(1.0).peak_horizontal() == ONE.peak_horizontal()


@pytest.mark.parametrize(
    ("frequencies", "turns"),
    [((2.0, 3.0), (2, 3)), ((1.0, 0.25), (4, 1)), ((6.0, 10.0, 15.0), (6, 10, 15)), ((7.0, 7.0), (1, 1))],
)
def test_the_common_period_of_a_sum_is_the_least(frequencies, turns):
    parts = [sb.Harmonic.straight(acceleration=1.0, angular_frequency=w) for w in frequencies]
    period = Sum(motions=tuple(parts)).period
    for frequency, n in zip(frequencies, turns, strict=True):
        assert period * frequency / (2.0 * math.pi) == pytest.approx(n, rel=1e-12)
    np.testing.assert_allclose(
        Sum(motions=tuple(parts)).acceleration(1.0 + period), Sum(motions=tuple(parts)).acceleration(1.0), atol=1e-12
    )


def test_frequencies_in_no_simple_ratio_have_no_common_period():
    first, second = (sb.Harmonic.straight(acceleration=1.0, angular_frequency=w) for w in (1.0, math.sqrt(2.0)))
    assert (first + second).period is None


def test_a_base_at_rest_does_nothing():
    assert np.all(BASE_AT_REST.acceleration(TIME) == 0.0)
    assert BASE_AT_REST.peak_horizontal() == 0.0
    assert BASE_AT_REST.duration == 0.0
    assert BASE_AT_REST.period is None
    assert BASE_AT_REST.highest_frequency == 0.0
    assert BASE_AT_REST.directions() == ()


def test_adding_a_base_at_rest_keeps_the_period():
    assert (BASE_AT_REST + TWO).period == TWO.period
    assert (TWO + BASE_AT_REST).period == TWO.period


@pytest.mark.parametrize("copy", [ONE.scaled(2.0), ONE.rotated(1.0), ONE.delayed(1.0), ONE.offset(1.0)])
def test_a_copy_keeps_period_and_frequency(copy):
    assert copy.period == ONE.period
    assert copy.highest_frequency == ONE.highest_frequency
    assert copy.duration == math.inf


@pytest.mark.parametrize(
    ("make", "name"),
    [
        (lambda: Sum(motions=(ONE, 3.0)), "motions"),
        (lambda: Scaled(motion="x", factor=1.0, vertical=1.0), "motion"),
        (lambda: ONE.scaled(math.nan), "factor"),
        (lambda: ONE.scaled(1.0, vertical=math.inf), "vertical"),
        (lambda: Rotated(motion=ONE, angle=math.nan), "angle"),
        (lambda: Delayed(motion=ONE, delay=math.inf), "delay"),
    ],
)
def test_impossible_combinations_are_refused_by_name(make, name):
    with pytest.raises(ParameterError, match=rf"^{name}\b"):
        make()


def test_only_motions_can_be_added():
    with pytest.raises(TypeError):
        ONE + 1.0


def test_while_a_motion_waits_its_vertical_range_holds_zero():
    rising = Constant(vertical=0.3)
    waiting = rising.delayed(2.0)
    assert waiting.vertical_range(0.0) == (0.0, 0.3)
    assert waiting.vertical_range(3.0) == (0.3, 0.3)


class Constant(sb.BaseMotion):
    """A base that accelerates upwards at a constant rate."""

    def __init__(self, vertical):
        self.vertical = vertical

    def derivative(self, time, order):
        t = np.asarray(time, dtype=float)
        return 0.0 * t, 0.0 * t, self.vertical * t ** (2 - order) / (2.0, 1.0, 1.0)[order]

    def peak_horizontal(self, since=0.0):
        return 0.0

    def vertical_range(self, since=0.0):
        return self.vertical, self.vertical

    def directions(self):
        return ()
