"""A store goes on where it was left, and with no other sweep than its own."""

import importlib
import linecache
import shutil
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
import zarr

import stylobate as sb
from stylobate.errors import FileError
from stylobate.files import _MACHINE
from stylobate.studies.sweeps import Sweep, run_sweep
from stylobate.studies.sweeps.chunks import Blocks, Chunks, encoded
from stylobate.studies.sweeps.fingerprint import identity_of
from stylobate.studies.sweeps.store import differences, open_sweep

MODEL = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
MOTION = sb.Harmonic.circular(acceleration=0.15, angular_frequency=1.0)


@pytest.fixture
def path(tmp_path):
    return tmp_path / "folder" / "sweep.zarr"


def chunks_of(sweep, path):
    return Chunks(path, Blocks.of(sweep.shape, 5), sweep.layout.variables)


def test_a_finished_store_is_read_and_not_computed(sweep, path, counting, assert_same_arrays):
    first, second = counting(), counting()
    data = run_sweep(sweep, store=path, chunk_size=3, executor=first)
    assert len(first.blocks) > 1
    assert_same_arrays(run_sweep(sweep, store=path, resume=True, executor=second), data)
    assert second.blocks == []


def test_only_missing_blocks_are_computed(grid, path, counting, assert_same_arrays, undisturbed):
    run_sweep(grid, store=path, chunk_size=5)
    with chunks_of(grid, path).shards("r+b") as shards:
        shards["seal"].forget(2)
    again = counting()
    assert_same_arrays(run_sweep(grid, store=path, resume=True, executor=again), undisturbed(grid))
    assert again.blocks == [2]


def test_data_torn_before_the_outcomes_are_computed_again(grid, path, assert_same_arrays, undisturbed):
    run_sweep(grid, store=path, chunk_size=5)
    with chunks_of(grid, path).shards("r+b") as shards:
        for name in ("seal", "outcome"):  # written last: the process died before
            shards[name].forget(1)
        shards["end_tilt"].write(1, encoded(np.full((1, 5, 2), 7.0)))
    assert_same_arrays(run_sweep(grid, store=path, resume=True), undisturbed(grid))


def test_a_store_gains_no_file_whatever_the_number_of_chunks(grid, path):
    files = []

    def look(done, total):
        files.append({str(file.relative_to(path)) for file in path.rglob("*")})

    run_sweep(grid, store=path, chunk_size=3, progress=look)
    assert len(files) > 5
    shutil.rmtree(path)
    run_sweep(grid, store=path, progress=look)
    assert all(found == files[0] for found in files)


def test_resume_begins_where_there_is_no_store(points, path, assert_same_arrays, undisturbed):
    assert_same_arrays(run_sweep(points, store=path, resume=True), undisturbed(points))


def test_a_store_that_exists_is_left_alone(points, path):
    run_sweep(points, store=path)
    before = {file: file.read_bytes() for file in path.rglob("*") if file.is_file()}
    with pytest.raises(FileError, match=r"sweep\.zarr exists\. Continue it with resume=True, or give another store"):
        run_sweep(points, store=path)
    assert {file: file.read_bytes() for file in path.rglob("*") if file.is_file()} == before


def test_a_store_whose_making_was_cut_short_is_made_again(points, path, assert_same_arrays, undisturbed):
    torn = path.with_name(f".sweep.{_MACHINE}-{2**22 + 1}-1a.part.zarr")  # of a process that cannot be alive
    zarr.create_group(torn)
    assert_same_arrays(run_sweep(points, store=path, resume=True), undisturbed(points))
    assert not torn.exists()


def changed(**changes):
    return replace(Sweep.points(MODEL, MOTION, at={"tilt_x": [0.01, 0.02]}, duration=10.0), **changes)


