"""Which values the runs have: grids, random points, given points."""

import json

import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st

import stylobate as sb
from stylobate.errors import ParameterError
from stylobate.studies.sweeps import Sweep
from stylobate.studies.sweeps.designs import Box, Grid, whole

MODEL = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
MOTION = sb.Harmonic.circular(acceleration=0.15, angular_frequency=1.0)
BOX = {"tilt_x": (-0.06, 0.06), "acceleration": (0.0, 0.2)}


def test_a_grid_is_every_combination_in_c_order():
    design = Grid.of({"acceleration": [1.0, 2.0], "damping": [0.1, 0.2, 0.3]})
    values = design.values(whole(design))
    assert design.dims == ("acceleration", "damping")
    np.testing.assert_array_equal(values["acceleration"], [1, 1, 1, 2, 2, 2])
    np.testing.assert_array_equal(values["damping"], [0.1, 0.2, 0.3] * 2)


@settings(max_examples=25)
@given(st.integers(0, 10_000), st.integers(0, 10_000))
def test_random_points_do_not_depend_on_how_they_are_cut(a, b):
    design = Box.of(BOX, 10_000, rng=3)
    part = slice(min(a, b), max(a, b))
    all_of_them, some = design.values(whole(design)), design.values((part,))
    for name, values in all_of_them.items():
        np.testing.assert_array_equal(some[name], values[part])


def test_the_first_random_points_are_those_of_a_shorter_sweep():
    long, short = Box.of(BOX, 9000, rng=3), Box.of(BOX, 50, rng=3)
    for name, values in short.values(whole(short)).items():
        np.testing.assert_array_equal(values, long.values(whole(long))[name][:50])


def test_random_points_fill_the_box_and_no_more():
    design = Box.of(BOX, 20_000, rng=3)
    values = design.values(whole(design))
    for name, (low, high) in BOX.items():
        shares = (values[name] - low) / (high - low)
        assert low <= values[name].min()
        assert values[name].max() <= high
        # The moments of a uniform distribution, to five standard errors of a sample of 20 000.
        assert shares.mean() == pytest.approx(1.0 / 2.0, abs=5.0 * np.sqrt(1.0 / 12.0 / 20_000))
        assert shares.var() == pytest.approx(1.0 / 12.0, abs=5.0 * np.sqrt(1.0 / 180.0 / 20_000))
    assert abs(np.corrcoef(*values.values())[0, 1]) < 5.0 / np.sqrt(20_000)


def test_a_range_of_no_width_is_one_value():
    design = Box.of({"damping": (0.3, 0.3)}, 5, rng=0)
    np.testing.assert_array_equal(design.values(whole(design))["damping"], 0.3)


def test_a_generator_gives_the_seed_once():
    first, second = (Box.of(BOX, 5, np.random.default_rng(8)) for _ in range(2))
    rng = np.random.default_rng(8)
    other = [Box.of(BOX, 5, rng).seed for _ in range(2)]
    assert first.seed == second.seed == other[0] != other[1]


def test_what_a_sweep_holds_does_not_change_with_the_array_it_was_given():
    values = np.array([0.1, 0.2])
    sweep = Sweep.points(MODEL, MOTION, at={"acceleration": values}, duration=1.0)
    values[0] = 5.0
    assert sweep.design.values(whole(sweep.design))["acceleration"][0] == 0.1


def test_periods_follow_a_frequency_that_varies():
    sweep = Sweep.points(MODEL, MOTION, at={"angular_frequency": [1.0, 4.0]}, periods=3.0)
    arguments = sweep.recipe.arguments(sweep.design.values(whole(sweep.design)))
    np.testing.assert_allclose(arguments["duration"], [6.0 * np.pi, 1.5 * np.pi])
    fixed = Sweep.points(MODEL, MOTION, at={"acceleration": [0.1]}, periods=3.0)
    assert fixed.recipe.arguments({"acceleration": np.array([0.1])})["duration"] == pytest.approx(6.0 * np.pi)


