"""Intervals of survival by record, and limit states of runs."""

import numpy as np
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st

import stylobate as sb
from stylobate import Outcome
from stylobate.earthquakes import fit_fragility, limit_states, reached_intervals
from stylobate.errors import ParameterError


@pytest.mark.slow
@given(st.lists(st.lists(st.booleans(), min_size=1, max_size=12), min_size=1, max_size=5), st.randoms())
def test_intervals_tell_every_run_whatever_their_order(series, random):
    runs = [(place, 1.0 + k, one) for place, states in enumerate(series) for k, one in enumerate(states)]
    random.shuffle(runs)
    record, scale, reached = (np.array(column) for column in zip(*runs, strict=True))
    found = reached_intervals(scale, reached, record=record)
    assert int(found["interval_runs"].sum()) == len(runs)
    for place, states in enumerate(series):
        intervals = found.isel(interval=found["interval_record"].values == place)
        states_of_bands = np.concatenate(
            [np.repeat(one["interval_reached"], one["interval_runs"]) for _, one in intervals.groupby("interval")]
        )
        assert states_of_bands.tolist() == states
        # Neighbours differ.
        assert np.all(np.diff(intervals["interval_reached"].values.astype(int)) != 0)
        assert bool(found["monotone"][place]) == (states == sorted(states))
        assert int(found["safe_again"][place]) == "".join("01"[one] for one in states).count("10")


def test_first_reached_and_last_safe_enclose_what_is_not_monotone():
    found = reached_intervals([1.0, 2.0, 3.0, 4.0], [0, 1, 0, 1], record=["a"] * 4)
    assert (found["first_reached"].item(), found["last_safe"].item()) == (2.0, 3.0)
    assert found.attrs["non_monotone_share"] == 1.0
    assert found["record"].values.tolist() == ["a"]


def test_a_record_that_never_reached_it_has_no_first():
    found = reached_intervals([1.0, 2.0, 1.0, 2.0], [0, 0, 1, -1], record=[0, 0, 1, 1])
    np.testing.assert_array_equal(found["first_reached"], [np.nan, 1.0])
    np.testing.assert_array_equal(found["last_safe"], [2.0, np.nan])
    assert found["runs"].values.tolist() == [2, 1]


def test_runs_that_disagree_are_refused():
    with pytest.raises(ParameterError, match=r"reached must agree .* at 1.0 of record all"):
        reached_intervals([1.0, 1.0], [0, 1])


def test_several_limit_states_are_refused_by_name():
    reached = xr.DataArray(
        [[0], [1]], dims=("limit_state", "run"), coords={"limit_state": ["tilt 0.1 α", "overturning"]}
    )
    with pytest.raises(ParameterError, match=r"one limit state, got tilt 0\.1 α, overturning"):
        reached_intervals([1.0], reached)


def codes(*outcomes):
    return ("run", list(outcomes))


def test_limit_states_are_nested_and_follow_the_tilt():
    c = 0.2
    tilt = np.arctan(c) * np.array([0.0, 0.05, 0.2, 0.7, 1.2])
    runs = xr.Dataset({"outcome": codes(*[Outcome.AT_REST] * 5), "peak_tilt": ("run", tilt)})
    found = limit_states(runs, slenderness=c)
    assert found["limit_state"].values.tolist() == [
        "tilt 0.001 α",
        "tilt 0.1 α",
        "tilt 0.5 α",
        "tilt 1 α",
        "overturning",
    ]
    assert found.sum("limit_state").values.tolist() == [0, 1, 2, 3, 4]
    assert np.all(np.diff(found.transpose("limit_state", "run"), axis=0) <= 0)


def test_a_run_that_overturned_reached_all_and_one_that_stopped_early_does_not_tell_the_rest():
    outcomes = codes(Outcome.OVERTURNED, Outcome.FAILED, Outcome.LIMIT_REACHED, Outcome.LIFTED_OFF)
    runs = xr.Dataset({"outcome": outcomes, "peak_tilt": ("run", [0.01, 0.06, 0.02, 0.0])})
    found = limit_states(runs, slenderness=0.1, tilt_ratios=(1e-3, 0.5)).transpose("run", "limit_state")
    assert found.values.tolist() == [[1, 1, 1], [1, 1, -1], [1, -1, -1], [-1, -1, -1]]


def test_a_run_not_computed_tells_nothing():
    runs = xr.Dataset({"outcome": ("run", [-1]), "peak_tilt": ("run", [np.nan])})
    assert np.all(limit_states(runs, slenderness=0.1) == -1)


def test_the_slenderness_is_that_of_each_run():
    runs = xr.Dataset(
        {"outcome": codes(Outcome.AT_REST, Outcome.AT_REST), "peak_tilt": ("run", [0.08, 0.08])},
        coords={"slenderness": ("run", [0.1, 0.3])},
    )
    assert limit_states(runs, tilt_ratios=(0.5,)).sel(limit_state="tilt 0.5 α").values.tolist() == [1, 0]


def test_limit_states_of_an_ensemble_are_those_of_its_runs():
    column = sb.Column.dimensionless(slenderness=0.1)
    motion = sb.Harmonic.circular(acceleration=0.15, angular_frequency=0.5)
    runs = sb.simulate_ensemble(
        sb.Slender(column, damping=0.1), motion, duration=50.0, parameters={"acceleration": [0.05, 0.15]}
    )
    found = limit_states(runs, slenderness=column.slenderness)
    assert found.isel(run=0).values.tolist() == [0] * 5
    assert found.isel(run=1).values.tolist() == [1] * 5
    assert fit_fragility(runs["acceleration"], found)["least_reached"].values.tolist() == [0.15] * 5


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({}, "slenderness must be given"),
        ({"slenderness": -0.1}, "slenderness must be positive, got -0.1"),
        ({"slenderness": [0.1, 0.2]}, "slenderness must be a number or have the shape of runs"),
        ({"slenderness": 0.1, "tilt_ratios": (0.5, 0.0)}, r"tilt_ratios\[1\] must be positive, got 0.0"),
    ],
)
def test_mistakes_are_told(options, message):
    runs = xr.Dataset({"outcome": codes(Outcome.AT_REST), "peak_tilt": ("run", [0.0])})
    with pytest.raises(ParameterError, match=message):
        limit_states(runs, **options)


def test_runs_without_tilts_are_refused():
    with pytest.raises(ParameterError, match="runs must hold the variable peak_tilt, got outcome"):
        limit_states(xr.Dataset({"outcome": codes(Outcome.AT_REST)}), slenderness=0.1)
