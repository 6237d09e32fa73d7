"""The base of a sliding column strikes only on straight paths: no threshold of passages decides an outcome."""

import numpy as np
import pytest

import stylobate as sb

COLUMN = sb.Column.solid(radius=0.4, height=4.0, density=2500.0)
C = COLUMN.slenderness
FRICTION = {"friction_coefficient": 0.5, "damping": 0.02}
ELLIPSE = sb.Harmonic.elliptic(amplitude=(1.6, 0.8), phase=0.5 * np.pi, angular_frequency=5.0)
OVERTURNED = int(sb.Outcome.OVERTURNED)


def starts(count):
    rng = np.random.default_rng(7)
    tilt = C * rng.uniform(-0.5, 0.5, (count, 2))
    return tilt, C * COLUMN.frequency_scale * rng.uniform(-0.5, 0.5, (count, 2))


def runs(count, motion=ELLIPSE, duration=20.0, *, recheck=False, **numbers):
    tilt, rate = starts(count)
    model = sb.Sliding(COLUMN, **FRICTION, **numbers)
    return sb.simulate_ensemble(model, motion, tilt=tilt, tilt_rate=rate, duration=duration, recheck=recheck)


def outcomes(count, motion=ELLIPSE, duration=20.0, **numbers):
    return runs(count, motion, duration, **numbers)["outcome"].values


def test_a_wider_passage_decides_no_outcome_far_below_the_size_of_passages():
    usual = outcomes(60)
    assert 10 < np.sum(usual == OVERTURNED) < 50
    for share in (1e-8, 1e-6, 1e-4):
        np.testing.assert_array_equal(outcomes(60, passage_tilt=share * C), usual)


def test_rechecked_runs_whose_outcome_depends_on_the_passage_tilt_are_uncertain():
    wide, half = runs(300, recheck=True, passage_tilt=0.5 * C), outcomes(300, passage_tilt=0.25 * C)
    changed = (wide["outcome"].values == OVERTURNED) != (half == OVERTURNED)
    assert changed.sum() > 10
    assert wide["uncertain"].values[changed].all()


def test_a_single_run_states_the_passage_tilt_and_the_other_outcome():
    wide, half = (outcomes(60, passage_tilt=share * C) for share in (0.5, 0.25))
    changed = int(np.flatnonzero((wide == OVERTURNED) != (half == OVERTURNED))[0])
    tilt, rate = starts(60)
    model = sb.Sliding(COLUMN, **FRICTION, passage_tilt=0.5 * C)
    run = sb.simulate(model, ELLIPSE, tilt=tilt[changed].tolist(), tilt_rate=rate[changed].tolist(), duration=20.0)
    assert run.thresholds["passage_tilt"] == pytest.approx(0.5 * C)
    assert run.uncertain
    assert f"with passage_tilt {0.25 * C:.2g}" in " ".join(run.warnings)
    assert sb.simulate(sb.Sliding(COLUMN), duration=1.0).thresholds["passage_tilt"] == pytest.approx(1e-9 * C)


@pytest.mark.parametrize("across", [1e-7, 1e-5, 1e-3])
def test_only_a_straight_path_strikes(across):
    model = sb.Sliding(COLUMN, friction_coefficient=2.0, damping=0.02)
    straight = sb.simulate(model, tilt=(0.03, 0.0), duration=8.0)
    beside = sb.simulate(model, tilt=(0.03, 0.0), tilt_rate=(0.0, across), duration=8.0)
    assert any(event.kind == "face_impact" for event in straight.events)
    assert not any(event.kind == "face_impact" for event in beside.events)


def test_a_path_that_passes_the_vertical_ever_closer_tends_to_the_motion_without_impact():
    # Without impacts and slip the column rolls as `Rolling`: also at passages far closer than the passage tilt of old.
    sliding = sb.Sliding(COLUMN, friction_coefficient=50.0, damping=0.02)
    rolling = sb.Rolling(COLUMN, damping=0.02)
    for across in (1e-5, 1e-4):
        given = {"tilt": (0.03, 0.0), "tilt_rate": (0.0, across), "duration": 6.0, "rtol": 1e-11}
        ends = [sb.simulate(model, **given).data["tilt"].values[-1] for model in (sliding, rolling)]
        np.testing.assert_allclose(ends[0], ends[1], atol=1e-7 * C)


@pytest.mark.slow
@pytest.mark.parametrize("motion", ["ellipse", "el centro"])
def test_600_starts_keep_their_outcomes_with_wider_passages(motion):
    given = (ELLIPSE, 20.0) if motion == "ellipse" else (sb.sample_record("el centro 1940").scaled(0.6), 35.0)
    usual = outcomes(600, *given)
    assert 100 < np.sum(usual == OVERTURNED) < 500
    assert not np.any(usual == int(sb.Outcome.FAILED))
    for share in (2e-9, 1e-6, 1e-4):
        np.testing.assert_array_equal(outcomes(600, *given, passage_tilt=share * C), usual)
