"""Draws with weights: integrals over distributions of an object's numbers."""

import numpy as np
import pytest
from scipy.special import ndtr
from scipy.stats import truncnorm

from stylobate.earthquakes.weighted_draws import Draws, Mixture, r_hat

THRESHOLDS = np.linspace(0.05, 0.95, 10)
NARROW = Mixture(np.array([[0.3], [0.6]]), np.array([[0.05], [0.2]]))


def drawn(*mixtures, number=4096):
    """Return draws of mixtures whose object falls where its number is below the threshold of a test."""
    places = np.concatenate([one.draws(number, np.random.default_rng(1)) for one in mixtures])
    density = np.mean([one.density(places) for one in mixtures], axis=0)
    return Draws(places, density, (places < THRESHOLDS).astype(float))


@pytest.mark.parametrize(
    ("mixtures", "error"),
    [((Mixture.even(1),), 2e-3), ((NARROW,), 1e-2), ((Mixture.even(1), NARROW), 2e-3)],
    ids=["even", "where it matters", "both"],
)
def test_probabilities_are_integrals_of_truncated_normal_distributions(mixtures, error):
    found = drawn(*mixtures)
    for mean, spread, lapse in ((0.5, 0.1, 0.0), (0.35, 0.2, 0.1), (0.9, 0.3, 0.02)):
        low, high = (-mean) / spread, (1.0 - mean) / spread
        exact = 0.5 * lapse + (1.0 - lapse) * truncnorm.cdf(THRESHOLDS, low, high, loc=mean, scale=spread)
        np.testing.assert_allclose(found.probabilities(np.array([[mean, spread, lapse]]))[0], exact, atol=error)


def test_densities_are_those_of_the_draws():
    rng = np.random.default_rng(3)
    mixture = Mixture(rng.random((5, 2)), 0.05 + 0.3 * rng.random((5, 2)))
    places = np.linspace(0.0, 1.0, 401)
    middle = 0.5 * (places[1:] + places[:-1])
    grid = np.stack(np.meshgrid(middle, middle, indexing="ij"), axis=-1).reshape(-1, 2)
    density = mixture.density(grid).reshape(400, 400)
    assert density.mean() == pytest.approx(1.0, abs=1e-4)
    own = mixture.draws(4095, rng)
    shares = np.histogramdd(own, bins=[[0.0, 0.5, 1.0]] * 2)[0] / len(own)
    np.testing.assert_allclose(shares, density.reshape(2, 200, 2, 200).mean(axis=(1, 3)) / 4.0, atol=5e-3)


def test_draws_of_equal_weight_count_as_themselves():
    found = drawn(Mixture.even(1), number=256)
    assert found.effective(np.array([[0.5, 1e4, 0.1]]))[0] == pytest.approx(256.0)
    assert found.effective(np.array([[0.5, 0.02, 0.1]]))[0] == pytest.approx(
        256 * 0.02 * 2.0 * np.sqrt(np.pi), rel=0.05
    )


def test_states_that_few_draws_know_are_not_believed():
    found = drawn(Mixture.even(1), number=64)
    overturned = THRESHOLDS > 0.5
    wide, narrow, outside = found.log_likelihood(
        np.array([[0.5, 0.2, 0.05], [0.5, 0.03, 0.05], [1.2, 0.2, 0.05]]), overturned
    )
    assert np.isfinite(wide)
    assert narrow == outside == -np.inf


def test_the_posterior_is_that_of_a_grid():
    found = drawn(Mixture.even(1), number=2048)
    overturned = THRESHOLDS > 0.42
    chains = found.posterior(overturned, 2000, np.random.default_rng(2))
    assert r_hat(chains).max() < 1.05
    mean, spread, lapse = np.meshgrid(
        np.linspace(0.005, 0.995, 100), np.geomspace(0.0204, 0.98, 40), np.linspace(0.005, 0.495, 50), indexing="ij"
    )
    states = np.stack([mean.ravel(), spread.ravel(), lapse.ravel()], axis=1)
    inside = [
        (ndtr((t - states[:, 0]) / states[:, 1]) - ndtr(-states[:, 0] / states[:, 1])) for t in (*THRESHOLDS, 1.0)
    ]
    share = np.array(inside[:-1]) / inside[-1]
    p = 0.5 * states[:, 2] + (1.0 - states[:, 2]) * share
    weight = np.prod(np.where(overturned[:, np.newaxis], p, 1.0 - p), axis=0)
    sampled = chains.reshape(-1, 3)
    for column, function in ((0, float), (1, np.log), (2, float)):
        exact = np.average(
            np.array([function(value) for value in np.unique(states[:, column])])[
                np.unique(states[:, column], return_inverse=True)[1]
            ],
            weights=weight,
        )
        values = np.array([function(value) for value in sampled[:, column]])
        assert values.mean() == pytest.approx(exact, abs=0.12 * values.std())


def test_chains_that_have_not_met_are_seen():
    rng = np.random.default_rng(4)
    same = rng.normal(size=(6, 200, 2))
    assert r_hat(same).max() < 1.03
    assert r_hat(same + np.arange(6)[:, np.newaxis, np.newaxis]).min() > 1.5
