"""Rest, standing and uplift of a lane, in plain Python."""

import math

import numpy as np
import pytest

import stylobate as sb
from stylobate.engine.kernel.driver.events import RunStatus

COLUMN = sb.Column.dimensionless(0.1)
SLENDER, ROLLING = sb.Slender(COLUMN), sb.Rolling(COLUMN)
WEAK = sb.Harmonic.circular(acceleration=0.065, angular_frequency=3.0)
LIFTING = sb.Harmonic(amplitude=(0.5, 0.2, 0.3), phase=(0.0, 0.5, 1.0), angular_frequency=2.0)
# A push of 0.2 g along x at time zero, twice what the column resists, and 0.12 g along y.
PUSH = {"turns0": 0.5, "ax_amplitude0": 0.2, "ay_amplitude0": 0.12, "ay_phase0": -0.25, "frequency": math.pi}
STRONG = PUSH | {"slenderness": 0.1, "capacity": 0.1, "least_force": -0.1}


def test_the_azimuth_of_a_standing_column_is_the_last_one(lane_of):
    leaning = {"x": -0.03, "y": 0.03, "turns": 2.0, "last_azimuth": 0.3}
    assert lane_of(SLENDER, WEAK, stands=1.0, **leaning).do("azimuth_now") == 0.3
    assert lane_of(SLENDER, WEAK, **leaning).do("azimuth_now") == pytest.approx(2.375)
    assert lane_of(SLENDER, WEAK, stands=1.0, last_azimuth=math.nan).do("azimuth_now") == 0.0
    assert lane_of(SLENDER, WEAK, planar=True, x=-0.03, last_azimuth=0.3).do("azimuth_now") == 0.3


def test_only_passages_with_losses_in_three_dimensions_follow_each_other_ever_faster(lane_of):
    assert lane_of(ROLLING, WEAK, passage_tilt=1e-3).do("chatters")
    assert not lane_of(ROLLING, WEAK).do("chatters")
    assert not lane_of(ROLLING, WEAK, planar=True, passage_tilt=1e-3).do("chatters")
    assert not lane_of(SLENDER, WEAK, passage_tilt=1e-3).do("chatters")


def test_a_column_comes_to_rest_only_where_the_plane_holds_it(lane_of):
    for share in (0.0, 0.4, 1.0):
        still = {"made": 0.01, "time": 0.0, "rest_energy": 1e-3, "rest_energy_for_good": 1e-3}
        pushed = lane_of(SLENDER, WEAK, **(STRONG | still))
        assert pushed.do("margin_within_step", 0.0, 0.01, share, False) == pytest.approx(-0.1, abs=1e-3)
        held = lane_of(SLENDER, WEAK, **(STRONG | still | {"ax_amplitude0": 0.01, "ay_amplitude0": 0.0}))
        assert held.do("margin_within_step", 0.0, 0.01, share, False) > 0.0


@pytest.mark.parametrize(("capacity", "kept"), [(0.05, 0.7), (0.3, 0.0)])
def test_a_column_that_stands_for_an_instant_keeps_its_spin(lane_of, monkeypatch, capacity, kept):
    one = lane_of(ROLLING, WEAK, **(STRONG | {"capacity": capacity, "y0": 1e-9, "y4": 0.7, "y": 1.0, "rests": 2.0}))
    monkeypatch.setitem(one.scope("settle"), "stand", lambda *_: RunStatus.RESTED)
    assert one.do("settle", one.table, one.pieces, 0.0) == RunStatus.RESTED
    assert [one[f"y{j}"] for j in range(5)] == [0.0, 0.0, 0.0, 0.0, kept]
    assert (one["rests"], one["stands"], one["reached_vertical"], one["last_azimuth"]) == (3.0, 1.0, 1.0, 0.25)


def test_uplift_is_counted_once_and_starts_the_motion(lane_of):
    for rests in (0.0, 1.0):
        one = lane_of(SLENDER, WEAK, **(STRONG | {"stands": 1.0, "atol": 1e-9, "rtol": 1e-8, "rests": rests}))
        assert one.do("stand", one.table, one.pieces, 0.0) == RunStatus.WAITING
        assert (one["releases"], one["stands"], one["released_from_rest"]) == (1.0, 0.0, rests)
        assert 0.0 < one["time"] < 0.01
        assert one["x"] < 0.0


@pytest.mark.parametrize("line", [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)])
def test_a_motion_along_a_line_goes_on_in_its_plane(lane_of, line):
    pushed = {"ax_amplitude0": 0.2 * line[0], "ay_amplitude0": 0.2 * line[1], "ay_phase0": 0.0}
    lined = {"line_x": line[0], "line_y": line[1], "stands": 1.0, "atol": 1e-9, "rtol": 1e-8}
    one = lane_of(SLENDER, WEAK, **(STRONG | lined | (pushed if any(line) else {})))
    status = one.do("stand", one.table, one.pieces, 0.0)
    assert status == (RunStatus.TO_PLANE if any(line) else RunStatus.WAITING)
    assert one["stands"] == 0.0


def test_uplift_gets_the_push_its_excess_and_the_mean_rates_of_both(lane_of, monkeypatch):
    lifting = {"az_amplitude0": 0.3, "az_phase0": 0.1}
    one = lane_of(SLENDER, LIFTING, **(STRONG | lifting))
    pushes = []
    monkeypatch.setitem(
        one.scope("depart"), "model_departure", lambda _buf, _i, push, *_: pushes.append(push) or (0.0,) * 4
    )
    elapsed = one.do("depart", 0.05) - 0.05
    times = 0.05, 0.05 + elapsed * 2.0 / 3.0
    (ax, ay, az), (bx, by, bz) = (one.do("accelerations", t) for t in times)
    (push,) = pushes
    here, there = math.hypot(ax, ay), math.hypot(bx, by)
    assert push.direction == pytest.approx((-ax / here, -ay / here))
    assert (push.acceleration, push.excess) == pytest.approx((here, here - 0.1 * (1.0 + az)))
    assert push.excess_rate == pytest.approx((there - 0.1 * (1.0 + bz) - push.excess) / (times[1] - times[0]))
    turned = np.angle(complex(bx, by) / complex(ax, ay))
    assert push.turning_rate == pytest.approx(turned / (times[1] - times[0]))
