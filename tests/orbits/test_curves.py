"""Curves of bifurcations in two parameters against closed forms, and against what is located over one parameter."""

import math

import numpy as np
import pytest

import stylobate as sb
from stylobate.errors import ParameterError
from stylobate.orbits import BifurcationKind, bifurcation_curve, continue_branch, periodic_orbit

C = ETA = 0.1
MODEL = sb.Slender(sb.Column.dimensionless(C), damping=ETA)


def branch_of(motion, model=MODEL, bounds=(0.8, 4.0)):
    return continue_branch(periodic_orbit(model, motion), "angular_frequency", bounds=bounds)


@pytest.fixture(scope="module")
def modulating():
    motion = sb.Harmonic.circular(acceleration=0.065, angular_frequency=3.0)
    return branch_of(motion).bifurcations[0]


@pytest.mark.parametrize("acceleration", [0.065, 0.1])
def test_the_neimark_sacker_curve_is_the_critical_frequency_of_theory_wherever_it_is_begun(acceleration, modulating):
    begun = modulating
    if acceleration != 0.065:
        motion = sb.Harmonic.circular(acceleration=acceleration, angular_frequency=3.0)
        begun = branch_of(motion, bounds=(1.2, 3.0)).bifurcations[0]
    curve = bifurcation_curve(begun, "acceleration", bounds=((0.8, 4.0), (0.03, 0.2)))
    frequency, acceleration = np.transpose([point.values for point in curve.path])
    # Both are told to about 1e-10 of the widths of the bounds.
    np.testing.assert_allclose(frequency, sb.theory.critical_frequency(acceleration, c=C, eta=ETA), atol=2e-9)
    np.testing.assert_array_equal(curve.points["supercritical"], 1)


@pytest.mark.long
def test_the_curve_over_friction_too(modulating):
    curve = bifurcation_curve(modulating, "damping", bounds=((0.8, 4.0), (0.05, 0.5)))
    for frequency, damping in [point.values for point in curve.path][::4]:
        assert frequency == pytest.approx(float(sb.theory.critical_frequency(0.065, c=C, eta=damping)), abs=2e-9)


@pytest.mark.long
def test_the_fold_curve_is_where_the_two_branches_of_rolling_meet():
    eta = 0.3
    model = sb.Slender(sb.Column.dimensionless(C), damping=eta)
    motion = sb.Harmonic.circular(acceleration=0.01, angular_frequency=4.0)
    fold = next(one for one in branch_of(motion, model, (1.5, 6.0)).bifurcations if one.kind is BifurcationKind.FOLD)
    curve = bifurcation_curve(fold, "acceleration", bounds=((1.5, 6.0), (0.006, 0.013)))
    nu, a0 = np.transpose([point.values for point in curve.path])
    # The discriminant of (8), relative to its terms.
    positive, negative = a0**2 * (1.0 + nu**2) ** 2, eta**2 * nu**2 * (C**2 - a0**2)
    np.testing.assert_allclose(positive, negative, rtol=1e-8)
    assert np.ptp(a0) > 0.005
    np.testing.assert_array_equal(curve.points["supercritical"], -1)


@pytest.mark.long
def test_the_pitchfork_curve_meets_what_is_located_at_other_amplitudes():
    at = {}
    for a1 in (0.04, 0.13):
        branch = branch_of(sb.Harmonic.straight(acceleration=a1, angular_frequency=3.0))
        at[a1] = max(branch.bifurcations, key=lambda one: one.parameter)
    assert at[0.04].parameter == pytest.approx(1.087672063, abs=1e-8)
    curve = bifurcation_curve(at[0.13], "amplitude_x", bounds=((0.8, 4.0), (0.03, 0.2)))
    frequency, amplitude = np.transpose([point.values for point in curve.path])
    order = np.argsort(amplitude)
    # A cubic through points 0.003 apart in amplitude.
    from scipy.interpolate import CubicSpline

    spline = CubicSpline(amplitude[order], frequency[order])
    assert float(spline(0.04)) == pytest.approx(at[0.04].parameter, abs=2e-6)
    assert curve.kind is BifurcationKind.PITCHFORK


def test_an_orbit_that_is_its_own_mirror_image_is_told():
    line = sb.Harmonic.straight(acceleration=0.13, angular_frequency=3.0, direction=0.4)
    rolling = periodic_orbit(MODEL, line)
    assert rolling.inversion
    assert not rolling.reflection
    circle = sb.Harmonic.circular(acceleration=0.065, angular_frequency=3.0)
    assert not periodic_orbit(MODEL, circle).reflection
    # Rocking in the plane leans the other way along the line, and not at all across it: it has both.
    rocking = periodic_orbit(
        MODEL,
        sb.Harmonic.straight(acceleration=0.13, angular_frequency=3.0, start_phase=-0.63),
        guess=(0.01, 0.0, 0.078, 0.0),
    )
    assert rocking.planar
    assert rocking.inversion
    assert rocking.reflection


@pytest.mark.parametrize(
    ("parameter", "bounds", "told"),
    [
        ("angular_frequency", ((0.8, 4.0), (0.8, 4.0)), "parameter must differ from angular_frequency"),
        ("acceleration", ((0.8, 4.0), (0.1, 0.4)), "bounds must be two numbers that enclose"),
        ("acceleration", ((0.8, 4.0), (0.01, math.nan)), "bounds must be two numbers that enclose"),
        ("colour", ((0.8, 4.0), (0.01, 0.4)), "colour"),
    ],
)
def test_bad_input_is_told_in_one_line(modulating, parameter, bounds, told):
    with pytest.raises(ParameterError, match=told) as error:
        bifurcation_curve(modulating, parameter, bounds=bounds)
    assert "\n" not in str(error.value)
