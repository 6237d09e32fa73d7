"""Runs under a periodic motion without a duration: they go on until the outcome is decided."""

import numpy as np
import pytest

import stylobate as sb
from stylobate.engine.verdict import MOST_PERIODS

MODEL = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)


def circle(frequency, acceleration=0.065):
    return sb.Harmonic.circular(acceleration=acceleration, angular_frequency=frequency)


def off_the_branch(motion):
    """Return the start on the upper branch with a tilt that is 0.1 % larger."""
    start = sb.studies.steady_start(MODEL, motion)
    return {**start, "tilt": tuple(1.001 * one for one in start["tilt"])}


@pytest.mark.parametrize(
    ("frequency", "outcome"),
    [(1.8, "ROLLING"), (1.41, "ROLLING"), (1.396, "MODULATED"), (1.36, "MODULATED"), (1.3, "OVERTURNED")],
)
def test_steady_rolling_that_is_not_stable_is_left_below_the_critical_frequency(frequency, outcome):
    run = sb.simulate(MODEL, circle(frequency), **off_the_branch(circle(frequency)))
    assert run.outcome == outcome


@pytest.mark.parametrize(("acceleration", "frequency"), [(0.1, 5.0), (0.07, 4.5), (0.15, 4.8)])
def test_slow_transients_are_followed_to_their_end(acceleration, frequency):
    motion = circle(frequency, acceleration)
    short = sb.simulate(MODEL, motion, tilt=(0.02, 0.0), duration=20.0 * motion.period)
    assert short.outcome is sb.Outcome.STILL_MOVING
    run = sb.simulate(MODEL, motion, tilt=(0.02, 0.0))
    assert run.outcome is not sb.Outcome.STILL_MOVING
    assert run.data["time"][-1] <= MOST_PERIODS * motion.period


def test_the_run_is_that_of_its_duration():
    motion = circle(1.398)
    run = sb.simulate(MODEL, motion, **off_the_branch(motion))
    same = sb.simulate(MODEL, motion, **off_the_branch(motion), duration=run.provenance["duration"])
    assert run.outcome is same.outcome
    np.testing.assert_array_equal(run.data["tilt"], same.data["tilt"])
    assert run.provenance["duration"] > 100.0 * motion.period  # longer than the first try


def test_a_tilt_limit_and_an_event_end_the_run_as_always():
    motion = circle(1.3)
    run = sb.simulate(MODEL, motion, **off_the_branch(motion), tilt_limit=0.09)
    assert run.outcome is sb.Outcome.LIMIT_REACHED
    ended = sb.EventFunction("five", lambda time, _: time - 5.0, terminal=True)
    assert sb.simulate(MODEL, motion, **off_the_branch(motion), events=[ended]).outcome is sb.Outcome.STOPPED
