"""Rotations, reflections, units and the choice of the time origin leave the physics as it is."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import stylobate as sb
from stylobate.base_motions import BASE_AT_REST

C = 0.1
START = np.array([0.04, 0.01]), np.array([-0.02, 0.05])


def model(damping=0.1):
    return sb.Slender(sb.Column.dimensionless(C), damping=damping)


def turned(vector, angle):
    cos, sin = math.cos(angle), math.sin(angle)
    return vector @ np.array([[cos, sin], [-sin, cos]])


MOTION = sb.Harmonic.elliptic(amplitude=(0.06, 0.03), phase=-1.2, angular_frequency=2.6, start_phase=0.4, ramp=2.0)


@settings(max_examples=15)
@given(angle=st.floats(-7.0, 7.0))
def test_turning_motion_and_start_together_turns_the_answer(angle):
    one = sb.simulate(model(), MOTION, tilt=START[0], tilt_rate=START[1], duration=10.0, rtol=1e-10)
    assert one.data.amplitude.min() > 1e-3 * C
    other = sb.simulate(
        model(),
        MOTION.rotated(angle),
        tilt=turned(START[0], angle),
        tilt_rate=turned(START[1], angle),
        duration=10.0,
        rtol=1e-10,
    )
    assert other.outcome is one.outcome
    assert not other.planar
    np.testing.assert_allclose(other.data.tilt, turned(one.data.tilt.to_numpy(), angle), rtol=0.0, atol=1e-6 * C)
    assert other.measures["turns"] == pytest.approx(one.measures["turns"], abs=1e-6)


def test_reflection_swaps_the_two_senses():
    def run(sense):
        motion = sb.Harmonic.circular(acceleration=0.065, angular_frequency=2.0, sense=sense)
        return sb.simulate(model(), motion, tilt=(0.02, 0.0), tilt_rate=(0.0, sense * 0.04), duration=40.0)

    left, right = run(1), run(-1)
    assert left.outcome is right.outcome
    mirrored = right.data.tilt.to_numpy() * [1.0, -1.0]
    # The two phases round differently by 1e-16; steps and motion amplify this while the motion settles.
    np.testing.assert_allclose(left.data.tilt, mirrored, rtol=0.0, atol=1e-11)
    np.testing.assert_allclose(left.data.azimuth, -right.data.azimuth, rtol=0.0, atol=1e-9)
    assert left.measures["turns"] == pytest.approx(-right.measures["turns"], rel=1e-12)
    assert left.measures["turns"] > 5.0


@pytest.mark.parametrize(
    "column",
    [
        sb.Column.solid(radius=0.5, height=10.0, density=2700.0),
        sb.Column.hollow(radius=0.2, inner_radius=0.15, height=4.0, density=7800.0, gravity=1.62),
    ],
    ids=["stone", "tube on the moon"],
)
def test_a_real_column_gives_the_dimensionless_answer(column):
    scale, g = column.frequency_scale, column.gravity
    nu, a0, duration = 2.3, 0.07, 25.0
    real = sb.simulate(
        sb.Slender(column, damping=0.1),
        sb.Harmonic.circular(acceleration=a0 * g, angular_frequency=nu * scale, ramp=3.0 / scale),
        tilt=START[0],
        tilt_rate=START[1] * scale,
        duration=duration / scale,
        rtol=1e-11,
        samples=501,
    )
    paper = sb.simulate(
        sb.Slender(sb.Column.dimensionless(column.slenderness), damping=0.1),
        sb.Harmonic.circular(acceleration=a0, angular_frequency=nu, ramp=3.0),
        tilt=START[0],
        tilt_rate=START[1],
        duration=duration,
        rtol=1e-11,
        samples=501,
    )
    np.testing.assert_allclose(real.data.time * scale, paper.data.time, rtol=1e-12)
    np.testing.assert_allclose(real.data.tilt, paper.data.tilt, rtol=0.0, atol=1e-7 * C)
    np.testing.assert_allclose(real.data.tilt_rate / scale, paper.data.tilt_rate, rtol=0.0, atol=1e-7 * C)
    energy_unit = column.base_inertia * scale**2
    np.testing.assert_allclose(real.data.energy / energy_unit, paper.data.energy / 0.75, rtol=0.0, atol=1e-7 * C**2)
    assert real.outcome is paper.outcome


@pytest.mark.parametrize("shift", [0.37, 2.9])
def test_start_phase_is_a_shift_of_time(shift):
    whole = sb.Harmonic.elliptic(amplitude=(0.06, 0.03), phase=-1.2, angular_frequency=2.6)
    late = sb.Harmonic.elliptic(amplitude=(0.06, 0.03), phase=-1.2, angular_frequency=2.6, start_phase=2.6 * shift)
    one = sb.simulate(model(), whole, tilt=START[0], tilt_rate=START[1], duration=6.0, rtol=1e-11)
    middle = one.sample(shift)
    two = sb.simulate(
        model(),
        late,
        tilt=middle.tilt.to_numpy()[0],
        tilt_rate=middle.tilt_rate.to_numpy()[0],
        duration=6.0 - shift,
        rtol=1e-11,
    )
    np.testing.assert_allclose(two.data.tilt[-1], one.data.tilt[-1], rtol=0.0, atol=1e-7 * C)
    three = sb.simulate(
        model(),
        whole.delayed(-shift),
        tilt=middle.tilt.to_numpy()[0],
        tilt_rate=middle.tilt_rate.to_numpy()[0],
        duration=6.0 - shift,
        rtol=1e-11,
    )
    np.testing.assert_allclose(three.data.tilt[-1], one.data.tilt[-1], rtol=0.0, atol=1e-7 * C)


def test_without_friction_time_runs_backwards_as_well():
    out = sb.simulate(model(0.0), tilt=START[0], tilt_rate=START[1], duration=8.0, rtol=1e-12)
    end = out.data.isel(time=-1)
    back = sb.simulate(
        model(0.0), tilt=end.tilt.to_numpy(), tilt_rate=-end.tilt_rate.to_numpy(), duration=8.0, rtol=1e-12
    )
    np.testing.assert_allclose(back.data.tilt[-1], START[0], rtol=0.0, atol=1e-8 * C)
    np.testing.assert_allclose(back.data.tilt_rate[-1], -START[1], rtol=0.0, atol=1e-8 * C)


def test_a_constant_acceleration_is_a_base_out_of_level():
    column, lean = sb.Column.solid(radius=0.3, height=3.0, density=2700.0), math.radians(0.5)
    start = {"tilt": (0.05, 0.02), "tilt_rate": (0.3, 0.05), "duration": 3.0, "rtol": 1e-10}
    damped = {"damping": 0.05, "spin_damping": 0.05}
    level = sb.Rolling(column, **damped)
    out_of_level = sb.Sliding(column, **damped, friction_coefficient=10.0, incline=lean, incline_direction=math.pi)
    added, leaning, plain = (
        sb.simulate(*case, **start).measures["peak_tilt"]
        for case in (
            (level, BASE_AT_REST.offset(column.gravity * math.sin(lean))),
            (out_of_level, None),
            (level, None),
        )
    )
    # Across the base the weight is smaller by 1 − cos δ, which the constant acceleration leaves out.
    assert added == pytest.approx(leaning, rel=2.0 * (1.0 - math.cos(lean)))
    assert abs(added - plain) > 100.0 * abs(added - leaning)
