"""Families followed over a parameter: through folds, from both ends, over any parameter."""

import math

import numpy as np
import pytest

import stylobate as sb
from stylobate.errors import ParameterError, UnsupportedError
from stylobate.orbits import BifurcationKind, BranchEnd, StepControl, continue_branch, periodic_orbit
from stylobate.theory.rolling import rolling_gap

C = 0.1


def slender(eta=0.1):
    return sb.Slender(sb.Column.dimensionless(C), damping=eta)


def circular_orbit(nu=2.0, a0=0.065, eta=0.1):
    return periodic_orbit(slender(eta), sb.Harmonic.circular(acceleration=a0, angular_frequency=nu))


@pytest.mark.slow
def test_every_point_of_a_branch_of_circular_motion_is_steady_rolling():
    branch = continue_branch(circular_orbit(), "angular_frequency", bounds=(1.2, 2.5))
    points = branch.points
    nu = points["angular_frequency"].to_numpy()
    rolling = sb.theory.steady_rolling(nu, 0.065, c=C, eta=0.1).upper
    np.testing.assert_allclose(points["mean_tilt"], rolling.amplitude, rtol=0.0, atol=1e-11)
    # On the point of bifurcation itself, where it is among them, nothing is decided.
    away = np.abs(nu - sb.theory.critical_frequency(0.065, c=C, eta=0.1)) > 1e-8
    np.testing.assert_array_equal(points["stable"][away], rolling.stable[away])
    expected = np.exp(2.0 * math.pi / nu[:, np.newaxis] * rolling.eigenvalues)
    found = points["multiplier"].to_numpy() @ np.array([1.0, 1j])
    np.testing.assert_allclose(np.sort(np.abs(found), axis=1), np.sort(np.abs(expected), axis=1), rtol=0.0, atol=1e-8)
    assert (nu[0], nu[-1]) == pytest.approx((1.2, 2.5), rel=1e-12)
    assert np.all(np.diff(nu) > 0.0)
    assert branch.ends == (BranchEnd.BOUND, BranchEnd.BOUND)


@pytest.mark.slow
@pytest.mark.parametrize(("side", "nu", "bounds"), [(1, 3.2, (2.0, 3.4)), (0, 0.3, (0.25, 1.4))])
def test_a_branch_goes_round_its_fold_to_the_lower_branch(side, nu, bounds):
    """Folds of circular motion: a0²(1 + ν²)² = η²ν²(c² − a0²), where A = c(1 + ν²)/D."""
    a0, eta = 0.01, 0.3
    branch = continue_branch(circular_orbit(nu, a0, eta), "angular_frequency", bounds=bounds)
    (fold,) = (one for one in branch.bifurcations if one.kind is BifurcationKind.FOLD)
    at = fold.parameter
    # The closed form, solved for ν.
    ratio = eta * math.sqrt(C**2 - a0**2) / a0
    expected = 0.5 * (ratio + (1 if side else -1) * math.sqrt(ratio**2 - 4.0))
    assert at == pytest.approx(expected, abs=1e-8)
    assert at == pytest.approx(float(rolling_gap(a0, c=C, eta=eta)[side]), abs=1e-8)
    d = (1.0 + at**2) ** 2 + (eta * at) ** 2
    # The tilt goes with the square root of the distance from the fold.
    assert fold.orbit.mean_tilt == pytest.approx(C * (1.0 + at**2) / d, rel=1e-6)
    assert abs(fold.multiplier - 1.0) < 1e-5
    assert fold.supercritical is None
    rolling = sb.theory.steady_rolling(nu, a0, c=C, eta=eta)
    tilts = sorted(orbit.mean_tilt for orbit in branch.orbits_at(nu * 1.01 if side else nu * 0.99))
    rolling = sb.theory.steady_rolling(nu * 1.01 if side else nu * 0.99, a0, c=C, eta=eta)
    assert tilts == pytest.approx([float(rolling.lower.amplitude), float(rolling.upper.amplitude)], abs=1e-11)


