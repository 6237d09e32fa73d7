"""Averaging of straight-line and elliptic base motion, and the limit of fast base motion."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad, solve_ivp

from stylobate.errors import ParameterError
from stylobate.theory import averaged_rolling, high_frequency_rolling, steady_rolling
from stylobate.theory.averaging import circular_components, high_frequency_rates, rotating_frame_rates

C, ETA = 0.1, 0.1
amplitude = st.floats(-1.0, 1.0)
angle = st.floats(-np.pi, np.pi)


@given(a1=amplitude, a2=amplitude, phi2=angle, time=angle)
def test_two_circular_motions_make_the_base_motion(a1, a2, phi2, time):
    p, q = circular_components(a1, a2, phi2)
    motion = a1 * np.cos(time) + 1j * a2 * np.cos(time + phi2)
    assert p * np.exp(1j * time) + q * np.exp(-1j * time) == pytest.approx(motion, abs=1e-15)


@given(a1=amplitude, a2=amplitude, phi2=angle)
def test_peak_acceleration_is_the_sum_of_both(a1, a2, phi2):
    p, q = circular_components(a1, a2, phi2)
    time = np.linspace(0.0, 2.0 * np.pi, 2001)
    largest = np.abs(a1 * np.cos(time) + 1j * a2 * np.cos(time + phi2)).max()
    # the maximum falls between samples: relative error below (step)²
    assert largest == pytest.approx(abs(p) + abs(q), rel=1e-5, abs=1e-12)


def test_straight_line_motion_rolls_like_circular_motion_of_half_the_amplitude_both_ways():
    nu = np.linspace(0.5, 4.0, 8)
    rolling, circular = averaged_rolling(nu, 0.13, c=C, eta=ETA), steady_rolling(nu, 0.065, c=C, eta=ETA)
    for sense, way in ((1, rolling.forward), (-1, rolling.backward)):
        assert way.sense == sense
        assert (way.azimuth_offset == 0.0).all()
        assert way.upper.amplitude == pytest.approx(circular.upper.amplitude, rel=1e-15)
        assert (way.upper.stable == circular.upper.stable).all()


@pytest.mark.parametrize(("phi2", "sense"), [(-np.pi / 2, 1), (np.pi / 2, -1)])
@pytest.mark.parametrize("turn", [0.0, 0.7])
def test_circular_motion_has_its_exact_solution_with_the_stated_azimuth(phi2, sense, turn):
    nu, a0 = 1.5, 0.065
    rolling = averaged_rolling(nu, a0, a0, phi2, c=C, eta=ETA)
    way, other = (rolling.forward, rolling.backward) if sense > 0 else (rolling.backward, rolling.forward)
    assert not other.upper.exists
    # put the solution into (1) at some time: z = A e^{iβ}, β̇ = ± ν
    tau = turn / nu
    beta = way.sense * (nu * tau + way.upper.phase) + way.azimuth_offset
    z = way.upper.amplitude * np.exp(1j * beta)
    base = a0 * np.cos(nu * tau) + 1j * a0 * np.cos(nu * tau + phi2)
    residual = -(nu**2) * z - z + C * z / abs(z) + ETA * 1j * way.sense * nu * z + base
    assert abs(residual) < 1e-16 * 10


def test_averaging_over_the_fast_phase_gives_the_rotating_frame():
    """(6) with a2 = 0 and β = ντ + ψ, averaged over ντ, is (7) with a0 = a1/2."""
    a1, nu = 0.13, 2.0
    mu, omega, tilt, psi = 0.02, 1.9, 0.03, 0.6

    def tilting(phase):
        return tilt * (1.0 + omega**2) - C - ETA * mu - a1 * np.cos(phase + psi) * np.cos(phase)

    def turning(phase):
        return (-2.0 * mu * omega - ETA * omega * tilt + a1 * np.sin(phase + psi) * np.cos(phase)) / tilt

    averaged = [quad(f, 0.0, 2.0 * np.pi)[0] / (2.0 * np.pi) for f in (tilting, turning)]
    rates = rotating_frame_rates([mu, omega, tilt, psi], nu, 0.5 * a1, c=C, eta=ETA)
    assert rates[:2] == pytest.approx(averaged, rel=1e-12)


def test_elliptic_motion_turned_by_an_angle_turns_the_rolling():
    """Straight-line motion along a line at 30° is two in-phase components; both offsets are then ±30°."""
    direction = np.pi / 6
    rolling = averaged_rolling(3.0, 0.1 * np.cos(direction), 0.1 * np.sin(direction), c=C, eta=ETA)
    assert rolling.forward.azimuth_offset == pytest.approx(direction)
    assert rolling.backward.azimuth_offset == pytest.approx(direction)
    assert rolling.forward.upper.amplitude == pytest.approx(rolling.backward.upper.amplitude)


@pytest.mark.parametrize("nu", [6.0, 24.0])
@pytest.mark.parametrize("a1", [0.00125, 0.005])
def test_the_error_of_averaging_is_of_the_order_a1_over_c_at_every_frequency(nu, a1):
    """Without friction, from the averaged start: measured 2.3 a1/c for a1 well below c."""
    way = averaged_rolling(nu, a1, c=C, eta=0.0).forward
    z = way.upper.amplitude * np.exp(1j * way.upper.phase)
    rate = 1j * nu * z

    def rates(tau, y):  # (1)
        tilt = np.hypot(y[0], y[1])
        return [y[2], y[3], y[0] - C * y[0] / tilt - a1 * np.cos(nu * tau), y[1] - C * y[1] / tilt]

    start = [z.real, z.imag, rate.real, rate.imag]
    run = solve_ivp(rates, [0.0, 200.0 / nu], start, "DOP853", rtol=1e-9, atol=1e-13)
    ratio = np.hypot(run.y[0], run.y[1]) / way.upper.amplitude
    assert 2.1 < np.abs(ratio - 1.0).max() / (a1 / C) < 2.5


def test_fast_limit_is_what_steady_rolling_tends_to():
    # the first correction is of the order (1 + ratio/2)/ν²
    nu, ratio = 1e4, np.array([0.1, 0.4, 1.3])
    rolling, limit = steady_rolling(nu, 0.5 * ratio * C, c=C, eta=ETA), high_frequency_rolling(ratio)
    assert rolling.upper.amplitude * nu**2 / C == pytest.approx(limit.upper, rel=1e-7)
    assert rolling.lower.amplitude * nu**2 / C == pytest.approx(limit.lower, rel=1e-6)
    assert rolling.upper.stable.all()
    frequencies = np.sort(np.abs(rolling.upper.eigenvalues.imag), axis=-1)[:, ::2] / nu
    assert frequencies == pytest.approx(limit.frequencies, rel=1e-6)
    assert np.isnan(high_frequency_rolling(2.5).lower)


def test_fast_limit_is_what_the_equation_of_motion_tends_to():
    nu, ratio, transverse, phi2 = 1e5, 0.4, 0.2, 0.9
    y = np.array([0.8, -0.5, 0.3, 1.1])
    s = 0.37
    scale = C / nu**2
    z, velocity = scale * y[:2], scale * nu * y[2:]
    base = C * np.array([ratio * np.cos(s), transverse * np.cos(s + phi2)])
    acceleration = z - C * z / np.hypot(*z) - ETA * velocity - base
    limit = high_frequency_rates(s, y, ratio, transverse, phi2)
    assert limit[:2].tolist() == y[2:].tolist()
    # what is dropped is of the order η/ν
    assert acceleration / (scale * nu**2) == pytest.approx(limit[2:], abs=2.0 * ETA / nu)


def test_circular_motion_is_an_exact_solution_of_the_fast_limit():
    ratio = 0.3
    for sign, start in ((1.0, 1.0 + ratio), (-1.0, 1.0 - ratio)):
        # (a1, a2, φ2) = (a0, a0, −π/2); the lower branch leans against the acceleration
        run = solve_ivp(
            lambda s, y: high_frequency_rates(s, y, ratio, ratio, -np.pi / 2),
            [0.0, 6.0],
            [sign * start, 0.0, 0.0, sign * start],
            "DOP853",
            rtol=1e-12,
            atol=1e-13,
        )
        assert np.hypot(run.y[0], run.y[1]) == pytest.approx(np.full(run.t.size, start), abs=1e-7)
    limit = high_frequency_rolling(2.0 * ratio)
    assert (limit.upper, limit.lower) == (pytest.approx(1.0 + ratio), pytest.approx(1.0 - ratio))


def test_user_mistakes_are_named():
    with pytest.raises(ParameterError, match="ratio must be zero or positive"):
        high_frequency_rolling(-0.1)
    with pytest.raises(ParameterError, match="phi2 must be finite"):
        circular_components(0.1, 0.1, np.inf)
    with pytest.raises(ParameterError, match="four entries"):
        high_frequency_rates(0.0, 1.0, 0.1)
