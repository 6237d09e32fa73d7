"""Bifurcations of orbits: where, of what kind, and soft or hard; by shooting, by theory, by direct integration."""

import math

import numpy as np
import pytest

import stylobate as sb
from stylobate.orbits import BifurcationKind, continue_branch, periodic_orbit
from stylobate.theory.averaging import rotating_frame_jacobian

C = 0.1


def slender(eta=0.1):
    return sb.Slender(sb.Column.dimensionless(C), damping=eta)


def branch_of_circle(a0, eta, low, high, rtol=1e-12):
    motion = sb.Harmonic.circular(acceleration=a0, angular_frequency=high)
    orbit = periodic_orbit(slender(eta), motion, rtol=rtol)
    return continue_branch(orbit, "angular_frequency", bounds=(low, high))


# Integrated independently; the page gives ten digits.
@pytest.mark.parametrize(("a0", "published"), [(0.065, 1.397107589247), (0.02, 0.981308017726)])
def test_steady_rolling_loses_its_stability_at_the_published_frequency(a0, published):
    branch = branch_of_circle(a0, 0.1, 0.9 * published, 1.1 * published)
    (found,) = branch.bifurcations
    assert found.kind is BifurcationKind.NEIMARK_SACKER
    # The condition is known to 1e-11 (multipliers) and its slope is of the order 1.
    assert found.parameter == pytest.approx(published, abs=1e-9)
    assert found.supercritical
    assert abs(found.multiplier) == pytest.approx(1.0, abs=1e-9)
    turn = float(sb.theory.crossing_frequency(a0, c=C, eta=0.1)) * 2.0 * math.pi / published
    expected = complex(math.cos(turn), math.sin(turn))
    assert min(abs(found.multiplier - expected), abs(found.multiplier - expected.conjugate())) < 1e-7


@pytest.mark.parametrize("eta", [0.05, 0.1, 0.3])
@pytest.mark.parametrize("a0", [0.02, 0.065, 0.2])
def test_bifurcations_of_circular_motion_are_those_of_theory(eta, a0):
    expected = float(sb.theory.critical_frequency(a0, c=C, eta=eta))
    coefficient = float(sb.theory.first_lyapunov_coefficient(a0, c=C, eta=eta))
    branch = branch_of_circle(a0, eta, 0.97 * expected, 1.05 * expected)
    (found,) = branch.bifurcations
    assert found.kind is BifurcationKind.NEIMARK_SACKER
    assert found.parameter == pytest.approx(expected, abs=1e-9)
    assert math.copysign(1.0, found.coefficient) == math.copysign(1.0, coefficient)
    assert found.supercritical == (coefficient < 0.0)


def test_normal_form_of_the_map_and_of_the_flow_agree_in_size():
    """Re(d) of the map over a time is Re(c1) of the flow times that time.

    Theory's vector is of length 1 in (μ/c, ω, A/c, ψ), here in states over c: the amplitude they give the same
    disturbance is their ratio.
    """
    for a0 in (0.02, 0.065, 0.2):
        nu = float(sb.theory.critical_frequency(a0, c=C, eta=0.1))
        (found,) = branch_of_circle(a0, 0.1, 0.97 * nu, 1.05 * nu).bifurcations
        scale = _length_of_theorys_vector(a0, nu)
        # Kuznetsov's l1 is Re(c1)/Ω.
        crossing = float(sb.theory.crossing_frequency(a0, c=C, eta=0.1))
        coefficient = float(sb.theory.first_lyapunov_coefficient(a0, c=C, eta=0.1))
        # The family has the inversion: its map is that of half a period.
        expected = coefficient * crossing * (math.pi / nu) / scale**2
        # Third differences over 2e-2 of the state: errors of its fourth power by higher derivatives.
        assert found.coefficient == pytest.approx(expected, rel=1e-4)


def _length_of_theorys_vector(a0, nu):
    """Return the length, in states over c at t = 0, of theory's critical vector of length 1."""
    upper = sb.theory.steady_rolling(nu, a0, c=C, eta=0.1).upper
    tilt, psi = float(upper.amplitude), float(upper.phase)
    jacobian = rotating_frame_jacobian(np.array([0.0, nu, tilt / C, psi]), a0 / C, eta=0.1)
    values, vectors = np.linalg.eig(jacobian)
    crossing = float(sb.theory.crossing_frequency(a0, c=C, eta=0.1))
    mu, omega, height, phase = vectors[:, np.argmin(np.abs(values - 1j * crossing))]
    turned = np.exp(1j * psi)
    # z = A e^{iβ}, ż = (μ + iAω) e^{iβ}: changes of their real and imaginary parts, by complex amplitudes.
    radial, around = height, tilt / C * phase
    along, across = mu - tilt / C * nu * phase, height * nu + tilt / C * omega
    pairs = [(radial, around), (along, across)]
    state = [f for r, t in pairs for f in (r * turned.real - t * turned.imag, r * turned.imag + t * turned.real)]
    return float(np.linalg.norm(state))


PITCHFORKS = {0.04: 1.087672063, 0.13: 1.620453934}


