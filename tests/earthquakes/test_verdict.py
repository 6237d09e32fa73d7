"""Verdicts: each variation is the run of the varied objects; shares repeat, cover the truth, and name what decides."""

import math
import re

import numpy as np
import pytest

import stylobate as sb
from stylobate.earthquakes import Choice, LognormalSpread, LogUniformSpread, NormalSpread, UniformSpread
from stylobate.earthquakes.property_spreads import VARIATIONS
from stylobate.earthquakes.verdict_study import contact_laws
from stylobate.errors import ParameterError, UnlikelyInputWarning, UnsupportedError
from stylobate.results.verdict import VerdictWord, interval_text, percent, word_of
from stylobate.studies.proportions import fraction_interval

COLUMN = sb.Column.solid(radius=0.3, height=3.0, density=2700.0)
MODEL = sb.Wobbling(COLUMN, damping=0.08)
PULSE = sb.Pulse.one_sine(acceleration=2.2, angular_frequency=4.0)


QUAKE = sb.sample_record("el centro 1940").trimmed(0.0, 12.0)
ALONE = dict.fromkeys(VARIATIONS)
"""Changes that leave all variations out."""


def varied(verdict, number):
    """Return model, motion and options of one run of a verdict, made of changed objects."""
    run = verdict.data.isel(run=number)
    value = {str(name): float(run["value"].sel(variation=name)) for name in verdict.data["variation"].to_numpy()}
    law = contact_laws(MODEL)[int(run["law"])]
    column = COLUMN.with_slenderness(value["slenderness"]).resized(value["size"])
    model = type(law)(column, damping=0.08 * value["dissipation"])
    record = QUAKE if math.isinf(value["lowpass"]) or value["lowpass"] >= 25.0 else QUAKE.filtered(lowpass=15.0)
    motion = sb.Record(
        samples=record.samples, step=record.step * value["clock"]
    )  # the clock itself, not its similarity
    motion = motion.scaled(value["scale"]).rotated(value["rotation"])
    slope = [column.gravity * math.sin(value[f"slope_{k}"]) for k in "xy"]
    tilt = tuple(column.tipping_angle * value[f"start_{k}"] for k in "xy")
    duration = motion.duration + value["clock"] * 20.0 / COLUMN.frequency_parameter * math.sqrt(
        value["size"] / value["clock"] ** 2
    )
    return model, motion.offset(*slope), {"tilt": tilt, "duration": duration, "rtol": 1e-8 * value["tolerance"]}


def test_each_run_is_that_of_the_varied_column_record_and_base():
    found = sb.verdict(MODEL, QUAKE, runs=24, seed=5)
    seen = set()
    for number in range(24):
        model, motion, options = varied(found, number)
        alone = sb.simulate(model, motion, **options, recheck=False)
        run = found.data.isel(run=number)
        assert int(run["outcome"]) == alone.outcome
        seen.add((type(model), alone.outcome))
        if alone.outcome is not sb.Outcome.OVERTURNED:
            # Similar runs differ by rounding, which passages near the vertical amplify.
            expected = alone.measures["peak_tilt"] / model.column.tipping_angle
            assert float(run["tilt_ratio"]) == pytest.approx(expected, rel=1e-4)
    assert {model for model, _ in seen} == {sb.Wobbling, sb.Rolling}
    assert sb.Outcome.OVERTURNED in {outcome for _, outcome in seen}
    assert len({outcome for _, outcome in seen}) > 1


def test_a_saved_verdict_is_repeated_bit_for_bit(tmp_path):
    changes = {"damping": UniformSpread(0.03, 0.1), "slope_x": None, "lowpass": Choice((math.inf, 20.0))}
    found = sb.verdict([MODEL, sb.Slender(COLUMN, damping=0.05)], QUAKE, variations=changes, runs=40, seed=2, **SHARED)
    loaded = sb.load(found.save(tmp_path / "verdict.nc"))
    assert str(loaded) == str(found)
    again = sb.earthquakes.repeat_verdict(loaded)
    assert again.data.identical(found.data)
    assert (again.share, again.interval, again.word) == (loaded.share, loaded.interval, loaded.word)


SHARED = {"rtol": 1e-7, "rules": sb.OutcomeRules(periods=20.0), "tilt": (0.001, 0.0)}