@pytest.mark.parametrize(
    ("make", "line"),
    [
        (lambda: Sweep.grid(MODEL, over={}, duration=1.0), "over must name what varies"),
        (lambda: Sweep.points(MODEL, at={}, duration=1.0), "at must name what varies"),
        (lambda: Sweep.grid(MODEL, over={"damping": [[0.1]]}, duration=1.0), r"over\['damping'\] must be a list"),
        (lambda: Sweep.grid(MODEL, over={"damping": "x"}, duration=1.0), r"over\['damping'\] must be a list"),
        (lambda: Sweep.grid(MODEL, over={"damping": [0.1, -0.2]}, duration=1.0), "zero or positive, got -0.2"),
        (lambda: Sweep.grid(MODEL, over={"tilt_x": [np.nan]}, duration=1.0), "must be finite, got nan rad"),
        (lambda: Sweep.grid(MODEL, over={"size": [0.0]}, duration=1.0), "must be positive, got 0.0$"),
        (
            lambda: Sweep.points(MODEL, at={"tilt_x": [0.1], "tilt_y": [0.1, 0.2]}, duration=1.0),
            r"at\['tilt_y'\] must have as many values as at\['tilt_x'\], 1, got 2",
        ),
        (
            lambda: Sweep.random(MODEL, over={"tilt_x": (0.1, 0.0)}, count=1, rng=1, duration=1.0),
            r"over\['tilt_x'\] must be a lower and an upper bound, got \(0.1, 0.0\)",
        ),
        (
            lambda: Sweep.random(MODEL, over={"scale": (-1e308, 1e308)}, count=1, rng=1, duration=1.0),
            "too large to compute with",
        ),
        (lambda: Sweep.random(MODEL, over=BOX, count=-1, rng=1, duration=1.0), "count must be a whole number"),
        (lambda: Sweep.random(MODEL, over=BOX, count=1, rng=None, duration=1.0), "rng must be"),
        (lambda: Sweep.grid(MODEL, over={"damping": [0.1]}), "one of duration .* got none of them"),
        (lambda: Sweep.grid(MODEL, MOTION, over={"damping": [0.1]}, duration=1.0, periods=1.0), "duration and periods"),
        (lambda: Sweep.grid(MODEL, over={"duration": [0.1]}, duration=1.0), "duration among what varies"),
        (lambda: Sweep.grid(MODEL, over={"damping": [0.1]}, periods=1.0), "periods needs a periodic base motion"),
        (lambda: Sweep.grid(MODEL, over={"damping": [0.1]}, duration=-1.0), "duration must be positive, got -1.0 s"),
        (lambda: Sweep.grid(MODEL, over={"damping": [0.1]}, duration=1.0, speed=3), "speed is no option of a sweep"),
        (lambda: Sweep.grid(MODEL, over={"damping": [0.1]}, duration=1.0, tilt=(1,)), "tilt must have 2 numbers"),
        (lambda: Sweep.grid(MODEL, 3, over={"damping": [0.1]}, duration=1.0), "motion must be a base motion"),
        (lambda: Sweep.grid(3, over={"damping": [0.1]}, duration=1.0), "model must be a model"),
        (
            lambda: Sweep.grid(MODEL, over={"colour": [0.1]}, duration=1.0),
            "^over: colour is not known here; known are tilt_x, tilt_y, tilt_rate_x, tilt_rate_y, spin, duration",
        ),
        (lambda: Sweep.points(MODEL, at={"colour": [0.1]}, duration=1.0), "^at: colour is not known here"),
        (
            lambda: Sweep.grid(MODEL, over={"slenderness": [0.1], "radius": [0.2]}, duration=1.0),
            "^over: slenderness changes the radius, which is given too; leave one of them out$",
        ),
    ],
)
def test_what_cannot_be_swept_is_named(make, line):
    with pytest.raises(ParameterError, match=line):
        make()


def test_a_study_takes_a_seed_or_a_generator_and_keeps_the_seed():
    found = [
        sb.studies.basins(MODEL, over={"tilt_x": (-0.06, 0.06)}, count=3, rng=rng, duration=1.0)
        for rng in (7, np.random.default_rng(1), np.random.default_rng(1))
    ]
    seeds = [json.loads(one.attrs["provenance"])["design"]["seed"] for one in found]
    assert seeds[0] == 7
    assert seeds[1] == seeds[2] == np.random.default_rng(1).integers(2**63)
    xr.testing.assert_equal(found[1], found[2])
