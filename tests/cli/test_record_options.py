"""Records on the command line."""

import json

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
    model = sb.Slender(sb.Column.solid(radius=0.3, height=3.0, density=2700.0), damping=0.05)
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
    assert "does not tell its unit" in told[0]


def test_a_map_takes_a_record_and_lasts_as_long(files, tmp_path, capsys):
    record = ["--record", str(files[0]), "--units", "g", "--step", "0.01"]
    axes = ["--x", "scale", "0.0", "3", "2", "--y", "rotation", "0", "0.1", "2"]
    saved = tmp_path / "map.nc"
    assert run(["map", *COLUMN, *record, *axes, "--output", str(saved), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["provenance"]["duration"] > 10.0
    assert run(["map", str(saved), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["provenance"] == told["provenance"]
