"""Where steady rolling with a free twist is stable: against eigenvalues, in its limits, and where it is lost again."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import brentq

from stylobate import theory
from stylobate.errors import ParameterError
from stylobate.theory import free_twist_critical_frequency, free_twist_upper_frequency
from stylobate.theory.free_twist import DampedColumn, characteristic

C = 0.1
EPS = float(np.finfo(float).eps)

bodies = st.tuples(st.floats(0.3, 0.95), st.floats(0.05, 2.0))
frictions = st.tuples(st.floats(1e-3, 1.0), st.floats(1e-2, 30.0))


def named(friction, body):
    return {"c": C, "eta": friction[0], "zeta": friction[1], "inertia_ratio": body[0], "axial_ratio": body[1]}


def growth(nu, a, column):
    return float(theory.free_twist_rolling(nu, a * C, **column).eigenvalues.real.max())


@given(nu=st.floats(0.3, 6.0), a=st.floats(0.1, 3.0), friction=frictions, body=bodies)
def test_the_polynomial_is_that_of_the_jacobian(nu, a, friction, body):
    column = named(friction, body)
    found = theory.free_twist_rolling(nu, a * C, **column)
    if not found.exists:
        return
    polynomial = [
        1.0,
        *characteristic(nu, C / float(found.amplitude), DampedColumn(*map(np.asarray, (*friction, *body)))),
    ]
    expected = np.poly(found.eigenvalues).real
    scale = np.poly(-np.abs(found.eigenvalues))  # what the symmetric functions are sums of
    # Eigenvalues are off by rounding of the largest entry of the Jacobian, which 1/A and 1/c make large.
    np.testing.assert_allclose(polynomial, expected, atol=1e-8 * float(scale.max()), rtol=0.0)


def test_known_critical_frequencies():
    found = free_twist_critical_frequency(0.065, c=C, eta=0.1, zeta=[math.inf, 1.0, 0.1])
    np.testing.assert_allclose(found, [1.3971, 1.3674, 1.0344], atol=5e-5)


@pytest.mark.slow
@given(a=st.floats(0.5, 10.0), friction=frictions, body=bodies)  # rolling exists at all frequencies
def test_the_largest_eigenvalue_leaves_the_left_half_plane_there(a, friction, body):
    column = named(friction, body)
    nu = float(free_twist_critical_frequency(a * C, **column))
    found = theory.free_twist_rolling(nu, a * C, **column)
    largest = found.eigenvalues[np.argmax(found.eigenvalues.real)]
    assert abs(largest.real) < 1e-8 * np.abs(found.eigenvalues).max()
    assert abs(largest.imag) > 1e-3  # a pair, not a real one
    assert growth(nu * 0.999, a, column) > 0.0 > growth(nu * 1.001, a, column)


@pytest.mark.slow
@given(a=st.floats(0.01, 30.0), friction=frictions, body=bodies)
def test_rolling_is_stable_from_the_critical_to_the_upper_frequency_and_not_beyond(a, friction, body):
    column = named(friction, body)
    low, high = (
        float(free_twist_critical_frequency(a * C, **column)),
        float(free_twist_upper_frequency(a * C, **column)),
    )
    if math.isnan(low):
        return
    nu = np.geomspace(low * 1.0001, min(high * 0.9999, 50.0 * low), 200)
    found = theory.free_twist_rolling(nu, a * C, **column)
    assert np.all(found.stable | ~found.exists)
    if math.isfinite(high):
        assert not theory.free_twist_rolling(high * np.array([1.001, 2.0]), a * C, **column).stable.any()


@pytest.mark.slow
@given(a=st.floats(0.05, 10.0), eta=st.floats(0.0, 1.0), body=bodies)
def test_infinite_spin_damping_gives_the_critical_frequency_of_the_paper(a, eta, body):
    column = named((eta, math.inf), body)
    held = free_twist_critical_frequency(a * C, **column)
    np.testing.assert_array_equal(held, theory.critical_frequency(a * C, c=C, eta=eta))
    assert free_twist_upper_frequency(a * C, **column) == math.inf


def test_the_paper_s_is_reached_as_one_over_zeta():
    zeta = np.array([1e3, 1e4, 1e5])
    off = free_twist_critical_frequency(0.065, c=C, eta=0.1, zeta=zeta) - theory.critical_frequency(0.065, c=C, eta=0.1)
    np.testing.assert_allclose(off[:-1] / off[1:], 10.0, rtol=0.02)


@given(a=st.floats(0.05, 10.0), zeta=st.floats(0.05, 20.0), body=bodies)
def test_without_damping_it_is_the_same_for_every_column(a, zeta, body):
    # The determinant has the factor x − 2: A = c/2 there.
    found = free_twist_critical_frequency(a * C, **named((0.0, zeta), body))
    assert float(found) == pytest.approx(math.sqrt(1.0 + 2.0 * a), rel=1e-12)


@pytest.mark.parametrize(
    ("a", "zeta", "body"), [(0.65, 0.3, (0.75, 0.5)), (1.5, 2.0, (0.6, 1.1)), (0.2, 1.0, (0.8, 0.3))]
)
def test_weak_damping_lowers_it_in_proportion(a, zeta, body):
    eta = np.array([1e-4, 1e-5])
    freedom = 1.0 + body[1] - body[0]
    axial_share = body[1] / freedom
    slope = (1.0 + a) * zeta / (a * (1.0 + 2.0 * a) * (1.0 - axial_share)) + a / (freedom * zeta)
    slope += (
        (1.0 + a) * (1.0 + axial_share) * (1.0 + a - axial_share * a) / ((1.0 + 2.0 * a) * (1.0 - axial_share) * zeta)
    )
    column = {"c": C, "zeta": zeta, "inertia_ratio": body[0], "axial_ratio": body[1]}
    off = free_twist_critical_frequency(a * C, eta=eta, **column) ** 2 - (1.0 + 2.0 * a - slope * eta)
    np.testing.assert_allclose(off[0] / off[1], 100.0, rtol=0.02)


@pytest.mark.parametrize("product", [0.03, 0.3, 3.0])
def test_weak_damping_and_strong_spin_damping_count_by_their_product(product):
    a, kappa, axial, zeta = 0.65, 0.75, 0.5, 1e4
    rho = product * (1.0 + axial - kappa) / (1.0 - kappa)

    def balance(square):
        m = a * (1.0 + square) / (1.0 + a)
        paper = (3.0 * square - 1.0 - m) ** 2 - 4.0 * (1.0 + square) * m
        return 2.0 * square * m**2 * (square - 1.0 - m) + rho * (m + rho) * paper

    limit = math.sqrt(brentq(balance, 1.4, 1.0 + 2.0 * a))
    assert float(theory.undamped_critical_frequency(a * C, c=C)) < limit < math.sqrt(1.0 + 2.0 * a)
    # Off by the friction that is left, η = product/ζ.
    found = free_twist_critical_frequency(a * C, **named((product / zeta, zeta), (kappa, axial)))
    assert float(found) == pytest.approx(limit, abs=10.0 * product / zeta)


def test_it_falls_as_the_root_of_a_small_spin_damping():
    # ν² = y ζD/η, where y is the root of a quartic's Hurwitz determinant.
    a, eta, kappa, axial = 0.65, 0.1, 0.75, 0.5
    freedom = 1.0 + axial - kappa
    epsilon, axial_share = kappa / freedom, axial / freedom

    def determinant(y):
        m = a * (1.0 + y) / (1.0 + a)
        b2 = 2.0 * y - 1.0 + eta**2 * (1.0 + epsilon) - axial_share * m
        b3 = (1.0 + epsilon) * (y - 1.0) - axial_share * m
        return (2.0 + epsilon) * b2 * b3 - b3**2 - (2.0 + epsilon) ** 2 * axial_share * m

    zeta = np.array([1e-5, 1e-6])
    limit = np.sqrt(brentq(determinant, 1.2, 10.0) * zeta * freedom / eta)
    off = free_twist_critical_frequency(a * C, c=C, eta=eta, zeta=zeta) / limit - 1.0
    assert abs(off[1]) < 1e-4
    assert off[0] / off[1] == pytest.approx(10.0, rel=0.05)


@given(
    a=st.floats(0.01, 100.0),
    friction=st.tuples(st.floats(1e-3, 3.0), st.floats(1e-4, 10.0)),
    kappa=st.floats(0.1, 0.98),
)
def test_a_body_no_slimmer_than_2_kappa_minus_1_stays_stable(a, friction, kappa):
    axial = max(2.0 * kappa - 1.0, 0.01) * (1.0 + 4.0 * EPS)
    assert free_twist_upper_frequency(a * C, **named(friction, (kappa, axial))) == math.inf


@pytest.mark.parametrize(("a", "body"), [(0.65, (0.75, 0.1)), (2.0, (0.9, 0.5)), (0.1, (0.6, 0.15))])
def test_a_slimmer_one_loses_it_again_where_spin_damping_is_small(a, body):
    column = {"c": C, "eta": 0.1, "inertia_ratio": body[0], "axial_ratio": body[1]}
    limit = math.sqrt((1.0 + a + body[1]) / (2.0 * body[0] - 1.0 - body[1]))
    off = free_twist_upper_frequency(a * C, zeta=np.array([1e-5, 1e-6]), **column) / limit - 1.0
    assert 0.0 < off[1] < 1e-3
    assert off[0] / off[1] == pytest.approx(10.0, rel=0.05)
    assert free_twist_upper_frequency(a * C, zeta=1.0, **column) == math.inf


def test_nothing_where_there_is_nothing():
    # No spin damping; no motion of the base; an amplitude below the start of the curve.
    found = free_twist_critical_frequency([0.065, 0.0, 0.001], c=C, eta=0.1, zeta=[0.0, 1.0, 1.0])
    assert np.isnan(found).all()
    assert free_twist_critical_frequency(np.full((2, 1), 0.065), c=C, eta=0.1, zeta=[0.1, 1.0, 2.0]).shape == (2, 3)
    assert free_twist_critical_frequency(np.empty(0), c=C, eta=0.1, zeta=1.0).shape == (0,)


@pytest.mark.parametrize(
    ("change", "told"), [({"zeta": -1.0}, "zeta"), ({"c": 0.0}, "c"), ({"axial_ratio": 0.0}, "axial")]
)
def test_bad_numbers_are_refused_by_name(change, told):
    with pytest.raises(ParameterError, match=told):
        free_twist_critical_frequency(0.065, **({"c": C, "eta": 0.1, "zeta": 0.1} | change))