@pytest.mark.parametrize(("a1", "published"), PITCHFORKS.items())
def test_straight_line_motion_has_its_pitchfork_where_published(straight_branches, a1, published):
    (found,) = straight_branches[a1].bifurcations
    assert found.kind is BifurcationKind.PITCHFORK
    assert found.parameter == pytest.approx(published, abs=1e-8)
    assert found.supercritical
    assert found.orbit.inversion
    assert abs(found.multiplier - 1.0) < 1e-6
    assert np.linalg.norm(found.critical_vector) == pytest.approx(1.0, rel=1e-12)


def test_elliptic_motion_has_its_pitchfork_where_published(ellipse_branch):
    (found,) = ellipse_branch.bifurcations
    assert found.kind is BifurcationKind.PITCHFORK
    assert found.parameter == pytest.approx(1.436505083, abs=1e-8)
    assert found.supercritical


@pytest.mark.parametrize("a1", PITCHFORKS)
def test_the_tolerance_of_the_flow_does_not_move_a_pitchfork(straight_branches, a1):
    (usual,) = straight_branches[a1].bifurcations
    motion = sb.Harmonic.straight(acceleration=a1, angular_frequency=usual.parameter + 0.1)
    orbit = periodic_orbit(slender(), motion, rtol=1e-11)
    assert orbit.system.rtol == 1e-11
    bounds = (usual.parameter - 0.1, usual.parameter + 0.2)
    (found,) = continue_branch(orbit, "angular_frequency", bounds=bounds).bifurcations
    assert found.parameter == pytest.approx(usual.parameter, abs=1e-8)


@pytest.mark.parametrize("a1", PITCHFORKS)
def test_multipliers_on_both_sides_confirm_a_pitchfork(straight_branches, a1):
    branch = straight_branches[a1]
    (found,) = branch.bifurcations
    above, below = (branch.orbits_at(found.parameter + side)[0] for side in (0.02, -0.02))
    assert above.stable
    assert not below.stable
    # It is the real one that leaves.
    assert abs(below.multipliers[0].imag) < 1e-12
    assert below.multipliers[0].real > 1.0
    for orbit in (above, below):
        # By whole periods and many shots, where the branch goes by halves.
        guess = np.concatenate([orbit.tilt, orbit.tilt_rate])
        whole = periodic_orbit(orbit.model, orbit.motion, guess=guess, arcs=4)
        np.testing.assert_allclose(whole.state, orbit.state, rtol=0.0, atol=1e-11)
        assert abs(whole.multipliers[0]) == pytest.approx(abs(orbit.multipliers[0]), rel=1e-8)


def distances_after(orbit, push, periods):
    """Return how far off the orbit a run is after each of so many periods, begun `push` beside it."""
    run = sb.simulate(
        orbit.model,
        orbit.motion,
        tilt=orbit.tilt + push,
        tilt_rate=orbit.tilt_rate,
        duration=periods * orbit.period,
        rtol=1e-11,
    )
    times = np.arange(periods + 1) * orbit.period
    data = run.sample(times[times <= run.data["time"].to_numpy()[-1]])
    states = np.concatenate([data["tilt"].to_numpy() - orbit.tilt, data["tilt_rate"].to_numpy() - orbit.tilt_rate], 1)
    return np.linalg.norm(states, axis=1) / C


@pytest.mark.parametrize("a1", PITCHFORKS)
def test_runs_stay_with_the_orbit_above_and_leave_it_below(straight_branches, a1):
    branch = straight_branches[a1]
    (found,) = branch.bifurcations
    push = 1e-3 * C * np.array([0.6, -0.8])
    above, below = (branch.orbits_at(found.parameter + side)[0] for side in (0.05, -0.05))
    factor = abs(above.multipliers[0])
    periods = math.ceil(math.log(1e-3) / math.log(factor))
    back = distances_after(above, push, periods)
    assert back[0] == pytest.approx(1e-3)
    # What is not along the slowest direction is larger at first, by a few times.
    assert back[-1] < 1e-5
    away = distances_after(below, push, math.ceil(math.log(1e4) / math.log(abs(below.multipliers[0]))))
    assert away.max() > 0.03


def test_bifurcations_tell_themselves_in_one_line(straight_branches):
    (found,) = straight_branches[0.04].bifurcations
    assert repr(found) == "Bifurcation(pitchfork at angular_frequency = 1.087672063, supercritical)"
    assert found.state is found.orbit.state or np.array_equal(found.state, found.orbit.state)


def test_a_branch_lists_its_bifurcations_in_its_data(straight_branches):
    branch = straight_branches[0.13]
    points = branch.points
    (found,) = branch.bifurcations
    assert list(points["bifurcation_kind"].to_numpy()) == ["pitchfork"]
    assert points["bifurcation_parameter"].to_numpy() == pytest.approx([found.parameter], rel=1e-15)
    assert list(points["bifurcation_supercritical"].to_numpy()) == [1]
    nu = points["angular_frequency"].to_numpy()
    away = np.abs(nu - found.parameter) > 1e-8
    np.testing.assert_array_equal(points["stable"].to_numpy()[away], (nu > found.parameter)[away])