@pytest.mark.slow
@pytest.mark.parametrize("a1", [0.04, 0.13])
def test_followed_from_either_end_a_branch_is_the_same(straight_branches, a1):
    branch = straight_branches[a1]
    back = continue_branch(branch.orbit(0), "angular_frequency", bounds=(branch.path[0].value, branch.path[-1].value))
    low, high = branch.path[0].value, branch.path[-1].value
    for value in np.linspace(low, high, 7)[1:-1] + 1e-3:
        (one,), (other,) = branch.orbits_at(value), back.orbits_at(value)
        np.testing.assert_allclose(one.state, other.state, rtol=0.0, atol=1e-11)
        assert np.abs(one.multipliers[0]) == pytest.approx(np.abs(other.multipliers[0]), rel=1e-8)
    assert len(back.bifurcations) == len(branch.bifurcations)
    for one, other in zip(branch.bifurcations, back.bifurcations, strict=True):
        assert one.kind is other.kind
        assert one.parameter == pytest.approx(other.parameter, abs=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("largest", [0.005, 0.05])
def test_a_branch_does_not_depend_on_its_steps(straight_branches, largest):
    usual = straight_branches[0.04]
    branch = continue_branch(
        usual.orbit(len(usual.path) // 2), "angular_frequency", bounds=(0.9, 2.0), control=StepControl(largest=largest)
    )
    for value in (0.95, 1.3, 1.9):
        (one,), (other,) = usual.orbits_at(value), branch.orbits_at(value)
        np.testing.assert_allclose(one.state, other.state, rtol=0.0, atol=1e-11)


@pytest.mark.parametrize("nu", [2.0, pytest.param(3.0, marks=pytest.mark.slow)])
def test_with_the_acceleration_circular_rolling_ends_at_the_upright(nu):
    """On the lower arm A → 0 as a0 → c; nothing of the other arm is followed again from there."""
    branch = continue_branch(circular_orbit(nu), "acceleration", bounds=(0.001, 0.3))
    assert branch.ends == (BranchEnd.LOST, BranchEnd.BOUND)
    points = branch.points
    a0, tilt = points["acceleration"].to_numpy(), points["mean_tilt"].to_numpy()
    (fold,) = (one for one in branch.bifurcations if one.kind is BifurcationKind.FOLD)
    at = int(np.argmin(a0))
    assert a0[at] == fold.parameter
    assert np.all(np.diff(a0[: at + 1]) < 0.0)
    assert np.all(np.diff(a0[at:]) > 0.0)
    rolling = sb.theory.steady_rolling(nu, a0, c=C, eta=0.1)
    # The tilt goes with the square root of the distance from the fold: two on either side of it are left out.
    for part, expected in ((slice(0, at - 2), rolling.lower), (slice(at + 3, None), rolling.upper)):
        np.testing.assert_allclose(tilt[part], expected.amplitude[part], rtol=0.0, atol=1e-10)
        # On the point of bifurcation itself, where it is among them, nothing is decided.
        away = ~np.isin(a0[part], [one.parameter for one in branch.bifurcations])
        np.testing.assert_array_equal(points["stable"][part][away], expected.stable[part][away])
    # By the closed form the tilt at the end is (c − a0) / (1 + ν²) but for friction.
    assert tilt[0] < 1e-4 * C
    assert a0[0] == pytest.approx(C, rel=1e-3)
    assert len(branch.orbits_at(0.2)) == 1
    assert sum(one.kind is BifurcationKind.NEIMARK_SACKER for one in branch.bifurcations) <= 1


def test_a_step_that_ends_farther_off_than_it_is_long_is_not_made():
    branch = continue_branch(circular_orbit(2.0), "acceleration", bounds=(0.001, 0.3))
    u = np.array([point.u for point in branch.path])
    # Half the largest step along the tangent, and as much as that across it.
    assert np.linalg.norm(np.diff(u, axis=0), axis=1).max() <= 1.5 * StepControl().largest


PARAMETERS = [
    ("amplitude_x", (0.06, 0.1), 0.09),
    ("amplitude_y", (0.03, 0.06), 0.05),
    ("phase_difference", (-2.0, -1.2), -1.4),
    ("acceleration", (0.07, 0.1), 0.09),
    ("damping", (0.05, 0.2), 0.15),
    ("slenderness", (0.08, 0.12), 0.11),
    ("rotation", (-0.3, 0.3), 0.2),
    ("scale", (0.9, 1.2), 1.1),
]


@pytest.mark.parametrize(("name", "bounds", "value"), PARAMETERS)
def test_followed_over_any_parameter_an_orbit_is_that_found_there(name, bounds, value):
    model = slender()
    motion = sb.Harmonic.elliptic(amplitude=(0.08, 0.04), phase=-math.pi / 2.0, angular_frequency=2.5)
    branch = continue_branch(periodic_orbit(model, motion), name, bounds=bounds)
    assert branch.ends == (BranchEnd.BOUND, BranchEnd.BOUND)
    assert [branch.path[0].value, branch.path[-1].value] == pytest.approx(bounds, rel=1e-9)
    (orbit,) = branch.orbits_at(value)
    changed_model, changed_motion = sb.with_parameters(model, motion, **{name: value})
    near = np.concatenate([orbit.tilt, orbit.tilt_rate]) * (1.0 + 1e-3)
    direct = periodic_orbit(changed_model, changed_motion, guess=near)
    np.testing.assert_allclose(orbit.state, direct.state, rtol=0.0, atol=1e-11)


@pytest.mark.parametrize("start", [0.0, 0.05])
def test_friction_can_be_followed_down_to_none(start):
    """Above ν* without friction (1.40 at a0 = 0.065), all multipliers come to lie on the unit circle."""
    branch = continue_branch(circular_orbit(eta=start), "damping", bounds=(0.0, 0.1))
    assert branch.path[0].value == 0.0
    (orbit,) = branch.orbits_at(0.0)
    np.testing.assert_allclose(np.abs(orbit.multipliers), 1.0, atol=1e-7)
    rolling = sb.theory.steady_rolling(2.0, 0.065, c=C, eta=0.0).upper
    assert orbit.mean_tilt == pytest.approx(float(rolling.amplitude), rel=1e-10)


def test_orbits_at_a_point_of_the_path_are_given_once():
    branch = continue_branch(circular_orbit(2.0), "angular_frequency", bounds=(1.5, 2.5))
    assert len(branch.orbits_at(2.0)) == 1
    assert len(branch.orbits_at(branch.path[3].value)) == 1
    assert len(branch.orbits_at(branch.path[0].value)) == 1
    assert branch.orbits_at(2.6) == ()


@pytest.mark.slow
def test_an_orbit_in_a_plane_is_followed_as_theory_says():
    """Both closed forms at each point: symmetric rocking of the half-period map."""
    motion = sb.Harmonic.straight(acceleration=0.13, angular_frequency=3.0)
    orbit = periodic_orbit(slender(), motion, guess=[0.02523651, 0.0, -0.00401839, 0.0])
    branch = continue_branch(orbit, "angular_frequency", bounds=(2.5, 4.0))
    points = branch.points
    expected = sb.theory.planar_forced_response(points["angular_frequency"], 0.13, c=C, eta=0.1).fast
    assert np.all(expected.exists)
    found = np.sort_complex(points["multiplier"].to_numpy() @ np.array([1.0, 1j]))
    squares = np.sort(np.abs(expected.multipliers**2), axis=1)
    # Near a double multiplier half the digits are lost.
    np.testing.assert_allclose(np.sort(np.abs(found), axis=1), squares, rtol=0.0, atol=1e-5)
    np.testing.assert_array_equal(points["stable"], expected.stable_in_plane)
    assert points.attrs["planar"] == 1


def test_progress_tells_every_new_point():
    told = []
    branch = continue_branch(
        circular_orbit(2.0), "angular_frequency", bounds=(1.5, 2.5), both_ways=False, progress=told.append
    )
    assert told == [point.value for point in branch.path[1:]]
    assert branch.ends == (BranchEnd.BEGUN, BranchEnd.BOUND)


def test_as_many_points_as_asked_for():
    branch = continue_branch(circular_orbit(2.0), "angular_frequency", bounds=(1.5, 2.5), control=StepControl(most=4))
    assert len(branch.path) == 1 + 2 * 4
    assert branch.ends == (BranchEnd.STEPS, BranchEnd.STEPS)


@pytest.mark.parametrize(
    ("name", "bounds", "words"),
    [
        ("angular_frequency", (2.1, 2.5), "bounds"),
        ("angular_frequency", (1.0, 1.9), "bounds"),
        ("angular_frequency", (2.5, 1.5), "bounds"),
        ("angular_frequency", (2.0, 2.0), "bounds"),
        ("angular_frequency", (math.nan, 3.0), "bounds"),
        ("angular_frequency", (1.0, math.inf), "bounds"),
        ("angular_frequency", (1.0, 2.5, 3.0), "bounds"),
        ("frequency", (1.0, 2.5), "frequency"),
        ("", (1.0, 2.5), "known"),
    ],
)
def test_bad_input_is_told_in_one_line(name, bounds, words):
    with pytest.raises(ParameterError, match=words) as told:
        continue_branch(circular_orbit(2.0), name, bounds=bounds)
    assert "\n" not in str(told.value)


def test_a_number_that_the_motion_lacks_is_refused():
    model = slender()
    both = sb.Harmonic.straight(acceleration=0.05, angular_frequency=2.0) + sb.Harmonic.straight(
        acceleration=0.04, angular_frequency=2.0, direction=1.0, start_phase=-1.5
    )
    orbit = periodic_orbit(model, both, guess=circular_orbit(2.0, 0.04).state)
    with pytest.raises(UnsupportedError, match="angular_frequency"):
        continue_branch(orbit, "angular_frequency", bounds=(1.0, 3.0))
