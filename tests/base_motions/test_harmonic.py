"""Harmonic motions: derivatives, bounds, and every named constructor against numbers worked out by hand."""

import math
import pickle
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import stylobate as sb
from stylobate.base_motions.declared import value_of, with_numbers
from stylobate.config.parts import describe_motion
from stylobate.errors import ParameterError

amplitudes = st.floats(-5.0, 5.0)
phases = st.floats(-7.0, 7.0)


SOME_RAMPS = st.sampled_from([0.0, 0.7, 3.0])


@st.composite
def harmonics(draw, ramps=SOME_RAMPS):
    return sb.Harmonic(
        amplitude=draw(st.tuples(amplitudes, amplitudes, amplitudes)),
        phase=draw(st.tuples(phases, phases, phases)),
        angular_frequency=draw(st.floats(0.3, 12.0)),
        start_phase=draw(phases),
        ramp=draw(ramps),
    )


def differences(function, time, step):
    """Return the derivative of `function` by the central difference of the sixth order."""
    weights = {1: 45.0 / 60.0, 2: -9.0 / 60.0, 3: 1.0 / 60.0}
    return sum(w * (function(time + k * step) - function(time - k * step)) for k, w in weights.items()) / step


@given(motion=harmonics(), time=st.floats(0.05, 8.0))
def test_velocity_and_acceleration_are_derivatives(motion, time):
    fastest = motion.highest_frequency + (math.pi / motion.ramp if motion.ramp > 0.0 else 0.0)
    step = 0.02 / fastest
    if abs(time - motion.ramp) < 4.0 * step:  # only there the fourth derivative of the displacement jumps
        return
    speed = 15.0 / motion.angular_frequency
    # The error of the difference is (ωh)⁶/140 of the slope, below 1e-10, and rounding over the step.
    np.testing.assert_allclose(
        differences(motion.velocity, time, step), motion.acceleration(time), rtol=0.0, atol=1e-9 * 15.0
    )
    np.testing.assert_allclose(
        differences(motion.displacement, time, step), motion.velocity(time), rtol=0.0, atol=1e-9 * speed
    )


@given(motion=harmonics(ramps=st.floats(0.1, 20.0)))
def test_a_ramp_joins_the_steady_motion_smoothly_and_starts_from_nothing(motion):
    steady = sb.Harmonic(
        amplitude=motion.amplitude,
        phase=motion.phase,
        angular_frequency=motion.angular_frequency,
        start_phase=motion.start_phase,
    )
    assert np.abs(motion.acceleration(0.0)).max() < 1e-13
    assert motion.breaks == (motion.ramp,)
    scale = max(1.0, 1.0 / motion.angular_frequency**2) * 5.0
    for name in ("acceleration", "velocity", "displacement"):
        before = getattr(motion, name)(np.nextafter(motion.ramp, 0.0))
        after = getattr(steady, name)(motion.ramp)
        # Phase at the end of the ramp: up to 240 rad, rounded to 3e-14.
        np.testing.assert_allclose(before, after, rtol=0.0, atol=1e-12 * scale)
    late = motion.ramp + np.linspace(0.0, 5.0, 11)
    np.testing.assert_array_equal(motion.displacement(late), steady.displacement(late))


@given(motion=harmonics(ramps=st.just(0.0)))
def test_peak_horizontal_is_reached_and_never_exceeded(motion):
    time = np.linspace(0.0, motion.period, 4001)
    found = np.hypot(*motion.acceleration(time).T[:2]).max()
    largest = motion.peak_horizontal()
    assert found <= largest * (1.0 + 1e-12) + 1e-300
    assert found >= largest * (1.0 - 1e-5)  # samples miss a peak by at most (π/4000)² of it
    low, high = motion.vertical_range()
    vertical = motion.acceleration(time)[:, 2]
    assert (low, high) == (-abs(motion.amplitude[2]), abs(motion.amplitude[2]))
    assert low * (1.0 + 1e-12) <= vertical.min() <= low * (1.0 - 1e-5)
    assert high * (1.0 - 1e-5) <= vertical.max() <= high * (1.0 + 1e-12)


