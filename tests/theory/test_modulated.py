"""Modulated rolling, the limit cycle below the critical frequency."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from stylobate.errors import ParameterError
from stylobate.theory import critical_frequency, crossing_frequency, modulated_rolling, steady_rolling
from stylobate.theory.averaging import rotating_frame_jacobian, rotating_frame_rates
from stylobate.theory.modulated import differentiation_matrix, interpolated

A0, C, ETA = 0.065, 0.1, 0.1


def start_of(motion):
    return np.array([motion.tilt_rate[0], motion.rolling_rate[0], motion.amplitude[0], motion.phase[0]])


@pytest.fixture(scope="module")
def motion():
    return modulated_rolling(1.36, A0, c=C, eta=ETA)


def test_differentiation_is_exact_for_resolved_harmonics():
    points = 21
    time = np.arange(points) / points
    wave = np.cos(2.0 * np.pi * 7.0 * time + 0.3)
    slope = -14.0 * np.pi * np.sin(2.0 * np.pi * 7.0 * time + 0.3)
    assert differentiation_matrix(points) @ wave == pytest.approx(slope, abs=1e-12)
    between = np.array([0.013, 0.77])
    assert interpolated(wave[np.newaxis], between)[0] == pytest.approx(np.cos(14.0 * np.pi * between + 0.3), abs=1e-13)


def test_integration_of_the_flow_follows_it_and_closes(motion):
    run = solve_ivp(
        lambda _, y: rotating_frame_rates(y, 1.36, A0, c=C, eta=ETA),
        [0.0, motion.period],
        start_of(motion),
        "DOP853",
        t_eval=[*motion.tau, motion.period],
        rtol=1e-12,
        atol=1e-14,
    )
    expected = np.stack([motion.tilt_rate, motion.rolling_rate, motion.amplitude, motion.phase])
    assert run.y[:, :-1] == pytest.approx(expected, abs=1e-9)
    assert run.y[:, -1] == pytest.approx(expected[:, 0], abs=1e-9)


def test_integration_of_the_equation_of_motion_repeats_it(motion):
    nu, beta = 1.36, motion.phase[0]
    z = motion.amplitude[0] * np.exp(1j * beta)
    rate = (motion.tilt_rate[0] + 1j * motion.amplitude[0] * motion.rolling_rate[0]) * np.exp(1j * beta)

    def rates(tau, y):  # (1)
        tilt = complex(y[0], y[1])
        acceleration = tilt - C * tilt / abs(tilt) - ETA * complex(y[2], y[3]) - A0 * np.exp(1j * nu * tau)
        return [y[2], y[3], acceleration.real, acceleration.imag]

    run = solve_ivp(
        rates, [0.0, motion.period], [z.real, z.imag, rate.real, rate.imag], "DOP853", rtol=1e-12, atol=1e-14
    )
    end = complex(run.y[0, -1], run.y[1, -1])
    assert end == pytest.approx(z * np.exp(1j * nu * motion.period), abs=1e-10)


def test_multipliers_are_those_of_the_variational_equation(motion):
    def rates(_, y):
        jacobian = rotating_frame_jacobian(y[:4], A0, eta=ETA)
        flow = rotating_frame_rates(y[:4], 1.36, A0, c=C, eta=ETA)
        return np.concatenate([flow, (jacobian @ y[4:].reshape(4, 4)).ravel()])

    start = np.concatenate([start_of(motion), np.eye(4).ravel()])
    run = solve_ivp(rates, [0.0, motion.period], start, "DOP853", rtol=1e-11, atol=1e-13)
    expected = np.linalg.eigvals(run.y[4:, -1].reshape(4, 4))
    for multiplier in motion.multipliers:
        assert np.abs(expected - multiplier).min() < 1e-7


@pytest.mark.parametrize("nu", [1.39, 1.36, 1.33])
def test_one_multiplier_is_one_and_their_product_is_that_of_liouville(nu):
    motion = modulated_rolling(nu, A0, c=C, eta=ETA, points=61)
    assert motion.stable
    assert np.abs(motion.multipliers - 1.0).min() < 1e-8
    assert np.prod(motion.multipliers) == pytest.approx(np.exp(-2.0 * ETA * motion.period), rel=1e-9)


def test_published_range_of_the_tilt(motion):
    assert np.round(motion.amplitude_range, 2).tolist() == [0.64, 1.29]


def test_the_modulation_doubles_its_period_near_1_322():
    above, below = (modulated_rolling(nu, A0, c=C, eta=ETA, points=61) for nu in (1.3234, 1.3214))
    assert above.stable
    assert not below.stable
    assert below.multipliers[0].real < -1.0
    assert below.multipliers[0].imag == 0.0


def test_it_grows_out_of_steady_rolling_with_the_root_of_the_distance():
    critical = float(critical_frequency(A0, c=C, eta=ETA))
    near, far = (modulated_rolling(critical - distance, A0, c=C, eta=ETA, points=31) for distance in (1e-4, 4e-4))
    swings = [np.ptp(motion.amplitude) for motion in (near, far)]
    assert swings[1] / swings[0] == pytest.approx(2.0, rel=0.01)  # next order: the square of the swing
    assert near.period == pytest.approx(2.0 * np.pi / float(crossing_frequency(A0, c=C, eta=ETA)), rel=1e-3)
    steady = steady_rolling(critical, A0, c=C, eta=ETA).upper.amplitude
    assert near.amplitude.mean() == pytest.approx(steady, rel=1e-3)


@pytest.mark.parametrize(
    ("nu", "a0", "eta", "points", "reason"),
    [
        (1.5, A0, ETA, 31, "below the critical frequency"),
        (1.0, A0, 0.0, 31, "below the critical frequency"),
        (0.5, 0.0001, ETA, 31, "below the critical frequency"),
        (1.25, A0, ETA, 31, "do not resolve"),
    ],
)
def test_what_is_not_found_says_why(nu, a0, eta, points, reason):
    motion = modulated_rolling(nu, a0, c=C, eta=eta, points=points)
    assert not motion.found
    assert not motion.stable
    assert reason in motion.reason
    assert np.isnan(motion.amplitude).all()
    assert motion.tau.shape == (points,)


@pytest.mark.slow
def test_the_doubled_modulation_is_what_is_seen_at_1_318():
    """Successive maxima of the tilt settle on two values, the cascade that ends the modulated rolling near 1.313."""
    start = start_of(modulated_rolling(1.324, A0, c=C, eta=ETA))

    def highest(_, y):
        return y[0]

    highest.direction = -1.0
    run = solve_ivp(
        lambda _, y: rotating_frame_rates(y, 1.318, A0, c=C, eta=ETA),
        [0.0, 1500.0],
        start,
        "DOP853",
        events=highest,
        rtol=1e-9,
        atol=1e-11,
    )
    tilt = run.y_events[0][-40:, 2]
    tilt = tilt[tilt > 0.5 * tilt.max()]
    assert len(np.unique(tilt.round(5))) == 2


def test_user_mistakes_are_named():
    with pytest.raises(ParameterError, match="points must be odd and at least 15, got 64"):
        modulated_rolling(1.36, A0, c=C, eta=ETA, points=64)
    with pytest.raises(ParameterError, match="nu must be positive"):
        modulated_rolling(-1.0, A0, c=C, eta=ETA)
