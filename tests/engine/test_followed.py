"""A run followed by kernels with a trace agrees with an independent integration, and to the bit with an ensemble."""

from functools import cache

import numpy as np
import pytest
from tests.reference import integrated, switched

import stylobate as sb
from stylobate.base_motions import BASE_AT_REST
from stylobate.engine.ensembles.batch import Batch
from stylobate.engine.ensembles.results import Contacts
from stylobate.engine.ensembles.runs import one_run
from stylobate.engine.kernel.columns import LOG, TRACE_ROOM, Change, Log, Setup, Trace
from stylobate.engine.kernel.driver.events import RunStatus, TraceKind
from stylobate.engine.single import Followed
from stylobate.engine.starts import RunStart, Turning
from stylobate.models.sliding import Contact

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
    "is released": (sb.Slender(COLUMN, damping=0.1), STRONG_CIRCLE, STILL, STILL, 2.0, "STAND STEP uplift"),
    "passes the upright": (sb.Slender(COLUMN), STRONG, STILL, STILL, 1.0, "STAND PLANE_STEP uplift passage"),
    "rocks and rests": (
        *(sb.PlanarRocking(COLUMN, restitution=0.8), STRONG, STILL, STILL, 2.0),
        "STAND PLANE_STEP uplift impact rest",
    ),
    "analytical step past the vertical": (
        sb.Slender(COLUMN),
        BASE_AT_REST,
        (0.3 * C, 0.0),
        (0.0, 1e-11 * C),
        3.0,
        "STEP ANALYTICAL_STEP",
    ),
    "strikes its base": (sb.Wobbling(COLUMN, restitution=0.9), CIRCLE, (0.2 * C, 0.0), (0.0, 1e-4), 3.0, "STEP impact"),
    "rests, then rocks in a plane": (
        *(sb.Wobbling(COLUMN, restitution=0.3), STRONG.delayed(2.0), (0.02 * C, 0.01 * C), STILL, 2.8),
        "STEP ANALYTICAL_STEP STAND PLANE_STEP uplift impact rest",
    ),
}
RTOL = 1e-10


def ignored(_steps, _time):
    """Take no notice of a pause."""


@cache
def followed(case, **options):
    model, motion, tilt, rate, duration, _ = CASES[case]
    pauses = []
    plan = plan_of(model, motion, duration, rtol=RTOL, **options)
    run = Followed.of(plan, one_run(RunStart(tilt, rate, duration)), lambda *progress: pauses.append(progress))
    return run, pauses


@cache
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
    # An analytical step past the vertical has a relative error of 1e-6 in its speed, which shifts the later motion.
    np.testing.assert_allclose(*times, rtol=0.0, atol=3e-6)
    time = np.linspace(0.0, run.trajectory.end * model.time_scale * (1.0 - 1e-9), 400)
    apart = np.abs(time[:, np.newaxis] - times[0]).min(axis=1, initial=1.0)
    smooth = time[apart > 1e-5]  # a rate jumps where a swing ends
    tau = smooth / model.time_scale
    states, expected = run.trajectory.states(tau), other.trajectory.states(tau)
    np.testing.assert_allclose(model.tilt(states), model.tilt(expected), atol=1e-6 * C)
    np.testing.assert_allclose(model.tilt_rate(states), model.tilt_rate(expected), atol=1e-5 * C)
    np.testing.assert_array_equal(run.trajectory.resting(tau), other.trajectory.resting(tau))
    if run.log(Log.THREE_DIMENSIONAL) and TraceKind.PLANE_STEP not in run.trajectory.stretches[:, Trace.KIND]:
        azimuth, known = (
            one.trajectory.azimuth(tau, model.tilt(seen)) for one, seen in ((run, states), (other, expected))
        )
        np.testing.assert_array_equal(np.isnan(azimuth), np.isnan(known))  # while it stands
        difference = (azimuth - known)[~np.isnan(known)]
        if np.abs(run.trajectory.stretches[:, len(Trace) : len(Trace) + 2]).min(axis=1).max() == 0.0:
            difference = (difference + np.pi) % (2.0 * np.pi) - np.pi  # from one side to the other, either way round
        np.testing.assert_allclose(difference, 0.0, atol=1e-4)


@pytest.mark.parametrize("make", [sb.Slender, sb.SlenderRolling, sb.Wobbling, sb.Rolling, sb.PlanarRocking])
@pytest.mark.parametrize("seed", [*range(3), *(pytest.param(seed, marks=pytest.mark.slow) for seed in range(3, 6))])
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
    plan = plan_of(model, motion, duration, rtol=RTOL)
    run = Followed.of(plan, one_run(RunStart(tuple(tilt), STILL, duration)), ignored)
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
    batch = Batch.of(plan_of(model, motion, duration, rtol=RTOL), one_run(RunStart(tilt, rate, duration)))
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
    limit = (1.0 - 1e-7) * whole.log(Log.PEAK_TILT)  # reached between the ends of a step
    run, other = followed("spins freely", tilt_limit=limit)[0], referred("spins freely", tilt_limit=limit)
    assert run.status == RunStatus.LIMIT
    assert run.trajectory.end * run.trajectory.model.time_scale == pytest.approx(other.events[-1].time, abs=1e-6)
    assert np.all(np.diff(run.trajectory.starts) > 0.0)
    assert run.trajectory.steps == len(run.trajectory.stretches) < whole.trajectory.steps


