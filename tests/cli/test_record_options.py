"""Records on the command line."""

import json
import subprocess
import sys

import numpy as np
import pytest

import stylobate as sb
from stylobate.cli.main import run

COLUMN = ["--radius", "0.3", "--height", "3", "--density", "2700", "--damping", "0.05"]


@pytest.fixture
def files(tmp_path):
    rng = np.random.default_rng(2)
    paths = [tmp_path / f"quake_{name}.txt" for name in ("NS", "EW")]
    for path in paths:
        np.savetxt(path, rng.normal(scale=0.2, size=200))
    return paths


def test_a_record_given_as_options_is_simulated_and_repeated_from_the_saved_run(files, tmp_path, capsys):
    saved = tmp_path / "run.nc"
    record = [part for path in files for part in ("--record", str(path))]
    options = [*record, "--units", "g", "--step", "0.01", "--scale", "1.5", "--rotation", "0.2", "--tail", "0.5"]
    assert run(["simulate", *COLUMN, *options, "--output", str(saved), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    (read,) = sb.read_records(files, "g", step=0.01)
    model = sb.Wobbling(sb.Column.solid(radius=0.3, height=3.0, density=2700.0), damping=0.05)
    motion = read.scaled(1.5).rotated(0.2).with_tail(0.5)
    found = sb.simulate(model, motion, duration=told["provenance"]["duration"])
    assert told["measures"] == dict(found.measures)
    assert list(told["provenance"]["motion"]["file_sha256"]) == [str(path) for path in files]
    assert run(["simulate", str(saved), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["measures"] == told["measures"]
    files[0].write_text("0.0\n0.1\n")
    assert run(["simulate", str(saved)]) == 2
    told = capsys.readouterr().err.splitlines()
    assert len(told) == 1
    assert "has changed since the result was saved" in told[0]


def test_a_record_without_its_unit_is_one_line(files, capsys):
    assert run(["simulate", *COLUMN, "--record", str(files[0]), "--step", "0.01"]) == 2
    told = capsys.readouterr().err.splitlines()
    assert len(told) == 1
    assert "names no unit" in told[0]


def test_a_map_takes_a_record_and_lasts_as_long(files, tmp_path, capsys):
    record = ["--record", str(files[0]), "--units", "g", "--step", "0.01", "--one-component"]
    axes = ["--x", "scale", "0.0", "3", "2", "--y", "rotation", "0", "0.1", "2"]
    saved = tmp_path / "map.nc"
    assert run(["map", *COLUMN, *record, *axes, "--output", str(saved), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["provenance"]["duration"] > 10.0
    assert run(["map", str(saved), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["provenance"] == told["provenance"]


STUDY = """
duration = 2.0
column = {shape = "solid", radius = 0.3, height = 3.0, density = 2700.0}
model = {kind = "wobbling", damping = 0.05}
motion = {kind = "record", path = "quakes/quake_NS.txt", units = "g", step = 0.01, one_component = true}

[map]
x = {name = "scale", from = 0.0, to = 3.0, number = 2}
y = {name = "rotation", from = 0.0, to = 0.1, number = 2}
"""


@pytest.fixture
def study(files, tmp_path):
    folder = tmp_path / "study"
    (folder / "quakes").mkdir(parents=True)
    files[0].rename(folder / "quakes" / "quake_NS.txt")
    (folder / "map.toml").write_text(STUDY)
    return folder


def test_a_study_that_was_moved_with_its_records_goes_on_where_it_is_now(study, tmp_path, capsys):
    assert run(["map", str(study / "map.toml"), "--output", str(study / "map.zarr"), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)["outcomes"]
    moved = study.rename(tmp_path / "moved")
    for source in ("map.toml", "map.zarr"):
        again = ["map", str(moved / source), "--output", str(moved / "map.zarr"), "--resume", "--json"]
        assert run(again) == 0
        assert json.loads(capsys.readouterr().out)["outcomes"] == told
    record = moved / "quakes" / "quake_NS.txt"
    record.write_text(record.read_text() + "0.0\n")
    assert run(["map", str(moved / "map.toml"), "--output", str(moved / "map.zarr"), "--resume"]) == 2
    assert "quake_NS.txt" in capsys.readouterr().err


def test_a_saved_run_finds_its_record_beside_it_and_takes_no_other_file_of_that_name(study, tmp_path, capsys):
    options = ["--record", str(study / "quakes" / "quake_NS.txt"), "--units", "g", "--step", "0.01", "--one-component"]
    assert run(["simulate", *COLUMN, *options, "--output", str(study / "run.nc"), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    moved = study.rename(tmp_path / "moved")
    assert run(["simulate", str(moved / "run.nc"), "--json"]) == 0
    again = json.loads(capsys.readouterr().out)
    assert again["measures"] == told["measures"]
    assert list(again["provenance"]["motion"]["file_sha256"]) == [str(moved / "quakes" / "quake_NS.txt")]
    record = moved / "quakes" / "quake_NS.txt"
    record.write_text(record.read_text() + "0.0\n")
    assert run(["simulate", str(moved / "run.nc")]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert "No such file or directory; the result was made with it: put it there or beside the result" in line


def test_a_record_beyond_what_the_ground_does_is_one_line_of_warning(tmp_path, capsys):
    path = tmp_path / "gal.txt"
    path.write_text("0.0\n-250.0\n120.0\n")
    record = ["--record", str(path), "--units", "g", "--step", "0.01", "--one-component"]
    run(["simulate", *COLUMN, *record, "--duration", "0.05"])
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith(f"stylobate: warning: {path}: its peak is 250 g")


def test_a_file_that_is_missing_is_told_before_anything_heavy_is_imported(tmp_path):
    code = (
        "import json, sys; from stylobate.cli.main import run\n"
        "for arguments in json.loads(sys.argv[1]):\n"
        "    print(run(arguments), sorted({'llvmlite', 'scipy', 'xarray', 'matplotlib'} & set(sys.modules)))"
    )
    missing = str(tmp_path / "missing.txt")
    commands = (
        ["simulate", *COLUMN, "--record", missing],
        ["map", *COLUMN, "--record", missing],
        ["spectrum", "missing.toml"],
        ["simulate", *COLUMN, "--duration", "-1"],
    )
    command = [sys.executable, "-c", code, json.dumps(commands)]
    ended = subprocess.run(command, capture_output=True, text=True, check=True)
    assert ended.stdout.splitlines() == ["2 []"] * len(commands)


def test_listed_components_are_one_event_whatever_their_names(files, tmp_path, capsys):
    paths = [path.rename(tmp_path / name) for path, name in zip(files, ("left.txt", "right.txt"), strict=True)]
    record = [part for path in paths for part in ("--record", str(path))]
    reading = ["--units", "g", "--step", "0.01", "--duration", "2", "--json"]
    assert run(["simulate", *COLUMN, *record, *reading]) == 2
    assert "left.txt: its direction is unknown. State directions" in capsys.readouterr().err
    one = ["--record-direction", "N10E"]
    assert run(["simulate", *COLUMN, *record, *one, *reading]) == 2
    assert "directions: one for each file is needed (got 1 for 2 files)" in capsys.readouterr().err
    assert run(["simulate", *COLUMN, *record, *one, "--record-direction", "100", *reading]) == 0
    told = capsys.readouterr()
    assert told.err == ""
    (read,) = sb.read_records([paths], "g", step=0.01, directions={"left.txt": 10, "right.txt": 100})
    model = sb.Wobbling(sb.Column.solid(radius=0.3, height=3.0, density=2700.0), damping=0.05)
    assert json.loads(told.out)["measures"] == dict(sb.simulate(model, read, duration=2.0).measures)


@pytest.mark.parametrize(
    ("more", "warned"), [([], True), (["--one-component"], False), (["--model", "planar-rocking"], False)]
)
def test_a_component_alone_is_one_line_of_warning_unless_it_is_meant(files, capsys, more, warned):
    column = COLUMN[:6]
    record = ["--record", str(files[0]), "--units", "g", "--step", "0.01", "--duration", "0.1"]
    assert run(["simulate", *column, *record, *more]) == 0
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == warned
    assert all(line.startswith("stylobate: warning: quake_NS: one horizontal component") for line in lines)