@pytest.mark.parametrize("motion", [sb.Record(samples=QUAKE.samples, step=QUAKE.step), PULSE])
def test_what_cannot_be_described_is_not_repeated(motion):
    class Fixed:
        def draw(self, nominal, shares):
            return np.full(shares.size, 1.01)

    found = sb.verdict(MODEL, motion, variations={"scale": Fixed()}, runs=2)
    with pytest.raises(UnsupportedError, match=r"Fixed|made from samples"):
        sb.earthquakes.repeat_verdict(found)


def test_a_variation_left_out_changes_no_other_and_more_runs_begin_with_the_same():
    short = sb.verdict(MODEL, PULSE, runs=30)
    longer = sb.verdict(MODEL, PULSE, runs=50)
    fewer = sb.verdict(MODEL, PULSE, runs=30, variations={"size": None, "rotation": None})
    np.testing.assert_array_equal(longer.data["value"][:, :30], short.data["value"])
    np.testing.assert_array_equal(longer.data["tilt_ratio"][:30], short.data["tilt_ratio"])
    kept = fewer.data["variation"].to_numpy()
    assert set(short.data["variation"].to_numpy()) - set(kept) == {"size", "rotation"}
    np.testing.assert_array_equal(fewer.data["value"], short.data["value"].sel(variation=kept))
    assert not np.array_equal(sb.verdict(MODEL, PULSE, runs=30, seed=1).data["value"], short.data["value"])


def test_without_variations_all_runs_are_the_given_one():
    found = sb.verdict([MODEL], QUAKE.scaled(0.6), variations=ALONE, runs=3)
    alone = sb.simulate(MODEL, QUAKE.scaled(0.6))
    assert found.data["outcome"].to_numpy().tolist() == 3 * [alone.outcome]
    ratio = alone.measures["peak_tilt"] / COLUMN.tipping_angle
    np.testing.assert_allclose(found.data["tilt_ratio"], ratio, rtol=1e-6)
    assert found.deciding == ""


def test_what_alone_moves_the_column_across_the_boundary_decides():
    intervals = sb.earthquakes.overturning_intervals(MODEL, PULSE, scales=np.geomspace(0.5, 2.0, 40))
    edge = float(intervals["interval_from"][0])
    assert edge < 1.9
    near = {"scale": LognormalSpread(0.3, median=edge), "tolerance": None, "slenderness": None}
    found = sb.verdict([MODEL], PULSE, variations=near, runs=200)
    assert found.deciding == "scale"
    influence = dict(zip(found.data["variation"].to_numpy(), found.data["influence"].to_numpy(), strict=True))
    assert influence["scale"] > 0.6
    assert max(value for name, value in influence.items() if name != "scale") < 0.1
    # Half of the scales lie above the edge, which the other variations move a little.
    shares = found.data["part_share"].sel(variation="scale").to_numpy()
    assert shares[0] < 0.1
    assert shares[1] < 0.5 < shares[4]


@pytest.mark.parametrize(
    ("scale", "word"), [(0.3, VerdictWord.STANDS), (3.0, VerdictWord.OVERTURNS), (1.0, VerdictWord.UNDECIDED)]
)
def test_the_word_follows_from_the_interval(scale, word):
    found = sb.verdict(MODEL, QUAKE.scaled(scale), runs=120)
    low, high = found.interval
    assert low <= found.share <= high
    assert found.word is word
    assert str(found).startswith(word.value)
    assert f"{percent(float((found.data['overturned'] == 1).mean()))} of 120 variations overturn" in str(found)
    counts, shares = found.data["model_runs"].to_numpy(), list(found.share_by_model.values())
    assert counts.sum() == 120
    assert np.dot(counts, shares) == pytest.approx(120.0 * found.share)


def test_words_and_their_limits():
    assert [word_of(*one).value for one in ((0.0, 0.05), (0.0, 0.06), (0.94, 1.0), (0.95, 1.0), (0.0, 1.0))] == [
        *("stands", "undecided", "undecided", "overturns", "undecided")
    ]
    assert [percent(share) for share in (0.0, 3e-4, 1.0 / 300.0, 0.076, 299.0 / 300.0, 0.99996, 1.0)] == [
        *("0 %", "0.03 %", "0.3 %", "8 %", "99.7 %", "99.996 %", "100 %")
    ]


