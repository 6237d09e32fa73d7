"""Basins have the symmetries of the motion, and fractions along a parameter are those of its values."""

from dataclasses import replace

import numpy as np
import pytest

import stylobate as sb
from stylobate.errors import Interrupted, ParameterError
from stylobate.studies.maps.attractor_search import OrbitScales
from stylobate.studies.maps.basin_fractions import scales_at

MODEL = sb.Slender(sb.Column.dimensionless(0.1), damping=0.1)
STRAIGHT = sb.Harmonic.straight(acceleration=0.04, angular_frequency=1.8)
BOX = {"tilt_x": (-0.05, 0.05), "tilt_y": (-0.05, 0.05), "tilt_rate_x": (-0.05, 0.05), "tilt_rate_y": (-0.05, 0.05)}
MIRRORED = {"rolling anticlockwise": "rolling clockwise", "rolling clockwise": "rolling anticlockwise"}


def test_basins_of_a_motion_along_x_are_mirrored_at_the_x_axis():
    half = np.linspace(0.002, 0.06, 8)
    axis = np.concatenate([-half[::-1], half])
    over = {"tilt_y": axis, "tilt_rate_y": axis}
    found = sb.studies.basins(MODEL, STRAIGHT, over=over, tilt=(0.02, 0.0), tilt_rate=(-0.01, 0.0), periods=120)
    names = [*found["attractor_name"].values, "not computed"]
    table = np.array([[names[label] for label in row] for row in found["attractor"].values])
    # Sign changes are exact in floating point, so that the mirror image is too.
    mirrored = np.array([[MIRRORED.get(name, name) for name in row] for row in table[::-1, ::-1]])
    np.testing.assert_array_equal(table, mirrored)
    assert set(MIRRORED) <= set(table.ravel())


def test_a_free_column_falls_beyond_its_tipping_angle_and_rests_within():
    starts = [-0.12, -0.08, 0.03, 0.09, 0.11]
    found = sb.studies.basins(MODEL, over={"tilt_x": starts, "tilt_rate_y": [0.0]}, duration=200.0)
    names = found["attractor_name"].values[found["attractor"].values[:, 0]]
    assert names.tolist() == ["overturned", "at rest", "at rest", "at rest", "overturned"]
    np.testing.assert_allclose(found["fraction"], [0.6, 0.4])
    assert ((found["fraction_low"] < found["fraction"]) & (found["fraction"] < found["fraction_high"])).all()


@pytest.mark.parametrize(
    ("frequency", "periods", "expected"),
    [
        (1.39, 100.0, {"modulated anticlockwise"}),
        (1.395, 100.0, {"modulated anticlockwise"}),
        (1.4, 60.0, {"not settled", "rolling anticlockwise"}),
        (1.4, 200.0, {"rolling anticlockwise"}),
    ],
)
def test_one_attractor_has_one_name_and_what_still_creeps_towards_it_has_not_settled(frequency, periods, expected):
    # Rolling is modulated below the frequency 1.3971, and comes in slowly above it.
    circle = sb.Harmonic.circular(acceleration=0.065, angular_frequency=frequency)
    begun = sb.studies.steady_start(MODEL, circle)
    over = {"tilt_x": (0.052, 0.06), "tilt_rate_y": (0.07, 0.078)}
    found = sb.studies.basins(MODEL, circle, over=over, count=40, rng=2, periods=periods, **begun)
    names = found["attractor_name"].values[found["attractor"].values]
    assert set(names.tolist()) - {"overturned"} == expected
    assert int(found["unsettled"]) == int((names == "not settled").sum())
    assert float(found["fraction"].sum()) == pytest.approx(1.0)


def test_starts_that_near_an_orbit_of_three_periods_are_not_taken_for_aperiodic():
    # Four in ten starts come to orbits of up to three periods in the end, and none of them within 200.
    line = sb.Harmonic.straight(acceleration=0.3, angular_frequency=6.0)
    box = dict.fromkeys(BOX, (-0.06, 0.06))
    early, late = (
        sb.studies.basins(MODEL, line, over=box, count=200, rng=1, periods=periods, strobes=64)
        for periods in (200, 3000)
    )
    settles = late["attractor_period"].values[late["attractor"].values] > 0
    told = early["attractor_kind"].values[early["attractor"].values][settles]
    assert settles.sum() > 50
    assert (told == "not settled").mean() > 0.95


def test_a_sample_is_the_same_for_the_same_seed_and_counts_every_start():
    first, again, other = (sb.studies.basins(MODEL, over=BOX, count=12, rng=seed, duration=5.0) for seed in (1, 1, 2))
    np.testing.assert_array_equal(first["tilt_x"], again["tilt_x"])
    assert (first["tilt_x"] != other["tilt_x"]).any()
    assert int(first["computed"]) == 12 == int(first["count"].sum())


