"""Runs that lanes give up because they are stiff: followed alone they are told as lanes tell them."""

import numpy as np
import pytest

import stylobate as sb
from stylobate.engine import ensemble
from stylobate.engine.ensembles.batch import Batch
from stylobate.engine.lanes.columns import LOG, Log, Status
from stylobate.errors import Interrupted
from stylobate.models.sliding import Contact, Sliding

COLUMN = sb.Column.dimensionless(slenderness=0.1)
CIRCLE = sb.Harmonic.circular(acceleration=0.065, angular_frequency=3.0)
RTOL = 1e-10

# Lanes and single runs agree to the tolerance of their states, which errors as fast as the column falls leave, e^τ of
# some units; extremes within a step are told by cubics there, and so is what turns with the forcing.
EXACT = ("outcome", "uncertain", "planar", "end_contact", "impacts", "slips", "releases", "sample_time")
ROUGHLY = {"least_tilt": 1e-6, "time_of_largest_tilt": 1e-5, "mean_tilt": 1e-6, "phase": 2e-3, "repetition": 1e-5}
CLOSELY = 1e-6


def random_runs(count, seed):
    """Return options of runs, half of the columns standing and turning."""
    rng = np.random.default_rng(seed)
    leans = np.where(np.arange(count) % 2, 1.0, 0.0)[:, np.newaxis]
    return {
        "tilt": leans * rng.uniform(-0.06, 0.06, (count, 2)),
        "tilt_rate": leans * rng.uniform(-0.06, 0.06, (count, 2)),
        "spin": rng.uniform(-0.5, 0.5, count),
        "parameters": {
            "friction_coefficient": rng.choice([0.03, 0.08, 0.15, 0.4, 1.0], count),
            "normal_restitution": rng.choice([0.0, 0.4], count),
            "damping": rng.choice([0.0, 0.05], count),
            "incline": rng.choice([0.0, 0.02], count),
            "acceleration": rng.uniform(0.02, 0.3, count),
        },
        "duration": 10.0,
        "rtol": RTOL,
        "samples": 5,
        "strobes": 6,
        "rules": sb.OutcomeRules(periods=2),
        "threads": 1,
    }


@pytest.fixture
def given_up(monkeypatch):
    """Let lanes give up all runs."""

    def advance(batch, halt):
        del halt
        batch.table[:, LOG + Log.STATUS] = Status.STIFF
        return True

    return lambda: monkeypatch.setattr(Batch, "advance", advance)


def test_they_are_told_as_lanes_tell_them(given_up):
    given = random_runs(6, seed=4)
    lanes = sb.simulate_ensemble(Sliding(COLUMN), CIRCLE, **given)
    given_up()
    alone = sb.simulate_ensemble(Sliding(COLUMN), CIRCLE, **given)
    assert set(lanes.data_vars) == set(alone.data_vars)
    for name in set(lanes.data_vars) - {"steps"}:
        atol = 0.0 if name in EXACT else ROUGHLY.get(name, CLOSELY)
        np.testing.assert_allclose(alone[name], lanes[name], rtol=1e-12, atol=atol, err_msg=name)
    # All kinds of contact were met, and all that is told was told of some run.
    told = {sb.Outcome(code) for code in lanes["outcome"].values}
    assert told >= {sb.Outcome.OVERTURNED, sb.Outcome.SLID, sb.Outcome.AT_REST}
    assert all(np.isfinite(lanes[name]).any() for name in lanes.data_vars)
    assert all(float(lanes[f"time_{kind.name.lower()}"].max()) > 0.0 for kind in Contact if kind is not Contact.JAMMED)


STIFF = {
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


@pytest.mark.parametrize("alone", [False, True])
def test_a_patch_that_creeps_is_followed_to_the_end(alone, given_up):
    if alone:
        given_up()
    column = sb.Column.solid(radius=1.0, height=20.0, density=1000.0)
    line = sb.Harmonic.elliptic(amplitude=(1.0, 0.5), phase=1.0, angular_frequency=1.0)
    run = sb.simulate_ensemble(Sliding(column), line, **STIFF, rtol=1e-7, threads=1).isel(run=0)
    model, motion = sb.with_parameters(Sliding(column), line, **STIFF["parameters"])
    start = {name: STIFF[name] for name in ("tilt", "tilt_rate", "duration")}
    single = sb.simulate(model, motion, **start, rtol=1e-7, recheck=False)
    assert sb.Outcome(int(run["outcome"])) is single.outcome is sb.Outcome.OVERTURNED
    if alone:  # the same integrator made the same steps
        assert float(run["steps"]) == single.measures["steps"]
        assert float(run["decided_at"]) == single.decided_at
        np.testing.assert_array_equal(run["end_tilt"], single.data["tilt"][-1])
    else:  # steps that stability cuts do not count among the most that are allowed
        assert float(run["steps"]) > 100.0 * single.measures["steps"]
        assert float(run["decided_at"]) == pytest.approx(single.decided_at, rel=1e-5)


def test_what_is_stopped_is_not_told(given_up, monkeypatch):
    class Halt:
        looks = 0

        def __getitem__(self, place):
            self.looks += 1
            return self.looks > 20

    def stopped(parts, compute, threads, done):
        del threads, done
        compute(parts[0], Halt())
        return False

    given_up()
    monkeypatch.setattr(ensemble, "run_parts", stopped)
    with pytest.raises(Interrupted) as caught:
        sb.simulate_ensemble(Sliding(COLUMN), CIRCLE, **random_runs(4, seed=3))
    partial = caught.value.partial
    told = partial["outcome"].to_numpy() != -1
    # It is stopped in the second run: the first one takes fewer steps than that.
    assert told.tolist() == [True, False, False, False]
    np.testing.assert_array_equal(np.isnan(partial["end_time"]), ~told)