@pytest.mark.parametrize(("overturned", "runs"), [(9, 300), (10, 300), (11, 300), (290, 300), (291, 300), (38, 1000)])
def test_an_interval_that_ends_near_a_limit_shows_on_which_side_and_the_rule(overturned, runs):
    low, high = fraction_interval(overturned, 0, runs, confidence=0.9)
    text = interval_text(float(low), float(high))
    numbers = [float(one) for one in re.findall(r"[\d.]+", text)]
    if "stands" in text:
        assert (numbers[1] < 5.0) == (word_of(low, high) is VerdictWord.STANDS)
    else:
        assert "overturns" in text
        assert (numbers[0] > 95.0) == (word_of(low, high) is VerdictWord.OVERTURNS)


def test_the_dissipation_varies_from_half_to_twice_as_the_recipe_says():
    values = VARIATIONS["dissipation"].draw(1.0, np.array([0.0, 0.5, 1.0]))
    np.testing.assert_allclose(values, [0.5, 1.0, 2.0])


def test_the_line_says_that_its_interval_is_of_the_sample():
    found = sb.verdict(MODEL, PULSE, runs=10)
    assert "(90 % sampling interval " in str(found)
    assert "90 % sampling interval" in found._repr_html_()


def test_runs_without_a_decision_count_on_both_sides():
    found = sb.verdict(MODEL, QUAKE, runs=20, max_steps=30)
    open_runs = int((found.data["overturned"] < 0).sum())
    assert open_runs > 5
    assert found.interval[1] >= open_runs / 20.0
    assert found.word is VerdictWord.UNDECIDED


def test_a_run_that_may_overturn_later_is_undecided_at_every_tail():
    strong = sb.Pulse.one_sine(acceleration=5.0, angular_frequency=6.0)
    for tail in (0.0, 0.5):
        cut = sb.verdict(MODEL, strong, runs=40, tail=tail)
        moving = cut.data["outcome"].to_numpy() == sb.Outcome.STILL_MOVING
        assert moving.any()
        np.testing.assert_array_equal(cut.data["overturned"].to_numpy() < 0, moving)
        assert cut.interval[1] == 1.0
        assert cut.word is VerdictWord.UNDECIDED
        assert f"{percent(float(moving.mean()))} are not decided" in str(cut)
    assert sb.verdict(MODEL, strong, runs=60).word is VerdictWord.OVERTURNS


def test_the_default_tail_is_lengthened_until_spinning_columns_are_decided():
    quake, chosen = sb.sample_record("el centro 1940"), {"runs": 60, "seed": 1}
    spinning = [sb.Rolling(COLUMN, damping=0.08)]
    short = sb.verdict(spinning, quake, tail=20.0 / COLUMN.frequency_parameter, **chosen)
    usual = sb.verdict(spinning, quake, **chosen)
    moving = short.data["overturned"].to_numpy() < 0
    assert moving.any()
    assert (short.data["outcome"] == sb.Outcome.STILL_MOVING).any()
    assert (usual.data["outcome"] != sb.Outcome.STILL_MOVING).all()
    np.testing.assert_array_equal(usual.data["outcome"][~moving], short.data["outcome"][~moving])


@pytest.mark.parametrize(
    ("model", "other"),
    [
        (MODEL, sb.Rolling(COLUMN, damping=0.08)),
        (sb.Rolling(COLUMN, damping=0.1, spin_damping=0.2, rolling_resistance=0.01), None),
        (sb.Slender(COLUMN, damping=0.1), sb.SlenderRolling(COLUMN, damping=0.1)),
    ],
)
def test_one_model_brings_the_other_contact_law_with_the_same_numbers(model, other):
    first, second = contact_laws(model)
    assert first is model
    assert second == other or second == sb.Wobbling(COLUMN, damping=0.1, rolling_resistance=0.01)
    assert contact_laws([model]) == (model,)


def test_a_model_of_another_class_is_used_alone():
    class Own(sb.Wobbling):
        pass

    assert len(contact_laws(Own(COLUMN))) == 1


def test_the_contact_law_can_be_left_out():
    alone = sb.verdict(MODEL, PULSE, runs=10, variations={"contact_law": None})
    assert alone.data.identical(sb.verdict([MODEL], PULSE, runs=10).data)


def test_a_column_without_losses_warns_once_with_the_yardstick():
    lossless = sb.Wobbling(COLUMN)
    with pytest.warns(
        UnlikelyInputWarning, match="loses no energy.*Housner's impacts lose as much as η = 0.12"
    ) as seen:
        sb.verdict(lossless, PULSE, runs=4)
    assert len(seen) == 1
    stated = sb.verdict(
        lossless, PULSE, runs=4, variations={"damping": UniformSpread(0.05, 0.1)}
    )  # warnings are errors
    assert stated.runs == 4


