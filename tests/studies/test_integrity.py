"""Integrity: the distance to overturning is exact on its grid, and says where it is a bound."""

import numpy as np
import pytest
import xarray as xr

import stylobate as sb
from stylobate.errors import Outcome, ParameterError
from stylobate.studies.maps.integrity import Metric, distance_to_overturning

FREE = sb.Slender(sb.Column.dimensionless(0.1))
OVERTURNED, SAFE = Outcome.OVERTURNED, Outcome.AT_REST


def grid(codes, **axes):
    return xr.DataArray(np.array(codes, dtype=np.int8), coords=axes, dims=tuple(axes))


def test_a_free_column_without_friction_is_safe_in_a_diamond():
    # In its plane it falls if |x|/c + |v|/(cω0) > 1, from starts below the tipping angle. No start stands on that edge.
    scaled = np.linspace(-0.97, 0.97, 36)
    over = {"tilt_x": 0.1 * scaled, "tilt_rate_x": 0.1 * scaled}
    found = sb.studies.integrity(FREE, over=over, duration=25.0)
    x, v = np.meshgrid(scaled, scaled, indexing="ij")
    falls = np.abs(x) + np.abs(v) > 1.0
    np.testing.assert_array_equal(found["outcome"] == OVERTURNED, falls)
    assert float(found["distance"]) == pytest.approx(np.hypot(x, v)[falls].min(), rel=1e-12)
    assert float(found["distance_low"]) < np.sqrt(0.5) < float(found["distance_high"]) == float(found["distance"])
    assert float(found["resolution"]) == pytest.approx(0.97 / 17.5 / np.sqrt(2.0), rel=1e-12)
    assert not bool(found["at_least"])
    assert np.abs(found["nearest"].values).sum() > 0.1


@pytest.mark.slow
def test_a_straight_boundary_lies_between_the_ends_of_its_distance():
    axis = np.linspace(-3.0, 3.0, 41)
    metric = Metric.of(FREE, {"tilt_x": 0.1 * axis, "tilt_y": 0.1 * axis}, None)
    x, y = np.meshgrid(axis, axis, indexing="ij")
    rng = np.random.default_rng(0)
    excess = []
    for angle, truth in zip(rng.uniform(0.0, 2.0 * np.pi, 500), rng.uniform(0.5, 2.0, 500), strict=True):
        codes = np.where(x * np.cos(angle) + y * np.sin(angle) >= truth, OVERTURNED, SAFE)
        found = distance_to_overturning(grid(codes, tilt_x=axis, tilt_y=axis), metric)
        assert found["distance_low"] <= truth <= found["distance_high"]
        excess.append((float(found["distance"]) - truth) / metric.resolution)
    # Half a diagonal would not do.
    assert 1.0 < max(excess) < 2.0


@pytest.mark.parametrize("outcome", [Outcome.FAILED, Outcome.LIFTED_OFF, Outcome.LIMIT_REACHED])
def test_a_run_that_ends_before_it_is_told_is_not_safe(outcome):
    axis = 0.1 * np.linspace(-1.0, 1.0, 5)
    metric = Metric.of(FREE, {"tilt_x": axis}, None)
    found = distance_to_overturning(grid([OVERTURNED, SAFE, SAFE, outcome, SAFE], tilt_x=axis), metric)
    assert bool(found["at_least"])
    assert float(found["distance"]) == pytest.approx(0.5, rel=1e-12)
    assert float(found["distance_high"]) == np.inf


def test_a_tilt_limit_is_refused():
    with pytest.raises(ParameterError, match=r"tilt_limit must be left out: .* got 0\.2 rad"):
        sb.studies.integrity(FREE, over={"tilt_x": [-0.1, 0.1]}, duration=1.0, tilt_limit=0.2)
    with pytest.raises(ParameterError, match="tilt_limit"):
        sb.studies.erosion(FREE, along={"damping": [0.1]}, over={"tilt_x": [-0.1, 0.1]}, duration=1.0, tilt_limit=0.2)


