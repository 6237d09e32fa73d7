"""A record: linear between samples, integrated exactly, bounded exactly."""

import math
import pickle

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

import stylobate as sb
from stylobate.engine.ensembles.polynomials import tabulated
from stylobate.errors import ParameterError

STEP = 0.25
SAMPLES = np.array(
    [[0.4, 0.0, 0.1], [-1.0, 2.0, 0.0], [0.5, 1.0, -0.7], [3.0, -1.0, 0.2], [0.0, 0.3, 0.0], [-0.6, 0.2, 0.3]]
)
RECORD = sb.Record(samples=SAMPLES, step=STEP, start=0.5, name="six")
INSIDE = np.linspace(0.0, 3.0, 37)
numbers = st.floats(-5.0, 5.0, allow_nan=False)


def test_acceleration_is_linear_between_samples_and_zero_outside():
    expected = [np.interp(INSIDE, RECORD.times, column, left=0.0, right=0.0) for column in SAMPLES.T]
    np.testing.assert_allclose(RECORD.acceleration(INSIDE), np.stack(expected, axis=-1), rtol=0.0, atol=1e-15)


@pytest.mark.parametrize(("integrand", "integral"), [("acceleration", "velocity"), ("velocity", "displacement")])
def test_velocity_and_displacement_are_the_integrals(integrand, integral):
    for time in (0.3, 0.9, 1.31, 1.75, 2.6):
        for axis in range(3):
            value, _ = quad(
                lambda t, i=axis: getattr(RECORD, integrand)(t)[i], 0.0, time, points=RECORD.times, limit=200
            )
            assert getattr(RECORD, integral)(time)[axis] == pytest.approx(value, rel=1e-11, abs=1e-12)


def test_after_the_end_the_base_goes_on_at_its_velocity():
    end = RECORD.duration
    np.testing.assert_array_equal(RECORD.velocity(end + 7.0), RECORD.residual_velocity)
    gone = RECORD.displacement(end + 2.0) - RECORD.displacement(end)
    np.testing.assert_allclose(gone, 2.0 * RECORD.residual_velocity, rtol=1e-14)


def test_what_lies_before_the_beginning_never_acts():
    past = RECORD.delayed(-10.0)
    assert past.duration == 0.0
    assert past.peak_horizontal() == 0.0
    assert past.vertical_range() == (0.0, 0.0)
    assert not past.acceleration([0.0, 1.0]).any()


@given(st.lists(st.tuples(numbers, numbers, numbers), min_size=2, max_size=8), st.floats(-1.0, 5.0))
def test_bounds_are_the_least_from_a_time_on(samples, since):
    record = sb.Record(samples=samples, step=0.5, start=0.25)
    later = np.concatenate([[since], np.linspace(since, 6.0, 400), record.times[record.times >= since]])
    x, y, z = record.acceleration(later).T
    assert record.peak_horizontal(since) == pytest.approx(np.hypot(x, y).max(), rel=1e-13, abs=1e-13)
    low, high = record.vertical_range(since)
    assert low == pytest.approx(min(z.min(), 0.0), rel=1e-13, abs=1e-13)
    assert high == pytest.approx(max(z.max(), 0.0), rel=1e-13, abs=1e-13)


@given(st.lists(st.tuples(numbers, numbers, numbers), min_size=2, max_size=8))
def test_the_highest_frequency_bounds_the_slope_as_in_harmonic_motion(samples):
    record = sb.Record(samples=samples, step=0.1)
    slopes = np.diff(record.samples[:, :2], axis=0) / 0.1
    largest = np.hypot(*slopes.T).max()
    assert largest <= record.highest_frequency * record.peak_horizontal() * (1.0 + 1e-12) + 1e-12


def test_breaks_are_the_knots_at_which_the_slope_changes():
    bent = sb.Record(samples=[0.0, 1.0, 2.0, 2.0, 0.0, 0.0, 0.0], step=1.0)
    assert bent.breaks == (0.0, 2.0, 3.0, 4.0)
    assert sb.Record(samples=[1.0, 1.0, 1.0], step=1.0).breaks == (0.0, 2.0)


