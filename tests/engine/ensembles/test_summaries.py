"""What is told of each run besides its end: largest and minimum tilt, turns, means, phase, strobes, samples."""

import math

import numpy as np
import pytest

import stylobate as sb

C, ETA = 0.1, 0.1
MODEL = sb.Slender(sb.Column.dimensionless(C), damping=ETA)
RULES = sb.OutcomeRules(periods=4)
TURNING = sb.Harmonic.circular(acceleration=0.065, angular_frequency=3.0, start_phase=0.7)
MOTIONS = {
    "circle": (TURNING, (0.012, 0.003), (0.0, 0.03)),
    "circle, clockwise": (
        sb.Harmonic.circular(acceleration=0.065, angular_frequency=3.0, sense=-1, start_phase=0.7),
        (0.012, 0.003),
        (0.0, -0.03),
    ),
    "line": (
        sb.Harmonic.straight(acceleration=0.04, angular_frequency=3.0, direction=0.4, start_phase=0.3),
        (0.01, 0.0),
        (0.0, 0.03),
    ),
    "ellipse": (
        sb.Harmonic.elliptic(amplitude=(0.06, 0.03), phase=-1.2, angular_frequency=2.6, start_phase=0.4),
        (0.03, 0.0),
        (0.0, 0.05),
    ),
    "in a plane": (
        sb.Harmonic.straight(acceleration=0.13, angular_frequency=3.0, direction=0.4, start_phase=0.3),
        (0.0, 0.0),
        (0.0, 0.0),
    ),
}


@pytest.fixture(scope="module", params=list(MOTIONS))
def one(request):
    """One run in an ensemble, and alone with many samples."""
    motion, tilt, rate = MOTIONS[request.param]
    options = {"tilt": tilt, "tilt_rate": rate, "duration": 20 * motion.period, "rules": RULES}
    data = sb.simulate_ensemble(MODEL, motion, **options, samples=9, strobes=3).isel(run=0)
    return motion, data, sb.simulate(MODEL, motion, **options, rtol=1e-12, samples=100_001, recheck=False)


def late(motion, single):
    """Time, tilt vector and amplitude over the last periods of a single run."""
    history = single.data.isel(time=single.data["time"].to_numpy() >= 16 * motion.period * (1.0 - 1e-12))
    return history["time"].to_numpy(), history["tilt"].to_numpy(), history["amplitude"].to_numpy()


def test_largest_and_minimum_tilt_are_those_of_a_dense_single_run(one):
    _, data, single = one
    amplitude, time = single.data["amplitude"].to_numpy(), single.data["time"].to_numpy()
    # Measured by quintics across a step, whose error goes with its sixth power; steps in a plane are the longest.
    relative = 1e-5 if single.planar else 1e-6
    assert float(data["peak_tilt"]) == pytest.approx(amplitude.max(), rel=relative)
    # At a peak the tilt changes by half its curvature times the square of the time.
    assert float(data["time_of_peak_tilt"]) == pytest.approx(time[amplitude.argmax()], abs=5e-3)
    assert float(single.sample(float(data["time_of_peak_tilt"]))["amplitude"][0]) == pytest.approx(
        amplitude.max(), rel=relative
    )
    assert float(data["minimum_tilt"]) == pytest.approx(amplitude.min(), rel=1e-3, abs=1e-9)


def test_turns_are_those_of_a_single_run(one):
    _, data, single = one
    assert float(data["turns"]) == pytest.approx(single.measures["turns"], abs=1e-6)
    rate = single.measures["mean_rolling_rate"]
    assert float(data["mean_rolling_rate"]) == pytest.approx(rate, abs=1e-6)


def test_mean_tilt_and_phase_are_integrals_over_the_last_periods(one):
    motion, data, single = one
    time, tilt, amplitude = late(motion, single)
    # By the trapezoidal rule with end correction over each step, of fourth order in it.
    assert float(data["mean_tilt"]) == pytest.approx(
        np.trapezoid(amplitude, time) / (4 * motion.period), rel=1e-3 if single.planar else 5e-5
    )
    # z = x + iy; its part that turns with the forcing is compared with the same part of the acceleration.
    sense = 1.0 if single.planar or single.measures["turns"] >= 0.0 else -1.0
    wave = np.exp(-1j * sense * motion.angular_frequency * time)
    lean = np.trapezoid(tilt @ np.array([1.0, 1j]) * wave, time)
    ax, ay, _ = motion.acceleration(time).T
    push = np.trapezoid((ax + 1j * ay) * wave, time)
    assert float(data["phase"]) == pytest.approx(sense * np.angle(lean / push), abs=2e-3)


