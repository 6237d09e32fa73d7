"""A run followed by kernels with a trace agrees with an independent integration, and to the bit with an ensemble."""

import numpy as np
import pytest
from tests.reference import integrated

import stylobate as sb
from stylobate.base_motions import BASE_AT_REST
from stylobate.engine.ensembles.batch import Batch
from stylobate.engine.ensembles.broadcasting import one_run
from stylobate.engine.followed import TRACES, Followed
from stylobate.engine.lanes.columns import LOG, TRACE_ROOM, Log, Setup, Status, Trace, TraceKind

from .plans import plan_of

COLUMN = sb.Column.solid(radius=0.5, height=3.0, density=2700.0)
C = COLUMN.slenderness
STILL = (0.0, 0.0)
CIRCLE = sb.Harmonic.circular(acceleration=0.6, angular_frequency=2.2)
LINE = sb.Harmonic.straight(acceleration=2.0, angular_frequency=4.0)
# Releases the column: its limit is C g.
STRONG = sb.Harmonic.straight(acceleration=3.5, angular_frequency=6.0)
STRONG_CIRCLE = sb.Harmonic.circular(acceleration=3.5, angular_frequency=6.0)

# Model, motion, tilt, tilt rate and duration of each run, and the kinds of stretches and events that it has.
CASES = {
    "rolls": (sb.Slender(COLUMN, damping=0.1), CIRCLE, (0.3 * C, 0.0), (0.0, 0.05), 4.0, "STEP"),
    "under a record": (sb.Slender(COLUMN), sb.sample_record(), (0.2 * C, 0.1 * C), STILL, 4.0, "STEP"),
    "spins freely": (sb.Rolling(COLUMN), LINE, (0.2 * C, 0.1 * C), STILL, 6.0, "STEP"),
    "wobbles": (sb.Wobbling(COLUMN, rolling_resistance=0.05), CIRCLE, (0.3 * C, 0.0), (0.0, 0.05), 4.0, "STEP"),
    "overturns": (sb.Slender(COLUMN), CIRCLE.scaled(4.0), (0.3 * C, 0.0), STILL, 40.0, "STEP overturned"),
    "is released": (sb.Slender(COLUMN, damping=0.1), STRONG_CIRCLE, STILL, STILL, 2.0, "STAND STEP release"),
    "passes the upright": (sb.Slender(COLUMN), STRONG, STILL, STILL, 1.0, "STAND PLANE_STEP release passage"),
    "rocks and rests": (
        *(sb.PlanarRocking(COLUMN, restitution=0.8), STRONG, STILL, STILL, 2.0),
        "STAND PLANE_STEP release impact rest",
    ),
    "leaps past the upright": (sb.Slender(COLUMN), BASE_AT_REST, (0.3 * C, 0.0), (0.0, 1e-11 * C), 3.0, "STEP LEAP"),
    "strikes its base": (sb.Wobbling(COLUMN, restitution=0.9), CIRCLE, (0.2 * C, 0.0), (0.0, 1e-4), 3.0, "STEP impact"),
    "rests, then rocks in a plane": (
        *(sb.Wobbling(COLUMN, restitution=0.3), STRONG.delayed(2.0), (0.02 * C, 0.01 * C), STILL, 2.8),
        "STEP LEAP STAND PLANE_STEP release impact rest",
    ),
}
RTOL = 1e-10


def followed(case, *, traces=TRACES, **options):
    model, motion, tilt, rate, duration, _ = CASES[case]
    pauses = []
    run = Followed.of(
        plan_of(model, motion, duration, traces=traces, rtol=RTOL, **options),
        one_run(tilt, rate, 0.0, duration),
        (0.0,) * len(model.carried_names),
        lambda *progress: pauses.append(progress),
    )
    return run, pauses


def referred(case, **options):
    model, motion, tilt, rate, duration, _ = CASES[case]
    return integrated(model, motion, tilt=tilt, tilt_rate=rate, duration=duration, rtol=RTOL, **options)