def test_progress_is_reported_up_to_the_number_of_runs():
    seen = []
    sb.verdict(MODEL, PULSE, runs=10, progress=lambda done, total: seen.append((done, total)))
    assert seen[-1] == (10, 10)
    assert [done for done, _ in seen] == sorted(done for done, _ in seen)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"models": sb.PlanarRocking(COLUMN)}, "models: must be three-dimensional models"),
        ({"models": []}, "models: must be at least one model"),
        ({"motion": sb.Harmonic.straight(acceleration=1.0, angular_frequency=3.0)}, "motion: must end after t = 0"),
        ({"variations": {"colour": NormalSpread(0.1)}}, "variations: colour is no variation of a wobbling column; use"),
        ({"variations": {"dampng": NormalSpread(0.1)}}, "dampng is no variation .*; did you mean damping?"),
        ({"variations": {"contact_law": NormalSpread(0.1)}}, "contact_law is no variation"),
        ({"variations": {"restitution": UniformSpread(0.5, 1.5)}}, r"variations\['restitution'\]: .* between 0 and 1"),
        ({"models": COLUMN}, "models: must be three-dimensional models"),
        ({"motion": [PULSE]}, "motion: must be one base motion"),
        ({"duration": 10.0}, r"duration: a verdict sets it for each variation \(got 10.0\). Pass tail="),
        ({"varations": None}, "varations: is no argument of verdict .*; did you mean variations?"),
        ({"variations": {"scale": 1.02}}, r"variations\['scale'\]: must be a distribution or None \(got 1.02\)"),
        ({"variations": ["scale"]}, "variations: must map names to distributions"),
        ({"runs": 1}, "runs must be a whole number of at least 2, got 1"),
        ({"confidence": 90.0}, "confidence must lie between 0 and 1, got 90"),
        ({"seed": -1}, "seed must be"),
        ({"tail": -50.0}, "tail must be zero or positive, got -50"),
        ({"tilt_limit": 0.1}, "tilt_limit"),
        ({"variations": {"lowpass": Choice((-3.0,))}, "motion": QUAKE}, "lowpass"),
    ],
)
def test_a_wrong_argument_is_named_with_its_remedy(arguments, message):
    with pytest.raises(ParameterError, match=message):
        sb.verdict(**{"models": MODEL, "motion": PULSE, "runs": 2, **arguments})


@pytest.mark.parametrize(
    "make", [lambda: LogUniformSpread(2.0, 1.0), lambda: LogUniformSpread(0.0, 1.0), lambda: Choice(())]
)
def test_a_wrong_distribution_is_refused(make):
    with pytest.raises(ParameterError):
        make()


def test_distributions_have_their_quantiles():
    shares = np.array([0.0, 0.5, 1.0 - 1e-12])
    np.testing.assert_allclose(LogUniformSpread(0.5, 8.0).draw(1.0, shares), [0.5, 2.0, 8.0])
    np.testing.assert_array_equal(Choice((3.0, 1.0)).draw(1.0, shares), [3.0, 1.0, 1.0])


def test_the_figure_shows_every_variation_and_law():
    found = sb.verdict(MODEL, QUAKE, runs=60)
    figure = sb.plot(found)
    tilts, shares = figure.axes
    assert len(shares.get_yticklabels()) == len(VARIATIONS) + 1
    bars = [bar.get_height() for container in tilts.containers for bar in container]
    assert sum(bars) == 60
    assert str(found) in figure.texts[0].get_text()


@pytest.mark.slow
def test_intervals_cover_the_share_of_many_variations_as_often_as_they_say():
    cases = [(scale, damping) for scale in np.linspace(0.55, 1.5, 10) for damping in (0.03, 0.05, 0.08, 0.12)]
    covered = total = 0
    for scale, damping in cases:
        model, quake = sb.Wobbling(COLUMN, damping=damping), QUAKE.scaled(float(scale))
        truth = sb.verdict(model, quake, runs=6000, seed=99).share
        if not 0.02 <= truth <= 0.98:
            continue  # an interval about nearly 0 or 1 covers nearly always
        for seed in range(8):
            low, high = sb.verdict(model, quake, runs=300, seed=seed).interval
            covered += low <= truth <= high
            total += 1
    assert total >= 200
    assert 0.86 <= covered / total <= 0.94
