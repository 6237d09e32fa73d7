"""Runs that would last without end come to one, by the step limit, and say so; starts of dust are starts at zero."""

import logging
import math
import time

import pytest
from tests.reference.forcing import Forcing
from tests.reference.resting import release_time, release_within

import stylobate as sb
from stylobate.engine.cost import expected_steps

COLUMN = sb.Column.dimensionless(slenderness=0.1)
MODEL = sb.Slender(COLUMN, damping=0.1)
FEW = 300


def straight(acceleration, angular_frequency, direction=0.0, start_phase=0.0):
    return sb.Harmonic.straight(
        acceleration=acceleration, angular_frequency=angular_frequency, direction=direction, start_phase=start_phase
    )


# Bounds of both pass the release limit, and neither motion reaches it: one repeats, the other does not.
REPEATING = straight(0.08, 2.0) + straight(0.08, 2.0, math.pi / 2.0, math.pi / 2.0)
NOT_REPEATING = straight(0.04, 2.0) + straight(0.04, 2.0 * math.sqrt(2.0), 1.6) + straight(0.04, 3.0 * math.pi, 0.8)


@pytest.mark.parametrize(
    ("model", "motion", "duration"),
    [
        (MODEL, straight(0.05, 2.0), 1e15),
        (MODEL, sb.Harmonic.circular(acceleration=0.05, angular_frequency=20.0), 1e15),
        (MODEL, straight(0.05, 5e5), 2e5),
        (sb.Slender(COLUMN, damping=1e9), straight(0.2, 2.0), 10.0),
        (sb.SlenderRolling(COLUMN, damping=0.1, spin_damping=1e9), straight(0.2, 2.0), 10.0),
    ],
)
def test_more_steps_than_there_may_be_are_announced_and_the_limit_is_named(model, motion, duration, caplog):
    run = sb.simulate(model, motion, tilt=(0.02, 0.03), duration=duration, max_steps=FEW)
    assert "steps are expected and max_steps is 300" in caplog.text
    assert run.outcome is sb.Outcome.FAILED
    assert "max_steps = 300; raise max_steps" in run.reason


def test_a_run_reports_how_far_it_is_and_one_of_few_steps_says_nothing(caplog):
    caplog.set_level(logging.INFO)
    sb.simulate(MODEL, straight(0.05, 2.0), tilt=(0.02, 0.03), duration=20.0)
    assert not caplog.records
    sb.simulate(MODEL, straight(0.05, 60.0), tilt=(0.02, 0.03), duration=400.0, max_steps=1500)
    assert "1000 steps of at most 1500, at " in caplog.text


def test_expected_steps_are_no_more_than_a_run_takes():
    for damping, frequency in ((0.1, 20.0), (100.0, 2.0)):
        model, motion = sb.Slender(COLUMN, damping=damping), straight(0.02, frequency)
        run = sb.simulate(model, motion, tilt=(0.02, 0.03), duration=20.0, rest_energy=0.0)
        assert expected_steps(model, frequency, run.data["time"].values[-1]) <= run.measures["steps"]


def test_a_motion_that_repeats_is_looked_at_for_as_long_as_it_needs_to():
    began = time.process_time()
    run = sb.simulate(MODEL, REPEATING, duration=1e12)
    assert time.process_time() - began < 5.0
    assert run.outcome is sb.Outcome.AT_REST
    assert run.decided_at == 1e12


@pytest.mark.slow
def test_a_column_that_stands_under_a_motion_without_period_ends_by_the_limit():
    run = sb.simulate(MODEL, NOT_REPEATING, duration=1e9, max_steps=FEW)
    assert run.outcome is sb.Outcome.FAILED
    assert "it stands for 300 periods of the base motion" in run.reason


@pytest.mark.parametrize("motion", [straight(0.12, 2.0, start_phase=1.6), NOT_REPEATING.scaled(2)])
def test_releases_within_the_limit_are_those_of_the_whole_search(motion):
    forcing = Forcing.of(MODEL, motion)
    whole = release_time(MODEL, forcing, 0.0, 50.0)
    assert release_within(MODEL, forcing, 0.0, 50.0, 10_000) == (whole, True)
    assert release_within(MODEL, forcing, 0.0, 50.0, 10)[0] == pytest.approx(whole, rel=1e-12)


@pytest.mark.parametrize("dust", [1e-300, -1e-160, 5e-324])
@pytest.mark.parametrize("rate", [(0.05, 0.0), (0.0, 0.05)])
def test_a_start_too_small_to_be_squared_is_a_start_at_zero(dust, rate):
    here, there = (
        sb.simulate(MODEL, straight(0.05, 2.0), tilt=tilt, tilt_rate=rate, duration=3.0)
        for tilt in ((dust, 0.0), (0.0, 0.0))
    )
    assert here.data.identical(there.data)
    runs = sb.simulate_ensemble(
        MODEL, straight(0.05, 2.0), tilt=[(dust, 0.0), (0.0, 0.0)], tilt_rate=rate, duration=3.0
    )
    assert runs["outcome"][0] == runs["outcome"][1]
    assert (runs["end_tilt"][0] == runs["end_tilt"][1]).all()
