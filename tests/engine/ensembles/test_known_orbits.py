"""Runs that have converged to a known orbit end early, with the outcome that they would have at their full duration."""

import math

import numpy as np
import pytest
import xarray as xr

import stylobate as sb
from stylobate import theory
from stylobate.errors import Outcome, ParameterError, UnsupportedError

pytestmark = pytest.mark.long

MODEL = sb.Slender(sb.Column.dimensionless(0.1), damping=0.1)
MOTION = sb.Harmonic.circular(acceleration=0.065, angular_frequency=1.8)
UPPER = theory.steady_rolling(1.8, 0.065, c=0.1, eta=0.1).upper
START = sb.studies.steady_start(MODEL, MOTION)
PERIODS = 300


def rolling(**changed):
    multiplier = math.exp(UPPER.eigenvalues.real.max() * MOTION.period)
    tilt = float(UPPER.amplitude)
    return sb.KnownOrbit(**{**START, "multiplier": multiplier, "turns": 1.0, "mean_tilt": tilt, **changed})


def near(part, count=60, start=START):
    """Return starts about `start` within this part of its tilt and rate."""
    rng = np.random.default_rng(7)
    return {
        name: np.asarray(start[name]) + part * math.hypot(*start[name]) * rng.uniform(-1.0, 1.0, (count, 2))
        for name in ("tilt", "tilt_rate")
    }


def both(starts, orbits, periods=PERIODS, **options):
    options = {"duration": periods * MOTION.period, **starts, **options}
    return [sb.simulate_ensemble(MODEL, MOTION, known_orbits=known, **options) for known in (None, orbits)]


@pytest.mark.parametrize("method", ["dop853", "taylor"])
def test_outcomes_are_those_of_the_full_duration_and_other_runs_keep_their_bits(method):
    full, early = both(near(1.5), rolling(), strobes=32, method=method)
    np.testing.assert_array_equal(early["outcome"], full["outcome"])
    ended = (early["outcome"] == Outcome.ROLLING).values
    assert ended.any()
    assert (~ended).any()
    assert (early["end_time"].values[ended] < 0.5 * full["end_time"].values[ended]).all()
    for name in full.data_vars:
        np.testing.assert_array_equal(early[name].values[~ended], full[name].values[~ended], err_msg=name)
    # Results over the last periods are those of the orbit, or none.
    for name in ("mean_tilt", "mean_rolling_rate", "strobe_tilt", "strobe_tilt_rate", "peak_tilt", "minimum_tilt"):
        np.testing.assert_allclose(early[name].values[ended], full[name].values[ended], rtol=0.0, atol=1e-8)
    assert np.isnan(early["repetition"].values[ended]).all()
    np.testing.assert_array_equal(early["decided_at"].values[ended], early["end_time"].values[ended])


def test_a_run_that_would_not_settle_in_time_is_followed_to_its_end():
    full, early = both(near(0.05), rolling(), periods=60)
    assert (full["outcome"] == Outcome.STILL_MOVING).all()
    np.testing.assert_array_equal(early["outcome"], full["outcome"])
    np.testing.assert_array_equal(early["end_time"], full["end_time"])


def test_a_passage_near_a_saddle_ends_no_run():
    lower = theory.steady_rolling(1.8, 0.065, c=0.1, eta=0.1).lower
    assert lower.eigenvalues.real.max() > 0.0
    saddle = sb.studies.steady_start(MODEL, MOTION, branch="lower")
    false = rolling(**saddle, mean_tilt=float(lower.amplitude))  # as if it were stable
    # The nearest of these starts pass the saddle at less than the distance within which runs are compared with it.
    for part in (1e-7, 1e-3, 0.02):
        full, early = both(near(part, start=saddle), false)
        np.testing.assert_array_equal(early["end_time"], full["end_time"])
        np.testing.assert_array_equal(early["outcome"], full["outcome"])


def test_with_a_wrong_multiplier_a_run_ends_on_the_orbit_only():
    for multiplier in (0.6, 0.95):
        full, early = both(near(0.05), rolling(multiplier=multiplier))
        np.testing.assert_array_equal(early["outcome"], full["outcome"])
        # From 0.05 of its size to 1e-6, where tolerances hide the rate, a distance takes 62 periods at the true rate.
        assert (early["end_time"] > 60 * MOTION.period).all()


def test_of_several_orbits_each_run_takes_its_own_and_nan_is_none():
    elsewhere = rolling(tilt=(0.5, 0.0))
    none = rolling(multiplier=math.nan)
    many = both(near(0.05), [elsewhere, none, rolling()])[1]
    np.testing.assert_array_equal(many["end_time"], both(near(0.05), rolling())[1]["end_time"])
    full, early = both(near(0.05), [none])
    np.testing.assert_array_equal(early["end_time"], full["end_time"])
    per_run = rolling(multiplier=np.where(np.arange(60) % 2, rolling().multiplier, math.nan))
    np.testing.assert_array_equal(both(near(0.05), per_run)[1]["end_time"] < full["end_time"], np.arange(60) % 2 == 1)


def test_rocking_is_said_of_an_orbit_that_does_not_travel_round():
    assert (both(near(0.05), rolling(turns=0.0))[1]["outcome"] == Outcome.ROCKING).all()


@pytest.mark.parametrize(
    "motion",
    [pytest.param(None, marks=pytest.mark.slow), sb.Pulse.one_sine(acceleration=0.05, angular_frequency=2.0)],
)
def test_without_a_period_no_run_is_compared(motion):
    options = {**near(0.2), "duration": 200.0}
    full, early = (sb.simulate_ensemble(MODEL, motion, known_orbits=known, **options) for known in (None, rolling()))
    xr.testing.assert_equal(early, full)


def test_what_is_no_stable_orbit_is_refused():
    for name, value, text in (
        ("multiplier", 1.01, "multiplier must lie between 0 and 1"),
        ("mean_tilt", 0.0, "mean_tilt must be positive"),
        ("turns", 0.5, "turns must be -1 or 1"),
        ("tilt", (math.inf, 0.0), "tilt must be finite"),
    ):
        with pytest.raises(ParameterError, match=text):
            rolling(**{name: value})
    with pytest.raises(ParameterError, match="known_orbits must be a KnownOrbit"):
        both(near(0.1), [START])
    with pytest.raises(ParameterError, match=r"known_orbits\[0\].turns must have 60 values along run"):
        both(near(0.1), rolling(turns=[1.0, 1.0]))
    slides = sb.Sliding(MODEL.column, friction_coefficient=0.5)
    with pytest.raises(UnsupportedError, match="leave out known_orbits"):
        sb.simulate_ensemble(slides, MOTION, duration=10.0, known_orbits=rolling())
