"""Branches that several tests look at, followed once."""

import math

import pytest

import stylobate as sb

STRAIGHT_BOUNDS = {0.04: (0.9, 2.0), 0.13: (1.4, 3.0)}


def slender(eta=0.1):
    return sb.Slender(sb.Column.dimensionless(0.1), damping=eta)


@pytest.fixture(scope="session")
def straight_branches():
    """Branches of straight-line motion over the frequency, by the amplitude."""
    branches = {}
    for a1, bounds in STRAIGHT_BOUNDS.items():
        motion = sb.Harmonic.straight(acceleration=a1, angular_frequency=bounds[1])
        orbit = sb.orbits.periodic_orbit(slender(), motion)
        branches[a1] = sb.orbits.continue_branch(orbit, "angular_frequency", bounds=bounds)
    return branches


@pytest.fixture(scope="session")
def ellipse_branch():
    motion = sb.Harmonic.elliptic(amplitude=(0.08, 0.04), phase=-math.pi / 2.0, angular_frequency=2.0)
    orbit = sb.orbits.periodic_orbit(slender(), motion)
    return sb.orbits.continue_branch(orbit, "angular_frequency", bounds=(1.35, 2.4))


@pytest.fixture(scope="session")
def asymmetric_branches(straight_branches):
    """What branches off at the pitchforks, both images, by the amplitude."""
    found = {}
    for a1, branch in straight_branches.items():
        (pitchfork,) = branch.bifurcations
        bounds = (pitchfork.parameter - 0.12, pitchfork.parameter + 0.1)
        found[a1] = tuple(
            sb.orbits.switch_branch(pitchfork, bounds=bounds, opposite=opposite) for opposite in (False, True)
        )
    return found
