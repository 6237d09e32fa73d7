"""A damaged store is refused in one line, and computed again where it is damaged when it is continued."""

import logging
import shutil
import subprocess
import sys

import numpy as np
import pytest
from tests.studies.sweeps.conftest import MODEL, MOTION

from stylobate.errors import FileError
from stylobate.studies.sweeps import Sweep, open_sweep, run_sweep, store
from stylobate.studies.sweeps.chunks import METADATA

FLIPS = 400


@pytest.fixture(scope="module")
def sweep():
    over = {"angular_frequency": np.linspace(0.5, 3.0, 4), "acceleration": np.linspace(0.09, 0.4, 5)}
    return Sweep.grid(MODEL, MOTION, over=over, periods=1.5, strobes=2)


@pytest.fixture(scope="module")
def undamaged(sweep, tmp_path_factory):
    path = tmp_path_factory.mktemp("undamaged") / "sweep.zarr"
    run_sweep(sweep, store=path, chunk_size=5)
    return path


@pytest.fixture
def path(undamaged, tmp_path):
    return shutil.copytree(undamaged, tmp_path / "sweep.zarr")


def files_of(path):
    return {str(file.relative_to(path)): file.read_bytes() for file in path.rglob("*") if file.is_file()}


def test_no_flipped_bit_is_accepted_and_all_that_can_be_are_mended(sweep, undamaged, path, assert_same_arrays):
    written, rng = files_of(undamaged), np.random.default_rng(22)
    data = open_sweep(undamaged, load=True)
    names = list(written)
    for _ in range(FLIPS):
        name = names[rng.integers(len(names))]
        damaged = bytearray(written[name])
        damaged[rng.integers(len(damaged))] ^= 1 << rng.integers(8)
        (path / name).write_bytes(damaged)
        if unchanged(name, written[name], damaged):
            assert_same_arrays(open_sweep(path, load=True), data)
        else:
            with pytest.raises(FileError, match=r"sweep\.zarr") as refusal:
                open_sweep(path)
            assert "\n" not in str(refusal.value)
        (path / name).write_bytes(written[name])


def unchanged(name, before, after):
    """Return whether damage to the metadata of the store itself says what was said before: a space became a tab."""
    return name == METADATA and b"".join(before.split()) == b"".join(bytes(after).split())


@pytest.mark.parametrize("lost", ["end_tilt/c/1/0/0", "outcome/c/2/0", "done/c/1", "end_tilt/c/0"])
def test_what_was_lost_is_computed_again_with_a_notice(sweep, undamaged, path, assert_same_arrays, caplog, lost):
    if (path / lost).is_dir():
        shutil.rmtree(path / lost)
    else:
        (path / lost).unlink()
    with caplog.at_level(logging.WARNING, "stylobate"):
        again = run_sweep(sweep, store=path, resume=True)
    assert_same_arrays(again, open_sweep(undamaged))
    assert files_of(path) == files_of(undamaged)
    if not lost.startswith("done"):  # without its mark a block is one that has not been finished
        assert "5 runs are computed again" in caplog.text


def test_a_damaged_chunk_is_computed_again(sweep, undamaged, path, caplog):
    file = path / "peak_tilt" / "c" / "3" / "0"
    file.write_bytes(bytes(reversed(file.read_bytes())))
    run_sweep(sweep, store=path, resume=True)
    assert "5 runs are computed again" in caplog.text
    assert files_of(path) == files_of(undamaged)


@pytest.mark.parametrize("lost", ["acceleration/c", "acceleration", "end_tilt/zarr.json", "zarr.json"])
@pytest.mark.parametrize("resume", [True, False])
def test_a_lost_axis_or_description_is_one_line(sweep, path, lost, resume):
    if (path / lost).is_dir():
        shutil.rmtree(path / lost)
    else:
        (path / lost).unlink()
    with pytest.raises(FileError, match=r"sweep\.zarr") as refusal:
        run_sweep(sweep, store=path, resume=True) if resume else open_sweep(path)
    assert "\n" not in str(refusal.value)


DRIVER = """
import sys
import numpy as np
import stylobate as sb
from stylobate.studies.sweeps import Sweep, run_sweep

model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
motion = sb.Harmonic.circular(acceleration=0.15, angular_frequency=1.0)
over = {"angular_frequency": np.linspace(0.5, 3.0, 4), "acceleration": np.linspace(0.09, 0.4, 5)}
sweep = Sweep.grid(model, motion, over=over, periods=1.5, strobes=2)
sys.stdin.read()  # until all are ready
try:
    run_sweep(sweep, store=sys.argv[1], resume=sys.argv[2] == "resume", chunk_size=5)
except sb.errors.FileError as error:
    print(error)
"""


@pytest.mark.parametrize("resume", [True, False])
def test_a_store_that_another_process_makes_meanwhile_is_left_alone(sweep, undamaged, tmp_path, monkeypatch, resume):
    path, fill = tmp_path / "sweep.zarr", store._fill_new

    def fill_late(*arguments):
        fill(*arguments)
        shutil.copytree(undamaged, path)

    monkeypatch.setattr(store, "_fill_new", fill_late)
    if resume:
        run_sweep(sweep, store=path, resume=True, chunk_size=5)
    else:
        with pytest.raises(FileError, match=r"exists\. Continue it with resume=True"):
            run_sweep(sweep, store=path, chunk_size=5)
    assert files_of(path) == files_of(undamaged)
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.slow
@pytest.mark.parametrize("resume", ["resume", "begin"])
def test_of_processes_that_begin_one_store_at_once_none_dies(resume, undamaged, tmp_path):
    path = tmp_path / "sweep.zarr"
    command = [sys.executable, "-c", DRIVER, str(path), resume]
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    processes = [subprocess.Popen(command, **pipes) for _ in range(3)]
    for process in processes:
        process.stdin.close()
    lines = []
    for process in processes:
        with process:
            lines += process.stdout.read().splitlines()
            assert "Traceback" not in process.stderr.read()
        assert process.returncode == 0
    assert files_of(path) == files_of(undamaged)
    assert list(tmp_path.iterdir()) == [path]
    assert len(lines) == (0 if resume == "resume" else 2)
    assert all("exists. Continue it with resume=True" in line for line in lines)
