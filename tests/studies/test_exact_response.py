"""Response curves of exact orbits: what theory knows exactly they equal, what averaging misses they show."""

import math

import numpy as np
import pytest
import xarray as xr

import stylobate as sb
from stylobate.errors import NoOrbitError, ParameterError
from stylobate.orbits import StepControl

pytestmark = pytest.mark.long

C = ETA = 0.1
MODEL = sb.Slender(sb.Column.dimensionless(C), damping=ETA)
LINE = sb.Harmonic.straight(acceleration=0.13, angular_frequency=3.0)


@pytest.fixture(scope="module")
def straight():
    return sb.studies.exact_response(MODEL, LINE, angular_frequency=(0.8, 8.0))


def family(curves, index):
    return curves.isel(point=np.nonzero(curves["branch"].to_numpy() == index)[0])


def test_circular_motion_has_the_response_of_the_exact_solution():
    motion = sb.Harmonic.circular(acceleration=0.065, angular_frequency=3.0)
    curves = sb.studies.exact_response(MODEL, motion, angular_frequency=(1.0, 4.0))
    steady = sb.theory.steady_rolling(curves["angular_frequency"].to_numpy(), 0.065, c=C, eta=ETA).upper
    np.testing.assert_allclose(curves["mean_tilt"], steady.amplitude, rtol=1e-10)
    np.testing.assert_allclose(curves["phase"], steady.phase, atol=1e-9)
    np.testing.assert_allclose(curves["minimum_tilt"], curves["peak_tilt"], rtol=1e-9)
    # On the bifurcation itself neither of the two calls it stable alike.
    apart = np.abs(curves["angular_frequency"] - curves["averaged_critical_frequency"]) > 1e-6
    np.testing.assert_array_equal(curves["stable"][apart], steady.stable[apart])
    assert bool(curves["averaged_is_exact"])
    assert curves["bifurcation_kind"].values.tolist() == ["Neimark-Sacker"]
    assert float(curves["bifurcation_angular_frequency"][0]) == pytest.approx(1.397107589247, abs=1e-9)


@pytest.mark.slow
def test_rolling_under_straight_motion_loses_its_stability_above_the_averaged_frequency(straight):
    rolling = family(straight, 0)
    stable = rolling["stable"].to_numpy()
    lowest = rolling["angular_frequency"].to_numpy()[stable].min()
    located = straight["bifurcation_angular_frequency"].to_numpy()
    assert located[1] == pytest.approx(1.620453934, abs=1e-8)
    assert lowest > located[1] > float(straight["averaged_critical_frequency"]) == pytest.approx(1.3971075892)
    # Bold lines end at bifurcations: each is a point of its family.
    for place, index in zip(located, straight["bifurcation_branch"].to_numpy(), strict=True):
        assert np.abs(family(straight, index)["angular_frequency"] - place).min() == 0.0


def test_what_is_born_at_a_pitchfork_begins_at_the_orbit_that_bears_it(straight):
    names = straight["branch_name"].to_numpy()
    assert names[0] == "rolling"
    born = family(straight, 2)
    # The first orbit lies 0.002 c off in state, hence nearer than that squared in the parameter.
    assert float(born["angular_frequency"][0]) == pytest.approx(1.620453934, abs=1e-4)
    assert float(born["mean_tilt"][0]) == pytest.approx(float(straight["bifurcation_mean_tilt"][1]), rel=1e-3)
    assert float(born["angular_frequency"][0]) == float(straight["bifurcation_angular_frequency"][1])
    assert not bool(born["stable"][0])
    assert bool(born["stable"][1])
    assert int(straight["bifurcation_supercritical"][1]) == 1


@pytest.mark.slow
def test_a_branch_does_not_depend_on_its_steps(straight):
    fine = sb.studies.exact_response(
        MODEL, LINE, angular_frequency=(1.2, 8.0), generations=0, control=StepControl(largest=0.007)
    )
    coarse = family(straight, 0).sortby("angular_frequency")
    inside = coarse.sel(point=coarse["angular_frequency"] > 1.2)
    again = fine.swap_dims(point="angular_frequency").drop_duplicates("angular_frequency").sortby("angular_frequency")
    # Between points 0.05 apart a cubic through the finer ones errs by about 1e-6 of the curve.
    between = again["mean_tilt"].interp(angular_frequency=inside["angular_frequency"].to_numpy(), method="cubic")
    np.testing.assert_allclose(between, inside["mean_tilt"], rtol=2e-5)


def test_the_response_is_made_in_less_than_a_few_seconds_and_saved(straight, tmp_path):
    straight.assign(
        {name: data.astype("int8") for name, data in straight.data_vars.items() if data.dtype == bool}
    ).to_netcdf(tmp_path / "curves.nc", engine="h5netcdf")
    with xr.open_dataset(tmp_path / "curves.nc") as read:
        np.testing.assert_array_equal(read["mean_tilt"], straight["mean_tilt"])


@pytest.mark.slow
def test_a_sense_that_is_asked_for_is_followed():
    curves = [
        sb.studies.exact_response(MODEL, LINE, angular_frequency=(2.9, 3.1), sense=sense, generations=0)
        for sense in (1, -1)
    ]
    np.testing.assert_array_equal(curves[0]["turns"], 1.0)
    np.testing.assert_array_equal(curves[1]["turns"], -1.0)
    # Mirror images of each other about the line of the base motion.
    assert float(curves[0]["mean_tilt"][-1]) == pytest.approx(float(curves[1]["mean_tilt"][-1]), rel=1e-9)


@pytest.mark.parametrize("bad", [(2.0, 1.0), (0.0, 1.0), (1.0, math.nan)])
def test_a_range_that_is_none_is_refused(bad):
    with pytest.raises(ParameterError, match="angular_frequency must rise"):
        sb.studies.exact_response(MODEL, LINE, angular_frequency=bad)


