"""Tabulated base motion in a lane, in plain Python: the piece of a time, its coefficients and bounds."""

import math

import numpy as np
import pytest

import stylobate as sb
from stylobate.engine.kernel.columns import Piece, Tabulated

SLENDER = sb.Slender(sb.Column.dimensionless(0.1))
RECORD = sb.Record(samples=np.random.default_rng(3).normal(size=(9, 3)), step=0.1)
TIMES = np.array([0.0, 0.3, 0.4, 1.1, 1.5, 2.5, 2.6])
"""Ends of the pieces [s]."""
SCALE, DELAY, FACTOR, UP, ANGLE = 0.5, 0.8, 2.0, -1.5, 0.7
"""Unit of time [s], delay [s], factors of the horizontal and vertical acceleration, and rotation."""
OFFSET = (0.03, -0.05)
"""Constant horizontal acceleration [g]."""


def lane_with_pieces(lane_of, *, planar=False, first=2, **given):
    """Return a lane whose motion is the table's pieces from row `first` on, and the coefficients of the pieces."""
    line = {"line_x": 0.6, "line_y": 0.8} if planar else {}
    units = {"time_scale": SCALE, "per_second": 1.0 / SCALE, "capacity": 0.1, "overturned_tilt": 1.5}
    one = lane_of(SLENDER, RECORD, planar=planar, slenderness=0.1, **line, **units, **given)
    rng = np.random.default_rng(5)
    columns, count = len(Piece), len(TIMES) - 1
    one.pieces = np.zeros((first + count + 1, columns + 6))
    coefficients = rng.normal(size=(count, 3, 2))
    for number in range(count):
        row, (start, end) = one.pieces[first + number], TIMES[number : number + 2]
        row[Piece.START], row[Piece.END], row[Piece.PER_HALF] = start, end, 2.0 / (end - start)
        row[Piece.LARGEST_HORIZONTAL] = 3.0 - 0.1 * number
        row[Piece.MINIMUM_VERTICAL], row[Piece.MAXIMUM_VERTICAL] = -0.4 + 0.01 * number, 0.6 - 0.01 * number
        row[Piece.CONTINUED] = float(number % 2 == 0)
        row[columns:] = coefficients[number].ravel()
    motion = one.table[0, one.shape.motion_at :]
    for name, value in {
        Tabulated.FACTOR: FACTOR,
        Tabulated.COS: math.cos(ANGLE),
        Tabulated.SIN: math.sin(ANGLE),
        Tabulated.VERTICAL: UP,
        Tabulated.DELAY: DELAY,
        Tabulated.OFFSET_X: OFFSET[0],
        Tabulated.OFFSET_Y: OFFSET[1],
        Tabulated.FIRST: first,
        Tabulated.COUNT: count,
    }.items():
        motion[name] = value
    return one, coefficients


def expected_at(coefficients, seconds, planar):
    """Return the accelerations at a time after the delay [s], in the piece that begins last."""
    number = min(np.searchsorted(TIMES, seconds, side="right") - 1, len(TIMES) - 2)
    middle, half = 0.5 * (TIMES[number] + TIMES[number + 1]), 0.5 * (TIMES[number + 1] - TIMES[number])
    x, y, z = coefficients[number] @ [1.0, (seconds - middle) / half]
    x, y = FACTOR * np.array([math.cos(ANGLE) * x - math.sin(ANGLE) * y, math.sin(ANGLE) * x + math.cos(ANGLE) * y])
    x, y = x + OFFSET[0], y + OFFSET[1]
    return (0.6 * x + 0.8 * y, 0.0, UP * z) if planar else (x, y, UP * z)


@pytest.mark.parametrize("planar", [False, True])
def test_a_leg_is_the_piece_of_its_time_scaled_rotated_and_delayed(lane_of, planar):
    rng = np.random.default_rng(1)
    one, coefficients = lane_with_pieces(lane_of, planar=planar)
    for seconds in (*TIMES[:-1], *rng.uniform(0.0, 2.6, 20)):
        t = (seconds + DELAY) / SCALE
        one["piece"] = float(rng.integers(0, 6))
        one.do("set_leg", one.table, one.pieces, t)
        assert one.do("accelerations", t) == pytest.approx(expected_at(coefficients, seconds, planar), rel=1e-9)
        number = int(one["piece"])
        assert TIMES[number] <= seconds + 1e-12 < TIMES[number + 1] + 1e-9
        ends = (TIMES[number + 1] + DELAY) / SCALE if number < 5 else math.inf
        assert (one["leg_ends"], one["continued"]) == (pytest.approx(ends), float(number % 2 == 0))


