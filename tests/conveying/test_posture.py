"""Whether a part on a vibrating base stays upright: shares over tilts and phases, against a block of its own."""

import json
import math

import numpy as np
import pytest
import xarray as xr
from tests.conveying.planar_block import fallen_and_travel

import stylobate as sb
from stylobate.cli.main import run
from stylobate.conveying import Posture, upright
from stylobate.results.storage import write_netcdf
from stylobate.studies.proportions import wilson_interval

PIN = sb.Column.solid(radius=0.006, height=0.040, density=7850.0)
PART = sb.Sliding(PIN, friction_coefficient=0.2, damping=0.05, normal_restitution=0.1)
STRONG = sb.Harmonic.stroke(stroke=0.001, frequency=50.0, angle=math.radians(25.0))
WEAK = sb.Harmonic.stroke(stroke=0.0003, frequency=50.0, angle=math.radians(25.0))


@pytest.fixture(scope="module")
def found():
    return upright(PART, STRONG, tilts=[0.0, 1e-3], phases=16, friction=[0.1, 0.2], periods=30)


def counts(found):
    return [(found["posture"] == kind).sum().item() for kind in Posture]


def test_shares_are_those_of_the_runs_that_have_a_tilt(found):
    tilted = found.isel(run=found["initial_tilt"].values > 0.0)
    assert int(found["counted"]) == tilted.sizes["run"] == 32
    np.testing.assert_array_equal(found["share"] * 32, counts(tilted))
    np.testing.assert_allclose(found["share"].sum(), 1.0, rtol=1e-15)
    assert (found["share_low"] <= found["share"]).all()
    assert (found["share"] <= found["share_high"]).all()
    low, high = wilson_interval(counts(tilted), 32, confidence=0.9)
    np.testing.assert_allclose(found["share_low"], low, atol=1e-15)
    np.testing.assert_allclose(found["share_high"], high, atol=1e-15)
    one = found["share_of_tilt"].sel(friction=0.2, tilt=1e-3)
    of_one = found.isel(run=(found["initial_tilt"].values == 1e-3) & (found["friction_coefficient"].values == 0.2))
    np.testing.assert_array_equal(one * 16, counts(of_one))


def test_each_run_is_that_of_its_tilt_and_phase(found):
    number = int(np.flatnonzero(found["posture"] == Posture.FALLEN)[0])
    one = found.isel(run=number)
    changed = sb.with_parameters(
        PART, STRONG, friction_coefficient=float(one["friction_coefficient"]), start_phase=float(one["phase"])
    )
    size, azimuth = float(one["initial_tilt"]), float(one["azimuth"])
    alone = sb.simulate(*changed, tilt=(size * math.cos(azimuth), size * math.sin(azimuth)), duration=30 / 50.0)
    assert alone.outcome is sb.Outcome.OVERTURNED
    assert alone.measures["peak_tilt"] == float(one["peak_tilt"])


def test_a_start_at_a_tilt_of_exactly_0_lands_flat_above_throw_number_1_and_is_not_counted(found):
    flat = found["initial_tilt"] == 0.0
    assert found.attrs["throw_number"] > 1.0
    assert found["lands_flat"].values[flat].all()
    assert (found["posture"].values[flat] == Posture.UPRIGHT).all()
    assert "32 runs that start exactly flat are not counted" in found.attrs["verdict"]
    alone = upright(PART, STRONG, tilts=[0.0], phases=3, periods=10)
    assert int(alone["counted"]) == 0
    assert np.isnan(alone["share"]).all()
    assert alone.attrs["verdict"].startswith("not decided: all runs start exactly flat")


def test_below_throw_number_1_a_flat_start_counts_and_stays_upright():
    weak = upright(PART, WEAK, tilts=[0.0], phases=64, periods=10)
    assert weak.attrs["throw_number"] < 1.0
    assert int(weak["counted"]) == 64
    assert weak.attrs["verdict"].startswith("stays upright: 100 % of 64 runs")


def test_a_single_run_that_lands_flat_warns_and_a_tilted_one_does_not():
    flat = sb.simulate(PART, STRONG, duration=0.4)
    assert any("lands at a tilt of exactly 0" in line for line in flat.warnings)
    askew = sb.simulate(PART, STRONG, tilt=(0.01, 0.0), duration=0.4)
    assert not any("exactly 0" in line for line in askew.warnings)
    assert sb.simulate(PART, WEAK, duration=0.4).warnings == ()


