"""Steps by Taylor series follow the runs that DOP853 follows: exact solutions, the other method and single runs."""

import math
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
import pytest

import stylobate as sb
from stylobate.base_motions import BaseMotion
from stylobate.engine import ensemble
from stylobate.errors import ParameterError, UnsupportedError

pytestmark = pytest.mark.long

C, ETA = 0.1, 0.1
COLUMN = sb.Column.dimensionless(C)
MODEL = sb.Slender(COLUMN, damping=ETA)
CIRCLE = sb.Harmonic.circular(acceleration=0.1, angular_frequency=2.0)
LINE = sb.Harmonic.straight(acceleration=0.1, angular_frequency=2.0)
ELLIPSE = sb.Harmonic.elliptic(amplitude=(0.1, 0.06), phase=1.0, angular_frequency=2.0)
KINDS = {"circle": CIRCLE, "line": LINE, "ellipse": ELLIPSE}


def rolling_runs(runs_of, nu, a0=0.065, **options):
    """Runs of 200 periods that begin exactly on steady rolling."""
    upper = sb.theory.steady_rolling(nu, a0, c=C, eta=ETA).upper
    lean = np.stack([np.cos(upper.phase), np.sin(upper.phase)], axis=1) * upper.amplitude[:, np.newaxis]
    along = np.stack([-lean[:, 1], lean[:, 0]], axis=1) * nu[:, np.newaxis]
    motion = sb.Harmonic.circular(acceleration=a0, angular_frequency=1.0)
    parameters = {"angular_frequency": nu}
    duration = 200 * 2.0 * math.pi / nu
    count = len(nu)
    return runs_of(
        MODEL, motion, count, tilt=lean, tilt_rate=along, duration=duration, parameters=parameters, **options
    )


# Rolling is stable there: errors of single steps, each of rtol at most, do not pile up.
@pytest.mark.parametrize("rtol", [1e-6, 1e-8, 1e-10, 1e-12])
def test_steady_rolling_stays_on_the_exact_solution_to_the_tolerance(runs_of, ends_of, rtol):
    nu = np.linspace(3.0, 6.0, 61)
    runs = rolling_runs(runs_of, nu, method="taylor", rtol=rtol)
    found = ends_of(runs.together())
    exact = np.concatenate([runs.tilt, runs.tilt_rate], axis=1)
    size = np.hypot(*runs.tilt.T)[:, np.newaxis] * np.array([1.0, 1.0, 0.0, 0.0])
    size = size + size[:, ::-1] * nu[:, np.newaxis]
    assert np.abs((found - exact) / size).max() < rtol + 6e-12


@pytest.mark.parametrize(("rtol", "share"), [(1e-8, 0.5), (1e-12, 0.25)])
def test_steady_rolling_takes_few_steps(runs_of, rtol, share):
    runs = rolling_runs(runs_of, np.linspace(3.0, 6.0, 7), rtol=rtol)
    fewer, more = (runs.together(method=method)["steps"].to_numpy() for method in ("taylor", "dop853"))
    assert np.all(fewer < share * more)


def test_steady_rolling_has_the_mean_tilt_phase_and_rate_of_theory(runs_of):
    nu = np.linspace(2.5, 5.0, 7)
    data = rolling_runs(runs_of, nu, method="taylor", rtol=1e-10, strobes=3).together()
    upper = sb.theory.steady_rolling(nu, 0.065, c=C, eta=ETA).upper
    assert set(data["outcome"].to_numpy()) == {sb.Outcome.ROLLING}
    np.testing.assert_allclose(data["mean_tilt"], upper.amplitude, rtol=1e-9)
    np.testing.assert_allclose(data["peak_tilt"], upper.amplitude, rtol=1e-9)
    np.testing.assert_allclose(data["phase"], upper.phase, atol=1e-9)
    np.testing.assert_allclose(data["mean_rolling_rate"], nu, rtol=1e-9)
    np.testing.assert_allclose(data["turns"], 200.0, rtol=1e-9)
    assert float(data["repetition"].max()) < 1e-9


# Runs of all kinds: those of the other method.


