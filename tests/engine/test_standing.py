"""Loads on the base of a standing column: where they are sampled, and their extremes."""

import math

import numpy as np
import pytest

import stylobate as sb
from stylobate.engine.forcing import Forcing
from stylobate.engine.history import loads_while_standing

MODEL = sb.Slender(sb.Column.solid(radius=0.5, height=5.0, density=2700.0))
RECORD = sb.sample_record()
LIFTED = sb.Harmonic(amplitude=(0.5, 0.2, 2.0), phase=(0.0, 0.5, 1.0), angular_frequency=2.0)


def loads(motion, start, end):
    """Return times [s] and loads from `start` to `end` [s]."""
    scale = MODEL.time_scale
    found = loads_while_standing(Forcing.of(MODEL, motion), start / scale, end / scale)
    return found.tau * scale, found


def test_under_a_record_loads_are_sampled_at_its_samples_and_at_the_ends():
    # A record is linear between samples: no load is larger there.
    start, end = 1.003, 4.007
    time, found = loads(RECORD, start, end)
    knots = RECORD.step * np.arange(math.ceil(start / RECORD.step), math.floor(end / RECORD.step) + 1)
    np.testing.assert_allclose(time, [start, *knots, end], rtol=0.0, atol=1e-12)
    ax, ay, az = RECORD.acceleration(time).T
    np.testing.assert_allclose(found.normal, 1.0 + az / 9.80665, rtol=1e-12)
    np.testing.assert_allclose(found.friction, np.hypot(ax, ay) / (9.80665 + az), rtol=1e-12)


@pytest.mark.parametrize(("start", "periods"), [(0.3, 20.0), (0.0, 0.7)])
def test_under_a_harmonic_motion_loads_of_one_period_are_sampled_64_times_at_least(start, periods):
    end = start + periods * LIFTED.period
    time, found = loads(LIFTED, start, end)
    assert (time[0], time[-1]) == (pytest.approx(start), pytest.approx(end))
    dense = time[:-1] if periods > 1.0 else time
    assert dense[-1] - start == pytest.approx(min(periods, 1.0) * LIFTED.period)
    assert np.diff(dense).max() <= LIFTED.period / 64.0 * (1.0 + 1e-9)
    assert time.size <= 64 * min(periods, 1.0) + 3
    ax, ay, az = LIFTED.acceleration(np.linspace(start, end, 100_001)).T
    # Between two samples a cosine falls by half the square of π/64.
    assert found.friction.max() == pytest.approx((np.hypot(ax, ay) / (9.80665 + az)).max(), rel=5e-3)
    assert found.normal.min() == pytest.approx(1.0 + az.min() / 9.80665, rel=5e-3)


def test_a_motion_that_becomes_periodic_is_sampled_for_one_period_after_its_last_break():
    ramped = sb.Harmonic.circular(acceleration=0.7, angular_frequency=2.0, ramp=4.0)
    time, _ = loads(ramped, 0.0, 40.0)
    assert time[-2] == pytest.approx(max(ramped.breaks) + ramped.period)
    assert np.diff(time[:-1]).max() <= ramped.period / 64.0 * (1.0 + 1e-9)
