"""Base motions of every kind move the runs of an ensemble as they move a single run."""

import math
from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import stylobate as sb
from stylobate.base_motions import BaseMotion
from stylobate.engine.ensembles.polynomials import tabulated
from stylobate.errors import ParameterError, UnsupportedError

STONE = sb.Slender(sb.Column.solid(radius=0.5, height=10.0, density=2700.0), damping=0.1)
ONE = sb.Harmonic.elliptic(amplitude=(0.6, 0.3), phase=1.0, angular_frequency=2.0, start_phase=0.4)
RAMPED = sb.Harmonic.circular(acceleration=0.7, angular_frequency=2.0, ramp=1.7)
TWO = ONE + sb.Harmonic.straight(acceleration=0.3, angular_frequency=3.1, direction=1.0)
LIFTING = sb.Harmonic(amplitude=(0.5, 0.2, 2.0), phase=(0.0, 0.5, 1.0), angular_frequency=2.0)
START = {"tilt": (0.04, 0.01), "tilt_rate": (-0.01, 0.03), "duration": 8.0, "rtol": 1e-10}


def expect_as_alone(runs, outcome_in, end_of, ends_of):
    data = runs.together()
    for index in range(len(runs)):
        single = runs.alone(index)
        assert outcome_in(data, index) is single.outcome
        assert bool(data["planar"][index]) is single.planar
        assert float(data["decided_at"][index]) == pytest.approx(single.decided_at, abs=1e-6)
        np.testing.assert_allclose(ends_of(data)[index], end_of(single), rtol=0.0, atol=1e-7)
    return data


@pytest.mark.parametrize(
    "motion",
    [
        None,
        ONE,
        ONE.rotated(0.7).scaled(1.3),
        ONE.scaled(-0.8, vertical=0.0),
        ONE.delayed(-1.3),
        RAMPED,
        RAMPED.delayed(0.9),
        RAMPED.delayed(-0.9),
        RAMPED.delayed(-0.9).delayed(2.0),
        RAMPED.delayed(2.0).delayed(-0.9).rotated(1.0),
        RAMPED.delayed(2.0).delayed(1.1),
        pytest.param(TWO, marks=pytest.mark.slow),  # a kernel of its own; see the test by plain Python in lanes
        pytest.param(TWO.rotated(-0.4).scaled(0.7), marks=pytest.mark.slow),
        LIFTING,
        LIFTING.scaled(1.2, vertical=-0.4),
    ],
    ids=lambda motion: type(motion).__name__,
)
def test_harmonic_motions_move_runs_as_they_do_alone(runs_of, outcome_in, end_of, ends_of, motion):
    expect_as_alone(runs_of(STONE, motion, 1, **START), outcome_in, end_of, ends_of)


def test_runs_over_stroke_angle_and_frequency_are_those_of_motions_stated_so():
    feeder = sb.Harmonic.stroke(stroke=0.001, frequency=50.0, angle=0.4)
    pin = sb.Sliding(sb.Column.solid(radius=0.006, height=0.040, density=7850.0), friction_coefficient=0.2)
    varied = {"stroke": [5e-4, 1.2e-3, 1.2e-3], "angle": [0.3, 0.4, 0.0], "frequency": [50.0, 40.0, 60.0]}
    runs = sb.simulate_ensemble(pin, feeder.rotated(0.5), duration=0.2, parameters=varied)
    for place in range(3):
        motion = sb.Harmonic.stroke(**{name: values[place] for name, values in varied.items()}).rotated(0.5)
        alone = sb.simulate(pin, motion, duration=0.2)
        assert alone.outcome == runs["outcome"][place]
        for axis in "xy":
            moved = alone.measures[f"residual_displacement_{axis}"]
            assert moved == runs["end_footprint"].sel(axis=axis).values[place]


def test_a_frequency_that_varies_sets_the_length_of_its_period():
    feeder = sb.Harmonic.stroke(stroke=0.001, frequency=50.0, angle=0.4)
    pin = sb.Sliding(sb.Column.solid(radius=0.006, height=0.040, density=7850.0), friction_coefficient=0.2)
    runs = sb.conveying.drift(pin, feeder, over={"frequency": [20.0, 40.0]}, periods=8.0, late=4, tolerance=None)
    assert runs["end_time"].values == pytest.approx([8.0 / 20.0, 8.0 / 40.0], rel=1e-14)


