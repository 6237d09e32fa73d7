"""Response curves in SI units are the closed forms, and their starts are motions of the model."""

from dataclasses import dataclass

import numpy as np
import pytest

import stylobate as sb
from stylobate.errors import ParameterError, StylobateError
from stylobate.studies.responses.response_curves import averaged_motion

MODEL = sb.Slender(sb.Column.solid(radius=0.5, height=10.0, density=2700.0), damping=0.1)


def test_si_curves_are_the_dimensionless_ones():
    gravity, scale = MODEL.column.gravity, MODEL.column.frequency_scale
    motion = sb.Harmonic.circular(acceleration=0.065 * gravity, angular_frequency=1.0)
    frequency = scale * np.array([0.8, 1.4, 2.5])
    curves = sb.studies.response_curves(MODEL, motion, angular_frequency=frequency)
    c = MODEL.column.slenderness
    steady = sb.theory.steady_rolling(frequency / scale, 0.065, c=c, eta=0.1)
    np.testing.assert_allclose(curves["amplitude"].sel(branch="upper")[0], steady.upper.amplitude, rtol=1e-12)
    np.testing.assert_allclose(curves["phase"].sel(branch="lower")[0], steady.lower.phase, rtol=1e-12)
    critical = scale * sb.theory.critical_frequency(0.065, c=c, eta=0.1)
    np.testing.assert_allclose(curves["critical_frequency"], [critical], rtol=1e-12)


def test_straight_motion_rolls_in_both_senses_and_circular_in_one():
    straight = sb.Harmonic.straight(acceleration=1.0, angular_frequency=1.0, direction=0.4)
    circular = sb.Harmonic.circular(acceleration=1.0, angular_frequency=1.0, sense=-1)
    both = sb.studies.response_curves(MODEL, straight, angular_frequency=[3.0])
    one = sb.studies.response_curves(MODEL, circular, angular_frequency=[3.0])
    assert list(both["sense"].values) == ["anticlockwise", "clockwise"]
    assert list(one["sense"].values) == ["clockwise"]


@pytest.mark.parametrize("sense", [1, -1])
@pytest.mark.parametrize("start_phase", [0.0, 0.9])
def test_a_start_on_circular_rolling_stays_on_it(sense, start_phase):
    motion = sb.Harmonic.circular(acceleration=0.6, angular_frequency=2.4, sense=sense, start_phase=start_phase)
    start = sb.studies.steady_start(MODEL, motion)
    run = sb.simulate(MODEL, motion, **start, duration=10 * motion.period, rtol=1e-11)
    tilt = np.hypot(*start["tilt"])
    # Ten times the accumulated tolerance of some 300 steps.
    assert np.abs(run.data["amplitude"] / tilt - 1.0).max() < 3e-8
    assert run.measures["turns"] == pytest.approx(10.0 * sense, rel=1e-7)


def test_a_start_on_elliptic_rolling_is_near_a_motion_that_follows_it():
    motion = sb.Harmonic.elliptic(amplitude=(0.6, 0.5), phase=-1.4, angular_frequency=4.0, start_phase=0.3)
    start = sb.studies.steady_start(MODEL, motion)
    run = sb.simulate(MODEL, motion, **start, duration=20 * motion.period)
    assert run.measures["turns"] == pytest.approx(20.0, abs=0.1)


@pytest.mark.parametrize(
    ("change", "name"),
    [
        ({"angular_frequency": [-1.0]}, "angular_frequency"),
        ({"angular_frequency": [[1.0]]}, "angular_frequency"),
        ({"motion": sb.Harmonic.vertical(acceleration=1.0, angular_frequency=1.0)}, "motion"),
        ({"motion": 3}, "motion"),
    ],
)
def test_bad_input_is_named(change, name):
    arguments = {
        "motion": sb.Harmonic.circular(acceleration=1.0, angular_frequency=1.0),
        "angular_frequency": [1.0],
    } | change
    with pytest.raises(ParameterError, match=name):
        sb.studies.response_curves(MODEL, arguments["motion"], angular_frequency=arguments["angular_frequency"])


def test_no_start_where_there_is_no_solution():
    model = sb.Slender(sb.Column.dimensionless(0.1), damping=0.3)
    motion = sb.Harmonic.circular(acceleration=0.01, angular_frequency=1.0)
    with pytest.raises(ParameterError, match="no steady rolling"):
        sb.studies.steady_start(model, motion)


@pytest.mark.parametrize("sense", [1, -1])
def test_the_slow_flow_is_exact_on_a_circle(sense):
    motion = sb.Harmonic.circular(acceleration=0.6, angular_frequency=2.4, sense=sense, start_phase=0.7)
    start = sb.studies.steady_start(MODEL, motion)
    start["tilt"] = (1.1 * start["tilt"][0], 1.1 * start["tilt"][1])
    run = sb.simulate(MODEL, motion, **start, duration=20.0, rtol=1e-11)
    slow = averaged_motion(MODEL, motion, **start, duration=20.0, rtol=1e-11)
    full = run.sample(slow["time"])
    np.testing.assert_allclose(slow["amplitude"], full["amplitude"], rtol=1e-8)
    np.testing.assert_allclose(slow["azimuth"] - slow["azimuth"][0], full["azimuth"] - full["azimuth"][0], atol=1e-8)


