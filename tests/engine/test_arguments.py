"""Arguments of `simulate` that no run can have are refused by name."""

import math

import numpy as np
import pytest

import stylobate as sb
from stylobate.errors import ParameterError

MODEL = sb.Slender(sb.Column.dimensionless(0.1), damping=0.1)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("tilt", (math.nan, 0.0)),
        ("tilt", (0.0, math.inf)),
        ("tilt", (0.1,)),
        ("tilt", (0.1, 0.0, 0.0)),
        ("tilt", 0.1),
        ("tilt", "ab"),
        ("tilt", "12"),
        ("tilt", ("0.1", "0.2")),
        ("tilt", (None, 0.0)),
        ("tilt", (1j, 0.0)),
        ("tilt", np.zeros((2, 2))),
        ("tilt_rate", (0.0, math.nan)),
        ("tilt_rate", ()),
        ("duration", -1.0),
        ("duration", 0.0),
        ("duration", math.inf),
        ("duration", math.nan),
        ("duration", None),
        ("duration", "5"),
        ("rtol", 1e-14),
        ("rtol", 0.1),
        ("rtol", -1e-8),
        ("rtol", "small"),
        ("atol", 0.0),
        ("atol", math.nan),
        ("tilt_limit", 0.0),
        ("tilt_limit", "x"),
        ("rest_energy", -1.0),
        ("rest_energy", math.nan),
        ("max_steps", 0),
        ("max_steps", math.nan),
        ("max_steps", "many"),
        ("samples", 1),
        ("samples", math.nan),
        ("samples", "many"),
        ("rules", {"periods": 3}),
    ],
)
def test_an_impossible_argument_is_refused_by_name(name, value):
    with pytest.raises(ParameterError, match=rf"^{name}\b"):
        sb.simulate(MODEL, **{"tilt": (0.01, 0.0), "duration": 1.0, name: value})


@pytest.mark.parametrize("value", [None, MODEL.column, sb.Slender, "slender"])
def test_what_is_no_model_is_refused(value):
    with pytest.raises(ParameterError, match=r"^model must be a model such as"):
        sb.simulate(value, duration=1.0)


@pytest.mark.parametrize("value", [0.5, MODEL, sb.Harmonic, "circular", (0.1, 0.2)])
def test_what_is_no_motion_is_refused(value):
    with pytest.raises(ParameterError, match=r"^motion must be a base motion such as"):
        sb.simulate(MODEL, value, duration=1.0)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("periods", 0),
        ("periods", 2.5),
        ("frequency_tolerance", -1.0),
        ("repeat_tolerance", math.nan),
        ("rest_tilt", "x"),
    ],
)
def test_impossible_rules_are_refused_by_name(name, value):
    with pytest.raises(ParameterError, match=rf"^rules\.{name}\b"):
        sb.OutcomeRules(**{name: value})


def test_options_are_keyword_only():
    with pytest.raises(TypeError, match="positional"):
        sb.simulate(MODEL, None, (0.1, 0.0), duration=1.0)


@pytest.mark.parametrize("kind", [list, np.array, iter])
def test_any_pair_of_numbers_is_a_tilt(kind):
    run = sb.simulate(MODEL, tilt=kind([0.01, 0.02]), tilt_rate=kind([0.0, 0]), duration=0.5)
    np.testing.assert_allclose(run.data.tilt[0], [0.01, 0.02], rtol=1e-15)
