"""Figures of a dimensionless column label their axes in its units, those of others in SI."""

import numpy as np
import pytest
import xarray as xr

import stylobate as sb
from stylobate.plots.labels import axis_label, in_own_units, unit_label

OWN = sb.Slender(sb.Column.dimensionless(0.1), damping=0.1)
STONE = sb.Slender(sb.Column.solid(radius=0.3, height=3.0, density=2700.0), damping=0.1)
LINE = sb.Harmonic.straight(acceleration=0.1, angular_frequency=2.0)
GRID = {"angular_frequency": np.array([1.0, 2.0]), "acceleration": np.array([0.05, 0.2])}


def overturning(model):
    return sb.studies.overturning_map(model, LINE, over=GRID, duration=20.0)


def labels(figure):
    return {text for axes in figure.axes for text in (axes.get_xlabel(), axes.get_ylabel()) if text}


@pytest.mark.parametrize(
    ("model", "expected"),
    [
        (OWN, {r"base frequency $\Omega/\omega_0$", "base acceleration $a/g$"}),
        (STONE, {"angular frequency [rad/s]", "peak horizontal acceleration of the base [m/s²]"}),
    ],
)
def test_a_map_has_the_units_of_its_column(model, expected):
    assert labels(sb.plot(overturning(model))) == expected


def test_a_saved_result_keeps_the_units_of_its_column(tmp_path):
    overturning(OWN).to_netcdf(tmp_path / "map.nc")
    with xr.open_dataset(tmp_path / "map.nc") as loaded:
        assert labels(sb.plot(loaded)) == {r"base frequency $\Omega/\omega_0$", "base acceleration $a/g$"}


@pytest.mark.slow
def test_a_saved_run_keeps_the_units_of_its_column(tmp_path):
    run = sb.simulate(OWN, LINE, tilt=(0.02, 0.01), duration=5.0)
    run.save(tmp_path / "run.nc")
    shown = labels(sb.plot(sb.load(tmp_path / "run.nc")))
    assert {r"time $\omega_0 t$", "base acceleration\n$a/g$"} <= shown
    assert not any("/s" in text or "[s]" in text for text in shown)


def test_a_run_of_a_stone_is_shown_in_si():
    run = sb.simulate(STONE, sb.Harmonic.straight(acceleration=3.0, angular_frequency=4.0), duration=5.0)
    assert {"time [s]", "base acceleration\n[m/s²]"} <= labels(sb.plot(run))


@pytest.mark.slow
@pytest.mark.parametrize("draw", ["response_curves", "exact_response", "stability_boundary"])
def test_no_figure_of_a_dimensionless_column_is_labelled_in_si(draw):
    circle = sb.Harmonic.circular(acceleration=0.065, angular_frequency=2.0)
    if draw == "response_curves":
        found = sb.studies.response_curves(OWN, circle, angular_frequency=[1.8, 2.2, 2.6])
    elif draw == "exact_response":
        found = sb.studies.exact_response(OWN, circle, angular_frequency=(1.9, 2.2))
    else:
        found = sb.studies.stability_boundary(OWN, circle, bounds=(0.03, 0.08), angular_frequency=(1.2, 1.8))
    shown = labels(sb.plot(found))
    assert r"base frequency $\Omega/\omega_0$" in shown
    assert not any("/s" in text for text in shown)


def test_the_path_of_the_contact_point_has_lengths_in_units_of_the_column():
    run = sb.simulate(sb.Rolling(sb.Column.dimensionless(0.2), damping=0.1), tilt=(0.1, 0.0), duration=3.0)
    figure = sb.plots.plot_column_path(run, times=[0.0, 1.0])
    plan = figure.axes[1]
    assert plan.get_xlabel() == r"$x$ [$g/\omega_0^2$]"
    assert {text.get_text() for text in plan.texts} == {"0", "1"}
    assert not any(text.get_text().endswith(" m") for text in figure.axes[0].texts)


def test_the_numbers_and_the_result_itself_stay():
    found = overturning(OWN)
    before = {name: dict(variable.attrs) for name, variable in found.variables.items()}
    own = in_own_units(found)
    assert own.equals(found)
    assert {name: dict(variable.attrs) for name, variable in found.variables.items()} == before
    assert unit_label(own["angular_frequency"]) == r"$\omega_0$"
    assert axis_label(own["angular_frequency"], "one") == r"one [$\omega_0$]"


@pytest.mark.parametrize("other", [3.0, None, "text", [1, 2], xr.Dataset(), xr.Dataset(attrs={"provenance": "{}"})])
def test_what_has_no_column_is_returned_as_it_is(other):
    assert in_own_units(other) is other


def test_a_stone_on_a_moon_of_unit_gravity_is_no_dimensionless_column():
    stone = sb.Column.solid(radius=0.1, height=1.0, density=2000.0, gravity=1.0)
    run = sb.simulate(sb.Slender(stone), tilt=(0.01, 0.0), duration=1.0)
    assert in_own_units(run) is run