@pytest.mark.parametrize("share", [0.0, 0.5, 1.0])
def test_a_run_may_end_at_or_within_an_analytical_step(share):
    model, motion, tilt, rate, _, _ = CASES["analytical step past the vertical"]
    whole = followed("analytical step past the vertical")[0].trajectory
    step = whole.stretches[whole.stretches[:, Trace.KIND] == TraceKind.ANALYTICAL_STEP][0]
    end = step[Trace.START] + share * step[Trace.LENGTH]
    duration = end * model.time_scale
    plan = plan_of(model, motion, duration, rtol=RTOL)
    run = Followed.of(plan, one_run(RunStart(tilt, rate, duration)), ignored)
    assert run.status == RunStatus.STOPPED
    assert run.trajectory.end == pytest.approx(end, rel=1e-14)
    lean, expected = (model.tilt(one.states(np.array([end]))) for one in (run.trajectory, whole))
    np.testing.assert_allclose(lean, expected, atol=1e-6 * C)


def test_a_run_that_ends_where_it_begins_has_a_state():
    model = sb.Slender(COLUMN)
    ended = Followed.of(plan_of(model, CIRCLE), one_run(RunStart((1.4, 0.0), (0.5, 0.0), 1.0)), ignored)
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
    assert "`simulate` computes single runs without compilation" in caplog.text
    # Sums are rounded otherwise in machine code, in the last digits.
    np.testing.assert_allclose(*(run.data["tilt"].values for run in runs), rtol=0.0, atol=1e-13)


# The same for a column that slips: model, motion, tilt, tilt rate, what else it begins with, duration, and its events.
LEANS = (0.3 * C, 0.1 * C)
SHAKEN = sb.Harmonic.oblique(acceleration=14.0, angular_frequency=25.0, angle=1.2)
SLIDING = {
    "slides on its base": (
        *(sb.Sliding(COLUMN, friction_coefficient=0.25), STRONG, STILL, STILL, Turning(), 1.5),
        "slide stop",
    ),
    "turns on its base": (sb.Sliding(COLUMN), BASE_AT_REST, STILL, STILL, Turning(spin=2.0), 1.0, "stop"),
    "slips on its rim": (
        *(sb.Sliding(COLUMN, friction_coefficient=0.2), CIRCLE, (0.5 * C, 0.1 * C), (0.0, 0.1), Turning(), 1.0),
        "slip stick",
    ),
    "strikes its base": (
        sb.Sliding(COLUMN, friction_coefficient=0.4, passage_tilt=0.01 * C),
        *(CIRCLE, LEANS, STILL, Turning(twist=0.3), 1.2, "face_impact stick"),
    ),
    "is thrown": (
        sb.Sliding(COLUMN, friction_coefficient=0.5, normal_restitution=0.2),
        *(CIRCLE, LEANS, STILL, Turning(0.1, 0.2, (0.3, -0.1), (0.2, 0.1, 0.5), 0.02), 0.4),
        "land",
    ),
    "hops": (sb.Sliding(COLUMN, friction_coefficient=0.6), SHAKEN, STILL, STILL, Turning(), 0.35, "lift land"),
    "creeps on a patch": (
        *(sb.Sliding(COLUMN, friction_coefficient=0.3, patch=0.1), CIRCLE, LEANS, (0.0, 0.3), Turning(), 0.5),
        "stick",
    ),
    "rests and is released": (
        *(sb.Sliding(COLUMN, friction_coefficient=0.6), STRONG.delayed(1.5), (0.0, 0.02 * C), STILL, Turning(), 1.9),
        "face_impact rest uplift",
    ),
    "overturns": (sb.Sliding(COLUMN), BASE_AT_REST, (1.2 * C, 0.0), (0.3, 0.1), Turning(), 9.0, "overturned"),
}


@cache
def slid(case):
    model, motion, tilt, rate, turning, duration, _ = SLIDING[case]
    return Followed.of(
        plan_of(model, motion, duration, rtol=RTOL), one_run(RunStart(tilt, rate, duration, turning)), ignored
    )


@pytest.mark.long
@pytest.mark.parametrize("case", SLIDING)
def test_a_run_that_slips_agrees_with_an_independent_integration(case):
    model, motion, tilt, rate, turning, duration, kinds = SLIDING[case]
    run = slid(case)
    other = switched(model, motion, tilt=tilt, tilt_rate=rate, duration=duration, rtol=RTOL, **turning.values())
    assert {event.kind for event in run.events} >= set(kinds.split())
    assert_alike(model, run, other)


@pytest.mark.parametrize("case", SLIDING)
def test_what_is_counted_of_contacts_is_what_the_trace_shows(case):
    run = slid(case)
    kinds = [event.kind for event in run.events]
    told = Contacts.of(run.batch)
    assert told.noted[0, Change.SLIPS] == sum(kind in ("slip", "slide", "reverse") for kind in kinds)
    assert told.noted[0, Change.IMPACTS] == sum(kind in ("land", "face_impact") for kind in kinds)
    trajectory = run.trajectory
    # A short time in which one kind becomes another counts to that.
    analytical = np.flatnonzero(trajectory.stretches[:, Trace.KIND] == TraceKind.ANALYTICAL_STEP)
    contacts, lengths = trajectory.contacts.copy(), trajectory.ends - trajectory.starts
    contacts[analytical] = contacts[analytical + 1]
    for kind, times in zip((k for k in Contact if k is not Contact.JAMMED), told.times.values(), strict=True):
        lasted = lengths[contacts == kind].sum()
        assert times[0] == pytest.approx(lasted, rel=1e-9, abs=1e-12)


def test_a_column_that_rocks_in_a_plane_does_not_travel_round():
    run = slid("rests and is released")
    assert sum(event.kind == "face_impact" for event in run.events) > 10
    assert abs(run.log(Log.LAST_AZIMUTH) - run.log(Log.FIRST_AZIMUTH)) <= 0.5