@pytest.mark.parametrize(
    ("values", "remedy"),
    [
        (
            {"stroke": [1e-3], "angular_frequency": [300.0]},
            "stroke: angular_frequency keeps the acceleration.*frequency",
        ),
        ({"frequency": [50.0], "angular_frequency": [300.0]}, "frequency: angular_frequency keeps the acceleration"),
        ({"stroke": [1e-3], "acceleration": [3.0]}, "stroke: acceleration sets the amplitude too"),
    ],
)
def test_numbers_that_replace_each_other_do_not_vary_together(values, remedy):
    feeder = sb.Harmonic.stroke(stroke=0.001, frequency=50.0, angle=0.4)
    with pytest.raises(ParameterError, match=remedy):
        sb.simulate_ensemble(STONE, feeder, duration=0.1, parameters=values)


# The end of the rise is met as a break: to the last bit the same number in the window and among the breaks.
@settings(max_examples=15)
@given(delays=st.lists(st.floats(-3.0, 5.0), min_size=1, max_size=20), ramp=st.floats(0.01, 4.0))
def test_a_rise_ends_wherever_it_began(delays, ramp):
    motion = sb.Harmonic.circular(acceleration=0.7, angular_frequency=2.0, ramp=ramp)
    data = sb.simulate_ensemble(STONE, motion, tilt=(0.02, 0.0), duration=10.0, parameters={"delay": delays}, rtol=1e-6)
    single = sb.simulate(
        STONE, motion.delayed(delays[0]), tilt=(0.02, 0.0), duration=10.0, samples=2, rtol=1e-6, recheck=False
    )
    late = sb.simulate(
        STONE, motion.delayed(delays[0]), tilt=(0.02, 0.0), duration=10.0, samples=2, rtol=1e-9, recheck=False
    )
    spread = np.abs(single.data["tilt"][-1] - late.data["tilt"][-1]).max()
    assert np.abs(data["end_tilt"][0].to_numpy() - late.data["tilt"].to_numpy()[-1]).max() < 100.0 * spread + 1e-4


@dataclass(frozen=True)
class Burst(BaseMotion):
    """Two frequencies in a Gaussian envelope, from a jump at its `onset` on; a motion of a user's own."""

    onset: float = 0.0
    vertical: float = 0.3
    bend: float = 0.8
    listed: bool = True
    bounds_fall: bool = False

    def derivative(self, time, order):
        t = np.asarray(time, dtype=float)
        if order < 2:  # of no matter to the column
            return 0.0 * t, 0.0 * t, 0.0 * t
        envelope = np.where(t < self.onset, 0.0, np.exp(-(((t - 3.0) / 4.0) ** 2)))
        x = envelope * 0.8 * np.cos(2.0 * t)
        return x, self.bend * envelope * 0.4 * np.sin(3.3 * t), self.vertical * envelope * np.cos(4.0 * t)

    def peak_horizontal(self, since=0.0):
        return 1.2 * self.envelope_from(since)

    def vertical_range(self, since=0.0):
        size = self.vertical * self.envelope_from(since)
        return -size, size

    def envelope_from(self, since):
        return math.exp(-(((max(since, 3.0) - 3.0) / 4.0) ** 2)) if self.bounds_fall else 1.0

    def directions(self):
        return ((0.8, 0.0), (0.0, 0.4 * self.bend))

    @property
    def highest_frequency(self):
        return 4.0

    @property
    def breaks(self):
        return (self.onset,) if self.listed and self.onset > 0.0 else ()


@pytest.mark.parametrize("motion", [Burst(), Burst(onset=2.345, vertical=0.0), Burst(onset=0.7, bounds_fall=True)])
@pytest.mark.parametrize("end", [5.0, 40.0])
def test_a_tabulated_motion_is_the_motion_to_rounding(motion, end):
    table = tabulated(motion, end)
    starts, ends = table.rows[:, 0], table.rows[:, 1]
    np.testing.assert_array_equal(starts[1:], ends[:-1])
    assert starts[0] == 0.0
    assert ends[-1] >= end
    time = np.random.default_rng(1).uniform(0.0, end, 20_000)
    piece = np.searchsorted(starts, time, side="right") - 1
    rows = table.rows[piece]
    u = (time - 0.5 * (rows[:, 0] + rows[:, 1])) / (0.5 * (rows[:, 1] - rows[:, 0]))
    coefficients = table.coefficients[piece]
    found = np.einsum("nap,np->an", coefficients, u[:, np.newaxis] ** np.arange(table.degree + 1))
    assert np.abs(found - np.stack(motion.derivative(time, 2))).max() < 1e-10 * motion.peak_horizontal()
    # Bounds are those from the start of each piece on.
    np.testing.assert_allclose(table.rows[:, 2], [motion.peak_horizontal(start) for start in starts])


