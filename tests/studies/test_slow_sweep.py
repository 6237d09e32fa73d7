"""Slow sweeps follow exact solutions as long as these are stable, and show where columns jump, and that they stay."""

import sys

import numpy as np
import pytest

import stylobate as sb
from stylobate.errors import Interrupted, Outcome, ParameterError, UnsupportedError
from stylobate.results import OutcomeRules
from stylobate.results.outcomes import NOT_COMPUTED

MODEL = sb.Slender(sb.Column.dimensionless(0.1), damping=0.1)
CIRCULAR = sb.Harmonic.circular(acceleration=0.065, angular_frequency=2.0)
STRAIGHT = sb.Harmonic.straight(acceleration=0.13, angular_frequency=3.0)
CRITICAL = 1.3971075892
PITCHFORK = 1.620454
RTOL = 1e-8


def at(motion, frequency):
    return sb.with_parameters(MODEL, motion, angular_frequency=float(frequency))[1]


def outcomes(swept):
    return [None if code < 0 else sb.Outcome(code) for code in swept["outcome"].values[:, 0]]


@pytest.fixture(scope="module")
def downward():
    values = np.concatenate([np.linspace(2.0, 1.45, 12), np.arange(1.44, 1.296, -0.004)])
    start = sb.studies.steady_start(MODEL, CIRCULAR)
    return sb.studies.slow_sweep(MODEL, CIRCULAR, values=values, periods_each=100, **start)


def test_a_sweep_stays_on_the_exact_solution_8_while_that_is_stable(downward):
    steady = downward.isel(step=slice(0, 12), sweep=0)
    nu = steady["angular_frequency"].values
    exact = sb.theory.steady_rolling(nu, 0.065, c=0.1, eta=0.1).upper
    # A step disturbs by about as much as the tilt changes; what is left decays with the eigenvalue of (7).
    rate = exact.eigenvalues.real.max(axis=-1)
    settling = 49 * 2.0 * np.pi / nu
    left = np.abs(np.diff(exact.amplitude, prepend=exact.amplitude[0])) * np.exp(rate * settling)
    # Errors of rtol of a step, some hundred of them while they decay.
    allowed = 10.0 * left + 100.0 * RTOL * exact.amplitude
    for name in ("mean_tilt", "minimum_tilt", "peak_tilt"):
        assert (np.abs(steady[name].values - exact.amplitude) < allowed).all()
    np.testing.assert_allclose(steady["turns_per_period"], 1.0, atol=1e-6)
    assert set(outcomes(downward)[:12]) == {Outcome.ROLLING}


def test_below_the_critical_frequency_it_is_modulated_and_then_overturns(downward):
    one = downward.isel(sweep=0)
    nu = one["angular_frequency"].values
    told = outcomes(downward)
    lost = told.index(Outcome.OVERTURNED)
    # Modulated rolling is lost at 1.312; each step of 0.004 may do it one step before.
    assert 1.310 < nu[lost] < 1.322
    modulated = slice(int(np.flatnonzero(nu < CRITICAL - 0.01)[0]), lost)
    assert set(told[modulated]) <= {Outcome.MODULATED, Outcome.STILL_MOVING}
    assert told[modulated].count(Outcome.MODULATED) > 0.8 * len(told[modulated])
    swing = (one["peak_tilt"] - one["minimum_tilt"]).values[modulated]
    assert (np.diff(swing) > 0.0).all()
    # It turns with the base: the lean swings about that of steady rolling by less than half a turn.
    np.testing.assert_allclose(one["turns_per_period"].values[modulated], 1.0, atol=0.5 / 51)


def test_modulated_rolling_swings_as_far_as_published(downward):
    near = downward.isel(sweep=0, step=int(np.abs(downward["angular_frequency"].values[:, 0] - 1.36).argmin()))
    steady = sb.theory.steady_rolling(1.36, 0.065, c=0.1, eta=0.1).upper.amplitude
    # Two published digits, 51 periods hold about 49 swings of which one comes within a percent of the extremes.
    assert float(near["minimum_tilt"]) / steady == pytest.approx(0.64, abs=0.01)
    assert float(near["peak_tilt"]) / steady == pytest.approx(1.29, abs=0.01)


def test_after_overturning_nothing_is_computed(downward):
    told = outcomes(downward)
    lost = told.index(Outcome.OVERTURNED)
    after = downward.isel(step=slice(lost + 1, None))
    assert after.sizes["step"] > 0
    assert (after["outcome"] == NOT_COMPUTED).all()
    for name in ("mean_tilt", "peak_tilt", "end_tilt"):
        assert downward[name].isel(step=slice(lost, None)).isnull().all()


