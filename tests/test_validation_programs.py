"""OpenSees and MapPy beside the package: what these comparisons compute themselves, and programs that are left out."""

import math
import re

import numpy as np
import pytest
from validation import engines, hybrid_orbit, opensees
from validation.rolling_rim import settling

import stylobate as sb
from stylobate.models.finite_tilt import planar_rates


def test_a_block_of_small_rotations_differs_from_the_block_by_the_square_of_its_angle():
    def difference(angle):
        block = opensees.Block(angle)
        run = sb.simulate(block.model(), tilt=(0.5 * angle, 0.0), duration=8.0, rtol=1e-12)
        return run.events[0].time / opensees.small_rotations(block) - 1.0

    first, second = difference(0.1), difference(0.05)
    assert 1e-3 < first < 1e-2
    assert first / second == pytest.approx(4.0, rel=0.02)


def test_the_first_passage_and_the_peak_before_it_are_those_of_the_curve():
    times = np.linspace(0.0, 3.0, 3001)
    tilts = 0.1 * np.sin(2.0 * times)
    tilts[:5] *= -1.0  # vibrations of the base before the uplift
    assert opensees.passage(times, tilts) == pytest.approx(0.5 * math.pi, abs=1e-6)
    assert opensees.peak(times, tilts) == pytest.approx(0.1, abs=1e-6)


def test_the_restitution_is_that_of_the_energy_of_the_second_swing(monkeypatch):
    block, e = opensees.Block(0.2), 0.9
    h, r = 0.5 * block.height, 0.5
    energy = e**2 * (r - 0.5 * h * 0.1) * 0.1
    second = (r - math.sqrt(r * r - 2.0 * h * energy)) / h
    times = np.linspace(0.0, 1.5, 1501)
    curve = np.where(times < 0.5, 0.1, -second) * np.cos(math.pi * times)
    monkeypatch.setattr(opensees, "rocking", lambda *_, **__: (times, np.where(times < 0.5, curve, -np.abs(curve))))
    assert opensees._restitution(block, 1e-6, 0.05) == pytest.approx(e, rel=1e-5)


def test_the_page_states_what_opensees_gave():
    rows = (engines.FOLDER / "opensees.txt").read_text("utf-8").splitlines()[2:]
    free, slenderer, time, peak, restitution = (re.split(r" *\| *", row)[1:] for row in rows)
    assert float(free[3]) / float(free[2]) == pytest.approx(1.01, abs=2e-3)  # 1 % earlier
    assert float(free[4]) / float(slenderer[4]) == pytest.approx(4.0, rel=0.1)  # with α²
    for row in (time, peak):
        softer, stiffer = map(float, re.findall(r"5e-0[67]: (\d\S+e-\d+)", row[1]))
        assert softer / stiffer == pytest.approx(10**0.5, rel=0.1)  # like √e0
        assert stiffer / float(row[4]) == pytest.approx(10**0.5, rel=0.1)
    assert (round(float(restitution[2]), 2), round(float(restitution[3]), 2)) == (0.96, 0.94)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_the_block_of_the_general_code_is_planar_rocking(side):
    random = np.random.default_rng(1)
    model = hybrid_orbit.MODEL
    for tilt, rate, base in random.uniform([0.0, -0.2, -1.0], [0.3, 0.2, 1.0], (20, 3)):
        _, expected = planar_rates(side * tilt, rate, side, base, 0.0, *model.parameters)
        assert hybrid_orbit.acceleration(side * tilt, rate, base, side) == pytest.approx(expected, rel=1e-12)


def test_the_orbit_of_the_general_code_has_two_impacts_in_a_period():
    orbit = hybrid_orbit.orbit(hybrid_orbit.FREQUENCIES[0])
    line = orbit.motion
    start = {"tilt": (orbit.state[0], 0.0), "tilt_rate": (orbit.state[1], 0.0)}
    run = sb.simulate(hybrid_orbit.MODEL, line, **start, duration=line.period, rtol=1e-11)
    assert [event.kind for event in run.events] == ["impact", "impact"]
    assert orbit.multipliers.imag.max() > 0.1


def test_rolling_resistance_lowers_the_tilt_that_is_compared():
    case = settling()
    assert case.exact < 0.6 * math.degrees(case.tilt)


@pytest.mark.parametrize("part", [opensees, hybrid_orbit])
def test_programs_that_are_missing_are_left_out_by_name(part, monkeypatch, capsys):
    monkeypatch.setattr(opensees, "version", lambda _: "")
    monkeypatch.delenv(hybrid_orbit.VARIABLE, raising=False)
    assert list(part.findings()) == []
    assert "left out" in capsys.readouterr().out


def test_only_engines_with_the_same_law_settle(monkeypatch):
    assert set(engines.RESISTING) <= set(engines.ENGINES)
    assert list(engines.settled({"PyBullet": None})) == []
