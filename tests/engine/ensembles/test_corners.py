"""Runs at the corners: exactly in a plane, exactly at rest, exactly at the limit, without friction."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import stylobate as sb

C = 0.1
COLUMN = sb.Column.dimensionless(C)
MODEL = sb.Slender(COLUMN, damping=0.1)


@settings(max_examples=25)
@given(frequency=st.floats(0.05, 40.0), start_phase=st.floats(-7.0, 7.0), ratio=st.sampled_from([0.0, 0.6, 1.0]))
def test_a_column_at_rest_stays_while_the_acceleration_is_exactly_c(frequency, start_phase, ratio):
    motion = sb.Harmonic.elliptic(
        amplitude=(C, ratio * C), phase=math.pi / 2.0, angular_frequency=frequency, start_phase=start_phase
    )
    data = sb.simulate_ensemble(MODEL, motion, duration=[10.0, 1000.0])
    np.testing.assert_array_equal(data["outcome"], sb.Outcome.AT_REST)
    np.testing.assert_array_equal(data["decided_at"], 0.0)
    np.testing.assert_array_equal(data["end_time"], [10.0, 1000.0])
    np.testing.assert_array_equal(data["peak_tilt"], 0.0)
    np.testing.assert_array_equal(data["uplifts"], 0)
    assert not data["uncertain"].any()


def test_the_peak_acceleration_set_to_exactly_c_keeps_it_at_rest():
    motion = sb.Harmonic.circular(acceleration=0.0371, angular_frequency=1.3)
    angles = np.linspace(-3.0, 3.0, 50)
    data = sb.simulate_ensemble(
        MODEL, motion, duration=100.0, parameters={"acceleration": C, "rotation": angles, "start_phase": angles}
    )
    assert set(data["outcome"].to_numpy()) == {sb.Outcome.AT_REST}


def test_free_planar_motion_without_friction_is_the_closed_form_and_conserves_energy(outcome_in):
    # (2), with the sign of every second half period: α = c − (c − A0) cosh τ up to the upright.
    amplitude = np.linspace(0.001, 0.099, 40)
    quarter = np.arccosh(C / (C - amplitude))
    times = np.array([0.3, 0.9])
    tilt = np.stack([amplitude, np.zeros(40)], axis=1)
    for part in times:
        data = sb.simulate_ensemble(sb.Slender(COLUMN), tilt=tilt, duration=part * quarter, rtol=1e-11)
        exact = C - (C - amplitude) * np.cosh(part * quarter)
        np.testing.assert_allclose(data["end_tilt"][:, 0], exact, atol=1e-10)
    data = sb.simulate_ensemble(sb.Slender(COLUMN), tilt=tilt, duration=100.0, rtol=1e-11)
    assert bool(data["planar"].all())
    assert outcome_in(data, 7) is sb.Outcome.STILL_MOVING
    a, v = np.hypot(*data["end_tilt"].to_numpy().T), np.hypot(*data["end_tilt_rate"].to_numpy().T)
    np.testing.assert_allclose(0.5 * v**2 + C * a - 0.5 * a**2, C * amplitude - 0.5 * amplitude**2, rtol=1e-7)
    # Exactly in its plane for ever, and never overturned.
    np.testing.assert_array_equal(data["end_tilt"][:, 1], 0.0)
    np.testing.assert_allclose(data["peak_tilt"], amplitude, rtol=1e-8)


def test_free_motion_in_space_conserves_energy_and_angular_momentum():
    rng = np.random.default_rng(4)
    tilt = rng.uniform(0.01, 0.05, (60, 2))
    rate = rng.uniform(-0.03, 0.03, (60, 2))
    data = sb.simulate_ensemble(sb.Slender(COLUMN), tilt=tilt, tilt_rate=rate, duration=30.0, rtol=1e-12)

    def integrals(x, v):
        a = np.hypot(*x.T)
        return 0.5 * np.sum(v**2, axis=1) + C * a - 0.5 * a**2, x[:, 0] * v[:, 1] - x[:, 1] * v[:, 0]

    energy, momentum = integrals(tilt, rate)
    found_energy, found_momentum = integrals(data["end_tilt"].to_numpy(), data["end_tilt_rate"].to_numpy())
    np.testing.assert_allclose(found_energy, energy, rtol=0.0, atol=1e-8 * C**2)
    np.testing.assert_allclose(found_momentum, momentum, rtol=0.0, atol=1e-8 * C**2)


@pytest.mark.parametrize("damping", [0.0, 0.2])
def test_starts_at_the_upright_with_speed_are_followed(runs_of, outcome_in, damping):
    angle = np.linspace(-3.0, 3.0, 6)
    rate = 0.03 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    model = sb.Slender(COLUMN, damping=damping)
    for motion in (sb.Harmonic.circular(acceleration=0.02, angular_frequency=2.0), None):
        runs = runs_of(model, motion, 6, tilt=(0.0, 0.0), tilt_rate=rate, duration=0.4, rtol=1e-11)
        data = runs.together()
        for index in range(6):
            single = runs.alone(index)
            assert bool(data["planar"][index]) is single.planar is (motion is None)
            np.testing.assert_allclose(data["end_tilt"][index], single.data["tilt"][-1], atol=1e-9)


def test_starts_that_are_rest_but_for_rounding_stand(outcome_in):
    data = sb.simulate_ensemble(MODEL, tilt=[(1e-16, -1e-16), (0.0, 0.0)], tilt_rate=(0.0, 1e-17), duration=10.0)
    assert outcome_in(data, 0) is outcome_in(data, 1) is sb.Outcome.AT_REST
    np.testing.assert_array_equal(data["end_tilt"], 0.0)


def test_a_very_short_run_is_where_it_began():
    data = sb.simulate_ensemble(MODEL, tilt=(0.03, 0.01), tilt_rate=(0.01, 0.02), duration=[1e-300, 1e-12])
    np.testing.assert_allclose(data["end_tilt"], [(0.03, 0.01)] * 2, rtol=1e-9)
    np.testing.assert_array_equal(data["end_time"], [1e-300, 1e-12])


@pytest.mark.parametrize("tilt", [(0.04, 0.0), (0.04, 0.02)], ids=["in a plane", "in space"])
def test_a_run_that_coasts_for_ever_ends_at_rest_or_out_of_steps(outcome_in, tilt):
    options = {"tilt": tilt, "tilt_rate": (0.01, 0.0), "duration": 1e7}
    data = sb.simulate_ensemble(MODEL, **options, max_steps=50_000)
    assert outcome_in(data) is sb.Outcome.AT_REST
    data = sb.simulate_ensemble(sb.Slender(COLUMN), **options, max_steps=2000)
    assert outcome_in(data) is sb.Outcome.FAILED


class Poisoned(sb.Slender):
    """Its rates are no number beyond a tilt."""

    @staticmethod
    def rates(x, y, vx, vy, ax, ay, az, c, eta, _kappa):
        broken = math.nan if x * x + y * y > 0.0025 else 0.0
        return vx, vy, x + broken, y + broken

    planar_rates = no_return_tilt = departure = contact = None


@pytest.mark.slow  # a kernel of its own
def test_rates_that_are_no_numbers_end_a_run_as_failed_and_leave_others_alone(outcome_in):
    data = sb.simulate_ensemble(Poisoned(COLUMN), tilt=[(0.04, 0.0), (0.01, 0.0)], duration=[9.0, 0.5])
    assert outcome_in(data, 0) is sb.Outcome.FAILED
    # x grows as cosh up to 0.05.
    assert float(data["decided_at"][0]) == pytest.approx(math.acosh(1.25), abs=1e-6)
    assert float(data["end_tilt"][1, 0]) == pytest.approx(0.01 * math.cosh(0.5), rel=1e-8)
