"""The critical frequency and what happens there."""

import numpy as np
import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import brentq

from stylobate.theory import (
    critical_amplitude,
    critical_frequency,
    crossing_frequency,
    first_lyapunov_coefficient,
    modulated_rolling,
    steady_rolling,
    undamped_critical_frequency,
)
from stylobate.theory.averaging import rotating_frame_jacobian
from stylobate.theory.lyapunov import _Expansion
from stylobate.theory.rolling import rolling_gap

C = 0.1


def growth(nu, a0, eta):
    """Largest real part of the eigenvalues of the Jacobian, and the imaginary part that belongs to it."""
    upper = steady_rolling(nu, a0, c=C, eta=eta).upper
    jacobian = rotating_frame_jacobian([0.0, nu, float(upper.amplitude), float(upper.phase)], a0, eta=eta)
    eigenvalues = np.linalg.eigvals(jacobian)
    largest = eigenvalues[np.argmax(eigenvalues.real)]
    return largest.real, abs(largest.imag)


def test_published_critical_frequencies():
    # ten digits are published
    assert critical_frequency([0.02, 0.065], c=C, eta=0.1) == pytest.approx([0.9813080177, 1.3971075892], abs=1e-10)
    assert crossing_frequency([0.02, 0.065], c=C, eta=0.1) == pytest.approx([0.8872, 1.3598], abs=5e-5)
    assert undamped_critical_frequency([0.02, 0.065], c=C) == pytest.approx([0.99162, 1.40046], abs=5e-6)
    assert np.isnan(critical_frequency(0.01, c=C, eta=0.3))


@pytest.mark.parametrize(
    ("a0", "eta"), [(0.02, 0.1), (0.065, 0.1), (0.065, 0.3), (0.065, 0.5), (0.065, 1.0), (1.0, 0.2), (0.3, 5.0)]
)
def test_agrees_with_the_sign_change_of_the_eigenvalues(a0, eta):
    nu = float(critical_frequency(a0, c=C, eta=eta))
    found = brentq(lambda t: growth(t, a0, eta)[0], nu - 0.01, nu + 0.01, xtol=1e-14)
    assert nu == pytest.approx(found, abs=1e-11)
    assert float(crossing_frequency(a0, c=C, eta=eta)) == pytest.approx(growth(nu, a0, eta)[1], rel=1e-9)


@given(nu=st.floats(0.58, 50.0), eta=st.floats(0.0, 30.0))
def test_amplitude_and_frequency_invert_each_other(nu, eta):
    a0 = critical_amplitude(nu, c=C, eta=eta)
    assert critical_frequency(a0, c=C, eta=eta) == pytest.approx(nu, rel=1e-11)


@given(a0=st.floats(1e-6, 100.0))
def test_without_damping_it_has_the_closed_form(a0):
    closed = undamped_critical_frequency(a0, c=C)
    assert critical_frequency(a0, c=C, eta=0.0) == pytest.approx(closed, rel=1e-13)


def test_undamped_limits():
    assert undamped_critical_frequency(0.0, c=C) == pytest.approx(1.0 / np.sqrt(3.0), rel=1e-15)
    # far away a0 → c ν²/2
    assert undamped_critical_frequency(1e10, c=1.0) == pytest.approx(np.sqrt(2e10), rel=1e-4)


@pytest.mark.parametrize("eta", [0.0, 0.01, 0.1, 1.0, 2.0, 10.0, 100.0])
def test_critical_amplitude_rises_with_frequency(eta):
    amplitude = critical_amplitude(np.geomspace(0.005, 100.0, 20001), c=C, eta=eta)
    defined = np.isfinite(amplitude)
    assert (np.diff(defined.astype(int)) >= 0).all()
    assert (np.diff(amplitude[defined]) > 0.0).all()


def test_stability_on_a_grid_is_what_the_boundary_says():
    nu, a0, eta = np.meshgrid(np.linspace(0.3, 4.0, 60), np.geomspace(0.002, 0.5, 40), [0.05, 0.3, 1.0])
    upper = steady_rolling(nu, a0, c=C, eta=eta).upper
    boundary = critical_amplitude(nu, c=C, eta=eta)
    said = upper.exists & np.isfinite(boundary) & (a0 < boundary)
    assert (said == upper.stable).all()


