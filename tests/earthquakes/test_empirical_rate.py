"""Annual rates counted from runs: hand integration, the lognormal limit, survivals above an overturning, bounds."""

import itertools
import math

import numpy as np
import pytest
import xarray as xr
from scipy.integrate import quad

import stylobate as sb
from stylobate.earthquakes import HazardCurve, annual_rate, empirical_rate, lognormal_fragility
from stylobate.earthquakes.fragility.empirical_rate import compared_with_target
from stylobate.errors import ParameterError

CURVE = HazardCurve(intensity=[0.05, 0.2, 1.0, 5.0], rate=[3e-2, 6e-3, 2.5e-4, 2e-6])
LEVELS = np.geomspace(0.3, 4.0, 9)


def by_hand(levels, reached, hazard):
    """Integrate the states of one record over the hazard by quadrature, each run up to half-way to its neighbours."""
    edges = [levels[0], *np.sqrt(levels[1:] * levels[:-1]), np.inf]
    points, rates, slopes = (np.asarray(one) for one in (hazard.intensity, hazard.rate, hazard.slopes))

    def density(x):
        piece = int(np.clip(np.searchsorted(points, x) - 1, 0, slopes.size - 1))
        return slopes[piece] * rates[piece] * (x / points[piece]) ** (-slopes[piece]) / x

    total = 0.0
    for low, high, hit in zip(edges[:-1], edges[1:], reached, strict=True):
        cuts = [low, *points[(points > low) & (points < high)], high]
        for a, b in itertools.pairwise(cuts):
            total += hit * quad(density, a, b, epsabs=0.0, epsrel=1e-13, limit=200)[0]
    return total


@pytest.mark.parametrize("seed", range(4))
def test_the_rate_is_that_of_an_integration_by_hand(seed):
    rng = np.random.default_rng(seed)
    reached = rng.random((5, LEVELS.size)) < 0.5
    record = np.repeat(np.arange(5), LEVELS.size).reshape(reached.shape)
    found = empirical_rate(np.broadcast_to(LEVELS, reached.shape), reached, CURVE, record=record, resamples=0)
    expected = [by_hand(LEVELS, state, CURVE) for state in reached]
    np.testing.assert_allclose(found["record_rate"][0], expected, rtol=1e-10)
    assert found["annual_rate"].item() == pytest.approx(np.mean(expected), rel=1e-10)
    assert found["probability"].item() == pytest.approx(-math.expm1(-50.0 * np.mean(expected)), rel=1e-10)


def test_contributions_are_integrals_over_their_bins_and_sum_to_the_rate():
    rng = np.random.default_rng(11)
    reached = rng.random((3, LEVELS.size)) < 0.5
    record = np.repeat(np.arange(3), LEVELS.size).reshape(reached.shape)
    found = empirical_rate(np.broadcast_to(LEVELS, reached.shape), reached, CURVE, record=record, resamples=0, bins=7)
    within, above = found["contribution"][0].to_numpy(), found["rate_above"].item()
    assert within.sum() + above == pytest.approx(found["annual_rate"].item(), rel=1e-12)
    assert found["bin_from"][0] == pytest.approx(LEVELS[0])
    assert found["bin_to"][-1] == pytest.approx(LEVELS[-1])
    last = CURVE.at(LEVELS[-1:])[0]  # above the last intensity a record stays as it is there
    assert above == pytest.approx(reached[:, -1].mean() * last, rel=1e-10)
    edges = np.sqrt(LEVELS[1:] * LEVELS[:-1])
    fine = np.geomspace(LEVELS[0], LEVELS[-1], 200_001)
    hit = reached[:, np.searchsorted(edges, np.sqrt(fine[1:] * fine[:-1]))].mean(axis=0)
    summed, _ = np.histogram(fine[:-1], [*found["bin_from"], np.inf], weights=hit * -np.diff(CURVE.at(fine)))
    # Of 200 000 steps one beside each of the edges may be on its wrong side.
    np.testing.assert_allclose(within, summed, rtol=0.0, atol=1e-4 * within.sum())


def test_the_figure_draws_shares_of_the_rate_whose_area_is_what_lies_within_the_runs():
    reached = np.array([[0, 0, 0, 1, 1, 0, 1, 1, 1], [0, 0, 0, 0, 0, 0, 0, 1, 1]])
    record = np.repeat(np.arange(2), LEVELS.size).reshape(reached.shape)
    found = empirical_rate(np.broadcast_to(LEVELS, reached.shape), reached, CURVE, record=record, resamples=0)
    (steps,) = sb.plot(found).axes[1].patches
    heights, edges, _ = steps.get_data()
    within = 1.0 - found["rate_above"].item() / found["annual_rate"].item()
    assert np.sum(heights * np.diff(np.log(edges))) == pytest.approx(within, rel=1e-12)


def test_many_lognormal_records_give_the_rate_of_the_lognormal_curve():
    rng, levels, median, dispersion = np.random.default_rng(3), np.geomspace(0.05, 20.0, 400), 1.1, 0.45
    capacities = median * np.exp(dispersion * rng.standard_normal(3000))
    reached = levels >= capacities[:, np.newaxis]
    record = np.repeat(np.arange(3000), levels.size).reshape(reached.shape)
    found = empirical_rate(
        np.broadcast_to(levels, reached.shape), reached, CURVE, record=record, resamples=200, rng=rng
    )
    expected = annual_rate(lognormal_fragility(median, dispersion), CURVE)["annual_rate"].item()
    low, high = found["rate_low"].item(), found["rate_high"].item()
    assert low < expected < high  # 3000 records: the interval is a few percent wide
    assert high / low < 1.25


