"""Acceptance of a step, its extremes and its successor, lane by lane in plain Python: each against its definition."""

import math

import numpy as np
import pytest

import stylobate as sb
from stylobate.engine.kernel.driver.events import Lean

COLUMN = sb.Column.dimensionless(0.1)
CIRCLE = sb.Harmonic.circular(acceleration=0.065, angular_frequency=3.0)
FAR = 99.0


@pytest.fixture
def lane(lane_of):
    """Make a lane of the slender column; a step of 0.1 has been made in it."""
    return lambda **given: lane_of(sb.Slender(COLUMN), CIRCLE, **({"h": 0.1, "side": 1.0} | given))


def hermite(start, end, slope, end_slope, u):
    """Return the cubic with these end values and slopes over [0, 1]."""
    return (
        start * (1.0 + 2.0 * u) * (1.0 - u) ** 2
        + slope * u * (1.0 - u) ** 2
        + end * u * u * (3.0 - 2.0 * u)
        - end_slope * u * u * (1.0 - u)
    )


FINE = np.linspace(0.0, 1.0, 20_001)


# Acceptance.


@pytest.mark.parametrize(
    ("error", "past", "aimed", "verdict"),
    [
        (0.999, -1.0, 0.0, (1.0, 0.0, 1.0)),
        (1.0, -1.0, 0.0, (0.0, 0.0, 0.0)),
        (math.nan, -1.0, 0.0, (0.0, 0.0, 0.0)),
        (0.5, 1e-9, 0.0, (1.0, 1.0, 0.0)),  # an event is ahead of its end
        (0.5, 1e-9, 1.0, (1.0, 0.0, 1.0)),  # of a step aimed at the event
        (1.5, 1e-9, 0.0, (0.0, 0.0, 0.0)),
    ],
)
def test_a_step_is_accepted_if_its_error_is_small_and_held_if_it_contains_an_event(lane, error, past, aimed, verdict):
    one = lane(error=error, aimed=aimed, tilt_limit=0.05 - past, new0=0.03, new1=0.04, new2=-0.2, new3=0.1)
    one.do("accept")
    assert (one["ok"], one["held"], one["go"]) == verdict
    assert (one["new_tilt"], one["new_radial"]) == (pytest.approx(0.05), pytest.approx(0.03 * -0.2 + 0.04 * 0.1))
    assert (one["new_x"], one["new_y"], one["new_vx"], one["new_vy"]) == (0.03, 0.04, -0.2, 0.1)


@pytest.mark.parametrize(
    ("tilt", "radial", "beyond"),
    [(0.09, 1.0, False), (0.11, 1.0, True), (0.11, -1.0, False), (0.21, -1.0, True), (0.21, 1.0, True)],
)
@pytest.mark.parametrize("planar", [False, True])
def test_beyond_the_point_of_no_return_counts_outwards_and_beyond_the_limit_always(lane, planar, tilt, radial, beyond):
    one = lane(planar=planar, no_return=0.1, tilt_limit=0.2, x=0.05, vx=0.1)
    assert (one.do("overshoot_of", Lean(tilt, 0.0, radial / tilt, 0.0, tilt, radial)) > 0.0) == beyond


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_planar_step_overshoots_if_its_path_crosses_the_vertical_anywhere(lane, side):
    rng = np.random.default_rng(2)
    seen = set()
    h = 0.4
    for start, end, slope, end_slope in rng.uniform([0.0, -0.2, 0.0, 0.0], [1.0, 0.8, 1.0, 1.0], (300, 4)):
        path = hermite(start, end, -4.0 * slope, 4.0 * end_slope, FINE)
        one = lane(planar=True, side=side, x=side * start, vx=side * -4.0 * slope / h, h=h)
        found = one.do("overshoot_of", Lean(side * end, 0.0, side * 4.0 * end_slope / h, 0.0, abs(end), 0.0)) > 0.0
        assert found == (path.min() < 0.0)
        seen.add((found, end > 0.0))
        # A path that leaves the vertical, or ends before its lowest point, is judged by its end.
        outwards = lane(planar=True, side=side, x=side * start, vx=side * slope / h, h=h)
        assert (outwards.do("overshoot_of", Lean(side * end, 0.0, side * 0.1, 0.0, abs(end), 0.0)) > 0.0) == (end < 0.0)
    assert seen == {(True, True), (True, False), (False, True)}


# Extremes.


