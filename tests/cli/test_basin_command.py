"""`stylobate basin` does what `basins` does, on a grid and from a random sample."""

import json

import numpy as np
import pytest
import xarray as xr

import stylobate as sb
from stylobate.cli.commands import COMMANDS
from stylobate.cli.main import run
from stylobate.studies.proportions import wilson_interval

SYSTEM = ["--slenderness", "0.1", "--damping", "0.1", "--motion", "circular"]
SYSTEM += ["--acceleration", "0.02", "--angular-frequency", "1.2"]
GRID = ["--x", "tilt-x", "-0.08", "0.08", "9", "--y", "tilt-rate-y", "-0.1", "0.1", "8"]
SAMPLE = ["--random", "60", "--seed", "3", "--over", "tilt-x", "-0.08", "0.08", "--over", "tilt-rate-y", "-0.1", "0.1"]
BASIN = ["basin", *SYSTEM, "--periods", "60"]

MODEL = sb.Wobbling(sb.Column.dimensionless(0.1), damping=0.1)
CIRCLE = sb.Harmonic.circular(acceleration=0.02, angular_frequency=1.2)


def test_a_grid_is_that_of_basins(tmp_path, capsys, saved):
    path, drawn = tmp_path / "basin.nc", tmp_path / "basin.png"
    assert run([*BASIN, *GRID, "--output", str(path), "--figure", str(drawn), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    over = {"tilt_x": np.linspace(-0.08, 0.08, 9), "tilt_rate_y": np.linspace(-0.1, 0.1, 8)}
    found = sb.studies.basins(MODEL, CIRCLE, over=over, periods=60.0)
    xr.testing.assert_equal(saved(path), found)
    assert [one["name"] for one in told["attractors"]] == found["attractor_name"].values.tolist()
    assert [one["fraction"] for one in told["attractors"]] == found["fraction"].values.tolist()
    assert sum(one["count"] for one in told["attractors"]) == told["computed"] == 72
    assert drawn.stat().st_size > 10_000


def test_runs_that_have_not_settled_are_a_row_of_the_table_with_their_remedy(capsys):
    assert run([*BASIN, *GRID, "--periods", "20"]) == 0
    printed = capsys.readouterr().out
    (row,) = [line for line in printed.splitlines() if line.startswith("│ not settled")]
    assert " % " in row
    assert printed.rstrip().endswith("run them for more periods")


def test_a_random_sample_is_that_of_basins(tmp_path, capsys, saved):
    path, drawn = tmp_path / "basin.nc", tmp_path / "basin.svg"
    assert run([*BASIN, *SAMPLE, "--output", str(path), "--figure", str(drawn)]) == 0
    printed = capsys.readouterr().out
    over = {"tilt_x": (-0.08, 0.08), "tilt_rate_y": (-0.1, 0.1)}
    found = sb.studies.basins(MODEL, CIRCLE, over=over, count=60, rng=3, periods=60.0)
    xr.testing.assert_equal(saved(path), found)
    assert "60 initial conditions" in printed
    low, high = 100.0 * found["fraction_low"].values, 100.0 * found["fraction_high"].values
    for place, name in enumerate(found["attractor_name"].values):
        assert str(name) in printed
        assert f"{low[place]:.2f} to {high[place]:.2f} %" in printed
    assert b"</svg>" in drawn.read_bytes()


def test_a_file_says_the_same_as_options(tmp_path, capsys):
    described = tmp_path / "basin.toml"
    described.write_text(
        "periods = 60.0\nconfidence = 0.9\nstrobes = 24\n"
        '[column]\nshape = "dimensionless"\nslenderness = 0.1\n[model]\ndamping = 0.1\n'
        '[motion]\nkind = "circular"\nacceleration = 0.02\nangular_frequency = 1.2\n'
        "[basin]\nrandom = 60\nseed = 3\n[basin.over]\ntilt_x = [-0.08, 0.08]\ntilt-rate-y = [-0.1, 0.1]\n"
    )
    assert run(["basin", str(described), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert run([*BASIN, *SAMPLE, "--confidence", "0.9", "--strobes", "24", "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == told
    assert (told["confidence"], told["provenance"]["strobes"]) == (0.9, 24)


@pytest.mark.parametrize(
    ("name", "how"),
    [
        ("basin.nc", GRID),
        ("basin.zarr", SAMPLE),
        pytest.param("basin.nc", SAMPLE, marks=pytest.mark.slow),
        pytest.param("basin.zarr", GRID, marks=pytest.mark.slow),
    ],
)
def test_saved_basins_are_shown_and_repeated(name, how, tmp_path, capsys):
    path = tmp_path / name
    assert run([*BASIN, *how, "--output", str(path), "--json"]) == 0
    first = json.loads(capsys.readouterr().out)
    assert run(["basin", str(path), "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == first
    assert run(["basin", str(path), "--periods", "60", "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == first
    assert run(["basin", str(path), "--confidence", "0.5", "--json"]) == 0
    one, told = first["attractors"][0], json.loads(capsys.readouterr().out)
    low, high = wilson_interval(one["count"], 60 if how is SAMPLE else 72, confidence=0.5)
    ends = [told["attractors"][0][f"fraction_{end}"] for end in ("low", "high")]
    assert [told["confidence"], *ends] == [0.5, pytest.approx(float(low)), pytest.approx(float(high))]


def test_a_sample_instead_of_the_grid_of_a_file(tmp_path, capsys):
    path = tmp_path / "basin.nc"
    assert run([*BASIN, *GRID, "--output", str(path)]) == 0
    capsys.readouterr()
    assert run(["basin", str(path), *SAMPLE, "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert (told["runs"], told["provenance"]["design"]["seed"]) == (60, 3)
    assert "x" not in told


@pytest.mark.slow
def test_after_ctrl_c_a_store_goes_on(tmp_path, capsys, interrupted):
    store = tmp_path / "basin.zarr"
    large = [*BASIN, "--periods", "20", "--random", "2000", *SAMPLE[2:]]
    assert run([*large, "--output", str(store), "--figure", str(tmp_path / "unfinished.png"), "--json"]) == 130
    told = json.loads(capsys.readouterr().out)
    assert 0 < told["computed"] < told["runs"] == 2000
    interrupted.undo()
    assert run([*large, "--output", str(store), "--resume", "--json"]) == 0
    resumed = json.loads(capsys.readouterr().out)
    assert run([*large, "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == resumed
    assert resumed["computed"] == 2000


def test_the_three_values_of_a_range_go_together():
    words = ["--over", "tilt-x", "-1", "2", "--seed", "3", "--over", "tilt-y", "0", "1"]
    read = COMMANDS["basin"].load().program("basin").make_context("basin", words).params
    assert read["over"] == (("tilt-x", "-1", "2"), ("tilt-y", "0", "1"))
    assert read["seed"] == 3


@pytest.mark.parametrize(
    ("arguments", "lines"),
    [
        (["basin"], ["column is missing"]),
        (BASIN, ["basin: x and y are missing (a grid of initial conditions), or random and over (a random sample)"]),
        ([*BASIN, *GRID[:5]], ["basin.y is missing"]),
        ([*BASIN, *SAMPLE[4:]], ["basin.random is missing"]),
        ([*BASIN, *SAMPLE[:4]], ["basin.over is missing"]),
        ([*BASIN, *GRID, *SAMPLE], ["basin.x and basin.y: random initial conditions have ranges"]),
        ([*BASIN, *SAMPLE, "--over", "tilt-y", "a", "1"], ["basin.over.tilt-y.0: input should be a valid number"]),
        ([*BASIN, *SAMPLE, "--over", "tilt-y", "1"], ["--over must be followed by NAME LOW HIGH; got fewer"]),
        ([*BASIN, *SAMPLE, "--over", "tilt-y", "1", "0"], ["over['tilt_y'] must be a lower and an upper bound"]),
        ([*BASIN, *SAMPLE, "--over", "damping", "0", "1"], ["basin.over must name starts of one system"]),
        ([*BASIN, "--x", "damping", "0", "1", "3", *GRID[5:]], ["basin.x must name starts of one system"]),
        (
            [*BASIN, *SAMPLE, "--random", "0", "--seed", "-1", "--confidence", "2", "--strobes", "1"],
            [
                "basin: random must be a whole number of at least 1",
                "basin: seed must be a whole number of at least 0",
                "strobes must be a whole number of at least 2",
                "confidence must lie between 0 and 1, got 2.0",
            ],
        ),
    ],
)
def test_bad_input_is_told_one_mistake_a_line(arguments, lines, capsys):
    assert run(arguments) == 2
    told = capsys.readouterr().err.strip().splitlines()
    assert len(told) == len(lines), told
    unmatched = [line for line in lines if not any(line in text for text in told)]
    assert not unmatched, told


def test_a_map_holds_no_basins(tmp_path, capsys):
    path = tmp_path / "map.nc"
    axes = ["--x", "acceleration", "0.01", "0.1", "2", "--y", "damping", "0", "0.1", "2"]
    assert run(["map", *SYSTEM, *axes, "--periods", "2", "--output", str(path)]) == 0
    assert run(["basin", str(path)]) == 2
    assert "runs without stroboscopic samples" in capsys.readouterr().err