def test_the_slow_flow_follows_a_weakly_driven_straight_motion():
    motion = sb.Harmonic.straight(acceleration=0.12, angular_frequency=4.0, direction=0.5, start_phase=0.3)
    start = sb.studies.steady_start(MODEL, motion, sense=-1)
    run = sb.simulate(MODEL, motion, **start, duration=10 * motion.period)
    slow = averaged_motion(MODEL, motion, **start, duration=10 * motion.period, sense=-1)
    full = run.sample(slow["time"])
    # The swing about the average is about 2.3 a1/c = 0.28 of the tilt; the mean follows far better.
    np.testing.assert_allclose(full["amplitude"], slow["amplitude"], rtol=0.35)
    assert float(full["amplitude"].mean() / slow["amplitude"].mean()) == pytest.approx(1.0, abs=0.02)
    turned = float(full["azimuth"][-1] - full["azimuth"][0]) / (2.0 * np.pi)
    assert turned == pytest.approx(-10.0, abs=0.05)


FULL = sb.Column.solid(radius=0.8, height=4.0, density=2700.0)


@pytest.mark.parametrize(
    "model",
    [
        sb.SlenderRolling(FULL, damping=0.1, spin_damping=0.2),
        sb.Wobbling(FULL, damping=0.1),
        sb.Wobbling(FULL, damping=0.1, constraint="rubber"),
        sb.Rolling(FULL, damping=0.1, spin_damping=0.2),
    ],
    ids=lambda model: f"{model.name}-{getattr(model, 'constraint', '')}",
)
@pytest.mark.parametrize("sense", [1, -1])
def test_a_start_is_on_the_steady_rolling_of_its_model(model, sense):
    motion = sb.Harmonic.circular(acceleration=1.2, angular_frequency=3.6, sense=sense, start_phase=0.7)
    start = sb.studies.steady_start(model, motion)
    run = sb.simulate(model, motion, **start, duration=10.0 * motion.period, rtol=1e-10)
    np.testing.assert_allclose(run.data["amplitude"], run.data["amplitude"][0], rtol=1e-6)
    turned = float(run.data["azimuth"][-1] - run.data["azimuth"][0]) / (2.0 * np.pi)
    assert turned == pytest.approx(10.0 * sense, abs=1e-6)
    if model.spin_state is None:
        assert "spin" not in start
    else:
        assert sense * start["spin"] < 0.0  # against the rolling
        np.testing.assert_allclose(run.data["spin"], start["spin"], rtol=1e-6)


def test_the_branches_of_full_rolling():
    model = sb.Rolling(FULL, damping=0.1, spin_damping=0.2)
    motion = sb.Harmonic.circular(acceleration=1.2, angular_frequency=3.6)
    rolling = sb.theory.full_rolling(
        3.6 * model.time_scale,
        1.2 / FULL.gravity,
        c=FULL.slenderness,
        eta=0.1,
        zeta=0.2,
        inertia_ratio=FULL.inertia_ratio,
        axial_ratio=FULL.axial_ratio,
    )
    assert rolling.stable.tolist() == [False, True]
    for index, branch in enumerate(("lower", "upper")):
        start = sb.studies.steady_start(model, motion, branch=branch)
        assert np.hypot(*start["tilt"]) == pytest.approx(rolling.amplitude[index], rel=1e-12)
        assert start["spin"] * model.time_scale == pytest.approx(rolling.spin[index], rel=1e-12)


@dataclass(frozen=True, slots=True)
class Own(sb.Slender):
    """A model with equations of its own."""

    rates = staticmethod(sb.Slender.rates)


@pytest.mark.parametrize(
    ("model", "branch", "told"),
    [
        (sb.PlanarRocking(FULL), "upper", "got model planar rocking"),
        (Own(FULL), "upper", "steady_start needs a closed form"),
        (sb.Wobbling(FULL, rolling_resistance=0.01), "upper", "rolling_resistance must be 0"),
        (sb.Rolling(FULL, rolling_resistance=0.01), "upper", "rolling_resistance must be 0"),
        (sb.SlenderRolling(FULL, couples="isotropic"), "upper", "couples must be 'contact'"),
        (sb.SlenderRolling(FULL), "lower", 'branch must be "upper" for slender rolling'),
        (sb.Rolling(FULL, damping=0.1), "upper", "spin_damping must be above zero"),
        (sb.Rolling(FULL), "left", 'branch must be "upper" or "lower"'),
    ],
)
def test_no_start_where_there_is_no_closed_form(model, branch, told):
    motion = sb.Harmonic.circular(acceleration=1.2, angular_frequency=3.6)
    with pytest.raises(StylobateError, match=told) as error:
        sb.studies.steady_start(model, motion, branch=branch)
    assert "\n" not in str(error.value)