@pytest.mark.parametrize("eta", [0.1, 0.5, 2.0])
def test_the_curve_begins_on_the_lower_fold(eta):
    nu = np.sqrt(2.0 / (2.0 + eta**2 + np.sqrt((2.0 + eta**2) ** 2 + 12.0))) * (1.0 + 1e-12)
    a0 = critical_amplitude(nu, c=C, eta=eta)
    low, _ = rolling_gap(a0, c=C, eta=eta)
    assert low == pytest.approx(nu, rel=1e-9)
    # Ω² = q/2 vanishes linearly there
    assert crossing_frequency(a0, c=C, eta=eta) < 1e-4
    assert np.isnan(critical_frequency(0.999 * a0, c=C, eta=eta))


def test_first_lyapunov_coefficient_is_negative():
    values = first_lyapunov_coefficient(
        np.geomspace(0.005, 5.0, 40), c=C, eta=np.geomspace(0.01, 5.0, 20)[:, np.newaxis]
    )
    assert np.isfinite(values).mean() > 0.5
    assert np.nanmax(values) < 0.0


def test_first_lyapunov_coefficient_depends_on_the_amplitude_ratio_only():
    ours = first_lyapunov_coefficient([0.02, 0.065], c=C, eta=0.1)
    assert first_lyapunov_coefficient([0.2, 0.65], c=1.0, eta=0.1) == pytest.approx(ours, rel=1e-11)
    assert np.isnan(first_lyapunov_coefficient([0.02, 0.0001], c=C, eta=[0.0, 0.1])).all()


def test_second_and_third_derivatives_by_algebra():
    mu, omega, tilt, psi, a, c, eta, nu = names = sp.symbols("mu omega A psi a c eta nu")
    rates = [
        tilt * (1 + omega**2) - c - eta * mu - a * sp.cos(psi),
        -2 * mu * omega / tilt - eta * omega + a / tilt * sp.sin(psi),
    ]
    state = names[:4]
    values = {mu: 0.0, omega: 1.3, tilt: 0.6, psi: 0.4, a: 0.7, c: 1.0, eta: 0.2, nu: 1.3}
    flow = _Expansion(
        nu=np.array(1.3), tilt=np.array(0.6), push=np.array(0.7 * np.cos(0.4)), drive=np.array(0.7 * np.sin(0.4))
    )
    x, y, z = np.random.default_rng(1).normal(size=(3, 4)) + 1j * np.random.default_rng(2).normal(size=(3, 4))
    for row, rate in enumerate(rates):
        second = sum(
            complex(sp.diff(rate, u, v).subs(values)) * x[i] * y[j]
            for i, u in enumerate(state)
            for j, v in enumerate(state)
        )
        third = sum(
            complex(sp.diff(rate, u, v, w).subs(values)) * x[i] * y[j] * z[k]
            for i, u in enumerate(state)
            for j, v in enumerate(state)
            for k, w in enumerate(state)
        )
        assert flow.second(x, y)[row] == pytest.approx(second, rel=1e-12)
        assert flow.third(x, y, z)[row] == pytest.approx(third, rel=1e-12)
    assert (flow.second(x, y)[2:] == 0.0).all()


def test_modulated_rolling_just_below_has_the_size_that_the_coefficient_predicts():
    """Normal form ż = (σ + iΩ)z + Ω l1 |z|²z: its cycle has |z|² = −σ/(Ω l1) and the deviations 2 Re(zq), |q| = 1."""
    a0, eta = 0.65, 0.1
    nu = float(critical_frequency(a0, c=1.0, eta=eta)) - 1e-4
    upper = steady_rolling(nu, a0, c=1.0, eta=eta).upper
    frequency = crossing_frequency(a0, c=1.0, eta=eta)
    size = np.sqrt(-upper.eigenvalues.real.max() / (frequency * first_lyapunov_coefficient(a0, c=1.0, eta=eta)))
    steady = [0.0, nu, float(upper.amplitude), float(upper.phase)]
    values, vectors = np.linalg.eig(rotating_frame_jacobian(steady, a0, eta=eta))
    swing = 2.0 * size * abs(vectors[2, np.argmax(values.imag)])
    tilt = modulated_rolling(nu, a0, c=1.0, eta=eta, points=31).amplitude
    # the next order of the normal form is relatively of the order of the size squared, 4e-4
    assert 2.0 * abs(np.fft.rfft(tilt)[1]) / tilt.size == pytest.approx(swing, rel=0.01)
