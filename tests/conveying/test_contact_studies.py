"""What a column that can slip does over two parameters, and where a vibrating base walks it to."""

import json
import math

import numpy as np
import pytest

import stylobate as sb
from stylobate.config.study import study_of
from stylobate.conveying import Transport
from stylobate.conveying.transport import half_width
from stylobate.results import ContactClass
from stylobate.results.run_rows import column_rows

C = 0.1
COLUMN = sb.Column.dimensionless(slenderness=C)
LINE = sb.Harmonic.straight(acceleration=0.2, angular_frequency=2.0)


@pytest.fixture(scope="module")
def found():
    over = {"friction_coefficient": [0.03, 0.07, 0.2, 0.5], "acceleration": [0.02, 0.05, 0.09, 0.12, 0.5]}
    return sb.studies.overturning_map(sb.Sliding(COLUMN), LINE, over=over, periods=5.0)


def test_what_moves_first_decides_between_staying_sliding_and_tipping(found):
    classes = found["contact_class"]
    for friction in classes["friction_coefficient"].values:
        for acceleration in classes["acceleration"].values:
            first = sb.theory.start_of_motion(acceleration, c=C, friction=friction)
            kind = int(classes.sel(friction_coefficient=friction, acceleration=acceleration))
            moves = float(first.amplitude) <= 1.0
            if not moves:
                assert kind == ContactClass.STAYS
            elif first.first == sb.theory.FirstMotion.SLIDE:
                assert kind == ContactClass.SLIDES
            else:
                assert kind in (ContactClass.ROCKS, ContactClass.SLIDES_AND_ROCKS, ContactClass.OVERTURNS)


def test_counts_are_those_of_the_classes(found):
    assert found["count"].sum() == found["computed"] == found["outcome"].size
    assert found["count"].sel(class_name="slides") == (found["contact_class"] == ContactClass.SLIDES).sum()
    assert sb.plot(found).axes


def test_a_part_that_hops_is_upright_or_rocks_and_a_flat_landing_is_marked():
    pin = sb.Column.solid(radius=0.006, height=0.040, density=7850.0)
    part = sb.Sliding(pin, damping=0.05, normal_restitution=0.1)
    trough = sb.Harmonic.stroke(stroke=0.0006, frequency=50.0, angle=0.436)
    over = {"friction_coefficient": [0.2, 0.5], "stroke": [0.0003, 0.0006]}
    flat, askew = (sb.studies.overturning_map(part, trough, over=over, periods=30, tilt=(x, 0.0)) for x in (0.0, 1e-2))
    names = [[ContactClass(code).name for code in row] for row in flat["contact_class"].values]
    assert names[0] == ["SLIDES", "HOPS_UPRIGHT"]  # μ < c, throw number 0.64 and 1.28
    assert set(names[1]) == {"HOPS_AND_ROCKS"}  # μ > c
    np.testing.assert_array_equal(flat["lands_flat"], [[False, True], [False, False]])
    assert (askew["contact_class"] != ContactClass.HOPS_UPRIGHT).all()
    assert not askew["lands_flat"].any()
    assert len(sb.plot(flat).axes) == 3  # classes, peak tilt and its scale


def test_a_friction_coefficient_that_equals_the_slenderness_is_told():
    squat = sb.Column.dimensionless(slenderness=0.3)
    for over in ({"friction_coefficient": [0.2, 0.3]}, {"slenderness": [0.5, 0.4]}):
        given = {**over, "acceleration": [0.1]}
        with pytest.warns(sb.errors.UnlikelyInputWarning, match="friction coefficient equals the slenderness"):
            sb.studies.overturning_map(sb.Sliding(squat, friction_coefficient=0.5), LINE, over=given, periods=2.0)
    equal = sb.simulate(sb.Sliding(squat, friction_coefficient=0.3), LINE, duration=2.0)
    assert any("equals the slenderness c = 0.3" in line for line in equal.warnings)