def spread(runs, ends_of, data, method):
    """Return how far runs by one method lie from runs begun beside them or made with a finer tolerance."""
    off = [replace(runs, tilt=runs.tilt * (1.0 + part)) for part in (1e-9, -1e-9)]
    others = [*(one.together(method=method) for one in off), runs.together(method=method, rtol=1e-9)]
    others.append(runs.together(method=method, rtol=1e-7))
    changed = np.any([other["outcome"].to_numpy() != data["outcome"].to_numpy() for other in others], axis=0)
    ends = np.max([np.abs(ends_of(other) - ends_of(data)).max(axis=1) for other in others], axis=0)
    times = np.max([abs(other["decided_at"] - data["decided_at"]).to_numpy() for other in others], axis=0)
    return changed, ends, times


@pytest.mark.parametrize("kind", KINDS)
def test_random_runs_differ_from_those_of_the_other_method_no_more_than_from_their_neighbours(
    mixed_runs, ends_of, kind
):
    runs = mixed_runs(KINDS[kind], 700, seed=2)
    data, usual = runs.together(method="taylor"), runs.together(method="dop853")
    changed, ends, times = (
        np.max(pair, axis=0)
        for pair in zip(spread(runs, ends_of, data, "taylor"), spread(runs, ends_of, usual, "dop853"), strict=True)
    )
    same = data["outcome"].to_numpy() == usual["outcome"].to_numpy()
    assert np.all(same | changed)
    assert same.mean() > 0.99
    assert np.all(np.abs(ends_of(data) - ends_of(usual)).max(axis=1)[same] <= (10.0 * ends + 1e-8)[same])
    assert np.all(abs(data["decided_at"] - usual["decided_at"]).to_numpy()[same] <= (10.0 * times + 1e-8)[same])
    calm = ~changed & (ends < 1e-6) & (times < 1e-6)
    assert calm.mean() > 0.7
    for name in ("planar", "uncertain", "uplifts"):
        np.testing.assert_array_equal(data[name][calm], usual[name][calm], err_msg=name)
    # Measured on cubics and quintics by the other method; at a peak the tilt changes with the square of the time.
    for name, allowed in (("peak_tilt", 1e-6), ("minimum_tilt", 1e-4), ("time_of_peak_tilt", 1e-4)):
        np.testing.assert_allclose(data[name][calm], usual[name][calm], rtol=0.0, atol=allowed, err_msg=name)


# Those in a plane are made by the same steps: linear equations between events.
def test_runs_in_a_plane_are_those_of_the_other_method_to_the_last_bit(mixed_runs):
    runs = mixed_runs(LINE, 100, seed=4, samples=5, strobes=2)
    runs = replace(runs, tilt=0.0 * runs.tilt, tilt_rate=0.0 * runs.tilt_rate)
    data, usual = (runs.together(method=method) for method in ("taylor", "dop853"))
    assert bool(data["planar"].all())
    assert int(data["uplifts"].max()) > 0
    assert data.drop_attrs(deep=False).identical(usual.drop_attrs(deep=False))


@pytest.mark.parametrize("kind", KINDS)
def test_random_runs_end_as_they_do_alone(mixed_runs, outcome_in, end_of, ends_of, kind):
    runs = mixed_runs(KINDS[kind], 12, seed=1, method="taylor", rtol=1e-10)
    data = runs.together()
    alone = replace(runs, options={"rtol": 1e-10})
    near = 0
    for index in range(len(runs)):
        single = alone.alone(index)
        assert outcome_in(data, index) is single.outcome
        near += bool(np.abs(ends_of(data)[index] - end_of(single)).max() < 1e-7)
    assert near >= 10


# Base motions of every kind: single runs.

STONE = sb.Slender(sb.Column.solid(radius=0.5, height=10.0, density=2700.0), damping=0.1)
ONE = sb.Harmonic.elliptic(amplitude=(0.6, 0.3), phase=1.0, angular_frequency=2.0, start_phase=0.4)
RAMPED = sb.Harmonic.circular(acceleration=0.7, angular_frequency=2.0, ramp=1.7)
TWO = ONE + sb.Harmonic.straight(acceleration=0.3, angular_frequency=3.1, direction=1.0)
LIFTING = sb.Harmonic(amplitude=(0.5, 0.2, 2.0), phase=(0.0, 0.5, 1.0), angular_frequency=2.0)
START = {"tilt": (0.04, 0.01), "tilt_rate": (-0.01, 0.03), "duration": 8.0, "rtol": 1e-10}


