"""The two backbones, and free rocking in a plane."""

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from stylobate.errors import ParameterError
from stylobate.theory import planar_backbone, planar_free_motion, planar_free_period, rolling_backbone

EPS = np.finfo(float).eps
positive = st.floats(0.01, 100.0)


@given(omega=positive, c=positive)
def test_rolling_backbone_balances_weight_and_centrifugal_force(omega, c):
    tilt = rolling_backbone(omega, c)
    assert tilt * (1.0 + omega**2) == pytest.approx(c, rel=4 * EPS)


def test_planar_backbone_is_the_printed_formula():
    with mpmath.workdps(40):
        for omega in (0.05, 0.3, 1.0, 7.0, 500.0):
            printed = 1 - 1 / mpmath.cosh(mpmath.pi / (2 * mpmath.mpf(omega)))
            assert planar_backbone(omega, 1.0) == pytest.approx(float(printed), rel=8 * EPS)


@given(omega=st.floats(0.3, 1000.0), c=positive)
def test_planar_period_inverts_the_backbone(omega, c):
    # near A0 = c the period depends on c − A0: the error is eps · c/(c − A0), which is below 200 eps at ω = 0.3
    assert planar_free_period(planar_backbone(omega, c), c) == pytest.approx(2.0 * np.pi / omega, rel=1e3 * EPS)


def test_planar_period_is_nan_where_the_column_does_not_come_back():
    assert np.isnan(planar_free_period([0.1, 0.2], 0.1)).all()


def test_planar_motion_agrees_with_integration_of_the_equation_through_two_passages():
    c, amplitude = 0.1, 0.06
    period = float(planar_free_period(amplitude, c))

    def rates(_, y, side):
        return [y[1], y[0] - side * c]

    def upright(_, y, _side):
        return y[0]

    upright.terminal = True
    tau, state = 0.0, [amplitude, 0.0]
    for side in (1.0, -1.0, 1.0):
        upright.direction = -side
        run = solve_ivp(
            rates, [tau, tau + period], state, "DOP853", args=(side,), events=upright, rtol=1e-12, atol=1e-15
        )
        alpha, rate = planar_free_motion(run.t[:-1], amplitude, c)
        assert alpha == pytest.approx(run.y[0, :-1], abs=1e-12)
        assert rate == pytest.approx(run.y[1, :-1], abs=1e-12)
        tau, state = run.t[-1], [0.0, run.y[1, -1]]


def test_planar_motion_changes_sides_each_half_period_and_conserves_energy():
    c, amplitude = 0.1, 0.07
    period = planar_free_period(amplitude, c)
    tau = np.linspace(-1.7, 2.3, 2001) * period
    alpha, rate = planar_free_motion(tau, amplitude, c)
    opposite, opposite_rate = planar_free_motion(tau + 0.5 * period, amplitude, c)
    assert opposite == pytest.approx(-alpha, abs=1e-14)
    assert opposite_rate == pytest.approx(-rate, abs=1e-14)
    energy = 0.5 * rate**2 + c * np.abs(alpha) - 0.5 * alpha**2
    assert energy == pytest.approx(np.full_like(tau, c * amplitude - 0.5 * amplitude**2), abs=1e-16)


def test_arguments_broadcast():
    assert planar_backbone(np.ones((3, 1)), np.full(4, 0.1)).shape == (3, 4)
    assert rolling_backbone(np.ones((3, 1)), np.full(4, 0.1)).shape == (3, 4)
    assert planar_free_motion(np.zeros((3, 1)), np.full(4, 0.01), 0.1)[0].shape == (3, 4)


@pytest.mark.parametrize("function", [rolling_backbone, planar_backbone])
def test_a_bad_value_in_an_array_is_named(function):
    with pytest.raises(ParameterError, match=r"^c must be positive, got -2.0$"):
        function([1.0, 2.0], [0.1, -2.0])
    with pytest.raises(ParameterError, match="omega must be"):
        function(np.nan, 0.1)
    with pytest.raises(ParameterError, match="omega must be a real number"):
        function("fast", 0.1)
