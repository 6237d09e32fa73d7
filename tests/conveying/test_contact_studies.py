"""What a column that can slip does over two parameters, and where a vibrating base walks it to."""

import math

import numpy as np
import pytest

import stylobate as sb
from stylobate.conveying import ContactClass

C = 0.1
COLUMN = sb.Column.dimensionless(slenderness=C)
LINE = sb.Harmonic.straight(acceleration=0.2, angular_frequency=2.0)


@pytest.fixture(scope="module")
def found():
    over = {"friction_coefficient": [0.03, 0.07, 0.2, 0.5], "acceleration": [0.02, 0.05, 0.09, 0.12, 0.5]}
    return sb.conveying.contact_map(sb.Sliding(COLUMN), LINE, over=over, periods=5.0)


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


def test_a_map_of_contacts_needs_a_contact_that_slips():
    with pytest.raises(sb.errors.UnsupportedError, match="model rolling assumes permanent contact"):
        sb.conveying.contact_map(sb.Rolling(COLUMN), LINE, over={"acceleration": [1.0], "damping": [0.1]}, periods=2.0)
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
        sb.conveying.contact_map(
            model, LINE, over={"acceleration": [0.1], "friction_coefficient": [0.1]}, periods=2.0, least_share=1.5
        )