@dataclass(frozen=True)
class Swell(BaseMotion):
    """Two frequencies in a Gaussian envelope from a jump at its `onset` on: a motion of a user's own."""

    onset: float = 0.0
    vertical: float = 0.0

    def derivative(self, time, order):
        t = np.asarray(time, dtype=float)
        if order < 2:  # of no matter to the column
            return 0.0 * t, 0.0 * t, 0.0 * t
        envelope = np.where(t < self.onset, 0.0, np.exp(-(((t - 3.0) / 4.0) ** 2)))
        x, y = 0.8 * np.cos(2.0 * t), 0.32 * np.sin(3.3 * t)
        return envelope * x, envelope * y, self.vertical * envelope * np.cos(4.0 * t)

    def peak_horizontal(self, since=0.0):
        return 1.2

    def vertical_range(self, since=0.0):
        return -self.vertical, self.vertical

    def directions(self):
        return ((0.8, 0.0), (0.0, 0.32))

    @property
    def highest_frequency(self):
        return 4.0

    @property
    def breaks(self):
        return (self.onset,) if self.onset > 0.0 else ()


def expect_as_alone(model, motion, outcome_in, end_of, ends_of, **arguments):
    data = sb.simulate_ensemble(model, motion, **arguments, method="taylor")
    single = sb.simulate(model, motion, **arguments, samples=2, recheck=False)
    assert outcome_in(data) is single.outcome
    assert bool(data["planar"][0]) is single.planar
    # A step by series has no cubics to be told by: what is told are the tolerances of two methods, and their growth.
    assert float(data["decided_at"][0]) == pytest.approx(single.decided_at, abs=1e-7)
    np.testing.assert_allclose(ends_of(data)[0], end_of(single), rtol=0.0, atol=1e-8)
    return data, single


@pytest.mark.parametrize("motion", [ONE, ONE.rotated(0.7).scaled(1.3), ONE.delayed(-1.3)])
def test_a_harmonic_motion_moves_runs_as_it_does_alone(outcome_in, end_of, ends_of, motion):
    expect_as_alone(STONE, motion, outcome_in, end_of, ends_of, **START)


RARE = {
    "at rest": sb.base_motions.BASE_AT_REST,
    "ramped": RAMPED,
    "ramped, delayed": RAMPED.delayed(0.9),
    "ramped, ahead": RAMPED.delayed(-0.9),
    "delayed": ONE.delayed(1.1).rotated(1.0),
    "two frequencies": TWO,
    "two frequencies, rotated and scaled": TWO.rotated(-0.4).scaled(0.7),
    "vertical": LIFTING,
    "vertical, scaled": LIFTING.scaled(1.2, vertical=-0.4),
    "own": Swell(),
    "own, with a break": Swell(onset=2.345).rotated(0.9),
    "own, vertical": Swell(onset=0.7, vertical=0.3),
}


@pytest.mark.slow
@pytest.mark.parametrize("kind", RARE)
def test_every_other_motion_moves_runs_as_it_does_alone(outcome_in, end_of, ends_of, kind):
    expect_as_alone(STONE, RARE[kind], outcome_in, end_of, ends_of, **START)


@pytest.mark.slow
def test_a_motion_of_ones_own_releases_a_column_from_rest(outcome_in, end_of, ends_of):
    still = {"tilt": (0.0, 0.0), "duration": 6.0, "rtol": 1e-10}
    data, single = expect_as_alone(STONE, Swell().scaled(2.0), outcome_in, end_of, ends_of, **still)
    releases = sum(event.kind == "uplift" for event in single.events)
    assert int(data["uplifts"][0]) == releases >= 1


# What is told of a run besides its end.

TOLD = {
    "circle": (
        sb.Harmonic.circular(acceleration=0.065, angular_frequency=3.0, start_phase=0.7),
        (0.012, 0.003),
        (0.0, 0.03),
    ),
    "line": (
        sb.Harmonic.straight(acceleration=0.04, angular_frequency=3.0, direction=0.4, start_phase=0.3),
        (0.01, 0.0),
        (0.0, 0.03),
    ),
    "ellipse": (
        sb.Harmonic.elliptic(amplitude=(0.06, 0.03), phase=-1.2, angular_frequency=2.6, start_phase=0.4),
        (0.03, 0.0),
        (0.0, 0.05),
    ),
}


