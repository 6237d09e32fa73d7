"""Ensembles of columns that change between kinds of contact: as single runs tell, whatever runs beside them."""

from collections import Counter

import numpy as np
import pytest

import stylobate as sb
from stylobate.engine import ensemble as engine
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
        "normal_restitution": rng.choice([0.0, 0.4], count),
        "damping": rng.choice([0.0, 0.05], count),
        "rolling_resistance": rng.choice([0.0, 0.01], count),
        "incline": rng.choice([0.0, 0.02], count),
    }
    return starts, numbers, rng.uniform(0.02, 0.3, count)


def test_runs_are_those_of_the_single_engine():
    count, duration = 24, 6.0
    starts, numbers, acceleration = random_runs(count, seed=1)
    passage = {"passage_tilt": 1e-2 * COLUMN.slenderness}  # so that the base strikes beside straight paths, too
    model = Sliding(COLUMN, **passage)
    runs = ensemble(model, acceleration=acceleration, parameters=numbers, duration=duration, **starts)
    kinds = Counter()
    for i in range(count):
        run = runs.isel(run=i)
        model = Sliding(COLUMN, **passage, **{name: float(values[i]) for name, values in numbers.items()})
        motion = sb.Harmonic.circular(acceleration=float(acceleration[i]), angular_frequency=3.0)
        start = {name: values[i].tolist() for name, values in starts.items()}
        single = sb.simulate(model, motion, duration=duration, rtol=RTOL, **start, recheck=False)
        events, end = Counter(event.kind for event in single.events), float(run["end_time"])
        last = single.sample(min(end, float(single.data["time"][-1]))).isel(time=0)
        for name in ("tilt", "spin", "twist", "footprint"):
            np.testing.assert_allclose(run[f"end_{name}"], last[name], atol=1e-7, err_msg=name)
        assert run["impacts"] == events["land"] + events["face_impact"]
        assert (run["outcome"] == sb.Outcome.OVERTURNED) == ("overturned" in events)
        kinds += events
    assert {"slip", "stick", "face_impact", "land", "slide", "overturned"} <= set(kinds)


def compared(motion, starts, numbers, duration):
    """Follow runs together and alone; compare their ends, samples and strobes, and return the kinds of events."""
    count, kinds = len(duration), Counter()
    given = {"duration": duration, "rtol": RTOL, "samples": 5, "strobes": 2, "threads": 1}
    runs = sb.simulate_ensemble(Sliding(COLUMN), motion, parameters=numbers, **starts, **given)
    for i in range(count):
        run = runs.isel(run=i)
        model, moved = sb.with_parameters(Sliding(COLUMN), motion, **{k: float(v[i]) for k, v in numbers.items()})
        start = {name: values[i].tolist() for name, values in starts.items()}
        single = sb.simulate(model, moved, duration=float(duration[i]), rtol=RTOL, **start, recheck=False)
        end = float(single.data["time"][-1])
        last = single.sample(min(float(run["end_time"]), end)).isel(time=0)
        for name in ("tilt", "spin", "twist", "footprint"):
            np.testing.assert_allclose(run[f"end_{name}"], last[name], atol=1e-7, err_msg=name)
        period = 2.0 * np.pi / moved.highest_frequency
        strobes = [period * (np.floor(duration[i] / period) - back) for back in (1, 0)]
        for kind, times in (("sample", run["sample_time"].to_numpy()), ("strobe", np.array(strobes))):
            # What begins to slip at once is told at its start as it is the lapse of that later.
            seen = (times > 0.0) & (times <= end)
            told = f"{kind}d_tilt" if kind == "sample" else "strobe_tilt"
            np.testing.assert_allclose(run[told][seen], single.sample(times[seen])["tilt"], atol=1e-7)
            assert np.isnan(run[told][(times < 0.0) | (times > end)]).all()
        kinds += Counter(event.kind for event in single.events)
        for name in TIMES:
            assert float(run[name]) == pytest.approx(single.measures[name], abs=5e-3)
    return set(kinds)


def test_runs_with_a_patch_are_those_of_the_single_engine():
    starts, numbers, acceleration = random_runs(4, seed=5)
    starts["spin"] = np.linspace(-0.4, 0.5, 4)  # of columns that stand too
    numbers |= {"acceleration": acceleration, "patch": np.linspace(0.02, 0.4, 4)}
    assert {"slip", "stick"} & compared(CIRCLE, starts, numbers, np.linspace(2.0, 3.0, 4))


@pytest.mark.slow  # a kernel of its own
def test_runs_on_a_base_that_moves_up_and_down_are_those_of_the_single_engine():
    starts, numbers, acceleration = random_runs(6, seed=6)
    oblique = sb.Harmonic.oblique(acceleration=1.0, angular_frequency=3.0, angle=1.1)
    numbers |= {"acceleration": 2.5 * acceleration, "patch": np.array([0.0, 0.0, 0.1] * 2)}
    assert {"lift", "land"} <= compared(oblique, starts, numbers, np.linspace(3.0, 4.0, 6))


