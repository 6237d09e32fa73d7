"""A sweep on workers of Dask: its arrays are those of threads, whatever happens to workers and scheduler."""

import os
import signal
import subprocess
import sys

import dask
import pytest
import xarray as xr

import stylobate as sb
from stylobate.errors import StylobateError
from stylobate.studies.sweeps import Dask, Sweep, run_sweep
from stylobate.studies.sweeps.dask_executor import executor_from

MODEL = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
MOTION = sb.Harmonic.circular(acceleration=0.15, angular_frequency=1.0)


@pytest.fixture(scope="module")
def client():
    """Connect to a cluster of two processes; only tests of this file use it, so that it is started once."""
    import distributed

    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address="127.0.0.1:0") as cluster,
        distributed.Client(cluster, set_as_default=False) as client,
    ):
        yield client


def test_workers_compute_what_threads_do(sweep, client, tmp_path, assert_same_arrays, undisturbed, counting):
    whole = undisturbed(sweep)
    workers = counting(Dask(client=client))
    assert_same_arrays(run_sweep(sweep, executor=workers, chunk_size=3), whole)
    assert sorted(workers.blocks) == list(range(len(workers.blocks)))
    assert_same_arrays(run_sweep(sweep, executor=workers, chunk_size=3, store=tmp_path / "sweep.zarr"), whole)


def test_a_scheduler_is_reached_by_its_address(points, client, assert_same_arrays, undisturbed):
    executor = executor_from(client.scheduler.address.replace("tcp://", "dask://"))
    assert_same_arrays(run_sweep(points, executor=executor, chunk_size=1), undisturbed(points))


def test_short_blocks_travel_together(client, counting, monkeypatch):
    sweep, sent, submit = Sweep.points(MODEL, MOTION, at={"tilt_x": [0.01] * 150}, duration=0.01), [], client.submit

    def counted(*arguments, **options):
        sent.append(options["key"])
        return submit(*arguments, **options)

    monkeypatch.setattr(client, "submit", counted)
    workers = counting(Dask(client=client))
    run_sweep(sweep, executor=workers, chunk_size=1)
    assert sorted(workers.blocks) == list(range(150))
    assert len(sent) < 75


def test_a_result_is_saved_while_a_dask_client_is_active(client, tmp_path):
    run = sb.simulate(MODEL, MOTION, tilt=(0.01, 0.0), duration=1.0)
    with client.as_current():
        assert dask.base.get_scheduler().__self__ is client
        loaded = sb.load(run.save(tmp_path / "run.nc"))
    xr.testing.assert_identical(loaded.data, run.data)


def test_a_mistake_in_a_worker_is_told_here(client):
    class Broken(sb.base_motions.BaseMotion):
        def derivative(self, time, order):
            message = "the record is empty"
            raise RuntimeError(message)

        def peak_horizontal(self, since=0.0):
            return 0.1

        def vertical_range(self, since=0.0):
            return 0.0, 0.0

        def directions(self):
            return ((1.0, 0.0), (0.0, 1.0))

    sweep = Sweep.points(MODEL, Broken(), at={"tilt_x": [0.01, 0.02]}, duration=1.0)
    with pytest.raises(RuntimeError, match="the record is empty"):
        run_sweep(sweep, executor=Dask(client=client))


class Through:
    """An executor that hands a changed `work` on."""

    def __init__(self, inner, change):
        self.inner, self.change = inner, change

    def results(self, work, tasks, progress=None):
        return self.inner.results(self.change(work), tasks, progress)