@pytest.fixture(scope="module", params=list(TOLD))
def told(request):
    """One run by series, and alone with many samples."""
    motion, tilt, rate = TOLD[request.param]
    rules = sb.OutcomeRules(periods=4)
    options = {"tilt": tilt, "tilt_rate": rate, "duration": 20 * motion.period, "rules": rules, "rtol": 1e-11}
    data = sb.simulate_ensemble(MODEL, motion, **options, samples=9, strobes=3, method="taylor").isel(run=0)
    return motion, data, sb.simulate(MODEL, motion, **options, samples=100_001, recheck=False)


def test_largest_and_minimum_tilt_are_those_of_a_dense_single_run(told):
    _, data, single = told
    amplitude, time = single.data["amplitude"].to_numpy(), single.data["time"].to_numpy()
    # Half a sample beside an extreme the tilt differs by an eighth of its curvature times the square of a sample.
    bend = np.abs(np.diff(amplitude, 2)).max() / 8.0
    assert float(data["peak_tilt"]) == pytest.approx(amplitude.max(), rel=0.0, abs=bend + 1e-9)
    assert float(data["time_of_peak_tilt"]) == pytest.approx(time[amplitude.argmax()], abs=time[1])
    # The least one is told where cubics over halves of a step have theirs: above it, by the square of what they err.
    assert -bend - 1e-9 < float(data["minimum_tilt"]) - amplitude.min() < 1e-4 * amplitude.min()


def test_turns_and_means_are_integrals_over_a_dense_single_run(told):
    motion, data, single = told
    assert float(data["turns"]) == pytest.approx(single.measures["turns"], abs=1e-9)
    assert float(data["mean_rolling_rate"]) == pytest.approx(single.measures["mean_rolling_rate"], abs=1e-9)
    late = single.data.isel(time=single.data["time"].to_numpy() >= 16 * motion.period * (1.0 - 1e-12))
    time, tilt = late["time"].to_numpy(), late["tilt"].to_numpy()
    # By Gauss's rule on the series; the trapezoidal rule beside it has 5000 samples a period.
    mean = np.trapezoid(late["amplitude"], time) / (4 * motion.period)
    assert float(data["mean_tilt"]) == pytest.approx(mean, rel=2e-8)
    sense = math.copysign(1.0, single.measures["turns"])
    wave = np.exp(-1j * sense * motion.angular_frequency * time)
    lean = np.trapezoid(tilt @ np.array([1.0, 1j]) * wave, time)
    ax, ay, _ = motion.acceleration(time).T
    push = np.trapezoid((ax + 1j * ay) * wave, time)
    assert float(data["phase"]) == pytest.approx(sense * np.angle(lean / push), abs=2e-8)


def test_samples_and_strobes_are_those_of_a_single_run(told):
    motion, data, single = told
    first = (-motion.start_phase / motion.angular_frequency) % motion.period
    there = {
        "strobe": single.sample(first + motion.period * np.array([17, 18, 19])),
        "sampled": single.sample(data["sample_time"].to_numpy()),
    }
    for name, sampled in there.items():
        np.testing.assert_allclose(data[f"{name}_tilt"], sampled["tilt"], rtol=0.0, atol=1e-10)
        np.testing.assert_allclose(data[f"{name}_tilt_rate"], sampled["tilt_rate"], rtol=0.0, atol=1e-9)


def test_samples_and_observation_change_no_run_but_for_its_steps(runs_of, ends_of):
    runs = rolling_runs(runs_of, np.linspace(3.0, 6.0, 5), method="taylor")
    plain, looked = ends_of(runs.together()), ends_of(runs.together(samples=37, strobes=5))
    np.testing.assert_allclose(looked, plain, rtol=0.0, atol=1e-8)


# Events.