@pytest.mark.slow  # compiles a kernel
def test_a_phase_of_a_sum_of_vibrations_is_a_delay():
    half = 0.5 * STRONG.peak_horizontal()
    both = sb.Harmonic.straight(acceleration=half, angular_frequency=300.0) + sb.Harmonic.vertical(
        acceleration=half, angular_frequency=300.0
    )
    one = sb.Harmonic(amplitude=(half, 0.0, half), angular_frequency=300.0)
    arguments = {"tilts": [1e-3], "phases": 4, "periods": 3}
    split, joined = (upright(PART, motion, **arguments) for motion in (both, one))
    # The phases differ by the rounding of a delay times a frequency, which three periods enlarge little.
    np.testing.assert_allclose(split["peak_tilt"], joined["peak_tilt"], rtol=1e-6)


def test_it_is_saved_loaded_and_drawn(found, tmp_path):
    path = write_netcdf(found, tmp_path / "posture.nc")
    again = sb.load(path)
    assert again.attrs["verdict"] == found.attrs["verdict"]
    xr.testing.assert_equal(again["share_of_tilt"], found["share_of_tilt"])
    assert len(sb.plot(again).axes) == 2


def test_runs_without_a_mean_tilt_are_undecided_unless_they_rest():
    """The last ten periods follow at least one: runs of ten periods are too short, runs of eleven are not."""
    short, long = (upright(PART, STRONG, tilts=[1e-2], phases=8, periods=periods) for periods in (10, 11))
    undecided = short["posture"].values == -1
    assert undecided.any()
    assert (undecided | (short["posture"].values == Posture.FALLEN)).all()
    assert (short["share_high"] - short["share_low"] >= undecided.mean()).all()
    assert "are undecided" in short.attrs["verdict"]
    assert "increase periods to 11 or more" in short.attrs["verdict"]
    assert (long["posture"] >= 0).all()
    assert "undecided" not in long.attrs["verdict"]
    still = sb.Harmonic.stroke(stroke=1e-5, frequency=50.0, angle=0.4)
    resting = upright(PART, still, tilts=[0.0], phases=4, periods=3)
    assert (resting["outcome"] == sb.Outcome.AT_REST).all()
    assert (resting["posture"] == Posture.UPRIGHT).all()


def test_a_tilt_in_the_plane_of_vibration_is_marked_and_a_tilt_beside_it_is_not():
    arguments = {"tilts": [1e-2], "phases": 4, "periods": 20}
    within, beside = (upright(PART, STRONG, azimuth=azimuth, **arguments) for azimuth in (math.pi, 1e-6))
    assert within["planar"].values.all()
    assert not beside["planar"].values.any()
    assert "exactly in one vertical plane" in within.attrs["verdict"]
    assert "vertical plane" not in beside.attrs["verdict"]
    flat = upright(PART, WEAK, tilts=[0.0], phases=4, periods=20)
    assert "vertical plane" not in flat.attrs["verdict"]


def test_angles_of_an_initial_tilt_have_units_in_python_in_a_file_and_in_the_shell(tmp_path, capsys):
    unit = pytest.importorskip("pint").UnitRegistry()
    plain = {"tilts": np.radians([0.1, 0.5]), "azimuth": math.radians(30.0), "friction": [0.28], "confidence": 0.8}
    arguments = {"phases": 2, "periods": 12}
    wanted = upright(PART, STRONG, **plain, **arguments)
    given = {"tilts": [0.1, 0.5] * unit.degree, "azimuth": 30 * unit.degree}
    given |= {"friction": [28] * unit.percent, "confidence": 80 * unit.percent}
    found = upright(PART, STRONG, **given, **arguments)
    np.testing.assert_allclose(found["tilt"], wanted["tilt"], rtol=1e-15)
    np.testing.assert_allclose(found["azimuth"], wanted["azimuth"], rtol=1e-15)
    assert found.attrs["verdict"] == wanted.attrs["verdict"]
    part = ["--radius", "6mm", "--height", "40mm", "--density", "7850", "--friction-coefficient", "0.2"]
    part += ["--damping", "0.05", "--normal-restitution", "0.1", "--motion", "stroke", "--stroke", "1mm"]
    part += ["--frequency", "50", "--angle", "25deg", "--periods", "12", "--phases", "2", "--json"]
    starts = [
        "--tilts",
        "0.1deg",
        "--tilts",
        "0.5deg",
        "--azimuth",
        "30deg",
        "--friction",
        "28%",
        "--confidence",
        "80%",
    ]
    assert run(["upright", *part, *starts]) == 0
    assert json.loads(capsys.readouterr().out)["verdict"] == wanted.attrs["verdict"]
    described = tmp_path / "starts.toml"
    described.write_text(
        '[upright]\ntilts = ["0.1 deg", "0.5 deg"]\nazimuth = "30 deg"\nfriction = ["28 %"]\nconfidence = "80 %"\n',
        encoding="utf-8",
    )
    assert run(["upright", str(described), *part]) == 0
    assert json.loads(capsys.readouterr().out)["verdict"] == wanted.attrs["verdict"]


