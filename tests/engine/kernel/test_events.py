"""Events and stops of a lane, in plain Python: lift-off of the base, steps aimed at an event, and new legs."""

import math

import numpy as np
import pytest

import stylobate as sb
from stylobate.engine.kernel.driver.events import EVENTS, LIMITS, RunStatus, Target, lean

COLUMN = sb.Column.dimensionless(0.1)
SLENDER = sb.Slender(COLUMN)
WEAK = sb.Harmonic.circular(acceleration=0.065, angular_frequency=3.0)
LIFTING = sb.Harmonic(amplitude=(0.5, 0.2, 3.0), phase=(0.0, 0.5, 1.0), angular_frequency=2.0)


# Lift-off.


def lift_under(lane_of, monkeypatch, weight, frequency, end):
    """Return the time from which this weight is negative."""
    one = lane_of(SLENDER, LIFTING, frequency=frequency)
    monkeypatch.setitem(one.scope("lift_in_leg"), "weight", lambda _buf, _i, t: weight(t))
    return one.do("lift_in_leg", 0.0, end)


@pytest.mark.parametrize("place", [0.5, 1.3, 1.5, 1.7, 6.5, 17.9, 29.2])
@pytest.mark.parametrize("depth", [1e-6, 1e-3, 0.3])
def test_the_base_lifts_where_the_weight_first_is_negative_between_any_two_samples(lane_of, monkeypatch, place, depth):
    spacing = 0.1
    lowest = place * spacing
    found = lift_under(
        lane_of, monkeypatch, lambda t: (t - lowest) ** 2 - depth * spacing**2, 2.0 * math.pi / (64 * spacing), 3.0
    )
    first = lowest - math.sqrt(depth) * spacing
    # The minimum is found to the root of the rounding error, the crossing to all digits.
    assert found == pytest.approx(max(first, 0.0), abs=1e-12)
    assert lift_under(lane_of, monkeypatch, lambda t: (t - lowest) ** 2 + 1e-9, 2.0 * math.pi / 6.4, 3.0) == math.inf


def test_lift_off_is_searched_leg_by_leg_and_leaves_the_first_leg_and_break(lane_of, monkeypatch):
    one = lane_of(SLENDER, LIFTING, end=6.0, minimum_vertical=-1.5, breaks=2.0)
    first = one.scope("set_break")["BREAKS_AT"]
    one.table[0, first : first + 2] = 1.0, 3.0
    one.do("set_break", one.table)
    searched, legs = [], []
    monkeypatch.setitem(one.scope("find_lift"), "lift_in_leg", lambda _buf, _i, *leg: searched.append(leg) or math.inf)
    monkeypatch.setitem(one.scope("find_lift"), "set_leg", lambda *given: legs.append(given[-1]))
    one.do("find_lift", one.table, one.pieces)
    assert searched == [(0.0, 1.0), (1.0, 3.0), (3.0, 6.0)]
    assert legs == [1.0, 3.0, 0.0]
    assert (one["next_break"], one["breaks_at"], one["lifts_at"]) == (0.0, 1.0, math.inf)


# Steps aimed at an event.


def test_the_acceleration_of_the_tilt_vector_is_the_slope_of_its_rate(lane_of):
    one = lane_of(SLENDER, WEAK)
    state, slopes = (0.03, -0.02, 0.1, 0.2), (0.1, 0.2, -0.7, 0.4)
    assert one.do("lean_and_rates", state, slopes) == pytest.approx((*state, -0.7, 0.4), rel=1e-10)
    planar = lane_of(SLENDER, WEAK, planar=True)
    assert planar.do("lean_and_rates", (0.03, 0.1), (0.1, -0.7)) == pytest.approx((0.03, 0.0, 0.1, 0.0, -0.7, 0.0))


def test_a_step_aimed_at_the_least_tilt_goes_on_by_a_secant_to_where_the_tilt_stops_falling(lane_of):
    rng = np.random.default_rng(4)
    for start, velocity in rng.normal(size=(20, 2, 2)):
        h, bend = 0.1, rng.normal(size=2)
        # Along x(t) = x₀ + vt + bt²/2, with its cubic through the ends.
        place, rate = start + velocity * h + 0.5 * bend * h * h, velocity + bend * h
        growth = [float(start @ velocity), float(place @ rate)]
        one = lane_of(SLENDER, WEAK, made=h, target=Target.IMPACT, tilt=float(np.hypot(*place)), radial=growth[1])
        for j, (old, new) in enumerate(zip((*start, *velocity), (*place, *rate), strict=True)):
            one[f"last{j}"], one[f"y{j}"] = old, new
        further = -growth[1] * h / (growth[1] - growth[0])
        assert one.do("time_left", lean(*start, *velocity)) == pytest.approx(min(max(further, -0.5 * h), 0.5 * h))


