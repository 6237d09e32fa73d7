"""Where two models disagree whether a column overturns."""

import numpy as np
import pytest

import stylobate as sb

COLUMN = sb.Column.dimensionless(slenderness=0.1)
HELD, FREE = sb.Slender(COLUMN, damping=0.1), sb.SlenderRolling(COLUMN, damping=0.1, spin_damping=0.1)
CIRCLE = sb.Harmonic.circular(acceleration=0.25, angular_frequency=5.0)
OVER = {"angular_frequency": [2.0, 5.0], "acceleration": [0.05, 0.25]}


@pytest.fixture(scope="module")
def found():
    return sb.studies.outcome_differences(HELD, FREE, CIRCLE, over=OVER, periods=60.0)


def test_the_twist_decides_and_single_runs_agree(found):
    names = list(sb.studies.Comparison)
    # At 5 rad/s and 0.25 m/s² only the column that cannot turn overturns.
    assert names[int(found["comparison"].sel(angular_frequency=5.0, acceleration=0.25))].name == "ONLY_FIRST"
    duration = 60.0 * CIRCLE.period
    assert sb.simulate(HELD, CIRCLE, duration=duration).outcome is sb.Outcome.OVERTURNED
    assert sb.simulate(FREE, CIRCLE, duration=duration).outcome is not sb.Outcome.OVERTURNED


def test_every_run_is_counted_once(found):
    codes = found["comparison"].to_numpy()
    np.testing.assert_array_equal(found["count"], [np.count_nonzero(codes == code) for code in range(5)])
    assert float(found["share"].sum()) == 1.0
    fallen = sb.Outcome.OVERTURNED
    both = (found["first_outcome"] == fallen) & (found["second_outcome"] == fallen)
    np.testing.assert_array_equal(both, codes == list(sb.studies.Comparison).index(sb.studies.Comparison.BOTH_OVERTURN))


def test_a_model_agrees_with_itself():
    same = sb.studies.outcome_differences(HELD, HELD, CIRCLE, over=OVER, periods=20.0)
    told = dict(zip([one.name for one in sb.studies.Comparison], same["count"].to_numpy(), strict=True))
    assert told["ONLY_FIRST"] == told["ONLY_SECOND"] == told["UNDECIDED"] == 0


def test_a_run_stopped_by_a_limit_is_undecided():
    stopped = sb.studies.outcome_differences(HELD, HELD, CIRCLE, over=OVER, periods=20.0, tilt_limit=0.01)
    assert int(stopped["count"][-1]) > 0
