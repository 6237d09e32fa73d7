"""Other programs on a rolling rim: the answers are those of theory, and engines that are not installed are left out."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest
from validation import engines
from validation.rolling_rim import cases

from stylobate import theory

CASES = cases()


@pytest.mark.parametrize("name", ["rolling", "coin"])
def test_the_rate_of_precession_is_that_of_free_rolling(name):
    assert CASES[name].exact == pytest.approx(CASES[name].turning, rel=1e-9)


def test_the_tilt_on_the_circling_base_is_that_of_steady_rolling():
    assert CASES["circling"].exact == pytest.approx(math.degrees(CASES["circling"].tilt), rel=1e-9)


def test_the_turn_of_the_can_tends_to_its_closed_form_as_its_offset_does():
    case = CASES["can"]
    limit = math.degrees(theory.angle_of_turn(case.column.slenderness, inertia_ratio=case.column.inertia_ratio))
    # The difference is ε (a − b ln ε) to the first order of the offset ε.
    first, second, third = (
        (replace(case, turning=share * case.turning).exact - limit) / share for share in (1.0, 0.1, 0.01)
    )
    assert third - second == pytest.approx(second - first, rel=1e-3)


@pytest.mark.parametrize("case", CASES.values(), ids=CASES)
def test_engines_start_with_the_rim_at_rest_on_the_plane_and_the_axis_turning(case):
    centre, rotation, velocity, spinning = case.placed()
    rim = [[math.cos(a) * case.column.radius, math.sin(a) * case.column.radius, -case.column.mass_height]
           for a in np.linspace(0.0, 2.0 * np.pi, 361)]  # fmt: skip
    assert min((centre + rotation @ point)[2] for point in rim) == pytest.approx(0.0, abs=1e-12)
    assert velocity + np.cross(spinning, -centre) == pytest.approx(np.zeros(3), abs=1e-12)
    moved = np.cross(spinning, rotation[:, 2])
    assert moved == pytest.approx([0.0, math.sin(case.tilt) * case.turning, 0.0], abs=1e-12)


def test_the_page_states_the_errors_that_were_measured():
    points = json.loads((engines.FOLDER / "engines.json").read_text("utf-8"))
    errors = {(point["case"], point["engine"], point["step"]): point["error"] for point in points if "step" in point}

    def falls(case, engine):
        return math.log10(errors[case, engine, 1e-3] / errors[case, engine, 1e-4])

    for engine in ("MuJoCo", "PyBullet", "Drake"):
        for case in ("rolling", "circling", "coin"):
            assert falls(case, engine) == pytest.approx(1.0, abs=0.25)  # in proportion to the step
        for case in ("rolling", "can", "circling"):
            assert max(errors[case, engine, step] for step in engines.STEPS[1:]) < 0.01
        assert errors["coin", engine, 1e-4] > 0.01
    for case in CASES:
        assert falls(case, "Exudyn") == pytest.approx(2.0, abs=0.25)  # to its square
    for engine in ("MuJoCo, default contact", "PyBullet, default settings"):
        assert falls("rolling", engine) == pytest.approx(0.0, abs=0.01)


def test_engines_that_are_not_installed_are_left_out_by_name(monkeypatch, capsys):
    monkeypatch.setattr(engines, "version", lambda package: "" if package in {"drake", "pybullet"} else "1")
    assert list(engines.installed()) == ["MuJoCo", "MuJoCo, default contact", "Exudyn"]
    assert capsys.readouterr().out == "left out, not installed: drake, pybullet\n"


def test_a_can_that_never_rises_again_has_no_angle_of_turn():
    times = np.linspace(0.0, 3.0, 301)
    assert math.isnan(CASES["can"].scalar(times, np.exp(-times), times))
