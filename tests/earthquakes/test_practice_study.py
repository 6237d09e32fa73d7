"""Rules of practice beside runs: the counts are those of answers and outcomes."""

import numpy as np
import pytest

import stylobate as sb
from stylobate.earthquakes import compare_rules, incremental_dynamic_analysis
from stylobate.errors import ParameterError
from stylobate.practice import rules_of_practice

COLUMN = sb.Column.solid(radius=0.2, height=2.0, density=2700.0)
MODELS = {"low": sb.Wobbling(COLUMN, damping=0.05), "tall": sb.Wobbling(COLUMN.resized(3.0), damping=0.05)}
PULSES = {
    f"{omega:g} rad/s": sb.Pulse.one_sine(acceleration=1.0, angular_frequency=omega) for omega in (3.0, 6.0, 12.0)
}
SCALES = [1.0, 2.5, 4.0, 8.0]


@pytest.fixture(scope="module")
def found():
    return compare_rules(MODELS, PULSES, scales=SCALES)


def test_every_decided_run_is_right_unsafe_or_strict(found):
    total = found["right"] + found["unsafe"] + found["strict"]
    assert bool((total == found["decided"]).all())
    assert found["decided"].values.tolist() == [12, 12]


def test_answers_and_outcomes_are_those_of_rules_and_runs(found):
    alone = incremental_dynamic_analysis(MODELS["tall"], PULSES, scales=SCALES)
    np.testing.assert_array_equal(
        found["overturned"].sel(model="tall").values, alone["reached"].sel(limit_state="overturning").values
    )
    answers = rules_of_practice(MODELS["tall"].column, PULSES["6 rad/s"].scaled(4.0))
    at = found.sel(model="tall", record="6 rad/s", scale=4.0)
    assert at["safe"].values.tolist() == [answer.safe for answer in answers]
    np.testing.assert_allclose(at["ratio"], [answer.ratio for answer in answers], rtol=1e-9)


def test_without_vertical_motion_west_is_never_unsafe_and_is_strict(found):
    assert int(found["unsafe"].sel(rule="West").sum()) == 0
    assert int(found["strict"].sel(rule="West").sum()) > 0


def test_a_single_model_is_a_mapping_of_one():
    one = compare_rules(MODELS["low"], PULSES["6 rad/s"], scales=[2.5])
    assert dict(one.sizes) == {"model": 1, "record": 1, "scale": 1, "rule": 7}


def test_models_must_be_models():
    for models in ({}, [MODELS["low"]], {"column": COLUMN}):
        with pytest.raises(ParameterError, match="models: must be a model"):
            compare_rules(models, PULSES, scales=SCALES)
