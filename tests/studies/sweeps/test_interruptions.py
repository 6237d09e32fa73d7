"""Killed and interrupted drivers: the arrays at the end are those of an undisturbed serial run."""

import os
import re
import signal
import subprocess
import sys
from contextlib import suppress

import numpy as np
import pytest

from stylobate.studies.sweeps import Threads, run_sweep
from stylobate.studies.sweeps.chunks import Blocks, Chunks, ChunkState, Shard
from stylobate.studies.sweeps.store import open_sweep

DRIVER = """
import os, signal, sys, time
import numpy as np
import stylobate as sb
from stylobate.studies.sweeps import Sweep, run_sweep
from stylobate.studies.sweeps.dask_executor import executor_from

def stop(done, total):
    print(done, flush=True)
    time.sleep(float(sys.argv[4]))
    if done >= int(sys.argv[3]):
        os.kill(os.getpid(), signal.SIGKILL)

if __name__ == "__main__":
    model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
    motion = sb.Harmonic.circular(acceleration=0.15, angular_frequency=1.0)
    over = {"angular_frequency": np.linspace(0.5, 3.0, 4), "acceleration": np.linspace(0.09, 0.4, 5)}
    sweep = Sweep.grid(model, motion, over=over, periods=1.5, strobes=2)
    run_sweep(sweep, store=sys.argv[1], executor=executor_from(sys.argv[2]), resume=True, chunk_size=2, progress=stop)
"""


def drive(tmp_path, executor, kill_after, pause=0.0, **options):
    script = tmp_path / "driver.py"
    script.write_text(DRIVER)
    command = [sys.executable, str(script), str(tmp_path / "sweep.zarr"), executor, str(kill_after), str(pause)]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **options)


@pytest.mark.posix
@pytest.mark.parametrize("executor", ["threads", pytest.param("dask://", marks=pytest.mark.slow)])
def test_a_driver_killed_and_started_again_changes_nothing(
    grid, tmp_path, assert_same_arrays, counting, undisturbed, executor
):
    with drive(tmp_path, executor, kill_after=7) as driver:
        driver.communicate(timeout=120)
    assert driver.returncode == -signal.SIGKILL
    chunks = Chunks(tmp_path / "sweep.zarr", Blocks.of(grid.shape, 2), grid.layout.variables)
    done = {index for index, state in chunks.states().items() if state is ChunkState.DONE}
    assert done
    again = counting(Threads(1))
    data = run_sweep(grid, store=tmp_path / "sweep.zarr", resume=True, executor=again)
    assert again.blocks
    assert not done.intersection(again.blocks)
    assert_same_arrays(data, undisturbed(grid))


@pytest.mark.posix
@pytest.mark.slow
@pytest.mark.parametrize("executor", ["threads", "dask://"])
def test_ctrl_c_in_a_terminal_stops_at_once_and_leaves_a_store_to_go_on_with(
    grid, tmp_path, assert_same_arrays, undisturbed, executor
):
    # A terminal sends it to the driver and its workers alike.
    with drive(tmp_path, executor, kill_after=10**6, pause=0.1, start_new_session=True) as driver:
        while int(driver.stdout.readline()) < 2:
            pass
        os.killpg(driver.pid, signal.SIGINT)
        _, complaint = driver.communicate(timeout=120)
    stopped = re.search(r"Interrupted: stopped after (\d+) of 20 runs; resume=True continues", complaint)
    assert int(stopped[1]) < 20
    data = run_sweep(grid, store=tmp_path / "sweep.zarr", resume=True, executor=Threads(1))
    assert_same_arrays(data, undisturbed(grid))


class KilledError(BaseException):
    """The process ends here."""


@pytest.mark.parametrize("begun", [False, pytest.param(True, marks=pytest.mark.slow)])
def test_a_writer_killed_at_any_write_leaves_a_store_that_goes_on(grid, tmp_path, undisturbed, monkeypatch, begun):
    path, left, write = tmp_path / "sweep.zarr", 0, Shard._write
    run_sweep(grid, store=path, chunk_size=5)
    chunks, whole = Chunks(path, Blocks.of(grid.shape, 5), grid.layout.variables), undisturbed(grid)
    block = chunks.blocks[1]
    arrays = chunks.read(block)
    some = {one.name: np.where(np.arange(5) < 3, arrays[one.name].T, one.fill).T for one in chunks.variables}

    def dying(shard, place, content):
        nonlocal left
        left -= 1
        if left < 0:
            write(shard, place, content[: len(content) // 2] if len(content) > 16 else b"")
            raise KilledError
        write(shard, place, content)

    for writes in range(200):
        chunks.forget(1)
        if begun:
            chunks.write(block, some, done=False)
        left = writes
        with monkeypatch.context() as patch, suppress(KilledError):
            patch.setattr(Shard, "_write", dying)
            chunks.write(block, arrays, done=True)
        found = open_sweep(path, load=True)
        computed = found["outcome"] >= 0
        for name in found.data_vars:
            assert found[name].where(computed).equals(whole[name].where(computed)), name
        if left >= 0:
            break
        chunks.write(block, arrays, done=True)
        assert chunks.state(1) is ChunkState.DONE
    assert 50 < writes < 200
