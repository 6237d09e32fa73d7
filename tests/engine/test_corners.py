"""Laws at the corners of single runs: marginal release, jumps, short ramps, fast rolling, models of one's own."""

import math
import pickle
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import pytest
import xarray as xr

import stylobate as sb
from stylobate import config
from stylobate.base_motions import BaseMotion
from stylobate.errors import ParameterError, UnsupportedError

C = 0.1
MODEL = sb.Slender(sb.Column.dimensionless(C), damping=0.1)


# Time at which the tilt reaches 0.19 rad, for circular motion with ν = 2 that exceeds c by these parts: from an
# integration of (1) by Radau and by DOP853 at two tolerances each, which agree to 1e-10.
@pytest.mark.parametrize(("excess", "expected"), [(1e-6, 10.4158), pytest.param(1e-7, 11.469, marks=pytest.mark.slow)])
def test_a_marginal_release_overturns_at_the_right_time(excess, expected):
    motion = sb.Harmonic.circular(acceleration=C * (1.0 + excess), angular_frequency=2.0)
    run = sb.simulate(MODEL, motion, duration=30.0, tilt_limit=0.19)
    assert run.outcome is sb.Outcome.LIMIT_REACHED
    assert run.decided_at == pytest.approx(expected, abs=2e-3)


def test_a_run_across_a_jump_is_two_runs_joined_at_it():
    late = sb.Harmonic.circular(acceleration=0.05, angular_frequency=3.0).delayed(2.0)
    whole = sb.simulate(MODEL, late, tilt=(0.03, 0.01), tilt_rate=(0.0, 0.05), duration=5.0, rtol=1e-11)
    first = sb.simulate(MODEL, tilt=(0.03, 0.01), tilt_rate=(0.0, 0.05), duration=2.0, rtol=1e-11).data.isel(time=-1)
    then = sb.simulate(
        MODEL, late.motion, tilt=first["tilt"].values, tilt_rate=first["tilt_rate"].values, duration=3.0, rtol=1e-11
    )
    np.testing.assert_allclose(whole.data["tilt"][-1], then.data["tilt"][-1], atol=1e-11)
    # The jump costs no search: each of the three runs takes about as many steps as its length asks for.
    assert whole.measures["steps"] < then.measures["steps"] + 60


def test_a_short_ramp_costs_no_more_than_none():
    steps = []
    for ramp in (0.0, 0.01):
        motion = sb.Harmonic.circular(acceleration=0.065, angular_frequency=1.8, ramp=ramp)
        run = sb.simulate(MODEL, motion, tilt=(0.04, 0.0), tilt_rate=(0.0, 0.07), duration=50.0)
        steps.append(run.measures["steps"])
    assert steps[1] < 1.2 * steps[0] + 20


@pytest.mark.parametrize("nu", [10.0, 40.0])
def test_fast_rolling_is_never_taken_for_rest(nu):
    motion = sb.Harmonic.circular(acceleration=0.5 * C, angular_frequency=nu)
    run = sb.simulate(MODEL, motion, **sb.studies.steady_start(MODEL, motion), duration=25 * motion.period)
    assert run.outcome is sb.Outcome.ROLLING


def test_a_start_on_rolling_is_exact_with_a_phase_on_the_first_axis():
    motion = sb.Harmonic(amplitude=(0.06, 0.06, 0.0), phase=(0.7, 0.7 - math.pi / 2.0, 0.0), angular_frequency=2.0)
    start = sb.studies.steady_start(MODEL, motion)
    run = sb.simulate(MODEL, motion, **start, duration=20.0, rtol=1e-11)
    assert float(np.ptp(run.data["amplitude"].to_numpy())) < 1e-11


def test_measures_do_not_depend_on_the_samples_kept():
    motion = sb.Harmonic.straight(acceleration=0.08, angular_frequency=2.0, direction=0.3)
    start = {"tilt": (0.05, 0.0), "tilt_rate": (0.0, 0.01), "duration": 10.0}
    few, many = (sb.simulate(MODEL, motion, **start, samples=n).measures for n in (2, 3000))
    assert few == many


def test_a_narrow_peak_is_not_stepped_over_while_the_column_moves():
    # Ten oscillations of the base within one free swing of the column.
    motion = sb.Harmonic.straight(acceleration=0.3, angular_frequency=60.0, direction=1.0).delayed(1.0)
    rough, fine = (
        sb.simulate(MODEL, motion, tilt=(0.05, 0.0), duration=2.0, rtol=rtol).data["tilt"][-1] for rtol in (1e-4, 1e-10)
    )
    np.testing.assert_allclose(rough, fine, atol=1e-5)


