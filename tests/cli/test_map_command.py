"""`stylobate map` does what `overturning_map` does, keeps what it computed, and goes on with it."""

import json
import logging
import subprocess
import sys

import numpy as np
import pytest
import xarray as xr

import stylobate as sb
from stylobate.cli.main import run
from stylobate.cli.terminal import log_lines
from stylobate.studies.sweeps.store import open_sweep

COLUMN = ["--slenderness", "0.1", "--damping", "0.1"]
AXES = ["--x", "angular-frequency", "0.5", "6", "5", "--y", "acceleration", "0.05", "0.4", "4"]
MAP = ["map", *COLUMN, "--motion", "circular", *AXES, "--periods", "12"]
MORE = ["--acceleration", "0.2", "--angular-frequency", "2"]
LARGE = ["map", *COLUMN, "--motion", "circular", "--periods", "3"]
LARGE += ["--x", "angular-frequency", "0.5", "6", "50", "--y", "acceleration", "0.05", "0.4", "40"]

MODEL = sb.Wobbling(sb.Column.dimensionless(0.1), damping=0.1)
CIRCLE = sb.Harmonic.circular(acceleration=1.0, angular_frequency=1.0)
OVER = {"angular_frequency": np.linspace(0.5, 6.0, 5), "acceleration": np.linspace(0.05, 0.4, 4)}


