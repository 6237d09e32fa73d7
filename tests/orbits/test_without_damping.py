"""Orbits of columns without friction: nothing decays, and stable means that nothing grows."""

import math

import numpy as np
import pytest

import stylobate as sb
from stylobate.orbits import BifurcationKind, continue_branch, periodic_orbit

C, A0 = 0.1, 0.065
MODEL = sb.Slender(sb.Column.dimensionless(C), damping=0.0)
# Of the closed form at this acceleration.
CRITICAL = 1.40046


def orbit_of_circle(nu):
    return periodic_orbit(MODEL, sb.Harmonic.circular(acceleration=A0, angular_frequency=nu))


@pytest.mark.parametrize("nu", [1.2, 1.39, 1.4, 1.401, 1.41, 1.6, 2.0, 3.0, 5.0])
def test_rolling_is_stable_where_theory_says_that_nothing_grows(nu):
    rolling = sb.theory.steady_rolling(nu, A0, c=C, eta=0.0).upper
    orbit = orbit_of_circle(nu)
    assert orbit.stable == bool(rolling.stable) == (nu > CRITICAL)


@pytest.mark.parametrize("nu", [0.4, 0.7, 1.39, 1.41, 3.0])
def test_volumes_of_states_keep_their_size(nu):
    multipliers = orbit_of_circle(nu).multipliers
    # Each is known to 1e-9, and the least have the rounding of the largest.
    assert abs(np.prod(multipliers) - 1.0) < 4e-9 + 1e-14 * abs(multipliers[0]) ** 2


def test_the_lower_branch_is_a_saddle_without_damping_too():
    rolling = sb.theory.steady_rolling(2.0, A0, c=C, eta=0.0).lower
    start = rolling.amplitude * np.exp(1j * rolling.phase)
    motion = sb.Harmonic.circular(acceleration=A0, angular_frequency=2.0)
    orbit = periodic_orbit(MODEL, motion, guess=(start.real, start.imag, -2.0 * start.imag, 2.0 * start.real))
    assert not orbit.stable


@pytest.mark.parametrize("eta", [1e-6, 1e-4])
def test_a_little_friction_decays(eta):
    """Mean decay by e^{−ηT/2} a multiplier, far above the 1e-9 to which they are known."""
    model = sb.Slender(sb.Column.dimensionless(C), damping=eta)
    orbit = periodic_orbit(model, sb.Harmonic.circular(acceleration=A0, angular_frequency=2.0))
    assert orbit.stable == bool(sb.theory.steady_rolling(2.0, A0, c=C, eta=eta).upper.stable)
    assert np.prod(np.abs(orbit.multipliers)) == pytest.approx(math.exp(-2.0 * eta * orbit.period), abs=1e-10)


@pytest.mark.slow
@pytest.mark.parametrize("bounds", [(0.4, 4.0), (1.5, 2.5)])
def test_rounding_invents_no_bifurcation_of_circular_motion(bounds):
    """A pair of multipliers is on the unit circle all along; theory has neither fold nor branch point here."""
    branch = continue_branch(orbit_of_circle(2.0), "angular_frequency", bounds=bounds)
    assert branch.bifurcations == ()
    points = branch.points
    expected = sb.theory.steady_rolling(points["angular_frequency"], A0, c=C, eta=0.0).upper.stable
    np.testing.assert_array_equal(points["stable"], expected)


def test_rounding_invents_no_bifurcation_where_friction_ends():
    model = sb.Slender(sb.Column.dimensionless(C), damping=0.05)
    orbit = periodic_orbit(model, sb.Harmonic.circular(acceleration=A0, angular_frequency=2.0))
    branch = continue_branch(orbit, "damping", bounds=(0.0, 0.1))
    assert branch.bifurcations == ()
    assert bool(branch.points["stable"].all())


def test_without_damping_a_pitchfork_is_neither_soft_nor_hard():
    """Straight-line rolling has one at every friction; nothing that is born there can attract."""
    motion = sb.Harmonic.straight(acceleration=0.04, angular_frequency=2.0)
    branch = continue_branch(periodic_orbit(MODEL, motion), "angular_frequency", bounds=(1.0, 2.0))
    (pitchfork,) = (one for one in branch.bifurcations if one.kind is BifurcationKind.PITCHFORK)
    assert pitchfork.supercritical is None
    assert math.isnan(pitchfork.coefficient)