@pytest.mark.slow
def test_a_sweep_of_a_straight_line_stays_on_the_exact_orbit_to_the_pitchfork_and_leaves_with_its_branch():
    orbit = sb.orbits.periodic_orbit(MODEL, STRAIGHT)
    # No value so near to the pitchfork that the sweep lags behind.
    values = np.array([*np.linspace(3.0, 1.7, 14), 1.66, 1.64, 1.60, 1.58])
    start = {"tilt": orbit.tilt, "tilt_rate": orbit.tilt_rate}
    swept = sb.studies.slow_sweep(MODEL, STRAIGHT, values=values, periods_each=300, **start).isel(sweep=0)
    for step, value in enumerate(values):
        end = swept.isel(step=step)
        state = np.concatenate([end["end_tilt"].values, end["end_tilt_rate"].values])
        exact = sb.orbits.periodic_orbit(MODEL, at(STRAIGHT, value), guess=state)
        assert exact.stable
        assert exact.inversion == (value > PITCHFORK)
        # Errors of rtol of a step, about 40 steps a period, kept for 1/(1 − |μ|) periods.
        kept = 40.0 / (1.0 - np.abs(exact.multipliers).max())
        near = np.concatenate([exact.tilt, exact.tilt_rate])
        assert np.abs(state - near).max() < kept * RTOL * np.abs(near).max()
        assert float(end["mean_tilt"]) == pytest.approx(exact.mean_tilt, rel=kept * RTOL)
        # The orbit's peak tilt is met to half a sample of 512: 1 − cos(π/512).
        tilts = np.hypot(*exact.states(512)[:2])
        assert float(end["peak_tilt"]) == pytest.approx(tilts.max(), rel=2e-5)


@pytest.fixture(scope="module")
def over_a_fold():
    model = sb.Slender(sb.Column.dimensionless(0.1), damping=0.3)
    motion = sb.Harmonic.circular(acceleration=0.01, angular_frequency=3.0)
    start = sb.studies.steady_start(model, motion)
    return sb.studies.slow_sweep(model, motion, values=np.arange(3.0, 2.45, -0.1), periods_each=100, back=True, **start)


def test_past_the_fold_of_8_it_falls_to_rest_and_stays_there_on_the_way_back(over_a_fold):
    nu = over_a_fold["angular_frequency"].values[:, 0]
    np.testing.assert_allclose(nu, [3.0, 2.9, 2.8, 2.7, 2.6, 2.5, 2.6, 2.7, 2.8, 2.9, 3.0])
    # Without a solution from a0(1 + ν²) < ην √(c² − a0²) on: ν² − kν + 1 < 0.
    k = 0.3 * np.sqrt(0.1**2 - 0.01**2) / 0.01
    fold = k / 2.0 + np.sqrt(k**2 / 4.0 - 1.0)
    told = outcomes(over_a_fold)
    rolling = [one is Outcome.ROLLING for one in told]
    assert rolling == [*(nu[:6] > fold), *([False] * 5)]
    assert set(told) == {Outcome.ROLLING, Outcome.AT_REST}
    for name in ("mean_tilt", "minimum_tilt", "peak_tilt", "turns_per_period"):
        assert (over_a_fold[name].values[~np.array(rolling)] == 0.0).all()


def test_a_sweep_whose_value_stays_is_one_run():
    start = {"tilt": (0.03, 0.01), "tilt_rate": (0.0, 0.05)}
    motion = sb.Harmonic.elliptic(amplitude=(0.05, 0.03), phase=0.4, angular_frequency=2.5, start_phase=0.7)
    swept = sb.studies.slow_sweep(
        MODEL, motion, values=[2.5] * 4, periods_each=9, rules=OutcomeRules(periods=4), **start
    )
    run = sb.simulate(MODEL, motion, **start, duration=36.0 * motion.period)
    end = run.sample(36.0 * motion.period)
    # Both with errors of rtol of a step, about 40 steps a period, 36 periods.
    for name, whole in (("end_tilt", "tilt"), ("end_tilt_rate", "tilt_rate")):
        np.testing.assert_allclose(swept[name].values[-1, 0], end[whole].values.ravel(), atol=1500.0 * RTOL * 0.1)