def turning(lane, planar, start, end, slope, end_slope, **given):
    """Return a lane whose step has these tilts at its ends, and rates of the tilt times the step there."""
    h = 0.2
    ends = {"x": start, "new_x": end, "vx": slope / h, "new_vx": end_slope / h, "tilt": start, "new_tilt": end}
    radial = {"radial": start * slope / h, "new_radial": end * end_slope / h}
    more = {"go": 1.0, "time": 5.0, "peak_at": 1.0, "minimum_tilt": FAR}
    more |= {} if planar else {"closest_passage": FAR}
    one = lane(planar=planar, **(ends | radial | {"h": h} | more | given))
    one.do("record_extremes")
    return one


def cubic_of(planar, start, end, slope, end_slope):
    """Return the tilt of the step: a cubic in planar motion, else the root of a cubic in the squared tilt."""
    if planar:
        return hermite(start, end, slope, end_slope, FINE)
    return np.sqrt(np.maximum(hermite(start**2, end**2, 2.0 * start * slope, 2.0 * end * end_slope, FINE), 0.0))


both = pytest.mark.parametrize("planar", [False, True])


@both
@pytest.mark.parametrize("ends", [(0.05, 0.04, -0.03, 0.05), (0.02, 0.06, -0.01, 0.09)])
def test_a_step_that_falls_and_rises_has_its_minimum_within(lane, planar, ends):
    one = turning(lane, planar, *ends, peak_tilt=0.07)
    least = cubic_of(planar, *ends).min()
    assert least < min(ends[:2])
    assert one["low"] == one["minimum_tilt"] == pytest.approx(least, rel=1e-7)
    if not planar:
        assert one["closest_passage"] == pytest.approx(least, rel=1e-7)
        # Slower than at rest is no passage; a step that is not accepted has no minimum.
        assert turning(lane, planar, *ends, rest_square=(ends[3] / 0.2) ** 2)["closest_passage"] == FAR
    assert turning(lane, planar, *ends, go=0.0)["minimum_tilt"] == FAR
    assert turning(lane, planar, *ends, minimum_tilt=1e-3)["minimum_tilt"] == 1e-3
    assert (one["peak_tilt"], one["peak_at"], one["peak"]) == (0.07, 1.0, 0.0)


@both
def test_a_step_that_rises_and_falls_leaves_a_new_peak_to_the_driver_and_keeps_an_old_one(lane, planar):
    ends = 0.05, 0.055, 0.03, -0.02
    path = cubic_of(planar, *ends)
    new = turning(lane, planar, *ends, peak_tilt=path.max() * 0.99)
    assert (new["peak"], new["peak_tilt"], new["peak_at"]) == (1.0, path.max() * 0.99, 1.0)
    old = turning(lane, planar, *ends, peak_tilt=path.max() * 1.2)
    assert (old["peak"], old["peak_tilt"], old["peak_at"]) == (0.0, path.max() * 1.2, 1.0)
    assert new["low"] == 0.05
    assert new["minimum_tilt"] == FAR
    # Nothing is recorded of a step that is not accepted; one aimed at an event is handled by the driver.
    assert turning(lane, planar, *ends, go=0.0)["peak"] == 0.0
    assert turning(lane, planar, *ends, peak_tilt=FAR, aimed=1.0)["peak"] == 1.0


@both
def test_a_step_that_only_rises_or_falls_has_its_extremes_at_its_ends(lane, planar):
    up = turning(lane, planar, 0.03, 0.05, 0.018, 0.021)
    assert (up["low"], up["peak_tilt"], up["peak_at"], up["peak"]) == (0.03, 0.05, 5.2, 0.0)
    down = turning(lane, planar, 0.05, 0.03, -0.018, -0.021)
    assert (down["low"], down["peak_tilt"], down["peak_at"], down["peak"]) == (0.03, 0.05, 5.0, 0.0)
    for one in (up, down):
        assert one["minimum_tilt"] == FAR
    late = turning(lane, planar, 0.03, 0.05, 0.018, 0.021, aimed=1.0)  # its end may lie beyond the event
    assert (late["peak_tilt"], late["peak_at"]) == (0.0, 1.0)


