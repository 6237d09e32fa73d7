"""Files are written whole or not at all, and a file that is not as it was written is refused in one line."""

import os
import shutil
import subprocess
import sys
import traceback
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from functools import partial
from pathlib import Path

import h5py
import numpy as np
import pytest
import xarray as xr

import stylobate as sb
from stylobate import orbits
from stylobate.cli.main import run as run_command
from stylobate.cli.output import check_writable, open_saved
from stylobate.earthquakes import incremental_dynamic_analysis
from stylobate.errors import FileError
from stylobate.files import read_sealed, sealed, write_whole
from stylobate.orbits.storage import load_orbits
from stylobate.results import Assessment
from stylobate.results.storage import read_dataset, write_netcdf

MODEL = sb.Slender(sb.Column.dimensionless(0.1), damping=0.1)
CIRCLE = sb.Harmonic.circular(acceleration=0.065, angular_frequency=2.0)
FLIPS = 500


def save_run(path):
    return sb.simulate(MODEL, CIRCLE, tilt=(0.03, 0.01), duration=5.0).save(path)


def save_study(path):
    over = {"angular_frequency": np.linspace(1.0, 3.0, 4), "acceleration": np.linspace(0.05, 0.3, 4)}
    return write_netcdf(sb.studies.overturning_map(MODEL, CIRCLE, over=over, periods=3.0), path)


def save_orbit(path):
    return orbits.periodic_orbit(MODEL, CIRCLE).save(path)


def save_assessment(path):
    tables = {name: xr.Dataset({"tilt": ("run", np.linspace(0.0, 1.0, 5))}) for name in ("verdicts", "margins")}
    return Assessment(data=tables, setting={"title": "columns"}).save(path)


def save_basins(path):
    starts = {name: np.linspace(-0.1, 0.1, 3) for name in ("tilt_x", "tilt_y")}
    return write_netcdf(sb.studies.basins(MODEL, CIRCLE, over=starts, periods=8.0), path)


def save_fragility(path):
    pulses = {
        name: sb.Pulse.one_sine(acceleration=0.2, angular_frequency=1.0 + number) for number, name in enumerate("ab")
    }
    return write_netcdf(incremental_dynamic_analysis(MODEL, pulses, scales=[0.5, 2.0]), path)


