"""Runs under records: knots resolved, single runs and lanes alike, rest that does not chatter."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stylobate as sb
from stylobate.records import sample_record

RECORD = sample_record("el centro 1940").trimmed(1.0, 4.5)
MODEL = sb.Wobbling(sb.Column.solid(radius=0.5, height=5.0, density=2700.0), damping=0.05)
START = (0.03, 0.01)


def knot_by_knot(model, record, tilt, rtol, scale=1.0):
    """Follow a column that stays aloft by SciPy, started anew at every knot; return its end state."""
    time_scale, gravity = model.time_scale, model.column.gravity
    state = np.array(model.start(tilt, (0.0, 0.0)))
    for start, step, (left, right) in zip(
        record.times[:-1], np.diff(record.times), zip(record.samples[:-1], record.samples[1:], strict=True), strict=True
    ):

        def rates(tau, y, start=start, step=step, left=left, right=right):
            share = (tau * time_scale - start) / step
            return model.rates(*y, *(scale * (left + share * (right - left)) / gravity), *model.parameters)

        span = (start / time_scale, (start + step) / time_scale)
        state = solve_ivp(rates, span, state, method="DOP853", rtol=rtol, atol=1e-12).y[:, -1]
    return state


def test_lanes_agree_with_scipy_stopped_at_every_knot():
    run = sb.simulate_ensemble(MODEL, RECORD, tilt=START, duration=RECORD.duration, rtol=1e-10)
    state = knot_by_knot(MODEL, RECORD, START, 1e-10)[:, np.newaxis]
    # The column passes the upright at 1e-3 rad or more: errors of 1e-10 a step grow by its inverse at most.
    assert run["minimum_tilt"].item() > 1e-3
    np.testing.assert_allclose(run["end_tilt"].values[0], MODEL.tilt(state)[:, 0], atol=1e-9)
    rate = MODEL.tilt_rate(state)[:, 0] / MODEL.time_scale
    np.testing.assert_allclose(run["end_tilt_rate"].values[0], rate, atol=1e-8)


def test_single_runs_agree_with_lanes():
    alone = sb.simulate(MODEL, RECORD, tilt=START, duration=RECORD.duration, rtol=1e-10)
    lane = sb.simulate_ensemble(MODEL, RECORD, tilt=START, duration=RECORD.duration, rtol=1e-10)
    np.testing.assert_allclose(lane["end_tilt"].values[0], alone.data["tilt"].isel(time=-1).values, atol=1e-9)


def test_a_table_approaches_the_formula_with_the_square_of_its_step():
    pulse = sb.Pulse.one_sine(acceleration=2.0, angular_frequency=4.0)
    model = sb.Slender(MODEL.column, damping=0.05)

    def end(motion):
        run = sb.simulate(model, motion, tilt=START, duration=pulse.duration + 0.3, rtol=1e-12)
        return run.data["tilt"].isel(time=-1).values

    errors = []
    for count in (20, 40, 80):
        # A whole number of steps fits, so that the corners of the pulse lie on knots.
        step = pulse.duration / count
        table = sb.Record(samples=pulse.acceleration(step * np.arange(count + 1)), step=step)
        errors.append(np.linalg.norm(end(table) - end(pulse)))
    orders = np.log2(np.divide(errors[:-1], errors[1:]))
    np.testing.assert_allclose(orders, 2.0, atol=0.1)


def test_what_is_looked_at_does_not_change_a_run():
    plain = sb.simulate_ensemble(MODEL, RECORD, duration=9.0, parameters={"scale": [0.5, 1.0, 1.7]})
    seen = sb.simulate_ensemble(MODEL, RECORD, duration=9.0, samples=37, parameters={"scale": [0.5, 1.0, 1.7]})
    np.testing.assert_allclose(seen["end_tilt"], plain["end_tilt"], rtol=1e-6, atol=1e-12)


def least_uplifting_scale(column, record):
    """Return the factor of the record at which the column is released first, where |a_h| = c(g + a_z) at a knot."""
    x, y, z = record.samples.T
    return float(1.0 / np.max((np.hypot(x, y) - column.slenderness * z) / (column.slenderness * column.gravity)))


@pytest.mark.parametrize("above", [1.02, 1.05, 1.1])
def test_a_column_that_just_uplifts_comes_to_rest_again(above):
    """Hops of less than a hundred-thousandth of c count as rest under a motion that ends; none goes on for ever."""
    scale = least_uplifting_scale(MODEL.column, RECORD)
    runs = sb.simulate_ensemble(
        MODEL, RECORD, duration=RECORD.duration + 5.0, parameters={"scale": [scale / above, scale * above]}
    )
    np.testing.assert_array_equal(runs["uplifts"] > 0, [False, True])
    assert not np.any(runs["outcome"] == sb.Outcome.FAILED)
    assert runs["steps"].values.max() < 20_000


def test_passages_as_slow_as_rest_leave_the_outcome_certain():
    scales = np.linspace(0.3, 2.0, 60)
    runs = sb.simulate_ensemble(MODEL, RECORD, duration=RECORD.duration + 5.0, parameters={"scale": scales})
    assert (runs["uplifts"].values > 0).sum() > 20
    assert runs["uncertain"].values.mean() < 0.1


def test_halving_the_tolerance_changes_no_certain_outcome():
    scales = np.linspace(0.3, 2.5, 80)
    found = [
        sb.simulate_ensemble(MODEL, RECORD, duration=RECORD.duration + 5.0, rtol=rtol, parameters={"scale": scales})
        for rtol in (1e-8, 5e-9)
    ]
    certain = ~(found[0]["uncertain"].values | found[1]["uncertain"].values)
    assert certain.sum() > 70
    np.testing.assert_array_equal(*(runs["outcome"].values[certain] for runs in found))


def test_a_column_on_a_record_is_released_where_the_knots_say():
    """Between knots |a_h| is convex in time where a is linear: the release lies where it first passes c(1 + a_z)."""
    column = MODEL.column
    runs = sb.simulate_ensemble(MODEL, RECORD, duration=RECORD.duration, samples=6001)
    time, tilt = runs["sample_time"].values[0], np.hypot(*runs["sampled_tilt"].values[0].T)
    fine = np.linspace(0.0, RECORD.duration, 600_001)
    a = RECORD.acceleration(fine)
    excess = np.hypot(a[:, 0], a[:, 1]) - column.slenderness * (column.gravity + a[:, 2])
    released = fine[np.argmax(excess > 0.0)]
    first = time[np.argmax(tilt > 0.0)]
    assert released <= first <= released + 2.0 * RECORD.duration / 6000
