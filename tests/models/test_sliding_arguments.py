"""What the column that can slip refuses, each in one line that names the argument."""

import math

import pytest

import stylobate as sb
from stylobate.errors import ParameterError

COLUMN = sb.Column.dimensionless(slenderness=0.2)


def refused(match, call):
    with pytest.raises(ParameterError, match=match) as found:
        call()
    assert "\n" not in str(found.value)


@pytest.mark.parametrize(
    ("name", "value", "match"),
    [
        ("friction_coefficient", -0.1, r"friction_coefficient must lie between 0 and 1e\+08"),
        ("friction_coefficient", math.inf, "friction_coefficient must lie between"),
        ("friction_coefficient", "rough", "friction_coefficient"),
        ("static_friction_coefficient", 0.4, "static_friction_coefficient must not be below the kinetic 0.5"),
        ("static_friction_coefficient", math.nan, "static_friction_coefficient must lie between"),
        ("patch", -0.1, "patch must be zero or positive"),
        ("patch", math.inf, "patch must"),
        ("normal_restitution", 1.1, "normal_restitution must lie between 0 and 1"),
        ("normal_restitution", -0.1, "normal_restitution must lie between 0 and 1"),
        ("damping", -0.1, "damping must be zero or positive"),
        ("spin_damping", -0.1, "spin_damping must be zero or positive"),
        ("rolling_resistance", -0.1, "rolling_resistance must be zero or positive"),
        ("passage_tilt", -0.1, "passage_tilt must lie between 0 and π/2"),
        ("incline", -0.1, "incline must lie between 0 and 1.57"),
        ("incline", math.pi / 2.0, "incline must lie between 0 and 1.57"),
        ("incline", math.nan, "incline must lie between 0 and 1.57"),
        ("incline_direction", math.inf, "incline_direction must be finite"),
    ],
)
def test_a_parameter_out_of_range_is_named(name, value, match):
    refused(match, lambda: sb.Sliding(COLUMN, **{name: value}))


def test_it_takes_a_column():
    refused("column must be a Column", lambda: sb.Sliding(0.2))


@pytest.mark.parametrize(
    ("options", "match"),
    [
        ({"clearance": -0.1}, "clearance must be zero or positive"),
        ({"clearance": math.nan}, "clearance must"),
        ({"velocity": (0.1, 0.0)}, "velocity must"),
        ({"velocity": (0.1, math.inf, 0.0)}, r"velocity\[1\] must be finite"),
        ({"velocity": (0.1, 0.0, -0.1)}, "velocity must not lead into the plane"),
        ({"spin": math.nan}, "spin must be finite"),
        ({"tilt": (1.6, 0.0)}, "tilt must be below π/2"),
        ({"friction_coefficient": 0.3}, "friction_coefficient must be given to model sliding itself"),
        ({"rtol": 1.0}, "rtol must lie between"),
    ],
)
def test_a_start_that_cannot_be_is_named(options, match):
    refused(match, lambda: sb.simulate(sb.Sliding(COLUMN), duration=1.0, **options))


@pytest.mark.parametrize("options", [{"velocity": (0.1, 0.0, 0.0)}, {"clearance": 0.1}])
def test_a_model_that_neither_slips_nor_flies_says_so(options):
    refused(next(iter(options)), lambda: sb.simulate(sb.Rolling(COLUMN), tilt=(0.05, 0.0), duration=1.0, **options))


def test_no_times_are_no_samples():
    run = sb.simulate(sb.Sliding(COLUMN), tilt=(0.1, 0.0), duration=1.0)
    assert run.sample([]).sizes["time"] == 0