@pytest.mark.slow  # two kernels of its own; see the test by plain Python in lanes
@pytest.mark.parametrize(
    "motion",
    [Burst(vertical=0.0), Burst(onset=2.345, vertical=0.0), Burst(onset=0.7), Burst(bend=0.0, vertical=0.0)],
)
def test_a_motion_of_ones_own_moves_runs_as_it_does_alone(runs_of, outcome_in, end_of, ends_of, motion):
    values = {"rotation": [0.0, 0.9, -2.0], "scale": [1.0, 1.4, -0.8], "delay": [0.0, 0.63, -0.4]}
    data = expect_as_alone(runs_of(STONE, motion, 3, **START, parameters=values), outcome_in, end_of, ends_of)
    assert len(set(data["end_tilt"][:, 0].to_numpy().tolist())) == 3


PLANES = pytest.mark.parametrize("planar", [True, pytest.param(False, marks=pytest.mark.slow)])


@PLANES
def test_a_motion_of_ones_own_releases_a_column_from_rest(runs_of, outcome_in, end_of, ends_of, planar):
    still = {"tilt": (0.0, 0.0), "duration": 12.0, "rtol": 1e-10}
    motion = Burst(bend=0.0 if planar else 0.8, vertical=0.0)
    runs = runs_of(STONE, motion, 3, **still, parameters={"scale": [1.0, 1.5, 2.0]})
    data = expect_as_alone(runs, outcome_in, end_of, ends_of)
    assert int(data["uplifts"][0]) == 0
    assert int(data["uplifts"][2]) >= 1


# Bounds that fall are taken anew with each piece of the table: what they prove is told at most a piece later.
@PLANES
def test_a_motion_that_dies_away_proves_the_same_a_piece_later(runs_of, outcome_in, end_of, ends_of, planar):
    motion = Burst(bend=0.0 if planar else 0.8, vertical=0.0, bounds_fall=True)
    piece = math.pi / motion.highest_frequency
    start = np.stack([np.linspace(0.0, 0.12, 13), np.full(13, 0.0 if planar else 0.01)], axis=1)
    runs = runs_of(STONE, motion, 13, tilt=start, duration=25.0, rtol=1e-10)
    data = runs.together()
    outcomes = [outcome_in(data, index) for index in range(13)]
    # In a plane friction brings some to rest.
    assert set(outcomes) - {sb.Outcome.AT_REST} == {sb.Outcome.OVERTURNED, sb.Outcome.STILL_MOVING}
    for index, outcome in enumerate(outcomes):
        single = runs.alone(index)
        assert outcome is single.outcome
        later = float(data["decided_at"][index]) - single.decided_at
        if outcome is sb.Outcome.OVERTURNED:
            assert -1e-6 < later < piece
        else:
            np.testing.assert_allclose(ends_of(data)[index], end_of(single), rtol=0.0, atol=1e-7)


def test_a_jump_that_is_not_listed_is_refused():
    unlisted = Burst(onset=2.345, listed=False)
    with pytest.raises(ParameterError, match=r"^Burst\.breaks: the acceleration jumps by .* at t = 2\.345 s") as caught:
        sb.simulate_ensemble(STONE, unlisted, **START)
    assert "\n" not in str(caught.value)
    with pytest.raises(UnsupportedError, match=r"must be smooth between its breaks, but is not near t = 2\.34"):
        tabulated(unlisted, 5.0)


class Broken(BaseMotion):
    """A motion that breaks one of its promises."""

    def __init__(self, values, bound=1.0):
        self.values, self.bound = values, bound

    def derivative(self, time, order):
        return tuple(np.full(np.shape(time), value) for value in self.values)

    def peak_horizontal(self, since=0.0):
        return self.bound

    def vertical_range(self, since=0.0):
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
        sb.simulate_ensemble(STONE, motion, tilt=(0.03, 0.0), duration=1.0)


def test_a_run_that_ends_before_its_pulse_begins_is_followed():
    late = sb.Pulse.sinusoidal(acceleration=2.5, angular_frequency=4.0, phase=0.4, start=0.7)
    model = sb.Slender(sb.Column.solid(radius=0.2, height=2.0, density=2700.0))
    runs = sb.simulate_ensemble(model, late, duration=[0.4, 0.5], tilt=[[0.01, 0.0], [0.0, 0.0]])
    alone = sb.simulate(model, late, duration=0.4, tilt=(0.01, 0.0), recheck=False)
    assert float(runs["end_tilt"].isel(run=0, axis=0)) == pytest.approx(float(alone.data["tilt"][-1, 0]), abs=1e-9)
