"""Numbers that differ between runs: each run is `simulate` of `with_parameters`, arrays go together by their names."""

import math

import numpy as np
import pytest
import xarray as xr

import stylobate as sb
from stylobate.engine.parameters import COLUMN_NAMES, MOTION_NAMES, model_names
from stylobate.errors import ParameterError, UnsupportedError

STONE = sb.Slender(sb.Column.solid(radius=0.5, height=10.0, density=2700.0), damping=0.1)
SHAKING = sb.Harmonic.elliptic(amplitude=(0.6, 0.3), phase=1.0, angular_frequency=2.0, start_phase=0.4)
START = {"tilt": (0.04, 0.01), "tilt_rate": (-0.01, 0.03), "duration": 8.0}

VALUES = {
    "radius": (0.45, 0.6),
    "mass_height": (4.0, 5.0),
    "mass": (20_000.0, 22_000.0),
    "transverse_inertia": (1.5e5, 2.0e5),
    "axial_inertia": (2000.0, 2700.0),
    "gravity": (1.62, 9.81),
    "slenderness": (0.08, 0.12),
    "size": (0.5, 2.0),
    "damping": (0.0, 0.3),
    "angular_frequency": (1.1, 3.3),
    "start_phase": (-2.0, 1.0),
    "acceleration": (0.0, 0.9),
    "scale": (-0.7, 1.2),
    "rotation": (-1.0, 2.5),
    "delay": (-0.8, 1.7),
    "offset_x": (-0.05, 0.1),
    "offset_y": (0.0, 0.12),
}


# Which motion it is has tests of its own.
OF_ONE_MOTION = tuple(name for name in MOTION_NAMES if name != "motion")


def test_every_name_has_values_here():
    assert set(VALUES) == {*COLUMN_NAMES, *OF_ONE_MOTION, *model_names(STONE)}


def expect_runs_as_alone(runs, outcome_in, end_of, ends_of):
    data = runs.together(rtol=1e-10)
    for index in range(len(runs)):
        single = runs.alone(index, rtol=1e-10)
        assert outcome_in(data, index) is single.outcome
        assert float(data["decided_at"][index]) == pytest.approx(single.decided_at, abs=1e-6)
        np.testing.assert_allclose(ends_of(data)[index], end_of(single), rtol=0.0, atol=1e-7)
    return data


@pytest.mark.parametrize("name", list(VALUES))
def test_a_run_with_a_number_changed_is_that_of_the_objects_with_it_changed(runs_of, outcome_in, end_of, ends_of, name):
    runs = runs_of(STONE, SHAKING, 2, **START, parameters={name: VALUES[name]})
    data = expect_runs_as_alone(runs, outcome_in, end_of, ends_of)
    # The first run is not the second.
    assert name in {"mass", "axial_inertia"} or not np.allclose(*ends_of(data), atol=1e-7)


def test_all_numbers_change_together_in_their_order(runs_of, outcome_in, end_of, ends_of):
    names = [name for name in VALUES if name not in {"radius", "mass_height", "transverse_inertia", "acceleration"}]
    parameters = {name: VALUES[name] for name in names}
    expect_runs_as_alone(runs_of(STONE, SHAKING, 2, **START, parameters=parameters), outcome_in, end_of, ends_of)
    moved = SHAKING.rotated(0.3).delayed(0.2).scaled(0.9)
    parameters = {name: VALUES[name] for name in OF_ONE_MOTION}
    expect_runs_as_alone(runs_of(STONE, moved, 2, **START, parameters=parameters), outcome_in, end_of, ends_of)


def test_arrays_go_together_by_the_names_of_their_dimensions(ends_of, end_of):
    frequency = xr.DataArray([1.5, 2.0, 3.0], dims="frequency", coords={"frequency": [1.5, 2.0, 3.0]})
    acceleration = xr.DataArray([0.2, 0.5], dims="level")
    tilt = xr.DataArray(
        [[0.01, 0.0], [0.02, 0.01], [0.03, 0.0], [0.0, 0.02]],
        dims=("start", "axis"),
        coords={"start": list("abcd"), "axis": ["x", "y"]},
    )
    duration = xr.DataArray([2.0, 4.0], dims="level")
    data = sb.simulate_ensemble(
        STONE,
        SHAKING,
        tilt=tilt,
        duration=duration,
        parameters={"angular_frequency": frequency, "acceleration": acceleration},
        rtol=1e-10,
    )
    assert dict(data["outcome"].sizes) == {"start": 4, "level": 2, "frequency": 3}
    assert list(data["start"].values) == list("abcd")
    np.testing.assert_array_equal(data["frequency"], frequency)
    np.testing.assert_array_equal(data["acceleration"], acceleration)
    one = data.isel(start=3, level=1, frequency=2)
    model, motion = sb.with_parameters(STONE, SHAKING, angular_frequency=3.0, acceleration=0.5)
    single = sb.simulate(model, motion, tilt=(0.0, 0.02), duration=4.0, samples=2, rtol=1e-10, recheck=False)
    np.testing.assert_allclose(ends_of(one), end_of(single), rtol=0.0, atol=1e-7)


