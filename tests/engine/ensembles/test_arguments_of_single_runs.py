"""An ensemble takes the arguments of a single run, with the same meaning."""

import numpy as np
import pytest
import xarray as xr

import stylobate as sb
from stylobate.errors import ParameterError

COLUMN = sb.Column.solid(radius=0.15, height=1.2, density=1000.0)
SLIDING = sb.Sliding(COLUMN, friction_coefficient=0.4, damping=0.1)
ROLLING = sb.Rolling(COLUMN, damping=0.1)
CIRCLE = sb.Harmonic.circular(acceleration=2.2, angular_frequency=5.0)
TILT, DURATION = (0.03, 0.01), 3.0
# One value of each initial condition, and another one.
FREE = {
    "twist": (0.7, -0.2),
    "position": ((0.3, -0.2), (0.0, 0.1)),
    "velocity": ((0.2, 0.1, 0.3), (0.0, 0.4, 0.0)),
    "clearance": (0.01, 0.02),
}
COMMON = ("outcome", "decided_at", "peak_tilt", "time_of_peak_tilt", "minimum_tilt", "turns", "steps")


def measures(run):
    """Return the measures of a single run that an ensemble has too."""
    own = {"outcome": int(run.outcome), "decided_at": run.decided_at, **run.measures}
    return {name: own[name] for name in (*COMMON, "impacts", "slips") if name in own}


def place(run):
    """Return footprint and twist at the end of a single run."""
    end = run.data.isel(time=-1)
    return [*end.footprint.to_numpy(), float(end.twist)]


def require_the_same(runs, run):
    """Require that a run of an ensemble is this single run."""
    for name, value in measures(run).items():
        assert runs[name].item() == value, name
    # The history ends with the polynomial of the last step, which rounds.
    np.testing.assert_allclose([*runs.end_footprint, runs.end_twist], place(run), rtol=1e-14, atol=1e-15)


ONE_BY_ONE = [{name: values[0]} for name, values in FREE.items()]
TOGETHER = {name: values[1] for name, values in FREE.items()}


@pytest.mark.parametrize("given", [*ONE_BY_ONE, TOGETHER])
def test_an_ensemble_of_one_run_equals_the_single_run_to_the_bit(given):
    run = sb.simulate(SLIDING, CIRCLE, tilt=TILT, duration=DURATION, recheck=False, **given)
    runs = sb.simulate_ensemble(SLIDING, CIRCLE, tilt=TILT, duration=DURATION, **given).isel(run=0)
    require_the_same(runs, run)
    usual = sb.simulate(SLIDING, CIRCLE, tilt=TILT, duration=DURATION, recheck=False)
    assert not np.allclose(place(run), place(usual))


@pytest.mark.parametrize("threads", [1, 2])
def test_runs_of_an_ensemble_differ_in_their_initial_conditions(threads):
    names = {name: np.array(values) for name, values in FREE.items()}
    runs = sb.simulate_ensemble(SLIDING, CIRCLE, tilt=TILT, duration=DURATION, threads=threads, **names)
    for k in (0, 1):
        given = {name: values[k] for name, values in FREE.items()}
        run = sb.simulate(SLIDING, CIRCLE, tilt=TILT, duration=DURATION, recheck=False, **given)
        require_the_same(runs.isel(run=k), run)
    np.testing.assert_array_equal(runs.velocity, FREE["velocity"])
    assert runs.velocity.dims == ("run", "component")


def test_initial_conditions_and_numbers_of_the_column_vary_together():
    position = xr.DataArray([(0.0, 0.0), (0.5, 0.2)], dims=("place", "axis"))
    friction = xr.DataArray([0.3, 0.5], dims="mu")
    runs = sb.simulate_ensemble(
        SLIDING, CIRCLE, tilt=TILT, duration=1.0, position=position, parameters={"friction_coefficient": friction}
    )
    moved = runs.end_footprint.isel(place=1) - runs.end_footprint.isel(place=0)
    np.testing.assert_allclose(moved.transpose("mu", "axis"), np.tile([0.5, 0.2], (2, 1)), atol=1e-12)


@pytest.mark.parametrize("given", [{"clearance": 0.01}, {"velocity": (0.1, 0.0, 0.0)}, {"clearance": -0.01}])
def test_an_ensemble_refuses_what_a_single_run_refuses(given):
    messages = []
    for simulate in (sb.simulate, sb.simulate_ensemble):
        with pytest.raises(ParameterError) as error:
            simulate(ROLLING, CIRCLE, tilt=TILT, duration=1.0, **given)
        messages.append(str(error.value))
    assert messages[0] == messages[1]


def test_a_friction_coefficient_marks_the_runs_that_need_more_friction():
    scales = np.array([0.2, 1.0])
    options = {"tilt": TILT, "duration": DURATION}
    demand = sb.simulate(ROLLING, CIRCLE, **options).measures["peak_friction_demand"]
    for coefficient in (0.9 * demand, 1.1 * demand):
        run = sb.simulate(ROLLING, CIRCLE, friction_coefficient=coefficient, recheck=False, **options)
        runs = sb.simulate_ensemble(ROLLING, CIRCLE, friction_coefficient=coefficient, **options).isel(run=0)
        assert bool(runs.would_slip) == (coefficient < demand) == any("slip" in warning for warning in run.warnings)
        for name in COMMON:
            assert runs[name].item() == measures(run)[name], name
    several = sb.simulate_ensemble(ROLLING, CIRCLE, friction_coefficient=demand * (1.0 + scales), **options)
    assert not several.would_slip.any()
    with pytest.raises(ParameterError, match="friction_coefficient"):
        sb.simulate_ensemble(ROLLING, CIRCLE, friction_coefficient=[0.3, 0.0], **options)
    with pytest.raises(ParameterError, match="must be given to model sliding itself"):
        sb.simulate_ensemble(SLIDING, CIRCLE, friction_coefficient=0.3, **options)