def test_samples_are_those_of_the_single_run(one):
    motion, data, single = one
    np.testing.assert_allclose(data["sample_time"], np.linspace(0.0, 20 * motion.period, 9), rtol=1e-12)
    sampled = single.sample(data["sample_time"].to_numpy())
    np.testing.assert_allclose(data["sampled_tilt"], sampled["tilt"], atol=1e-7)
    np.testing.assert_allclose(data["sampled_tilt_rate"], sampled["tilt_rate"], atol=3e-7)


def test_strobes_are_states_at_phase_zero(one):
    motion, data, single = one
    first = (-motion.start_phase / motion.angular_frequency) % motion.period
    sampled = single.sample(first + motion.period * np.array([17, 18, 19]))
    np.testing.assert_allclose(data["strobe_tilt"], sampled["tilt"], atol=1e-7)
    np.testing.assert_allclose(data["strobe_tilt_rate"], sampled["tilt_rate"], atol=3e-7)


@pytest.mark.parametrize("sense", [1, -1])
@pytest.mark.parametrize("start_phase", [0.0, 2.1, -0.4])
@pytest.mark.parametrize("delay", [0.0, -0.37])
def test_steady_rolling_has_the_mean_tilt_phase_and_rate_of_theory(sense, start_phase, delay):
    nu = np.linspace(2.0, 5.0, 7)
    upper = sb.theory.steady_rolling(nu, 0.065, c=C, eta=ETA).upper
    angle = sense * (start_phase - nu * delay + upper.phase)
    lean = np.stack([np.cos(angle), np.sin(angle)], axis=1) * upper.amplitude[:, np.newaxis]
    along = sense * np.stack([-lean[:, 1], lean[:, 0]], axis=1) * nu[:, np.newaxis]
    motion = sb.Harmonic.circular(acceleration=0.065, angular_frequency=1.0, sense=sense, start_phase=start_phase)
    data = sb.simulate_ensemble(
        MODEL,
        motion.delayed(delay),
        tilt=lean,
        tilt_rate=along,
        duration=30.5 * 2.0 * math.pi / nu,
        parameters={"angular_frequency": nu},
        rtol=1e-10,
        strobes=4,
    )
    assert set(data["outcome"].to_numpy()) == {sb.Outcome.ROLLING}
    np.testing.assert_allclose(data["mean_tilt"], upper.amplitude, rtol=1e-8)
    np.testing.assert_allclose(data["phase"], upper.phase, atol=1e-8)
    np.testing.assert_allclose(data["mean_rolling_rate"], sense * nu, rtol=1e-8)
    np.testing.assert_allclose(data["turns"], sense * 30.5, rtol=1e-8)
    assert float(data["repetition"].max()) < 1e-8
    # At phase zero the base accelerates along x: all strobes are one point, that of the exact solution there.
    at_zero = upper.amplitude[:, np.newaxis] * np.stack([np.cos(upper.phase), sense * np.sin(upper.phase)], axis=1)
    rate_at_zero = sense * nu[:, np.newaxis] * np.stack([-at_zero[:, 1], at_zero[:, 0]], axis=1)
    np.testing.assert_allclose(data["strobe_tilt"], np.repeat(at_zero[:, np.newaxis], 4, axis=1), atol=1e-9)
    np.testing.assert_allclose(data["strobe_tilt_rate"], np.repeat(rate_at_zero[:, np.newaxis], 4, axis=1), atol=5e-9)