@pytest.mark.parametrize(
    ("other", "line"),
    [
        (changed(duration=20.0), "duration was 10.0, is 20.0"),
        (changed(duration=None, periods=3.0), "duration was 10.0, is not given; periods was not given, is 3.0"),
        (changed(options={"rtol": 1e-6}), "rtol was 1e-08, is 1e-06"),
        (changed(options={"method": "taylor"}), "method was 'dop853', is 'taylor'"),
        (changed(options={"rules": sb.OutcomeRules(periods=4)}), "rules.periods was 10, is 4"),
        (changed(model=replace(MODEL, damping=0.2)), "model.damping was 0.1, is 0.2"),
        (
            changed(motion=sb.Harmonic.circular(acceleration=0.15, angular_frequency=2.0)),
            "motion.angular_frequency was 1.0, is 2.0",
        ),
        (
            Sweep.points(MODEL, MOTION, at={"tilt_x": [0.01, 0.03]}, duration=10.0),
            "tilt_x was 2 values from 0.01 to 0.02, is 2 values from 0.01 to 0.03",
        ),
        (
            Sweep.points(MODEL, MOTION, at={"tilt_y": [0.01, 0.02]}, duration=10.0),
            "tilt_y was not given, is 2 values from 0.01 to 0.02",
        ),
        (Sweep.grid(MODEL, MOTION, over={"tilt_x": [0.01, 0.02]}, duration=10.0), "design.kind was 'points'"),
        (
            Sweep.random(replace(MODEL, damping=0.0), over={"tilt_x": (0.0, 0.1)}, count=1, rng=1, duration=1.0),
            "and [0-9]+ more differences",
        ),
    ],
)
def test_another_sweep_is_refused_and_the_difference_named(path, other, line):
    run_sweep(changed(), store=path)
    with pytest.raises(FileError, match=rf"sweep\.zarr cannot be continued: .*{line}") as refusal:
        run_sweep(other, store=path, resume=True)
    assert "\n" not in str(refusal.value)


def test_values_between_the_same_ends_differ(path):
    run_sweep(Sweep.points(MODEL, MOTION, at={"tilt_x": [0.01, 0.02, 0.03]}, duration=1.0), store=path)
    other = Sweep.points(MODEL, MOTION, at={"tilt_x": [0.01, 0.025, 0.03]}, duration=1.0)
    with pytest.raises(FileError, match="tilt_x has other values than before"):
        run_sweep(other, store=path, resume=True)


def test_another_version_is_refused_and_named(points, path, monkeypatch):
    describe_now = Sweep.describe
    monkeypatch.setattr(Sweep, "describe", lambda sweep: {**describe_now(sweep), "version": "0.0.1"})
    run_sweep(points, store=path)
    monkeypatch.setattr(Sweep, "describe", describe_now)
    with pytest.raises(FileError, match=rf"the store was made by stylobate 0\.0\.1, this is {sb.__version__}"):
        run_sweep(points, store=path, resume=True)


def test_another_chunk_size_is_refused(points, path):
    run_sweep(points, store=path, chunk_size=2)
    run_sweep(points, store=path, chunk_size=2, resume=True)
    with pytest.raises(FileError, match=r"has chunks of \[2\] runs, not of 1\. Leave chunk_size out"):
        run_sweep(points, store=path, chunk_size=1, resume=True)


def test_what_is_no_store_of_a_sweep_is_refused(points, path):
    with pytest.raises(FileError, match=r"cannot read .*sweep\.zarr"):
        open_sweep(path)
    path.mkdir(parents=True)
    (path / "letter.txt").write_text("keep me")
    with pytest.raises(FileError, match="it is no store of a sweep"):
        run_sweep(points, store=path, resume=True)
    shutil.rmtree(path)
    xr.Dataset({"a": ("x", [1.0])}).to_zarr(path, consolidated=False)
    with pytest.raises(FileError, match=r"is no store of a sweep: its format is None"):
        run_sweep(points, store=path, resume=True)