@given(motion=harmonics())
def test_the_bounds_hold_with_a_ramp(motion):
    time = np.linspace(0.0, 12.0, 2001)
    acceleration = motion.acceleration(time)
    assert np.hypot(*acceleration.T[:2]).max() <= motion.peak_horizontal() * (1.0 + 1e-12) + 1e-14
    assert np.abs(acceleration[:, 2]).max() <= motion.vertical_range()[1] * (1.0 + 1e-12) + 1e-14


@given(motion=harmonics())
def test_the_directions_span_the_acceleration(motion):
    first, second = (np.array(vector) for vector in motion.directions())
    for time in (0.1, 1.0, 2.7):
        horizontal = motion.acceleration(time)[:2]
        basis = np.array([first, second]).T
        parts = np.linalg.lstsq(basis, horizontal, rcond=None)[0]
        np.testing.assert_allclose(basis @ parts, horizontal, rtol=0.0, atol=1e-12 * (1.0 + np.abs(basis).max()))


@pytest.mark.parametrize("sense", [1, -1])
def test_circular_motion_has_constant_size_and_turns_in_its_sense(sense):
    motion = sb.Harmonic.circular(acceleration=0.65, angular_frequency=1.8, sense=sense, start_phase=0.4)
    time = np.linspace(0.0, 3.0, 7)
    angle = sense * 1.8 * time + sense * 0.4
    expected = 0.65 * np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], axis=-1)
    np.testing.assert_allclose(motion.acceleration(time), expected, rtol=0.0, atol=1e-15)
    assert motion.period == pytest.approx(2.0 * math.pi / 1.8)


def test_straight_motion_keeps_to_its_direction():
    motion = sb.Harmonic.straight(acceleration=2.0, angular_frequency=3.0, direction=math.pi / 6.0)
    np.testing.assert_allclose(motion.acceleration(0.0), [math.sqrt(3.0), 1.0, 0.0], rtol=1e-15)
    np.testing.assert_allclose(motion.acceleration(math.pi / 9.0), [math.sqrt(3.0) / 2.0, 0.5, 0.0], rtol=1e-14)
    assert motion.peak_horizontal() == pytest.approx(2.0)


def test_elliptic_motion_by_amplitudes_and_phase():
    motion = sb.Harmonic.elliptic(amplitude=(0.3, 0.4), phase=0.5, angular_frequency=2.0, start_phase=0.1)
    expected = [0.3 * math.cos(2.1), 0.4 * math.cos(2.6), 0.0]
    np.testing.assert_allclose(motion.acceleration(1.0), expected, rtol=1e-14)


def test_vertical_motion_is_vertical():
    motion = sb.Harmonic.vertical(acceleration=3.0, angular_frequency=2.0)
    np.testing.assert_allclose(motion.acceleration(1.0), [0.0, 0.0, 3.0 * math.cos(2.0)], rtol=1e-15)
    assert motion.peak_horizontal() == 0.0
    assert motion.vertical_range() == (-3.0, 3.0)


def test_displacement_amplitude_is_that_of_the_path():
    motion = sb.Harmonic.displacement_amplitude(
        amplitude=(0.01, 0.02, 0.003), phase=(0.0, 0.5, 1.0), angular_frequency=4.0
    )
    expected = [0.01 * math.cos(4.0), 0.02 * math.cos(4.5), 0.003 * math.cos(5.0)]
    np.testing.assert_allclose(motion.displacement(1.0), expected, rtol=1e-14)
    np.testing.assert_allclose(motion.acceleration(1.0), -16.0 * np.array(expected), rtol=1e-14)


def test_stroke_is_from_peak_to_peak():
    motion = sb.Harmonic.stroke(stroke=0.04, frequency=5.0, direction=0.3)
    path = motion.displacement(np.linspace(0.0, 0.2, 2001)) @ [math.cos(0.3), math.sin(0.3), 0.0]
    assert np.ptp(path) == pytest.approx(0.04, rel=1e-12)
    assert motion.peak_horizontal() == pytest.approx(0.02 * (10.0 * math.pi) ** 2, rel=1e-14)
    assert motion.period == pytest.approx(0.2)