def test_threads_change_nothing(monkeypatch):
    monkeypatch.setattr(engine, "_FEWEST", 4)
    monkeypatch.setattr(engine, "_MOST", 4)
    starts, numbers, acceleration = random_runs(16, seed=7)
    options = {"acceleration": acceleration, "parameters": numbers, "duration": 4.0, "rtol": 1e-8, "samples": 3}
    alone, shared = (ensemble(threads=threads, **options, **starts) for threads in (1, 3))
    for name in alone.data_vars:
        np.testing.assert_array_equal(alone[name], shared[name], err_msg=name)


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


@pytest.mark.slow
def test_without_slip_it_rolls_as_the_rolling_column():
    tilt, rate = [(0.05, 0.0), (0.06, 0.01), (0.03, -0.02)], [(0.0, 0.03), (0.01, 0.05), (-0.02, 0.04)]
    shared = {"tilt": tilt, "tilt_rate": rate, "duration": 8.0, "rtol": RTOL}
    rough = ensemble(Sliding(COLUMN, friction_coefficient=50.0, passage_tilt=1e-9), **shared)
    rolling = sb.simulate_ensemble(sb.Rolling(COLUMN), CIRCLE, **shared, demands=True)  # a kernel of others
    np.testing.assert_array_equal(rough["slips"], 0)
    for name in ("end_tilt", "end_spin", "peak_tilt", "turns"):
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
    assert sb.Outcome(int(run["outcome"][0])) is sb.Outcome.AT_REST


def test_a_base_slides_down_a_plane_as_galileo_tells():
    # Steps are half a period long here, as the times at which the last periods are looked at lie apart.
    frequency, friction, incline = np.linspace(8.0, 20.0, 24), 0.03, 0.2
    duration = 12.0 * 2.0 * np.pi / frequency
    runs = ensemble(
        Sliding(COLUMN, friction_coefficient=friction, incline=incline), acceleration=np.zeros(24), rtol=1e-5,
        parameters={"angular_frequency": frequency}, duration=duration, max_steps=1000, tilt=(0.0, 0.0),
    )  # fmt: skip
    assert (runs["outcome"] == sb.Outcome.SLID).all()
    way = 0.5 * COLUMN.gravity * (np.sin(incline) - friction * np.cos(incline)) * duration**2
    np.testing.assert_allclose(runs["end_footprint"][:, 0], way, rtol=1e-5)


def test_rocking_comes_to_rest_by_strokes_of_its_base():
    run = ensemble(Sliding(COLUMN, friction_coefficient=1.0), acceleration=0.0, tilt=(0.05, 0.0), duration=200.0)
    assert sb.Outcome(int(run["outcome"][0])) is sb.Outcome.AT_REST
    assert int(run["impacts"][0]) > 1
    assert float(run["time_resting"][0]) > 0.0
    assert float(run["end_contact"][0]) == Contact.RESTING


def test_a_limit_of_the_tilt_ends_a_run_there():
    run = ensemble(tilt=(0.05, 0.0), tilt_rate=(0.2, 0.0), duration=5.0, tilt_limit=0.08)
    assert sb.Outcome(int(run["outcome"][0])) is sb.Outcome.LIMIT_REACHED
    assert float(np.hypot(*run["end_tilt"][0])) == pytest.approx(0.08, rel=1e-9)


@pytest.mark.parametrize("asked", [{"demands": True}, {"method": "taylor"}])
def test_what_it_cannot_do_is_told(asked):
    with pytest.raises(UnsupportedError, match="changes between kinds of contact"):
        ensemble(duration=1.0, **asked)


def test_a_slip_that_turns_within_a_step_is_not_stopped():
    friction = np.geomspace(1e-4, 0.03, 40)
    runs, exact = (
        ensemble(acceleration=1.0, parameters={"friction_coefficient": friction}, duration=20.0, rtol=rtol)
        for rtol in (1e-5, RTOL)
    )
    np.testing.assert_allclose(runs["end_footprint"], exact["end_footprint"], atol=1e-3)
    one = sb.simulate(
        Sliding(COLUMN, friction_coefficient=float(friction[20])),
        sb.Harmonic.circular(acceleration=1.0, angular_frequency=3.0),
        duration=20.0,
        rtol=RTOL,
    )
    np.testing.assert_allclose(exact["end_footprint"][20], one.data["footprint"][-1], atol=1e-6)
    np.testing.assert_array_equal(runs["slips"], 0)


def test_without_friction_a_base_slides_as_in_single_runs():
    runs = ensemble(parameters={"friction_coefficient": np.array([0.0, 0.3])}, duration=5.0)
    one = sb.simulate(Sliding(COLUMN, friction_coefficient=0.0), CIRCLE, duration=5.0, rtol=RTOL)
    np.testing.assert_allclose(runs["end_footprint"][0], one.data["footprint"][-1], atol=1e-9)
    assert runs["outcome"].to_numpy().tolist() == [sb.Outcome.SLID, sb.Outcome.AT_REST]