def test_a_lane_is_slow_if_the_speed_within_the_step_may_be_that_of_rest(lane):
    def slow(before, after, h=0.01, rest=1e-6, slenderness=0.1, vertical=0.0):
        one = lane(vx=before[0], vy=before[1], new_vx=after[0], new_vy=after[1], slow_square=rest)
        one["slenderness"], one["maximum_vertical"] = slenderness, vertical
        one.do("mark_slow", h)
        return one["slow"] == 1.0

    assert not slow((0.3, 0.0), (0.29, 0.01))
    assert slow((0.3, 0.0), (-0.2, 0.0))  # it turns within
    assert slow((1e-4, 0.0), (1e-4, 0.0))  # the weight may stop it: 0.01 · 0.1 > 1e-4
    speed = math.sqrt(2.0) * 0.3
    for scale, expected in ((1.001, False), (0.999, True)):
        # Twice the square of the change is the bound, that of the weight included.
        assert slow((scale * speed, 0.0), (scale * speed, 0.0), h=3.0, rest=0.0) == expected
        assert slow((scale * speed, 0.0), (scale * speed, 0.0), h=1.5, rest=0.0, vertical=1.0) == expected
        assert slow((scale * speed, 0.0), (scale * speed, 0.0), h=3.0, rest=0.0, vertical=-0.5) == expected
        assert slow((scale * 0.2, 0.0), (scale * 0.2, 0.0), h=0.0, rest=0.02) == expected


def test_the_azimuth_follows_the_lean_and_a_motion_that_has_grown_gets_the_full_tolerance(lane):
    one = lane(x=-0.03, y=0.01, new_x=-0.03, new_y=-0.01, new_vx=0.1, new_vy=-0.2, momentum=0.01, turns=2.0, go=1.0)
    for name, value in {"new_tilt": 0.04, "new_radial": 0.004, "grown": 0.1, "atol": 1e-9, "atol_now": 1e-12}.items():
        one[name] = value
    one.do("follow_azimuth")
    # Anticlockwise across the negative x axis, where the azimuth jumps.
    assert (one["turns"], one["momentum"]) == (3.0, pytest.approx(0.03 * 0.2 + 0.01 * 0.1))
    assert one["atol_now"] == 1e-12
    for name, value in (("grown", 0.03), ("new_radial", -0.001)):
        again = lane(x=-0.03, y=0.01, new_x=-0.03, new_y=-0.01, new_tilt=0.04, new_radial=0.004, go=1.0)
        again["grown"], again["atol"], again["atol_now"] = 0.1, 1e-9, 1e-12
        again[name] = value
        again.do("follow_azimuth")
        assert again["atol_now"] == 1e-9
        again["go"], again["atol_now"], again["momentum"], again["turns"] = 0.0, 1e-12, 0.5, 1.0
        again.do("follow_azimuth")
        assert (again["atol_now"], again["momentum"], again["turns"]) == (1e-12, 0.5, 1.0)


# The next step.


@pytest.mark.parametrize("go", [0.0, 1.0])
def test_an_accepted_step_replaces_the_state_and_a_rejected_one_leaves_it(lane, go):
    names = [f"y{j}" for j in range(4)]
    new = [f"new{j}" for j in range(4)]
    pairs = [
        *zip(names, new, strict=True),
        ("tilt", "new_tilt"),
        ("radial", "new_radial"),
        ("x", "new_x"),
        ("y", "new_y"),
    ]
    pairs += [("vx", "new_vx"), ("vy", "new_vy"), *((f"k0_{j}", f"k12_{j}") for j in range(4))]
    one = lane(go=go, **{name: float(k) for k, pair in enumerate(pairs) for name in pair[:1]})
    for k, (_, name) in enumerate(pairs):
        one[name] = 100.0 + k
    one.do("keep_step", 0)
    assert [one[name] for name, _ in pairs] == [100.0 * go + k for k in range(len(pairs))]
    assert [one[f"last{j}"] for j in range(4)] == [0.0, 1.0, 2.0, 3.0]
    assert [one[f"last_slope{j}"] for j in range(4)] == [10.0, 11.0, 12.0, 13.0]


def stepped(lane, **given):
    usual = {"h": 0.2, "time": 3.0, "go": 1.0, "ok": 1.0, "stop": 9.0, "error": 0.9**8, "steps": 7.0}
    one = lane(**(usual | given))
    one.do("choose_next_step", 1.0)
    return one


def test_an_accepted_step_advances_the_time_and_a_rejected_one_does_not(lane):
    one = stepped(lane)
    assert (one["time"], one["made"], one["tried"], one["steps"], one["reached"]) == (3.2, 0.2, 0.2, 8.0, 0.0)
    assert (one["wanted"], one["h"], one["rejected"]) == (pytest.approx(0.2), pytest.approx(0.2), 0.0)
    held = stepped(lane, go=0.0)
    assert (held["time"], held["made"], held["tried"], held["steps"], held["rejected"]) == (3.0, 0.0, 0.2, 7.0, 0.0)
    refused = stepped(lane, go=0.0, ok=0.0, error=(0.9 / 0.5) ** 8)
    assert (refused["time"], refused["steps"], refused["rejected"]) == (3.0, 7.0, 1.0)
    assert refused["h"] == pytest.approx(0.1)