def test_a_run_goes_through_pickle_with_its_samples():
    run = sb.simulate(MODEL, tilt=(0.05, 0.0), duration=5.0)
    again = pickle.loads(pickle.dumps(run))  # noqa: S301  our own bytes
    xr.testing.assert_identical(again.data, run.data)
    assert (again.outcome, again.measures, again.provenance) == (run.outcome, run.measures, run.provenance)
    with pytest.raises(UnsupportedError):
        again.sample(1.0)


@dataclass(frozen=True, slots=True)
class Dragged(sb.Slender):
    """The slender column with a drag that grows with the square of its speed."""

    drag: float = 20.0


def test_a_subclass_is_not_described_as_its_base():
    run = sb.simulate(Dragged(sb.Column.dimensionless(C)), tilt=(0.05, 0.0), duration=1.0)
    assert run.provenance["model"]["kind"] == "other"
    with pytest.raises(UnsupportedError, match="only the repr is kept"):
        config.config_of(run.provenance)


def _counted_rates(x, y, vx, vy, turned, ax, ay, az, c, eta, _kappa):
    lean = (1.0 + az) * (1.0 - c / math.sqrt(x * x + y * y + 1e-300))
    return vx, vy, lean * x - eta * vx - ax, lean * y - eta * vy - ay, math.hypot(vx, vy)


@dataclass(frozen=True, slots=True)
class Counted(sb.Slender):
    """The slender column with a fifth state, the way its tilt has gone."""

    state_names: ClassVar[tuple[str, ...]] = (*sb.Slender.state_names, "way")
    rates: ClassVar = staticmethod(_counted_rates)

    def start(self, tilt, tilt_rate):
        return (*sb.Slender.start(self, tilt, tilt_rate), 1.0)

    @staticmethod
    def tilt_of(x, y, vx, vy, way, *_):
        return x, y, vx, vy

    @staticmethod
    def at_rest(x, y, vx, vy, way, *_):
        return 0.0, 0.0, 0.0, 0.0, way

    planar_rates: ClassVar = None
    contact: ClassVar = None
    departure: ClassVar = None
    passage: ClassVar = None

    def outputs(self, states, accelerations, resting):
        return {}


@pytest.mark.slow
def test_a_model_with_a_further_state_keeps_it_at_rest():
    model = Counted(sb.Column.dimensionless(C), damping=0.3)
    standing = sb.simulate(model, duration=1.0)
    assert standing.outcome is sb.Outcome.AT_REST
    run = sb.simulate(model, tilt=(0.03, 0.0), tilt_rate=(0.0, 0.02), duration=60.0, rtol=1e-6)
    assert run.outcome is sb.Outcome.AT_REST
    plain = sb.simulate(
        sb.Slender(model.column, damping=0.3), tilt=(0.03, 0.0), tilt_rate=(0.0, 0.02), duration=60.0, rtol=1e-6
    )
    assert run.decided_at == pytest.approx(plain.decided_at, rel=0.02)


class Broken(BaseMotion):
    """A motion that breaks one of its promises."""

    def __init__(self, values, bound=1.0):
        self.values, self.bound = values, bound

    def derivative(self, time, order):
        del order
        return tuple(np.full(np.shape(time), value) for value in self.values)

    def peak_horizontal(self, since=0.0):
        del since
        return self.bound

    def vertical_range(self, since=0.0):
        del since
        return 0.0, 0.0

    def directions(self):
        return ((1.0, 0.0),)


@pytest.mark.parametrize(
    ("motion", "told"),
    [
        (Broken((math.nan, 0.0, 0.0)), "finite acceleration"),
        (Broken((0.5, 0.0)), "three arrays"),
        (Broken((0.5, 0.0, 0.0), bound=0.1), "peak_horizontal must bound"),
    ],
)
def test_a_motion_that_breaks_its_promises_is_told(motion, told):
    with pytest.raises(ParameterError, match=told):
        sb.simulate(MODEL, motion, tilt=(0.03, 0.0), duration=1.0)


def test_degrees_are_refused():
    with pytest.raises(ParameterError, match=r"got 5\.0 rad\. For 5 deg give 0\.08727 rad\."):
        sb.simulate(MODEL, tilt=(5.0, 0.0), duration=1.0)


def test_a_motion_that_repeats_while_it_travels_round_is_not_rocking():
    # The base rises and falls once in two of its horizontal periods: the common period holds two turns of the rim.
    round_about = sb.Harmonic.circular(acceleration=0.065, angular_frequency=3.0)
    up_and_down = sb.Harmonic.vertical(acceleration=0.02, angular_frequency=1.5)
    start = sb.studies.steady_start(MODEL, round_about)
    run = sb.simulate(MODEL, round_about + up_and_down, **start, duration=500.0)
    assert run.measures["repetition"] < sb.OutcomeRules().repeat_tolerance
    assert run.measures["mean_rolling_rate"] == pytest.approx(3.0, rel=1e-6)
    assert run.outcome is not sb.Outcome.ROCKING
