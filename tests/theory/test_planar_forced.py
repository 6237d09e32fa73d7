"""Rocking in a plane with the period of the base motion, and what happens across the plane."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import expm

from stylobate.theory import planar_backbone, planar_forced_response, planar_free_motion
from stylobate.theory.planar import planar_kick_slope

C = 0.1
CASES = [(3.0, 0.13, 0.1), (1.5, 0.05, 0.1), (1.0, 0.02, 0.1), (6.0, 0.2, 0.3), (0.5, 0.08, 0.0), (2.0, 0.01, 0.0)]


def orbits(nu, a1, eta):
    response = planar_forced_response(nu, a1, c=C, eta=eta)
    return [orbit for orbit in (response.fast, response.slow) if orbit.exists]


def half_period(nu, a1, eta, start):
    """Integrate (1) with α2 = 0 on the positive side for half a period."""
    tilt, rate, phase = start

    def rates(tau, y):
        return [y[1], y[0] - C - eta * y[1] - a1 * np.cos(nu * tau + phase)]

    return solve_ivp(rates, [0.0, np.pi / nu], [tilt, rate], "DOP853", rtol=1e-12, atol=1e-14, dense_output=True)


@pytest.mark.parametrize(("nu", "a1", "eta"), CASES)
def test_integration_from_its_start_returns_with_the_velocity_reversed(nu, a1, eta):
    assert orbits(nu, a1, eta)
    # errors of the integration grow like e^{H} before they are compared
    tolerance = 1e-12 * np.exp(np.pi / nu)
    for orbit in orbits(nu, a1, eta):
        run = half_period(nu, a1, eta, orbit.start())
        assert run.y[0, -1] == pytest.approx(0.0, abs=tolerance)
        assert run.y[1, -1] == pytest.approx(-float(orbit.crossing_velocity), abs=tolerance)
        tilt = run.sol(np.linspace(0.0, np.pi / nu, 20001))[0]
        assert tilt[1:-1].min() > 0.0
        # between samples the tilt rises by less than |α̈|(H/20000)²/8
        assert tilt.max() == pytest.approx(float(orbit.amplitude), abs=2.0 * (np.pi / nu / 20000) ** 2)


@pytest.mark.parametrize(("nu", "a1", "eta"), CASES)
def test_multipliers_are_those_of_the_flow_and_the_jump_at_the_passage(nu, a1, eta):
    flow = expm(np.array([[0.0, 1.0], [1.0, -eta]]) * np.pi / nu)
    for orbit in orbits(nu, a1, eta):
        jump = np.array([[1.0, 0.0], [-2.0 * C / orbit.crossing_velocity, 1.0]])
        expected = np.linalg.eigvals(-jump @ flow)
        for multiplier in orbit.multipliers:
            assert np.abs(expected - multiplier).min() < 1e-9 * np.abs(expected).max()
        assert np.prod(orbit.multipliers) == pytest.approx(np.exp(-eta * np.pi / nu), rel=1e-12)
        if eta > 0.0:
            assert orbit.stable_in_plane == (np.abs(expected).max() < 1.0)


def test_the_multipliers_say_how_a_deviation_in_the_plane_returns():
    """The half-period map itself, by integration to the passage: its derivative has the stated multipliers."""
    nu, a1, eta = 1.5, 0.05, 0.1
    orbit = planar_forced_response(nu, a1, c=C, eta=eta).fast

    def passage(velocity, phase):
        def upright(_, y):
            return y[0]

        upright.terminal, upright.direction = True, -1.0

        def rates(tau, y):
            return [y[1], y[0] - C - eta * y[1] - a1 * np.cos(nu * tau + phase)]

        run = solve_ivp(
            rates, [0.0, 2.0 * np.pi / nu], [0.0, velocity], "DOP853", events=upright, rtol=1e-12, atol=1e-15
        )
        return np.array([-run.y[1, -1], phase + nu * run.t[-1] - np.pi])

    start, step = np.array([float(orbit.crossing_velocity), float(orbit.phase)]), 1e-6
    columns = [(passage(*(start + shift)) - passage(*(start - shift))) / (2.0 * step) for shift in step * np.eye(2)]
    found = np.linalg.eigvals(np.stack(columns, axis=-1))
    for multiplier in orbit.multipliers:
        assert np.abs(found - multiplier).min() < 1e-6


def test_a_small_base_motion_without_damping_leaves_the_backbone():
    nu = np.linspace(0.5, 5.0, 40)
    response = planar_forced_response(nu, 1e-9, c=C, eta=0.0)
    for orbit in (response.fast, response.slow):
        assert orbit.exists.all()
        assert orbit.amplitude == pytest.approx(planar_backbone(nu, C), abs=1e-9)
    at_rest = planar_forced_response(nu, 0.0, c=C, eta=0.0).fast
    assert at_rest.amplitude == pytest.approx(planar_backbone(nu, C), rel=1e-12)
    _, rate = planar_free_motion(-0.5 * np.pi / nu, at_rest.amplitude, C)
    assert at_rest.crossing_velocity == pytest.approx(rate, rel=1e-9)


def test_without_damping_the_amplitudes_lie_either_side_of_the_backbone():
    nu = np.linspace(0.5, 5.0, 40)
    response = planar_forced_response(nu, 0.01, c=C, eta=0.0)
    assert (response.fast.amplitude > planar_backbone(nu, C)).all()
    slow = response.slow.exists
    assert (response.slow.amplitude[slow] < planar_backbone(nu, C)[slow]).all()


def test_friction_needs_a_least_base_motion():
    amplitude = np.linspace(0.0, 0.05, 200)
    exists = planar_forced_response(2.0, amplitude, c=C, eta=0.5).fast.exists
    assert not exists[0]
    assert exists[-1]
    assert (np.diff(exists.astype(int)) >= 0).all()


def test_very_slow_base_motion_does_not_overflow():
    response = planar_forced_response([0.05, 0.005, 0.001], 0.05, c=C, eta=0.1)
    # quasi-static: the unstable equilibrium c + a1 on one side; errors of the order ν²
    assert response.fast.amplitude == pytest.approx(C + 0.05, rel=3e-3)
    assert not response.fast.stable_in_plane.any()


def test_shapes_broadcast_and_missing_orbits_are_nan():
    response = planar_forced_response(np.linspace(1.0, 3.0, 5)[:, np.newaxis], [0.0, 0.1, 0.2], c=C, eta=0.3)
    for orbit in (response.fast, response.slow):
        assert orbit.amplitude.shape == (5, 3)
        assert orbit.multipliers.shape == (5, 3, 2)
        assert not orbit.exists[:, 0].any()
        for values in (orbit.amplitude, orbit.phase, orbit.crossing_velocity):
            assert (np.isfinite(values) == orbit.exists).all()


def test_the_kick_out_of_the_plane_grows_with_the_logarithm_of_the_offset():
    speed, half_window = 0.05, 1e-4
    offsets = np.array([1e-9, 1e-10, 1e-11, 1e-12])

    def rates(_, y):  # (1), free
        tilt = np.hypot(y[0], y[1])
        return [y[2], y[3], y[0] - C * y[0] / tilt, y[1] - C * y[1] / tilt]

    def relative_kick(offset):
        """Perturbation of the rate across the plane, from half a window before the passage to half a window after."""
        runs = [
            solve_ivp(
                rates, [0.0, way * half_window], [0.0, offset, speed, 0.0], "DOP853", rtol=1e-12, atol=1e-13 * offset
            )
            for way in (1.0, -1.0)
        ]
        return (runs[0].y[3, -1] - runs[1].y[3, -1]) / offset

    kicks = [relative_kick(offset) for offset in offsets]
    slopes = np.diff(kicks) / np.diff(np.log(offsets))
    # the kick acts back on the offset within the window: a relative error of the order c · window/speed, 2e-4
    assert slopes == pytest.approx(np.full(3, planar_kick_slope(speed, C)), rel=1e-3)