KINDS = {
    "run": (save_run, sb.load),
    "map": (save_study, sb.load),
    "basins": (save_basins, open_saved),
    "fragility": (save_fragility, sb.load),
    "orbit": (save_orbit, load_orbits),
    "assessment": (save_assessment, Assessment.load),
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("files")


@pytest.fixture(scope="module", params=KINDS)
def kept(request, folder):
    save, load = KINDS[request.param]
    return save(folder / f"{request.param}.nc"), load


def require_refused(path, content, load):
    path.write_bytes(content)
    with pytest.raises(FileError) as refusal:
        load(path)
    assert str(path) in str(refusal.value)
    assert "\n" not in str(refusal.value)


def test_no_flipped_bit_is_accepted(kept, tmp_path):
    path, load = kept
    content, rng = path.read_bytes(), np.random.default_rng(20)
    for bit in rng.integers(8 * len(content), size=FLIPS).tolist():
        damaged = bytearray(content)
        damaged[bit // 8] ^= 1 << bit % 8
        require_refused(tmp_path / path.name, damaged, load)


def test_a_file_of_another_length_is_refused(kept, tmp_path):
    path, load = kept
    content, rng = path.read_bytes(), np.random.default_rng(22)
    for added in (b"\n", b"\0", rng.bytes(200), bytes(5000), content):
        require_refused(tmp_path / path.name, content + added, load)
    for lost in (1, 30, 65, 84, 85, 100):  # parts of the checksum, all of it, and more
        require_refused(tmp_path / path.name, content[:-lost], load)


def test_no_flipped_bit_is_accepted_where_a_byte_was_appended(kept, tmp_path):
    path, load = kept
    content, rng = path.read_bytes() + b"\n", np.random.default_rng(23)
    for bit in rng.integers(8 * len(content), size=50).tolist():
        damaged = bytearray(content)
        damaged[bit // 8] ^= 1 << bit % 8
        require_refused(tmp_path / path.name, damaged, load)


@pytest.mark.parametrize(("number", "remedy"), [("0", "Compute it again"), ("12", "Update stylobate")])
def test_a_file_of_another_version_is_refused_with_the_remedy(kept, number, remedy, tmp_path):
    path, load = kept
    with h5py.File(shutil.copy(path, tmp_path), "r+") as file:
        kind = file.attrs["format"].rpartition(" ")[0]
        file.attrs["format"] = f"{kind} {number}"
    other = write_whole(tmp_path / "other.nc", sealed((tmp_path / path.name).read_bytes()))
    with pytest.raises(FileError, match=rf"other\.nc: written by a .* version of stylobate .*\. {remedy}$"):
        load(other)


def test_a_file_of_a_later_kind_is_refused(kept, tmp_path):
    path, load = kept
    with h5py.File(shutil.copy(path, tmp_path), "r+") as file:
        file.attrs["format"] = "stylobate novelty 1"
    require_refused(tmp_path / "other.nc", sealed((tmp_path / path.name).read_bytes()), load)


def test_a_result_does_not_hold_the_format_of_its_file(folder):
    assert "format" not in sb.load(save_study(folder / "read.nc")).attrs


def test_no_lost_stretch_is_accepted(kept, tmp_path):
    path, load = kept
    content, rng = path.read_bytes(), np.random.default_rng(21)
    for start in rng.integers(len(content) - 4096 - 128, size=20).tolist():
        zeroed = content[:start] + bytes(4096) + content[start + 4096 :]
        if zeroed != content:
            require_refused(tmp_path / path.name, zeroed, load)
    for length in rng.integers(len(content) // 2, size=20).tolist():
        require_refused(tmp_path / path.name, content[:length], load)


READ_DAMAGED = """
import sys
from contextlib import suppress
from pathlib import Path
import numpy as np
from stylobate.errors import FileError
from stylobate.results.storage import read_dataset

content = Path(sys.argv[1]).read_bytes()
for flip in range(40):
    damaged, rng = bytearray(content), np.random.default_rng(flip)
    for bit in rng.integers(8 * len(content), size=200).tolist():
        damaged[bit // 8] ^= 1 << bit % 8
    Path(sys.argv[2]).write_bytes(damaged)
    with suppress(FileError):  # without a seal no reader can see every damage
        read_dataset(sys.argv[2])
"""


def test_of_a_file_of_another_program_no_damage_raises_a_foreign_error(tmp_path):
    data = xr.Dataset({"tilt": ("run", np.linspace(0.0, 1.0, 5))}, attrs={"kind": "map"})
    data.to_netcdf(tmp_path / "foreign.nc", engine="h5netcdf")
    # In a process of its own: damaged files can leave the HDF5 library with open objects.
    command = [sys.executable, "-c", READ_DAMAGED, str(tmp_path / "foreign.nc"), str(tmp_path / "damaged.nc")]
    ended = subprocess.run(command, capture_output=True, text=True, check=False)
    assert ended.returncode == 0, ended.stderr


def another_file(path):
    with h5py.File(path, "w") as file:
        file["tilt"] = np.arange(5.0)
    return path


def link(file, other):
    file["tilt"] = h5py.ExternalLink(str(other), "/tilt")


def soft_link(file, other):
    del other
    file["tilt"] = h5py.SoftLink("/other")


def virtual(file, other):
    layout = h5py.VirtualLayout(shape=(5,), dtype=float)
    layout[:] = h5py.VirtualSource(str(other), "tilt", shape=(5,))
    file.create_virtual_dataset("tilt", layout)


def external(file, other):
    file.create_dataset("tilt", (5,), float, external=str(other))


def immense(file, other):
    del other
    file.create_dataset("tilt", (1 << 40,), float, chunks=(1 << 10,))


@pytest.mark.parametrize("seal", [sealed, bytes])
@pytest.mark.parametrize(
    ("fill", "problem"),
    [
        (link, "'tilt' is a link"),
        (soft_link, "'tilt' is a link"),
        (virtual, "the values of '/tilt' lie in other files, or need a plugin of HDF5"),
        (external, "the values of '/tilt' lie in other files, or need a plugin of HDF5"),
        (immense, r"its data are to take [\d.e+]+ GiB, the file has \d+ bytes"),
    ],
)
def test_a_result_refers_to_no_other_file_and_declares_no_more_than_it_holds(tmp_path, fill, problem, seal):
    path = tmp_path / "result.nc"
    with h5py.File(path, "w") as file:
        fill(file, another_file(tmp_path / "other.h5"))
    path.write_bytes(seal(path.read_bytes()))
    with pytest.raises(FileError, match=rf"result\.nc: it is not a netCDF file, or damaged \({problem}\)"):
        read_dataset(path)


def test_a_sealed_file_is_still_netcdf_for_other_programs(kept):
    path, _ = kept
    with xr.open_datatree(path, engine="h5netcdf", decode_times=False) as tree:
        assert tree.load().subtree


def test_what_is_sealed_is_read_as_it_was(tmp_path):
    for content in (b"", b"x", bytes(range(256)) * 40):
        assert read_sealed(write_whole(tmp_path / "file", sealed(content))) == (content, True)
        assert read_sealed(write_whole(tmp_path / "file", content)) == (content, False)


def fail(*_):
    raise OSError(28, os.strerror(28))


@pytest.mark.parametrize("save", [save_run, save_orbit, save_assessment])
def test_an_older_file_outlives_a_full_disk(save, tmp_path, monkeypatch):
    path = write_whole(tmp_path / "older.nc", b"older")
    monkeypatch.setattr(os, "fsync", fail)
    with pytest.raises(FileError, match=r"^cannot write .*older\.nc: No space left on device$"):
        save(path)
    assert path.read_bytes() == b"older"
    assert list(tmp_path.iterdir()) == [path]


def test_after_a_failed_save_the_error_holds_no_memory_of_the_file(tmp_path, monkeypatch):
    monkeypatch.setattr(os, "fsync", fail)
    with pytest.raises(FileError) as failure:
        save_run(tmp_path / "run.nc")
    errors = [failure.value, failure.value.__context__]
    frames = [frame for error in errors for frame, _ in traceback.walk_tb(error.__traceback__)]
    for view in (value for frame in frames for value in frame.f_locals.values() if isinstance(value, memoryview)):
        with pytest.raises(ValueError, match="released"):
            view.tobytes()
    assert frames


RUN = ["simulate", "--slenderness", "0.1", "--motion", "circular", "--acceleration", "0.065"]
RUN += ["--angular-frequency", "2", "--tilt", "0.03", "0.01", "--duration", "60"]


@contextmanager
def no_file_longer_than(size):
    """Files of this process end at a size, as on a full disk."""
    import resource

    before, most = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, most))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (before, most))


@pytest.mark.posix
@pytest.mark.parametrize(("option", "name"), [("--output", "run.nc"), ("--figure", "run.png")])
def test_a_command_on_a_full_disk_ends_with_one_line(option, name, tmp_path, capsys):
    path = tmp_path / name
    assert run_command([*RUN, option, str(path)]) == 0  # its kernel is kept in a file too
    assert path.stat().st_size > 4096
    path.unlink()
    capsys.readouterr()
    with no_file_longer_than(4096):
        assert run_command([*RUN, option, str(path)]) == 2
    assert capsys.readouterr().err == f"stylobate: cannot write {path}: File too large\n"
    assert not list(tmp_path.iterdir())


def test_what_a_killed_process_left_is_removed(tmp_path):
    script = (
        "import os, sys\nfrom stylobate.files import written_aside\n"
        "with written_aside(sys.argv[1]) as beside:\n    beside.touch()\n    os.kill(os.getpid(), 9)\n"
    )
    path = tmp_path / "run.nc"
    subprocess.run([sys.executable, "-c", script, str(path)], check=False)
    assert len(list(tmp_path.iterdir())) == 1
    write_whole(path, b"new")
    assert list(tmp_path.iterdir()) == [path]


def test_two_processes_that_write_one_file_leave_it_whole(tmp_path):
    script = (
        "import sys\nfrom stylobate.files import write_whole\n"
        "for _ in range(100): write_whole(sys.argv[1], sys.argv[2].encode() * 50_000)\n"
    )
    path = tmp_path / "file"
    writers = [subprocess.Popen([sys.executable, "-c", script, str(path), letter]) for letter in "ab"]
    seen = set()
    while any(writer.poll() is None for writer in writers):
        seen |= {Path(path).read_bytes()} if path.exists() else set()
    assert [writer.returncode for writer in writers] == [0, 0]
    assert seen | {path.read_bytes()} <= {b"a" * 50_000, b"b" * 50_000}
    assert list(tmp_path.iterdir()) == [path]


@pytest.fixture
def read_only(monkeypatch):
    monkeypatch.setattr(os, "access", lambda path, mode: False)


@pytest.mark.usefixtures("read_only")
@pytest.mark.parametrize("name", ["map.zarr", "map.nc"])
def test_a_read_only_folder_is_named_with_the_file_asked_for(name, tmp_path):
    with pytest.raises(FileError) as refusal:
        check_writable(None, tmp_path / name, stores=True)
    assert str(refusal.value) == f"cannot write {tmp_path / name}: {tmp_path} is not a writable folder"


@pytest.mark.usefixtures("read_only")
def test_a_complete_store_is_shown_on_a_read_only_disk(tmp_path):
    over = {"angular_frequency": np.linspace(1.0, 3.0, 2), "acceleration": np.linspace(0.05, 0.3, 2)}
    study = partial(sb.studies.overturning_map, MODEL, CIRCLE, over=over, periods=3.0, store=tmp_path / "map.zarr")
    first = study()
    before = {file: file.stat().st_mtime_ns for file in tmp_path.rglob("*")}
    check_writable(None, tmp_path / "map.zarr", stores=True)
    xr.testing.assert_equal(study(resume=True), first)
    assert {file: file.stat().st_mtime_ns for file in tmp_path.rglob("*")} == before


@pytest.mark.posix
def test_a_link_and_the_permissions_of_a_file_stay(tmp_path):
    file, link = tmp_path / "file.nc", tmp_path / "link.nc"
    file.write_bytes(b"older")
    file.chmod(0o600)
    link.symlink_to(file)
    write_whole(link, b"new")
    assert link.is_symlink()
    assert file.read_bytes() == b"new"
    assert file.stat().st_mode & 0o777 == 0o600


@pytest.mark.posix
def test_a_pipe_is_written_and_not_replaced(tmp_path):
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    reader = subprocess.Popen(["cat", str(pipe)], stdout=subprocess.PIPE)
    write_whole(pipe, b"through")
    assert reader.communicate()[0] == b"through"
    assert pipe.is_fifo()


@pytest.mark.parametrize("name", ["", ".", "a\0b", "missing/file.nc"])
def test_a_name_that_is_no_file_is_one_line(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(FileError, match=r"^cannot write "):
        write_whole(name, b"x")


def test_threads_that_write_one_file_leave_it_whole(tmp_path):
    path = tmp_path / "file"
    with ThreadPoolExecutor(4) as pool:
        list(pool.map(lambda letter: [write_whole(path, letter * 20_000) for _ in range(20)], (b"a", b"b", b"c", b"d")))
    assert path.read_bytes() in {letter * 20_000 for letter in (b"a", b"b", b"c", b"d")}
    assert list(tmp_path.iterdir()) == [path]