@pytest.mark.parametrize(
    ("given", "factor"),
    [
        ({"error": 0.0}, 10.0),  # at most
        ({"error": 1e9}, 0.2),  # at least
        ({"error": math.nan}, 0.2),
        ({"error": 0.3**8}, 3.0),
        ({"error": 0.3**8, "rejected": 1.0}, 1.0),  # no growth after a rejected step
        ({"error": 1.8**8, "rejected": 1.0}, 0.5),
        ({"error": 0.3**8, "longest_step": 0.5}, 2.5),
    ],
)
def test_the_next_step_is_bounded(lane, given, factor):
    assert stepped(lane, **given)["wanted"] == pytest.approx(0.2 * factor)


def test_a_step_ends_on_its_stop_to_the_last_bit(lane):
    for stop in (3.2, math.nextafter(3.2, 0.0), 3.0 + 0.2 * (1.0 - 1e-16)):
        one = stepped(lane, stop=stop, h=0.2)
        assert (one["reached"], one["time"]) == (1.0, stop)
    shorter = stepped(lane, stop=3.2, h=math.nextafter(0.2, 0.0))  # 3 + h is rounded to 3.2
    assert (shorter["reached"], shorter["time"]) == (1.0, 3.2)
    near = stepped(lane, stop=3.25)
    assert (near["reached"], near["time"], near["h"]) == (0.0, 3.2, pytest.approx(0.05))
    assert near["wanted"] == pytest.approx(0.2)
    assert stepped(lane, stop=3.2, go=0.0)["reached"] == 0.0


def test_a_step_back_to_an_event_remains_aimed_if_it_is_rejected(lane):
    assert stepped(lane, aimed=1.0)["aimed"] == 1.0
    assert stepped(lane, aimed=1.0, ok=0.0, go=0.0)["aimed"] == 0.0
    assert stepped(lane, aimed=1.0, ok=0.0, go=0.0, h=-0.2)["aimed"] == 1.0
    assert stepped(lane)["aimed"] == 0.0


# Flags.


@both
@pytest.mark.parametrize(
    ("given", "flagged"),
    [
        ({}, False),
        ({"held": 1.0, "go": 0.0}, True),
        ({"reached": 1.0}, True),
        ({"reached": 1.0, "go": 0.0}, False),
        ({"aimed": 1.0}, True),
        ({"peak": 1.0}, True),
        ({"steps": 50.0}, True),
        ({"steps": 49.0}, False),
        ({"tried": 1e-15, "rejected": 1.0, "go": 0.0}, True),  # no shorter step changes the time
        ({"tried": 1e-15}, False),
        ({"tried": 1e-14, "rejected": 1.0, "go": 0.0}, False),
    ],
)
def test_a_lane_is_flagged_for_each_task_of_the_driver(lane, planar, given, flagged):
    usual = {"go": 1.0, "tried": 0.1, "time": 1.0, "most_steps": 50.0}
    one = lane(planar=planar, **(usual | ({} if planar else {"low": 1.0, "tilt": 1.0, "slenderness": 0.1}) | given))
    one.do("flag_lane")
    assert (one["flag"] > 0.0) == flagged


@pytest.mark.parametrize(
    ("given", "flagged"),
    [
        ({}, False),
        ({"low": 0.9e-3, "passage_tilt": 1e-3}, True),
        ({"low": 1.1e-3, "passage_tilt": 1e-3}, False),
        ({"low": 0.9e-3, "rest_tilt": 1e-3, "slow": 1.0}, True),
        ({"low": 0.9e-3, "rest_tilt": 1e-3, "slow": 0.0}, False),
        # Straight for the vertical, within a millionth of the smaller of c and the speed.
        ({"tilt": 0.9e-8, "radial": -1.0}, True),
        ({"tilt": 0.9e-8, "radial": 1.0}, False),
        ({"tilt": 1.1e-8, "radial": -1.0}, False),
        ({"tilt": 0.9e-8, "radial": -1.0, "momentum": 0.9e-12}, True),
        ({"tilt": 0.9e-8, "radial": -1.0, "momentum": -1.1e-12}, False),
        ({"tilt": 0.9e-7, "radial": -1.0, "vx": 3.0, "vy": 4.0}, True),
        ({"tilt": 1.1e-7, "radial": -1.0, "vx": 3.0, "vy": 4.0}, False),
    ],
)
def test_a_lane_near_rest_or_near_the_vertical_is_flagged(lane, given, flagged):
    one = lane(**({"low": 1.0, "tilt": 1.0, "slenderness": 0.1, "vx": 0.006, "vy": 0.008} | given))
    assert (one.do("near_vertical") > 0.0) == flagged
