"""A sweep is its runs, whatever the chunks, the store and the executor."""

import json

import numpy as np
import pytest
import xarray as xr

import stylobate as sb
from stylobate.errors import Interrupted, ParameterError, UnsupportedError
from stylobate.studies.sweeps import Dask, Sweep, Threads, run_sweep
from stylobate.studies.sweeps.chunks import Chunks
from stylobate.studies.sweeps.dask_executor import executor_from
from stylobate.studies.sweeps.store import open_sweep

MODEL = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
MOTION = sb.Harmonic.circular(acceleration=0.15, angular_frequency=1.0)


def test_a_grid_is_the_ensemble_of_its_runs(grid, undisturbed):
    data = undisturbed(grid)
    frequency, acceleration = xr.broadcast(data["angular_frequency"], data["acceleration"])
    runs = sb.simulate_ensemble(
        MODEL,
        MOTION,
        duration=1.5 * 2.0 * np.pi / frequency.values.ravel(),
        parameters={"angular_frequency": frequency.values.ravel(), "acceleration": acceleration.values.ravel()},
        strobes=2,
    )
    assert data["outcome"].dims == ("angular_frequency", "acceleration")
    assert data["end_tilt"].dims == ("angular_frequency", "acceleration", "axis")
    for name, array in runs.data_vars.items():
        np.testing.assert_array_equal(data[name].values.reshape(array.shape), array.values)
        assert data[name].attrs.keys() == array.attrs.keys()
    assert data["acceleration"].attrs["units"] == "m s-2"


def test_starts_are_where_the_sweep_says(points):
    data = run_sweep(points)
    for i, (duration, tilt_y, phase) in enumerate(
        zip(data["duration"].values, data["tilt_y"].values, data["start_phase"].values, strict=True)
    ):
        motion = sb.Harmonic.circular(acceleration=0.15, angular_frequency=1.0, start_phase=phase)
        run = sb.simulate_ensemble(MODEL, motion, tilt=(0.03, tilt_y), duration=duration, rtol=1e-6)
        np.testing.assert_allclose(data["end_tilt"][i], run["end_tilt"][0], rtol=1e-9)
        assert data["outcome"][i] == run["outcome"][0]


@pytest.mark.parametrize("chunk_size", [pytest.param(1, marks=pytest.mark.slow), 3])
def test_results_do_not_depend_on_the_chunks(sweep, chunk_size, tmp_path, assert_same_arrays, undisturbed):
    whole = undisturbed(sweep)
    assert_same_arrays(run_sweep(sweep, chunk_size=chunk_size), whole)
    assert_same_arrays(run_sweep(sweep, chunk_size=chunk_size, store=tmp_path / "sweep.zarr"), whole)


@pytest.mark.parametrize("stored", [True, False])
def test_progress_rises_from_nothing_to_all(grid, stored, tmp_path):
    told = []
    store = tmp_path / "sweep.zarr" if stored else None
    run_sweep(grid, store=store, chunk_size=6, progress=lambda done, total: told.append((done, total)))
    done = [number for number, _ in told]
    assert {total for _, total in told} == {grid.runs}
    assert done == sorted(done)
    assert (done[0], done[-1]) == (0, grid.runs)


def test_a_result_says_how_it_was_made(random, tmp_path):
    for data in (run_sweep(random), run_sweep(random, store=tmp_path / "sweep.zarr")):
        assert data.attrs["kind"] == "sweep"
        made = json.loads(data.attrs["provenance"])
        assert made["version"] == sb.__version__
        assert made["design"]["seed"] == 5
        assert made["design"]["values"]["damping"] == [0.0, 0.2]
        assert made["duration"] == 4.0
        assert made["motion"]["angular_frequency"] == 1.0
        assert data["outcome"].attrs["flag_meanings"].split()[0] == "NOT_COMPUTED"
        np.testing.assert_array_equal(data["outcome"].attrs["flag_values"], [-1, *sb.Outcome])


