"""The motion that is drawn is the motion that was computed."""

import dataclasses
import json
import math

import numpy as np
import pytest

import stylobate as sb
from stylobate.errors import ParameterError
from stylobate.plots.animation.motion import DrawnMotion, drawn_motion
from stylobate.plots.geometry import Shape

COLUMN = sb.Column.solid(radius=0.1, height=0.6, density=2700.0)
CIRCLE = sb.Harmonic.circular(acceleration=1.0, angular_frequency=9.0)
START = {"tilt": (0.1, 0.02), "tilt_rate": (0.0, 0.4)}


@pytest.fixture(scope="module")
def run():
    return sb.simulate(sb.Rolling(COLUMN, damping=0.05, spin_damping=0.1), CIRCLE, **START, spin=1.5, duration=2.0)


@pytest.fixture(scope="module")
def slid():
    model = sb.Sliding(COLUMN, friction_coefficient=0.08, damping=0.05, incline=0.05, incline_direction=1.0)
    return sb.simulate(model, **START, spin=2.0, clearance=0.02, duration=1.0)


def test_positions_and_angles_are_those_of_the_run(run):
    drawn = drawn_motion(run, frames_per_second=30.0)
    at = run.sample(np.linspace(0.0, 2.0, 61))
    for name, known in (
        ("tilt", "tilt"),
        ("tilt_rate", "tilt_rate"),
        ("twist", "twist"),
        ("spin", "spin"),
        ("footprint", "footprint"),
        ("contact_point", "contact_point"),
        ("base", "base_displacement"),
        ("friction_demand", "friction_demand"),
    ):
        # Seven digits are kept: half a unit of the last.
        np.testing.assert_allclose(drawn[name], at[known], rtol=5.01e-7, atol=1e-22, err_msg=name)
    assert drawn["column"]["slenderness"] == pytest.approx(COLUMN.slenderness)
    assert drawn["outcome"] == run.outcome.name


def test_the_path_of_the_pose_is_that_of_the_run_also_where_it_flies_and_slides(slid):
    motion = DrawnMotion.of(slid)
    flying = motion.clearance > 0.0
    assert flying.any()
    assert motion.on_rim.any()
    height = motion.centre[:, 2] - motion.shape.radius * np.sin(np.hypot(*motion.tilt.T))
    np.testing.assert_allclose(height, motion.clearance, atol=1e-14)
    assert not (motion.on_rim & flying).any()
    assert drawn_motion(slid)["plane"] == {"incline": 0.05, "incline_direction": 1.0}
    assert drawn_motion(slid)["friction_coefficient"] == 0.08


def axial_rate(rotation, step):
    """Body-frame angular velocity about the axis by central differences: 2 q* q̇, its z."""
    w, x, y, z = rotation[1:-1].T
    dw, dx, dy, dz = ((rotation[2:] - rotation[:-2]) / (2.0 * step)).T
    return 2.0 * (w * dz - z * dw - x * dy + y * dx)


@pytest.mark.parametrize("name", ["run", "slid"])
def test_the_rotation_turns_about_the_axis_by_the_spin_to_second_order(name, request):
    response = request.getfixturevalue(name)
    # Where nothing strikes: an impact changes rates at once.
    first = 0.0 if name == "run" else max(event.time for event in response.events if event.kind == "land") + 0.01
    errors = []
    for count in (201, 401):
        time = np.linspace(first, min(first + 0.2, float(response.data["time"][-1])), count)
        data = response.sample(time)
        rotation = sb.plots.geometry.quaternions(data["tilt"].to_numpy(), data["twist"].to_numpy())
        found = axial_rate(rotation, time[1] - time[0])
        errors.append(np.abs(found - data["spin"].to_numpy()[1:-1]).max())
    assert errors[1] < 1e-3
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.1)


def test_steps_are_equal_and_reach_from_start_to_end(run):
    drawn = drawn_motion(run, frames_per_second=7.0)
    time = np.array(drawn["time"])
    assert len(time) == 15
    np.testing.assert_allclose(np.diff(time), 1.0 / 7.0, rtol=1e-5)
    assert (time[0], time[-1]) == (0.0, 2.0)
    lengths = {len(values) for values in drawn.values() if isinstance(values, list)}
    assert lengths == {15}


def test_by_default_there_are_the_samples_of_the_run_and_never_more_than_2000(run):
    assert len(drawn_motion(run)["time"]) == run.data.sizes["time"]
    assert len(drawn_motion(run, frames_per_second=1e5)["time"]) == 2000


def test_text_of_it_is_strict_json_with_seven_digits(run):
    demand = run.data["friction_demand"].copy()
    demand[3] = np.inf
    text = json.dumps(
        drawn_motion(dataclasses.replace(run, data=run.data.assign(friction_demand=demand))), allow_nan=False
    )
    again = json.loads(text)
    assert again["friction_demand"][3] is None
    for number in again["tilt"][7]:
        assert number == float(f"{number:.7g}")
        assert number != 0.0