def planar_counts(tilts, phases, periods, steps):
    """Return the numbers of fallen runs of each tilt along the vibration: of the package, and of the block."""
    undamped = sb.Sliding(PIN, friction_coefficient=0.2, normal_restitution=0.1)
    found = upright(undamped, STRONG, tilts=tilts, phases=phases, azimuth=0.0, periods=periods)
    along, _, normal = STRONG.amplitude
    starts = {"tilts": found["initial_tilt"].values, "phases": found["phase"].values}
    bodies = {"friction": 0.2, "restitution": 0.1, "along": along, "normal": normal, "frequency": 50.0}
    fallen, _ = fallen_and_travel(PIN, **bodies, **starts, periods=periods, steps=steps)
    fell = (found["posture"].values == Posture.FALLEN).reshape(len(tilts), phases)
    return fell.sum(axis=1), fallen.reshape(len(tilts), phases).sum(axis=1)


def expect_alike(ours, others, phases):
    """Chaotic runs agree in number: within three standard deviations of the difference of two binomial counts."""
    share = np.clip((ours + others) / (2.0 * phases), 1.0 / phases, None)
    assert (np.abs(ours - others) <= 3.0 * np.sqrt(2.0 * phases * share * (1.0 - share))).all()


@pytest.mark.slow
def test_a_block_by_time_stepping_falls_as_often():
    ours, others = planar_counts([0.01], 64, periods=30, steps=100)
    assert ours.min() > 0
    expect_alike(ours, others, 64)


@pytest.mark.slow
def test_a_block_by_time_stepping_falls_as_often_at_each_tilt():
    ours, others = planar_counts([0.0, 1e-5, 1e-4, 1e-3, 1e-2], 64, periods=60, steps=500)
    assert ours[0] == others[0] == 0
    expect_alike(ours, others, 64)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"tilts": [-0.1]}, "tilts: must be one or more angles from 0"),
        ({"tilts": []}, "tilts: must be one or more angles from 0"),
        ({"tilts": [5.0]}, "^tilts must lie between .* For 5 deg give 0.08727 rad"),
        ({"friction": [-1.0]}, "^friction must lie between"),
        ({"phases": 0}, "phases"),
        ({"friction": []}, "friction: must be at least one number"),
        ({"confidence": 1.0}, "confidence must lie between 0 and 1"),
        ({"tilt": (0.1, 0.0)}, "tilt: tilts sets the initial tilts"),
        ({"tilt_limit": 0.1}, "tilt_limit must be left out"),
    ],
)
def test_bad_questions_are_named(change, message):
    with pytest.raises(sb.errors.ParameterError, match=message):
        upright(PART, STRONG, **change)


def test_it_needs_a_contact_that_slips_and_a_period():
    with pytest.raises(sb.errors.UnsupportedError, match="A posture needs Sliding"):
        upright(sb.Rolling(PIN), STRONG)
    with pytest.raises(sb.errors.UnsupportedError, match="periodic base motion"):
        upright(PART, sb.Pulse.one_sine(acceleration=3.0, angular_frequency=30.0))


@pytest.mark.slow
def test_the_command_saves_shows_and_repeats_the_study(tmp_path, capsys, found):
    path, drawn = tmp_path / "posture.nc", tmp_path / "posture.png"
    part = ["--radius", "0.006", "--height", "0.04", "--density", "7850", "--friction-coefficient", "0.2"]
    part += ["--damping", "0.05", "--normal-restitution", "0.1", "--motion", "stroke", "--stroke", "0.001"]
    part += ["--frequency", "50", "--angle", repr(math.radians(25.0)), "--periods", "30", "--phases", "16"]
    part += ["--tilts", "0", "--tilts", "0.001", "--friction", "0.1", "--friction", "0.2"]
    assert run(["upright", *part, "--output", str(path), "--figure", str(drawn), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["verdict"] == found.attrs["verdict"]
    assert told["shares"]["fallen"]["share"] == float(found["share"].sel(posture_name="fallen"))
    assert drawn.read_bytes().startswith(b"\x89PNG")
    assert run(["upright", str(path)]) == 0
    assert found.attrs["verdict"] in capsys.readouterr().out.replace("\n", " ")
    assert run(["upright", str(path), "--friction", "0.1", "--json"]) == 0
    again = json.loads(capsys.readouterr().out)
    assert again["runs"] == 32
    of_one = found["share_of_tilt"].sel(friction=0.1, tilt=1e-3)
    assert list(again["by_tilt"][1].values())[2:] == of_one.values.tolist()
