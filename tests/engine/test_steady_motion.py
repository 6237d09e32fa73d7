"""The outcome of a steady motion does not depend on the duration of the run, nor on how it was computed."""

import math
import re
from typing import NamedTuple

import numpy as np
import pytest

import stylobate as sb
from stylobate.engine.kernel.columns import PAIRS, pair_begins

C = ETA = 0.1
MODEL = sb.Slender(sb.Column.dimensionless(C), damping=ETA)
DURATIONS = 40
Outcome = sb.Outcome


class Motion(NamedTuple):
    """A motion that has settled after `settled` periods of the base motion."""

    shaking: sb.Harmonic
    tilt: tuple[float, float]
    tilt_rate: tuple[float, float]
    outcome: Outcome
    settled: float
    longest: float = 650.0
    repeats_after: int = 0


def circle(acceleration, nu):
    return sb.Harmonic.circular(acceleration=acceleration, angular_frequency=nu)


def line(acceleration, nu):
    return sb.Harmonic.straight(acceleration=acceleration, angular_frequency=nu)


def beside_rolling(nu, off):
    """Return base motion, tilt and rate beside steady rolling on the upper branch (8)."""
    start = sb.studies.steady_start(MODEL, circle(0.065, nu))
    tilt = tuple(off * np.array(start["tilt"]))
    return circle(0.065, nu), tilt, start["tilt_rate"]


MOTIONS = {
    "at rest": Motion(circle(0.0487, 1.0075), (-0.0183, 0.0057), (-0.0017, -0.0055), Outcome.AT_REST, 60.0),
    "steady rolling": Motion(*beside_rolling(1.8, 1.0), Outcome.ROLLING, 12.0, repeats_after=1),
    "rolling, from nearby": Motion(*beside_rolling(1.8, 1.01), Outcome.ROLLING, 150.0, repeats_after=1),
    "modulated, 1.37": Motion(*beside_rolling(1.37, 1.01), Outcome.MODULATED, 130.0),
    "modulated, 1.36": Motion(*beside_rolling(1.36, 1.01), Outcome.MODULATED, 130.0),
    "modulated, 1.35": Motion(*beside_rolling(1.35, 1.01), Outcome.MODULATED, 130.0),
    "rocking": Motion(
        line(0.0589, 1.1271), (-0.0126, 0.0134), (-0.0045, -0.0043), Outcome.ROCKING, 100.0, repeats_after=1
    ),
    "two periods": Motion(
        line(0.2169, 3.7459), (0.0115, 0.0013), (0.005, -0.0432), Outcome.PERIODIC, 250.0, repeats_after=2
    ),
    "three periods": Motion(
        line(0.2188, 5.4884), (-0.00525, -0.0006), (0.001, -0.0086), Outcome.PERIODIC, 400.0, repeats_after=3
    ),
    "aperiodic, circle": Motion(
        circle(0.1143, 5.4586), (0.0028, -0.0024), (-0.0133, -0.0154), Outcome.APERIODIC, 130.0
    ),
    "aperiodic, line": Motion(line(0.1858, 4.6424), (-0.0076, 0.0014), (-0.002, -0.0106), Outcome.APERIODIC, 130.0),
    "transient": Motion(*beside_rolling(1.5, 1.1), Outcome.STILL_MOVING, 11.0, 60.0),
}


def durations(motion, count=DURATIONS):
    return np.linspace(motion.settled, motion.longest, count) * motion.shaking.period


def ensemble(motion, count=DURATIONS, **options):
    return sb.simulate_ensemble(
        MODEL,
        motion.shaking,
        tilt=motion.tilt,
        tilt_rate=motion.tilt_rate,
        duration=durations(motion, count),
        **options,
    )


def names(codes):
    return {Outcome(int(code)).name for code in np.ravel(codes)}


@pytest.mark.parametrize("name", MOTIONS)
def test_the_outcome_is_the_same_at_any_duration(name):
    motion = MOTIONS[name]
    found = ensemble(motion)
    assert names(found["outcome"]) == {motion.outcome.name}
    assert set(found["repeats_after"].values.tolist()) == {motion.repeats_after}


@pytest.mark.parametrize("name", MOTIONS)
def test_a_single_run_has_the_outcome_of_the_ensemble(name):
    motion = MOTIONS[name]
    longest = ensemble(motion, 2).isel(run=-1)
    run = sb.simulate(
        MODEL, motion.shaking, tilt=motion.tilt, tilt_rate=motion.tilt_rate, duration=float(durations(motion, 2)[-1])
    )
    assert run.outcome == int(longest["outcome"])
    if motion.outcome is not Outcome.AT_REST:
        assert run.measures["repetition"] == float(longest["repetition"])
        assert run.measures["repeats_after"] == motion.repeats_after


@pytest.mark.parametrize("nu", [1.37, 1.36, 1.35])
def test_settled_modulated_rolling_is_modulated_at_41_durations(nu):
    shaking, tilt, rate = beside_rolling(nu, 1.01)
    found = sb.simulate_ensemble(MODEL, shaking, tilt=tilt, tilt_rate=rate, duration=np.linspace(600.0, 3000.0, 41))
    assert names(found["outcome"]) == {"MODULATED"}


@pytest.mark.parametrize("nu", [1.4, 1.43, 1.5, 1.8, 3.0])
def test_a_transient_towards_rolling_is_never_another_motion(nu):
    # Just above the critical frequency 1.397 a transient of the kind of the modulated motion decays slowly.
    shaking, tilt, rate = beside_rolling(nu, 1.05)
    periods = np.arange(12.0, 400.0, 4.0)
    found = sb.simulate_ensemble(MODEL, shaking, tilt=tilt, tilt_rate=rate, duration=periods * shaking.period)
    codes = found["outcome"].values
    rolls = codes == Outcome.ROLLING
    assert names(codes) == {"STILL_MOVING", "ROLLING"}
    assert not np.any(np.diff(rolls.astype(int)) < 0)


