"""What is born at a bifurcation: orbits without the symmetry, orbits of twice the length."""

import math

import numpy as np
import pytest

import stylobate as sb
from stylobate.errors import ParameterError
from stylobate.orbits import BifurcationKind, continue_branch, periodic_orbit, switch_branch

C = 0.1


def asymmetry(orbit):
    """Return how far the orbit is from its image half a period later [c]."""
    states = orbit.states(2)
    return float(np.linalg.norm(states[:, 0] + states[:, 1]) / C)


@pytest.fixture(scope="module")
def doublings(asymmetric_branches):
    return [one for one in asymmetric_branches[0.13][0].bifurcations if one.kind is BifurcationKind.PERIOD_DOUBLING]


@pytest.fixture(scope="module")
def doubled_branch(doublings):
    at = doublings[0].parameter
    return switch_branch(doublings[0], bounds=(at - 0.006, at + 0.01))


@pytest.mark.slow
@pytest.mark.parametrize("a1", [0.04, 0.13])
def test_a_soft_pitchfork_bears_stable_orbits_without_the_symmetry(straight_branches, asymmetric_branches, a1):
    (pitchfork,) = straight_branches[a1].bifurcations
    for branch in asymmetric_branches[a1]:
        assert branch.orbits_at(pitchfork.parameter + 1e-3) == ()
        (orbit,) = branch.orbits_at(pitchfork.parameter - 0.01)
        assert orbit.stable
        assert not orbit.inversion
        assert orbit.turns == 1.0
        # Newton's last step is below 1e-11 of the point; the residual is a few times that at most.
        assert np.abs(orbit.chain.residual).max() < 1e-11


@pytest.mark.parametrize("a1", [0.04, 0.13])
def test_the_two_orbits_are_images_of_each_other_half_a_period_later(straight_branches, asymmetric_branches, a1):
    (pitchfork,) = straight_branches[a1].bifurcations
    (one,), (other,) = (branch.orbits_at(pitchfork.parameter - 0.01) for branch in asymmetric_branches[a1])
    np.testing.assert_allclose(other.states(2), -one.states(2)[:, ::-1], rtol=0.0, atol=1e-11)
    assert asymmetry(one) > 1e-2
    np.testing.assert_allclose(np.abs(one.multipliers), np.abs(other.multipliers), rtol=0.0, atol=1e-9)


@pytest.mark.parametrize("a1", [0.04, 0.13])
def test_the_asymmetry_grows_as_the_square_root_of_the_distance(straight_branches, asymmetric_branches, a1):
    (pitchfork,) = straight_branches[a1].bifurcations
    distances = np.array([1e-4, 2e-4, 4e-4, 8e-4])
    orbits = [asymmetric_branches[a1][0].orbits_at(pitchfork.parameter - distance) for distance in distances]
    sizes = [asymmetry(orbit) for (orbit,) in orbits]
    slope = np.polyfit(np.log(distances), np.log(sizes), 1)[0]
    # The next term is of the order of the distance over 0.1.
    assert slope == pytest.approx(0.5, abs=0.02)


@pytest.mark.parametrize("a1", [0.04, 0.13])
def test_multipliers_of_old_and_new_orbit_leave_1_at_the_rate_2_to_1(straight_branches, asymmetric_branches, a1):
    """At a pitchfork the new orbits decay twice as fast as disturbances of the old one grow."""
    (pitchfork,) = straight_branches[a1].bifurcations
    at = pitchfork.parameter - 1e-4
    (old,), (new,) = straight_branches[a1].orbits_at(at), asymmetric_branches[a1][0].orbits_at(at)
    grows = math.log(abs(old.multipliers[0]))
    decays = math.log(abs(new.multipliers[0]))
    # To first order in the distance: at ten times the distance the ratio is −2.9, so here it is off by a tenth of that.
    assert decays / grows == pytest.approx(-2.0, abs=0.1)


def test_runs_beside_the_old_orbit_end_on_a_new_one(straight_branches, asymmetric_branches):
    (pitchfork,) = straight_branches[0.04].bifurcations
    at = pitchfork.parameter - 0.02
    (old,) = straight_branches[0.04].orbits_at(at)
    new = [branch.orbits_at(at)[0] for branch in asymmetric_branches[0.04]]
    run = sb.simulate(
        old.model, old.motion, tilt=old.tilt * 1.001, tilt_rate=old.tilt_rate, duration=100 * old.period, rtol=1e-9
    )
    end = run.data.isel(time=-1)
    state = np.concatenate([end["tilt"], end["tilt_rate"]])
    assert min(np.abs(state - orbit.state).max() for orbit in new) < 1e-4 * C
    assert np.abs(state - old.state).max() > 1e-2 * C


def test_the_asymmetric_orbit_doubles_its_period(doublings):
    assert doublings[0].parameter == pytest.approx(1.571124, abs=1e-6)
    assert doublings[0].supercritical
    assert abs(doublings[0].multiplier + 1.0) < 1e-6


def test_both_images_double_at_the_same_frequency(asymmetric_branches, doublings):
    image = [one for one in asymmetric_branches[0.13][1].bifurcations if one.kind is BifurcationKind.PERIOD_DOUBLING]
    assert image[0].parameter == pytest.approx(doublings[0].parameter, abs=1e-9)
    assert image[0].supercritical


