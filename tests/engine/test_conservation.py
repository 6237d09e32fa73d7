"""Energy and angular momentum along a run."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import stylobate as sb

C = 0.1


def model(damping=0.0):
    return sb.Slender(sb.Column.dimensionless(C), damping=damping)


def in_units_of_c(run, name):
    # J0 = κ and ω0 = 1 in a dimensionless column: the SI numbers are κ times those of the equations.
    return run.data[name].to_numpy() / 0.75 / C**2


def test_free_motion_conserves_energy_and_angular_momentum():
    # 100 swings between the turning points, each of which takes about half of 2π/√(1 + 3ω²) or more.
    run = sb.simulate(model(), tilt=(0.05, 0.0), tilt_rate=(0.01, 0.02), duration=400.0, rtol=1e-12)
    turning = np.count_nonzero(np.diff(np.sign(run.data.amplitude_rate.to_numpy())))
    assert turning > 200
    for name in ("energy", "angular_momentum"):
        value = in_units_of_c(run, name)
        np.testing.assert_allclose(value, value[0], rtol=0.0, atol=1e-9)


def test_free_motion_in_a_plane_conserves_energy_through_every_passage():
    run = sb.simulate(model(), tilt=(0.05, 0.0), duration=100.0 * 4.0 * math.acosh(2.0), rtol=1e-12)
    energy = in_units_of_c(run, "energy")
    assert run.planar
    np.testing.assert_allclose(energy, 0.375, rtol=0.0, atol=1e-9)  # A0/c − (A0/c)²/2 with A0 = c/2
    np.testing.assert_array_equal(run.data.angular_momentum, 0.0)


@settings(max_examples=40)
@given(
    tilt=st.floats(0.1, 0.9),
    rate=st.floats(0.0, 0.5),
    heading=st.floats(0.0, 2.0 * math.pi),
    damping=st.floats(0.01, 2.0),
)
def test_friction_never_adds_energy_on_a_base_at_rest(tilt, rate, heading, damping):
    run = sb.simulate(
        model(damping),
        tilt=(tilt * C, 0.0),
        tilt_rate=(rate * C * math.cos(heading), rate * C * math.sin(heading)),
        duration=4.0,
        rest_energy=1e-3,
    )
    # Rounding and the tolerance 1e-8 of the integration may add that much of the largest energy, c²/2.
    assert np.diff(in_units_of_c(run, "energy")).max() < 1e-7


@pytest.mark.parametrize("damping", [0.0, 0.1])
@pytest.mark.parametrize(
    "motion",
    [
        sb.Harmonic.circular(acceleration=0.065, angular_frequency=1.8),
        sb.Harmonic.elliptic(amplitude=(0.02, 0.03), phase=-1.4, angular_frequency=2.4, ramp=3.0),
    ],
    ids=["circular", "elliptic with a ramp"],
)
def test_energy_changes_by_the_work_of_base_and_friction(motion, damping):
    run = sb.simulate(model(damping), motion, tilt=(0.04, 0.0), tilt_rate=(0.0, 0.07), duration=10.0, rtol=1e-11)
    assert run.data.amplitude.min() > 0.003  # no near passage: the power is smooth on the scale of the nodes
    points, weights = np.polynomial.legendre.leggauss(8)
    edges = np.linspace(0.0, float(run.data.time[-1]), 1001)
    half = np.diff(edges)[:, np.newaxis] / 2.0
    at = run.sample((edges[:-1, np.newaxis] + half * (1.0 + points)).ravel())
    rate, acceleration = at.tilt_rate.to_numpy(), at.base_acceleration.to_numpy()[:, :2]
    power = -np.sum(acceleration * rate, axis=1) - damping * np.sum(rate**2, axis=1)  # α̇·(1)
    work = np.concatenate([[0.0], np.cumsum((power.reshape(-1, 8) @ weights) * half[:, 0])]) / C**2
    energy = run.sample(edges).energy.to_numpy() / 0.75 / C**2
    assert np.ptp(work) > 0.01
    np.testing.assert_allclose(energy - energy[0], work, rtol=0.0, atol=1e-8)


def test_vertical_motion_enters_as_a_change_of_weight():
    # (1) with a_z: d/dτ(½|α̇|²) = (1 + a_z)(α − cû)·α̇, so dE/dτ = a_z (A − c) Ȧ.
    motion = sb.Harmonic.vertical(acceleration=0.5, angular_frequency=2.0)
    run = sb.simulate(
        model(), motion, tilt=(0.05, 0.0), tilt_rate=(0.0, 0.05), duration=10.0, rtol=1e-11, samples=20_001
    )
    data = run.data
    power = data.base_acceleration[:, 2] * (data.amplitude - C) * data.amplitude_rate
    energy = in_units_of_c(run, "energy")
    gained = float(np.trapezoid(power, data.time)) / C**2
    assert abs(gained) > 1e-3
    # The trapezoidal rule's own error: (0.5e-3)² × some 10 times the largest slope.
    assert energy[-1] - energy[0] == pytest.approx(gained, abs=1e-6)