# Averaging is right to the order of a1/c; both senses of rolling live on one straight motion.
@pytest.mark.parametrize("sense", [1, -1])
def test_rolling_on_a_straight_motion_has_the_averages_of_theory_roughly(sense):
    upper = sb.theory.steady_rolling(4.0, 0.02, c=C, eta=ETA).upper
    motion = sb.Harmonic.straight(acceleration=0.04, angular_frequency=4.0, direction=0.4)
    amplitude, angle = float(upper.amplitude), 0.4 + sense * float(upper.phase)
    tilt = amplitude * np.array([math.cos(angle), math.sin(angle)])
    rate = sense * 4.0 * np.array([-tilt[1], tilt[0]])
    data = sb.simulate_ensemble(MODEL, motion, tilt=tilt, tilt_rate=rate, duration=120 * motion.period)
    assert float(data["mean_rolling_rate"][0]) == pytest.approx(sense * 4.0, rel=1e-3)
    assert float(data["mean_tilt"][0]) == pytest.approx(amplitude, rel=0.15)
    assert float(data["phase"][0]) == pytest.approx(float(upper.phase), abs=0.15)


def test_rocking_is_told_with_its_mean_tilt_and_phase_and_without_turns():
    motion = sb.Harmonic.straight(acceleration=0.13, angular_frequency=3.0, direction=0.4)
    model = sb.Slender(sb.Column.dimensionless(C), damping=0.5)
    data = sb.simulate_ensemble(model, motion, duration=100 * motion.period, strobes=3).isel(run=0)
    orbit = sb.simulate(model, motion, duration=100 * motion.period, samples=100_001, recheck=False)
    assert orbit.outcome is sb.Outcome.ROCKING
    assert int(data["outcome"]) == sb.Outcome.ROCKING
    assert float(data["turns"]) == float(data["mean_rolling_rate"]) == 0.0
    last = orbit.data.isel(time=orbit.data["time"].to_numpy() >= 90 * motion.period * (1.0 - 1e-12))
    mean = np.trapezoid(last["amplitude"], last["time"]) / (10 * motion.period)
    assert float(data["mean_tilt"]) == pytest.approx(mean, rel=1e-3)
    wave = np.exp(-1j * 3.0 * last["time"].to_numpy())
    lean = np.trapezoid(last["tilt"].to_numpy() @ np.array([math.cos(0.4), math.sin(0.4)]) * wave, last["time"])
    assert float(data["phase"]) == pytest.approx(np.angle(lean), abs=2e-3)
    assert float(np.ptp(data["strobe_tilt"].to_numpy(), axis=0).max()) < 1e-6 * C


def test_nothing_is_told_of_periods_that_were_not_run():
    free = sb.simulate_ensemble(MODEL, tilt=(0.03, 0.01), duration=2.0, strobes=2)
    short = sb.simulate_ensemble(MODEL, TURNING, tilt=(0.01, 0.01), duration=10.9 * TURNING.period, strobes=14)
    fallen = sb.simulate_ensemble(MODEL, TURNING, tilt=(0.2, 0.0), duration=99 * TURNING.period, samples=5)
    for data in (free, short, fallen):
        for name in ("mean_tilt", "phase", "mean_rolling_rate", "repetition"):
            assert np.isnan(data[name]).all()
    assert np.isnan(free["strobe_tilt"]).all()
    # Of 14 strobes 10 or 11 there were: the newest stand last.
    there = ~np.isnan(short["strobe_tilt"].to_numpy()[0, :, 0])
    np.testing.assert_array_equal(there, np.arange(14) >= 3)
    gone = np.isnan(fallen["sampled_tilt"].to_numpy()[0, :, 0])
    np.testing.assert_array_equal(gone, [False, True, True, True, True])


def test_every_variable_has_a_name_and_units():
    data = sb.simulate_ensemble(MODEL, TURNING, tilt=(0.01, 0.01), duration=1.0, strobes=2, samples=2)
    assert data.attrs["kind"] == "ensemble"
    for name, variable in data.data_vars.items():
        assert variable.attrs["long_name"], name
        assert "units" in variable.attrs or variable.dtype.kind in "bi"
    meanings = data["outcome"].attrs["flag_meanings"].split()
    values = data["outcome"].attrs["flag_values"].tolist()
    assert dict(zip(meanings, values, strict=True)) == {
        "NOT_COMPUTED": -1,
        **{outcome.name: code for code, outcome in enumerate(sb.Outcome)},
    }
