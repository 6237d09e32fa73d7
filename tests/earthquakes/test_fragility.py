"""Fragility curves: agreement with another probit, intervals that hold the truth, data that determine no curve."""

import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize
from scipy.special import log_ndtr, ndtr
from scipy.stats import binom, chi2

from stylobate.earthquakes import Counting, FitStatus, fit_fragility, lognormal_fragility
from stylobate.earthquakes.fragility.likelihood import _climb, log_likelihood
from stylobate.errors import ParameterError

MEDIAN, DISPERSION = 3.0, 0.4


def runs(rng, count, *, spread=0.6):
    intensity = MEDIAN * np.exp(rng.normal(0.0, spread, count))
    return intensity, rng.random(count) < ndtr(np.log(intensity / MEDIAN) / DISPERSION)


def status(found):
    return FitStatus(found["status"].item())


def least_covered(share, replications, risk=1e-4):
    """Return how many intervals of a coverage `share` hold the truth at least, but for a risk."""
    return binom.ppf(risk, replications, share)


@pytest.mark.parametrize("count", [30, 200, 2000])
def test_the_fit_is_the_probit_of_statsmodels(count):
    import statsmodels.api as sm

    intensity, reached = runs(np.random.default_rng(count), count)
    found = fit_fragility(intensity, reached)
    design = np.column_stack([np.ones(count), np.log(intensity)])
    probit = sm.Probit(reached.astype(float), design).fit(disp=0, tol=1e-13)
    a, b = probit.params
    # ln m = −a/b, ln β = −ln b: the covariance is carried over by their derivatives.
    jacobian = np.array([[-1.0 / b, a / b**2], [0.0, -1.0 / b]])
    np.testing.assert_allclose(found["median"].item(), np.exp(-a / b), rtol=1e-8)
    np.testing.assert_allclose(found["dispersion"].item(), 1.0 / b, rtol=1e-8)
    np.testing.assert_allclose(found["log_likelihood"].item(), probit.llf, rtol=1e-12)
    np.testing.assert_allclose(found["covariance"][0], jacobian @ probit.cov_params() @ jacobian.T, rtol=1e-6)


def test_a_step_is_halved_until_it_does_not_lower_the_likelihood():
    u = np.linspace(-1.0, 1.0, 9)
    hits = np.array([[0, 0, 1, 0, 1, 1, 1, 1, 1], [0, 1, 0, 0, 1, 0, 1, 1, 1]], float)
    start, step = np.zeros((2, 2)), np.array([[0.5, 30.0], [0.0, 1.0]])
    value = log_likelihood(start[:, 0], start[:, 1], u, hits, 1.0 - hits)
    found, reached = _climb(start, step, value, u, hits, 1.0 - hits)
    for one, (halved, by) in enumerate(zip((True, False), step, strict=True)):
        likelihood = [log_likelihood(*(by[:, None] / 2.0**k), u, hits[one], 1.0 - hits[one])[0] for k in range(5)]
        halvings = np.flatnonzero(likelihood >= value[one])[0]
        assert (halvings > 0) == halved
        np.testing.assert_array_equal(found[one], by / 2.0**halvings)
        assert reached[one] == pytest.approx(likelihood[halvings], rel=1e-14)


def test_ends_of_profile_intervals_are_just_rejected_by_the_likelihood_ratio_test():
    intensity, reached = runs(np.random.default_rng(4), 60)
    found = fit_fragility(intensity, reached, confidence=0.9)
    u = np.log(intensity)

    def deviance(mu, log_beta):
        eta = (u - mu) / np.exp(log_beta)
        return -2.0 * np.sum(np.where(reached, log_ndtr(eta), log_ndtr(-eta)))

    best = -2.0 * found["log_likelihood"].item()
    for end in ("median_low", "median_high"):
        mu = np.log(found[end].item())
        rest = minimize(lambda b, mu=mu: deviance(mu, b[0]), [np.log(0.4)], method="Nelder-Mead", tol=1e-10)
        assert rest.fun - best == pytest.approx(chi2.ppf(0.9, 1), rel=1e-6)
    for end in ("dispersion_low", "dispersion_high"):
        log_beta = np.log(found[end].item())
        rest = minimize(lambda m, b=log_beta: deviance(m[0], b), [np.log(3.0)], method="Nelder-Mead", tol=1e-10)
        assert rest.fun - best == pytest.approx(chi2.ppf(0.9, 1), rel=1e-6)