def test_a_larger_acceleration_releases_a_column_that_rests():
    values = [0.05, 0.09, 0.11, 0.3]
    swept = sb.studies.slow_sweep(
        MODEL, CIRCULAR, parameter="acceleration", values=values, tilt=(0.0, 0.0), periods_each=60
    )
    told = outcomes(swept)
    assert told[:2] == [Outcome.AT_REST] * 2
    assert told[2] is not Outcome.AT_REST
    assert told[-1] in (Outcome.OVERTURNED, None)
    assert swept["acceleration"].attrs["units"] == "m s-2"


def test_sweeps_advance_together_as_they_would_alone():
    start = sb.studies.steady_start(MODEL, CIRCULAR)
    tilt, rate = np.array(start["tilt"]), np.array(start["tilt_rate"])
    down = np.array([2.0, 1.8, 1.6])
    values = np.stack([down, [2.0, 0.9, 0.8], 4.0 - down], axis=1)
    together = sb.studies.slow_sweep(
        MODEL, CIRCULAR, values=values, tilt=tilt, tilt_rate=[rate, rate, 0.9 * rate], periods_each=60
    )
    assert together["outcome"].dims == ("step", "sweep")
    assert together["outcome"].values[1, 1] == Outcome.OVERTURNED
    for sweep, own in enumerate((rate, rate, 0.9 * rate)):
        alone = sb.studies.slow_sweep(
            MODEL, CIRCULAR, values=values[:, sweep], tilt=tilt, tilt_rate=own, periods_each=60
        )
        for name in ("outcome", "mean_tilt", "end_tilt"):
            np.testing.assert_array_equal(together[name].values[:, sweep], alone[name].values[:, 0])


def test_a_mirrored_start_on_a_straight_line_rolls_the_other_way():
    orbit = sb.orbits.periodic_orbit(MODEL, STRAIGHT)
    sides = np.array([[1.0, 1.0], [1.0, -1.0]])
    swept = sb.studies.slow_sweep(
        MODEL, STRAIGHT, values=[3.0, 2.8], tilt=orbit.tilt * sides, tilt_rate=orbit.tilt_rate * sides
    )
    np.testing.assert_allclose(swept["turns_per_period"], [[1.0, -1.0]] * 2, atol=1e-6)
    np.testing.assert_array_equal(swept["peak_tilt"][:, 0], swept["peak_tilt"][:, 1])


def test_an_interrupted_sweep_hands_over_the_steps_that_were_done(monkeypatch):
    done = []

    def interrupting(*args, **kwargs):
        if len(done) == 2:
            message = "Ctrl-C"
            raise Interrupted(message, None)
        return sb.simulate_ensemble(*args, **kwargs)

    monkeypatch.setattr(sys.modules["stylobate.studies.responses.slow_sweep"], "simulate_ensemble", interrupting)
    start = sb.studies.steady_start(MODEL, CIRCULAR)
    with pytest.raises(Interrupted) as caught:
        sb.studies.slow_sweep(
            MODEL, CIRCULAR, values=[2.0, 1.9, 1.8], **start, progress=lambda step, whole: done.append((step, whole))
        )
    assert done == [(1, 3), (2, 3)]
    assert outcomes(caught.value.partial) == [Outcome.ROLLING, Outcome.ROLLING, None]


@pytest.mark.parametrize(
    ("changed", "named"),
    [
        ({"values": ["fast"]}, "values must be an array of numbers"),
        ({"values": []}, "values must have the shape"),
        ({"values": [2.0, -1.0]}, "angular_frequency"),
        ({"values": [[2.0, 2.0]], "tilt": np.zeros((3, 2))}, "number of sweeps"),
        ({"tilt": (0.1, 0.0, 0.0)}, "tilt must have the shape"),
        ({"periods_each": 50}, "periods_each must be a whole number of at least 51"),
        ({"parameter": "colour"}, "colour"),
    ],
)
def test_a_wrong_argument_is_named(changed, named):
    given = {"values": [2.0, 1.9], "tilt": (0.03, 0.0), **changed}
    with pytest.raises(ParameterError, match=named):
        sb.studies.slow_sweep(MODEL, CIRCULAR, **given)


def test_a_base_motion_with_a_ramp_is_refused():
    ramped = sb.Harmonic.circular(acceleration=0.065, angular_frequency=2.0, ramp=5.0)
    with pytest.raises(UnsupportedError, match="without ramp"):
        sb.studies.slow_sweep(MODEL, ramped, values=[2.0], tilt=(0.03, 0.0))
