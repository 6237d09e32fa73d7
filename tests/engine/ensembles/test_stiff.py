"""Runs whose slip is stiff, which lanes follow by implicit steps: as single runs do by SciPy's Radau."""

import numpy as np
import pytest
from tests.engine.sliding_at_random import COLUMN, MOTIONS, random_runs

import stylobate as sb
from stylobate.models.sliding import Contact

# A patch that creeps; half a million explicit steps, cut by stability alone.
CREEP = {
    "tilt": (0.00113, -0.0332),
    "tilt_rate": (-0.0433, 0.0433),
    "duration": 14.0,
    "parameters": {
        "slenderness": 0.172,
        "friction_coefficient": 0.784,
        "static_friction_coefficient": 0.784,
        "patch": 0.157,
        "incline": 0.3,
        "incline_direction": 2.26,
        "acceleration": 0.584,
        "angular_frequency": 0.427,
    },
}
# A base whose slip begins again and again, and follows a load that turns.
BLOCK = {
    "tilt": (0.0, 0.0),
    "duration": 6.0,
    "parameters": {
        "slenderness": 0.5,
        "friction_coefficient": 0.1,
        "acceleration": 1.2,
        "angular_frequency": 2.0,
    },
}
LINE = sb.Harmonic.elliptic(amplitude=(1.0, 0.5), phase=1.0, angular_frequency=1.0)

# Seed and number of random runs that overturn after tens of thousands of explicit steps, and of some that creep in the
# last period before the third number [s]: strong and weak friction, small and large patches, level and inclined planes.
COUNT = 150
OVERTURN = {"ellipse": (2, 33), "oblique": (21, 41), "upright": (21, 44)}
CREEP_LATE = {"ellipse": (2, 29, 5.4), "oblique": (2, 57, 8.6), "upright": (2, 77, 3.0)}

RTOL = 1e-8
# What has grown out of the errors of both by the end: a factor of e^τ, of some units.
CLOSELY = 100.0 * RTOL
# Single runs count the lapse in which slip begins to the kind of contact before it, ensembles to slip.
LAPSES = 5e-3


def together(case, motion=LINE, **options):
    options = {**case, "rtol": RTOL, "threads": 1, **options}
    return sb.simulate_ensemble(sb.Sliding(COLUMN), motion, **options).isel(run=0)


def alone(case, motion=LINE, **options):
    model, motion = sb.with_parameters(sb.Sliding(COLUMN), motion, **case["parameters"])
    start = {name: value for name, value in case.items() if name != "parameters"}
    return sb.simulate(model, motion, **{**start, "rtol": RTOL, "recheck": False, **options})


def random_case(motion, seed, number, duration=12.0 / COLUMN.frequency_scale):
    """Return one of the random runs as a case, and its motion."""
    runs = random_runs(COUNT, seed, MOTIONS[motion])
    starts = {name: values[number].tolist() for name, values in runs.starts.items()}
    numbers = {name: float(values[number]) for name, values in runs.parameters.items()}
    return {**starts, "duration": duration, "parameters": numbers}, runs.motion


def agree(run, single):
    """Check that a run of an ensemble ends as a single one, and was as long in each kind of contact."""
    assert sb.Outcome(int(run["outcome"])) is single.outcome
    end = min(float(run["end_time"]), float(single.data["time"][-1]))
    assert float(run["end_time"]) == pytest.approx(end, rel=CLOSELY)
    last = single.sample(end).isel(time=0)
    for name in ("tilt", "tilt_rate", "spin", "footprint", "twist"):
        np.testing.assert_allclose(run[f"end_{name}"], last[name], atol=CLOSELY, err_msg=name)
    for name in ("peak_tilt", "impacts"):
        assert float(run[name]) == pytest.approx(single.measures[name], abs=CLOSELY), name
    for kind in Contact:
        if kind is not Contact.JAMMED:
            name = f"time_{kind.name.lower()}"
            assert float(run[name]) == pytest.approx(single.measures[name], abs=LAPSES), name


