"""`stylobate drift` does what `drift` does, keeps what it computed, and shows it again."""

import json

import numpy as np
import pytest
import xarray as xr

import stylobate as sb
from stylobate.cli.main import run

BLOCK = ["--radius", "1.5", "--height", "2", "--density", "1000", "--friction-coefficient", "0.2"]
SLOPE = ["--incline", "0.1", "--motion", "straight", "--angular-frequency", "3"]
OVER = ["--x", "acceleration", "0.5", "12", "4"]
DRIFT = ["drift", *BLOCK, *SLOPE, *OVER, "--periods", "12", "--late", "4"]


@pytest.fixture(scope="module")
def found():
    block = sb.Column.solid(radius=1.5, height=2.0, density=1000.0)
    model = sb.Sliding(block, friction_coefficient=0.2, incline=0.1)
    shaking = sb.Harmonic.straight(acceleration=1.0, angular_frequency=3.0)
    return sb.conveying.drift(model, shaking, over={"acceleration": np.linspace(0.5, 12.0, 4)}, periods=12.0, late=4)


def test_it_finds_saves_and_shows_what_the_study_finds(tmp_path, capsys, saved, found):
    path, drawn = tmp_path / "drift.nc", tmp_path / "drift.png"
    assert run([*DRIFT, "--output", str(path), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    xr.testing.assert_equal(saved(path), found)
    assert [row["acceleration"] for row in told["drifts"]] == found["acceleration"].values.tolist()
    velocities = np.array([row["mean_velocity"] for row in told["drifts"]])
    np.testing.assert_array_equal(velocities, found["mean_velocity"])
    assert told["drifts"][0]["contact_class"] == "STAYS"
    assert told["drifts"][-1]["contact_class"] == "SLIDES"
    assert run(["drift", str(path), "--figure", str(drawn)]) == 0
    shown = capsys.readouterr().out
    assert "speed [m/s]" in shown
    assert "twist rate [°/s]" in shown
    assert drawn.read_bytes().startswith(b"\x89PNG")


FEEDER = [
    "--radius",
    "30mm",
    "--height",
    "0.2",
    "--density",
    "884",
    "--friction-coefficient",
    "0.2",
    "--motion",
    "stroke",
]
FEEDER += ["--frequency", "50", "--angle", "25deg", "--periods", "8", "--late", "4", "--most-periods", "8"]


def test_small_lengths_and_angles_are_in_millimetres_and_degrees_and_knife_edges_are_counted(capsys):
    assert run(["drift", *FEEDER, "--x", "stroke", "0.2mm", "1.2mm", "2", "--y", "angle", "20deg", "25deg", "2"]) == 0
    shown = capsys.readouterr().out
    for heading in ("stroke [mm]", "angle [°]", "[mm/s]"):
        assert heading in shown
    assert "│ 1.2         │ 25" in shown
    assert "2 runs landed at a tilt of exactly 0" in shown
    assert "vertical plane" not in shown
    assert run(["drift", *FEEDER, "--x", "stroke", "1mm", "1.2mm", "2", "--tilt", "0.01", "0"]) == 0
    shown = capsys.readouterr().out
    assert "2 runs stayed in exactly one vertical plane" in shown
    assert "exactly 0" not in shown


def test_a_stroke_in_metres_is_questioned_once(capsys):
    assert run(["drift", *FEEDER, "--x", "stroke", "1", "1.2", "3"]) == 0
    assert capsys.readouterr().err.count("is unlikely") == 1


def test_a_store_is_shown_as_a_drift_and_repeated_with_other_numbers(tmp_path, capsys, saved, found):
    store, path = tmp_path / "drift.zarr", tmp_path / "again.nc"
    assert run([*DRIFT, "--output", str(store), "--json"]) == 0
    first = json.loads(capsys.readouterr().out)
    assert run(["drift", str(store), "--json"]) == 0
    again = json.loads(capsys.readouterr().out)
    assert again["drifts"] == first["drifts"]
    assert run(["drift", str(store), "--late", "2", "--output", str(path), "--json"]) == 0
    others = saved(path)
    # The motion is nearly periodic by then: means over fewer periods are nearly the same.
    np.testing.assert_allclose(others["mean_velocity"], found["mean_velocity"], rtol=1e-3, atol=1e-9)
    assert json.loads(others.attrs["provenance"])["rules"]["periods"] == 2


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (["--late", "12"], "periods must be at least one more than late, which is 12; got 12.0"),
        (
            ["--model", "rolling"],
            "--friction-coefficient: model 'rolling' does not use it (got 0.2). Remove it, or choose --model sliding.",
        ),
        (["--y", "acceleration", "1", "2", "2"], "drift.x and drift.y must differ, got 'acceleration' in both"),
        (["--y", "tilt-z", "1", "2", "2"], "drift.y"),
        (
            ["--y", "tilt-z", "1mm", "2mm", "2"],
            "tilt_z is not known here, so its unit cannot be converted; did you mean",
        ),
        (["--diameter", "60mm"], "A column has --radius, half of its diameter."),
    ],
)
def test_bad_questions_are_told_in_one_line(arguments, line, capsys):
    given = [part for part in DRIFT if "incline" not in part and part != "0.1"] if "rolling" in arguments else DRIFT
    assert run([*given, *arguments]) == 2
    told = capsys.readouterr().err.splitlines()
    assert len(told) == 1
    assert line in told[0]


def test_what_varies_must_be_told(capsys):
    assert run(["drift", *BLOCK, *SLOPE]) == 2
    assert (
        "drift.x is missing. State what varies: --x acceleration 2 30 29, or --x acceleration 9 9 1 for one run."
        in capsys.readouterr().err
    )


def test_a_saved_map_is_no_drift(tmp_path, capsys):
    path = tmp_path / "map.nc"
    rolling = ["map", "--slenderness", "0.1", "--motion", "circular", "--periods", "2"]
    rolling += ["--x", "angular-frequency", "1", "2", "2", "--y", "acceleration", "0.01", "0.02", "2"]
    assert run([*rolling, "--output", str(path)]) == 0
    capsys.readouterr()
    assert run(["drift", str(path)]) == 2
    assert "no drift" in capsys.readouterr().err
