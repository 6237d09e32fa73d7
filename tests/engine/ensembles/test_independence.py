"""What a run amounts to does not depend, to the last bit, on the runs beside it or on how they are computed."""

import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st

import stylobate as sb
from stylobate.engine import ensemble

CIRCLE = sb.Harmonic.circular(acceleration=0.1, angular_frequency=2.0)
LINE = sb.Harmonic.straight(acceleration=0.1, angular_frequency=2.0)
OPTIONS = {"samples": 3, "strobes": 2}
COUNT = 97


def bits(data):
    """Return every number of every run as bytes, shape (runs, …)."""
    columns = [
        np.ascontiguousarray(variable.transpose("run", ...).to_numpy().reshape(data.sizes["run"], -1)).view(np.uint8)
        for name, variable in sorted(data.data_vars.items())
    ]
    return np.concatenate(columns, axis=1)


@pytest.fixture(scope="module", params=[CIRCLE, LINE], ids=["circle", "line"])
def runs(request, mixed_runs):
    return mixed_runs(request.param, COUNT, seed=5, **OPTIONS)


@pytest.fixture(scope="module")
def whole(runs):
    return bits(runs.together(threads=1))


def test_a_run_is_the_same_alone(runs, whole):
    for index in (0, 1, 15, 16, 17, 50, COUNT - 1):
        np.testing.assert_array_equal(bits(runs.part([index]).together())[0], whole[index])


@settings(max_examples=20)
@given(data=st.data())
def test_a_run_is_the_same_in_any_company_and_order(runs, whole, data):
    chosen = data.draw(st.lists(st.integers(0, COUNT - 1), min_size=1, max_size=60))
    np.testing.assert_array_equal(bits(runs.part(chosen).together()), whole[chosen])


@pytest.mark.parametrize("threads", [1, 2, 5])
@pytest.mark.parametrize("size", [1, 7, 33, 4096])
def test_a_run_is_the_same_in_parts_of_any_size_on_any_number_of_threads(runs, whole, monkeypatch, size, threads):
    monkeypatch.setattr(ensemble, "_FEWEST", size)
    monkeypatch.setattr(ensemble, "_MOST", size)
    assert len(ensemble.parts_of(COUNT, threads)) == -(-COUNT // size)
    np.testing.assert_array_equal(bits(runs.together(threads=threads)), whole)


def test_a_run_is_the_same_whether_its_numbers_are_given_once_or_for_each_run(runs):
    alike = {name: np.full(COUNT, value[3]) for name, value in runs.parameters.items()}
    each = sb.simulate_ensemble(
        runs.model, runs.motion, tilt=runs.tilt, tilt_rate=runs.tilt_rate, duration=60.0, parameters=alike, **OPTIONS
    )
    once = {name: float(value[3]) for name, value in runs.parameters.items()}
    shared = sb.simulate_ensemble(
        runs.model, runs.motion, tilt=runs.tilt, tilt_rate=runs.tilt_rate, duration=60.0, parameters=once, **OPTIONS
    )
    np.testing.assert_array_equal(bits(shared), bits(each))


def test_a_run_is_the_same_wherever_it_stands_in_a_grid(runs, whole):
    tilt = xr.DataArray(runs.tilt[:96].reshape(8, 12, 2), dims=("row", "place", "axis"))
    rate = xr.DataArray(runs.tilt_rate[:96].reshape(8, 12, 2).swapaxes(0, 1), dims=("place", "row", "axis"))
    values = {
        name: xr.DataArray(value[:96].reshape(8, 12), dims=("row", "place")) for name, value in runs.parameters.items()
    }
    grid = sb.simulate_ensemble(
        runs.model, runs.motion, tilt=tilt, tilt_rate=rate, duration=60.0, parameters=values, **OPTIONS
    )
    assert grid["outcome"].dims == ("row", "place")
    stacked = grid.drop_vars([name for name in grid.coords if name != "axis"]).stack(run=("row", "place"))
    np.testing.assert_array_equal(bits(stacked.reset_index("run")), whole[:96])


def test_looking_at_a_run_changes_its_steps_alone(runs):
    # Samples are times at which a step ends: the run is the same to the tolerance, not to the bit.
    plain, looked = runs.together(samples=None, strobes=0), runs.together()
    same = plain["outcome"] == looked["outcome"]
    assert float(same.mean()) > 0.98
    steady = same & (abs(plain["decided_at"] - looked["decided_at"]) < 1e-5)
    assert float(steady.mean()) > 0.9