def test_a_stroke_that_rises_is_measured_along_its_line():
    angle, direction = 0.436, 0.3
    motion = sb.Harmonic.stroke(stroke=0.6e-3, frequency=50.0, angle=angle, direction=direction)
    line = np.array([math.cos(angle) * math.cos(direction), math.cos(angle) * math.sin(direction), math.sin(angle)])
    path = motion.displacement(np.linspace(0.0, 0.02, 2001))
    assert np.ptp(path @ line) == pytest.approx(0.6e-3, rel=1e-12)
    np.testing.assert_allclose(path, np.outer(path @ line, line), rtol=0.0, atol=1e-18)
    oblique = sb.Harmonic.oblique(
        acceleration=motion.peak_horizontal(),
        angular_frequency=motion.angular_frequency,
        angle=angle,
        direction=direction,
        start_phase=math.pi,  # the displacement is positive at the start
    )
    time = np.linspace(0.0, 0.04, 17)
    np.testing.assert_allclose(motion.acceleration(time), oblique.acceleration(time), rtol=0.0, atol=1e-11)


@pytest.mark.parametrize("sense", [1, -1])
def test_orbit_is_a_circle_of_its_diameter_at_its_speed(sense):
    motion = sb.Harmonic.orbit(diameter=0.02, rpm=300.0, sense=sense)
    path = motion.displacement([0.0, 0.05, 0.1])  # a quarter turn in 1/20 s
    np.testing.assert_allclose(path[:, :2], 0.01 * np.array([[1, 0], [0, sense], [-1, 0]]), rtol=0.0, atol=1e-15)
    assert motion.peak_horizontal() == pytest.approx(0.01 * (10.0 * math.pi) ** 2, rel=1e-14)


@pytest.mark.parametrize(
    ("make", "options", "name"),
    [
        (sb.Harmonic.circular, {"acceleration": 1.0, "angular_frequency": 0.0}, "angular_frequency"),
        (sb.Harmonic.circular, {"acceleration": 1.0, "angular_frequency": -2.0}, "angular_frequency"),
        (sb.Harmonic.circular, {"acceleration": math.nan, "angular_frequency": 1.0}, "acceleration"),
        (sb.Harmonic.circular, {"acceleration": "x", "angular_frequency": 1.0}, "acceleration"),
        (sb.Harmonic.circular, {"acceleration": 1.0, "angular_frequency": 1.0, "sense": 0}, "sense"),
        (sb.Harmonic.circular, {"acceleration": 1.0, "angular_frequency": 1.0, "sense": "left"}, "sense"),
        (sb.Harmonic.circular, {"acceleration": 1.0, "angular_frequency": 1.0, "ramp": -1.0}, "ramp"),
        (sb.Harmonic.straight, {"acceleration": math.inf, "angular_frequency": 1.0}, "acceleration"),
        (sb.Harmonic.straight, {"acceleration": 1.0, "angular_frequency": 1.0, "direction": math.nan}, "direction"),
        (sb.Harmonic.straight, {"acceleration": 1.0, "angular_frequency": 1.0, "start_phase": math.nan}, "start_phase"),
        (sb.Harmonic.elliptic, {"amplitude": (1.0,), "phase": 0.0, "angular_frequency": 1.0}, "amplitude"),
        (sb.Harmonic.elliptic, {"amplitude": 1.0, "phase": 0.0, "angular_frequency": 1.0}, "amplitude"),
        (sb.Harmonic.elliptic, {"amplitude": (1.0, math.nan), "phase": 0.0, "angular_frequency": 1.0}, "amplitude"),
        (sb.Harmonic.elliptic, {"amplitude": (1.0, 1.0), "phase": math.nan, "angular_frequency": 1.0}, "phase"),
        (sb.Harmonic.vertical, {"acceleration": math.nan, "angular_frequency": 1.0}, "acceleration"),
        (sb.Harmonic.stroke, {"stroke": 0.0, "frequency": 1.0}, "stroke"),
        (sb.Harmonic.stroke, {"stroke": 0.1, "frequency": 0.0}, "frequency"),
        (sb.Harmonic.orbit, {"diameter": -0.1, "rpm": 30.0}, "diameter"),
        (sb.Harmonic.orbit, {"diameter": 0.1, "rpm": 0.0}, "rpm"),
        (sb.Harmonic.orbit, {"diameter": 0.1, "rpm": 10.0, "sense": 2}, "sense"),
    ],
)
def test_impossible_numbers_are_refused_by_name(make, options, name):
    with pytest.raises(ParameterError, match=rf"^{name}\b") as caught:
        make(**options)
    assert "got" in str(caught.value)