@pytest.mark.parametrize("case", CASES)
def test_a_case_has_what_it_is_named_for(case):
    run, _ = followed(case)
    stretches = {TraceKind(int(kind)).name for kind in run.trajectory.stretches[:, Trace.KIND]}
    assert stretches | {event.kind for event in run.events} == set(CASES[case][-1].split())


@pytest.mark.parametrize("case", CASES)
def test_states_and_events_agree_with_an_independent_integration(case):
    assert_alike(CASES[case][0], followed(case)[0], referred(case))


def assert_alike(model, run, other):
    assert [event.kind for event in run.events] == [event.kind for event in other.events]
    times = [np.array([event.time for event in one.events]) for one in (run, other)]
    np.testing.assert_allclose(*times, atol=1e-6)
    time = np.linspace(0.0, run.trajectory.end * model.time_scale * (1.0 - 1e-9), 400)
    apart = np.abs(time[:, np.newaxis] - times[0]).min(axis=1, initial=1.0)
    smooth = time[apart > 1e-5]  # a rate jumps where a swing ends
    tau = smooth / model.time_scale
    states, expected = run.trajectory.states(tau), other.trajectory.states(tau)
    np.testing.assert_allclose(model.tilt(states), model.tilt(expected), atol=1e-6 * C)
    np.testing.assert_allclose(model.tilt_rate(states), model.tilt_rate(expected), atol=1e-5 * C)
    np.testing.assert_array_equal(run.trajectory.resting(tau), other.trajectory.resting(tau))
    if run.log(Log.IN_SPACE) and TraceKind.PLANE_STEP not in run.trajectory.stretches[:, Trace.KIND]:
        azimuth = run.trajectory.azimuth(tau, model.tilt(states))
        np.testing.assert_allclose(azimuth, other.trajectory.azimuth(tau, model.tilt(expected)), atol=1e-4)


@pytest.mark.parametrize("make", [sb.Slender, sb.SlenderRolling, sb.Wobbling, sb.Rolling, sb.PlanarRocking])
@pytest.mark.parametrize("seed", range(6))
def test_runs_at_random_agree_with_an_independent_integration(make, seed):
    random = np.random.default_rng(seed)
    model = make(COLUMN, damping=0.2 * random.random())
    direction = random.uniform(0.0, 2.0 * np.pi)
    motion = sb.Harmonic.straight(
        acceleration=C * 9.81 * random.uniform(0.3, 1.5),
        angular_frequency=random.uniform(2.0, 8.0),
        direction=direction,
        start_phase=random.uniform(0.0, 2.0 * np.pi),
    )
    lean = direction if make is sb.PlanarRocking else random.uniform(0.0, 2.0 * np.pi)
    tilt, duration = 0.4 * C * random.random() * np.array([np.cos(lean), np.sin(lean)]), 3.0
    start = one_run(tuple(tilt), STILL, 0.0, duration)
    run = Followed.of(
        plan_of(model, motion, duration, traces=TRACES, rtol=RTOL),
        start,
        (0.0,) * len(model.carried_names),
        lambda _steps, _time: None,
    )
    assert_alike(model, run, integrated(model, motion, tilt=tilt, duration=duration, rtol=RTOL))


@pytest.mark.parametrize("case", ["spins freely", "wobbles", "rests, then rocks in a plane"])
def test_twist_and_footprint_agree_with_an_independent_integration(case):
    run, other = followed(case)[0], referred(case)
    tau = np.linspace(0.0, run.trajectory.end, 400)
    np.testing.assert_allclose(run.trajectory.states(tau)[-3:], other.trajectory.states(tau)[-3:], atol=1e-6)


