"""The sheet of a feeder: each number by a second route."""

import csv
import json
import math

import numpy as np
import pytest

import stylobate as sb
from stylobate.cli.main import run
from stylobate.conveying import sheet, sheet_rows, upright

PIN = sb.Column.solid(radius=0.006, height=0.040, density=7850.0)
PART = sb.Sliding(PIN, friction_coefficient=0.2)
STARTS = {"tilts": [1e-3, 1e-2], "phases": 8, "periods": 20}
STROKE, FREQUENCY, ANGLE = 0.0006, 50.0, math.radians(25.0)
TROUGH = sb.Harmonic.stroke(stroke=STROKE, frequency=FREQUENCY, angle=ANGLE)


@pytest.fixture(scope="module")
def found():
    return sheet(PART, TROUGH, friction=[0.2, 0.28], **STARTS)


def test_machine_and_throw_number_are_those_of_the_data_sheet(found):
    machine = 0.5 * STROKE * (2.0 * math.pi * FREQUENCY) ** 2 / PIN.gravity
    assert float(found["machine_number"]) == pytest.approx(machine, rel=1e-12)
    assert float(found["throw_number"]) == pytest.approx(machine * math.sin(ANGLE), rel=1e-12)
    assert float(found["critical_friction"]) == pytest.approx(0.3, rel=1e-12)


def test_the_hop_is_that_of_a_bouncing_mass(found):
    hop = float(found["hop_number"])
    assert sb.theory.flight_throw_number(hop) == pytest.approx(float(found["throw_number"]), rel=1e-9)
    assert float(found["flight_time"]) == pytest.approx(hop / FREQUENCY, rel=1e-12)
    assert int(found["hop_periods"]) == 1


def _stroke(throw):
    return 2.0 * throw * PIN.gravity / ((2.0 * math.pi * FREQUENCY) ** 2 * math.sin(ANGLE))


_END, _SECOND_END = (_stroke(math.sqrt(4.0 + (n * math.pi) ** 2) * (1.0 - 1e-4)) for n in (1, 2))


@pytest.mark.parametrize(
    ("stroke", "hops", "periods"),
    # 0.64, plateaus, 6.38, and the last ten-thousandth of both plateaus
    [(0.0003, 0.0, 1), (0.0016, 1.0, 1), (0.00165, 1.0, 1), (0.0030, 2.0, 2), (_END, 1.0, 1), (_SECOND_END, 2.0, 2)],
)
def test_hops_are_locked_to_whole_periods_on_their_plateaus(stroke, hops, periods):
    motion = sb.Harmonic.stroke(stroke=stroke, frequency=FREQUENCY, angle=ANGLE)
    one = sheet(PART, motion, **STARTS, max_steps=1_000_000)
    assert float(one["hop_number"]) == pytest.approx(hops, abs=1e-6)
    assert int(one["hop_periods"]) == periods


@pytest.mark.parametrize("throw", [3.35, 3.6, 6.40, 6.50, 9.50, 9.55])
def test_hops_on_plateaus_are_those_of_a_block_that_settles(throw):
    motion = sb.Harmonic.stroke(stroke=_stroke(throw), frequency=FREQUENCY, angle=ANGLE)
    one = sheet(PART, motion, tilts=[1e-3], phases=1, periods=11)
    cycle = sb.theory.block_cycle(0.0, throw, static_friction=1e3, cycles=10_000)
    assert int(one["hop_periods"]) == cycle.period == round(throw / math.pi)
    # The block leaves where it lands, so its flights add up to whole periods.
    assert cycle.fraction[sb.theory.BlockPhase.FLIGHT] == pytest.approx(1.0, abs=1e-12)
    assert float(one["hop_number"]) == cycle.period


def test_a_part_that_stays_upright_on_a_level_track_can_fall_on_the_steepest_one():
    bottle = sb.Column.solid(radius=0.03, height=0.2, density=884.0)
    motion = sb.Harmonic.stroke(stroke=0.0012, frequency=50.0, angle=ANGLE, direction=2.0)
    found = sheet(sb.Sliding(bottle, friction_coefficient=0.28), motion, tilts=[1e-3], phases=16)
    slope = float(found["steepest_incline"][0])
    track = sb.Sliding(bottle, friction_coefficient=0.28, incline=slope, incline_direction=2.0 - math.pi)
    alone = upright(track, motion, tilts=[1e-3], phases=16)
    assert str(found["steepest_verdict"][0].item()).partition(";")[0] == alone.attrs["verdict"].partition(";")[0]
    assert float(found["share"].sel(posture_name="fallen")[0]) == 0.0
    assert float(alone["share"].sel(posture_name="fallen")) > 0.5


