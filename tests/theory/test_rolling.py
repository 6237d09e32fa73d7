"""Steady rolling on a circularly moving base: the solution, the folds, the stability."""

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp

from stylobate.errors import ParameterError
from stylobate.theory import rolling_backbone, steady_rolling
from stylobate.theory.averaging import rotating_frame_jacobian, rotating_frame_rates
from stylobate.theory.rolling import rolling_gap

C = 0.1
NU = np.linspace(0.05, 10.0, 300)[:, np.newaxis, np.newaxis]
A0 = np.array([1e-4, 0.004, 0.02, 0.065, 0.0999999, 0.1, 0.2])[:, np.newaxis]
ETA = np.array([0.0, 0.1, 0.5, 2.0])
ROLLING = steady_rolling(NU, A0, c=C, eta=ETA)
BRANCHES = pytest.mark.parametrize("branch", [ROLLING.upper, ROLLING.lower], ids=["upper", "lower"])


def states(branch, nu=NU):
    return np.stack(np.broadcast_arrays(0.0 * branch.amplitude, nu, branch.amplitude, branch.phase))


@BRANCHES
def test_solves_the_equations_to_rounding(branch):
    rates = rotating_frame_rates(states(branch), NU, A0, c=C, eta=ETA)
    assert np.nanmax(np.abs(rates[0])) < 1e-14
    assert np.nanmax(np.abs(rates[1] * branch.amplitude)) < 1e-14


@BRANCHES
def test_eigenvalues_are_those_of_the_jacobian(branch):
    # two nearly equal roots split by the root of the rounding error, hence the tolerance
    jacobian = rotating_frame_jacobian(states(branch), A0, eta=ETA)[branch.exists]
    expected, ours = np.linalg.eigvals(jacobian), branch.eigenvalues[branch.exists]
    distance = np.abs(expected[:, :, np.newaxis] - ours[:, np.newaxis, :])
    scale = np.abs(ours).max(axis=-1)
    assert (distance.min(axis=1).max(axis=-1) / scale).max() < 1e-7
    assert (distance.min(axis=2).max(axis=-1) / scale).max() < 1e-7


@BRANCHES
def test_routh_hurwitz_agrees_with_the_eigenvalues(branch):
    jacobian = rotating_frame_jacobian(states(branch), A0, eta=ETA)
    friction = branch.exists & (ETA > 0.0)
    growth = np.linalg.eigvals(jacobian[friction]).real.max(axis=-1)
    clear = np.abs(growth) > 1e-9
    assert clear.mean() > 0.99
    assert ((growth < 0.0) == branch.stable[friction])[clear].all()


def test_without_damping_stable_means_that_all_eigenvalues_are_imaginary():
    free = ROLLING.upper.exists & (ETA == 0.0)
    growth = ROLLING.upper.eigenvalues.real.max(axis=-1)[free]
    assert (growth[ROLLING.upper.stable[free]] == 0.0).all()
    assert (growth[~ROLLING.upper.stable[free]] > 0.0).all()


def test_lower_branch_is_a_saddle_with_one_unstable_direction():
    lower = ROLLING.lower
    assert not lower.stable.any()
    unstable = (lower.eigenvalues.real > 0.0).sum(axis=-1)[lower.exists & (ETA > 0.0)]
    assert (unstable == 1).all()


def test_q_and_p0_give_the_characteristic_polynomial():
    upper = ROLLING.upper
    x, k = C / np.where(upper.exists, upper.amplitude, 1.0), 1.0 + NU**2
    q, p0 = 2.0 * NU**2 - 2.0 + x, k * (k - x) + (ETA * NU) ** 2
    coefficients = np.stack(np.broadcast_arrays(1.0, 2.0 * ETA, ETA**2 + q, ETA * q, p0), axis=-1)
    for place in zip(*np.nonzero(upper.exists), strict=True):
        expected = np.poly(upper.eigenvalues[place]).real
        assert coefficients[place] == pytest.approx(expected, rel=1e-9, abs=1e-9 * np.abs(expected).max())


def symbols():
    return sp.symbols("s nu eta A", positive=True)


def test_characteristic_polynomial_is_a_quadratic_in_s_squared_plus_eta_s():
    s, nu, eta, tilt = symbols()
    omega, mu, psi, a0, c = sp.symbols("omega mu psi a0 c")
    rates = sp.Matrix(
        [
            tilt * (1 + omega**2) - c - eta * mu - a0 * sp.cos(psi),
            -2 * mu * omega / tilt - eta * omega + a0 / tilt * sp.sin(psi),
            mu,
            omega - nu,
        ]
    )
    steady = {a0 * sp.cos(psi): tilt * (1 + nu**2) - c, a0 * sp.sin(psi): eta * nu * tilt}
    jacobian = rates.jacobian([mu, omega, tilt, psi]).subs({mu: 0, omega: nu}).subs(steady)
    x, u, k = c / tilt, s**2 + eta * s, 1 + nu**2
    q, p0 = 2 * nu**2 - 2 + x, k * (k - x) + eta**2 * nu**2
    assert sp.simplify((s * sp.eye(4) - jacobian).det() - (u**2 + q * u + p0)) == 0


def test_hopf_condition_is_a_quadratic_in_the_slenderness_ratio():
    _, nu, eta, x = symbols()
    k, w = 1 + nu**2, 4 * nu**2 + eta**2
    q, p0 = 2 * nu**2 - 2 + x, k * (k - x) + eta**2 * nu**2
    assert sp.expand(q**2 + 2 * eta**2 * q - 4 * p0 - (x**2 + 2 * w * x - 4 * w)) == 0
    critical = 4 / (1 + sp.sqrt(1 + 4 / w))
    assert sp.simplify((x**2 + 2 * w * x - 4 * w).subs(x, critical)) == 0