@pytest.mark.slow
def test_orbits_of_twice_the_length_are_born_stable(doublings, doubled_branch):
    at = doublings[0].parameter - 0.002
    orbits = doubled_branch.orbits_at(at)
    assert orbits
    for orbit in orbits:
        assert orbit.periods == 2
        assert orbit.stable
        assert orbit.period == pytest.approx(4.0 * math.pi / at, rel=1e-14)
        # After one period it is elsewhere.
        first, second = orbit.states(2).T
        assert np.abs(first - second).max() > 1e-2 * C
        assert np.prod(orbit.multipliers).real == pytest.approx(math.exp(-0.2 * orbit.period), rel=1e-8)
    (single,) = periodic_single(at)
    assert not single.stable
    assert single.multipliers[0].real < -1.0


def periodic_single(at):
    """Return the orbit of one period in the same place, found by itself."""
    model = sb.Slender(sb.Column.dimensionless(C), damping=0.1)
    motion = sb.Harmonic.straight(acceleration=0.13, angular_frequency=3.0)
    branch = continue_branch(periodic_orbit(model, motion), "angular_frequency", bounds=(1.6, 3.0))
    (pitchfork,) = branch.bifurcations
    return switch_branch(pitchfork, bounds=(1.565, 1.63)).orbits_at(at)


def test_a_run_comes_back_to_the_doubled_orbit(doublings, doubled_branch):
    orbit = doubled_branch.orbits_at(doublings[0].parameter - 0.003)[0]
    run = sb.simulate(
        orbit.model,
        orbit.motion,
        tilt=orbit.tilt * (1.0 + 1e-4),
        tilt_rate=orbit.tilt_rate,
        duration=30 * orbit.period,
        rtol=1e-10,
    )
    data = run.sample(np.array([29.0, 29.5, 30.0]) * orbit.period)
    tilts = data["tilt"].to_numpy()
    left = abs(orbit.multipliers[0]) ** 29
    assert left < 0.1
    np.testing.assert_allclose(tilts[0], orbit.tilt, rtol=0.0, atol=1e-3 * left * C + 1e-8 * C)
    np.testing.assert_allclose(tilts[2], orbit.tilt, rtol=0.0, atol=1e-3 * left * C + 1e-8 * C)
    assert np.abs(tilts[1] - orbit.tilt).max() > 1e-2 * C


def test_the_amplitude_of_doubling_grows_as_the_square_root_of_the_distance(doublings, doubled_branch):
    distances = np.array([1e-4, 2e-4, 4e-4])
    sizes = []
    for distance in distances:
        orbit = doubled_branch.orbits_at(doublings[0].parameter - distance)[0]
        first, second = orbit.states(2).T
        sizes.append(np.abs(first - second).max())
    assert np.polyfit(np.log(distances), np.log(sizes), 1)[0] == pytest.approx(0.5, abs=0.02)


@pytest.mark.slow
def test_nothing_branches_off_at_a_fold_or_a_neimark_sacker_point():
    for a0, eta, nu, bounds in ((0.01, 0.3, 3.2, (2.0, 3.4)), (0.065, 0.1, 1.6, (1.3, 1.7))):
        model = sb.Slender(sb.Column.dimensionless(C), damping=eta)
        motion = sb.Harmonic.circular(acceleration=a0, angular_frequency=nu)
        branch = continue_branch(periodic_orbit(model, motion), "angular_frequency", bounds=bounds)
        with pytest.raises(ParameterError, match="bifurcation must be") as told:
            switch_branch(branch.bifurcations[0], bounds=bounds)
        assert "\n" not in str(told.value)


@pytest.mark.parametrize("bounds", [(1.7, 2.0), (1.0, 1.2), (1.7, 1.5), (math.nan, 2.0), (1.62, 1.62)])
def test_bounds_must_enclose_the_bifurcation(straight_branches, bounds):
    (pitchfork,) = straight_branches[0.13].bifurcations
    with pytest.raises(ParameterError, match="bounds") as told:
        switch_branch(pitchfork, bounds=bounds)
    assert "\n" not in str(told.value)


@pytest.mark.slow
def test_a_family_ends_where_its_path_meets_the_upright():
    """Beyond, the lean would wind about the upright another number of times: no path leads there but through it."""
    model = sb.Slender(sb.Column.dimensionless(0.1), damping=0.1)
    motion = sb.Harmonic.straight(acceleration=0.13, angular_frequency=3.0)
    rolling = sb.orbits.continue_branch(sb.orbits.periodic_orbit(model, motion), "angular_frequency", bounds=(1.2, 4.0))
    family = sb.orbits.switch_branch(rolling.bifurcations[-1], bounds=(0.8, 4.0))
    assert family.ends[1] is sb.orbits.BranchEnd.LOST
    points = family.points
    assert set(points["turns"].values) == {1.0}
    assert float(points["angular_frequency"][-1]) == pytest.approx(0.9787, abs=1e-3)
    # Its minimum tilt falls towards nothing as the end comes near.
    assert float(points["minimum_tilt"][-1]) < 0.05 * float(points["minimum_tilt"].max())
