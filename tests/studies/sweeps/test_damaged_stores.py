"""A damaged store is refused in one line, and computed again where it is damaged when it is continued."""

import json
import logging
import os
import re
import shutil
import subprocess
import sys

import numpy as np
import pytest
import zarr
from tests.studies.sweeps.conftest import MODEL, MOTION

import stylobate as sb
from stylobate.errors import FileError
from stylobate.studies.sweeps import Sweep, run_sweep, store
from stylobate.studies.sweeps.chunks import METADATA, Blocks, Chunks
from stylobate.studies.sweeps.store import open_sweep

FLIPS, EXCHANGES = 400, 25


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


def chunks_of(sweep, path):
    return Chunks(path, Blocks.of(sweep.shape, 5), sweep.layout.variables)


def files_of(path):
    return {str(file.relative_to(path)): file.read_bytes() for file in path.rglob("*") if file.is_file()}


@pytest.mark.slow
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


@pytest.fixture(scope="module")
def begun(sweep, undamaged, tmp_path_factory):
    """Return a store without its last block, and with some runs of the block before."""
    path = shutil.copytree(undamaged, tmp_path_factory.mktemp("begun") / "sweep.zarr")
    chunks = chunks_of(sweep, path)
    arrays = chunks.read(chunks.blocks[2])
    for variable in chunks.variables:
        arrays[variable.name][3:] = variable.fill
    chunks.write(chunks.blocks[2], arrays, done=False)
    chunks.forget(3)
    return path


@pytest.mark.parametrize(("written", "other"), [('"group"', '"groups"'), ('"zarr_format": 3', '"zarr_format": 2')])
def test_a_store_that_zarr_would_not_find_is_refused_in_one_line(path, written, other):
    text = (path / METADATA).read_text()
    assert written in text
    (path / METADATA).write_text(text.replace(written, other))
    with pytest.raises(FileError, match=r"sweep\.zarr is damaged: .*\. Begin another store$"):
        sb.load(path)


def test_a_store_of_another_version_is_refused_with_the_remedy(path):
    text = (path / METADATA).read_text()
    for number, remedy in ((1, "Compute it again"), (99, "Update stylobate")):
        (path / METADATA).write_text(re.sub("stylobate sweep [0-9]+", f"stylobate sweep {number}", text))
        with pytest.raises(FileError, match=rf"sweep\.zarr: written by a .* version of stylobate .*\. {remedy}$"):
            sb.load(path)


def test_zarr_describes_the_arrays_of_a_store_as_it_does_and_reads_their_chunks(sweep, undamaged, assert_same_arrays):
    group, blocks = zarr.open_group(undamaged, mode="r"), Blocks.of(sweep.shape, 5)
    for name, array in group.arrays():
        written = json.loads((undamaged / name / METADATA).read_text())
        known = json.loads(json.dumps(array.metadata.to_dict()))
        if array.dtype.itemsize == 1:  # whose bytes have no order
            known["codecs"] = written["codecs"]
        assert known == written
    for variable in sweep.layout.variables:
        chunks = Chunks(undamaged, blocks, sweep.layout.variables)
        read = [chunks.read(block)[variable.name] for block in blocks]
        assert np.concatenate(read).tobytes() == group[variable.name][:].tobytes()


def exchange_files(rng, path):
    chunks = sorted(file for file in path.rglob("*") if file.is_file() and file.name != METADATA)
    exchange(*rng.choice(chunks, 2, replace=False))


def exchange_metadata(rng, path):
    exchange(*rng.choice(sorted(path.rglob(METADATA)), 2, replace=False))


def exchange_arrays(rng, path):
    exchange(*rng.choice(sorted(folder for folder in path.iterdir() if folder.is_dir()), 2, replace=False))


def exchange(one, other):
    one.rename(one.with_name("between"))
    other.rename(one)
    one.with_name("between").rename(other)


def any_file(rng, path):
    return rng.choice(sorted(file for file in path.rglob("*") if file.is_file()))


def append(rng, path):
    file = any_file(rng, path)
    file.write_bytes(file.read_bytes() + rng.bytes(1))


def truncate(rng, path):
    file = any_file(rng, path)
    file.write_bytes(file.read_bytes()[: rng.integers(file.stat().st_size)])


def remove(rng, path):
    any_file(rng, path).unlink()


def add_an_array(rng, path):
    shutil.copytree(path / "outcome", path / "extra")
    append(rng, path / "extra")


DAMAGES = (exchange_files, exchange_metadata, exchange_arrays, append, truncate, remove, add_an_array)