def test_survival_above_an_overturning_counts_and_scales_and_samples_share_their_record():
    reached = np.array([[0, 1, 0, 0], [0, 0, 0, 1], [0, 0, 0, 0]])
    levels = xr.DataArray(np.tile(LEVELS[:4], (3, 1)), dims=("record", "scale"), coords={"record": ["a", "b", "c"]})
    states = xr.DataArray(reached, dims=("record", "scale"), coords={"record": ["a", "b", "c"]})
    found = empirical_rate(levels, states, CURVE, resamples=100, rng=np.random.default_rng(1))
    first = CURVE.at(math.sqrt(LEVELS[0] * LEVELS[1])) - CURVE.at(math.sqrt(LEVELS[1] * LEVELS[2]))
    second = CURVE.at(math.sqrt(LEVELS[2] * LEVELS[3]))
    np.testing.assert_allclose(found["record_rate"][0], [first, second, 0.0], rtol=1e-12)
    last = float(CURVE.at(LEVELS[3]))
    assert found["rate_least"].item() == pytest.approx((first + second - last) / 3.0)
    assert found["rate_most"].item() == pytest.approx((first + second + 2.0 * last) / 3.0)
    assert found["rate_low"].item() <= found["annual_rate"].item() <= found["rate_high"].item()
    twice = xr.concat([states, 0 * states], dim=xr.Variable("property_sample", [0, 1]))
    halved = empirical_rate(levels, twice, CURVE, property_sample=twice["property_sample"], resamples=0)
    assert halved["annual_rate"].item() == pytest.approx(0.5 * found["annual_rate"].item())


def test_what_is_not_known_is_left_out_and_a_fall_at_once_has_no_upper_bound():
    reached = np.array([-1, 0, 1, -1, 1])
    whole = empirical_rate(LEVELS[:5], reached, CURVE, record=np.zeros(5), resamples=0)
    known = empirical_rate(LEVELS[[1, 2, 4]], reached[[1, 2, 4]], CURVE, record=np.zeros(3), resamples=0)
    assert whole["annual_rate"].item() == known["annual_rate"].item()
    assert math.isnan(whole["rate_low"].item())
    at_once = empirical_rate(LEVELS, LEVELS > 0.0, CURVE, record=np.zeros(9), resamples=0)
    assert at_once["annual_rate"].item() == pytest.approx(float(CURVE.at(LEVELS[0])))
    assert math.isinf(at_once["rate_most"].item())


def test_a_record_of_which_no_run_is_known_is_left_out():
    levels = np.tile(LEVELS[:3], (3, 1))
    states = np.array([[0, 1, 1], [-1, -1, -1], [0, 0, 1]])
    record = np.repeat(["a", "b", "c"], 3).reshape(3, 3)
    found = empirical_rate(levels, states, CURVE, record=record, resamples=50, rng=np.random.default_rng(0))
    known = [0, 2]
    own = empirical_rate(
        levels[known], states[known], CURVE, record=record[known], resamples=50, rng=np.random.default_rng(0)
    )
    for name in ("annual_rate", "rate_low", "rate_high", "rate_least", "rate_most"):
        assert found[name].item() == own[name].item()
    assert math.isnan(found["record_rate"].sel(record="b").item())
    none = empirical_rate(levels[1], states[1], CURVE, record=record[1], resamples=50, rng=np.random.default_rng(0))
    assert all(math.isnan(none[name].item()) for name in ("annual_rate", "rate_low", "rate_high", "probability"))


def test_mistakes_are_one_line():
    arguments = (LEVELS, LEVELS > 1.0, CURVE)
    with pytest.raises(ParameterError, match=r"^record: missing\. Name the record of each run"):
        empirical_rate(*arguments)
    with pytest.raises(ParameterError, match=r"^rng: missing, needed for resamples=1000"):
        empirical_rate(*arguments, record=np.repeat([0, 1, 2], 3))
    other = HazardCurve(intensity=[0.1, 1.0], rate=[1e-2, 1e-4], units="m s-2")
    with pytest.raises(ParameterError, match="hazard must have the unit of the fragility, '1', got 'm s-2'"):
        empirical_rate(LEVELS, LEVELS > 1.0, other, record=np.zeros(9))


def test_a_rate_is_compared_with_its_target_by_its_interval():
    def said(rate, low, high, target=1e-4):
        return compared_with_target(rate, low, high, target)

    assert said(1e-5, 5e-6, 5e-5) == "below the target of 1.0e-04 per year"
    assert said(1e-3, 5e-4, 5e-3) == "above the target of 1.0e-04 per year"
    assert said(1e-4, 5e-5, 5e-4) == "not decided: the target of 1.0e-04 per year lies in the interval. Add records"
    assert said(1e-5, math.nan, math.nan) == "below the target of 1.0e-04 per year, without an interval"