def test_the_base_is_at_rest_before_the_delay_except_for_the_constant_acceleration(lane_of):
    one, _ = lane_with_pieces(lane_of)
    one.do("set_leg", one.table, one.pieces, 1.2)
    assert one.do("accelerations", 1.2) == (*OFFSET, 0.0)
    assert (one["leg_ends"], one["continued"]) == (pytest.approx(DELAY / SCALE), 0.0)


def test_bounds_are_those_of_the_rest_of_the_motion_and_are_set_if_they_change(lane_of, monkeypatch):
    one, _ = lane_with_pieces(lane_of)
    calls = []
    monkeypatch.setitem(one.scope("load_piece"), "set_bounds", lambda _buf, i: calls.append(i))
    motion = one.table[0, one.shape.motion_at :]
    for number in range(6):
        one.do("load_piece", motion, one.pieces, 2 + number)
        horizontal = 2.0 * (3.0 - 0.1 * number) + math.hypot(*OFFSET)
        low, high = -0.4 + 0.01 * number, 0.6 - 0.01 * number
        found = one["largest_horizontal"], one["minimum_vertical"], one["maximum_vertical"]
        # The vertical acceleration is upside down.
        assert found == pytest.approx((horizontal, -1.5 * high, -1.5 * low))
        assert len(calls) == number + 1
        one.do("load_piece", motion, one.pieces, 2 + number)
        assert len(calls) == number + 1
    for name in ("largest_horizontal", "minimum_vertical"):
        one[name] += 0.1
        one.do("load_piece", motion, one.pieces, 7)
    assert len(calls) == 8


def test_only_a_piece_that_is_continued_is_followed_by_the_next_without_a_new_leg(lane_of):
    one, coefficients = lane_with_pieces(lane_of)
    for number in range(5):
        t = (TIMES[number] + DELAY) / SCALE
        one.do("set_leg", one.table, one.pieces, t)
        ended = one["leg_ends"]
        assert one.do("continues_in_next_piece", one.table, one.pieces) == (number % 2 == 0)
        assert one["piece"] == number + (number % 2 == 0)
        if number % 2 == 0:
            seconds = TIMES[number + 1] + 0.01
            found = one.do("accelerations", (seconds + DELAY) / SCALE)
            assert found == pytest.approx(expected_at(coefficients, seconds, False))
            assert one["leg_ends"] > ended


def test_a_piece_too_short_for_its_time_is_not_continued(lane_of):
    one, _ = lane_with_pieces(lane_of)
    one.do("set_leg", one.table, one.pieces, (TIMES[0] + DELAY) / SCALE)
    one.pieces[3, Piece.END] = TIMES[1]
    assert not one.do("continues_in_next_piece", one.table, one.pieces)


@pytest.mark.parametrize(
    "given", [{}, {"flag": 2.0}, {"reached": 0.0}, {"run": -1.0}, {"other_stop": 2.2}, {"time": 2.1}]
)
def test_a_knot_that_is_the_only_task_of_a_stop_is_passed(lane_of, given):
    one, _ = lane_with_pieces(lane_of)
    one.do("set_leg", one.table, one.pieces, DELAY / SCALE)
    knot = (TIMES[1] + DELAY) / SCALE
    usual = {"flag": 1.0, "reached": 1.0, "other_stop": 9.0, "time": one["leg_ends"], "wanted": 0.5}
    for name, value in (usual | given).items():
        one[name] = value
    passes = one.do("passes_knot", one.table, one.pieces)
    assert passes == (not given)
    assert one["leg_ends"] == pytest.approx((TIMES[2] + DELAY) / SCALE if passes else knot)
    if passes:
        assert (one["flag"], one["stop"], one["h"]) == (0.0, one["leg_ends"], one["leg_ends"] - one["time"])
