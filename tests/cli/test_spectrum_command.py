"""`stylobate spectrum` does what the studies of spectra do, keeps what it computed, and shows it again."""

import json

import numpy as np
import pytest
import xarray as xr

import stylobate as sb
from stylobate.cli.main import run
from stylobate.config import study_config
from stylobate.errors import ConfigError

COLUMN = ["--slenderness", "0.1", "--damping", "0.1"]
OVER = ["--motion", "one-sine", "--x", "angular-frequency", "3", "6", "2"]
INTERVALS = ["spectrum", *COLUMN, *OVER, "--scales", "0.1", "1.5", "10", "--width", "0.01"]
SpectrumConfig = study_config(sb.earthquakes.overturning_intervals)
MODEL = sb.Wobbling(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
SINE = sb.Pulse.one_sine(acceleration=1.0, angular_frequency=1.0)


@pytest.fixture(scope="module")
def found():
    scales, over = np.geomspace(0.1, 1.5, 10), {"angular_frequency": [3.0, 6.0]}
    return sb.earthquakes.overturning_intervals(MODEL, SINE, scales=scales, over=over, width=0.01)


@pytest.mark.slow
def test_it_finds_saves_and_shows_what_the_study_finds(tmp_path, capsys, saved, found):
    path, drawn = tmp_path / "intervals.nc", tmp_path / "intervals.png"
    assert run([*INTERVALS, "--output", str(path), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    xr.testing.assert_equal(saved(path), found)
    assert [case["angular_frequency"] for case in told["cases"]] == [3.0, 6.0]
    for place, case in enumerate(told["cases"]):
        assert len(case["intervals"]) == int(found["intervals"][place])
        for interval, row in enumerate(case["intervals"]):
            assert row["interval_from"] == found["interval_from"][place, interval]
    assert run(["spectrum", str(path), "--figure", str(drawn)]) == 0
    table = capsys.readouterr().out
    assert "overturns at scales" in table
    assert f"{found['interval_from'][0, 0]:.4g} to {found['interval_to'][0, 0]:.4g}; " in table
    assert "may be missed" in table
    assert drawn.read_bytes().startswith(b"\x89PNG")


@pytest.mark.slow
def test_a_saved_spectrum_is_repeated_with_other_numbers(tmp_path, capsys, saved, found):
    path, other = tmp_path / "intervals.nc", tmp_path / "other.nc"
    found.to_netcdf(path, engine="h5netcdf")
    assert run(["spectrum", str(path), "--free-tail", "30", "--output", str(other)]) == 0
    again = saved(other)
    assert json.loads(again.attrs["provenance"])["tail"] == 30.0
    np.testing.assert_array_equal(again["interval_from"], found["interval_from"])
    np.testing.assert_array_equal(again["scale"], found["scale"])


def test_a_store_goes_on_with_the_same_options(tmp_path, capsys):
    store = tmp_path / "intervals.zarr"
    told = []
    for more in ([], ["--resume"]):
        assert run([*INTERVALS, "--output", str(store), "--json", *more]) == 0
        told.append(json.loads(capsys.readouterr().out))
    assert told[0] == told[1]
    assert run(["spectrum", str(store)]) == 2
    assert "--resume" in capsys.readouterr().err


def test_an_interrupted_scan_is_told_and_can_go_on(tmp_path, capsys, interrupted):
    store = tmp_path / "intervals.zarr"
    assert run([*INTERVALS, "--output", str(store)]) == 130
    told = capsys.readouterr()
    assert "20 of 20 runs are done" in told.err
    assert "--resume" in told.err
    interrupted.undo()
    assert run([*INTERVALS, "--output", str(store), "--resume"]) == 0


def test_a_rocking_spectrum_tells_peaks(tmp_path, capsys):
    path = tmp_path / "rocking.nc"
    rocking = ["spectrum", *COLUMN, "--motion", "one-sine", "--acceleration", "0.15", "--angular-frequency", "2"]
    assert run([*rocking, "--rocking", "--x", "size", "1", "9", "2", "--output", str(path), "--json"]) == 0
    first, second = json.loads(capsys.readouterr().out)["cases"]
    over = {"size": [1.0, 9.0]}
    pulse = sb.Pulse.one_sine(acceleration=0.15, angular_frequency=2.0)
    found = sb.earthquakes.rocking_spectrum(MODEL, pulse, over=over)
    assert first["outcome"] == "overturned"
    assert first["peak_tilt_ratio"] is None
    assert second["peak_tilt_ratio"] == found["peak_tilt_ratio"][1]
    assert run(["spectrum", str(path)]) == 0
    assert "peak tilt / α" in capsys.readouterr().out


def test_one_column_needs_no_quantity_that_varies(capsys):
    one = ["spectrum", *COLUMN, "--motion", "half-sine", "--angular-frequency", "2", "--scales", "0.1", "0.5", "4"]
    assert run(one) == 0
    assert "1 case, model wobbling, damping" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (INTERVALS[:-6], "spectrum.scales are missing"),
        (
            [*INTERVALS, "--rocking", "--acceleration", "1"],
            "spectrum.scales is not supported by a rocking spectrum. Remove it.",
        ),
        ([*INTERVALS, "--y", "angular-frequency", "1", "2", "2"], "spectrum.x and spectrum.y must differ"),
        ([*INTERVALS, "--y", "weight", "1", "2", "2"], "spectrum.y: weight is not known here"),
        (["spectrum", *COLUMN, *OVER, "--scales", "1", "0.1", "3"], "scales must be two or more positive numbers"),
        (["spectrum", *COLUMN, *OVER, "--scales", "0", "1", "3"], "spectrum.scales: from must be positive, got 0.0"),
        (
            ["spectrum", *COLUMN, "--motion", "circular", *OVER[2:], "--scales", "1", "2", "3"],
            "duration must be given",
        ),
    ],
)
def test_bad_questions_are_told_in_one_line(arguments, line, capsys):
    assert run(arguments) == 2
    told = capsys.readouterr().err.splitlines()
    assert line in told[0]


def test_a_saved_map_is_no_spectrum(tmp_path, capsys, found):
    path = tmp_path / "map.nc"
    found.assign_attrs(kind="overturning map").to_netcdf(path, engine="h5netcdf")
    assert run(["spectrum", str(path)]) == 2
    assert "no spectrum" in capsys.readouterr().err


def test_a_description_says_the_same_and_leaves_other_commands_alone(found):
    values = {
        "column": {"shape": "dimensionless", "slenderness": 0.1},
        "model": {"damping": 0.1, "kind": "wobbling"},
        "motion": {"kind": "one_sine"},
        "periods": 400.0,
        "map": {"x": {"name": "damping", "values": [0.1]}},
        "spectrum": {
            "x": {"name": "angular_frequency", "values": [3.0, 6.0]},
            "scales": {"from": 0.1, "to": 1.5, "number": 10},
            "width": 0.01,
        },
    }
    setup = SpectrumConfig.parse(values).build()
    assert setup.model == MODEL
    np.testing.assert_allclose(setup.options["scales"], found["scale"], rtol=1e-15)
    assert "periods" not in setup.options
    with pytest.raises(ConfigError, match=r"motion\.angular_frequency is missing"):
        SpectrumConfig.parse({**values, "spectrum": {"scales": {"values": [1.0, 2.0]}}})