EMPTY = {
    "grid": Sweep.grid(MODEL, MOTION, over={"acceleration": [], "damping": [0.1, 0.2]}, duration=1.0),
    "random": Sweep.random(MODEL, MOTION, over={"damping": (0.1, 0.2)}, count=0, rng=1, duration=1.0),
    "points": Sweep.points(MODEL, MOTION, at={"angular_frequency": []}, periods=1.0),
}


# Nobody listens at this address: no worker is asked for the runs of an empty sweep.
@pytest.mark.parametrize("executor", [None, Dask(address="tcp://127.0.0.1:1")])
@pytest.mark.parametrize("kind", EMPTY)
def test_an_empty_sweep_has_an_empty_result_at_once(kind, executor, tmp_path, assert_same_arrays):
    sweep, path = EMPTY[kind], tmp_path / "sweep.zarr"
    data = run_sweep(sweep, executor=executor)
    assert data["outcome"].shape == sweep.shape
    assert data["outcome"].dims == sweep.dims
    assert data["end_tilt"].shape == (*sweep.shape, 2)
    assert_same_arrays(run_sweep(sweep, executor=executor, store=path), data)
    assert_same_arrays(run_sweep(sweep, executor=executor, store=path, resume=True), data)
    assert sweep.estimated_bytes() > 0


class StopAfter:
    """Ctrl-C after so many runs."""

    def __init__(self, runs):
        self.runs = runs

    def __call__(self, done, total):
        if done >= self.runs:
            raise KeyboardInterrupt


@pytest.mark.parametrize("after", [0, 8, 19])
def test_ctrl_c_keeps_what_was_computed(grid, after, undisturbed):
    whole = undisturbed(grid)
    with pytest.raises(Interrupted, match=r"stopped after \d+ of 20 runs; its result so far is \.partial") as stop:
        run_sweep(grid, chunk_size=6, progress=StopAfter(after))
    partial = stop.value.partial
    computed = (partial["outcome"] >= 0).values
    assert after <= computed.sum() < 20 or after == 19
    np.testing.assert_array_equal(partial["outcome"].values[computed], whole["outcome"].values[computed])
    np.testing.assert_array_equal(partial["end_tilt"].values[computed], whole["end_tilt"].values[computed])
    assert np.isnan(partial["end_tilt"].values[~computed]).all()


@pytest.mark.parametrize("after", [0, 8, 19])
def test_after_ctrl_c_a_store_goes_on_where_it_was(grid, after, tmp_path, assert_same_arrays, undisturbed):
    path = tmp_path / "sweep.zarr"
    with pytest.raises(Interrupted, match="resume=True continues") as stop:
        run_sweep(grid, store=path, chunk_size=6, progress=StopAfter(after))
    computed = int((stop.value.partial["outcome"] >= 0).sum())
    assert computed >= after
    data = run_sweep(grid, store=path, resume=True)
    assert_same_arrays(data, undisturbed(grid))


def test_ctrl_c_in_the_middle_of_writing_loses_nothing(grid, tmp_path, monkeypatch):
    path, writes = tmp_path / "sweep.zarr", []
    write = Chunks.write

    def interrupted_once(self, block, arrays, *, done):
        writes.append(block.index)
        if writes == [0, 1]:
            raise KeyboardInterrupt
        write(self, block, arrays, done=done)

    monkeypatch.setattr(Chunks, "write", interrupted_once)
    with pytest.raises(Interrupted):
        run_sweep(grid, store=path, chunk_size=5)
    assert open_sweep(path).attrs["runs_done"] == 10


def test_a_run_that_ctrl_c_left_complete_is_not_computed_again(grid, tmp_path, monkeypatch):
    path = tmp_path / "sweep.zarr"
    with pytest.raises(Interrupted) as stop:
        run_sweep(grid, store=path, chunk_size=6, progress=StopAfter(8))
    left = int((stop.value.partial["outcome"] < 0).sum())
    asked = []

    def counted(model, motion, *, tilt, **options):
        asked.append(len(tilt))
        return sb.simulate_ensemble(model, motion, tilt=tilt, **options)

    monkeypatch.setattr("stylobate.studies.sweeps.chunks.simulate_ensemble", counted)
    run_sweep(grid, store=path, resume=True)
    assert sum(asked) == left


