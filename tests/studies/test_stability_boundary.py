"""Boundaries of stable rolling in two parameters, and where averaging is right about them."""

import math

import numpy as np
import pytest

import stylobate as sb
from stylobate.errors import ParameterError

C = ETA = 0.1
MODEL = sb.Slender(sb.Column.dimensionless(C), damping=ETA)
CIRCLE = sb.Harmonic.circular(acceleration=0.065, angular_frequency=3.0)
LINE = sb.Harmonic.straight(acceleration=0.1, angular_frequency=3.0)


@pytest.mark.slow
def test_under_circular_motion_the_boundary_is_the_closed_form():
    found = sb.studies.stability_boundary(
        MODEL, CIRCLE, bounds=(0.03, 0.2), angular_frequency=(0.8, 3.0), values=[0.065, 0.1]
    )
    # From two bifurcations on one curve it is followed once.
    assert found["curve_kind"].values.tolist() == ["Neimark-Sacker"]
    critical = sb.theory.critical_frequency(found["acceleration"].to_numpy(), c=C, eta=ETA)
    # The theory's own root is told to about 1e-10, the curve to 1e-10 of its bounds.
    np.testing.assert_allclose(found["angular_frequency"], critical, atol=2e-9)
    np.testing.assert_array_equal(found["supercritical"], 1)
    assert bool(found["theory_is_exact"])


@pytest.mark.slow
def test_under_straight_motion_the_boundary_passes_through_the_pitchforks():
    found = sb.studies.stability_boundary(
        MODEL, LINE, bounds=(0.035, 0.14), angular_frequency=(0.8, 4.0), values=[0.13]
    )
    assert found["curve_kind"].values.tolist() == ["pitchfork"]
    order = np.argsort(found["acceleration"].to_numpy())
    acceleration, frequency = (found[name].to_numpy()[order] for name in ("acceleration", "angular_frequency"))
    # Located on branches over the frequency; between points of the curve a straight line errs by 1e-4.
    assert np.interp(0.04, acceleration, frequency) == pytest.approx(1.087672, abs=5e-4)
    assert np.interp(0.13, acceleration, frequency) == pytest.approx(1.620454, abs=5e-4)
    averaged = np.interp(acceleration, found["theory_parameter"], found["theory_frequency"])
    assert np.all(frequency > averaged)


@pytest.mark.slow
def test_where_the_ellipse_is_nearly_a_circle_another_bifurcation_takes_over():
    ellipse = sb.Harmonic.elliptic(amplitude=(0.08, 0.04), phase=-math.pi / 2.0, angular_frequency=3.0)
    found = sb.studies.stability_boundary(
        MODEL,
        ellipse,
        parameter="amplitude_y",
        bounds=(0.07, 0.08),
        angular_frequency=(1.2, 2.0),
        values=[0.072, 0.0798],
    )
    assert sorted(found["curve_kind"].values) == ["Neimark-Sacker", "pitchfork"]
    kinds = found["curve_kind"].to_numpy()[found["curve"].to_numpy()]
    amplitude = found["amplitude_y"].to_numpy()
    assert amplitude[kinds == "pitchfork"].max() < 0.0785
    # At the circle it ends at the critical frequency of theory.
    end = found.isel(point=int(np.argmax(amplitude)))
    assert float(end["amplitude_y"]) > 0.0795
    critical = float(sb.theory.critical_frequency(0.08, c=C, eta=ETA))
    assert float(end["angular_frequency"]) == pytest.approx(critical, abs=0.01)


def test_averaging_is_exact_for_circular_motion():
    found = sb.studies.averaging_map(MODEL, CIRCLE, values=[0.05, 0.08], angular_frequency=np.linspace(1.05, 3.0, 6))
    np.testing.assert_array_equal(found["exact"], found["averaged"])
    assert float(abs(found["error"]).max()) < 1e-9