@pytest.mark.parametrize("motion", OVERTURN)
def test_random_columns_that_creep_end_as_by_scipy(motion):
    case, shaken = random_case(motion, *OVERTURN[motion])
    run = together(case, shaken)
    agree(run, alone(case, shaken))
    assert int(run["steps"]) < 2000


@pytest.mark.parametrize("case", [CREEP, BLOCK], ids=["creep", "block"])
def test_creep_and_blocks_that_slide_end_as_by_scipy(case):
    agree(together(case), alone(case))


@pytest.mark.parametrize("motion", CREEP_LATE)
def test_samples_and_last_periods_are_those_of_scipys_trajectory(motion):
    case, shaken = random_case(motion, *CREEP_LATE[motion])
    options = {"rtol": 1e-10, "rules": sb.OutcomeRules(periods=1)}
    run, single = together(case, shaken, samples=9, **options), alone(case, shaken, **options)
    assert sb.Outcome(int(run["outcome"])) is single.outcome
    end = float(single.data["time"][-1])
    sampled = single.sample(np.minimum(run["sample_time"], end))
    # A start that slips at once is told at its time as it is the lapse of that later.
    np.testing.assert_allclose(run["sampled_tilt"][1:], sampled["tilt"][1:], atol=CLOSELY)
    period = 2.0 * np.pi / case["parameters"]["angular_frequency"]
    tilt = np.hypot(*single.sample(np.linspace(end - period, end, 20001))["tilt"].to_numpy().T)
    mean = (tilt[1:] + tilt[:-1]).mean() / 2.0
    # Integrated by cubics through the ends of each step, which need the finer tolerance for that.
    assert float(run["mean_tilt"]) == pytest.approx(mean, rel=1e-6)


def test_results_converge_with_the_tolerance():
    names = ("decided_at", "end_footprint", "end_twist")
    exact = together(CREEP, rtol=1e-12)
    errors = []
    for rtol in (1e-5, 1e-7, 1e-9):
        run = together(CREEP, rtol=rtol)
        errors.append(max(float(np.abs(run[name] - exact[name]).max()) for name in names))
        assert errors[-1] < rtol
    assert errors[2] < 1e-2 * errors[0]


def test_runs_beside_it_change_nothing():
    runs = random_runs(COUNT, 21, MOTIONS["upright"])
    number = OVERTURN["upright"][1]
    single, among = (runs.part(part).together(threads=1) for part in ([number], [*range(number - 5, number + 6)]))
    for name in single.data_vars:
        np.testing.assert_array_equal(single[name][0], among[name][5], err_msg=name)


def test_implicit_steps_count_among_the_most_that_are_allowed():
    whole = int(together(CREEP)["steps"])
    cut = together(CREEP, max_steps=whole - 50)
    assert (sb.Outcome(int(cut["outcome"])), int(cut["steps"])) == (sb.Outcome.FAILED, whole - 50)


def test_the_tilt_limit_ends_a_run_that_creeps():
    limit = 0.1
    run, single = together(CREEP, tilt_limit=limit), alone(CREEP, tilt_limit=limit)
    assert sb.Outcome(int(run["outcome"])) is single.outcome is sb.Outcome.LIMIT_REACHED
    assert float(np.hypot(*run["end_tilt"])) == pytest.approx(limit, rel=1e-12)
    assert float(run["end_time"]) == pytest.approx(single.decided_at, rel=CLOSELY)


def test_a_record_of_many_pieces_is_followed_by_implicit_steps_too():
    column = sb.Column.solid(radius=0.5, height=3.0, density=2700.0)
    model, motion = sb.Sliding(column, 0.1), sb.sample_record().scaled(3.0)
    given = {"tilt": (0.0, 0.0), "duration": 2.5, "rtol": RTOL}
    run = sb.simulate_ensemble(model, motion, **given, threads=1).isel(run=0)
    single = sb.simulate(model, motion, **given, recheck=False)
    assert single.measures["slips"] == 2.0
    agree(run, single)
