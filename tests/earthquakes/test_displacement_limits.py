"""Limit states of displacement: names, what they limit, and their descriptions."""

import math

import numpy as np
import pytest
import xarray as xr

import stylobate as sb
from stylobate.earthquakes import LimitState
from stylobate.earthquakes.config.assess import AssessConfig
from stylobate.earthquakes.config.fragility import FragilityConfig
from stylobate.earthquakes.config.limit_states import limit_state_of_text
from stylobate.errors import ConfigError, ParameterError

COLUMN = sb.Column.solid(radius=0.2, height=2.0, density=2700.0)
PULSES = {
    f"pulse {frequency:g}": sb.Pulse.one_sine(acceleration=2.0, angular_frequency=frequency) for frequency in (3.0, 8.0)
}


def test_a_limit_state_is_named_by_its_response_and_its_limit():
    assert LimitState(response="residual", limit=0.0125).name == "residual 12.5 mm"
    assert LimitState(response="neighbours", limit=0.1, height=2.0).name == "neighbours 100 mm at 2 m"


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"response": "sli", "limit": 0.1}, r"response: unknown \(got 'sli'\). Did you mean slip"),
        ({"response": "slip", "limit": 0.0}, "limit must be positive"),
        ({"response": "slip", "limit": math.nan}, "limit"),
        ({"response": "edge", "limit": 0.1, "height": 2.0}, r"height: is of no use for edge \(got 2.0\). Remove it."),
        ({"response": "neighbours", "limit": 0.1, "height": -2.0}, "height must be positive"),
    ],
)
def test_a_limit_state_without_meaning_is_refused(arguments, message):
    with pytest.raises(ParameterError, match=message):
        LimitState(**arguments)


def test_only_a_residual_limit_looks_at_the_end():
    peak, residual = xr.DataArray([0.04, 0.06, 0.06]), xr.DataArray([0.04, 0.04, 0.06])
    reached = {
        name: LimitState(response=name, limit=0.05).of_slip(peak, residual).values.tolist()
        for name in ("slip", "edge", "neighbours", "residual")
    }
    assert reached["slip"] == reached["edge"] == reached["neighbours"] == [False, True, True]
    assert reached["residual"] == [False, False, True]


def test_a_tilt_moves_the_body_by_the_height_times_its_sine_and_by_the_rolled_rim():
    tilts = xr.DataArray(np.linspace(0.0, 0.09, 200), dims="run")
    limit = LimitState(response="neighbours", limit=0.1, height=1.5)
    reached = limit.of_tilt(tilts, [COLUMN], "column")
    first = float(tilts[int(reached.values.argmax())])
    # a point of the axis at the height z turns about the rim: its distance is z sin θ + r (1 − cos θ)
    turned = np.array([[math.cos(first), math.sin(first)], [-math.sin(first), math.cos(first)]]) @ [-0.2, 1.5]
    assert turned[0] + 0.2 == pytest.approx(0.1, abs=0.0005 * 1.5 + 1e-9)
    assert limit.of_tilt(tilts, [COLUMN, COLUMN], "sample").dims in (("run", "sample"), ("sample", "run"))


def test_neighbours_without_a_height_are_as_high_as_the_column():
    tilts = xr.DataArray(np.linspace(0.0, 0.09, 50), dims="run")
    of_column, stated = (LimitState(response="neighbours", limit=0.1, height=height) for height in (None, 2.0))
    assert (of_column.of_tilt(tilts, [COLUMN], "c") == stated.of_tilt(tilts, [COLUMN], "c")).all()
    bare = sb.Column.dimensionless(slenderness=0.1)
    with pytest.raises(ParameterError, match="height: missing in the limit state 'neighbours 100 mm'"):
        of_column.of_tilt(tilts, [bare], "c")
    with pytest.raises(ParameterError, match="height: missing"):  # before anything runs
        sb.earthquakes.incremental_dynamic_analysis(sb.Wobbling(bare), PULSES, scales=[1.0], limit_states=[of_column])


