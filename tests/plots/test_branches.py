"""Figures of branches and of curves of bifurcations show what these hold."""

import numpy as np
import pytest

import stylobate as sb
from stylobate.errors import ParameterError
from stylobate.plots.style import STABLE_WIDTH

pytestmark = pytest.mark.long

MODEL = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
LINE = sb.Harmonic.straight(acceleration=0.13, angular_frequency=1.65)


@pytest.fixture(scope="module")
def symmetric():
    return sb.orbits.continue_branch(
        sb.orbits.periodic_orbit(MODEL, LINE), "angular_frequency", bounds=(1.58, 1.65), both_ways=True
    )


@pytest.fixture(scope="module")
def asymmetric(symmetric):
    return sb.orbits.switch_branch(symmetric.bifurcations[0], bounds=(1.58, 1.65))


KEY = ["pitchfork, supercritical", "bold: stable", "range of the tilt over a period"]


def texts(axes):
    return [text.get_text() for text in axes.get_legend().get_texts()]


def test_a_branch_is_bold_where_it_is_stable_and_marks_its_bifurcation(symmetric):
    axes = sb.plot(symmetric).axes[0]
    thin, bold, mark = axes.lines[:3]
    points = symmetric.points
    np.testing.assert_array_equal(thin.get_ydata(), points["mean_tilt"])
    assert bold.get_linewidth() == STABLE_WIDTH
    drawn = np.isfinite(bold.get_ydata())
    assert drawn[points["stable"]].all()
    assert 0 < np.count_nonzero(~drawn) < points.sizes["point"]
    np.testing.assert_array_equal(mark.get_xdata(), [symmetric.bifurcations[0].parameter])
    assert texts(axes) == KEY
    assert axes.get_xlabel() == r"base frequency $\Omega/\omega_0$"


def test_branches_are_compared_under_their_names(symmetric, asymmetric):
    axes = sb.plot([symmetric, asymmetric], labels=["symmetric", "asymmetric"]).axes[0]
    named = texts(axes)
    assert named[:2] == ["symmetric", "asymmetric"]
    assert len(set(named)) == len(named)
    assert texts(sb.plot([symmetric, symmetric]).axes[0]) == KEY


def test_branches_over_different_parameters_have_no_common_axis(symmetric):
    orbit = symmetric.orbit(0)
    other = sb.orbits.continue_branch(orbit, "damping", bounds=(0.099, 0.101))
    with pytest.raises(ParameterError, match="branches must have one parameter, got angular_frequency, damping"):
        sb.plot([symmetric, other])


def test_a_curve_is_drawn_over_its_two_parameters(symmetric):
    curve = sb.orbits.bifurcation_curve(symmetric.bifurcations[0], "acceleration", bounds=((1.6, 1.66), (0.12, 0.14)))
    axes = sb.plot(curve).axes[0]
    np.testing.assert_array_equal(axes.lines[0].get_xdata(), curve.points["angular_frequency"])
    np.testing.assert_array_equal(axes.lines[0].get_ydata(), curve.points["acceleration"])
    assert texts(axes) == ["pitchfork", "supercritical"]
    assert axes.get_ylabel() == "base acceleration $a/g$"
    with pytest.raises(ParameterError, match="curves must have the same two parameters"):
        sb.plot(
            [
                curve,
                sb.orbits.bifurcation_curve(symmetric.bifurcations[0], "damping", bounds=((1.6, 1.66), (0.099, 0.101))),
            ]
        )
    with pytest.raises(ParameterError, match="a sequence of runs, branches or curves"):
        sb.plot([curve, symmetric])
