"""Rolling whose twist is free: balances, limits, linearisation, and integration in the fixed frame."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from tests.theory.turning_frame import free_twist_rates

from stylobate import theory
from stylobate.errors import ParameterError
from stylobate.theory.free_twist import free_twist_jacobian

C = 0.1
SOLID = {"inertia_ratio": 0.75, "axial_ratio": 0.5}
EPS = float(np.finfo(float).eps)


def fixed_frame(tau, state, nu, a0, eta, zeta, kappa, i_a):
    """The equations in the frame of the base, tilt vector in units of c: an independent way to write them."""
    q, v, spin = state[:2], state[2:4], state[4]
    size = math.hypot(*q)
    u = q / size
    n = np.array([-u[1], u[0]])
    push = a0 * np.array([math.cos(nu * tau), math.sin(nu * tau)])
    across, freedom = push @ n, 1.0 + i_a - kappa
    turning = (q[0] * v[1] - q[1] * v[0]) / size**2
    rate = q - u - push + n * across * (1.0 - kappa) / freedom - kappa * spin * turning * u
    rate = rate - eta * ((v @ u) * u + (1.0 + i_a) / freedom * (v @ n) * n) - kappa * zeta * spin * n
    spin_up = across * (1.0 - kappa) / (kappa * freedom) - eta / freedom * (v @ n) - zeta * spin
    return [*v, *rate, spin_up]


def on_the_orbit(found, nu):
    """The state at τ = 0 in the fixed frame."""
    size, psi = float(found.amplitude) / C, float(found.phase)
    lean = size * np.array([math.cos(psi), math.sin(psi)])
    return np.array([*lean, -nu * lean[1], nu * lean[0], float(found.spin)])


bodies = st.tuples(st.floats(0.3, 0.95), st.floats(0.05, 2.0))


@given(nu=st.floats(0.5, 6.0), a=st.floats(0.1, 3.0), eta=st.floats(0.0, 0.5), zeta=st.floats(1e-2, 10.0), body=bodies)
def test_steady_rolling_is_where_nothing_changes(nu, a, eta, zeta, body):
    shape = dict(zip(SOLID, body, strict=True))
    found = theory.free_twist_rolling(nu, a * C, c=C, eta=eta, zeta=zeta, **shape)
    if not found.exists:
        return
    state = [0.0, nu, float(found.amplitude), float(found.phase), float(found.spin)]
    rates = free_twist_rates(state, nu, a * C, c=C, eta=eta, zeta=zeta, **shape)
    largest = (1.0 + nu**2) * (1.0 + a + abs(float(found.spin))) * (1.0 + zeta) / (shape["inertia_ratio"])
    scale = np.array([C, 1.0 / float(found.amplitude) * C, 1.0, 1.0, 1.0 / (1.0 + body[1] - body[0])])
    assert np.all(np.abs(rates) <= 1e3 * EPS * largest * np.maximum(scale, 1.0))


@pytest.mark.parametrize("body", [(0.75, 0.5), (0.6, 1.1)])
def test_the_moving_frame_says_what_the_fixed_frame_says(body):
    shape = dict(zip(SOLID, body, strict=True))
    nu, a0, eta, zeta = 2.3, 0.8, 0.2, 0.3
    state = np.array([0.4, 0.2, 0.1, 0.35, 0.3])
    size, azimuth = math.hypot(*state[:2]), math.atan2(state[1], state[0])
    u, n = state[:2] / size, np.array([-state[1], state[0]]) / size
    moving = [C * state[2:4] @ u, state[2:4] @ n / size, C * size, azimuth, state[4]]
    mu, omega, *_, spin = free_twist_rates(moving, nu, C * a0, c=C, eta=eta, zeta=zeta, **shape)
    *_, ax, ay, spin_up = fixed_frame(0.0, state, nu, a0, eta, zeta, *body)
    along, across = np.array([ax, ay]) @ u, np.array([ax, ay]) @ n
    assert mu / C == pytest.approx(along + size * moving[1] ** 2, rel=1e-13)
    assert omega == pytest.approx((across - 2.0 * moving[0] / C * moving[1]) / size, rel=1e-13)
    assert spin == pytest.approx(spin_up, rel=1e-13)


def test_known_numbers():
    found = theory.free_twist_rolling(3.0, 0.65 * C, c=C, eta=0.1, zeta=0.1)
    assert float(found.amplitude) / C == pytest.approx(0.07498, abs=5e-6)
    assert float(found.spin) == pytest.approx(-0.39991, abs=5e-6)


@pytest.mark.slow
def test_integration_from_elsewhere_settles_on_it():
    # The slowest deviation decays as exp(-0.0254 τ): by a factor 4e-7 here.
    nu, a0, eta, zeta = 3.0, 0.65, 0.1, 0.1
    found = theory.free_twist_rolling(nu, a0 * C, c=C, eta=eta, zeta=zeta)
    start = on_the_orbit(theory.free_twist_rolling(nu, a0 * C, c=C, eta=eta, zeta=math.inf), nu)
    periods = 280
    run = solve_ivp(
        fixed_frame, (0.0, periods * 2.0 * math.pi / nu), start, "DOP853", rtol=1e-9, atol=1e-11,
        args=(nu, a0, eta, zeta, *SOLID.values()),
    )  # fmt: skip
    slowest = float(found.eigenvalues.real.max())
    left = math.exp(slowest * run.t[-1])
    np.testing.assert_allclose(run.y[:, -1], on_the_orbit(found, nu), atol=5.0 * left + 1e-7)


def test_without_spin_damping_the_tilt_dies():
    nu, a0, eta = 3.0, 0.65, 0.1
    start = on_the_orbit(theory.free_twist_rolling(nu, a0 * C, c=C, eta=eta, zeta=math.inf), nu)
    dies = lambda _, state, *__: math.hypot(state[0], state[1]) - 1e-4  # noqa: E731
    dies.terminal = True
    run = solve_ivp(
        fixed_frame, (0.0, 200.0), start, "DOP853", rtol=1e-9, atol=1e-11, events=dies,
        args=(nu, a0, eta, 0.0, *SOLID.values()),
    )  # fmt: skip
    assert run.t[-1] == pytest.approx(51.6, abs=0.1)
    assert run.y[4, -1] == pytest.approx(-0.724, abs=2e-3)
    assert not theory.free_twist_rolling(nu, a0 * C, c=C, eta=eta, zeta=0.0).exists


@given(nu=st.floats(0.5, 6.0), a=st.floats(0.1, 3.0), eta=st.floats(0.0, 0.5))
def test_infinite_spin_damping_gives_the_column_that_cannot_turn(nu, a, eta):
    held = theory.free_twist_rolling(nu, a * C, c=C, eta=eta, zeta=math.inf)
    paper = theory.steady_rolling(nu, a * C, c=C, eta=eta).upper
    assert bool(held.exists) is bool(paper.exists)
    if held.exists:
        assert float(held.amplitude) == pytest.approx(float(paper.amplitude), rel=1e-13)
        assert float(held.phase) == pytest.approx(float(paper.phase), abs=1e-13)
        assert float(held.spin) == 0.0
        if eta > 1e-3:
            assert bool(held.stable) is bool(paper.stable) or abs(held.eigenvalues[:4].real.max()) < 1e-9


@pytest.mark.parametrize("nu", [1.2, 1.5, 3.0])
def test_the_limit_is_reached_as_one_over_zeta(nu):
    at = {"c": C, "eta": 0.1}
    zeta = np.array([1e2, 1e3, 1e4])
    paper = theory.steady_rolling(nu, 0.065, **at).upper
    found = theory.free_twist_rolling(nu, 0.065, zeta=zeta, **at)
    off = np.abs(found.amplitude - paper.amplitude)
    np.testing.assert_allclose(off[:-1] / off[1:], 10.0, rtol=0.02)
    slow = found.eigenvalues[-1][np.argsort(found.eigenvalues[-1].real)][1:]
    assert slow.real.max() == pytest.approx(paper.eigenvalues.real.max(), abs=1e-2)


def test_without_damping_it_is_the_paper_s_and_neutrally_stable():
    found = theory.free_twist_rolling(3.0, 0.065, c=C, eta=0.0, zeta=0.0)
    paper = theory.steady_rolling(3.0, 0.065, c=C, eta=0.0).upper
    assert float(found.amplitude) == pytest.approx(float(paper.amplitude), rel=1e-14)
    assert float(found.spin) == 0.0
    assert found.stable


def test_the_jacobian_is_the_derivative_of_the_rates():
    at = {"c": C, "eta": 0.2, "zeta": 0.3, "inertia_ratio": 0.6, "axial_ratio": 0.9}
    state = np.array([0.03, 1.7, 0.06, 0.4, -0.3])
    exact = free_twist_jacobian(state, 0.07, **at)
    step = 1e-6
    for j in range(5):
        off = np.zeros(5)
        off[j] = step
        ends = [free_twist_rates(state + sign * off, 2.0, 0.07, **at) for sign in (1.0, -1.0)]
        # Second-order differences: step² times third derivatives, and rounding over the step.
        np.testing.assert_allclose((ends[0] - ends[1]) / (2.0 * step), exact[:, j], rtol=1e-6, atol=1e-7)


def test_spin_damping_steadies_rolling_below_the_critical_frequency_of_the_paper():
    # Without twist rolling is unstable at ν = 1.2 < 1.397; with a free one it leans less and is stable.
    at = {"c": C, "eta": 0.1}
    assert not theory.steady_rolling(1.2, 0.065, **at).upper.stable
    found = theory.free_twist_rolling(1.2, 0.065, zeta=[0.1, 1.0], **at)
    np.testing.assert_array_equal(found.stable, [True, False])


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"zeta": -0.1}, "zeta"),
        ({"zeta": math.nan}, "zeta"),
        ({"inertia_ratio": 1.0}, "inertia_ratio = m h²/J0 must be below 1"),
        ({"axial_ratio": 0.0}, "axial_ratio"),
    ],
)
def test_bad_numbers_are_refused_by_name(change, told):
    with pytest.raises(ParameterError, match=told):
        theory.free_twist_rolling(3.0, 0.065, **({"c": C, "eta": 0.1, "zeta": 0.1} | change))
