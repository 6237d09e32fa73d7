"""Annual rates: fragility and hazard brought together."""

import logging
import math

import numpy as np
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.special import ndtr

import stylobate as sb
from stylobate.base_motions.base import ACCELERATION
from stylobate.earthquakes import HazardCurve, annual_rate, fit_fragility, lognormal_fragility
from stylobate.errors import ParameterError
from stylobate.records.intensities import HorizontalComponent, horizontal_peak

BENT = HazardCurve(intensity=[0.2, 1.0, 3.0, 5.0, 20.0], rate=[0.2, 2e-2, 3e-3, 6e-4, 2e-6])


@given(
    median=st.floats(0.05, 50.0),
    beta=st.floats(0.05, 1.0),
    slope=st.floats(0.5, 8.0),
    points=st.integers(2, 20),
)
def test_under_a_power_law_the_rate_is_that_of_cornell_and_others(median, beta, slope, points):
    intensity = np.geomspace(0.1, 10.0, points)
    hazard = HazardCurve(intensity=intensity, rate=1e-3 * intensity**-slope)
    found = annual_rate(lognormal_fragility(median, beta), hazard)
    exact = 1e-3 * median**-slope * np.exp(0.5 * (slope * beta) ** 2)
    # λ(0.1) is the largest number in sums that are as small as the rate.
    rounding = 1e-14 * 1e-3 * 0.1**-slope
    # Above the curve the rate is at most that of exceeding its end, below it the power law is continued.
    assert found["annual_rate"].item() == pytest.approx(exact, rel=1e-9, abs=rounding)


@pytest.mark.parametrize(("median", "beta"), [(0.5, 0.3), (4.0, 0.4), (15.0, 0.6)])
def test_the_rate_within_a_bent_curve_is_its_integral(median, beta):
    found = annual_rate(lognormal_fragility(median, beta), BENT)
    knots, slopes = BENT.log_intensity, BENT.slopes
    total = 0.0
    for a, b, k in zip(knots[:-1], knots[1:], slopes, strict=True):
        total += quad(
            lambda u, k=k: ndtr((u - np.log(median)) / beta) * k * float(BENT.at(np.exp(u))), a, b, epsrel=1e-11
        )[0]
    assert found["rate_within"].item() == pytest.approx(total, rel=1e-9)


@pytest.mark.parametrize("bins", [1, 7, 40])
def test_contributions_add_up_to_the_rate_within(bins):
    found = annual_rate(lognormal_fragility(3.0, 0.4), BENT, bins=bins)
    assert found["contribution"].sum().item() == pytest.approx(found["rate_within"].item(), rel=1e-12)
    assert np.all(found["contribution"] >= 0.0)
    assert found.sizes["bin"] == bins


@pytest.mark.parametrize("median", [0.3, 3.0, 30.0])
def test_a_curve_cut_short_bounds_what_the_longer_one_gives(median):
    longer = annual_rate(lognormal_fragility(median, 0.5), BENT)
    middle = slice(1, -1)
    short = HazardCurve(intensity=BENT.intensity[middle], rate=BENT.rate[middle])
    cut = annual_rate(lognormal_fragility(median, 0.5), short)
    # The curve is concave on logarithmic axes, as the bounds take it to be.
    assert np.all(np.diff(BENT.slopes) > 0.0)
    assert cut["rate_low"].item() <= longer["rate_low"].item()
    assert longer["rate_high"].item() <= cut["rate_high"].item() * (1.0 + 1e-12)
    for found in (longer, cut):
        assert found["rate_low"].item() <= found["annual_rate"].item() <= found["rate_high"].item()


def test_a_rate_mostly_from_beyond_the_curve_is_warned_of(caplog):
    with caplog.at_level(logging.WARNING, logger="stylobate"):
        found = annual_rate(lognormal_fragility(40.0, 0.3, name="overturning"), BENT)
    assert found["share_beyond"].item() > 0.9
    assert "of the annual rate of 'overturning' lies beyond the hazard curve" in caplog.text


@pytest.mark.parametrize(
    ("median", "reason"),
    [
        (3.0, ""),
        (200.0, "the hazard curve ends at 20, and all of the rate lies beyond"),
        (0.02, "the hazard curve begins at 0.2, and 97 % of the rate lies beyond"),
    ],
)
def test_a_rate_that_lies_mostly_beyond_the_curve_is_withheld(median, reason):
    found = annual_rate(lognormal_fragility(median, 0.3), BENT)
    assert found["withheld_reason"].item() == reason
    assert (found["share_beyond"].item() > 0.5) is bool(reason)


