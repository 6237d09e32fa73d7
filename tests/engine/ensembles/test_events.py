"""Runs of an ensemble meet the events that single runs meet, at the same times."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq

import stylobate as sb

C = 0.1
COLUMN = sb.Column.dimensionless(C)
MODEL = sb.Slender(COLUMN, damping=0.1)
CIRCLE = sb.Harmonic.circular(acceleration=0.065, angular_frequency=1.8)
LINE = sb.Harmonic.straight(acceleration=0.1, angular_frequency=2.0)


def release_of(excess, frequency, start_phase):
    """|cos(Ωt + φ)| (1 + excess) > 1 for the first time."""
    before = math.acos(1.0 / (1.0 + excess))
    if abs(math.cos(start_phase)) * (1.0 + excess) > 1.0:
        return 0.0
    return (math.ceil((start_phase + before) / math.pi) * math.pi - before - start_phase) / frequency


@pytest.mark.parametrize("excess", [1e-8, 1e-4, 0.1, 2.0])
def test_release_comes_when_a_straight_acceleration_reaches_c(runs_of, excess):
    # A run that ends just before the release stands, one that ends just after it has been released.
    phases = np.array([-1.5, -0.9, 0.6, 2.0, 3.0])
    times = np.array([release_of(excess, 1.7, phase) for phase in phases])
    motion = sb.Harmonic.straight(acceleration=C * (1.0 + excess), angular_frequency=1.7, direction=0.4)
    # The motion departs a thousandth of the fastest time later; 8 ulp of margin shift it by less than 1e-9.
    later = 1e-3 / 2.7
    late, early = times + later + 2e-9, np.maximum(times - 2e-9, 1e-12)
    both = runs_of(
        MODEL,
        motion,
        10,
        tilt=(0.0, 0.0),
        duration=np.concatenate([late, early]),
        parameters={"start_phase": np.tile(phases, 2)},
    )
    releases = both.together()["uplifts"].to_numpy()
    np.testing.assert_array_equal(releases[:5], 1 if excess > 1e-6 else releases[:5])
    np.testing.assert_array_equal(releases[5:], 0)
    np.testing.assert_array_equal(releases[:5], [len(both.alone(i).events) for i in range(5)])


@pytest.mark.parametrize("start_phase", [0.3, 1.1, 2.9])
def test_release_between_weight_and_push_is_that_of_a_root(runs_of, start_phase):
    motion = sb.Harmonic(
        amplitude=(0.09, 0.02, 0.4), phase=(0.0, 0.8, 1.3), angular_frequency=1.3, start_phase=start_phase
    )

    def excess(t):
        ax, ay, az = motion.acceleration(t)
        return math.hypot(ax, ay) - C * (1.0 + az)

    grid = np.linspace(0.0, 10.0, 100_001)
    ax, ay, az = motion.acceleration(grid).T
    above = int(np.argmax(np.hypot(ax, ay) - C * (1.0 + az) > 0.0))
    expected = 0.0 if above == 0 else brentq(excess, grid[above - 1], grid[above], xtol=1e-14)
    later = 1e-3 / 2.3
    runs = runs_of(MODEL, motion, 2, tilt=(0.0, 0.0), duration=[expected + later + 1e-9, max(expected, 1e-9)])
    np.testing.assert_array_equal(runs.together()["uplifts"], [1, 0])


def test_marginal_releases_overturn_at_the_time_of_single_runs(runs_of):
    # Times from two independent integrators, see the corners of single runs.
    motion = sb.Harmonic.circular(acceleration=C, angular_frequency=2.0)
    runs = runs_of(
        MODEL,
        motion,
        2,
        tilt=(0.0, 0.0),
        duration=30.0,
        parameters={"scale": [1.0 + 1e-6, 1.0 + 1e-7]},
        tilt_limit=0.19,
    )
    np.testing.assert_allclose(runs.together()["decided_at"], [10.4158, 11.469], atol=2e-3)


@pytest.mark.parametrize("rate", [(0.0, 0.0), (0.0, 0.01)], ids=["in a plane", "in space"])
@pytest.mark.parametrize("damping", [pytest.param(0.3, marks=pytest.mark.slow), 1.5])
def test_friction_brings_columns_to_rest_when_it_does_alone(runs_of, outcome_in, rate, damping):
    model = sb.Slender(COLUMN, damping=damping)
    still = LINE.scaled(0.0)
    runs = runs_of(model, still, 2, tilt=[(0.01, 0.0), (0.05, 0.0)], tilt_rate=rate, duration=100.0)
    data = runs.together(rtol=1e-10)
    for index in range(2):
        single = runs.alone(index, rtol=1e-10)
        assert outcome_in(data, index) is single.outcome is sb.Outcome.AT_REST
        # Seen on cubics between the ends of a step, single runs on polynomials of order 7.
        assert float(data["decided_at"][index]) == pytest.approx(single.decided_at, abs=2e-5)
        assert bool(data["planar"][index]) is single.planar is (rate == (0.0, 0.0))
        np.testing.assert_array_equal(data["end_tilt"][index], 0.0)
        assert float(data["minimum_tilt"][index]) == 0.0


def test_no_friction_never_brings_rest(runs_of, outcome_in):
    model = sb.Slender(COLUMN)
    runs = runs_of(model, LINE.scaled(0.0), 2, tilt=(1e-5, 0.0), tilt_rate=[(0.0, 1e-6), (0.0, 0.0)], duration=2.0)
    data = runs.together()
    assert {outcome_in(data, 0), outcome_in(data, 1)} == {sb.Outcome.STILL_MOVING}


@pytest.mark.parametrize("direction", [0.0, 2.0])
def test_overturning_is_proved_when_and_where_it_is_alone(runs_of, outcome_in, direction):
    angle = np.linspace(-3.0, 3.0, 8)
    tilt = 0.08 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    motion = CIRCLE.scaled(2.0).rotated(direction)
    runs = runs_of(MODEL, motion, 8, tilt=tilt, tilt_rate=tilt[:, ::-1] * 0.5, duration=20.0, rtol=1e-11)
    data = runs.together()
    for index in range(8):
        single = runs.alone(index)
        assert outcome_in(data, index) is single.outcome is sb.Outcome.OVERTURNED
        assert float(data["decided_at"][index]) == pytest.approx(single.decided_at, abs=1e-7)
        last = single.data["tilt"].to_numpy()[-1]
        assert float(data["direction"][index]) == pytest.approx(math.atan2(last[1], last[0]), abs=1e-6)
        # Where the proof holds for the first time: at the tilt, or where the tilt begins to grow beyond it.
        assert float(data["peak_tilt"][index]) >= C + 0.13 - 1e-10


def test_a_start_beyond_return_has_overturned_at_once(runs_of, outcome_in):
    rates = [(0.01, 0.01), (-0.1, 0.01)]
    runs = runs_of(MODEL, CIRCLE.scaled(0.0), 2, tilt=(0.2, 0.0), tilt_rate=rates, duration=20.0, rtol=1e-11)
    data = runs.together()
    assert outcome_in(data, 0) is outcome_in(data, 1) is sb.Outcome.OVERTURNED
    assert float(data["decided_at"][0]) == pytest.approx(0.0, abs=1e-9)
    assert float(data["decided_at"][1]) == pytest.approx(runs.alone(1).decided_at, abs=1e-7)
    assert float(data["decided_at"][1]) > 0.1


def test_a_tilt_limit_is_met_at_the_exact_time(outcome_in):
    # Free motion in a plane without friction: α = c − 0.05 cosh τ + 0.04 sinh τ.
    data = sb.simulate_ensemble(
        sb.Slender(COLUMN), LINE.scaled(0.0), tilt=(0.05, 0.0), tilt_rate=(0.04, 0.0), duration=5.0, tilt_limit=0.06
    )
    time = float(data["decided_at"][0])
    assert outcome_in(data) is sb.Outcome.LIMIT_REACHED
    assert C - 0.05 * math.cosh(time) + 0.04 * math.sinh(time) == pytest.approx(0.06, abs=1e-9)
    assert float(data["peak_tilt"][0]) == pytest.approx(0.06, abs=1e-12)


# A swing may pass the limit between two steps: the peak tilt tells that it did.
@pytest.mark.parametrize("short", [1e-3, 1e-4, 1e-5])
@pytest.mark.parametrize("motion", [CIRCLE, LINE], ids=["in space", "in a plane"])
def test_no_tilt_exceeds_the_limit_unseen(runs_of, outcome_in, motion, short):
    angle = np.linspace(-3.0, 3.0, 24)
    tilt = 0.02 * (np.stack([np.cos(angle), np.sin(angle)], axis=1) if motion is CIRCLE else angle[:, np.newaxis])
    tilt = tilt * ([1.0, 1.0] if motion is CIRCLE else [1.0, 0.0])
    runs = runs_of(MODEL, motion, 24, tilt=tilt, tilt_rate=(0.03, 0.0), duration=15.0)
    free = runs.together()
    moving = free["outcome"].to_numpy() != sb.Outcome.OVERTURNED
    assert moving.sum() >= 5
    for index in np.flatnonzero(moving):
        peak = float(free["peak_tilt"][index])
        if float(free["time_of_peak_tilt"][index]) == 0.0:
            continue
        limit = peak * (1.0 - short)
        data = runs.part([index]).together(tilt_limit=limit)
        assert outcome_in(data) is sb.Outcome.LIMIT_REACHED
        assert float(data["peak_tilt"][0]) == pytest.approx(limit, rel=1e-8)
        assert float(data["decided_at"][0]) < float(free["time_of_peak_tilt"][index])
        assert np.hypot(*data["end_tilt"].to_numpy()[0]) == pytest.approx(limit, rel=1e-8)
        assert float(data["end_tilt"][0] @ data["end_tilt_rate"][0]) > 0.0


@pytest.mark.parametrize("rate", [(0.1, 0.0), (-0.1, 0.0), (-0.1, 0.02)])
def test_a_start_beyond_the_limit_ends_at_once(outcome_in, rate):
    data = sb.simulate_ensemble(MODEL, CIRCLE, tilt=(0.0301, 0.0), tilt_rate=rate, duration=5.0, tilt_limit=0.03)
    assert outcome_in(data) is sb.Outcome.LIMIT_REACHED
    assert float(data["decided_at"][0]) == 0.0


@pytest.mark.parametrize("max_steps", [1, 7])
def test_a_run_out_of_steps_has_failed(runs_of, outcome_in, max_steps):
    runs = runs_of(
        MODEL, CIRCLE, 2, tilt=(0.05, 0.0), tilt_rate=(0.0, 0.02), duration=[100.0, 1e-6], max_steps=max_steps
    )
    data = runs.together()
    assert outcome_in(data, 0) is runs.alone(0).outcome is sb.Outcome.FAILED
    assert bool(data["uncertain"][0])
    assert int(data["steps"][0]) <= max_steps
    assert 0.0 < float(data["decided_at"][0]) < 100.0


@pytest.mark.parametrize("acceleration", [1.3, 1.01, 1.0001])
@pytest.mark.parametrize(
    "rate",
    [pytest.param((0.0, 0.0), id="in a plane", marks=pytest.mark.slow), pytest.param((0.0, 0.03), id="in space")],
)
def test_a_base_that_falls_faster_than_gravity_is_left_behind(outcome_in, acceleration, rate):
    motion = sb.Harmonic.vertical(acceleration=acceleration, angular_frequency=0.5)
    data = sb.simulate_ensemble(sb.Slender(COLUMN), motion, tilt=(0.03, 0.0), tilt_rate=rate, duration=7.0)
    assert outcome_in(data) is sb.Outcome.LIFTED_OFF
    assert float(data["decided_at"][0]) == pytest.approx(2.0 * math.acos(-1.0 / acceleration), abs=1e-9)


def test_a_column_at_rest_is_left_behind_too(outcome_in):
    motion = sb.Harmonic.vertical(acceleration=1.5, angular_frequency=1.0)
    data = sb.simulate_ensemble(MODEL, motion, duration=20.0)
    assert outcome_in(data) is sb.Outcome.LIFTED_OFF
    assert float(data["decided_at"][0]) == pytest.approx(math.acos(-1.0 / 1.5), abs=1e-9)


def test_close_passages_are_uncertain_and_wide_ones_are_not(runs_of):
    aside = np.array([1e-12, 1e-11, 1e-7, 1e-5, 1e-3])
    runs = runs_of(
        sb.Slender(COLUMN),
        LINE.scaled(0.0),
        5,
        tilt=np.stack([np.full(5, 0.03), aside], axis=1),
        tilt_rate=(-0.02, 0.0),
        duration=2.0,
    )
    data = runs.together()
    singles = [runs.alone(index) for index in range(5)]
    np.testing.assert_array_equal(data["uncertain"], [run.uncertain for run in singles])
    np.testing.assert_array_equal(data["uncertain"], [True, True, False, False, False])
    assert not data["planar"].any()
    np.testing.assert_allclose(data["minimum_tilt"], [run.measures["least_passage"] for run in singles], rtol=1e-3)


def test_start_and_motion_in_one_plane_are_integrated_in_it(runs_of, end_of, ends_of):
    angle = np.linspace(-3.0, 3.0, 9)
    line = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    runs = runs_of(
        MODEL, LINE, 9, tilt=0.03 * line, tilt_rate=-0.02 * line, duration=15.0, parameters={"rotation": angle}
    )
    data = runs.together()
    assert bool(data["planar"].all())
    aside = data["end_tilt"].to_numpy() @ np.array([[0.0, -1.0], [1.0, 0.0]])
    np.testing.assert_allclose(np.sum(aside * line, axis=1), 0.0, atol=1e-16)
    # All are one motion, turned.
    along = np.sum(data["end_tilt"].to_numpy() * line, axis=1)
    np.testing.assert_allclose(along, along[0], atol=1e-7)
    single = runs.alone(4)
    assert single.planar
    np.testing.assert_allclose(ends_of(data)[4], end_of(single), atol=1e-7)


@pytest.mark.slow  # a kernel of its own; runs by Taylor series go on like this too
def test_a_space_motion_that_rests_goes_on_in_the_plane_of_a_straight_base_motion(runs_of, outcome_in):
    # Begun across the line of the base motion, at rest before it releases the column 40 s later.
    runs = runs_of(
        sb.Slender(COLUMN, damping=1.0),
        sb.Harmonic.straight(acceleration=0.13, angular_frequency=2.0, direction=0.6),
        3,
        tilt=[(0.0, 0.01), (0.005, 0.01), (0.01, -0.01)],
        tilt_rate=(0.001, 0.0),
        duration=52.0,
        parameters={"delay": [40.0, 40.5, 41.0]},
    )
    data = runs.together()
    for index in range(3):
        single = runs.alone(index)
        kinds = [event.kind for event in single.events]
        assert kinds[:2] == ["rest", "uplift"]
        assert int(data["uplifts"][index]) == kinds.count("uplift") == 1
        assert outcome_in(data, index) is single.outcome
        # It moved in space before.
        assert bool(data["planar"][index]) is single.planar is False
        end = data["end_tilt"].to_numpy()[index]
        np.testing.assert_allclose(end, single.data["tilt"].to_numpy()[-1], atol=1e-7)
        assert end @ [-math.sin(0.6), math.cos(0.6)] == pytest.approx(0.0, abs=1e-16)
        assert np.hypot(*end) > 1e-3


STONE = sb.Slender(sb.Column.solid(radius=0.5, height=10.0, density=2700.0), damping=0.1)


def test_small_hops_after_release_are_followed(runs_of, outcome_in):
    motion = sb.Harmonic.straight(acceleration=1.0, angular_frequency=2.0, start_phase=-math.pi / 2.0)
    runs = runs_of(STONE, motion, 3, tilt=(0.0, 0.0), duration=60.0, parameters={"acceleration": [0.99, 1.0, 1.02]})
    data = runs.together()
    for index in range(3):
        single, fine = runs.alone(index), runs.alone(index, rtol=1e-12, rest_energy=1e-12)
        assert outcome_in(data, index) is single.outcome is fine.outcome is sb.Outcome.OVERTURNED
        # The least of the three hops longest: its time hangs on the last bits of the base motion.
        if index > 0:
            spread = abs(single.decided_at - fine.decided_at)
            assert float(data["decided_at"][index]) == pytest.approx(fine.decided_at, abs=2.0 * spread + 1e-5)


def test_rest_between_hops_too_small_to_follow_is_uncertain(runs_of):
    motion = sb.Harmonic.straight(acceleration=0.1, angular_frequency=2.0, start_phase=-math.pi / 2.0)
    runs = runs_of(MODEL, motion, 2, tilt=(0.0, 0.0), duration=20.0, parameters={"scale": [1.0001, 0.99]})
    np.testing.assert_array_equal(runs.together()["uncertain"], [True, False])
    assert runs.alone(0).uncertain


@pytest.mark.slow
def test_a_column_released_under_a_model_that_cannot_depart_is_told():
    class Stuck(sb.Slender):
        departure = None

    with pytest.raises(sb.errors.UnsupportedError, match="does not say how a column departs"):
        sb.simulate_ensemble(Stuck(COLUMN, damping=0.1), CIRCLE.scaled(2.0), duration=5.0)
    held = sb.simulate_ensemble(Stuck(COLUMN, damping=0.1), CIRCLE, duration=5.0)
    assert sb.Outcome(held["outcome"][0]) is sb.Outcome.AT_REST