@pytest.mark.parametrize("direction", [0.0, 2.0])
def test_overturning_is_proved_when_and_where_it_is_alone(runs_of, outcome_in, direction):
    angle = np.linspace(-3.0, 3.0, 8)
    tilt = 0.08 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    motion = sb.Harmonic.circular(acceleration=0.13, angular_frequency=1.8).rotated(direction)
    runs = runs_of(MODEL, motion, 8, tilt=tilt, tilt_rate=tilt[:, ::-1] * 0.5, duration=20.0, rtol=1e-11)
    data = runs.together(method="taylor")
    for index in range(8):
        single = runs.alone(index)
        assert outcome_in(data, index) is single.outcome is sb.Outcome.OVERTURNED
        assert float(data["decided_at"][index]) == pytest.approx(single.decided_at, abs=1e-9)
        last = single.data["tilt"].to_numpy()[-1]
        assert float(data["direction"][index]) == pytest.approx(math.atan2(last[1], last[0]), abs=1e-8)
        assert float(data["peak_tilt"][index]) >= C + 0.13 - 1e-10


# Steps are long: a swing may pass the limit between their ends, and more than one swing lie within.
@pytest.mark.parametrize("short", [1e-3, 1e-5, 1e-7])
def test_no_tilt_exceeds_the_limit_unseen(runs_of, outcome_in, short):
    angle = np.linspace(-3.0, 3.0, 24)
    tilt = 0.02 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    motion = sb.Harmonic.circular(acceleration=0.065, angular_frequency=1.8)
    runs = runs_of(MODEL, motion, 24, tilt=tilt, tilt_rate=(0.03, 0.0), duration=15.0, method="taylor")
    free = runs.together()
    swinging = (free["outcome"] != sb.Outcome.OVERTURNED) & (free["time_of_peak_tilt"] > 0.0)
    assert int(swinging.sum()) >= 5
    for index in np.flatnonzero(swinging):
        limit = float(free["peak_tilt"][index]) * (1.0 - short)
        data = runs.part([index]).together(tilt_limit=limit)
        assert outcome_in(data) is sb.Outcome.LIMIT_REACHED
        assert float(data["peak_tilt"][0]) == pytest.approx(limit, rel=1e-9)
        assert float(data["decided_at"][0]) < float(free["time_of_peak_tilt"][index])
        assert np.hypot(*data["end_tilt"].to_numpy()[0]) == pytest.approx(limit, rel=1e-9)
        assert float(data["end_tilt"][0] @ data["end_tilt_rate"][0]) > 0.0


@pytest.mark.parametrize("damping", [0.3, 1.5])
def test_friction_brings_columns_to_rest_when_it_does_alone(runs_of, outcome_in, damping):
    model = sb.Slender(COLUMN, damping=damping)
    still = LINE.scaled(0.0)
    tilt = [(0.01, 0.0), (0.05, 0.0)]
    runs = runs_of(model, still, 2, tilt=tilt, tilt_rate=(0.0, 0.01), duration=100.0, rtol=1e-10)
    data = runs.together(method="taylor")
    for index in range(2):
        single = runs.alone(index)
        assert outcome_in(data, index) is single.outcome is sb.Outcome.AT_REST
        assert float(data["decided_at"][index]) == pytest.approx(single.decided_at, abs=1e-6)
        np.testing.assert_array_equal(data["end_tilt"][index], 0.0)
        assert float(data["minimum_tilt"][index]) == 0.0


@pytest.mark.parametrize("excess", [1e-4, 0.1, 2.0])
def test_a_column_is_released_when_it_is_alone(runs_of, outcome_in, end_of, ends_of, excess):
    motion = sb.Harmonic.elliptic(
        amplitude=(C * (1.0 + excess), 0.03), phase=0.4, angular_frequency=1.7, start_phase=0.6
    )
    runs = runs_of(MODEL, motion, 1, tilt=(0.0, 0.0), duration=4.0, rtol=1e-11)
    data, single = runs.together(method="taylor"), runs.alone(0)
    assert outcome_in(data) is single.outcome
    releases = sum(event.kind == "uplift" for event in single.events)
    assert int(data["uplifts"][0]) == releases >= 1
    np.testing.assert_allclose(ends_of(data)[0], end_of(single), rtol=0.0, atol=1e-7)