@pytest.mark.posix
@pytest.mark.parametrize("moment", ["before", pytest.param("after", marks=pytest.mark.slow)])
@pytest.mark.parametrize("stored", [True, pytest.param(False, marks=pytest.mark.slow)])
def test_a_worker_killed_in_the_middle_changes_nothing(
    grid, client, tmp_path, assert_same_arrays, counting, undisturbed, moment, stored
):
    once = tmp_path / "killed"

    def change(work):
        # Local, so that it travels to the workers by value.
        def fragile(task, *, threads, progress):
            if moment == "after":
                work(task, threads=threads, progress=progress)
            if task.block.index == 2 and not once.exists():
                once.touch()
                os.kill(os.getpid(), signal.SIGKILL)
            return work(task, threads=threads, progress=progress)

        return fragile

    executor = counting(Through(Dask(client=client), change))
    data = run_sweep(grid, executor=executor, chunk_size=2, store=tmp_path / "sweep.zarr" if stored else None)
    assert once.exists()
    assert sorted(executor.blocks) == list(range(len(executor.blocks)))
    assert_same_arrays(data, undisturbed(grid))


@pytest.mark.posix
@pytest.mark.slow
def test_a_chunk_that_kills_every_worker_is_named(points, client):
    def change(work):
        def deadly(task, *, threads, progress):
            if task.block.index == 1:
                os.kill(os.getpid(), signal.SIGKILL)
            return work(task, threads=threads, progress=progress)

        return deadly

    with pytest.raises(StylobateError, match=r"4 workers died on chunk 1 of 1 runs\. Give them more memory, or"):
        run_sweep(points, executor=Through(Dask(client=client), change), chunk_size=1)


@pytest.mark.slow
def test_a_lost_scheduler_is_told_and_the_store_goes_on(grid, tmp_path, assert_same_arrays, undisturbed):
    address, path = "127.0.0.1:38786", tmp_path / "sweep.zarr"
    executor = Dask(address="tcp://" + address, wait=60.0)  # both processes import Dask first
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    dask = [sys.executable, "-m", "dask"]
    scheduler = subprocess.Popen([*dask, "scheduler", "--host", "tcp://" + address, "--no-dashboard"], **quiet)
    worker = subprocess.Popen([*dask, "worker", "tcp://" + address, "--nthreads", "1", "--no-dashboard"], **quiet)

    def lose(done, total):
        if done:
            scheduler.kill()

    with scheduler, worker:
        try:
            with pytest.raises(StylobateError, match="the Dask scheduler was lost"):
                run_sweep(grid, store=path, executor=executor, chunk_size=1, progress=lose)
        finally:
            scheduler.kill()
            worker.kill()
    assert_same_arrays(run_sweep(grid, store=path, resume=True), undisturbed(grid))


@pytest.mark.long
def test_a_scheduler_that_does_not_answer_is_named(points):
    with pytest.raises(StylobateError, match=r"no Dask scheduler answers at tcp://127\.0\.0\.1:1"):
        run_sweep(points, executor=Dask(address="tcp://127.0.0.1:1", wait=0.5))


@pytest.mark.slow
def test_workers_compute_the_objects_of_an_inventory_as_threads_do(client, monkeypatch, tmp_path):
    monkeypatch.setattr("stylobate.earthquakes.inventories.runs._BLOCK_OF_WORKER", 8)
    objects = [
        sb.earthquakes.InventoryObject(
            name=f"column {place}",
            column={"radius": 0.06 + 0.03 * place, "height": 1.0, "density": 2400.0},
            model={"damping": 0.05},
            friction_coefficient=0.6,
            spreads={"radius": sb.earthquakes.LognormalSpread(0.05)},
        )
        for place in range(4)
    ]
    pulse = sb.Pulse.one_sine(acceleration=2.5, angular_frequency=5.0)
    alone = sb.earthquakes.inventory(objects, pulse, samples=4, progress=False)
    spread = sb.earthquakes.inventory(
        objects, pulse, samples=4, progress=False, executor=Dask(client=client), store=tmp_path
    )
    assert spread.identical(alone)
    assert 0.0 < float(alone["probability"].sel(limit_state="overturning").mean()) < 1.0
    assert len(list(tmp_path.glob("*.nc"))) == 4