def test_map_saves_what_overturning_map_finds(tmp_path, capsys, saved):
    path = tmp_path / "map.nc"
    assert run([*MAP, "--output", str(path), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    found = sb.studies.overturning_map(MODEL, CIRCLE, over=OVER, periods=12.0)
    data = saved(path)
    xr.testing.assert_equal(data, found)
    assert json.loads(data.attrs["provenance"]) == json.loads(found.attrs["provenance"]) == told["provenance"]
    assert told["computed"] == told["runs"] == 20
    counts = [outcome["count"] for outcome in told["outcomes"].values()]
    assert counts == found["count"].values.tolist()
    assert told["x"] == {"name": "angular_frequency", "from": 0.5, "to": 6.0, "number": 5}


def test_a_table_tells_the_outcomes_and_a_figure_shows_them(tmp_path, capsys):
    drawn = tmp_path / "map.png"
    assert run([*MAP, "--figure", str(drawn)]) == 0
    printed = capsys.readouterr()
    assert "overturned" in printed.out
    assert "20 runs over angular_frequency and acceleration" in printed.out
    assert drawn.read_bytes().startswith(b"\x89PNG")
    assert drawn.stat().st_size > 10_000


@pytest.mark.parametrize("name", ["map.nc", "map.zarr"])
def test_a_saved_map_is_shown_without_computing(name, tmp_path, capsys, monkeypatch):
    path, drawn = tmp_path / name, tmp_path / "map.svg"
    assert run([*MAP, "--output", str(path), "--json"]) == 0
    first = json.loads(capsys.readouterr().out)

    def refuse(*_, **__):
        message = "nothing is to be computed"
        raise AssertionError(message)

    monkeypatch.setattr("stylobate.studies.sweeps.running.run_sweep", refuse)
    assert run(["map", str(path), "--figure", str(drawn), "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == first
    assert b"</svg>" in drawn.read_bytes()


@pytest.mark.parametrize("name", ["map.nc", "map.zarr"])
def test_options_repeat_a_saved_map_with_changes(name, tmp_path, capsys, saved):
    path, changed = tmp_path / name, tmp_path / "changed.nc"
    assert run([*MAP, "--output", str(path)]) == 0
    capsys.readouterr()
    assert run(["map", str(path), "--damping", "0.3", "--duration", "9", "--output", str(changed), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)["provenance"]
    assert (told["model"]["damping"], told["duration"], told["periods"]) == (0.3, 9.0, None)
    damped = sb.Wobbling(sb.Column.dimensionless(0.1), damping=0.3)
    xr.testing.assert_equal(saved(changed), sb.studies.overturning_map(damped, CIRCLE, over=OVER, duration=9.0))


def test_a_file_says_the_same_as_options(tmp_path, capsys):
    described = tmp_path / "map.toml"
    described.write_text(
        "periods = 12.0\ntilt = [0.02, 0.0]\n"
        '[column]\nshape = "dimensionless"\nslenderness = 0.1\n[model]\ndamping = 0.1\n[motion]\nkind = "circular"\n'
        '[map]\nx = {name = "angular_frequency", from = 0.5, to = 6.0, number = 5, spacing = "log"}\n'
        'y = {name = "acceleration", values = [0.05, 0.1, 0.4]}\n[basin]\nrandom = 10\nover.tilt_x = [0, 1]\n'
    )
    assert run(["map", str(described), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    over = {"angular_frequency": np.geomspace(0.5, 6.0, 5), "acceleration": [0.05, 0.1, 0.4]}
    found = sb.studies.overturning_map(MODEL, CIRCLE, over=over, periods=12.0, tilt=(0.02, 0.0))
    assert told["provenance"] == json.loads(found.attrs["provenance"])
    assert run(["map", str(described), "--y", "damping", "0", "1", "3", "--acceleration", "0.2", "--json"]) == 0
    changed = json.loads(capsys.readouterr().out)
    assert changed["y"] == {"name": "damping", "from": 0.0, "to": 1.0, "number": 3}
    assert changed["x"] == told["x"]


def test_after_ctrl_c_what_was_computed_is_in_the_file(tmp_path, capsys, interrupted, saved):
    path, drawn = tmp_path / "map.nc", tmp_path / "map.png"
    assert run([*LARGE, "--output", str(path), "--figure", str(drawn)]) == 130
    printed = capsys.readouterr()
    assert "runs are done" in printed.err
    assert printed.err.endswith("stylobate: interrupted\n")
    assert "2000 runs over angular_frequency and acceleration, " in printed.out
    partial = saved(path)
    known = partial["outcome"].values >= 0
    assert 0 < known.sum() == partial["computed"] < known.size
    assert np.isnan(partial["peak_tilt"].values[~known]).all()
    whole = sb.studies.overturning_map(
        MODEL,
        CIRCLE,
        over={"angular_frequency": np.linspace(0.5, 6.0, 50), "acceleration": np.linspace(0.05, 0.4, 40)},
        periods=3.0,
        progress=False,
    )
    np.testing.assert_array_equal(partial["outcome"].values[known], whole["outcome"].values[known])
    assert drawn.stat().st_size > 10_000


def test_a_store_goes_on_after_ctrl_c_and_ends_as_if_undisturbed(tmp_path, capsys, interrupted, saved):
    store, whole = tmp_path / "map.zarr", tmp_path / "whole.nc"
    assert run([*LARGE, "--output", str(store)]) == 130
    assert f"{store} continues with --resume" in capsys.readouterr().err
    assert run(["map", str(store), "--figure", str(tmp_path / "unfinished.png"), "--json"]) == 0
    first = json.loads(capsys.readouterr().out)
    assert 0 < first["computed"] < first["runs"] == 2000
    interrupted.undo()
    assert run([*LARGE, "--output", str(store)]) == 2
    assert "Continue it with --resume" in capsys.readouterr().err
    assert run(["map", str(store), "--resume", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["computed"] == 2000
    assert run([*LARGE, "--output", str(store), "--resume"]) == 0
    assert run([*LARGE, "--output", str(whole)]) == 0
    xr.testing.assert_equal(open_sweep(store).load(), saved(whole).drop_dims("outcome_name").drop_vars("computed"))


def test_another_sweep_does_not_go_on_with_a_store(tmp_path, capsys):
    store = tmp_path / "map.zarr"
    assert run([*MAP, "--output", str(store)]) == 0
    assert run([*MAP, "--rtol", "1e-6", "--output", str(store), "--resume"]) == 2
    assert "rtol was 1e-08, is 1e-06" in capsys.readouterr().err


@pytest.mark.slow
def test_the_method_is_that_of_the_option_and_told_with_the_map(tmp_path, capsys, saved):
    path = tmp_path / "map.nc"
    assert run([*MAP, "--method", "taylor", "--output", str(path), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["provenance"]["method"] == "taylor"
    data = saved(path)
    found = sb.studies.overturning_map(MODEL, CIRCLE, over=OVER, periods=12.0, method="taylor")
    xr.testing.assert_equal(data, found)
    # Steps of another kind, not a name only.
    usual = sb.studies.overturning_map(MODEL, CIRCLE, over=OVER, periods=12.0)
    assert (data["steps"] != usual["steps"]).any()


def test_a_map_by_another_method_does_not_go_on_with_a_store(tmp_path, capsys):
    store = tmp_path / "map.zarr"
    assert run([*MAP, "--output", str(store)]) == 0
    assert run([*MAP, "--method", "taylor", "--output", str(store), "--resume"]) == 2
    assert "method was 'dop853', is 'taylor'" in capsys.readouterr().err


def test_stroke_and_angle_of_a_feeder_make_a_map(tmp_path, saved, capsys):
    path = tmp_path / "map.nc"
    pin = ["--radius", "0.006", "--height", "0.04", "--density", "7850", "--friction-coefficient", "0.2"]
    feeder = ["--motion", "stroke", "--frequency", "50", "--periods", "5"]
    plane = ["--x", "stroke", "0.0003", "0.0009", "2", "--y", "angle", "0.3", "0.5", "3"]
    assert run(["map", *pin, "--model", "sliding", *feeder, *plane, "--output", str(path)]) == 0
    assert "6 runs over stroke and angle" in capsys.readouterr().out
    found = saved(path)
    assert found["stroke"].attrs["units"] == "m"
    motion = json.loads(found.attrs["provenance"])["motion"]
    assert (motion["kind"], motion["frequency"]) == ("stroke", 50.0)


def test_the_number_of_threads_changes_nothing(tmp_path, saved):
    for name, more in (("one.nc", ["--threads", "1"]), ("all.nc", ["--executor", "threads"])):
        assert run([*MAP, *more, "--output", str(tmp_path / name)]) == 0
    xr.testing.assert_identical(saved(tmp_path / "one.nc"), saved(tmp_path / "all.nc"))


@pytest.mark.slow
def test_dask_workers_compute_the_same(tmp_path):
    paths = {executor: tmp_path / f"{executor[:4]}.zarr" for executor in ("threads", "dask://")}
    for executor, path in paths.items():
        command = [sys.executable, "-m", "stylobate", *MAP, "--executor", executor, "--output", str(path)]
        subprocess.run(command, check=True, capture_output=True)
    first, second = (open_sweep(path).load() for path in paths.values())
    xr.testing.assert_identical(first, second)


@pytest.mark.parametrize(
    ("arguments", "lines"),
    [
        (["map"], ["column is missing", "map is missing"]),
        (["map", *COLUMN, *AXES[:5], "--duration", "3"], ["map.y is missing"]),
        (
            ["map", *COLUMN, "--motion", "circular", *AXES, "--duration", "3", "--periods", "2"],
            ["one of them; got duration and periods"],
        ),
        (["map", *COLUMN, "--motion", "circular", *AXES], ["one of them; got none of them"]),
        (
            ["map", "--slenderness", "-1", *MAP[3:-1], "-2", "--y", "damping", "0", "1", "0", *MORE],
            [
                "column: slenderness must be positive",
                "map.y: number must be a whole number",
                "periods must be positive",
            ],
        ),
        ([*MAP, *MORE, "--x", "acceleration", "nan", "1", "2"], ["map.x: from must be finite, got nan", "must differ"]),
        (
            [*MAP, "--x", "acceleration", "0.1", "one", "2"],
            ["--x must be followed by NAME FROM TO NUMBER; one of them is not a number"],
        ),
        (
            [
                "map",
                *COLUMN,
                "--motion",
                "circular",
                "--x",
                "angular-frequncy",
                "1",
                "2",
                "2",
                *AXES[5:],
                "--periods",
                "3",
            ],
            ["angular_frequncy is not known here; did you mean angular_frequency?"],
        ),
        (
            ["map", *COLUMN, "--motion", "circular", "--x", "colour", "1", "2", "2", *AXES[5:], "--periods", "3"],
            ["colour is not known here; the base motion needs"],
        ),
        ([*MAP, *MORE, "--x", "dampng", "0.1", "1", "2"], ["map.x: dampng is not known here; did you mean damping?"]),
        ([*MAP, *MORE, "--x", "colour", "0.1", "1", "2"], ["map.x: colour is not known here; known are tilt_x,"]),
        ([*MAP, "--output", "map.txt"], ["--output must end with .nc, .zarr, .csv or .xlsx, got 'map.txt'"]),
        ([*MAP, "--x-spacing", "cubic"], ["map.x.spacing: input should be 'linear' or 'log', got 'cubic'"]),
        (
            [*MAP, "--x", "angular-frequency", "0", "6", "3"],
            ["map.x['angular_frequency'] must be positive, got 0.0 rad/s"],
        ),
        ([*MAP, "--method", "rk4"], ["method: input should be 'dop853' or 'taylor', got 'rk4'"]),
        ([*MAP, "--resume"], ["--resume: the store to continue is missing. Add --output NAME.zarr."]),
        ([*MAP, "--executor", "slurm"], ['executor must be "threads"']),
        (
            [*MAP, "--executor", "dask://h:1", "--threads", "2"],
            ["--threads: the workers of dask://h:1 have one thread"],
        ),
        ([*MAP, "--threads", "0"], ["threads must be a whole number of at least 1"]),
        ([*MAP, "--output", "none/map.nc"], ["cannot write none/map.nc"]),
        ([*MAP, "--output", "none/map.zarr"], ["none is not a writable folder"]),
        (["map", "none.nc"], ["cannot read none.nc: No such file or directory"]),
        (["map", "none.zarr"], ["cannot read none.zarr: No such file or directory"]),
        (
            ["map", *COLUMN, "--motion", "stroke", *AXES, "--duration", "2"],
            ["stroke is missing", "frequency is missing"],
        ),
        (
            ["map", *COLUMN, "--motion", "rest", *AXES, "--duration", "2"],
            ["the base motion has no such number (got a base at rest). Give a base motion"],
        ),
    ],
)
def test_bad_input_is_told_one_mistake_a_line(arguments, lines, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert run(arguments) == 2
    told = capsys.readouterr().err.strip().splitlines()
    assert len(told) == len(lines), told
    unmatched = [line for line in lines if not any(line in text for text in told)]
    assert not unmatched, told


@pytest.mark.parametrize("content", [b"no netCDF", b""])
def test_a_file_that_holds_no_map_is_told(content, tmp_path, capsys):
    path = tmp_path / "other.nc"
    path.write_bytes(content)
    assert run(["map", str(path)]) == 2
    assert "cannot read" in capsys.readouterr().err
    xr.Dataset({"a": 1}).to_netcdf(path, engine="h5netcdf")
    assert run(["map", str(path)]) == 2
    assert "holds no map or basins saved by stylobate" in capsys.readouterr().err


def test_a_single_run_is_no_map(tmp_path, capsys):
    path = tmp_path / "run.nc"
    assert run(["simulate", *COLUMN, "--duration", "1", "--output", str(path)]) == 0
    assert run(["map", str(path)]) == 2
    assert "holds no map or basins" in capsys.readouterr().err


def test_warnings_of_the_library_are_told_on_stderr_one_to_a_line(capsys):
    log = logging.getLogger("stylobate")
    with log_lines():
        log.warning("compiling %s", "a model " * 40)
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err == f"stylobate: compiling {'a model ' * 40}\n"
    assert not log.handlers


def test_runs_that_have_converged_end_early_and_a_saved_map_keeps_the_option(tmp_path, capsys):
    saved = tmp_path / "map.nc"
    options = "--slenderness 0.1 --damping 0.1 --motion circular --acceleration 0.065 --tilt 0.03 0 --periods 200"
    axes = "--x angular-frequency 1.5 2.5 3 --y start-phase 0 1 2"
    assert run(["map", *options.split(), *axes.split(), "--end-converged", "--output", str(saved)]) == 0
    found = sb.load(saved)
    rolling = found["outcome"] == sb.Outcome.ROLLING
    assert (found["end_time"] < 0.5 * 200.0 * 2.0 * np.pi / found["angular_frequency"]).where(rolling, other=True).all()
    assert rolling.any()
    again = tmp_path / "again.nc"
    assert run(["map", str(saved), "--rtol", "1e-9", "--output", str(again)]) == 0
    assert json.loads(sb.load(again).attrs["provenance"])["end_converged"] is True
    capsys.readouterr()
    assert run(["map", *options.replace("circular", "straight").split(), *axes.split(), "--end-converged"]) != 0
    assert "end_converged: the base motion must be circular" in capsys.readouterr().err
