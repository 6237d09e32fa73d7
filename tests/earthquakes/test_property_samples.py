"""Property samples have the medians and spreads they are drawn with."""

import numpy as np
import pytest
from scipy import stats

import stylobate as sb
from stylobate.earthquakes import LognormalSpread, NormalSpread, UniformSpread, property_samples

MODEL = sb.Slender(sb.Column.solid(radius=0.4, height=4.0, density=2700.0), damping=0.05)
SPREADS = {
    "damping": LognormalSpread(0.4),
    "size": NormalSpread(0.02),
    "slenderness": UniformSpread(0.18, 0.22),
}


def test_samples_have_the_distributions_asked_for():
    drawn = property_samples(MODEL, SPREADS, count=4000, rng=np.random.default_rng(0))
    expected = {
        "damping": stats.lognorm(0.4, scale=0.05),
        "size": stats.norm(1.0, 0.02),
        "slenderness": stats.uniform(0.18, 0.04),
    }
    for name, distribution in expected.items():
        assert stats.kstest(drawn[name], distribution.cdf).pvalue > 0.01
    assert np.abs(np.corrcoef(list(drawn.values())) - np.eye(3)).max() < 4.0 / np.sqrt(4000)
    # median and dispersion, within three standard errors
    assert abs(np.log(np.median(drawn["damping"]) / 0.05)) < 3.0 * 1.2533 * 0.4 / np.sqrt(4000)
    assert abs(np.log(drawn["damping"]).std() - 0.4) < 3.0 * 0.4 / np.sqrt(8000)


def test_a_seed_gives_the_same_samples_and_the_first_of_a_longer_series():
    short = property_samples(MODEL, SPREADS, count=3, rng=np.random.default_rng(7))
    long = property_samples(MODEL, SPREADS, count=10, rng=np.random.default_rng(7))
    for name in SPREADS:
        np.testing.assert_array_equal(short[name], long[name][:3])


def test_a_normal_spread_stays_within_its_bounds():
    tight = NormalSpread(0.1, mean=0.05, least=0.0, most=0.2)
    drawn = property_samples(MODEL, {"damping": tight}, count=2000, rng=np.random.default_rng(0))["damping"]
    assert drawn.min() >= 0.0
    assert drawn.max() <= 0.2
    cut = stats.truncnorm(-0.5, 1.5, loc=0.05, scale=0.1)
    assert stats.kstest(drawn, cut.cdf).pvalue > 0.01


@pytest.mark.parametrize(
    ("spreads", "message"),
    [
        ({}, "spreads must name properties"),
        ({"colour": LognormalSpread(0.1)}, "spreads: colour is not known here"),
        ({"scale": LognormalSpread(0.1)}, "spreads cannot name scale: it belongs to the base motion"),
        ({"slenderness": LognormalSpread(0.1), "radius": LognormalSpread(0.1)}, "slenderness changes the radius"),
        ({"damping": 0.4}, r"spreads\['damping'\] must be a spread"),
    ],
)
def test_mistakes_are_told(spreads, message):
    with pytest.raises(sb.errors.ParameterError, match=message):
        property_samples(MODEL, spreads, count=3, rng=np.random.default_rng(0))