def test_where_nothing_rolls_it_is_told():
    # With this friction steady rolling exists nowhere between the folds.
    model = sb.Slender(sb.Column.dimensionless(C), damping=0.3)
    motion = sb.Harmonic.circular(acceleration=0.01, angular_frequency=1.0)
    with pytest.raises(NoOrbitError, match="no orbit was found between"):
        sb.studies.exact_response(model, motion, angular_frequency=(0.6, 1.6))


def test_an_orbit_of_another_base_motion_or_column_is_refused():
    weak = sb.Harmonic.straight(acceleration=0.04, angular_frequency=2.5)
    with pytest.raises(ParameterError, match="orbit must be an orbit under"):
        sb.studies.exact_response(
            MODEL, LINE, angular_frequency=(2.0, 3.0), orbit=sb.orbits.periodic_orbit(MODEL, weak)
        )
    other = sb.Slender(sb.Column.dimensionless(C), damping=0.12)
    with pytest.raises(ParameterError, match="orbit must be one of the model"):
        sb.studies.exact_response(
            MODEL, LINE, angular_frequency=(2.0, 3.0), orbit=sb.orbits.periodic_orbit(other, LINE)
        )


def test_an_orbit_outside_the_range_is_refused():
    orbit = sb.orbits.periodic_orbit(MODEL, LINE)
    with pytest.raises(ParameterError, match="angular_frequency must enclose that of the orbit"):
        sb.studies.exact_response(MODEL, LINE, angular_frequency=(2.0, 2.5), orbit=orbit)


@pytest.mark.slow
def test_an_orbit_at_another_frequency_begins_the_same_family():
    at = sb.Harmonic.straight(acceleration=0.13, angular_frequency=2.5)
    own = sb.studies.exact_response(
        MODEL, LINE, angular_frequency=(2.4, 2.6), orbit=sb.orbits.periodic_orbit(MODEL, at), generations=0
    )
    assert float(own["mean_tilt"].sel(point=0)) == pytest.approx(
        sb.orbits.periodic_orbit(MODEL, sb.Harmonic.straight(acceleration=0.13, angular_frequency=2.4)).mean_tilt,
        rel=1e-9,
    )


@pytest.fixture(scope="module")
def wide():
    return sb.studies.exact_response(MODEL, LINE, angular_frequency=(1.2, 3.0))


@pytest.mark.slow
def test_stability_is_known_on_either_side_of_every_bifurcation(wide):
    for index in range(wide.sizes["branch_index"]):
        part = family(wide, index)
        located = np.isin(part["angular_frequency"], wide["bifurcation_angular_frequency"])
        assert not np.any(located[1:] & located[:-1])
    asymmetric = family(wide, 1)
    window = (asymmetric["angular_frequency"] > 1.5334) & (asymmetric["angular_frequency"] < 1.5399)
    # Between the Neimark-Sacker point and the doubling, where steps of this range leave no orbit.
    assert bool(asymmetric["stable"][window].all())
    assert window.any()
    assert not bool(asymmetric["stable"][asymmetric["angular_frequency"] < 1.5333].any())


@pytest.mark.slow
def test_each_family_is_followed_once_and_along_its_length_once():
    curves = sb.studies.exact_response(MODEL, LINE, angular_frequency=(1.4, 2.0), generations=2)
    assert curves["branch_periods"].values.tolist() == [1, 1, 2]
    assert curves.sizes["bifurcation"] == 7
    assert np.unique(curves["bifurcation_angular_frequency"].values.round(8)).size == 7
    # The doubled orbits reach from one doubling of the asymmetric ones to the other.
    ends = family(curves, 2)["angular_frequency"].values[[0, -1]]
    doublings = curves["bifurcation_angular_frequency"].values[1:3]
    np.testing.assert_array_equal(ends, doublings)


@pytest.mark.slow
def test_rocking_has_no_averaged_rolling_beside_it():
    orbit = sb.orbits.periodic_orbit(MODEL, LINE, guess=[0.02523651, 0.0, -0.00401839, 0.0])
    curves = sb.studies.exact_response(MODEL, LINE, angular_frequency=(2.5, 4.0), orbit=orbit, generations=0)
    assert curves.attrs["planar"] == 1
    assert not [name for name in curves if str(name).startswith("averaged")]


def test_every_number_has_its_unit(wide):
    for name in ("mean_tilt", "minimum_tilt", "peak_tilt", "phase", "tilt", "bifurcation_mean_tilt"):
        assert wide[name].attrs["units"] == "rad"
    for name in ("angular_frequency", "bifurcation_angular_frequency"):
        assert wide[name].attrs["units"] == "rad s-1"


@pytest.mark.parametrize(
    ("options", "told"),
    [
        ({"angular_frequency": np.linspace(1.0, 2.0, 5)}, "angular_frequency must be two numbers"),
        ({"angular_frequency": (1.0, 2.0), "generations": -1}, "generations must be a whole number of at least 0"),
        ({"angular_frequency": (1.0, 2.0), "orbit": 3}, "orbit must be a PeriodicOrbit"),
    ],
)
def test_bad_input_is_told_in_one_line(options, told):
    with pytest.raises(ParameterError, match=told) as error:
        sb.studies.exact_response(MODEL, LINE, **options)
    assert "\n" not in str(error.value)


def test_a_range_without_rolling_asks_for_no_guess():
    weak = sb.Harmonic.straight(acceleration=0.001, angular_frequency=3.0)
    with pytest.raises(NoOrbitError, match="increase the acceleration") as error:
        sb.studies.exact_response(MODEL, weak, angular_frequency=(1.0, 2.0))
    assert "guess" not in str(error.value)