def test_a_sweep_that_does_not_fit_on_the_disk_does_not_begin(grid, path, monkeypatch):
    usage = shutil.disk_usage(path.parent.parent)._replace(free=3_000_000)
    monkeypatch.setattr(shutil, "disk_usage", lambda where: usage)
    large = Sweep.grid(MODEL, MOTION, over={"damping": np.linspace(0, 1, 10**4), "scale": np.ones(10**4)}, duration=1)
    with pytest.raises(FileError, match=r"the sweep needs up to 1\d\.\d GB at .* and the disk has 3 MB free\. Choose"):
        run_sweep(large, store=path)
    assert not list(path.parent.iterdir())
    run_sweep(grid, store=path)


def test_a_store_takes_no_more_than_was_estimated(sweep, path):
    run_sweep(sweep, store=path, chunk_size=3)
    data = [file for file in path.rglob("*") if file.is_file() and file.name != "zarr.json"]
    assert sum(-(-file.stat().st_size // 4096) * 4096 for file in data) <= sweep.estimated_bytes(chunk_size=3)
    whole = run_sweep(sweep, store=path.with_name("whole.zarr"))
    assert sum(array.nbytes for array in whole.data_vars.values()) <= sweep.estimated_bytes()


def test_a_place_that_cannot_be_written_is_named(points, tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(FileError, match=r"cannot write .*sweep\.zarr: "):
        run_sweep(points, store=tmp_path / "file" / "sweep.zarr")


def test_a_disk_that_fills_up_is_told_and_the_store_goes_on(points, path, monkeypatch, assert_same_arrays, undisturbed):

    def full(*arguments, **options):
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as patch:
        patch.setattr("stylobate.studies.sweeps.chunks.Chunks.write", full)
        with pytest.raises(FileError, match=r"No space left on device\. Continue it with resume=True"):
            run_sweep(points, store=path)
    assert_same_arrays(run_sweep(points, store=path, resume=True), undisturbed(points))


KEYS = ({}, {"run": 4}, {"run": -1}, {"run": slice(None, None, -3)}, {"run": [5, 0, 5]}, {"run": slice(2, 2)})


@pytest.mark.parametrize("key", [*KEYS, {"axis": 1}, {"axis": [1, 0], "run": slice(1, 9, 2)}])
def test_a_selection_is_that_of_the_arrays_in_memory(random, path, key, assert_same_arrays):
    whole = run_sweep(random)
    run_sweep(random, store=path, chunk_size=3)
    assert_same_arrays(sb.load(path).isel(key).load(), whole.isel(key))
    assert_same_arrays(sb.load(path).chunk(run=2).isel(key).load(), whole.isel(key))


@pytest.mark.slow
def test_a_store_is_written_and_read_without_zarr(path):
    program = (
        "import sys; import stylobate as sb; from stylobate.studies.sweeps import Sweep, run_sweep; "
        "model = sb.Slender(sb.Column.dimensionless(slenderness=0.1)); "
        "sweep = Sweep.points(model, at={'tilt_x': [0.01, 0.02]}, duration=1.0); "
        "run_sweep(sweep, store=sys.argv[1]); sb.load(sys.argv[1]).load(); "
        "print(sorted({'zarr', 'numcodecs'} & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", program, str(path)], capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"


def test_other_software_opens_a_store(random, path):
    data = run_sweep(random, store=path)
    with xr.open_zarr(path, consolidated=False) as plain:
        np.testing.assert_array_equal(plain["outcome"], data["outcome"])
        assert "damping" in plain.coords


def own_motion(body):
    """Return a motion of a user's own class, with `body` in its source."""
    return f"""
@dataclass(frozen=True, eq=False)
class Sway(sb.BaseMotion):
    table: object
    def derivative(self, time, order):
        value = {body}
        return value, 0.0 * value, 0.0 * value
    def peak_horizontal(self, since=0.0):
        return 1.0
    def vertical_range(self, since=0.0):
        return 0.0, 0.0
    def directions(self):
        return ((1.0, 0.0),)
"""


@pytest.fixture
def sway(tmp_path, monkeypatch):
    """Write a module with a motion of its own, and return the class."""
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr(sys, "dont_write_bytecode", True)

    def make(body):
        head = "from dataclasses import dataclass\nimport numpy as np\nimport stylobate as sb\n"
        (tmp_path / "swaying.py").write_text(head + own_motion(body))
        sys.modules.pop("swaying", None)
        linecache.clearcache()
        importlib.invalidate_caches()
        return importlib.import_module("swaying").Sway

    yield make
    sys.modules.pop("swaying", None)


def test_a_motion_of_ones_own_is_told_by_its_class_state_and_source(sway):
    table = np.linspace(0.0, 1.0, 5000)
    cls = sway("0.2 * np.cos(time)")
    one, same, other = (identity_of(cls(values)) for values in (table, table.copy(), table + np.eye(1, 5000, 9)[0]))
    assert one == same
    assert one["class"] == "swaying.Sway"
    assert one["repr"] == other["repr"]  # an array this long is abbreviated
    assert one["state_sha256"] != other["state_sha256"]
    assert one["source_sha256"] == other["source_sha256"]
    rewritten = identity_of(sway("0.3 * np.cos(time)")(table))
    assert rewritten["state_sha256"] == one["state_sha256"]
    assert rewritten["source_sha256"] != one["source_sha256"]


def test_a_motion_within_a_motion_is_looked_at_too(sway):
    one = identity_of(sway("0.2 * np.cos(time)")(None).scaled(2.0))
    other = identity_of(sway("0.3 * np.cos(time)")(None).scaled(2.0))
    assert one["state_sha256"] == other["state_sha256"]
    assert one["source_sha256"] != other["source_sha256"]


def test_an_object_that_holds_itself_has_an_identity_without_addresses():
    class Knot:
        def __init__(self):
            self.parts = [self, object(), {"f": len, "g": Knot}]

    assert identity_of(Knot()) == identity_of(Knot())
    assert "0x" not in identity_of(Knot())["repr"]


def test_a_sweep_with_a_motion_of_ones_own_goes_on_and_refuses_another_source(sway, path):
    def described(body):
        return Sweep.points(MODEL, sway(body)(None), at={"tilt_x": [0.02]}, duration=1.0)

    first = described("0.2 * np.cos(time)")
    run_sweep(first, store=path)
    run_sweep(described("0.2 * np.cos(time)"), store=path, resume=True)
    with pytest.raises(FileError, match="motion source changed"):
        run_sweep(described("0.25 * np.cos(time)"), store=path, resume=True)


OWN_MODEL = """
from dataclasses import dataclass
from stylobate.column import Column
from stylobate.models import Model
def force(tilt):
    return {force}
def rates(x, y, vx, vy, ax, ay, az, c, eta):
    return vx, vy, force(x) - eta * vx - ax, force(y) - eta * vy - ay
def tilt_of(x, y, vx, vy, *_):
    return x, y, vx, vy
@dataclass(frozen=True)
class Spring(Model):
    column: Column
    damping: float = 0.0
    name = "spring"
    state_names = ("x", "y", "vx", "vy")
    rates = staticmethod(rates)
    tilt_of = staticmethod(tilt_of)
    @property
    def parameters(self):
        return self.column.slenderness, self.damping
    def start(self, tilt, tilt_rate):
        return (*tilt, *(rate * self.time_scale for rate in tilt_rate))
"""


def test_a_model_of_ones_own_is_told_by_the_functions_of_its_module(tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr(sys, "dont_write_bytecode", True)

    def described(force):
        (tmp_path / "springs.py").write_text(OWN_MODEL.format(force=force))
        monkeypatch.delitem(sys.modules, "springs", raising=False)
        linecache.clearcache()
        importlib.invalidate_caches()
        model = importlib.import_module("springs").Spring(MODEL.column)
        return Sweep.points(model, MOTION, at={"tilt_x": [0.02]}, duration=1.0).describe()

    first, again, other = (described(force) for force in ("-tilt", "-tilt", "-4.0 * tilt"))
    monkeypatch.delitem(sys.modules, "springs", raising=False)
    assert differences(first, again) == []
    # The source of the class is as before.
    assert differences(first, other) == ["model equations changed"]
