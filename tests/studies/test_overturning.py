"""Overturning maps obey the laws of the base motion they are made with."""

import numpy as np
import pytest

import stylobate as sb
from stylobate.config.study import study_of
from stylobate.errors import Outcome, ParameterError

MODEL = sb.Slender(sb.Column.dimensionless(0.1), damping=0.1)
CIRCULAR = sb.Harmonic.circular(acceleration=0.15, angular_frequency=1.0)


def test_below_the_limit_nothing_is_released_from_rest():
    over = {"angular_frequency": [0.3, 1.0, 5.0], "acceleration": [0.0, 0.05, 0.0999]}
    found = sb.studies.overturning_map(MODEL, CIRCULAR, over=over, periods=5)
    assert found["outcome"].dims == tuple(over)
    assert (found["outcome"] == Outcome.AT_REST).all()
    assert found["share"].sel(outcome_name="at rest").item() == 1.0
    assert found["share"].sum() == 1.0


def test_from_rest_the_phase_of_a_circular_motion_does_not_matter():
    over = {"start_phase": [0.0, 0.7, 2.0, 4.0], "acceleration": [0.12, 0.2]}
    found = sb.studies.overturning_map(MODEL, CIRCULAR, over=over, duration=20.0)
    assert (found["outcome"] == Outcome.OVERTURNED).all()
    times = found["decided_at"].values
    # Overturning grows as e^t: an error of 1e-8 c at release has grown by e^t, and moves the time by no more than it.
    np.testing.assert_allclose(times, np.broadcast_to(times[:1], times.shape), rtol=1e-6)


def test_the_start_phase_of_a_circular_motion_is_its_rotation():
    angles, starts = [0.0, 0.9, 2.5, 5.0], [-0.06, 0.02, 0.06]
    found = [
        sb.studies.overturning_map(MODEL, CIRCULAR, over={name: angles, "tilt_x": starts}, duration=30.0)
        for name in ("start_phase", "rotation")
    ]
    np.testing.assert_array_equal(found[0]["outcome"], found[1]["outcome"])
    np.testing.assert_allclose(found[0]["decided_at"], found[1]["decided_at"], rtol=1e-6)


def test_shares_are_those_of_the_runs_and_a_start_may_be_given():
    over = {"acceleration": [0.01, 0.3], "angular_frequency": [0.5, 0.8]}
    found = sb.studies.overturning_map(MODEL, CIRCULAR, over=over, tilt=(0.2, 0.0), duration=20.0)
    assert found["share"].sel(outcome_name="overturned").item() == 1.0
    assert found["count"].sum() == found["computed"] == 4
    assert found.attrs["kind"] == "overturning map"
    assert "provenance" in found.attrs


@pytest.mark.parametrize("over", [{"acceleration": [0.1]}, {"a": [1.0], "b": [1.0], "c": [1.0]}, ["acceleration"]])
def test_a_map_is_over_two_parameters(over):
    with pytest.raises(ParameterError, match="over must name two"):
        sb.studies.overturning_map(MODEL, CIRCULAR, over=over, duration=1.0)


def test_a_map_of_nothing_is_refused():
    over = {"acceleration": [], "damping": [0.1]}
    with pytest.raises(ParameterError, match=r"^over\['acceleration'\] must have at least one value, got none$"):
        sb.studies.overturning_map(MODEL, CIRCULAR, over=over, duration=1.0)


def test_the_table_of_a_map_says_that_columns_at_rest_and_survivors_both_stand():
    pulse = sb.Pulse.one_sine(acceleration=0.11, angular_frequency=2.0)
    over = {"acceleration": [0.01, 0.11], "damping": [0.1]}
    found = sb.studies.overturning_map(MODEL, pulse, over=over, duration=4.0)
    table = study_of(sb.studies.overturning_map).table(found)
    assert {row[0] for row in table.rows} == {"at rest", "survived"}
    assert "columns at rest and those that survived stand" in table.title