def test_runs_that_rock_reach_the_neighbours_by_their_tilt_and_by_overturning():
    model, scales = sb.Wobbling(COLUMN, damping=0.05), [0.4, 1.0, 1.3, 4.0]
    limits = [LimitState(response="neighbours", limit=limit) for limit in (0.05, 0.3)]
    plain = sb.earthquakes.incremental_dynamic_analysis(model, PULSES, scales=scales)
    found = sb.earthquakes.incremental_dynamic_analysis(model, PULSES, scales=scales, limit_states=limits)
    assert found["reached"].sel(limit_state=plain["limit_state"]).identical(plain["reached"])
    tilt, fallen = found["peak_tilt"], plain["reached"].sel(limit_state="overturning", drop=True) == 1
    shift = 2.0 * np.sin(tilt) + 0.2 * (1.0 - np.cos(tilt))
    for limit in limits:
        own = found["reached"].sel(limit_state=limit.name, drop=True)
        assert (own == 1).values.tolist() == ((shift >= limit.limit) | fallen).values.tolist()
    assert 0 < int(found["reached"].sel(limit_state=limits[0].name).sum()) < 8


@pytest.mark.parametrize("response", ["slip", "residual", "edge"])
def test_a_model_without_slip_refuses_limits_of_slip(response):
    limits = [LimitState(response=response, limit=0.1)]
    with pytest.raises(ParameterError, match=r"limit_states\[0\]: the model wobbling does not slip"):
        sb.earthquakes.incremental_dynamic_analysis(sb.Wobbling(COLUMN), PULSES, scales=[1.0], limit_states=limits)


def test_limit_states_of_one_name_or_of_another_kind_are_refused():
    same = [LimitState(response="neighbours", limit=0.1)] * 2
    for given, message in (
        (same, "two limit states are equal"),
        ([0.05], "must hold limit states"),
        (0.05, "sequence"),
    ):
        with pytest.raises(ParameterError, match=message):
            sb.earthquakes.incremental_dynamic_analysis(sb.Wobbling(COLUMN), PULSES, scales=[1.0], limit_states=given)


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("slip=0.05", {"response": "slip", "limit": 0.05}),
        ("neighbours = 80 mm @ 2.5", {"response": "neighbours", "limit": "80 mm", "height": 2.5}),
    ],
)
def test_the_command_line_states_a_limit_as_a_file_does(text, values):
    assert limit_state_of_text(text) == values


@pytest.mark.parametrize("text", ["slip", "=0.05", "slip=", "neighbours=0.08@"])
def test_an_incomplete_limit_on_the_command_line_is_refused(text):
    with pytest.raises(ParameterError, match="--limit-state: must be a response and its limit"):
        limit_state_of_text(text)


BODY = {"shape": "solid", "radius": 0.5, "height": 3.0, "density": 2700.0}
RECORDS = {"samples": ["el centro 1940"]}


def test_files_of_fragilities_and_assessments_state_the_same_limits():
    stated = [{"response": "slip", "limit": "50 mm"}, {"response": "neighbours", "limit": 0.08, "height": 2.5}]
    expected = (LimitState(response="slip", limit=0.05), LimitState(response="neighbours", limit=0.08, height=2.5))
    fragility = FragilityConfig.parse(
        {
            "column": BODY,
            "model": {"kind": "sliding", "friction_coefficient": 0.15},
            "records": RECORDS,
            "fragility": {"scales": {"values": [1.0]}, "limit_states": stated},
        }
    )
    assert fragility.build().limit_states == expected
    levels = {level: {"damping": value} for level, value in (("low", 0.05), ("central", 0.1), ("high", 0.2))}
    study = {"columns": {"a": BODY, "b": BODY}, "dissipation": levels, "friction_coefficient": 0.15, "records": RECORDS}
    assert AssessConfig.parse({**study, "limit_states": stated}).build().options["limit_states"] == expected
    by_column = AssessConfig.parse({**study, "limit_states": {"b": stated}}).build()
    assert by_column.options["limit_states"] == {"b": expected}
    bad = {**study, "limit_states": {"c": [{"response": "slop", "limit": 1.0}]}}
    with pytest.raises(ConfigError) as refused:
        AssessConfig.parse(bad).build()
    assert list(refused.value.problems) == [
        "limit_states: 'c' is no column; leave it out",
        "limit_states.c[0]: response: unknown (got 'slop'). Did you mean slip?",
    ]
