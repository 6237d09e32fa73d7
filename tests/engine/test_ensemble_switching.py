"""Ensembles of columns that change between kinds of contact: as single runs tell, whatever runs beside them."""

from collections import Counter

import numpy as np
import pytest

import stylobate as sb
from stylobate.errors import UnsupportedError
from stylobate.models.sliding import Contact, Sliding

COLUMN = sb.Column.dimensionless(slenderness=0.1)
CIRCLE = sb.Harmonic.circular(acceleration=0.065, angular_frequency=3.0)
RTOL = 1e-10
TIMES = [f"time_{kind.name.lower()}" for kind in Contact if kind is not Contact.JAMMED]


def ensemble(model=None, *, acceleration=0.065, **kwargs):
    """Follow runs of one kernel: all shakers here go round in circles."""
    kwargs = {"rtol": RTOL, "threads": 1} | kwargs
    varied = {"acceleration": acceleration} | kwargs.pop("parameters", {})
    return sb.simulate_ensemble(model or Sliding(COLUMN), CIRCLE, parameters=varied, **kwargs)


def random_runs(count, seed):
    """Return starts, half of the columns standing, and numbers that differ."""
    rng = np.random.default_rng(seed)
    moving = np.where(np.arange(count) % 2, 1.0, 0.0)[:, np.newaxis]
    starts = {
        "tilt": moving * rng.uniform(-0.06, 0.06, (count, 2)),
        "tilt_rate": moving * rng.uniform(-0.06, 0.06, (count, 2)),
        "spin": moving[:, 0] * rng.uniform(-0.5, 0.5, count),
    }
    numbers = {
        "friction_coefficient": rng.choice([0.03, 0.08, 0.15, 0.4, 1.0], count),
        "restitution": rng.choice([0.0, 0.4], count),
        "damping": rng.choice([0.0, 0.05], count),
        "rolling_resistance": rng.choice([0.0, 0.01], count),
        "incline": rng.choice([0.0, 0.02], count),
    }
    return starts, numbers, rng.uniform(0.02, 0.3, count)


def test_runs_are_those_of_the_single_engine():
    count, duration = 24, 6.0
    starts, numbers, acceleration = random_runs(count, seed=1)
    runs = ensemble(acceleration=acceleration, parameters=numbers, duration=duration, **starts)
    kinds = Counter()
    for i in range(count):
        run = runs.isel(run=i)
        model = Sliding(COLUMN, **{name: float(values[i]) for name, values in numbers.items()})
        motion = sb.Harmonic.circular(acceleration=float(acceleration[i]), angular_frequency=3.0)
        start = {name: values[i].tolist() for name, values in starts.items()}
        single = sb.simulate(model, motion, duration=duration, rtol=RTOL, **start)
        events, end = Counter(event.kind for event in single.events), float(run["end_time"])
        last = single.sample(min(end, float(single.data["time"][-1]))).isel(time=0)
        for name in ("tilt", "spin", "twist", "footprint"):
            np.testing.assert_allclose(run[f"end_{name}"], last[name], atol=1e-7, err_msg=name)
        assert run["impacts"] == events["land"] + events["stroke"]
        assert (run["outcome"] == sb.results.code_of(sb.Outcome.OVERTURNED)) == ("overturned" in events)
        kinds += events
    assert {"slip", "stick", "stroke", "land", "slide", "overturned"} <= set(kinds)


def test_kinds_of_contact_last_for_the_whole_run():
    starts, numbers, acceleration = random_runs(16, seed=2)
    runs = ensemble(acceleration=acceleration, parameters=numbers, duration=5.0, rtol=1e-8, **starts)
    lasted = sum(runs[name] for name in TIMES)
    np.testing.assert_allclose(lasted, runs["end_time"], rtol=1e-12)


def test_a_run_does_not_depend_on_its_neighbours():
    starts, numbers, acceleration = random_runs(20, seed=3)
    together = ensemble(acceleration=acceleration, parameters=numbers, duration=5.0, rtol=1e-8, **starts)
    for i in (0, 7, 13):
        chosen = [i]
        alone = ensemble(
            acceleration=acceleration[chosen],
            parameters={name: values[chosen] for name, values in numbers.items()},
            duration=5.0,
            rtol=1e-8,
            **{name: values[chosen] for name, values in starts.items()},
        )
        for name in together.data_vars:
            np.testing.assert_array_equal(alone[name][0], together[name][i], err_msg=name)


def test_without_slip_it_rolls_as_the_rolling_column():
    tilt, rate = [(0.05, 0.0), (0.06, 0.01), (0.03, -0.02)], [(0.0, 0.03), (0.01, 0.05), (-0.02, 0.04)]
    shared = {"tilt": tilt, "tilt_rate": rate, "duration": 8.0, "rtol": RTOL}
    rough = ensemble(Sliding(COLUMN, friction_coefficient=50.0, passage_tilt=1e-9), **shared)
    rolling = sb.simulate_ensemble(sb.Rolling(COLUMN), CIRCLE, **shared)
    np.testing.assert_array_equal(rough["slips"], 0)
    for name in ("end_tilt", "end_spin", "largest_tilt", "turns"):
        np.testing.assert_allclose(rough[name], rolling[name], atol=1e-7, err_msg=name)


def test_a_base_turns_to_a_stop_as_coulomb_tells():
    friction, spin = 0.05, 0.3
    run = ensemble(
        Sliding(COLUMN, friction_coefficient=friction), acceleration=0.0, spin=spin, duration=40.0, tilt=(0.0, 0.0)
    )
    # A base under even pressure turns to a stop under the moment (2/3)μ m g r.
    axial = COLUMN.axial_inertia / (COLUMN.mass * COLUMN.radius)
    stop = spin * axial / (2.0 / 3.0 * friction * COLUMN.gravity)
    assert stop < float(run["end_time"][0])
    assert float(run["time_sliding"][0]) == pytest.approx(stop, rel=1e-8)
    assert float(run["end_twist"][0]) == pytest.approx(0.5 * spin * stop, rel=1e-8)
    assert sb.results.outcome_of(int(run["outcome"][0])) is sb.Outcome.AT_REST


def test_rocking_comes_to_rest_by_strokes_of_its_base():
    run = ensemble(Sliding(COLUMN, friction_coefficient=1.0), acceleration=0.0, tilt=(0.05, 0.0), duration=200.0)
    assert sb.results.outcome_of(int(run["outcome"][0])) is sb.Outcome.AT_REST
    assert int(run["impacts"][0]) > 1
    assert float(run["time_resting"][0]) > 0.0
    assert float(run["end_contact"][0]) == Contact.RESTING


def test_a_limit_of_the_tilt_ends_a_run_there():
    run = ensemble(tilt=(0.05, 0.0), tilt_rate=(0.2, 0.0), duration=5.0, tilt_limit=0.08)
    assert sb.results.outcome_of(int(run["outcome"][0])) is sb.Outcome.LIMIT_REACHED
    assert float(np.hypot(*run["end_tilt"][0])) == pytest.approx(0.08, rel=1e-9)


@pytest.mark.parametrize("asked", [{"demands": True}, {"method": "taylor"}])
def test_what_it_cannot_do_is_told(asked):
    with pytest.raises(UnsupportedError, match="changes between kinds of contact"):
        ensemble(duration=1.0, **asked)
