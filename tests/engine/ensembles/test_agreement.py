"""Many runs at once are what each run is alone: `simulate` and exact solutions as oracles."""

import math

import numpy as np
import pytest

import stylobate as sb

C, ETA = 0.1, 0.1
MODEL = sb.Slender(sb.Column.dimensionless(C), damping=ETA)
CIRCLE = sb.Harmonic.circular(acceleration=0.1, angular_frequency=2.0)
LINE = sb.Harmonic.straight(acceleration=0.1, angular_frequency=2.0)
ELLIPSE = sb.Harmonic.elliptic(amplitude=(0.1, 0.06), phase=1.0, angular_frequency=2.0)


def rolling_runs(runs_of, nu, a0=0.065):
    """Runs of 200 periods that begin exactly on steady rolling."""
    upper = sb.theory.steady_rolling(nu, a0, c=C, eta=ETA).upper
    lean = np.stack([np.cos(upper.phase), np.sin(upper.phase)], axis=1) * upper.amplitude[:, np.newaxis]
    along = np.stack([-lean[:, 1], lean[:, 0]], axis=1) * nu[:, np.newaxis]
    motion = sb.Harmonic.circular(acceleration=a0, angular_frequency=1.0)
    parameters = {"angular_frequency": nu}
    duration = 200 * 2.0 * math.pi / nu
    return runs_of(MODEL, motion, len(nu), tilt=lean, tilt_rate=along, duration=duration, parameters=parameters)


# Rolling is stable there: errors of single steps, each of rtol at most, do not pile up.
@pytest.mark.parametrize("rtol", [1e-6, 1e-8, 1e-10, 1e-12])
def test_steady_rolling_stays_on_the_exact_solution_to_a_few_tolerances(runs_of, ends_of, rtol):
    nu = np.linspace(3.0, 6.0, 61)
    runs = rolling_runs(runs_of, nu)
    found = ends_of(runs.together(rtol=rtol))
    exact = np.concatenate([runs.tilt, runs.tilt_rate], axis=1)
    size = np.hypot(*runs.tilt.T)[:, np.newaxis] * np.array([1.0, 1.0, 0.0, 0.0])
    size = size + size[:, ::-1] * nu[:, np.newaxis]
    assert np.abs((found - exact) / size).max() < 5.0 * rtol + 6e-12


@pytest.mark.parametrize("rtol", [1e-8, 1e-11])
def test_steady_rolling_ends_where_single_runs_end(runs_of, end_of, ends_of, rtol):
    nu = np.linspace(3.0, 6.0, 3)
    runs = rolling_runs(runs_of, nu)
    data = runs.together(rtol=rtol)
    for index in range(3):
        single = runs.alone(index, rtol=rtol)
        difference = np.abs(ends_of(data)[index] - end_of(single))
        assert np.all(difference < 8.0 * rtol * np.hypot(*runs.tilt[index]) * np.array([1.0, 1.0, nu[index]] * 2)[:4])
        # The same method with the same control of its steps.
        assert int(data["steps"][index]) == pytest.approx(single.measures["steps"], rel=0.05)


def agree(runs, outcome_in, end_of, ends_of):
    """Return how many runs have another outcome alone; check that each of them is a sensitive one, others the same."""
    data = runs.together()
    ends = ends_of(data)
    disagreeing, sensitive = 0, 0
    for index in range(len(runs)):
        single = runs.alone(index)
        if outcome_in(data, index) is not single.outcome:
            disagreeing += 1
            nearby = [
                runs.alone(index, off=off, rtol=rtol).outcome
                for off, rtol in ((1e-9, 1e-8), (-1e-9, 1e-8), (0.0, 1e-7), (0.0, 1e-9), (0.0, 1e-11))
            ]
            assert set(nearby) != {single.outcome}, (index, outcome_in(data, index), single.outcome)
            continue
        time, end = float(data["decided_at"][index]), ends[index]
        if abs(time - single.decided_at) > 1e-7 or np.abs(end - end_of(single)).max() > 1e-7:
            # Then a single run differs as much from one with a finer tolerance, or one begun beside it.
            others = [runs.alone(index, rtol=1e-11), runs.alone(index, off=1e-9)]
            spread = max(abs(other.decided_at - single.decided_at) for other in others)
            spread_of_ends = max(np.abs(end_of(other) - end_of(single)).max() for other in others)
            assert abs(time - single.decided_at) < 50.0 * spread + 1e-7
            assert np.abs(end - end_of(single)).max() < 50.0 * spread_of_ends + 1e-7
            sensitive += 1
        assert bool(data["planar"][index]) is single.planar
        assert bool(data["uncertain"][index]) is single.uncertain
        releases = sum(event.kind == "uplift" for event in single.events)
        assert int(data["uplifts"][index]) == releases
        largest = single.measures["peak_tilt"]
        assert float(data["peak_tilt"][index]) == pytest.approx(largest, rel=1e-4)
    return disagreeing, sensitive


@pytest.mark.parametrize("motion", [CIRCLE, LINE, ELLIPSE], ids=["circle", "line", "ellipse"])
def test_random_runs_have_the_outcomes_that_they_have_alone(mixed_runs, outcome_in, end_of, ends_of, motion):
    runs = mixed_runs(motion, 30, seed=1)
    disagreeing, sensitive = agree(runs, outcome_in, end_of, ends_of)
    assert disagreeing == 0
    assert sensitive < 6


@pytest.mark.slow
@pytest.mark.parametrize("motion", [CIRCLE, LINE, ELLIPSE], ids=["circle", "line", "ellipse"])
def test_of_many_random_runs_only_sensitive_ones_disagree(mixed_runs, outcome_in, end_of, ends_of, motion):
    runs = mixed_runs(motion, 700, seed=2)
    disagreeing, sensitive = agree(runs, outcome_in, end_of, ends_of)
    assert disagreeing <= 0.005 * len(runs)
    assert sensitive < 0.1 * len(runs)


def test_random_runs_show_every_common_outcome(mixed_runs):
    found = set()
    for motion in (CIRCLE, LINE, ELLIPSE):
        found |= set(mixed_runs(motion, 700, seed=2).together()["outcome"].to_numpy().tolist())
    codes = {name: code for code, name in enumerate(outcome.name for outcome in sb.Outcome)}
    assert {codes[name] for name in ("AT_REST", "OVERTURNED", "STILL_MOVING")} <= found


def test_runs_whose_passages_fall_on_looks_do_not_stick_there():
    # On the exact periodic motion passages of the upright fall on half periods, as the looks do, but for rounding.
    nu = np.linspace(3.0, 6.0, 32)
    rate, phase = sb.theory.planar_forced_response(nu, 0.065, c=C, eta=ETA).fast.start()[1:]
    motion = sb.Harmonic.straight(acceleration=0.065, angular_frequency=1.0)
    runs = sb.simulate_ensemble(
        MODEL,
        motion,
        tilt_rate=np.stack([rate, np.zeros_like(rate)], axis=1),
        duration=200.0 * 2.0 * math.pi / nu,
        parameters={"angular_frequency": nu, "start_phase": phase},
        rtol=1e-12,
        max_steps=20_000,
    )
    assert np.all(runs["outcome"] == sb.Outcome.ROCKING)
    ends = np.abs(runs["end_tilt_rate"][:, 0] / rate - 1.0)
    assert ends.max() < 1e-8