def test_distances_are_in_c_and_its_rate_whatever_the_column():
    stone = sb.Slender(sb.Column.solid(radius=0.5, height=10.0, density=2700.0))
    c, scale = stone.column.slenderness, stone.column.frequency_scale
    axis = np.array([0.0, 0.5, 1.0])
    metric = Metric.of(stone, {"tilt_x": c * axis, "tilt_rate_y": c * scale * axis}, None)
    expected = np.hypot(*np.meshgrid(axis, axis, indexing="ij"))
    np.testing.assert_allclose(metric.distances(("tilt_x", "tilt_rate_y")), expected, rtol=1e-14)
    assert metric.resolution == pytest.approx(0.5 / np.sqrt(2.0), rel=1e-14)


def test_a_grid_where_nothing_overturns_gives_a_lower_bound():
    axis = 0.1 * np.array([-0.4, 0.0, 0.3])
    metric = Metric.of(FREE, {"tilt_x": axis}, None)
    found = distance_to_overturning(grid([SAFE] * 3, tilt_x=axis), metric)
    assert bool(found["at_least"])
    assert float(found["distance"]) == pytest.approx(0.3, rel=1e-12)
    assert np.isnan(found["nearest"]).all()


def test_a_start_that_is_not_known_bounds_the_distance():
    axis = 0.1 * np.linspace(-1.0, 1.0, 5)
    metric = Metric.of(FREE, {"tilt_x": axis}, None)
    found = distance_to_overturning(grid([OVERTURNED, SAFE, SAFE, -1, SAFE], tilt_x=axis), metric)
    assert bool(found["at_least"])
    assert float(found["distance"]) == pytest.approx(0.5, rel=1e-12)


def test_the_start_phase_counts_for_no_distance():
    axis, phases = 0.1 * np.linspace(-1.0, 1.0, 5), np.array([0.0, 1.0])
    metric = Metric.of(FREE, {"start_phase": phases, "tilt_x": axis}, {"tilt_x": 0.01})
    codes = [[OVERTURNED, SAFE, SAFE, SAFE, SAFE], [SAFE, SAFE, SAFE, OVERTURNED, SAFE]]
    found = distance_to_overturning(grid(codes, start_phase=phases, tilt_x=axis), metric)
    assert float(found["distance"]) == pytest.approx(0.4, rel=1e-12)
    assert found["nearest"].values.tolist() == [axis[3]]


def test_friction_makes_a_free_column_safer():
    axis = 0.1 * np.linspace(-1.4, 1.4, 30)
    found = sb.studies.erosion(
        FREE, along={"damping": [0.0, 1.0]}, over={"tilt_x": axis, "tilt_rate_x": axis}, duration=25.0
    )
    assert found["distance"].dims == ("damping",)
    assert float(found["integrity"][0]) == 1.0
    assert float(found["integrity"][1]) > 1.0
    assert ((found["integrity_low"] < found["integrity"]) & (found["integrity"] < found["integrity_high"])).all()
    np.testing.assert_allclose(found["integrity"], found["distance"] / found["distance"][0], rtol=1e-15)
    np.testing.assert_array_equal(found["integrity_low"], found["distance_low"] / found["distance_high"][0])
    np.testing.assert_array_equal(found["integrity_high"], found["distance_high"] / found["distance_low"][0])
    assert found.attrs["kind"] == "erosion"


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"over": {"tilt_x": [0.1, 0.0]}}, "increasing"),
        ({"over": {"tilt_x": [-0.1, 0.1], "start_phase": []}}, "at least one value"),
        ({"over": {"start_phase": [0.1, 0.2]}}, "at least one of tilt_x"),
        ({"over": {"damping": [0.1, 0.2]}}, "damping"),
        ({"reference": {"tilt_x": 0.5}}, "reference"),
        ({"reference": {"tilt_y": 0.0}}, "reference"),
    ],
)
def test_bad_input_is_named(change, message):
    arguments = {"over": {"tilt_x": [-0.1, 0.1]}, "duration": 1.0} | change
    with pytest.raises(ParameterError, match=message):
        sb.studies.integrity(FREE, **arguments)


@pytest.mark.parametrize("along", [{"slenderness": [0.1]}, {"gravity": [9.8]}, {"start_phase": [0.0]}])
def test_erosion_is_along_what_leaves_the_units(along):
    with pytest.raises(ParameterError, match="along must name a parameter of the model or the base motion"):
        sb.studies.erosion(FREE, along=along, over={"tilt_x": [-0.1, 0.1]}, duration=1.0)