def covered(seed, replications, count):
    """Return how many intervals of median and of dispersion hold the truth."""
    rng = np.random.default_rng(seed)
    held = np.zeros(2)
    for _ in range(replications):
        found = fit_fragility(*runs(rng, count))
        held += [
            found["median_low"].item() <= MEDIAN <= found["median_high"].item(),
            found["dispersion_low"].item() <= DISPERSION <= found["dispersion_high"].item(),
        ]
    return held


@pytest.mark.slow
def test_intervals_hold_the_truth_as_often_as_they_say():
    held = covered(11, 200, 100)
    assert np.all(held >= least_covered(0.94, 200))


@pytest.mark.slow
@pytest.mark.parametrize("count", [60, 200])
def test_intervals_hold_the_truth_as_often_as_they_say_of_many(count):
    held = covered(12, 2000, count)
    assert np.all(held >= least_covered(0.94, 2000))
    assert np.all(held <= binom.ppf(1.0 - 1e-4, 2000, 0.96))


def records(rng, count, *, between=0.35, within=0.2):
    """Return intensities, what was reached, and records: runs of one record share a part of their capacity."""
    scale = np.geomspace(1.0, 9.0, 9)
    capacity = rng.normal(0.0, between, (count, 1)) + rng.normal(0.0, within, (count, scale.size))
    dims = ("record", "scale")
    return xr.DataArray(scale, dims="scale"), xr.DataArray(np.log(scale / MEDIAN) > capacity, dims=dims)


def covered_by_records(seed, replications, count, **options):
    rng = np.random.default_rng(seed)
    held = np.zeros(2)
    truth = MEDIAN, np.hypot(0.35, 0.2)
    for _ in range(replications):
        found = fit_fragility(*records(rng, count), **{"resamples": 300, "rng": rng, **options})
        held += [
            found[f"{name}_low"].item() <= true <= found[f"{name}_high"].item()
            for name, true in zip(("median", "dispersion"), truth, strict=True)
        ]
    return held


@pytest.mark.slow
def test_resampled_records_hold_the_truth_where_independent_runs_do_not():
    held = covered_by_records(5, 300, 40)
    # Of 40 records the interval of the dispersion still falls short of 95 % by a few.
    assert held[0] >= least_covered(0.92, 300)
    assert held[1] >= least_covered(0.90, 300)
    alone = covered_by_records(5, 300, 40, resamples=0)
    assert alone[0] < least_covered(0.92, 300)


def test_resampled_intervals_are_wider_where_runs_of_a_record_go_together():
    rng = np.random.default_rng(8)
    data = records(rng, 30, within=0.0)
    alone, together = fit_fragility(*data), fit_fragility(*data, resamples=400, rng=rng)
    assert together.attrs["intervals"] == "400 resamples of the records"
    assert "independent" in alone.attrs["intervals"]
    widths = [np.log(one["median_high"] / one["median_low"]).item() for one in (alone, together)]
    assert widths[1] > 1.2 * widths[0]
    for name in ("median", "dispersion"):
        assert together[name].item() == alone[name].item()


def test_records_that_all_agree_do_not_pretend_to_know_the_dispersion():
    scale, states = np.tile([1.0, 2.0, 4.0, 8.0], 6), np.tile([0, 0, 1, 1], 6)
    record = np.repeat(np.arange(6), 4)
    drawn = fit_fragility(scale, states, record=record, resamples=20, rng=np.random.default_rng(0))
    alone = fit_fragility(scale, states)
    for name in ("median_low", "median_high", "dispersion_low", "dispersion_high"):
        assert drawn[name].item() == alone[name].item()
    assert drawn["median_low"].item() < 4.0
    assert drawn["dispersion_high"].item() > 0.1


