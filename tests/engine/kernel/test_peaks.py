"""Peaks, closest points and passages of a lane, in plain Python, on paths that are known polynomials."""

import math

import numpy as np
import pytest

import stylobate as sb
from stylobate.engine.kernel.driver.events import RunStatus

COLUMN = sb.Column.dimensionless(0.1)
SLENDER, ROLLING = sb.Slender(COLUMN), sb.Rolling(COLUMN)
CIRCLE = sb.Harmonic.circular(acceleration=0.065, angular_frequency=3.0)
H, FINE = 0.4, np.linspace(0.0, 0.4, 40_001)


def along(lane_of, x, y=(), **given):
    """Return a lane that has just made a step along polynomials of degree 5, highest power first, ending at time 2."""
    planar = not y
    one = lane_of(SLENDER, CIRCLE, planar=planar, made=H, time=2.0, stop=9.0, **given)
    paths = [np.poly1d(x)] if planar else [np.poly1d(x), np.poly1d(y)]
    count = len(paths)
    for j, path in enumerate(paths):
        for order, (state, slope) in enumerate(((j, j), (j + count, j + count))):
            for rows, slopes, t in (("last", "last_slope", 0.0), ("y", "k0_", H)):
                one[f"{rows}{state}"] = path.deriv(order)(t)
                one[f"{slopes}{slope}"] = path.deriv(order + 1)(t)
    one.do("set_lean")
    return one, np.hypot(*[path(FINE) for path in (*paths, np.poly1d(0.0))][:2])


PEAKED = [
    ((3.0, -1.0, 0.5, -0.6, 0.15, 0.03), (1.0, 0.2, -0.1, -0.3, 0.1, 0.02)),
    ((0.0, 0.0, 0.0, -0.5, 0.2, 0.01), ()),
    ((0.0, 0.0, 0.0, 0.5, -0.2, -0.01), ()),
]


@pytest.mark.parametrize(("x", "y"), PEAKED)
def test_the_peak_within_a_step_is_that_of_its_path(lane_of, x, y):
    one, tilt = along(lane_of, x, y)
    assert 0 < tilt.argmax() < len(FINE) - 1
    assert one.do("measure_peak") == 0.0
    assert one["peak_tilt"] == pytest.approx(tilt.max(), rel=1e-9)
    assert one["peak_at"] == pytest.approx(2.0 - H + FINE[tilt.argmax()], abs=2e-5)
    before = one["peak_at"]
    one["peak_tilt"] = 1.01 * tilt.max()
    assert one.do("measure_peak") == 0.0
    assert (one["peak_tilt"], one["peak_at"]) == (1.01 * tilt.max(), before)


@pytest.mark.parametrize(("x", "y"), PEAKED)
def test_a_peak_beyond_the_limit_returns_the_time_at_which_the_limit_is_passed(lane_of, x, y):
    one, tilt = along(lane_of, x, y)
    one["tilt_limit"] = 0.3 * tilt[0] + 0.7 * tilt.max()
    passed = one.do("measure_peak")
    assert passed == pytest.approx(FINE[np.argmax(tilt > one["tilt_limit"])], abs=2e-5)
    assert one["peak_tilt"] == 0.0


def test_the_closest_point_is_that_of_the_path(lane_of):
    one, tilt = along(lane_of, (2.0, 0.1, 0.0, 0.3, -0.5, 0.1), (0.0, 1.0, 0.3, -0.1, 0.02, 0.01))
    assert one.do("closest_within") == pytest.approx(H - FINE[tilt.argmin()], abs=2e-5)


def test_a_passage_with_losses_records_its_distance(lane_of):
    usual = {"vx": 0.03, "vy": 0.04, "momentum": -1e-4, "slenderness": 0.1, "closest_passage": 1.0}
    one = lane_of(ROLLING, CIRCLE, **usual)
    one.do("record_loss")
    assert (one["widest_loss"], one["closest_passage"]) == pytest.approx((2e-3, 2e-3))
    one = lane_of(ROLLING, CIRCLE, **(usual | {"widest_loss": 0.1, "closest_passage": 1e-3}))
    one.do("record_loss")
    assert (one["widest_loss"], one["closest_passage"]) == (0.1, 1e-3)
    # Slower than at rest is no passage, and in a plane the distance is a rounding error.
    for given in ({"rest_square": 0.0026}, {"momentum": 1e-16}):
        one = lane_of(ROLLING, CIRCLE, **(usual | given))
        one.do("record_loss")
        assert one["closest_passage"] == 1.0


def test_a_step_undone_leaves_the_state_of_its_start(lane_of):
    # Across the negative x axis, anticlockwise: one turn more.
    one, _ = along(lane_of, (0.0, 0.0, 0.0, 0.0, 0.01, -0.1), (0.0, 0.0, 0.0, 0.0, -0.2, 0.03), turns=3.0)
    one.do("undo_step")
    assert [one[f"y{j}"] for j in range(4)] == pytest.approx([-0.1, 0.03, 0.01, -0.2])
    assert [one[f"k0_{j}"] for j in range(4)] == pytest.approx([0.01, -0.2, 0.0, 0.0])
    assert (one["time"], one["turns"], one["x"], one["y"]) == pytest.approx((2.0 - H, 2.0, -0.1, 0.03))