@pytest.mark.parametrize(("nu", "periods"), [(1.5, 30), (1.8, 60), (3.0, 60), (3.0, 90)])
def test_the_durations_in_the_reasons_lead_to_the_end_of_a_transient(nu, periods):
    # The first may be that of a motion which does not repeat; the next ones are estimated from the decay.
    shaking, tilt, rate = beside_rolling(nu, 1.05)
    duration, runs = periods * shaking.period, []
    while len(runs) < 4 and (not runs or runs[-1].outcome is not Outcome.ROLLING):
        runs.append(sb.simulate(MODEL, shaking, tilt=tilt, tilt_rate=rate, duration=duration))
        needed = re.search(r"set duration to at least ([\d.]+) s$", runs[-1].reason)
        duration = float(needed[1]) if needed else duration
    assert [run.outcome for run in runs[:-1]] == [Outcome.STILL_MOVING] * (len(runs) - 1)
    assert runs[-1].outcome is Outcome.ROLLING
    assert len(runs) > 1
    shorter = sb.simulate(MODEL, shaking, tilt=tilt, tilt_rate=rate, duration=0.5 * duration)
    assert duration == pytest.approx(100.0 * shaking.period, rel=1e-3) or shorter.outcome is Outcome.STILL_MOVING


@pytest.mark.parametrize("name", ["modulated, 1.36", "aperiodic, line"])
def test_a_short_run_states_the_periods_that_show_a_motion_without_repetition(name):
    motion = MOTIONS[name]
    start = {"tilt": motion.tilt, "tilt_rate": motion.tilt_rate}
    run = sb.simulate(MODEL, motion.shaking, **start, duration=45.0 * motion.shaking.period)
    assert run.outcome is Outcome.STILL_MOVING
    needed = float(re.search(r"set duration to at least ([\d.]+) s$", run.reason)[1])
    assert needed == pytest.approx(100.0 * motion.shaking.period, rel=1e-3)


@pytest.mark.parametrize("method", ["dop853", "taylor"])
def test_the_outcome_does_not_depend_on_the_method(method):
    for name in ("modulated, 1.36", "two periods", "aperiodic, circle"):
        found = ensemble(MOTIONS[name], 5, method=method)
        assert names(found["outcome"]) == {MOTIONS[name].outcome.name}


@pytest.mark.parametrize("spacing", [4.0, 14.38, 300.0])
def test_pairs_follow_each_other_and_are_in_step_with_no_period(spacing):
    begins = pair_begins(np.arange(PAIRS), spacing)
    assert np.all(np.diff(begins) <= -1.0 + 1e-12)
    assert begins[-1] >= 1.0
    # The mean of a phase that turns steadily: 1/√16 for random places, and 1 for equal places in step with it, such as
    # 14 turns of modulated rolling in 14.38 periods.
    for turns in (0.973, 1.0, 0.75, 0.5, 0.618):
        assert abs(np.mean(np.exp(2j * np.pi * turns * begins))) < 0.7


def test_maps_have_the_outcomes_of_single_runs():
    axes = {
        "angular_frequency": np.array([1.36, 3.0, 4.6424, 5.4586]),
        "acceleration": np.array([0.065, 0.1143, 0.1858]),
    }
    start = {"tilt": (0.0028, -0.0024), "tilt_rate": (-0.0133, -0.0154)}
    found = sb.studies.overturning_map(MODEL, circle(0.1, 2.0), over=axes, periods=130.0, **start)
    for nu in axes["angular_frequency"]:
        for acceleration in axes["acceleration"]:
            shaking = circle(float(acceleration), float(nu))
            run = sb.simulate(MODEL, shaking, **start, duration=130.0 * shaking.period)
            assert run.outcome == int(found["outcome"].sel(angular_frequency=nu, acceleration=acceleration))


def test_basins_have_the_outcomes_of_single_runs():
    shaking, periods = line(0.1858, 4.6424), 300.0
    axes = {"tilt_x": np.linspace(-0.02, 0.02, 4), "tilt_rate_y": np.linspace(-0.02, 0.02, 3)}
    found = sb.studies.basins(MODEL, shaking, over=axes, tilt=(0.0, 0.001), periods=periods)
    kinds = found["attractor_kind"].values
    stands_for = {Outcome.ROLLING: "rolling", Outcome.ROCKING: "rocking", Outcome.APERIODIC: "aperiodic"}
    for x in axes["tilt_x"]:
        for rate in axes["tilt_rate_y"]:
            run = sb.simulate(MODEL, shaking, tilt=(x, 0.001), tilt_rate=(0.0, rate), duration=periods * shaking.period)
            kind = str(kinds[int(found["attractor"].sel(tilt_x=x, tilt_rate_y=rate))])
            assert kind.startswith(stands_for.get(run.outcome, run.outcome.label))


def test_planar_rocking_is_rocking_at_any_duration():
    shaking = line(0.13, 3.0)
    found = sb.simulate_ensemble(
        MODEL,
        shaking,
        tilt=(0.01, 0.0),
        tilt_rate=(0.0, 0.0),
        duration=np.linspace(150.0, 600.0, DURATIONS) * 2.0 * math.pi / 3.0,
    )
    assert bool(found["planar"].all())
    assert names(found["outcome"]) == {"ROCKING"}