@pytest.mark.parametrize(
    ("limit", "no_return", "start", "growth", "target"),
    [
        (0.3, 0.4, 0.2, 0.5, Target.LIMIT),
        (0.4, 0.3, 0.2, 0.5, Target.OVERTURNING),
        (0.3, 0.3, 0.2, 0.5, Target.LIMIT),
        (9.0, 0.25, 0.3, -0.2, Target.GROWTH),  # the point of no return fell below the tilt
    ],
)
def test_a_held_step_is_aimed_at_the_first_event_within_it(lane_of, limit, no_return, start, growth, target):
    # Straight outwards along x = start + growth t + t²/2, from which the tilt of 0.5 is passed at the latest.
    h = -2.0 * growth if target is Target.GROWTH else 1.0
    one = lane_of(SLENDER, WEAK, tilt_limit=limit, no_return=no_return, tilt=start, radial=start * growth)
    x, rate = start + growth * h + 0.5 * h * h, growth + h
    first, time = one.do("first_event", h, lean(x, 0.0, rate, 0.0))
    expected = (
        -growth if target is Target.GROWTH else -growth + math.sqrt(growth**2 + 2.0 * (min(limit, no_return) - start))
    )
    assert Target(first) is target
    assert time == pytest.approx(expected, abs=0.02)


def test_each_event_that_ends_runs_has_an_outcome_and_a_reason():
    assert len({event.target for event in EVENTS}) == len(EVENTS)
    ends = [event.status for event in EVENTS if event.status is not RunStatus.WAITING]
    assert all(status.outcome is not None and status.event and status.reason for status in ends)
    assert all(event.status in ends for event in LIMITS)


@pytest.mark.parametrize("rests_at", [math.nan, 5.0])
def test_a_column_rests_near_the_vertical_at_the_time_found_within_the_step(lane_of, monkeypatch, rests_at):
    one = lane_of(SLENDER, WEAK, rest_energy=1e-3, low=1e-4, slow=1.0, rest_tilt=1e-3, radial=1.0)
    monkeypatch.setitem(one.scope("handle_near_vertical"), "rest_within_step", lambda *_: rests_at)
    assert one.do("handle_near_vertical", one.table) == pytest.approx(rests_at, nan_ok=True)


@pytest.mark.parametrize("longest", [1.0, 1e-3])
@pytest.mark.parametrize("share", [1e-5, -1e-5, 1e-7])
def test_only_a_very_short_remaining_step_is_made_by_a_taylor_polynomial(lane_of, longest, share):
    further = share * longest
    # On a path straight outwards, with the limit a little ahead.
    one = lane_of(SLENDER, WEAK, made=0.1, aimed=1.0, target=Target.LIMIT, tilt=0.5, radial=0.5, longest_step=longest)
    one["y0"], one["y2"], one["k0_0"], one["last_slope0"], one["tilt_limit"] = 0.5, 1.0, 1.0, 1.0, 0.5 + further
    status = one.do("approach_target", one.table, one.pieces)
    if abs(share) > 1e-6:
        assert (status, one["aimed"], one["h"]) == (RunStatus.WAITING, 2.0, pytest.approx(further))
    else:
        assert (status, one["time"]) == (RunStatus.LIMIT, pytest.approx(further))
        assert one["tilt"] == pytest.approx(0.5 + further, rel=1e-12)


@pytest.mark.parametrize(("stop", "passed"), [(1.05, False), (1.25, True)])
def test_a_passage_that_would_end_after_the_next_stop_is_not_made_analytically(lane_of, monkeypatch, stop, passed):
    moving = {"momentum": 1e-12, "vx": 0.1, "atol": 1e-9, "rtol": 1e-8}
    one = lane_of(SLENDER, WEAK, time=1.0, samples_at=stop, samples=9.0, **moving)
    monkeypatch.setitem(one.scope("pass_analytically"), "model_passage", lambda *_: (0.2, (1e-3, 0.0, 0.1, 0.0)))
    one.do("pass_analytically", one.table)
    assert (one["time"], one["x"]) == (pytest.approx(1.2 if passed else 1.0), 1e-3 if passed else 0.0)


# Stops and steps.


@pytest.mark.parametrize(
    ("given", "sets"),
    [
        ({"samples_at": 2.0}, False),
        ({"samples_at": 2.0, "breaks_at": 3.0, "leg_ends": 3.0}, False),
        ({"breaks_at": 2.0}, True),
        ({"leg_ends": 2.0}, True),
    ],
)
def test_only_a_stop_at_the_end_of_a_leg_sets_a_new_one(lane_of, monkeypatch, given, sets):
    one, called = lane_of(SLENDER, WEAK, time=2.0, **given), []
    for name in ("set_leg", "set_rates"):
        monkeypatch.setitem(one.scope("meet_stop"), name, lambda *_, name=name: called.append(name))
    assert one.do("meet_stop", one.table, one.pieces, 2.0) == RunStatus.WAITING
    assert called == (["set_leg", "set_rates"] if sets else [])


@pytest.mark.parametrize("watched", [0.0, 1.0])
@pytest.mark.parametrize("go", [0.0, 1.0])
def test_steps_are_observed_in_the_last_periods_if_they_are_accepted(lane_of, monkeypatch, watched, go):
    one, observed = lane_of(SLENDER, WEAK, watched=watched, go=go, flag=1.0), []
    monkeypatch.setitem(one.scope("is_due"), "observe", lambda _buf, i: observed.append(i))
    assert one.do("is_due", one.table, one.pieces)
    assert observed == ([0] if watched * go else [])


def test_nodes_and_weights_of_long_steps_integrate_polynomials_of_degree_15(lane_of):
    scope = lane_of(SLENDER, WEAK).scope("observe_by_nodes")
    powers = np.arange(16)
    np.testing.assert_allclose(scope["WEIGHTS"] @ scope["PLACES"][:, None] ** powers, 1.0 / (powers + 1.0), rtol=1e-14)