@pytest.mark.parametrize(
    ("text", "executor"),
    [
        ("threads", Threads()),
        ("dask://", Dask()),
        ("dask://10.0.0.1:8786", Dask(address="tcp://10.0.0.1:8786")),
        ("dask://10.0.0.1:8786?wait=600", Dask(address="tcp://10.0.0.1:8786", wait=600.0)),
    ],
)
def test_an_executor_is_named_by_a_text(text, executor):
    assert executor_from(text) == executor


@pytest.mark.parametrize("text", ["", "dask", "processes", "tcp://10.0.0.1:8786"])
def test_a_text_that_names_no_executor_is_refused(text):
    with pytest.raises(ParameterError, match=r'executor must be "threads", "dask://" or "dask://host:port", got'):
        executor_from(text)


@pytest.mark.parametrize("wait", ["0", "-1", "nan", "soon", ""])
def test_a_wait_for_workers_is_a_positive_number_of_seconds(wait):
    with pytest.raises(ParameterError, match="wait"):
        executor_from(f"dask://10.0.0.1:8786?wait={wait}")


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        ({"resume": True}, "resume needs the store"),
        ({"chunk_size": 0}, "chunk_size must be a whole number of at least 1, got 0"),
        (
            {"executor": "dask"},
            r"executor must be Threads\(...\) or Dask\(...\), got 'dask'. Pass Dask\(address=",
        ),
        ({"store": ""}, "store must name the folder of a store, such as \"map.zarr\", or be None; got ''"),
        ({"store": 3}, "store must name the folder of a store, .* got 3"),
    ],
)
def test_bad_arguments_are_named(points, arguments, line):
    with pytest.raises(ParameterError, match=line):
        run_sweep(points, **arguments)


def test_bad_executors_are_named():
    with pytest.raises(ParameterError, match="threads must be a whole number of at least 1, got 0"):
        Threads(0)
    with pytest.raises(ParameterError, match="workers must be a whole number"):
        Dask(workers=0)
    with pytest.raises(ParameterError, match="one of address, workers and client, got address and workers"):
        Dask(address="tcp://10.0.0.1:8786", workers=2)
    with pytest.raises(ParameterError, match="sweep must be a Sweep"):
        run_sweep({"acceleration": [0.1]})


def test_a_name_that_no_run_knows_is_refused_before_anything_is_written(tmp_path):
    with pytest.raises(ParameterError, match="over: colour is not known here"):
        run_sweep(Sweep.grid(MODEL, MOTION, over={"colour": [1.0]}, duration=1.0), store=tmp_path / "sweep.zarr")
    assert not list(tmp_path.iterdir())


def test_without_dask_the_remedy_is_told(points, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "distributed", None)
    with pytest.raises(UnsupportedError, match=r'pip install "stylobate\[cluster\]"'):
        run_sweep(points, executor=Dask())


def test_an_unfinished_store_opens_with_holes(grid, tmp_path):
    path = tmp_path / "sweep.zarr"
    with pytest.raises(Interrupted):
        run_sweep(grid, store=path, chunk_size=5, progress=StopAfter(10))
    data = open_sweep(path)
    assert data.attrs["runs_done"] <= int((data["outcome"] >= 0).sum()) == 10
    assert np.isnan(data["peak_tilt"].values[data["outcome"].values < 0]).all()


def test_a_store_is_read_in_parts(grid, tmp_path, assert_same_arrays):
    data = run_sweep(grid, store=tmp_path / "sweep.zarr", chunk_size=5)
    row = open_sweep(tmp_path / "sweep.zarr").isel(angular_frequency=2)
    assert_same_arrays(row.load(), data.isel(angular_frequency=2).load())
    assert_same_arrays(open_sweep(tmp_path / "sweep.zarr", load=True), data)
    arrays = open_sweep(tmp_path / "sweep.zarr").chunk(angular_frequency=1)
    assert arrays["outcome"].chunks == ((1,) * 4, (5,))
    assert_same_arrays(arrays.compute(), data)