@pytest.mark.parametrize("case", CASES)
def test_a_trace_changes_no_bit_of_a_run(case):
    model, motion, tilt, rate, duration, _ = CASES[case]
    run, _ = followed(case)
    batch = Batch.of(plan_of(model, motion, duration, rtol=RTOL), one_run(tilt, rate, 0.0, duration))
    batch.advance(np.zeros(1, dtype=np.uint8))
    columns = np.arange(batch.table.shape[1])
    columns = columns[(columns != LOG + Log.NEXT_TRACE) & (columns != Setup.TRACES)]
    np.testing.assert_array_equal(run.batch.table[:, columns], batch.table[:, columns])


@pytest.mark.parametrize("case", ["rolls", "rocks and rests", "rests, then rocks in a plane"])
def test_a_trace_that_is_emptied_several_times_loses_nothing(case):
    whole, pauses = followed(case, traces=100_000)
    assert not pauses
    in_parts, pauses = followed(case, traces=20 + TRACE_ROOM)
    assert len(pauses) > 2
    np.testing.assert_array_equal(in_parts.trajectory.stretches, whole.trajectory.stretches)
    assert in_parts.events == whole.events


def test_a_step_that_is_taken_back_leaves_no_trace():
    whole = followed("spins freely")[0]
    limit = (1.0 - 1e-7) * whole.log(Log.LARGEST_TILT)  # reached between the ends of a step
    run, other = followed("spins freely", tilt_limit=limit)[0], referred("spins freely", tilt_limit=limit)
    assert run.status == Status.LIMIT
    assert run.trajectory.end * run.trajectory.model.time_scale == pytest.approx(other.events[-1].time, abs=1e-6)
    assert np.all(np.diff(run.trajectory.starts) > 0.0)
    assert run.trajectory.steps == len(run.trajectory.stretches) < whole.trajectory.steps


@pytest.mark.parametrize("share", [0.0, 0.5, 1.0])
def test_a_run_may_end_at_or_within_a_leap(share):
    model, motion, tilt, rate, _, _ = CASES["leaps past the upright"]
    whole = followed("leaps past the upright")[0].trajectory
    leap = whole.stretches[whole.stretches[:, Trace.KIND] == TraceKind.LEAP][0]
    end = leap[Trace.START] + share * leap[Trace.LENGTH]
    duration = end * model.time_scale
    plan = plan_of(model, motion, duration, traces=TRACES, rtol=RTOL)
    run = Followed.of(plan, one_run(tilt, rate, 0.0, duration), (), lambda _steps, _time: None)
    assert run.status == Status.STOPPED
    assert run.trajectory.end == pytest.approx(end, rel=1e-14)
    lean, expected = (model.tilt(one.states(np.array([end]))) for one in (run.trajectory, whole))
    np.testing.assert_allclose(lean, expected, atol=1e-6 * C)


def test_a_run_that_ends_where_it_begins_has_a_state():
    model = sb.Slender(COLUMN)
    plan, run = plan_of(model, CIRCLE, traces=TRACES), one_run((1.4, 0.0), (0.5, 0.0), 0.0, 1.0)
    ended = Followed.of(plan, run, (), lambda _steps, _time: None)
    assert ended.events[-1].kind == "overturned"
    assert model.tilt(ended.trajectory.states(np.zeros(1)))[:, 0] == pytest.approx([1.4, 0.0])


class Uncompiled(sb.Slender):
    """Its equations are those of `Slender`, in words that are not compiled."""

    @staticmethod
    def rates(*numbers):
        return tuple({"rate": rate}["rate"] for rate in sb.Slender.rates(*numbers))


def test_a_model_that_cannot_be_compiled_is_followed_in_plain_python(caplog):
    runs = [
        sb.simulate(make(COLUMN, damping=0.1), CIRCLE, tilt=(0.3 * C, 0.0), tilt_rate=(0.0, 0.05), duration=2.0)
        for make in (sb.Slender, Uncompiled)
    ]
    assert "simulate follows single runs of it uncompiled" in caplog.text
    # Sums are rounded otherwise in machine code, in the last digits.
    np.testing.assert_allclose(*(run.data["tilt"].values for run in runs), rtol=0.0, atol=1e-13)
