"""Figures of the ladder, and of the column on its path, show what their results hold."""

import math

import numpy as np
import pytest

import stylobate as sb
from stylobate.errors import ParameterError
from stylobate.plots.body import MARKED, FlutedColumn, ring
from stylobate.plots.geometry import Shape, View, base_centres, frames, hull, quaternions

COLUMN = sb.Column.dimensionless(slenderness=0.1)
CIRCLE = sb.Harmonic.circular(acceleration=0.065, angular_frequency=1.8)
CASE = {"damping": 0.1, "spin_damping": 0.1, "tilt": (0.04, 0.0), "tilt_rate": (0.0, 0.07), "duration": 10.0}


@pytest.fixture(scope="module")
def run():
    model = sb.Rolling(COLUMN, damping=0.1, spin_damping=0.1)
    return sb.simulate(model, CIRCLE, tilt=(0.04, 0.0), tilt_rate=(0.0, 0.07), twist=0.4, duration=10.0)


def test_histories_of_all_levels_lie_over_one_another():
    found = sb.studies.model_hierarchy(COLUMN, CIRCLE, **CASE, samples=100)
    tilt, spin, *_ = sb.plot(found).axes
    for line, model in zip(tilt.lines, found["model"].to_numpy(), strict=False):
        np.testing.assert_array_equal(line.get_ydata(), found["amplitude"].sel(model=model))
    assert len(spin.lines) == 2  # models that may turn


def test_several_slendernesses_show_convergence():
    found = sb.studies.model_hierarchy(COLUMN, CIRCLE, **CASE, slenderness=[0.2, 0.1])
    convergence, late = sb.plot(found).axes
    assert convergence.get_yscale() == "log"
    expected = found["deviation"].sel(model="slender", other_model="rolling") / found["slenderness"]
    np.testing.assert_allclose(convergence.lines[0].get_ydata(), expected[::-1])
    assert len(late.lines) == found.sizes["model"]


def test_one_slenderness_shows_that_case_alone():
    found = sb.studies.model_hierarchy(COLUMN, CIRCLE, **CASE, slenderness=[0.2])
    tilts, demands = sb.plot(found).axes
    assert {tilts.get_xscale(), demands.get_xscale(), tilts.get_yscale()} == {"linear"}
    top = float(found["peak_tilt"].sel(model="slender")[0]) / 0.2
    assert tilts.lines[0].get_xdata() == pytest.approx([top])


def test_demands_are_shown_beside_the_coefficient():
    found = sb.studies.model_hierarchy(COLUMN, CIRCLE, **CASE, friction_coefficient=0.05)
    _, demands = sb.plot(found).axes
    assert any(np.allclose(line.get_xdata(), 0.05) for line in demands.lines)


def test_differences_of_outcomes_name_the_models():
    over = {"angular_frequency": [2.0, 5.0], "acceleration": [0.05, 0.25]}
    model = sb.Slender(COLUMN, damping=0.1)
    found = sb.studies.outcome_differences(model, model, CIRCLE, over=over, periods=20.0)
    told = [text.get_text() for text in sb.plot(found).legends[0].get_texts()]
    assert [text.rsplit("  ", 1)[0] for text in told] == ["overturns in neither", "overturns in both"]


def test_a_leaning_cylinder_touches_the_base_at_the_contact_point(run):
    for index in (0, 137, -1):
        at = run.data.isel(time=index)
        tilt, frame = at["tilt"].to_numpy(), frames(quaternions(at["tilt"], float(at["twist"])))
        centre = base_centres(tilt, at["footprint"].to_numpy(), COLUMN.radius)
        circle = ring(np.linspace(0.0, 2.0 * math.pi, 181), COLUMN.radius, 0.0) @ frame.T + centre
        # 181 points on the rim: the lowest of them is within a quarter of a step of the contact point.
        lowest = circle[np.argmin(circle[:, 2])]
        assert abs(lowest[2]) < 1e-4 * COLUMN.radius
        np.testing.assert_allclose(lowest[:2], at["contact_point"], atol=0.02 * COLUMN.radius)
        np.testing.assert_allclose(frame.T @ frame, np.eye(3), atol=1e-14)
        assert math.acos(frame[2, 2]) == pytest.approx(float(at["amplitude"]), rel=1e-8)


def test_the_mark_on_an_upright_column_tells_its_twist():
    column = FlutedColumn.of(Shape(radius=1.0, top_radius=1.0, height=3.0, mass_height=1.5, slenderness=2.0 / 3.0))
    mark = column.top[column.wedge].mean(axis=0) @ frames(quaternions(np.zeros(2), 0.7)).T - [0.0, 0.0, 3.0]
    turned = MARKED + 0.7
    along = mark / np.linalg.norm(mark)
    np.testing.assert_allclose(along, [math.cos(turned), math.sin(turned), 0.0], atol=1e-15)


def test_a_view_from_above_keeps_lengths_and_a_view_from_the_side_heights():
    points = np.array([[0.0, 0.0, 0.0], [3.0, 4.0, 0.0], [0.0, 0.0, 2.0]])
    above = View(0.3, math.pi / 2.0).project(points)
    assert math.dist(above[0], above[1]) == pytest.approx(5.0)
    assert math.dist(above[0], above[2]) == pytest.approx(0.0, abs=1e-15)
    side = View(0.3, 0.0).project(points)
    assert side[2, 1] - side[0, 1] == pytest.approx(2.0)


def test_an_outline_covers_the_cylinder():
    tilt, view = np.array([0.3, 0.1]), View()
    around = np.linspace(0.0, 2.0 * math.pi, 181)
    low, middle, high = (
        ring(around, 0.5, height) @ frames(quaternions(tilt, 0.0)).T + base_centres(tilt, np.zeros(2), 0.5)
        for height in (0.0, 1.0, 2.0)
    )
    corners = hull(view.project(np.concatenate([low, high])))
    edges = np.roll(corners, -1, axis=0) - corners
    for point in view.project(np.concatenate([low, middle, high])):
        offsets = point - corners
        assert np.all(edges[:, 0] * offsets[:, 1] - edges[:, 1] * offsets[:, 0] > -1e-12)


def test_the_path_from_above_is_that_of_the_contact_point(run):
    plan = sb.plots.plot_column_path(run, times=[0.0, 2.0, 5.0]).axes[1]
    contact, footprint = plan.lines[0].get_xydata(), plan.lines[1].get_xydata()
    np.testing.assert_allclose(np.hypot(*(contact - footprint).T), COLUMN.radius)
    np.testing.assert_allclose(contact[0], run.data["contact_point"][0])
    np.testing.assert_allclose(contact[-1], run.sample(5.0)["contact_point"][0], atol=1e-12)
    assert {text.get_text() for text in plan.texts} == {"0", "2", "5"}


def test_a_saved_run_is_drawn_from_its_samples(run, tmp_path):
    again = sb.load(run.save(tmp_path / "run.nc"))
    plan = sb.plots.plot_column_path(again).axes[1]
    np.testing.assert_array_equal(plan.lines[0].get_xydata(), run.data["contact_point"])


@pytest.mark.parametrize("times", [[], [-1.0, 2.0], [5.0, 20.0], [0.0]])
def test_times_outside_the_run_are_refused(run, times):
    with pytest.raises(ParameterError, match="times and until must lie within the run"):
        sb.plots.plot_column_path(run, times=times)