def test_branches_lie_either_side_of_the_backbone_and_become_it_without_base_motion_and_friction():
    nu = np.linspace(0.1, 5.0, 50)
    free = steady_rolling(nu, 0.0, c=C, eta=0.0)
    assert free.upper.amplitude == pytest.approx(rolling_backbone(nu, C), rel=1e-15)
    assert free.lower.amplitude == pytest.approx(rolling_backbone(nu, C), rel=1e-15)
    driven = steady_rolling(nu, 0.05, c=C, eta=0.0)
    assert (driven.upper.amplitude > rolling_backbone(nu, C)).all()
    assert (driven.lower.amplitude < rolling_backbone(nu, C)).all()
    assert (driven.upper.phase == 0.0).all()
    assert (driven.lower.phase == np.pi).all()


@pytest.mark.parametrize(("a0", "eta"), [(0.01, 0.3), (0.02, 0.5), (1e-6, 0.1)])
def test_gap_ends_are_reciprocal_and_rolling_vanishes_between_them(a0, eta):
    low, high = rolling_gap(a0, c=C, eta=eta)
    assert low * high == pytest.approx(1.0, rel=1e-15)
    step = 1e-6
    inside, outside = np.array([low * (1 + step), high * (1 - step)]), np.array([low * (1 - step), high * (1 + step)])
    assert not steady_rolling(inside, a0, c=C, eta=eta).upper.exists.any()
    rolling = steady_rolling(outside, a0, c=C, eta=eta)
    assert rolling.upper.exists.all()
    assert rolling.lower.exists.all()
    d = (1 + outside**2) ** 2 + (eta * outside) ** 2
    fold = C * (1 + outside**2) / d
    assert rolling.upper.amplitude == pytest.approx(fold, rel=10 * np.sqrt(step))
    assert rolling.lower.amplitude == pytest.approx(fold, rel=10 * np.sqrt(step))


def test_published_gap():
    assert np.round(rolling_gap(0.01, c=C, eta=0.3), 3).tolist() == [0.385, 2.600]


def test_gap_closes_at_the_stated_amplitude():
    limit = 0.3 * C / np.sqrt(4.0 + 0.3**2)
    assert np.isfinite(rolling_gap(limit * 0.999999, c=C, eta=0.3)).all()
    assert np.isnan(rolling_gap([limit * 1.000001, 0.2, 5.0], c=C, eta=0.3)).all()
    assert np.isnan(rolling_gap([0.0, 0.1], c=C, eta=0.0)).all()
    assert [float(end) for end in rolling_gap(0.0, c=C, eta=0.3)] == [0.0, np.inf]


@pytest.mark.parametrize(("nu", "a0"), [(1.5, 0.065), (3.0, 0.065), (1.2, 0.02)])
def test_motion_started_on_the_stable_branch_stays_on_it(nu, a0):
    rolling = steady_rolling(nu, a0, c=C, eta=0.1).upper
    assert rolling.stable
    start = [0.0, nu, float(rolling.amplitude), float(rolling.phase)]
    run = solve_ivp(
        lambda _, y: rotating_frame_rates(y, nu, a0, c=C, eta=0.1),
        [0.0, 50.0 * 2.0 * np.pi / nu],
        start,
        "DOP853",
        rtol=1e-12,
        atol=1e-14,
    )
    assert np.abs(run.y.T - start).max() < 1e-11


def test_the_rotating_frame_is_the_equation_of_motion():
    nu, a0, eta = 1.3, 0.07, 0.2
    mu, omega, tilt, psi = 0.03, 0.8, 0.05, 0.4
    beta = psi  # at τ = 0
    lean, across = np.exp(1j * beta), 1j * np.exp(1j * beta)
    z, velocity = tilt * lean, mu * lean + tilt * omega * across
    acceleration = z - C * lean - eta * velocity - a0  # (1)
    rates = rotating_frame_rates([mu, omega, tilt, psi], nu, a0, c=C, eta=eta)
    assert rates[0] - tilt * omega**2 == pytest.approx((acceleration / lean).real, rel=1e-13)
    assert tilt * rates[1] + 2.0 * mu * omega == pytest.approx((acceleration / lean).imag, rel=1e-13)


def test_jacobian_is_the_derivative_of_the_rates():
    state, step = np.array([0.03, 0.8, 0.05, 0.4]), 1e-6
    jacobian = rotating_frame_jacobian(state, 0.07, eta=0.2)
    shifts = state[:, np.newaxis] + step * np.eye(4)
    back = state[:, np.newaxis] - step * np.eye(4)
    numerical = rotating_frame_rates(shifts, 1.3, 0.07, c=C, eta=0.2) - rotating_frame_rates(
        back, 1.3, 0.07, c=C, eta=0.2
    )
    # truncation: third derivatives grow like 1/A⁴ = 2e5, times step²
    assert jacobian == pytest.approx(numerical / (2.0 * step), abs=1e-5)


def test_user_mistakes_are_named():
    with pytest.raises(ParameterError, match=r"nu must be positive, got 0.0"):
        steady_rolling([1.0, 0.0], 0.1, c=C, eta=0.1)
    with pytest.raises(ParameterError, match=r"a0 must be zero or positive, got -0.1"):
        steady_rolling(1.0, -0.1, c=C, eta=0.1)
    with pytest.raises(ParameterError, match="four entries"):
        rotating_frame_rates([1.0, 2.0], 1.0, 0.1, c=C, eta=0.1)