def test_the_same_seed_gives_the_same_intervals():
    data = records(np.random.default_rng(1), 12)
    first, second = (fit_fragility(*data, resamples=50, rng=np.random.default_rng(3)) for _ in range(2))
    xr.testing.assert_identical(first, second)


@settings(max_examples=20)
@given(factor=st.floats(1e-3, 1e3), seed=st.integers(0, 20))
def test_another_unit_of_the_intensity_scales_the_median_and_nothing_else(factor, seed):
    intensity, reached = runs(np.random.default_rng(seed), 80)
    one, other = fit_fragility(intensity, reached), fit_fragility(factor * intensity, reached)
    for name in ("median", "median_low", "median_high"):
        np.testing.assert_allclose(other[name], factor * one[name], rtol=1e-6)
    for name in ("dispersion", "dispersion_low", "dispersion_high", "probability_low", "stripe_share"):
        np.testing.assert_allclose(other[name], one[name], rtol=1e-6, atol=1e-12)


def test_none_reached_bounds_the_median_from_below_only():
    found = fit_fragility(np.arange(1.0, 31.0), np.zeros(30))
    assert status(found) is FitStatus.NONE_REACHED
    assert np.isnan(found["median"].item())
    assert 20.0 < found["median_low"].item() <= 30.0
    assert found["median_high"].item() == np.inf
    assert np.isnan(found["probability"]).all()


def test_all_reached_bounds_the_median_from_above_only():
    found = fit_fragility(np.arange(1.0, 31.0), np.ones(30))
    assert status(found) is FitStatus.ALL_REACHED
    assert found["median_low"].item() == 0.0
    assert 1.0 <= found["median_high"].item() < 3.0


def test_separated_data_bound_median_and_dispersion_and_fit_neither():
    found = fit_fragility([1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0], [0, 0, 0, 0, 1, 1, 1, 1])
    assert status(found) is FitStatus.SEPARATED
    assert np.isnan(found["median"].item())
    assert np.isnan(found["dispersion"].item())
    assert found["median_low"].item() < 4.0
    assert found["median_high"].item() > 5.0
    assert found["dispersion_low"].item() == 0.0
    assert 0.0 < found["dispersion_high"].item() < np.inf
    assert (found["largest_safe"].item(), found["least_reached"].item()) == (4.0, 5.0)


@pytest.mark.parametrize(
    ("intensity", "reached", "expected"),
    [
        ([2.0] * 10, [1] * 4 + [0] * 6, FitStatus.ONE_INTENSITY),
        ([1.0, 2.0, 3.0, 4.0], [1, 1, 0, 0], FitStatus.NOT_INCREASING),
        ([1.0, 2.0, 3.0, 4.0], [1, 0, 1, 0], FitStatus.NOT_INCREASING),
        ([1.0, 2.0], [-1, -1], FitStatus.NO_RUNS),
        ([1.0, 2.0, 2.0, 3.0], [0, 0, 1, 1], FitStatus.SEPARATED),
    ],
)
def test_data_that_determine_no_curve_are_told(intensity, reached, expected):
    found = fit_fragility(intensity, reached)
    assert status(found) is expected
    assert np.isnan(found["median"].item())
    assert found["median_low"].item() < found["median_high"].item()


def test_a_weak_rise_leaves_the_dispersion_open_above():
    found = fit_fragility([1.0, 2.0, 3.0, 4.0, 5.0, 6.0], [0, 1, 0, 1, 0, 1])
    assert status(found) is FitStatus.FITTED
    assert found["dispersion_high"].item() == np.inf


def test_runs_that_are_not_known_do_not_count():
    intensity, reached = runs(np.random.default_rng(2), 50)
    more = fit_fragility([*intensity, 100.0, 0.01], [*reached.astype(int), -1, -1])
    alone = fit_fragility(intensity, reached)
    assert more["median"].item() == alone["median"].item()
    assert (more["runs"].item(), more["runs_not_known"].item()) == (50, 2)


