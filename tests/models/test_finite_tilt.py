"""What the levels at finite tilt share: sine and cosine, the equation of the tilt, and the tilt of no return."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import fsolve

import stylobate as sb
from stylobate.models import finite_tilt
from stylobate.models.finite_tilt import (
    cosine,
    no_return_tilt,
    planar_acceleration,
    potential,
    sine_over_angle,
    tilt_acceleration,
)

EPS = float(np.finfo(float).eps)
C, KAPPA = 0.2, 0.73
numbers = st.floats(-0.5, 0.5)


@given(tilt=st.floats(0.0, math.pi / 2.0))
def test_sine_and_cosine_are_right_to_rounding_up_to_a_right_angle(tilt):
    assert tilt * sine_over_angle(tilt**2) == pytest.approx(math.sin(tilt), rel=0.0, abs=2.0 * EPS)
    assert cosine(tilt**2) == pytest.approx(math.cos(tilt), rel=0.0, abs=2.0 * EPS)


@given(tilt=st.floats(math.pi / 2.0, 2.3))
def test_beyond_a_right_angle_they_lose_a_digit_only(tilt):
    # The terms left out: θ^23/23! and θ^22/22!.
    left = EPS + tilt**22 / math.factorial(22)
    assert tilt * sine_over_angle(tilt**2) == pytest.approx(math.sin(tilt), abs=2.0 * left)
    assert cosine(tilt**2) == pytest.approx(math.cos(tilt), abs=2.0 * left)


@given(
    tilt=st.floats(0.0, 1.4), moment=numbers, rate=numbers, across=numbers, weight=st.floats(0.5, 1.5),
    arm=st.floats(0.0, 0.3),
)  # fmt: skip
def test_tilt_and_normal_force_solve_their_two_equations(tilt, moment, rate, across, weight, arm):
    sine, cos = math.sin(tilt), math.cos(tilt)
    acceleration, normal, drag = tilt_acceleration(moment, rate, across, sine, cos, weight, C, KAPPA, arm)
    height, slope = cos + C * sine, C * cos - sine
    turning = math.sqrt(rate**2 + across**2 + finite_tilt.FADING**2)
    assert drag == pytest.approx(C * arm * normal / turning, rel=1e-12, abs=1e-15)
    assert (1.0 + KAPPA * C**2) * acceleration == pytest.approx(moment - drag * rate, abs=1e-14)
    assert normal == pytest.approx(weight + KAPPA * (slope * acceleration - height * rate**2), abs=1e-14)


@given(tilt=st.floats(1e-3, 1.4), rate=numbers, ax=numbers, az=numbers, side=st.sampled_from([1.0, -1.0]))
def test_a_motion_in_a_plane_is_the_same_on_both_sides_of_the_upright(tilt, rate, ax, az, side):
    one = planar_acceleration(tilt, rate, 1.0, ax, az, C, 0.1, KAPPA, 0.02)
    other = planar_acceleration(side * tilt, side * rate, side, side * ax, az, C, 0.1, KAPPA, 0.02)
    assert other == pytest.approx((side * one[0], one[1], one[2]), rel=1e-14, abs=1e-15)


@given(tilt=st.floats(1e-3, 1.4))
def test_potential_is_the_work_of_the_moment_of_the_weight(tilt):
    # d/dθ of the height of the centre of mass is z' = c cos θ − sin θ.
    step = 1e-5
    slope = (potential(np.array(tilt + step), C) - potential(np.array(tilt - step), C)) / (2.0 * step)
    assert float(slope) == pytest.approx(C * math.cos(tilt) - math.sin(tilt), abs=1e-9)


@given(
    a=st.floats(0.0, 1.0), az=st.floats(-0.5, 0.0), share=st.floats(1e-6, 1.0), heading=st.floats(0.0, 6.3),
    turning=numbers,
)  # fmt: skip
def test_beyond_the_tilt_of_no_return_no_acceleration_turns_a_growing_tilt_back(a, az, share, heading, turning):
    # Rolling about the rim without spin drives the tilt outwards too.
    limit = no_return_tilt(a, az, C)
    column = sb.Column.dimensionless(C, KAPPA, 0.4)
    tilt = limit + share * (math.pi / 2.0 - limit)
    model = sb.Wobbling(column)
    _, _, along, _ = model.rates(
        tilt, 0.0, 0.0, turning * tilt, a * math.cos(heading), a * math.sin(heading), az, *model.parameters
    )
    assert along + tilt * turning**2 > 0.0  # θ̈


def test_the_tilt_of_no_return_is_sharp():
    a, az = 0.4, -0.3
    limit = no_return_tilt(a, az, C)
    balanced, _, _ = planar_acceleration(limit, 0.0, 1.0, a, az, C, 0.0, KAPPA, 0.0)
    assert balanced == pytest.approx(0.0, abs=1e-15)
    tipping = fsolve(lambda tilt: planar_acceleration(tilt[0], 0.0, 1.0, 0.0, 0.0, C, 0.0, KAPPA, 0.0)[0], [0.3])
    assert no_return_tilt(0.0, 0.0, C) == pytest.approx(tipping[0], rel=1e-12)


@pytest.mark.parametrize("az", [-1.0, -1.5])
def test_without_weight_nothing_is_certain(az):
    assert no_return_tilt(0.1, az, C) == math.inf


def test_a_column_that_lies_does_not_come_back():
    # 1/c times gravity across the lean would raise it from anywhere else.
    assert no_return_tilt(1.01 / C, 0.0, C) == math.pi / 2.0
    assert no_return_tilt(0.99 / C, 0.0, C) < math.pi / 2.0
