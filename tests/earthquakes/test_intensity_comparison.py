"""How well intensity measures predict a limit state."""

import numpy as np
import pytest
import xarray as xr
from numpy.testing import assert_allclose
from scipy.optimize import minimize
from scipy.stats import norm

import stylobate as sb
from stylobate.earthquakes import compare_intensities, fit_fragility

N = 1500


@pytest.fixture(scope="module")
def runs():
    """Runs that a demand x z^0.5 decides, with a dispersion of 0.3; y is x with noise, w knows nothing."""
    rng = np.random.default_rng(3)
    x, z, w = np.exp(rng.normal(0.0, 0.8, (3, N)))
    y = x * np.exp(rng.normal(0.0, 0.5, N))
    hit = np.log(x) + 0.5 * np.log(z) + 0.3 * rng.normal(size=N) > 0.2
    return {"x": x, "y": y, "z": z, "w": w}, hit


@pytest.fixture(scope="module")
def found(runs):
    return compare_intensities(*runs)


def test_each_measure_has_the_fit_of_its_fragility(runs, found):
    measures, hit = runs
    for name in ("x", "y"):
        own = fit_fragility(xr.DataArray(measures[name], dims="run"), xr.DataArray(hit.astype(int), dims="run"))
        assert_allclose(found["median"].sel(measure=name), own["median"], rtol=1e-9)
        assert_allclose(found["dispersion"].sel(measure=name), own["dispersion"], rtol=1e-9)


def test_the_pair_that_decides_has_its_exponent_and_dispersion(found):
    pair = found.sel(measure="x", other="z")
    assert float(pair["pair_exponent"]) == pytest.approx(0.5, abs=0.08)
    assert float(pair["pair_dispersion"]) == pytest.approx(0.3, abs=0.04)
    turned = found.sel(measure="z", other="x")
    assert float(turned["pair_exponent"]) == pytest.approx(1.0 / float(pair["pair_exponent"]), rel=1e-6)


def test_a_pair_has_the_likelihood_of_another_optimisation(runs, found):
    measures, hit = runs
    design = np.column_stack([np.ones(N), np.log(measures["x"]), np.log(measures["z"])])

    def unlikely(theta):
        return -np.sum(norm.logcdf(np.where(hit, 1.0, -1.0) * (design @ theta)))

    other = minimize(
        unlikely, np.zeros(3), method="Nelder-Mead", options={"xatol": 1e-9, "fatol": 1e-9, "maxiter": 9000}
    )
    assert float(found["pair_log_likelihood"].sel(measure="x", other="z")) == pytest.approx(-other.fun, abs=1e-5)


def test_the_better_measure_is_more_likely_and_sufficient_for_the_worse_one(found):
    likelihood = found["log_likelihood"]
    assert float(likelihood.sel(measure="x")) > float(likelihood.sel(measure="y")) > found.attrs["unknown"]
    p = found["p_value"]
    assert float(p.sel(measure="x", other="z")) < 1e-6  # z adds to x
    assert float(p.sel(measure="y", other="x")) < 1e-6  # x adds to y, which is x with noise
    assert float(p.sel(measure="x", other="w")) > 0.001  # w adds nothing


def test_p_values_of_a_measure_that_adds_nothing_are_uniform():
    rng = np.random.default_rng(11)
    values = []
    for _ in range(200):
        x, w = np.exp(rng.normal(size=(2, 150)))
        hit = np.log(x) + 0.5 * rng.normal(size=150) > 0.0
        values.append(float(compare_intensities({"x": x, "w": w}, hit)["p_value"].sel(measure="x", other="w")))
    assert 0.02 < np.mean(np.array(values) < 0.05) < 0.1
    assert 0.4 < np.median(values) < 0.6


def test_p_values_stay_uniform_where_runs_of_a_record_depend_on_each_other():
    rng = np.random.default_rng(12)
    values = []
    for _ in range(100):
        record = np.repeat(np.arange(50), 6)
        x, w = np.exp(rng.normal(size=(2, 50)))[:, record] * np.exp(0.1 * rng.normal(size=(2, 300)))
        hit = np.log(x) + 1.0 * rng.normal(size=50)[record] + 0.3 * rng.normal(size=300) > 0.0
        values.append(
            float(compare_intensities({"x": x, "w": w}, hit, record=record)["p_value"].sel(measure="x", other="w"))
        )
    assert np.mean(np.array(values) < 0.05) < 0.15  # 0.4 if runs were taken as independent