def test_fractions_at_one_value_are_those_of_the_attractors_there():
    along = {"acceleration": [0.02, 0.2]}
    found = sb.studies.basin_fractions(MODEL, STRAIGHT, along=along, over=BOX, count=200, rng=4, periods=90)
    for value in along["acceleration"]:
        motion = sb.Harmonic.straight(acceleration=value, angular_frequency=1.8)
        alone = sb.studies.attractors(MODEL, motion, over=BOX, count=200, rng=4, periods=90)
        here = found.sel(acceleration=value)
        counts = dict(zip(found["attractor_name"].values, here["count"].values, strict=True))
        expected = dict(zip(alone["attractor_name"].values, alone["count"].values, strict=True))
        assert {name: count for name, count in counts.items() if count} == expected
        assert int(here["unsettled"]) == int(alone["unsettled"])
    np.testing.assert_allclose(found["fraction"].sum("attractor_index"), 1.0, rtol=1e-12)


def test_strobed_states_are_measured_in_free_rolling_at_the_frequency_of_each_value():
    scales = [
        sb.studies.basin_fractions(
            MODEL, STRAIGHT, along={name: [value]}, over={"tilt_x": (0.2, 0.3)}, count=1, duration=30.0
        )
        for name, value in (("angular_frequency", 2.0), ("slenderness", 0.2), ("size", 4.0), ("damping", 0.2))
    ]
    assert all(found["attractor_name"].values.tolist() == ["overturned"] for found in scales)


@pytest.mark.parametrize(
    "motion", [STRAIGHT, STRAIGHT.rotated(0.1), 2.0 * STRAIGHT, STRAIGHT.delayed(0.3)], ids=["itself", "r", "s", "d"]
)
def test_the_units_of_strobed_states_are_those_of_the_harmonic_within(motion):
    for name, value in (("angular_frequency", 3.6), ("slenderness", 0.2), ("size", 4.0), ("damping", 0.3)):
        assert scales_at(MODEL, motion, name, value) == scales_at(MODEL, STRAIGHT, name, value)
    assert scales_at(MODEL, motion, "angular_frequency", 3.6).period == pytest.approx(2.0 * np.pi / 3.6, rel=1e-14)
    assert scales_at(MODEL, motion, "size", 4.0) == OrbitScales.of(
        replace(MODEL, column=MODEL.column.resized(4.0)), motion
    )
    assert scales_at(MODEL, None, "tilt_x", 0.1) == OrbitScales.of(MODEL, None)


def test_an_interrupted_study_keeps_and_labels_what_was_computed():
    def stop(done, total):
        del total
        if done >= 1:
            raise KeyboardInterrupt

    # More starts than a chunk holds.
    over = {"tilt_x": np.linspace(0.11, 0.2, 60), "tilt_y": np.linspace(0.0, 0.1, 50)}
    with pytest.raises(Interrupted) as caught:
        sb.studies.basins(MODEL, over=over, duration=50.0, progress=stop)
    partial = caught.value.partial
    assert partial.attrs["kind"] == "basins"
    computed = int(partial["computed"])
    assert 0 < computed < 3000
    assert (partial["attractor"].values == -1).sum() == 3000 - computed
    assert sb.plot(partial).legends


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"over": {"tilt_x": [0.0]}}, "over must name two starts"),
        ({"over": {"acceleration": [0.1], "tilt_x": [0.0]}}, "acceleration"),
        ({"over": {}}, "over must name starts"),
        ({"over": {"tilt_x": [0.0, 0.1, 0.2]}, "count": 3}, "tilt_x"),
        ({"confidence": 95.0}, "confidence"),
        ({"over": {"tilt_x": [], "tilt_y": [0.0]}}, r"over\['tilt_x'\] must have at least one value, got none"),
        ({"over": {"tilt_x": (0.0, 0.1)}, "count": 0}, "count must be a whole number of at least 1"),
    ],
)
def test_bad_input_is_named(change, message):
    arguments = {"over": {"tilt_x": [0.2], "tilt_y": [0.0]}, "duration": 30.0} | change
    with pytest.raises(ParameterError, match=message):
        sb.studies.basins(MODEL, STRAIGHT, **arguments)


@pytest.mark.parametrize(
    ("along", "message"),
    [
        ({"acceleration": [0.1], "damping": [0.1]}, "along must name one"),
        ({"acceleration": []}, "at least one value"),
        ({"tilt_x": [0.1]}, "along and over must differ"),
        ({"loudness": [0.1]}, "^along: loudness is not known here; known are tilt_x, .*duration, .*damping"),
    ],
)
def test_a_parameter_to_go_along_is_one(along, message):
    with pytest.raises(ParameterError, match=message):
        sb.studies.basin_fractions(MODEL, STRAIGHT, along=along, over=BOX, count=2, duration=30.0)