def test_a_space_motion_that_rests_goes_on_in_the_plane_of_a_straight_base_motion(runs_of, outcome_in):
    motion = sb.Harmonic.straight(acceleration=0.13, angular_frequency=0.05, start_phase=-1.6, direction=0.6)
    model = sb.Slender(COLUMN, damping=1.0)
    runs = runs_of(model, motion, 2, tilt=[(0.0, 0.01), (0.01, -0.01)], tilt_rate=(0.001, 0.0), duration=22.0)
    data = runs.together(method="taylor")
    for index in range(2):
        single = runs.alone(index)
        assert [event.kind for event in single.events][:2] == ["rest", "uplift"]
        assert int(data["uplifts"][index]) == 1
        assert outcome_in(data, index) is single.outcome
        assert bool(data["planar"][index]) is False
        np.testing.assert_allclose(data["end_tilt"][index], single.data["tilt"].to_numpy()[-1], rtol=0.0, atol=1e-6)


@pytest.mark.parametrize("max_steps", [1, 7])
def test_a_run_out_of_steps_has_failed(runs_of, outcome_in, max_steps):
    runs = runs_of(MODEL, CIRCLE, 1, tilt=(0.05, 0.0), tilt_rate=(0.0, 0.02), duration=100.0, max_steps=max_steps)
    data = runs.together(method="taylor")
    assert outcome_in(data) is sb.Outcome.FAILED
    assert int(data["steps"][0]) <= max_steps
    assert 0.0 < float(data["decided_at"][0]) < 100.0


def test_free_motion_in_space_conserves_energy_and_angular_momentum():
    rng = np.random.default_rng(4)
    tilt, rate = rng.uniform(0.01, 0.05, (60, 2)), rng.uniform(-0.03, 0.03, (60, 2))
    still = CIRCLE.scaled(0.0)
    options = {"tilt": tilt, "tilt_rate": rate, "duration": 30.0, "rtol": 1e-12, "method": "taylor"}
    data = sb.simulate_ensemble(sb.Slender(COLUMN), still, **options)

    def integrals(x, v):
        a = np.hypot(*x.T)
        return 0.5 * np.sum(v**2, axis=1) + C * a - 0.5 * a**2, x[:, 0] * v[:, 1] - x[:, 1] * v[:, 0]

    found = integrals(data["end_tilt"].to_numpy(), data["end_tilt_rate"].to_numpy())
    np.testing.assert_allclose(found, integrals(tilt, rate), rtol=0.0, atol=1e-8 * C**2)


# Nothing but the energy at the start can tilt the column: friction takes from it.
@pytest.mark.parametrize("spatial", [False, pytest.param(True, marks=pytest.mark.slow)])
@pytest.mark.parametrize("damping", [0.0, 0.1])
def test_exact_planar_motion_is_never_a_false_overturn(damping, spatial):
    amplitude = np.linspace(0.001, 0.099, 40)
    model = (Spatial if spatial else sb.Slender)(COLUMN, damping)
    for angle in (0.0, 0.7):
        tilt = amplitude[:, np.newaxis] * np.array([math.cos(angle), math.sin(angle)])
        data = sb.simulate_ensemble(model, CIRCLE.scaled(0.0), tilt=tilt, duration=30.0, method="taylor", rtol=1e-8)
        assert bool((data["planar"] != spatial).all())
        assert sb.Outcome.OVERTURNED not in data["outcome"].to_numpy()
        # Each step may add the tolerance.
        assert np.all(data["peak_tilt"] <= amplitude * (1.0 + 1e-8 * data["steps"]))


# A run does not depend on those beside it.


def bits(data):
    """Return every number of every run as bytes, shape (runs, …)."""
    columns = [
        np.ascontiguousarray(variable.transpose("run", ...).to_numpy().reshape(data.sizes["run"], -1)).view(np.uint8)
        for name, variable in sorted(data.data_vars.items())
    ]
    return np.concatenate(columns, axis=1)


@pytest.mark.parametrize("kind", ["circle", "line"])
def test_a_run_is_the_same_to_the_last_bit_in_any_company_on_any_number_of_threads(mixed_runs, monkeypatch, kind):
    runs = mixed_runs(KINDS[kind], 97, seed=5, samples=3, strobes=2, method="taylor")
    whole = bits(runs.together(threads=1))
    rng = np.random.default_rng(6)
    for chosen in ([0], [16], [96], rng.permutation(97), rng.integers(0, 97, 30)):
        np.testing.assert_array_equal(bits(runs.part(chosen).together()), whole[chosen])
    for size, threads in ((1, 2), (7, 1), (33, 5)):
        monkeypatch.setattr(ensemble, "_FEWEST", size)
        monkeypatch.setattr(ensemble, "_MOST", size)
        np.testing.assert_array_equal(bits(runs.together(threads=threads)), whole)