@pytest.mark.slow
def test_averaging_errs_the_more_the_larger_the_acceleration():
    found = sb.studies.averaging_map(MODEL, LINE, values=[0.04, 0.08, 0.16], angular_frequency=np.linspace(1.0, 4.0, 7))
    error = found["error"].sel(angular_frequency=3.0).to_numpy()
    assert np.all(np.diff(error) > 0.0)
    # In c units the error is of second order in a1/c.
    assert error[1] / error[0] == pytest.approx(4.0, rel=0.15)
    wrong = (found["averaged"] == 1) & (found["exact"] == 0)
    assert bool(wrong.any())
    assert not bool(((found["averaged"] == 0) & (found["exact"] == 1)).any())


@pytest.mark.parametrize(
    ("options", "told"),
    [
        ({"bounds": (0.2, 0.1)}, "bounds must rise"),
        ({"bounds": (0.1, 0.2), "values": [0.3]}, "values must lie between the bounds"),
        ({"bounds": (0.1, 0.2), "values": []}, "values must lie between the bounds"),
        ({"bounds": (0.1, 0.2), "parameter": "colour"}, "colour"),
        ({"bounds": (-0.1, 0.2)}, "bounds: values of acceleration must be zero or positive .got -0.1"),
        ({"bounds": (0.1, 0.2), "angular_frequency": (0.0, 3.0)}, "angular_frequency must rise from above zero"),
        ({"bounds": (0.0, 0.2), "parameter": "damping"}, "damping must be positive"),
    ],
)
def test_bad_input_is_told_in_one_line(options, told):
    with pytest.raises(ParameterError, match=told) as error:
        sb.studies.stability_boundary(MODEL, CIRCLE, **{"angular_frequency": (1.0, 3.0), **options})
    assert "\n" not in str(error.value)


@pytest.mark.slow
def test_a_curve_begun_on_a_bound_is_followed_once():
    # The first of the default values is the bound itself.
    found = sb.studies.stability_boundary(MODEL, LINE, bounds=(0.12, 0.14), angular_frequency=(1.3, 2.0))
    assert found["curve_kind"].values.tolist() == ["pitchfork"]


@pytest.mark.slow
def test_a_curve_that_bends_much_over_wide_bounds_is_followed_once():
    found = sb.studies.stability_boundary(
        MODEL, LINE, bounds=(0.005, 0.4), angular_frequency=(0.4, 6.0), values=[0.10375, 0.2025, 0.4]
    )
    assert found["curve_kind"].values.tolist() == ["pitchfork"]


@pytest.mark.slow
def test_without_a_loss_of_stability_it_is_told_how_rolling_is():
    above, below = (
        sb.studies.stability_boundary(MODEL, LINE, bounds=(0.1, 0.12), angular_frequency=range_, values=[0.11])
        for range_ in ((2.0, 2.5), (1.1, 1.3))
    )
    assert above.sizes["curve_index"] == below.sizes["curve_index"] == 0
    assert (above.attrs["rolling"], below.attrs["rolling"]) == ("stable", "unstable")


def test_without_damping_nothing_is_decided():
    model = sb.Slender(sb.Column.dimensionless(C), damping=0.0)
    with pytest.raises(ParameterError, match="damping must be above zero"):
        sb.studies.stability_boundary(model, LINE, bounds=(0.1, 0.2), angular_frequency=(1.0, 3.0))


def test_without_damping_exact_rolling_is_neutrally_stable_where_averaging_says_so():
    model = sb.Slender(sb.Column.dimensionless(C), damping=0.0)
    found = sb.studies.averaging_map(model, LINE, values=[0.04], angular_frequency=[2.0, 3.0, 4.0])
    assert found.attrs["friction"] == 0
    np.testing.assert_array_equal(found["averaged"], 1)
    np.testing.assert_array_equal(found["exact"], 1)


@pytest.mark.parametrize(
    ("options", "told"),
    [
        ({"values": [0.1], "angular_frequency": [3.0, 1.0]}, "must be two or more frequencies that rise"),
        ({"values": [], "angular_frequency": [1.0, 3.0]}, "values must hold"),
        ({"values": [-0.1, 0.1], "angular_frequency": [1.0, 3.0]}, "values of acceleration must be zero or positive"),
    ],
)
def test_a_map_that_cannot_be_is_told_in_one_line(options, told):
    with pytest.raises(ParameterError, match=told) as error:
        sb.studies.averaging_map(MODEL, LINE, **options)
    assert "bounds" not in str(error.value)