def test_a_map_of_contacts_needs_a_contact_that_slips():
    with pytest.raises(sb.errors.UnsupportedError, match="model rolling assumes permanent contact"):
        sb.studies.overturning_map(
            sb.Rolling(COLUMN), LINE, least_share=0.1, over={"acceleration": [1.0], "damping": [0.1]}, periods=2.0
        )
    with pytest.raises(sb.errors.UnsupportedError, match="model slender assumes permanent contact"):
        sb.conveying.drift(sb.Slender(COLUMN), LINE, over={"acceleration": [1.0]})


def test_a_block_creeps_down_a_shaken_slope_at_the_speed_of_theory():
    incline, frequency = 0.1, 3.0
    squat = sb.Column.solid(radius=1.5, height=2.0, density=1000.0)
    model = sb.Sliding(squat, friction_coefficient=0.2, incline=incline, incline_direction=math.pi)
    shaking = sb.Harmonic.straight(acceleration=squat.gravity, angular_frequency=frequency)
    amplitudes = np.array([0.05, 0.3, 0.6, 1.2])
    drifting = sb.conveying.drift(
        model, shaking, over={"acceleration": amplitudes * squat.gravity}, periods=30.0, late=10, rtol=1e-9
    )
    theory = sb.theory.mean_block_speed(amplitudes, static_friction=0.2, incline=incline) * squat.gravity / frequency
    np.testing.assert_allclose(drifting["mean_velocity"].sel(axis="x"), theory, rtol=1e-6, atol=1e-9)
    np.testing.assert_allclose(drifting["mean_velocity"].sel(axis="y"), 0.0, atol=1e-9)
    assert drifting["transport_speed"][0] == 0.0
    assert sb.plot(drifting).axes


def test_bad_questions_are_told():
    model = sb.Sliding(COLUMN)
    with pytest.raises(sb.errors.ParameterError, match="over must name one or two parameters"):
        sb.conveying.drift(model, LINE, over={})
    with pytest.raises(sb.errors.ParameterError, match="periods must be at least one more than late"):
        sb.conveying.drift(model, LINE, over={"acceleration": [0.1]}, periods=10.0, late=20)
    with pytest.raises(sb.errors.ParameterError, match="least_share must lie between 0 and 1"):
        sb.studies.overturning_map(
            model, LINE, over={"acceleration": [0.1], "friction_coefficient": [0.1]}, periods=2.0, least_share=1.5
        )


@pytest.mark.parametrize(("friction", "line"), [(0.05, "slides above"), (0.2, "uplifts above")])
def test_the_acceleration_in_a_summary_is_that_of_the_first_motion(friction, line):
    model = sb.Sliding(COLUMN, friction_coefficient=friction)
    (_, (name, value)) = column_rows(COLUMN, model.rest_capacity)
    assert name == line
    assert float(value.split()[0]) == pytest.approx(min(friction, C) * COLUMN.gravity, rel=1e-4)


PIN = sb.Column.solid(radius=0.006, height=0.040, density=7850.0)
FEEDER = sb.Harmonic.stroke(stroke=0.0012, frequency=50.0, angle=0.436)


def test_strobed_footprints_are_those_of_the_run():
    part = sb.Sliding(PIN, friction_coefficient=0.2)
    motion = sb.Harmonic.stroke(stroke=0.0003, frequency=50.0, angle=0.436, start_phase=1.0)
    runs = sb.simulate_ensemble(part, motion, tilt=np.array([[0.0, 0.0], [0.01, 0.002]]), duration=0.1, strobes=4)
    first = (-1.0 / (2.0 * math.pi) % 1.0) * motion.period
    times = first + motion.period * np.arange(5)
    for place, tilt in enumerate([(0.0, 0.0), (0.01, 0.002)]):
        alone = sb.simulate(part, motion, tilt=tilt, duration=0.1).sample(times[-4:])
        # Chaos enlarges the rounding of the two recordings, dense output and stop, over a few impacts.
        np.testing.assert_allclose(runs["strobe_footprint"][place], alone["footprint"], atol=1e-9)
        np.testing.assert_allclose(runs["strobe_twist"][place], alone["twist"], atol=1e-6)


