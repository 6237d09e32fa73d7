"""Rotations, reflections and shifts of time leave ensembles as they leave the physics."""

import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

import stylobate as sb

C = 0.1
MODEL = sb.Slender(sb.Column.dimensionless(C), damping=0.1)
ELLIPSE = sb.Harmonic.elliptic(amplitude=(0.06, 0.03), phase=-1.2, angular_frequency=2.6, start_phase=0.4)
TILT = 0.03 * np.stack([np.cos(np.arange(12.0)), np.sin(np.arange(12.0))], axis=1)
RATE = np.stack([0.02 * np.sin(np.arange(12.0)), 0.05 * np.cos(np.arange(12.0))], axis=1)
SCALARS = ("decided_at", "peak_tilt", "turns", "mean_tilt", "phase", "mean_rolling_rate")


def follow(motion=ELLIPSE, tilt=TILT, rate=RATE, **arguments):
    options = {"duration": 30.0, "rtol": 1e-11, "rules": sb.OutcomeRules(periods=2), **arguments}
    return sb.simulate_ensemble(MODEL, motion, tilt=tilt, tilt_rate=rate, **options)


# The motions here keep clear of the upright, where rounding grows; 1e-7 leaves them a factor of 10⁴ to do so.
def same(one, other):
    calm = (one["minimum_tilt"] > 1e-3 * C) & (abs(one["decided_at"] - other["decided_at"]) < 1e-7)
    assert float(calm.mean()) > 0.5
    np.testing.assert_array_equal(one["outcome"], other["outcome"])
    return calm.to_numpy()


@settings(max_examples=15)
@given(angle=st.floats(-7.0, 7.0))
def test_turning_motion_and_starts_together_turns_the_answers(angle):
    cos, sin = math.cos(angle), math.sin(angle)
    turn = np.array([[cos, sin], [-sin, cos]])
    one, other = follow(), follow(tilt=TILT @ turn, rate=RATE @ turn, parameters={"rotation": angle})
    calm = same(one, other)
    np.testing.assert_allclose((one["end_tilt"].to_numpy() @ turn)[calm], other["end_tilt"][calm], atol=1e-7)
    for name in SCALARS:
        np.testing.assert_allclose(one[name][calm], other[name][calm], atol=1e-6)


def test_reflection_swaps_the_two_senses():
    mirror = np.array([1.0, -1.0])
    mirrored = sb.Harmonic.elliptic(amplitude=(0.06, -0.03), phase=-1.2, angular_frequency=2.6, start_phase=0.4)
    one, other = follow(), follow(mirrored, TILT * mirror, RATE * mirror)
    calm = same(one, other)
    np.testing.assert_allclose(one["end_tilt"][calm], other["end_tilt"][calm] * mirror, atol=1e-7)
    for name in SCALARS:
        sign = -1.0 if name in {"turns", "mean_rolling_rate"} else 1.0
        # The phase leads in either sense.
        np.testing.assert_allclose(one[name][calm], sign * other[name][calm], atol=1e-6)
    assert np.abs(one["turns"]).max() > 2.0


@settings(max_examples=15)
@given(turns=st.integers(-5, 5))
def test_whole_turns_of_the_start_phase_change_nothing(turns):
    one, other = follow(), follow(parameters={"start_phase": 0.4 + 2.0 * math.pi * turns})
    calm = same(one, other)
    np.testing.assert_allclose(one["end_tilt"][calm], other["end_tilt"][calm], atol=1e-7)


@settings(max_examples=10)
@given(shift=st.floats(0.1, 5.0))
def test_a_shift_of_time_is_a_start_phase(shift):
    one = follow(parameters={"delay": -shift})
    other = follow(parameters={"start_phase": 0.4 + 2.6 * shift})
    calm = same(one, other)
    np.testing.assert_allclose(one["end_tilt"][calm], other["end_tilt"][calm], atol=1e-7)
    np.testing.assert_allclose(one["phase"][calm], other["phase"][calm], atol=1e-6)


def test_real_columns_give_the_dimensionless_answer():
    column = sb.Column.hollow(radius=0.2, inner_radius=0.15, height=4.0, density=7800.0, gravity=1.62)
    scale, g = column.frequency_scale, column.gravity
    paper = sb.Column.dimensionless(column.slenderness)
    real = sb.simulate_ensemble(
        sb.Slender(column, damping=0.1),
        sb.Harmonic.circular(acceleration=0.07 * g, angular_frequency=2.3 * scale),
        tilt=TILT,
        tilt_rate=RATE * scale,
        duration=25.0 / scale,
        rtol=1e-11,
    )
    unit = sb.simulate_ensemble(
        sb.Slender(paper, damping=0.1),
        sb.Harmonic.circular(acceleration=0.07, angular_frequency=2.3),
        tilt=TILT,
        tilt_rate=RATE,
        duration=25.0,
        rtol=1e-11,
    )
    np.testing.assert_array_equal(real["outcome"], unit["outcome"])
    np.testing.assert_allclose(real["decided_at"] * scale, unit["decided_at"], rtol=1e-6)
    calm = (unit["minimum_tilt"] > 1e-3 * C).to_numpy()
    np.testing.assert_allclose(real["end_tilt"][calm], unit["end_tilt"][calm], atol=1e-7)