def test_the_table_of_the_compiled_engine_is_the_record():
    table = tabulated(RECORD, 3.0)
    edges = table.rows[:, :2]
    assert len(edges) < 12  # one piece a step
    for (begin, end), coefficients in zip(edges, table.coefficients, strict=True):
        s = np.linspace(-0.99, 0.99, 5)
        middle, half = 0.5 * (begin + end), 0.5 * (end - begin)
        values = np.stack([np.polynomial.polynomial.polyval(s, c) for c in coefficients], axis=-1)
        np.testing.assert_allclose(values, RECORD.acceleration(middle + half * s), rtol=0.0, atol=1e-13)


def test_a_run_under_a_record_is_that_of_an_independent_integration(integrate_equations_1):
    column = sb.Column.dimensionless(slenderness=0.1)
    record = sb.Record(samples=np.array([[0.0, 0.0], [0.3, 0.1], [-0.2, 0.2], [0.1, -0.3], [0.0, 0.0]]), step=0.4)
    state = (0.02, 0.01, 0.0, 0.03)
    oracle = np.array(state)
    for begin, end in zip(record.times[:-1], record.times[1:], strict=True):
        leg = integrate_equations_1(
            oracle, (begin, end), c=0.1, eta=0.1, acceleration=lambda t: tuple(record.acceleration(t))
        )
        oracle = leg.y[:, -1]
    run = sb.simulate(sb.Slender(column, damping=0.1), record, tilt=state[:2], tilt_rate=state[2:], duration=1.6)
    np.testing.assert_allclose(run.data.tilt.values[-1], oracle[:2], rtol=1e-7, atol=1e-9)


def test_one_line_is_told_from_two():
    assert len(RECORD.directions()) == 2
    line = sb.Record(samples=SAMPLES[:, :1], step=STEP)
    assert line.directions() == ((3.0, 0.0),)
    turned = line.rotated(0.7).rotated(-1.9)
    ((x, y),) = turned.directions()
    assert math.atan2(y, x) == pytest.approx(-1.2, abs=1e-14)
    assert sb.Record.from_components(z=[1.0, 2.0], step=STEP).directions() == ()


def test_components_that_are_not_given_are_zero():
    record = sb.Record.from_components(z=[1.0, 2.0], y=[3.0, 4.0], step=1.0)
    assert record.axes == ("y", "z")
    np.testing.assert_array_equal(record.samples, [[0.0, 3.0, 1.0], [0.0, 4.0, 2.0]])


def test_records_are_values():
    same = sb.Record(samples=SAMPLES.copy(), step=STEP, start=0.5)
    assert same == RECORD
    assert hash(same) == hash(RECORD)
    assert RECORD.scaled(2.0) != RECORD
    assert RECORD != "six"
    assert pickle.loads(pickle.dumps(RECORD)) == RECORD  # noqa: S301
    with pytest.raises(ValueError, match="read-only"):
        RECORD.samples[0, 0] = 1.0


def test_the_repr_tells_records_apart():
    assert repr(RECORD).startswith("Record('six', 6 samples every 0.25 s from 0.5 s, x y z, peak 3 m/s², ")
    assert repr(RECORD) != repr(RECORD.scaled(1.0 + 1e-15))


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"samples": [1.0], "step": 0.1}, r"samples must be numbers of shape .* got \(1,\)"),
        ({"samples": np.ones((5, 4)), "step": 0.1}, r"samples must be numbers of shape .* got \(5, 4\)"),
        ({"samples": ["a", "b"], "step": 0.1}, "samples must be numbers"),
        ({"samples": [1.0, math.nan], "step": 0.1}, r"samples must be finite, got \[nan\] at index 1"),
        ({"samples": [1.0, 2.0], "step": 0.0}, r"step must be positive, got 0.0 s"),
        ({"samples": [1.0, 2.0], "step": 1.0, "start": math.inf}, r"start must be finite"),
    ],
)
def test_what_is_no_record_is_refused(arguments, message):
    with pytest.raises(ParameterError, match=message):
        sb.Record(**arguments)


def test_components_of_different_lengths_are_refused():
    with pytest.raises(ParameterError, match="arrays of one length"):
        sb.Record.from_components(x=[1.0, 2.0], y=[1.0, 2.0, 3.0], step=1.0)
    with pytest.raises(ParameterError, match="one of them at least"):
        sb.Record.from_components(step=1.0)