def test_the_interval_of_a_mean_covers_it_as_often_as_its_confidence_says():
    # An autoregressive series of mean 0: means of long batches are nearly independent.
    draws = np.random.default_rng(1).normal(size=(2000, 400))
    series = draws.copy()
    for k in range(1, series.shape[1]):
        series[:, k] += 0.5 * series[:, k - 1]
    covered = np.mean([abs(one.mean()) <= half_width(one, 0.9) for one in series])
    assert covered == pytest.approx(0.92, abs=0.03)  # the correlation of ten means only widens the interval
    assert half_width(np.ones(40), 0.9) == 0.0
    assert math.isnan(half_width(np.ones(3), 0.9))
    # A motion over two periods has equal batches.
    assert half_width(np.tile([1.0, 3.0], 20), 0.9) == 0.0


def test_a_chaotic_drift_is_repeated_until_its_speed_is_known_and_agrees_with_a_long_run():
    part = sb.Sliding(PIN, friction_coefficient=0.2, normal_restitution=0.3)
    over = {"start_phase": [0.0, 1.0]}
    short = sb.conveying.drift(part, FEEDER, over=over, tolerance=None)
    known = sb.conveying.drift(part, FEEDER, over=over, tolerance=0.03)
    assert (short["periods_computed"] == pytest.approx(60.0)).all()
    assert (known["periods_computed"] >= 120.0 - 1e-9).all()
    assert (known["transport"] == Transport.KNOWN).all()
    half = known["speed_high"] - known["transport_speed"]
    assert (half <= 0.03 * known["transport_speed"]).all()
    long = sb.conveying.drift(part, FEEDER, over={"start_phase": [0.5]}, periods=3000, late=2900, tolerance=None)
    # Three half-widths of 90 % intervals are about five standard errors.
    assert (np.abs(known["transport_speed"] - float(long["transport_speed"][0])) <= 3.0 * half).all()
    assert "strobe_tilt" not in known


def test_a_periodic_drift_is_known_at_once_with_its_bits():
    part = sb.Sliding(PIN, friction_coefficient=0.2)
    over = {"stroke": [0.0003, 0.0006]}
    plain, refined = (sb.conveying.drift(part, FEEDER, over=over, tolerance=one) for one in (None, 0.02))
    np.testing.assert_array_equal(plain["mean_velocity"], refined["mean_velocity"])
    assert (refined["periods_computed"] == pytest.approx(60.0)).all()
    assert (refined["transport"] == Transport.KNOWN).all()


def test_beyond_the_friction_angle_a_part_accelerates_and_has_no_mean_velocity():
    weak = sb.Harmonic.stroke(stroke=0.0003, frequency=50.0, angle=0.3)
    steep = sb.Sliding(PIN, friction_coefficient=0.2, incline=0.22)  # tan 0.22 = 0.224
    found = sb.conveying.drift(steep, weak, over={"friction_coefficient": [0.2, 0.25]}, periods=30)
    assert [Transport(code).name for code in found["transport"].values] == ["ACCELERATES", "KNOWN"]
    assert np.isnan(found["mean_velocity"][0]).all()
    assert found["periods_computed"][0] == pytest.approx(30.0)
    speed = sb.theory.mean_block_speed(1.0, 0.2, static_friction=0.2, incline=0.22)
    assert np.isinf(speed)


def test_a_contact_map_is_shown_and_repeated_with_its_least_share():
    over = {"friction_coefficient": [0.05, 0.2], "acceleration": [0.05, 0.3]}
    found = sb.studies.overturning_map(sb.Sliding(COLUMN), LINE, over=over, periods=2.0, least_share=0.6)
    study = study_of(sb.studies.overturning_map)
    assert study.completed(found, None, {}).identical(found)
    described = sb.config.study_config(sb.studies.overturning_map).of_saved(json.loads(found.attrs["provenance"]), over)
    assert described.build().options["least_share"] == found.attrs["least_share"] == 0.6