# Passages.


@pytest.mark.parametrize(
    ("given", "loses"),
    [
        ({}, True),
        ({"low": 1e-3}, False),  # not close enough
        ({"y2": -0.2, "k0_0": -0.2}, False),  # still falling at its end
        ({"last0": 0.02, "last2": 0.2, "last_slope0": 0.2}, False),  # has just been handled
    ],
)
def test_a_passage_loses_energy_if_the_step_went_closely_past_the_vertical(lane_of, given, loses):
    step = {"made": 0.2, "last0": -0.02, "y0": 0.02, "last2": 0.2, "y2": 0.2, "last_slope0": 0.2, "k0_0": 0.2}
    one = lane_of(ROLLING, CIRCLE, **({"low": 1e-5, "passage_tilt": 1e-4} | step | given))
    one.do("set_lean")
    assert one.do("loses_energy") == loses


@pytest.mark.parametrize(
    ("given", "near"),
    [
        ({}, True),
        ({"radial": 1e-12}, False),
        ({"momentum": -1.1e-12}, False),
        ({"tilt": 1.1e-8}, False),
        ({"vx": 0.3, "vy": 0.4}, True),
        ({"vx": 0.3, "vy": 0.4, "tilt": 0.9e-7, "momentum": 4e-11}, True),
        ({"vx": 0.3, "vy": 0.4, "tilt": 1.1e-7}, False),
    ],
)
def test_a_passage_is_analytical_within_a_millionth_of_the_lesser_of_slenderness_and_speed(lane_of, given, near):
    straight = {"slenderness": 0.1, "vx": 0.006, "vy": 0.008, "tilt": 0.9e-8, "radial": -1e-12, "momentum": 0.9e-12}
    assert lane_of(SLENDER, CIRCLE, **(straight | given)).do("nears_vertical") == near


def test_an_impact_at_the_closest_point_is_recorded_and_applied(lane_of):
    model = sb.Rolling(COLUMN, restitution=0.9, passage_tilt=1e-4)
    state = (1e-5, 2e-5, -0.2, 0.1, 0.3)
    usual = {"atol": 1e-9, "atol_now": 1e-12, "rtol": 1e-8, "wanted": 0.01, "last_azimuth": math.nan}
    one = lane_of(model, CIRCLE, time=2.0, slenderness=0.1, **usual, **{f"y{j}": part for j, part in enumerate(state)})
    one["first_azimuth"], one["closest_passage"] = math.nan, 1.0
    assert one.do("apply_impact", one.table, one.pieces) == RunStatus.WAITING
    expected = model.impact_map(*state, *model.parameters)
    assert [one[f"y{j}"] for j in range(5)] == pytest.approx(list(expected))
    distance = (1e-5 * 0.1 + 2e-5 * 0.2) / math.hypot(0.2, 0.1)
    assert (one["widest_loss"], one["closest_passage"]) == pytest.approx((distance, distance))
    assert (one["atol_now"], one["wanted"], one["vx"]) == (1e-9, 0.01, pytest.approx(expected[2]))


@pytest.mark.parametrize(
    ("losses", "speed", "rests"),
    [(False, -0.2, False), (True, -0.2, False), (False, 0.0, True), (False, -0.9e-3, True), (False, -1.1e-3, False)],
)
def test_a_planar_passage_changes_the_side_loses_energy_or_ends_at_rest(lane_of, monkeypatch, losses, speed, rests):
    model = sb.Rolling(COLUMN, restitution=0.9, passage_tilt=1e-4) if losses else ROLLING
    usual = {"atol": 1e-9, "rtol": 1e-8, "held_step": 0.03, "side": 1.0, "line_x": 1.0, "time": 2.0}
    # A base at rest holds the column; the rest energy is that of a speed of 1e-3.
    energy = 100.0 * model.rest_energy(0.0, 1e-3, 0.0, *model.parameters)
    usual |= {"slenderness": 0.1, "rest_energy": energy, "rest_energy_for_good": energy, "least_force": 0.1}
    one = lane_of(model, CIRCLE, planar=True, y0=1e-15, y1=speed, passage_tilt=1e-4 * losses, **usual)
    monkeypatch.setitem(one.scope("cross_vertical"), "settle", lambda *_: RunStatus.RESTED)
    status = one.do("cross_vertical", one.table, one.pieces)
    assert (status, one["y0"], one["reached_vertical"]) == (RunStatus.RESTED if rests else RunStatus.WAITING, 0.0, 1.0)
    if not rests:
        after = model.impact_map(0.0, 0.0, speed, 0.0, 0.0, *model.parameters)[2] if losses else speed
        assert (one["y1"], one["side"], one["wanted"]) == (pytest.approx(after), -1.0, 0.03)
        assert (abs(after) < abs(speed)) == losses
