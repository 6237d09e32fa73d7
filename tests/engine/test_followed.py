"""A run that kernels followed with a trace of its steps is that of `simulate`, and to the bit that of an ensemble."""

import numpy as np
import pytest

import stylobate as sb
from stylobate.engine.ensembles.batch import Batch, Plan
from stylobate.engine.ensembles.broadcasting import one_run
from stylobate.engine.ensembles.motion_columns import MotionPlan
from stylobate.engine.ensembles.options import Options
from stylobate.engine.followed import TRACES, Followed
from stylobate.engine.lanes.columns import LOG, TRACE_ROOM, Log, Setup

COLUMN = sb.Column.solid(radius=0.5, height=3.0, density=2700.0)
C = COLUMN.slenderness
CIRCLE = sb.Harmonic.circular(acceleration=0.6, angular_frequency=2.2)
STRAIGHT = sb.Harmonic.straight(acceleration=2.0, angular_frequency=4.0)

CASES = {
    "rolls": (sb.Slender(COLUMN, damping=0.1), CIRCLE, (0.3 * C, 0.0), (0.0, 0.05), 10.0),
    "is released, rocks and rests in a plane": (sb.PlanarRocking(COLUMN), STRAIGHT, (0.0, 0.0), (0.0, 0.0), 8.0),
    "rocks out of a plane": (sb.Rolling(COLUMN), STRAIGHT, (0.2 * C, 0.1 * C), (0.0, 0.0), 6.0),
    "wobbles": (sb.Wobbling(COLUMN, rolling_resistance=0.05), CIRCLE, (0.3 * C, 0.0), (0.0, 0.05), 6.0),
    "under a record": (sb.Slender(COLUMN), sb.sample_record(), (0.2 * C, 0.1 * C), (0.0, 0.0), 4.0),
    "overturns": (sb.Slender(COLUMN), CIRCLE.scaled(4.0), (0.3 * C, 0.0), (0.0, 0.0), 40.0),
}


def plan_of(model, motion, duration, *, traces=TRACES, rtol=1e-10):
    options = Options.checked(
        rtol=rtol,
        atol=None,
        tilt_limit=None,
        rest_energy=None,
        max_steps=200_000,
        samples=None,
        strobes=0,
        rules=None,
    )
    return Plan(model, MotionPlan.of(motion, {}, np.array([duration])), options, traces=traces)


def followed(case, **options):
    model, motion, tilt, rate, duration = CASES[case]
    carried = (0.0,) * len(model.carried_names)
    pauses = []
    run = Followed.of(
        plan_of(model, motion, duration, **options),
        one_run(tilt, rate, 0.0, duration),
        carried,
        lambda *told: pauses.append(told),
    )
    return run, pauses


@pytest.mark.parametrize("case", CASES)
def test_states_and_events_are_those_of_an_independent_integration(case):
    model, motion, tilt, rate, duration = CASES[case]
    run, _ = followed(case)
    other = sb.simulate(model, motion, tilt=tilt, tilt_rate=rate, duration=duration, rtol=1e-10)
    assert [event.kind for event in run.events] == [event.kind for event in other.events]
    times = [[event.time for event in one.events] for one in (run, other)]
    np.testing.assert_allclose(*times, atol=1e-6)
    time = np.linspace(0.0, run.trajectory.end * model.time_scale * (1.0 - 1e-9), 400)
    apart = np.abs(time[:, np.newaxis] - np.array(times[0])).min(axis=1, initial=1.0)
    smooth = time[apart > 1e-5]  # a rate jumps where a swing ends
    data, tau = other.sample(smooth), smooth / model.time_scale
    states = run.trajectory.states(tau)
    np.testing.assert_allclose(model.tilt(states).T, data["tilt"].values, atol=1e-6 * C)
    np.testing.assert_allclose(
        model.tilt_rate(states).T / model.time_scale, data["tilt_rate"].values, atol=1e-5 * C / model.time_scale
    )
    np.testing.assert_array_equal(run.trajectory.resting(tau), data["resting"].values)
    if not other.planar:
        azimuth = run.trajectory.azimuth(tau, model.tilt(states))
        assert azimuth - data["azimuth"].values == pytest.approx(0.0, abs=1e-4, nan_ok=True)


@pytest.mark.parametrize("case", ["rocks out of a plane", "wobbles"])
def test_what_is_carried_along_is_that_of_an_independent_integration(case):
    model, motion, tilt, rate, duration = CASES[case]
    run, _ = followed(case)
    data = sb.simulate(model, motion, tilt=tilt, tilt_rate=rate, duration=duration, rtol=1e-10).data
    carried = run.trajectory.states(data["time"].values / model.time_scale)[-3:]
    np.testing.assert_allclose(carried[0], data["twist"].values, atol=1e-6)
    np.testing.assert_allclose(COLUMN.radius * carried[1:].T, data["footprint"].values, atol=1e-6)


@pytest.mark.parametrize("case", CASES)
def test_a_trace_changes_no_bit_of_a_run(case):
    model, motion, tilt, rate, duration = CASES[case]
    run, _ = followed(case)
    batch = Batch.of(plan_of(model, motion, duration, traces=0), one_run(tilt, rate, 0.0, duration))
    batch.advance(np.zeros(1, dtype=np.uint8))
    columns = np.arange(batch.table.shape[1])
    columns = columns[(columns != LOG + Log.NEXT_TRACE) & (columns != Setup.TRACES)]
    np.testing.assert_array_equal(run.batch.table[:, columns], batch.table[:, columns])


def test_a_trace_that_is_taken_out_now_and_then_loses_nothing():
    whole, pauses = followed("rolls", traces=100_000)
    assert not pauses
    in_parts, pauses = followed("rolls", traces=50 + TRACE_ROOM)
    assert len(pauses) == (whole.trajectory.steps - 1) // 50
    np.testing.assert_array_equal(in_parts.trajectory.stretches, whole.trajectory.stretches)
    np.testing.assert_array_equal(in_parts.batch.log(Log.TIME), whole.batch.log(Log.TIME))


def test_a_run_that_ends_where_it_begins_has_a_state():
    model = sb.Slender(COLUMN)
    run = Followed.of(
        plan_of(model, CIRCLE, 1.0), one_run((1.4, 0.0), (0.5, 0.0), 0.0, 1.0), (), lambda _steps, _time: None
    )
    assert run.events[-1].kind == "overturned"
    assert model.tilt(run.trajectory.states(np.zeros(1)))[:, 0] == pytest.approx([1.4, 0.0])