@pytest.mark.slow
@pytest.mark.parametrize("store", ["undamaged", "begun"])
@pytest.mark.parametrize("damage", DAMAGES)
def test_a_changed_store_is_refused_or_holds_what_was_written(store, damage, request, tmp_path, assert_same_arrays):
    written, path, rng = request.getfixturevalue(store), tmp_path / "sweep.zarr", np.random.default_rng(23)
    data, refused = open_sweep(written, load=True), 0
    for _ in range(EXCHANGES if damage is exchange_files else 8):
        shutil.copytree(written, path)
        damage(rng, path)
        try:
            assert_same_arrays(sb.load(path).load(), data)
        except FileError as error:
            refused += 1
            assert [str(path) in line for line in str(error).splitlines()] == [True]  # noqa: PT017  or the same
        shutil.rmtree(path)
    assert refused or damage is add_an_array


@pytest.mark.parametrize("pair", [("repetition", "decided_at"), ("end_tilt", "end_tilt_rate")])
@pytest.mark.parametrize("whole", [True, False])
def test_exchanged_chunks_are_computed_again(sweep, undamaged, path, pair, whole):
    if whole:
        exchange(*(next((path / name).glob("c.*")) for name in pair))
    else:
        with chunks_of(sweep, path).shards("r+b") as shards:
            contents = [shards[name].content(1) for name in pair]
            for name, content in zip(pair, reversed(contents), strict=True):
                shards[name].write(1, content)
    assert files_of(path) != files_of(undamaged)
    run_sweep(sweep, store=path, resume=True)
    assert files_of(path) == files_of(undamaged)


@pytest.mark.parametrize(("lost", "index"), [("end_tilt", 1), ("outcome", 2), ("seal", 1)])
def test_what_was_lost_is_computed_again_with_a_notice(sweep, undamaged, path, assert_same_arrays, caplog, lost, index):
    with chunks_of(sweep, path).shards("r+b") as shards:
        shards[lost].forget(index)
    with caplog.at_level(logging.WARNING, "stylobate"):
        again = run_sweep(sweep, store=path, resume=True)
    assert_same_arrays(again, open_sweep(undamaged))
    assert files_of(path) == files_of(undamaged)
    if lost != "seal":  # without its seal a block is one that has not been finished
        assert "5 runs are computed again" in caplog.text


@pytest.mark.parametrize("kept", [None, 0, 20, 70])
@pytest.mark.parametrize("lost", ["end_tilt/c.0.0.0", "outcome/c.0.0", "seal/c.0"])
@pytest.mark.parametrize("begun", [True, False])
def test_a_lost_or_shortened_file_is_made_again_with_a_notice(
    sweep, undamaged, path, assert_same_arrays, caplog, lost, kept, begun
):
    if begun:
        for index in range(2, 4):
            chunks_of(sweep, path).forget(index)
    content = (path / lost).read_bytes()
    (path / lost).unlink()
    if kept is not None:
        (path / lost).write_bytes(content[:kept])
    with pytest.raises(FileError, match=r"sweep\.zarr is damaged: [0-9]+ runs cannot be read"):
        open_sweep(path)
    with caplog.at_level(logging.WARNING, "stylobate"):
        again = run_sweep(sweep, store=path, resume=True)
    assert "runs are computed again" in caplog.text
    assert_same_arrays(again, open_sweep(undamaged))
    assert files_of(path) == files_of(undamaged)


@pytest.mark.parametrize("date", [0, 4e9])
def test_the_dates_of_files_do_not_matter(sweep, undamaged, path, caplog, date):
    chunks_of(sweep, path).forget(3)
    for file in path.rglob("*"):  # the clock went back, or forward
        os.utime(file, (date, date))
    with caplog.at_level(logging.WARNING):
        run_sweep(sweep, store=path, resume=True)
    assert files_of(path) == files_of(undamaged)


def test_a_damaged_chunk_is_computed_again(sweep, undamaged, path, caplog):
    with chunks_of(sweep, path).shards("r+b") as shards:
        shards["peak_tilt"].write(3, bytes(reversed(shards["peak_tilt"].content(3))))
    run_sweep(sweep, store=path, resume=True)
    assert "5 runs are computed again" in caplog.text
    assert files_of(path) == files_of(undamaged)


@pytest.mark.parametrize("lost", ["acceleration/c.0", "acceleration", "end_tilt/zarr.json", "zarr.json"])
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


@pytest.mark.parametrize(("name", "kind"), [("../elsewhere", "<f8"), ("tilt", "|O"), ("", "<f8")])
def test_a_store_names_arrays_of_numbers_in_its_own_folders(path, name, kind):
    metadata = json.loads((path / METADATA).read_text())
    metadata["attributes"]["variables"][name] = [kind, []]
    (path / METADATA).write_text(json.dumps(metadata))
    (path.parent / "elsewhere").mkdir()
    asked = []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(store, "_digest", lambda *_: asked.append(1))
        with pytest.raises(FileError, match="is damaged: its metadata or axes are not as they were written"):
            open_sweep(path)
    assert asked == []  # no file of such a name is opened