def test_a_steep_curve_continued_too_far_is_told_to_be_infinite():
    steep = HazardCurve(intensity=[1.0, 1.1, 2.0], rate=[0.1, 1e-6, 1e-9])
    found = annual_rate(lognormal_fragility(1.5, 3.0), steep)
    assert found["rate_high"].item() == np.inf
    assert found["share_beyond"].item() == 1.0
    assert 0.0 < found["rate_low"].item() < 0.1


def test_a_sure_step_is_reached_as_often_as_its_intensity_is_exceeded():
    found = annual_rate(lognormal_fragility(4.0, 1e-6), BENT)
    assert found["annual_rate"].item() == pytest.approx(float(BENT.at(4.0)), rel=1e-9)


def test_the_probability_is_that_of_a_poisson_process():
    found = annual_rate(lognormal_fragility(3.0, 0.4), BENT, years=50.0)
    assert found["probability"].item() == pytest.approx(1.0 - np.exp(-50.0 * found["annual_rate"].item()), rel=1e-12)


def test_one_limit_state_that_is_selected_has_its_rate():
    fits = lognormal_fragility(2.0, 0.3)
    (name,) = fits["limit_state"].values
    one = annual_rate(fits.sel(limit_state=name), BENT)
    assert one["limit_state"].values.tolist() == [name]
    assert one["annual_rate"].item() == annual_rate(fits, BENT)["annual_rate"].item()


def test_a_limit_state_without_a_fit_has_no_rate():
    found = annual_rate(fit_fragility([1.0, 2.0], [0, 0]), BENT)
    assert np.isnan(found["annual_rate"].item())
    assert np.isnan(found["contribution"]).all()


@pytest.mark.parametrize(
    ("intensity", "rate", "message"),
    [
        ("abc", [0.1, 0.2], "intensity must be a list of two or more numbers, got 'abc'"),
        ([1.0], [0.1], "intensity must be a list of two or more numbers"),
        ([1.0, 2.0], [0.1], "rate must be a list of two or more numbers"),
        ([1.0, 2.0], [0.1, 0.05, 0.01], "rate must have one number for each intensity, got 3 for 2"),
        ([2.0, 1.0, 2.0], [0.1, 0.05, 0.1], "intensity must hold different values, got 2.0 twice"),
        ([2.0, 1.0], [0.1, 0.05], "rate must not increase with intensity, got 0.1 at 2.0 after 0.05 at 1.0"),
        ([1.0, 2.0], [0.1, 0.2], "rate must not increase with intensity, got 0.2"),
        ([1.0, 2.0], [0.1, 0.0], "rate must be positive and finite, got 0.0"),
    ],
)
def test_points_that_are_no_hazard_curve_are_refused(intensity, rate, message):
    with pytest.raises(ParameterError, match=message):
        HazardCurve(intensity=intensity, rate=rate)


@pytest.mark.parametrize(
    ("arguments", "options", "message"),
    [
        ((BENT, BENT), {}, "fragility must come from fit_fragility"),
        ((lognormal_fragility(1.0, 0.4), 3.0), {}, "hazard must be a HazardCurve, got float"),
        ((lognormal_fragility(1.0, 0.4, units="m s-2"), BENT), {}, "'m s-2', got '1'; convert"),
        ((lognormal_fragility(1.0, 0.4), BENT), {"years": 0.0}, "years must be positive"),
        ((lognormal_fragility(1.0, 0.4), BENT), {"bins": 0}, "bins must be a whole number of at least 1"),
    ],
)
def test_mistakes_are_told(arguments, options, message):
    with pytest.raises(ParameterError, match=message):
        annual_rate(*arguments, **options)


def test_probabilities_of_exceedance_are_rates_of_a_poisson_process():
    rate = np.array([2e-2, 1e-3, 4e-5])
    for years in (1.0, 50.0, 475.0):
        curve = HazardCurve.of_probabilities([1.0, 3.0, 9.0], 1.0 - np.exp(-rate * years), investigation_time=years)
        np.testing.assert_allclose(curve.rate, rate, rtol=1e-10)
        assert f"in {years:g} years" in curve.origin
    # 0.63, 0.33, 0.1 and 0.02 in 50 years, taken for annual rates, are too large by fifty times and more.
    fragility = lognormal_fragility(4.0, 0.4)
    intensity, probability = [0.5, 1.0, 4.0, 9.0], [0.63, 0.33, 0.1, 0.02]
    right = annual_rate(fragility, HazardCurve.of_probabilities(intensity, probability, investigation_time=50.0))
    wrong = annual_rate(fragility, HazardCurve(intensity=intensity, rate=probability))
    assert float(wrong["annual_rate"][0]) > 40.0 * float(right["annual_rate"][0])
    assert "50 years" in right.attrs["hazard_origin"]


