"""Extremes of the contact loads, within a step and while the column stands, in plain Python."""

import math

import numpy as np
import pytest

import stylobate as sb

COLUMN = sb.Column.dimensionless(0.1)
MODEL = sb.Slender(COLUMN)
MOTION = sb.Harmonic(amplitude=(0.5, 0.2, 0.3), phase=(0.0, 0.5, 1.0), angular_frequency=2.0)


@pytest.fixture
def lane(lane_of):
    return lambda motion=MOTION, **given: lane_of(MODEL, motion, demands=True, **given)


def largest_on_parabolas(values):
    """Return the maximum of the parabolas through the first three and the last three of five values."""
    u = np.linspace(0.0, 1.0, 20_001)
    halves = (values[:3], values[2:])
    return max(np.polyval(np.polyfit([0.0, 0.5, 1.0], half, 2), u).max() for half in halves)


LOADS = ("normal", "friction", "pivoting")
PLACES = ("now", 1, 2, 3, 4)


def test_the_extreme_load_of_a_step_is_that_of_parabolas_through_its_quarters(lane):
    rng = np.random.default_rng(5)
    inside = 0
    for _ in range(60):
        values, before = rng.normal(size=(3, 5)), rng.normal(size=3)
        one = lane(go=1.0)
        for load, name in enumerate(LOADS):
            one[name], sign = before[load], -1.0 if name == "normal" else 1.0
            for place, value in zip(PLACES, values[load], strict=True):
                one[f"{name}_{place}"] = value
            one.do("record_extreme", load, one.row(name), sign)
            within = largest_on_parabolas(sign * values[load])
            inside += within > (sign * values[load]).max() + 1e-6
            assert sign * one[name] == pytest.approx(max(within, sign * before[load]), abs=1e-6)
            assert one[f"{name}_now"] == values[load, -1]  # the start of the next step
    assert inside > 30


def test_a_step_that_is_not_accepted_leaves_the_loads(lane):
    one = lane(go=0.0, friction=0.1, **{f"friction_{place}": 1.0 + k for k, place in enumerate(PLACES)})
    one.do("record_extreme", 1, one.row("friction"), 1.0)
    assert (one["friction"], one["friction_now"]) == (0.1, 1.0)


@pytest.mark.parametrize("share", [0.0, 0.25, 0.7, 1.0])
def test_the_state_within_a_step_is_a_cubic_through_its_ends(lane, share):
    one, h = lane(made=0.3), 0.3
    cubic = np.array([[0.4, -0.3, 2.0, 1.5], [1.0, 0.5, -1.0, 0.3], [0.0, 2.0, 0.0, 0.1], [-1.0, 0.2, 0.4, 5.0]])
    for j, powers in enumerate(cubic):
        one[f"last{j}"], one[f"y{j}"] = np.polyval(powers[::-1], [0.0, h])
        one[f"last_slope{j}"], one[f"k0_{j}"] = np.polyval(np.polyder(powers[::-1]), [0.0, h])
    found = one.do("state_within", share)
    assert found == pytest.approx([np.polyval(powers[::-1], share * h) for powers in cubic], rel=1e-12)


WAVE = {"turns0": 0.5, "ax_amplitude0": 0.3, "ax_phase0": 0.1, "ay_amplitude0": 0.2, "ay_phase0": -0.35}
WAVE |= {"az_amplitude0": 0.4, "az_phase0": 0.8}


def push_at(t):
    """Return the accelerations of the wave."""
    return tuple(
        WAVE[f"{axis}_amplitude0"] * math.cos(2.0 * math.pi * (WAVE["turns0"] * t + WAVE[f"{axis}_phase0"]))
        for axis in ("ax", "ay", "az")
    )


def test_loads_at_the_start_of_a_step_are_those_of_the_model(lane):
    state = (0.03, 0.01, -0.02, 0.04)
    one = lane(**WAVE, **{f"y{j}": value for j, value in enumerate(state)})
    one.do("set_loads", 0.7)
    found = [one[f"{name}_now"] for name in LOADS]
    normal, friction, pivoting = MODEL.contact(*state, *push_at(0.7), *MODEL.parameters)
    assert found == pytest.approx([normal, friction / normal, pivoting / normal], rel=1e-12)


def demands(t):
    ax, ay, az = np.array([push_at(one) for one in t]).T
    return (np.hypot(ax, ay) / (1.0 + az)).max(), 1.0 + az.min()


@pytest.mark.parametrize(("start", "end"), [(0.0, 12.0), (1.3, 1.9), (2.0, 2.001)])
def test_loads_of_a_standing_column_are_extremes_over_the_whole_time(lane, start, end):
    one = lane(frequency=2.0 * math.pi * WAVE["turns0"], normal=9.0, **WAVE)
    one.do("record_standing_loads", start, end)
    most, least = demands(np.linspace(start, end, 20_001))
    # The parabola through three of 64 samples in a period misses a crest by less than (2π/64)³/16 of its third
    # derivative, which is at most 8 times the demand: it has twice the frequency. At a crest of the wave that is zero.
    assert (one["friction"], one["normal"]) == (pytest.approx(most, rel=5e-4), pytest.approx(least, rel=1e-5))


def test_loads_under_linear_accelerations_are_those_of_the_ends(lane, monkeypatch):
    record = sb.Record(samples=np.ones((9, 3)), step=0.1)
    # Around its middle 1, with half length 1.
    line = {"middle": 1.0, "per_half": 1.0, "ax0": 0.15, "ax1": 0.05, "ay0": -0.1, "ay1": 0.1, "az0": 0.1, "az1": -0.2}
    one, times = lane(record, frequency=50.0, normal=9.0, **line), []
    scope = one.driver.record_standing_loads.__globals__
    of_model = scope["standing_load"]
    monkeypatch.setitem(scope, "standing_load", lambda buf, i, t: times.append(t) or of_model(buf, i, t))
    one.do("record_standing_loads", 0.0, 2.0)
    assert times == [0.0, 2.0]
    assert one["friction"] == pytest.approx(max(math.hypot(0.1, -0.2) / 1.3, math.hypot(0.2, 0.0) / 0.9))
    assert one["normal"] == pytest.approx(0.9)


def test_no_time_has_no_loads_and_a_known_extreme_stays(lane):
    one = lane(frequency=3.0, normal=0.1, friction=7.0, **WAVE)
    one.do("record_standing_loads", 0.0, 4.0)
    assert (one["friction"], one["normal"]) == (7.0, 0.1)
    one["friction"], one["normal"] = 0.0, 9.0
    one.do("record_standing_loads", 3.0, 3.0)
    assert (one["friction"], one["normal"]) == (0.0, 9.0)