# Refusals, and models of a user's own.


@dataclass(frozen=True, slots=True)
class Spatial(sb.Slender):
    """The slender column without equations for a plane."""

    name: ClassVar[str] = "spatial"
    planar_rates = None


class Comparing(Spatial):
    name = "comparing"
    contact = None

    @staticmethod
    def rates(x, y, vx, vy, ax, ay, az, c, eta, _kappa):
        lean = 1.0 - c / math.sqrt(x * x + y * y) if x != 0.0 else 0.0
        return vx, vy, lean * x - eta * vx - ax, lean * y - eta * vy - ay


class Waving(Spatial):
    name = "waving"
    contact = no_return_tilt = None

    @staticmethod
    def rates(x, y, vx, vy, ax, ay, az, c, eta, _kappa):
        lean = 1.0 - c / math.sqrt(x * x + y * y)
        return vx, vy, lean * math.sin(x) - eta * vx - ax, lean * math.sin(y) - eta * vy - ay


@pytest.mark.parametrize("model", [Comparing, Waving])
def test_a_model_without_series_is_refused_in_one_line(model):
    with pytest.raises(UnsupportedError, match=rf"model {model.name} hold .*; use method='dop853'") as refusal:
        sb.simulate_ensemble(model(COLUMN, ETA), CIRCLE, tilt=(0.03, 0.0), duration=1.0, method="taylor")
    assert "\n" not in str(refusal.value)


@pytest.mark.parametrize("method", ["rk4", "Taylor", "", None])
def test_another_method_is_refused_in_one_line(method):
    with pytest.raises(ParameterError, match=r"method must be 'dop853' or 'taylor', got ") as refusal:
        sb.simulate_ensemble(MODEL, CIRCLE, tilt=(0.03, 0.0), duration=1.0, method=method)
    assert str(refusal.value).endswith(f"got {method!r}")


class Chained(Spatial):
    """Linear, its states in another order: the rate of the second is the first, of the fourth the third."""

    name = "chained"
    passage = contact = departure = rest_energy = no_return_tilt = None

    @staticmethod
    def rates(vx, x, vy, y, ax, ay, az, c, eta, _kappa):
        return -x - eta * vx - ax, vx, -y - eta * vy - ay, vy

    @staticmethod
    def tilt_of(vx, x, vy, y, *_):
        return x, y, vx, vy

    def start(self, tilt, tilt_rate):
        scale = self.time_scale
        return tilt_rate[0] * scale, tilt[0], tilt_rate[1] * scale, tilt[1]


@pytest.mark.slow
def test_states_in_another_order_are_followed(outcome_in):
    # A harmonic oscillator: z = z0 cos t + z0' sin t.
    start = {"tilt": (0.03, 0.01), "tilt_rate": (-0.01, 0.02), "rest_energy": 0.0}
    data = sb.simulate_ensemble(
        Chained(COLUMN), CIRCLE.scaled(0.0), **start, duration=30.0, rtol=1e-11, method="taylor"
    )
    cos, sin = math.cos(30.0), math.sin(30.0)
    assert outcome_in(data) is sb.Outcome.STILL_MOVING
    expected = [0.03 * cos - 0.01 * sin, 0.01 * cos + 0.02 * sin]
    np.testing.assert_allclose(data["end_tilt"][0], expected, rtol=0.0, atol=1e-11)


@pytest.mark.parametrize(("kind", "advised"), [(sb.Slender, False), (sb.SlenderRolling, False), (sb.Wobbling, True)])
def test_series_are_advised_against_where_they_are_slower(kind, advised, caplog):
    sb.simulate_ensemble(kind(COLUMN, damping=ETA), CIRCLE, tilt=(0.05, 0.0), duration=0.1, method="taylor")
    assert ("'taylor' takes two to eight times the time of 'dop853'" in caplog.text) is advised
