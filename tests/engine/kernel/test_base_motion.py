"""The rows of the base motion in a lane hold the motion, in three dimensions and along a line."""

import math

import numpy as np
import pytest

import stylobate as sb
from stylobate.engine.kernel.columns import Wave

COLUMN = sb.Column.dimensionless(0.1)
MODEL = sb.Slender(COLUMN)
FLAT = sb.Harmonic.elliptic(amplitude=(0.1, 0.06), phase=1.0, angular_frequency=2.0)
LIFTING = sb.Harmonic(amplitude=(0.5, 0.2, 0.3), phase=(0.0, 0.5, 1.0), angular_frequency=2.0)
ANGLE = 0.7
LINE = math.cos(ANGLE), math.sin(ANGLE)
WAVE = {
    Wave.TURNS: 0.31,
    Wave.SIZE_X: 0.3,
    Wave.PHASE_X: 0.1,
    Wave.SIZE_Y: 0.2,
    Wave.PHASE_Y: -0.35,
    Wave.SIZE_Z: 0.15,
    Wave.PHASE_Z: 0.8,
    Wave.ONSET: 1.0,
    Wave.BEGINS: 1.0,
    Wave.ENDS: 3.0,
}
both = pytest.mark.parametrize("planar", [False, True])


def acceleration_of(wave, t):
    """Return the components of a harmonic term, without its window."""
    axes = ((Wave.SIZE_X, Wave.PHASE_X), (Wave.SIZE_Y, Wave.PHASE_Y), (Wave.SIZE_Z, Wave.PHASE_Z))
    return [wave[size] * math.cos(2.0 * math.pi * (wave[Wave.TURNS] * t + wave[phase])) for size, phase in axes]


def expected(acceleration, planar):
    ax, ay, az = acceleration
    return (LINE[0] * ax + LINE[1] * ay, 0.0, az) if planar else (ax, ay, az)


@both
@pytest.mark.parametrize("motion", [FLAT, LIFTING], ids=["horizontal", "with a vertical part"])
def test_a_harmonic_motion_has_its_components_along_the_axes_or_along_the_line(lane_of, motion, planar):
    lane = lane_of(MODEL, motion, planar=planar, line_x=LINE[0], line_y=LINE[1])
    lane.do("set_terms", np.array([WAVE.get(name, 0.0) for name in Wave]), 0.0)
    for t in (0.0, 0.4, 1.9, 7.3):
        x, y, z = expected(acceleration_of(WAVE, t), planar)
        assert lane.do("accelerations", t) == pytest.approx((x, y, z if motion is LIFTING else 0.0), abs=1e-12)


@both
def test_a_ramped_motion_rises_as_half_a_cosine_between_its_ends(lane_of, planar):
    ramped = sb.Harmonic.circular(acceleration=0.1, angular_frequency=2.0, ramp=1.7)
    lane = lane_of(MODEL, ramped, planar=planar, line_x=LINE[0], line_y=LINE[1])
    for leg, t, window in (
        (0.0, 0.5, 0.0),
        (1.0, 1.0, 0.0),
        (1.0, 1.7, 0.5 - 0.5 * math.cos(0.35 * math.pi)),
        (3.0, 4.0, 1.0),
    ):
        lane.do("set_terms", np.array([WAVE.get(name, 0.0) for name in Wave]), leg)
        x, y, _ = expected(acceleration_of(WAVE, t), planar)
        assert lane.do("accelerations", t)[:2] == pytest.approx((window * x, window * y), abs=1e-12)


@both
@pytest.mark.parametrize("vertical", [False, True])
def test_the_rate_of_the_force_under_a_record_is_that_of_its_linear_pieces(lane_of, planar, vertical):
    samples = np.random.default_rng(3).normal(size=(9, 3 if vertical else 2))
    lane = lane_of(MODEL, sb.Record(samples=samples, step=0.1), planar=planar, slenderness=0.3)
    axes = ("ah",) if planar else ("ax", "ay")
    names = [f"{axis}{power}" for axis in (*axes, *(("az",) if vertical else ())) for power in range(2)]
    lane["middle"], lane["per_half"] = 2.0, 4.0
    for name, value in zip(names, np.linspace(0.3, 1.7, len(names)), strict=True):
        lane[name] = value
    ends = np.array([lane.do("accelerations", 2.0 + sign * 0.25) for sign in (-1.0, 1.0)])
    rates = (ends[1] - ends[0]) / 0.5
    assert lane.do("forcing_rate") == pytest.approx(math.hypot(rates[0], rates[1]) + 0.3 * abs(rates[2]), rel=1e-12)


def test_the_rate_of_the_force_under_other_motions_is_bounded_by_their_highest_frequency(lane_of):
    lane = lane_of(MODEL, LIFTING, frequency=2.5, largest_horizontal=0.4, slenderness=0.3)
    lane["minimum_vertical"], lane["maximum_vertical"] = -0.5, 0.2
    assert lane.do("forcing_rate") == pytest.approx(2.5 * (0.4 + 0.3 * 0.5))
    lane["maximum_vertical"] = 0.6
    assert lane.do("forcing_rate") == pytest.approx(2.5 * (0.4 + 0.3 * 0.6))


def test_a_column_is_held_for_good_if_the_least_force_is_not_negative_and_its_weight_stays(lane_of):
    lane = lane_of(MODEL, LIFTING, least_force=0.0, minimum_vertical=-0.5)
    assert lane.do("held_for_good")
    for name, value in (("least_force", -1e-9), ("minimum_vertical", -1.0)):
        before, lane[name] = lane[name], value
        assert not lane.do("held_for_good")
        lane[name] = before
    lane["slope_z"] = -0.5  # the base tilts ever more
    assert not lane.do("held_for_good")


def test_the_least_force_is_what_the_weakest_weight_leaves_of_the_strongest_push(lane_of):
    lane = lane_of(MODEL, LIFTING, largest_horizontal=0.02, capacity=0.1, minimum_vertical=-0.4, overturned_tilt=1.5)
    lane["slope_x"], lane["slope_y"], lane["slope_z"] = 0.003, -0.004, 0.1
    lane.do("set_bounds")
    assert lane["least_force"] == pytest.approx(0.1 * 0.7 - 0.02 - 0.005)