def test_points_of_probability_0_or_1_are_left_out_and_others_beyond_are_refused():
    curve = HazardCurve.of_probabilities([0.1, 1.0, 3.0, 9.0], [1.0, 0.5, 0.1, 0.0], investigation_time=50.0)
    assert curve.intensity == (1.0, 3.0)
    with pytest.raises(ParameterError, match=r"probability must be between 0 and 1, got 63\.0; divide"):
        HazardCurve.of_probabilities([1.0, 3.0], [63.0, 10.0], investigation_time=50.0)
    with pytest.raises(ParameterError, match="probability must have one number for each intensity, got 2 for 3"):
        HazardCurve.of_probabilities([1.0, 3.0, 4.0], [0.1, 0.2], investigation_time=50.0)
    with pytest.raises(ParameterError, match="investigation_time must be positive"):
        HazardCurve.of_probabilities([1.0, 3.0], [0.2, 0.1], investigation_time=0.0)


@pytest.mark.parametrize(
    ("fragility", "hazard", "message"),
    [
        (
            "RotD50",
            "geometric mean",
            r"hazard: horizontal component 'geometric mean', but the fragility uses 'RotD50'\. Fit",
        ),
        ("RotD50", None, r"hazard: horizontal component not stated, but the fragility uses 'RotD50'\. State"),
        (None, "RotD50", r"fragility: horizontal component not stated, but the hazard uses 'RotD50'\. State"),
    ],
)
def test_fragility_and_hazard_must_state_one_horizontal_component(fragility, hazard, message):
    curve = {"intensity": [1.0, 10.0], "rate": [1e-2, 1e-4]}
    with pytest.raises(ParameterError, match=message):
        annual_rate(lognormal_fragility(3.0, 0.4, component=fragility), HazardCurve(**curve, component=hazard))
    for same in (fragility, hazard):
        found = annual_rate(lognormal_fragility(3.0, 0.4, component=same), HazardCurve(**curve, component=same))
        assert found["hazard_intensity"].attrs.get("component") == same
        assert found["hazard_intensity"].attrs["long_name"] == ("intensity" if same is None else f"intensity, {same}")


def test_a_fragility_over_the_vector_underestimates_the_rate_of_a_hazard_in_rotd50():
    # One hazard, of RotD50. A column whose capacity is a scale of each record, whatever measures the record.
    rng = np.random.default_rng(2)
    records = [sb.Record(samples=rng.normal(size=(200, 2)) * (1.0, 0.7), step=0.02, name=f"{k}") for k in range(40)]
    scale = xr.DataArray(np.geomspace(0.3, 3.0, 15), dims="scale")
    capacity = xr.DataArray(np.exp(rng.normal(0.0, 0.4, 40)), dims="record")
    rates, medians = {}, {}
    for name in ("RotD50", "RotD100", "geometric mean"):
        peaks = [horizontal_peak(record, ACCELERATION, HorizontalComponent.named(name)) for record in records]
        intensity = (xr.DataArray(peaks, dims="record") * scale).assign_attrs(units="m s-2", component=name)
        fits = fit_fragility(intensity, scale > capacity)
        hazard = HazardCurve(intensity=[0.5, 5.0], rate=[1e-1, 1e-4], units="m s-2", component=name)
        rates[name], medians[name] = float(annual_rate(fits, hazard)["annual_rate"][0]), float(fits["median"][0])
        assert fits["median"].attrs["component"] == name
    assert medians["geometric mean"] < medians["RotD50"] * 1.05
    assert 1.05 * medians["RotD50"] < medians["RotD100"] < math.sqrt(2.0) * medians["RotD50"]
    # λ ~ x⁻³: rates differ by about the cube of the ratio of the medians.
    assert rates["RotD100"] < rates["RotD50"] / 1.05**3


def test_a_hazard_curve_keeps_its_numbers():
    intensity = np.array([1.0, 2.0])
    curve = HazardCurve(intensity=intensity, rate=[0.1, 0.05])
    intensity[0] = 5.0
    assert curve == HazardCurve(intensity=[1.0, 2.0], rate=[0.1, 0.05])