def test_numbers_alone_make_one_run():
    data = sb.simulate_ensemble(STONE, SHAKING, tilt=(0.01, 0.0), duration=1.0, parameters={"damping": 0.2})
    assert dict(data["outcome"].sizes) == {"run": 1}


@pytest.mark.parametrize("shape", [(0,), (3, 0)])
def test_no_runs_are_an_empty_dataset_of_the_right_shape(shape):
    dims = ("level", "place")[: len(shape)]
    damping = xr.DataArray(np.empty(shape), dims=dims)
    data = sb.simulate_ensemble(STONE, SHAKING, duration=1.0, parameters={"damping": damping}, samples=3, strobes=2)
    assert data["outcome"].shape == shape
    assert data["end_tilt"].shape == (*shape, 2)
    assert data["sampled_tilt"].shape == (*shape, 3, 2)
    assert data["strobe_tilt"].shape == (*shape, 2, 2)
    empty = sb.simulate_ensemble(STONE, SHAKING, tilt=np.empty((0, 2)), duration=[], parameters={"damping": []})
    assert empty["outcome"].shape == (0,)


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        ({"parameters": {"damping": [0.1, 0.2, 0.3]}, "duration": [1.0, 2.0]}, "damping must have 2 values along run"),
        ({"parameters": {"damping": [0.1, 0.2]}, "tilt": np.zeros((3, 2))}, "damping must have 3 values along run"),
        ({"parameters": {"colour": 1.0}}, "colour is not known here; known are radius"),
        ({"parameters": {"scal": 1.0}}, r"^parameters: scal is not known here; did you mean scale\?$"),
        ({"parameters": {"damping": [0.1, math.nan]}}, "damping must be finite, got nan in run 1"),
        ({"parameters": {"delay": math.inf}}, "delay must be finite, got inf"),
        ({"parameters": {"acceleration": [math.nan]}}, "acceleration must be finite"),
        ({"tilt": [(0.01, math.nan)]}, "tilt must be finite"),
        ({"tilt_rate": (math.inf, 0.0)}, "tilt_rate must be finite"),
        ({"tilt_rate": (0.0, 0.0, 0.0)}, r"tilt_rate must have shape \(2,\) or \(n, 2\)"),
        ({"tilt": (5.0, 0.0)}, r"got 5\.0 rad\. For 5 deg give 0\.08727 rad\."),
        ({"duration": [1.0, math.nan]}, "duration must be finite"),
        ({"duration": math.inf}, "duration must be finite"),
        ({"duration": [1.0, 0.0]}, "duration must be positive, got 0.0"),
        ({"duration": [[1.0]]}, "duration must be a number, a list or a DataArray"),
        ({"duration": "long"}, "duration must be a number"),
        ({"parameters": {"damping": [0.1, -0.2]}}, "damping must be zero or positive, got -0.2"),
        ({"parameters": {"radius": [0.5, 0.0]}}, "radius must be positive"),
        ({"parameters": {"angular_frequency": [2.0, 0.0]}}, "angular_frequency must be positive, got 0.0"),
        ({"parameters": {"angular_frequency": -1.0}}, "angular_frequency must be positive, got -1.0"),
        ({"rtol": 0.5}, "rtol must lie between"),
        ({"max_steps": 0}, "max_steps must be"),
        ({"samples": 1}, "samples must be"),
        ({"strobes": -1}, "strobes must be"),
        ({"threads": 0}, "threads must be"),
        ({"tilt_limit": -0.1}, "tilt_limit must be positive"),
        ({"rest_energy": math.nan}, "rest_energy must be"),
        ({"rules": "strict"}, "rules must be"),
    ],
)
def test_what_no_run_can_have_is_refused_in_one_line_that_names_it(arguments, told):
    with pytest.raises(ParameterError, match=told) as caught:
        sb.simulate_ensemble(STONE, SHAKING, **{"duration": 1.0, **arguments})
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("motion", "values"),
    [
        (SHAKING + SHAKING, {"angular_frequency": 2.0}),
        (None, {"start_phase": 0.1}),
        (sb.Harmonic.vertical(acceleration=1.0, angular_frequency=2.0), {"acceleration": 1.0}),
    ],
)
def test_a_number_that_the_motion_lacks_is_told(motion, values):
    with pytest.raises(UnsupportedError, match=next(iter(values))):
        sb.simulate_ensemble(STONE, motion, duration=1.0, parameters=values)


def test_names_that_say_contrary_things_are_refused():
    with pytest.raises(ParameterError, match="with_parameters: size changes the radius, which"):
        sb.with_parameters(STONE, SHAKING, size=2.0, radius=0.4)
    with pytest.raises(ParameterError, match="with_parameters: colour is not known here"):
        sb.with_parameters(STONE, SHAKING, colour=2.0)


def test_numbers_that_vary_have_their_unit_and_name():
    runs = sb.simulate_ensemble(
        sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1),
        sb.Harmonic.circular(acceleration=0.065, angular_frequency=1.8),
        duration=1.0,
        parameters={"angular_frequency": [1.0, 1.8], "damping": [0.1, 0.2]},
    )
    assert runs["angular_frequency"].attrs == {"long_name": "angular frequency", "units": "rad s-1"}
    assert runs["damping"].attrs == {"long_name": "damping of tilting", "units": "1"}
