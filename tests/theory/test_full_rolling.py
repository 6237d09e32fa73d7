"""Steady rolling at finite tilt with free twist: nothing is missed, limits, stability by integration."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from tests.theory.turning_frame import free_twist_rates, full_rolling_rates

from stylobate import theory
from stylobate.errors import ParameterError
from stylobate.theory import finite_tilt

SOLID = {"inertia_ratio": 0.75, "axial_ratio": 0.5}


def state_of(found, branch, nu):
    return np.array([0.0, nu, found.amplitude[branch], found.phase[branch], found.spin[branch]])


@pytest.mark.slow
@given(
    c=st.floats(0.01, 1.0), nu=st.floats(0.2, 8.0), a=st.floats(0.05, 5.0), eta=st.floats(1e-3, 2.0),
    zeta=st.one_of(st.floats(1e-2, 10.0), st.just(math.inf)), kappa=st.floats(0.1, 0.6), axial=st.floats(0.1, 1.0),
)  # fmt: skip
def test_the_branches_are_where_nothing_changes_and_their_number_is_even_or_odd(c, nu, a, eta, zeta, kappa, axial):
    at = {"c": c, "eta": eta, "zeta": zeta, "inertia_ratio": kappa, "axial_ratio": axial}
    found = theory.full_rolling(nu, a * c, **at)
    if abs(a - 1.0) > 1e-6:
        # The excess X² + Y² − a0² runs from c² − a0² at no tilt to infinity at π/2.
        assert found.exists.sum() % 2 == (a > 1.0)
    for branch in np.flatnonzero(found.exists):
        state = state_of(found, branch, nu)
        rates = full_rolling_rates(state, nu, a * c, **at)
        # Not better than the terms cancel: those of the tilt, and of the spin, which 1/I_a amplifies.
        zeta_or_0 = 0.0 if math.isinf(zeta) else zeta
        terms = (1.0 + nu**2) * (1.0 + a + abs(state[4])) * (1.0 + zeta_or_0) * (1.0 + eta / state[2])
        assert np.abs(rates).max() <= 1e-12 * terms / (kappa * axial * min(1.0, c) * (1.0 - kappa))


@pytest.mark.slow
def test_nothing_is_missed_without_damping():
    # Where the spin is given, X ∓ a0 is a quartic in tan(A/2) over (1 + tan²)² p: five values give all its zeros.
    rng, most = np.random.default_rng(4), 0
    nodes = np.linspace(-0.9, 0.8, 5)
    for number in range(150):
        kappa = rng.uniform(0.05, 0.9)
        c = 10.0 ** rng.uniform(-2.0, 0.3)
        axial = rng.uniform(0.05, 1.0) * min(1.0, 2.0 * (1.0 - kappa) / kappa / c**2)
        nu, a0, spin = 10.0 ** rng.uniform(-1, 1), c * 10.0 ** rng.uniform(-2, 1), 3.0 * rng.normal()
        if number == 0:  # a case with four
            c, kappa, axial, nu, a0, spin = 1.87822, 0.084543, 0.508536, 6.93993, 2.3045, 4.63626
        shape = {"inertia_ratio": kappa, "axial_ratio": axial}
        found = theory.full_rolling(nu, a0, c=c, eta=0.0, zeta=0.0, spin=spin, **shape)
        expected = []
        for side in (1.0, -1.0):
            values = [
                (1.0 + t * t) ** 2
                * tilting(2.0 * math.atan(t), nu, side * a0, spin, c, kappa, axial)
                for t in nodes
            ]  # fmt: skip
            roots = np.roots(np.linalg.solve(np.vander(nodes, 5), values))
            real = roots[np.abs(roots.imag) < 1e-9 * np.abs(roots)].real
            expected += [2.0 * math.atan(t) for t in real if 0.0 < t < 1.0]
        most = max(most, len(expected))
        np.testing.assert_allclose(found.amplitude[found.exists], sorted(expected), rtol=1e-6)
        np.testing.assert_array_equal(found.spin[found.exists], spin)
        np.testing.assert_array_equal(np.abs(np.sin(found.phase[found.exists])) < 1e-12, True)
    assert most == 4


def tilting(tilt, nu, push, spin, c, kappa, axial):
    """The balance of tilting times −1, from the rolling equations."""
    s, cosine = math.sin(tilt), math.cos(tilt)
    p = cosine + c * s
    w = c * spin - nu * s
    gyroscopic = (1.0 - kappa) * nu**2 * s * cosine - kappa * axial * c**2 * nu * s * spin
    return c * cosine - s + p * push + kappa * p * nu * w - gyroscopic


def test_a_finer_scan_finds_no_more(monkeypatch):
    rng = np.random.default_rng(6)
    c, kappa = 10.0 ** rng.uniform(-3.0, 0.2, 400), rng.uniform(0.05, 0.95, 400)
    shape = {"inertia_ratio": kappa, "axial_ratio": rng.uniform(0.05, 1.0, 400) * np.minimum(1.0, (1 - kappa) / c**2)}
    nu, a0 = 10.0 ** rng.uniform(-1.0, 1.5, 400), c * 10.0 ** rng.uniform(-2.0, 1.5, 400)
    eta, zeta = 10.0 ** rng.uniform(-3.0, 0.7, 400), 10.0 ** rng.uniform(-3.0, 2.0, 400)

    def solve():
        return [
            theory.full_rolling(nu, a0, c=c, eta=eta, zeta=zeta, **shape),
            theory.wobbling_rolling(nu, a0, c=c, eta=eta, **shape),
        ]

    coarse = solve()
    monkeypatch.setattr(finite_tilt, "_POINTS", 1500)
    for found, finer in zip(coarse, solve(), strict=True):
        assert set(found.exists.sum(axis=-1)) == {0, 1, 2}
        np.testing.assert_allclose(found.amplitude, finer.amplitude, rtol=1e-9)


@pytest.mark.parametrize("zeta", [0.1, 1.0, math.inf])
def test_small_tilts_give_the_slender_column_with_an_error_of_order_c_squared(zeta):
    nu, a, eta = 1.7, 0.65, 0.1
    c = np.array([0.02, 0.01, 0.005])
    full = theory.full_rolling(nu, a * c, c=c, eta=eta, zeta=zeta)
    slender = theory.free_twist_rolling(nu, a * c, c=c, eta=eta, zeta=zeta)
    upper = full.amplitude.shape[-1] - 1
    pairs = [
        (full.amplitude[:, upper] / c, slender.amplitude / c),
        (full.phase[:, upper], slender.phase),
        (full.spin[:, upper], slender.spin),
        (full.friction_moment[:, upper] / c, slender.friction_moment / c),
        (ordered(full.eigenvalues[:, upper]), ordered(slender.eigenvalues)),
    ]
    for finite, limit in pairs:
        off = np.abs(finite - limit).reshape(3, -1).max(axis=1)
        assert np.all(np.abs(np.log2(off[:-1] / off[1:]) - 2.0) < 0.05)
    np.testing.assert_array_equal(full.stable[:, upper], slender.stable)


def ordered(eigenvalues):
    finite = np.where(np.isfinite(eigenvalues), eigenvalues, 0.0)
    return np.array([row[np.argsort(row.imag)] for row in finite])


def test_the_rates_at_small_tilts_are_those_of_the_slender_column():
    # At 1e-3 the tilt leaves a relative error of order 1e-6, and the slopes of the spin one over c less.
    c, at = 1e-3, {"eta": 0.2, "zeta": 0.3, "inertia_ratio": 0.6, "axial_ratio": 0.9}
    state = np.array([0.4 * c, 1.7, 0.8 * c, 0.4, -0.3])
    full = full_rolling_rates(state, 2.0, 0.7 * c, c=c, **at)
    slender = free_twist_rates(state, 2.0, 0.7 * c, c=c, **at)
    np.testing.assert_allclose(full, slender, rtol=1e-5)


def test_the_energy_of_free_rolling_is_conserved():
    c, kappa, axial = 0.3, 0.7, 0.5
    at = {"c": c, "eta": 0.0, "zeta": 0.0, "inertia_ratio": kappa, "axial_ratio": axial}

    def energy(state):
        mu, omega, tilt, _, spin = state
        w1, i_a = -omega * np.sin(tilt), kappa * axial * c**2
        return 0.5 * (
            (1.0 + kappa * c**2) * mu**2 + kappa * (c * spin + w1) ** 2 + (1.0 - kappa) * w1**2 + i_a * spin**2
        ) + np.cos(tilt) + c * np.sin(tilt)  # fmt: skip

    run = solve_ivp(
        lambda _, x: full_rolling_rates(x, 0.0, 0.0, **at), (0.0, 20.0), [0.1, 1.2, 0.2, 0.0, 0.4],
        "DOP853", rtol=1e-11, atol=1e-13,
    )  # fmt: skip
    assert np.ptp(run.y[2]) > 0.05
    np.testing.assert_allclose(energy(run.y), energy(run.y[:, 0]), rtol=1e-9)


@pytest.mark.parametrize(("nu", "zeta", "stable"), [(1.5, 0.1, True), (1.2, 1.0, False)])
def test_deviations_grow_and_decay_as_the_eigenvalues_say(nu, zeta, stable):
    at = {"c": 0.1, "eta": 0.1, "zeta": zeta}
    found = theory.full_rolling(nu, 0.065, **at)
    branch = int(np.flatnonzero(found.exists)[-1])
    assert bool(found.stable[branch]) is stable
    values = found.eigenvalues[branch]
    slowest = values[values.real.argmax()]
    start = state_of(found, branch, nu)
    small = 1e-7 * start[2]
    period = 2.0 * math.pi / abs(slowest.imag) if slowest.imag else 5.0
    settle = 0.0 if not stable else 60.0
    times = [settle + 40.0, settle + 40.0 + period]
    run = solve_ivp(
        lambda _, x: full_rolling_rates(x, nu, 0.065, **at), (0.0, times[-1]),
        start + small * np.array([0.0, 0.0, 1.0, 0.0, 0.0]), "DOP853", t_eval=times, rtol=1e-12, atol=1e-15,
    )  # fmt: skip
    first, second = (run.y - start[:, None]).T
    assert math.log(np.linalg.norm(second) / np.linalg.norm(first)) == pytest.approx(slowest.real * period, rel=0.02)


def test_known_numbers():
    found = theory.full_rolling([1.2, 1.5, 3.0], 0.065, c=0.1, eta=0.1, zeta=0.1)
    np.testing.assert_allclose(found.amplitude[:, -1], [0.03774127, 0.02634683, 0.0074953], rtol=2e-6)
    np.testing.assert_array_equal(found.stable, [[False, True]] * 3)


def test_damping_without_spin_damping_leaves_no_steady_rolling():
    found = theory.full_rolling(2.0, 0.065, c=0.1, eta=0.1, zeta=0.0)
    assert found.amplitude.shape == (1,)
    assert not found.exists.any()
    assert np.isnan(found.amplitude).all()


def test_spin_damping_alone_forbids_rotation_about_the_vertical():
    found = theory.full_rolling(2.0, 0.065, c=0.3, eta=0.0, zeta=[0.2, math.inf])
    tilt = found.amplitude
    np.testing.assert_allclose(found.spin, -2.0 * np.sin(tilt) * np.tan(tilt), rtol=1e-14)
    np.testing.assert_array_equal(np.cos(found.phase).round(12), [[-1.0, 1.0]] * 2)
    np.testing.assert_array_equal(found.friction_moment, 0.0)


def test_many_at_once_are_as_one_by_one():
    rng = np.random.default_rng(2)
    nu, a0, eta = rng.uniform(0.5, 4.0, 4500), rng.uniform(0.01, 0.3, 4500), rng.choice([0.0, 0.1], 4500)
    every = theory.full_rolling(nu.reshape(45, 100), a0.reshape(45, 100), c=0.1, eta=eta.reshape(45, 100), zeta=0.5)
    assert every.eigenvalues.shape == (45, 100, 2, 5)
    for i in (0, 17, 4321, 4499):
        one = theory.full_rolling(nu[i], a0[i], c=0.1, eta=eta[i], zeta=0.5)
        count = one.exists.sum()
        np.testing.assert_array_equal(every.amplitude[divmod(i, 100)][:count], one.amplitude[one.exists])


@pytest.mark.parametrize(("change", "told"), [({"zeta": -0.1}, "zeta"), ({"spin": math.nan}, "spin")])
def test_bad_numbers_are_refused_by_name(change, told):
    with pytest.raises(ParameterError, match=told):
        theory.full_rolling(**({"nu": 2.0, "a0": 0.05, "c": 0.1, "eta": 0.1, "zeta": 0.1} | change))
