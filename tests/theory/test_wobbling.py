"""Steady rolling of the column that only tilts: balances, the paper's column as limit, stability, energy."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from tests.theory.turning_frame import wobbling_rates

from stylobate import theory


@given(c=st.floats(0.01, 1.0), nu=st.floats(0.2, 8.0), a=st.floats(0.05, 5.0), eta=st.floats(0.0, 2.0))
def test_the_branches_are_where_nothing_changes(c, nu, a, eta):
    found = theory.wobbling_rolling(nu, a * c, c=c, eta=eta, inertia_ratio=0.6)
    for tilt, phase in zip(found.amplitude[found.exists], found.phase[found.exists], strict=True):
        rates = wobbling_rates([0.0, nu, tilt, phase], nu, a * c, c=c, eta=eta, inertia_ratio=0.6)
        assert np.abs(rates).max() <= 1e-12 * (1.0 + nu**2) * (1.0 + a) * (1.0 + eta) * (1.0 + c / tilt)


def test_small_tilts_give_the_paper_s_column_with_an_error_of_order_c_squared():
    nu, a, eta = 1.7, 0.65, 0.1
    c = np.array([0.02, 0.01, 0.005])
    wobbling = theory.wobbling_rolling(nu, a * c, c=c, eta=eta)
    paper = theory.steady_rolling(nu, a * c, c=c, eta=eta)
    for branch, limit in ((0, paper.lower), (1, paper.upper)):
        off = np.abs(wobbling.amplitude[:, branch] / limit.amplitude - 1.0)
        assert np.all(np.abs(np.log2(off[:-1] / off[1:]) - 2.0) < 0.05)
        off = np.abs(wobbling.phase[:, branch] - limit.phase)
        assert np.all(np.abs(np.log2(off[:-1] / off[1:]) - 2.0) < 0.05)
        growth = wobbling.eigenvalues[:, branch].real.max(axis=-1) - limit.eigenvalues.real.max(axis=-1)
        assert np.all(np.abs(np.log2(growth[:-1] / growth[1:]) - 2.0) < 0.05)
        np.testing.assert_array_equal(wobbling.stable[:, branch], limit.stable)
    np.testing.assert_allclose(wobbling.friction_moment[:, 1] / c, eta * nu * paper.upper.amplitude / c, rtol=1e-3)


def test_rolling_becomes_stable_near_the_critical_frequency_of_the_paper():
    # A bisection for the frequency of gained stability, which lies above the paper's by a part of the order c².
    shifts = []
    for c in (0.1, 0.2):
        low, high = 1.2, 1.6
        for _ in range(40):
            middle = 0.5 * (low + high)
            stable = theory.wobbling_rolling(middle, 0.65 * c, c=c, eta=0.1).stable[-1]
            low, high = (low, middle) if stable else (middle, high)
        shifts.append(high - float(theory.critical_frequency(0.65 * c, c=c, eta=0.1)))
    assert shifts[0] == pytest.approx(0.0019, abs=1e-4)
    assert shifts[1] / shifts[0] == pytest.approx(4.0, abs=0.2)


def test_free_wobbling_conserves_its_energy_and_its_moment_of_momentum():
    c, kappa, axial = 0.3, 0.7, 0.5

    def rates(_, state):
        return wobbling_rates(state, 0.0, 0.0, c=c, eta=0.0, inertia_ratio=kappa, axial_ratio=axial)

    run = solve_ivp(rates, (0.0, 20.0), [0.1, 1.2, 0.2, 0.0], "DOP853", rtol=1e-11, atol=1e-13)
    mu, omega, tilt, _ = run.y
    inertia = (
        kappa * (np.sin(tilt) + c * (1.0 - np.cos(tilt))) ** 2
        + (1.0 - kappa) * np.sin(tilt) ** 2
        + kappa * axial * c**2 * (1.0 - np.cos(tilt)) ** 2
    )
    energy = 0.5 * (1.0 + kappa * c**2) * mu**2 + 0.5 * inertia * omega**2 + np.cos(tilt) + c * np.sin(tilt)
    assert np.ptp(tilt) > 0.05
    np.testing.assert_allclose(energy, energy[0], rtol=1e-9)
    np.testing.assert_allclose(inertia * omega, inertia[0] * omega[0], rtol=1e-9)


def test_it_settles_on_the_stable_branch():
    nu, a0, at = 1.6, 0.065, {"c": 0.1, "eta": 0.1}
    found = theory.wobbling_rolling(nu, a0, **at)
    slowest = found.eigenvalues[1].real.max()
    assert slowest < 0.0
    start = [0.0, nu, 1.02 * found.amplitude[1], found.phase[1]]
    span = np.log(1e-6) / slowest
    run = solve_ivp(lambda _, x: wobbling_rates(x, nu, a0, **at), (0.0, span), start, "DOP853", rtol=1e-10, atol=1e-12)
    np.testing.assert_allclose(run.y[2:, -1], [found.amplitude[1], found.phase[1]], atol=1e-6)


def test_without_damping_and_base_motion_it_rolls_by_itself_with_any_phase():
    found = theory.wobbling_rolling(1.3, 0.0, c=0.1, eta=[0.0, 0.1])
    assert found.amplitude.shape == (2, 1)
    np.testing.assert_array_equal(found.exists, [[True], [False]])
    assert found.amplitude[0, 0] == pytest.approx(float(theory.rolling_backbone(1.3, 0.1)), rel=5e-3)  # c² = 0.01
