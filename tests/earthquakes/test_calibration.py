"""Numbers of an object learnt from tests in which it stood or fell."""

import warnings

import numpy as np
import pytest

import stylobate as sb
from stylobate.earthquakes.calibration import calibrate, reliability, scores

pytestmark = pytest.mark.long

BLOCK = sb.PlanarRocking.block(width=0.4, height=2.4, density=2700.0)
RANGES = {"slenderness": (0.08, 0.3), "restitution": (0.7, 1.0)}
PULSES = [
    sb.Pulse.one_sine(acceleration=acceleration, angular_frequency=2.0 * np.pi / duration)
    for duration in (0.4, 0.8, 1.6)
    for acceleration in np.linspace(1.0, 8.0, 20)
]


@pytest.fixture(scope="module")
def known():
    """Outcomes of tests of a block whose slenderness and restitution differ a little from test to test."""
    rng = np.random.default_rng(5)
    fell = []
    for pulse in PULSES:
        numbers = {"slenderness": rng.normal(0.167, 0.008), "restitution": min(rng.normal(0.9, 0.02), 1.0)}
        model, moved = sb.with_parameters(BLOCK, pulse, **numbers)
        fell.append(sb.simulate(model, moved, duration=pulse.duration + 4.0).outcome is sb.Outcome.OVERTURNED)
    return np.array(fell)


@pytest.fixture(scope="module")
def learnt(known):
    return calibrate(BLOCK, PULSES, known, ranges=RANGES, count=96, samples=200, tail=4.0, rng=1, progress=False)


def test_the_numbers_of_the_object_lie_in_their_intervals(learnt):
    mean = learnt.numbers()["mean"]
    low, middle, high = mean.sel(number="slenderness").values
    assert low < 0.167 < high
    assert middle == pytest.approx(0.167, abs=0.015)
    assert learnt.numbers()["lapse"].sel(quantile=0.025) < 0.05
    assert learnt.numbers()["r_hat"] < 1.5


def test_further_rounds_draw_where_the_distributions_are(learnt, known):
    once = calibrate(
        BLOCK, PULSES, known, ranges=RANGES, count=288, rounds=1, samples=50, tail=4.0, rng=1, progress=False
    )
    assert len(once.draws) == len(learnt.draws) == 288
    assert np.mean(learnt.draws.effective(learnt.states)) > 1.2 * np.mean(once.draws.effective(learnt.states))
    assert learnt.numbers()["effective_draws"] == learnt.effective_draws


def test_too_few_draws_are_named(known):
    with pytest.warns(sb.errors.UnlikelyInputWarning, match="16 count as .* Give a larger count, or more rounds"):
        calibrate(BLOCK, PULSES, known, ranges=RANGES, count=8, rounds=2, samples=1, tail=4.0, progress=False)


def test_outcomes_that_were_not_used_are_predicted(learnt, known):
    held_out = learnt.held_out(folds=5, repeats=2, rng=0)
    assert held_out.shape == (2, len(PULSES))
    rate = known.mean()
    for one in held_out:
        assert scores(one, known)["same_outcome"] > 0.85
        assert scores(one, known)["brier"] < 0.5 * rate * (1.0 - rate)


def test_a_held_out_probability_does_not_know_the_outcome_of_its_test(learnt, known):
    usual = learnt.held_out(folds=4, repeats=1, rng=3)
    part = np.array_split(np.random.default_rng(3).permutation(len(known)), 4)[0]
    other = known.copy()
    other[part] = ~other[part]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", sb.errors.UnlikelyInputWarning)
        changed = learnt.relearnt(other, samples=1)
    np.testing.assert_array_equal(changed.held_out(folds=4, repeats=1, rng=3)[0, part], usual[0, part])


def test_a_held_out_probability_does_not_know_the_outcomes_of_its_group(learnt, known):
    group = np.repeat(["short", "medium", "long"], 20)
    usual = learnt.held_out(folds=3, repeats=1, groups=group, rng=3)[0]
    for name in np.unique(group):
        other = np.where(group == name, ~known, known)
        with warnings.catch_warnings():  # few draws are where other outcomes would have them
            warnings.simplefilter("ignore", sb.errors.UnlikelyInputWarning)
            changed = learnt.relearnt(other, samples=1)
        changed = changed.held_out(folds=3, repeats=1, groups=group, rng=3)[0]
        np.testing.assert_array_equal(changed[group == name], usual[group == name])
        assert not np.array_equal(changed[group != name], usual[group != name])


@pytest.mark.parametrize(
    ("groups", "message"),
    [(["a", "b"], "a label for each of 60 tests"), (["a"] * 30 + ["b"] * 30, "at least 3 labels")],
)
def test_groups_that_cannot_be_divided_are_refused(learnt, groups, message):
    with pytest.raises(sb.errors.ParameterError, match=message):
        learnt.held_out(folds=3, groups=groups)


def test_predictions_are_the_probabilities_of_the_same_motions(learnt):
    some = [7, 30, 55]
    found = learnt.predict([PULSES[k] for k in some], tail=4.0, progress=False)
    np.testing.assert_allclose(found, learnt.probabilities()[some], rtol=1e-12)


def test_scores_of_certain_answers_of_a_coin_and_of_errors():
    known = np.array([True, False, True, True])
    assert scores(known, known) == {"same_outcome": 1.0, "brier": 0.0, "log_loss": 0.0}
    coin = scores(np.full(4, 0.5), known)
    assert (coin["brier"], coin["log_loss"]) == pytest.approx((0.25, np.log(2.0)))
    assert scores(~known, known)["brier"] == 1.0


def test_reliability_counts_each_test_once_and_means_of_like_probability():
    probability = np.array([[0.1, 0.15, 0.9, 1.0], [0.1, 0.15, 0.9, 1.0]])
    found = reliability(probability, [False, True, True, True], bins=2)
    assert found["tests"].values.tolist() == [4, 4]
    np.testing.assert_allclose(found["predicted"], [0.125, 0.95])
    np.testing.assert_allclose(found["overturned"], [0.5, 1.0])


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"overturned": [True, False]}, "overturned must have one outcome for each of 60 motions"),
        ({"overturned": [True] * 60}, "overturned must have both outcomes"),
        ({"ranges": {"slenderness": (0.2, 0.1)}}, r"ranges\['slenderness'\] must be a smaller and a larger number"),
        ({"ranges": {"slendernes": (0.1, 0.2)}}, "slenderness"),
    ],
)
def test_what_cannot_be_learnt_from_is_refused_in_one_line(known, change, said):
    given = {"overturned": known, "ranges": RANGES} | change
    with pytest.raises(sb.errors.ParameterError, match=said):
        calibrate(BLOCK, PULSES, given["overturned"], ranges=given["ranges"], progress=False)