def test_a_loaded_run_is_drawn_from_its_samples(run, tmp_path):
    again = sb.load(run.save(tmp_path / "run.nc"))
    assert drawn_motion(again) == drawn_motion(run)
    time, tilt = run.data["time"].to_numpy(), run.data["tilt"].to_numpy()
    between = DrawnMotion.of(again, frames_per_second=33.0)
    np.testing.assert_allclose(between.tilt[:, 0], np.interp(between.time, time, tilt[:, 0]), rtol=1e-12)
    # The contact point stays on the circle: it is not cut across.
    radius = np.hypot(*(between.contact_point - between.footprint).T)
    np.testing.assert_allclose(radius, COLUMN.radius, rtol=1e-12)


def test_a_column_that_stands_touches_with_its_whole_base_and_keeps_its_contact_point():
    run = sb.simulate(sb.Rolling(COLUMN, damping=0.3), tilt=(0.0, 0.05), duration=10.0)
    assert run.outcome is sb.Outcome.AT_REST
    motion = DrawnMotion.of(dataclasses.replace(run, data=run.data))
    assert motion.resting[-1]
    still = sb.simulate(sb.Rolling(COLUMN), duration=1.0)
    drawn = drawn_motion(still)
    assert set(drawn["resting"]) == {1}
    assert np.isfinite(drawn["contact_point"]).all()


def test_a_column_that_slides_upright_rests_on_its_whole_base():
    model = sb.Sliding(COLUMN, friction_coefficient=0.1)
    run = sb.simulate(model, velocity=(0.5, 0.0, 0.0), duration=0.3)
    drawn = drawn_motion(run)
    assert set(drawn["resting"]) == {1}
    assert drawn["centre"][-1] == [drawn["footprint"][-1][0], 0.0, 0.0]
    assert drawn["footprint"][-1][0] > 0.0


def test_a_planar_column_has_no_twist_and_a_footprint_that_stays():
    line = sb.Harmonic.straight(acceleration=5.0, angular_frequency=9.0)
    drawn = drawn_motion(sb.simulate(sb.PlanarRocking(COLUMN), line, tilt=(0.05, 0.0), duration=1.0))
    assert drawn["spin"] is None
    assert drawn["clearance"] is None
    assert set(drawn["twist"]) == {0.0}
    assert np.ptp(drawn["footprint"], axis=0).max() == 0.0


def test_of_a_column_that_overturns_the_fall_is_not_invented():
    push = sb.Harmonic.circular(acceleration=6.0, angular_frequency=3.0)
    run = sb.simulate(sb.Slender(COLUMN), push, duration=20.0)
    assert run.outcome is sb.Outcome.OVERTURNED
    drawn = drawn_motion(run)
    assert drawn["time"][-1] == pytest.approx(run.decided_at, rel=1e-6)
    assert math.hypot(*drawn["tilt"][-1]) < 0.5 * math.pi
    assert drawn["title"].startswith("overturned: ")


def shape_of(column):
    return Shape.of(sb.simulate(sb.Slender(column), duration=0.1))


def test_a_frustum_is_known_by_its_mass_and_inertia():
    found = shape_of(sb.Column.frustum(radius=0.5, top_radius=0.3, height=3.0, density=2000.0))
    assert (found.radius, found.height) == (0.5, 3.0)
    assert found.top_radius == pytest.approx(0.3, rel=1e-9)


@pytest.mark.parametrize(
    "column",
    [
        sb.Column.solid(radius=0.5, height=3.0, density=2000.0),
        sb.Column.hollow(radius=0.5, inner_radius=0.3, height=3.0, density=2000.0),
        sb.Column(radius=0.5, mass_height=1.0, mass=1.0, transverse_inertia=0.5, axial_inertia=0.05, height=3.0),
        sb.Column(radius=0.5, mass_height=0.4, mass=1.0, transverse_inertia=0.5, axial_inertia=0.05, height=3.0),
        sb.Column.dimensionless(0.1),
    ],
)
def test_all_others_are_drawn_as_cylinders(column):
    found = shape_of(column)
    assert found.top_radius == found.radius
    assert found.height == (column.height or 2.0 * column.mass_height)


@pytest.mark.parametrize("rate", [0.0, -5.0, math.nan, "fast"])
def test_a_rate_that_is_not_positive_is_refused(run, rate):
    with pytest.raises(ParameterError, match=r"^frames_per_second must be"):
        drawn_motion(run, frames_per_second=rate)


def test_what_is_no_run_is_refused():
    with pytest.raises(ParameterError, match="run must be a run, as simulate returns it, got int"):
        drawn_motion(3)


def test_a_run_of_one_sample_is_refused(run):
    with pytest.raises(ParameterError, match="run must have 2 samples at least, got 1"):
        drawn_motion(dataclasses.replace(run, data=run.data.isel(time=[0])))
