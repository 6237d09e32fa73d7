"""Maps whose runs start on a branch of steady rolling, each on that of its own motion."""

import numpy as np
import pytest

import stylobate as sb
from stylobate.errors import Outcome, ParameterError
from stylobate.lab.grids import OFF_BRANCH, grid, starts_on_branch
from stylobate.lab.requests import GRIDS

CASE = {
    "column": {"shape": "dimensionless", "slenderness": 0.1},
    "model": {"kind": "slender", "damping": 0.1},
    "motion": {"kind": "circular", "acceleration": 0.065, "angular_frequency": 1.8},
    "periods": 200,
}
AXES = {
    "x": {"name": "angular_frequency", "from": 1.2, "to": 2.0, "number": 5},
    "y": {"name": "acceleration", "from": 0.06, "to": 0.07, "number": 3},
}


def map_from(start, **changes):
    values = {**CASE, "map": AXES, **changes} | ({} if start is None else {"start": start})
    return np.array(grid(GRIDS["map"], values, lambda _: None).codes)


def test_columns_roll_above_the_critical_frequency_and_leave_the_branch_below_it():
    codes = map_from("upper")
    assert np.all(codes[2:] == Outcome.ROLLING)  # 1.6 and more; the critical frequency is 1.397 at 0.065
    assert np.all(codes[0] == Outcome.OVERTURNED)


def test_the_start_of_the_case_is_another_one():
    assert np.all(map_from(None) == Outcome.AT_REST)  # it stands


def test_each_start_is_that_of_its_own_motion_a_little_off_the_branch():
    setup = sb.config.study_config(GRIDS["map"]).parse({**CASE, "map": AXES}).build()
    found = starts_on_branch(setup, {**CASE, "map": AXES}, "lower")
    motion = sb.Harmonic.circular(acceleration=0.065, angular_frequency=1.6)
    wanted = sb.studies.steady_start(setup.model, motion, branch="lower")
    place = 2 * 3 + 1
    assert [found["tilt_x"][place], found["tilt_y"][place]] == pytest.approx(
        [(1.0 + OFF_BRANCH) * one for one in wanted["tilt"]]
    )
    assert [found["tilt_rate_x"][place], found["tilt_rate_y"][place]] == pytest.approx(list(wanted["tilt_rate"]))


def test_a_motion_without_a_branch_is_refused():
    pulse = {"kind": "half_sine", "acceleration": 0.2, "angular_frequency": 2.0}
    with pytest.raises(ParameterError, match="horizontal harmonic motion for a start on a branch"):
        map_from("upper", motion=pulse, periods=None)