STATED = [
    sb.Harmonic.stroke(stroke=0.0012, frequency=50.0, angle=0.4, start_phase=0.3),
    sb.Harmonic.orbit(diameter=0.02, rpm=300.0, sense=-1),
    sb.Harmonic.oblique(acceleration=2.0, angular_frequency=30.0, angle=0.5),
    sb.Harmonic.displacement_amplitude(amplitude=(1e-3, 0.0, 2e-3), phase=(0.0, 0.0, 0.7), angular_frequency=90.0),
    sb.Harmonic.circular(acceleration=0.3, angular_frequency=2.0, ramp=1.0),
    sb.Harmonic.elliptic(amplitude=(0.3, 0.2), phase=0.4, angular_frequency=2.0),
    sb.Harmonic.vertical(acceleration=3.0, angular_frequency=2.0),
]


@pytest.mark.parametrize("motion", STATED, ids=lambda motion: motion.stated.constructor)
def test_a_motion_keeps_the_numbers_of_its_constructor(motion):
    for again in (
        motion.made_by()[0](**motion.made_by()[1]),
        pickle.loads(pickle.dumps(motion)),  # noqa: S301
        describe_motion(motion).build(),
    ):
        assert again == motion
        assert repr(again) == repr(motion)
    assert describe_motion(motion).kind == motion.stated.constructor
    # Numbers of the components replace those of the constructor.
    assert replace(motion, amplitude=(1.0, 2.0, 3.0)).stated is None


def test_numbers_of_the_constructor_change_as_if_stated_anew():
    stroke = sb.Harmonic.stroke(stroke=0.0012, frequency=50.0, angle=0.4)
    other = sb.Harmonic.stroke(stroke=0.0005, frequency=30.0, angle=-0.2, start_phase=1.0)
    changed = with_numbers(stroke, {"stroke": 0.0005, "frequency": 30.0, "angle": -0.2, "start_phase": 1.0})
    assert changed == other
    assert repr(changed) == repr(other)
    assert [value_of(stroke, name) for name in ("stroke", "angle", "direction")] == [0.0012, 0.4, 0.0]


def test_an_angular_frequency_keeps_the_acceleration_and_a_frequency_the_path():
    stroke = sb.Harmonic.stroke(stroke=0.0012, frequency=50.0, angle=0.4)
    faster = with_numbers(stroke, {"angular_frequency": 400.0})
    assert faster.amplitude == stroke.amplitude
    assert faster.stated is None
    circle = sb.Harmonic.circular(acceleration=0.3, angular_frequency=2.0)
    assert with_numbers(circle, {"angular_frequency": 3.0}).stated.arguments["angular_frequency"] == 3.0
    doubled = with_numbers(stroke, {"frequency": 100.0})
    assert doubled.peak_horizontal() == pytest.approx(4.0 * stroke.peak_horizontal(), rel=1e-15)


def test_a_motion_is_a_value():
    one = sb.Harmonic.circular(acceleration=0.65, angular_frequency=1.8)
    assert one == sb.Harmonic.circular(acceleration=0.65, angular_frequency=1.8)
    assert hash(one) == hash(sb.Harmonic.circular(acceleration=0.65, angular_frequency=1.8))
    with pytest.raises(AttributeError):
        one.ramp = 1.0


@pytest.mark.parametrize("shape", [(), (0,), (4,), (2, 3)])
def test_times_of_any_shape_give_vectors_of_that_shape(shape):
    motion = sb.Harmonic.circular(acceleration=0.65, angular_frequency=1.8, ramp=2.0)
    for name in ("acceleration", "velocity", "displacement"):
        assert getattr(motion, name)(np.ones(shape)).shape == (*shape, 3)