def test_a_p_value_is_that_of_statsmodels_with_groups(runs):
    import statsmodels.api as sm

    measures, hit = runs
    record = np.arange(N) // 30
    found = compare_intensities(measures, hit, record=record)["p_value"].sel(measure="x", other="w")
    design = sm.add_constant(np.log(np.column_stack([measures["x"], measures["w"]])))
    groups = {"groups": record, "use_correction": False}
    fit = sm.Probit(hit.astype(float), design).fit(disp=0, cov_type="cluster", cov_kwds=groups)
    count = record.max() + 1
    assert float(found) == pytest.approx(2.0 * norm.sf(abs(fit.tvalues[2]) * np.sqrt((count - 1) / count)), rel=1e-5)


def test_records_that_are_not_monotonic_are_counted():
    x = np.array([1.0, 2.0, 3.0, 1.0, 2.0, 3.0])
    hit = [0, 1, 0, 0, 1, 1]
    assert int(compare_intensities({"x": x}, hit, record=["a"] * 3 + ["b"] * 3)["reversed"][0]) == 1
    assert int(compare_intensities({"x": x}, hit, record=["a", "a", "c", "b", "b", "b"])["reversed"][0]) == 0


def test_runs_of_an_incremental_analysis_are_compared_by_their_dimensions():
    model = sb.Slender(sb.Column.solid(radius=0.2, height=2.0, density=2700.0), damping=0.02)
    record = sb.sample_record()
    records = {"as it is": record, "slower": sb.Record(samples=record.samples, step=1.5 * record.step)}
    scales = np.geomspace(0.3, 4.0, 10)
    runs = sb.earthquakes.incremental_dynamic_analysis(model, records, scales=scales, progress=False)
    reached = runs["reached"].sel(limit_state="overturning", drop=True)
    measures = sb.records.intensity_table(records.values(), scales=scales)[["pga", "pgv"]]
    named = measures.assign_coords(record=list(records))
    found = compare_intensities(named, reached)
    flat = compare_intensities(
        {name: measures[name].to_numpy().ravel() for name in measures},
        reached.transpose("record", "scale").to_numpy().ravel(),
        record=np.repeat([0, 1], len(scales)),
    )
    xr.testing.assert_allclose(found.drop_vars("status"), flat.drop_vars("status"))
    assert found.attrs["records"] == 2
    assert found.attrs["runs"] == int((reached >= 0).sum())


def test_undecided_runs_are_left_out():
    x = np.array([1.0, 2.0, 3.0, 4.0, 5.0])
    with_unknown = compare_intensities({"x": x}, [0, 1, -1, 0, 1])
    without = compare_intensities({"x": x[[0, 1, 3, 4]]}, [0, 1, 0, 1])
    assert with_unknown.attrs["runs"] == 4
    assert_allclose(with_unknown["log_likelihood"], without["log_likelihood"])


def test_a_measure_that_falls_where_more_runs_reach_the_state_knows_nothing():
    x = np.arange(1.0, 41.0)
    found = compare_intensities({"x": 1.0 / x}, x + 9.0 * np.sin(7.0 * x) > 20.0)
    assert found["status"].item() == "NOT_INCREASING"
    assert found["log_likelihood"].item() == pytest.approx(found.attrs["unknown"])


def test_a_pair_that_separates_the_runs_has_no_exponent():
    x, z = np.exp([0.0, 1.0, 2.0, 3.0]), np.exp([3.0, 0.0, 3.0, 0.0])
    found = compare_intensities({"x": x, "z": z}, [1, 0, 1, 0]).sel(measure="x", other="z")
    assert np.isnan(float(found["pair_exponent"]))
    assert float(found["pair_log_likelihood"]) == pytest.approx(0.0, abs=2e-3)


@pytest.mark.parametrize(
    ("measures", "reached", "message"),
    [
        ({}, [0, 1], "measures: must have one measure"),
        ({"x": [1.0, 2.0, 3.0]}, [0, 1], "x: must have one value for each of 2 runs"),
        ({"x": [1.0, 0.0]}, [0, 1], "x: must be finite and above 0"),
        ({"x": [1.0, 2.0]}, [1, 1], "reached: must have runs that reached"),
    ],
)
def test_what_cannot_be_compared_is_refused(measures, reached, message):
    with pytest.raises(sb.errors.ParameterError, match=message):
        compare_intensities(measures, reached)