@pytest.mark.slow
def test_the_table_states_a_horizontal_vibration_and_the_default_friction():
    level = sheet(sb.Sliding(PIN), sb.Harmonic.stroke(stroke=STROKE, frequency=FREQUENCY), tilts=[0.0], phases=1)
    rows = dict(sheet_rows(level))
    assert rows["vibration angle"] == ["0.0° (horizontal)"]
    assert rows["friction"] == ["0.5 (the default)"]
    with pytest.raises(sb.errors.ParameterError, match="kind 'feeder sheet', which has no figure"):
        sb.plot(level)


def test_speeds_are_those_of_a_block(found):
    along, normal = (float(found["machine_number"]) * part for part in (math.cos(ANGLE), math.sin(ANGLE)))
    block = sb.theory.mean_block_speed(along, normal, static_friction=[0.2, 0.28])
    speeds = block * PIN.gravity / (2.0 * math.pi * FREQUENCY)
    np.testing.assert_allclose(found["speed"], speeds, rtol=1e-6)
    np.testing.assert_allclose(found["direction"], 0.0, atol=1e-9)
    assert (found["speed_low"] <= found["speed"]).all()
    assert (found["tilted_speed_low"] <= found["tilted_speed_high"]).all()


def test_a_part_climbs_below_the_steepest_track_and_slides_back_above_it():
    weak = sb.Harmonic.stroke(stroke=0.0004, frequency=FREQUENCY, angle=ANGLE)
    steepest = float(sheet(PART, weak, **STARTS)["steepest_incline"][0])
    assert 0.0 < steepest < math.atan(0.2)
    for off, sense in ((-0.003, 1.0), (0.003, -1.0)):
        track = sb.Sliding(PIN, friction_coefficient=0.2, incline=steepest + off, incline_direction=math.pi)
        uphill = sb.conveying.drift(track, weak, over={"friction_coefficient": [0.2]})["mean_velocity"].sel(axis="x")
        assert math.copysign(1.0, float(uphill[0])) == sense


def test_the_posture_is_that_of_upright(found):
    alone = upright(PART, TROUGH, friction=0.28, **STARTS)
    for name in ("share", "share_low", "share_high"):
        np.testing.assert_array_equal(found[name][1], alone[name])
    assert str(found["verdict"][1].item()) == alone.attrs["verdict"]


def test_a_vibration_about_a_circle_has_no_steepest_track():
    circle = sb.Harmonic.displacement_amplitude(
        amplitude=(0.25e-3, 0.25e-3, 0.1e-3), phase=(0.0, -math.pi / 2.0, 0.0), angular_frequency=300.0
    )
    one = sheet(PART, circle, **STARTS)
    assert np.isnan(one["steepest_incline"]).all()
    rows = dict(sheet_rows(one))
    assert rows["steepest track of a part that stays upright"] == rows["posture on that track"] == ["not known"]


def test_it_needs_a_harmonic_motion_and_a_contact_that_slips():
    for model, motion in ((sb.Rolling(PIN), TROUGH), (PART, TROUGH + TROUGH)):
        with pytest.raises(sb.errors.UnsupportedError, match="a feeder sheet needs"):
            sheet(model, motion)


@pytest.mark.slow
def test_the_command_writes_the_sheet(tmp_path, capsys, found):
    arguments = ["feeder", "--radius", "0.006", "--height", "0.04", "--density", "7850", "--motion", "stroke"]
    arguments += [
        "--stroke",
        repr(STROKE),
        "--frequency",
        "50",
        "--angle",
        repr(ANGLE),
        "--friction-coefficient",
        "0.2",
    ]
    arguments += ["--friction", "0.2", "--friction", "0.28", "--tilts", "0.001", "--tilts", "0.01"]
    arguments += ["--phases", "8", "--periods", "20"]
    saved, table = tmp_path / "sheet.nc", tmp_path / "sheet.csv"
    assert run([*arguments, "--output", str(saved), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["speed"] == found["speed"].values.tolist()
    assert sb.load(saved).attrs["kind"] == "feeder sheet"
    assert run(["feeder", str(saved), "--output", str(table)]) == 0
    assert "machine number K" in capsys.readouterr().out
    rows = [row for row in csv.reader(table.read_text(encoding="utf-8").splitlines()) if row]
    assert rows == [[label, *values] for label, values in sheet_rows(found)]
    assert run([*arguments, "--output", "sheet.txt"]) == 2
    assert "--output must end with .nc or .csv" in capsys.readouterr().err