def test_counting_the_first_counts_all_above_it_and_records_are_flagged_either_way():
    scale = xr.DataArray([1.0, 2.0, 3.0, 4.0], dims="scale")
    states = [[0, 1, 0, 1], [0, 0, 1, 1], [0, 0, 0, 1], [0, 0, 1, 1]]
    reached = xr.DataArray(states, dims=("record", "scale"))
    computed, first = (fit_fragility(scale, reached, counting=one) for one in Counting)
    assert computed["stripe_reached"].values.tolist() == [[0, 1, 2, 4]]
    assert first["stripe_reached"].values.tolist() == [[0, 1, 3, 4]]
    assert first["median"].item() < computed["median"].item()
    for found in (computed, first):
        assert found["non_monotone_records"].item() == 1


def test_property_samples_of_a_record_are_series_of_their_own():
    # Each sample is monotone; their runs of one record together are not.
    states = [[[0, 1, 1], [0, 0, 1]], [[0, 0, 1], [0, 1, 1]]]
    reached = xr.DataArray(states, dims=("record", "property_sample", "scale"))
    scale = xr.DataArray([1.0, 2.0, 3.0], dims="scale")
    found = fit_fragility(scale, reached, counting=Counting.FIRST)
    assert found["non_monotone_records"].item() == 0
    assert found["stripe_reached"].values.tolist() == [[0, 2, 4]]


def test_each_limit_state_is_fitted_by_itself():
    rng = np.random.default_rng(6)
    intensity, reached = runs(rng, 60)
    both = xr.DataArray([reached, np.zeros(60)], dims=("limit_state", "run"), coords={"limit_state": ["tilt", "fall"]})
    found = fit_fragility(intensity, both)
    assert found["median"].sel(limit_state="tilt").item() == fit_fragility(intensity, reached)["median"].item()
    assert FitStatus(found["status"].sel(limit_state="fall").item()) is FitStatus.NONE_REACHED


def test_a_result_survives_a_file(tmp_path):
    found = fit_fragility(*runs(np.random.default_rng(3), 40))
    found.to_netcdf(tmp_path / "fragility.nc", engine="h5netcdf")
    with xr.open_dataset(tmp_path / "fragility.nc", engine="h5netcdf") as again:
        xr.testing.assert_equal(found, again.load())


def test_a_given_fragility_has_half_of_its_probability_at_the_median():
    found = lognormal_fragility(2.0, 0.5)
    half = np.interp(np.log(2.0), np.log(found["curve_intensity"]), found["probability"][0])
    assert half == pytest.approx(0.5, abs=1e-12)


@pytest.mark.parametrize(
    ("arguments", "options", "message"),
    [
        (([1.0, 0.0], [0, 1]), {}, "intensity must be positive and finite, got 0.0"),
        ((["1.0", "x"], [0, 1]), {}, "intensity must hold real numbers"),
        (([], []), {}, "intensity must hold at least one run"),
        (([1.0, 2.0], [0, 2]), {}, "reached must hold True or False"),
        (([1.0, 2.0], [0.0, np.nan]), {}, "reached must hold True or False"),
        (([1.0, 2.0, 3.0], [0, 1]), {}, "intensity must have the shape of reached"),
        (([1.0, 2.0], [0, 1]), {"record": [1]}, "record must have the shape of reached"),
        (([1.0, 2.0], [0, 1]), {"resamples": 10}, r"resamples: requires two or more records \(got 10 resamples\)"),
        (([1.0, 2.0], [0, 1]), {"resamples": 10, "record": [1, 2]}, "rng: required to resample the records"),
        (([1.0, 2.0], [0, 1]), {"counting": Counting.FIRST}, "counting must be Counting.AS_COMPUTED"),
        (([1.0, 2.0], [0, 1]), {"confidence": 95.0}, "confidence must lie between 0 and 1, got 95.0"),
    ],
)
def test_mistakes_are_told_in_one_line(arguments, options, message):
    with pytest.raises(ParameterError, match=message) as raised:
        fit_fragility(*arguments, **options)
    assert "\n" not in str(raised.value)
