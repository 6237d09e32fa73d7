"""Orbits, branches and curves kept in files."""

import math

import numpy as np
import pytest
import xarray as xr

import stylobate as sb
from stylobate.errors import FileError, ParameterError
from stylobate.orbits import bifurcation_curve, continue_branch, periodic_orbit
from stylobate.orbits.storage import load_orbits

MODEL = sb.Slender(sb.Column.dimensionless(0.1), damping=0.1)
CIRCLE = sb.Harmonic.circular(acceleration=0.065, angular_frequency=2.0)


@pytest.fixture(scope="module")
def orbit():
    return periodic_orbit(MODEL, CIRCLE)


@pytest.fixture(scope="module")
def branch(orbit):
    return continue_branch(orbit, "angular_frequency", bounds=(1.3, 2.1))


def test_an_orbit_is_read_as_it_was_saved(orbit, tmp_path):
    again = load_orbits(orbit.save(tmp_path / "orbit.nc"))
    np.testing.assert_array_equal(again.state, orbit.state)
    np.testing.assert_array_equal(again.multipliers, orbit.multipliers)


def test_a_branch_is_read_as_it_was_saved(branch, tmp_path):
    again = load_orbits(branch.save(tmp_path / "branch.nc"))
    xr.testing.assert_identical(again.points.drop_attrs(), branch.points.drop_attrs())
    assert again.ends == branch.ends


def test_a_curve_is_read_as_it_was_saved(branch, tmp_path):
    bounds = ((1.0, 2.0), (0.05, 0.08))
    curve = bifurcation_curve(branch.bifurcations[0], "acceleration", bounds=bounds)
    again = load_orbits(curve.save(tmp_path / "curve.nc"))
    xr.testing.assert_identical(again.points.drop_attrs(), curve.points.drop_attrs())
    assert (again.kind, again.parameters, again.ends) == (curve.kind, curve.parameters, curve.ends)


def test_only_netcdf_is_written_and_only_to_folders_that_exist(orbit, tmp_path):
    for name in ("orbit.txt", "orbit", "orbit.nc.gz"):
        with pytest.raises(ParameterError, match=r"path must end in \.nc"):
            orbit.save(tmp_path / name)
    assert not list(tmp_path.iterdir())
    with pytest.raises(FileError, match="there is no folder") as told:
        orbit.save(tmp_path / "none" / "orbit.nc")
    assert "\n" not in str(told.value)


def test_a_file_that_holds_no_orbit_is_told_in_one_line(tmp_path):
    (tmp_path / "text.nc").write_text("nothing of the kind", encoding="utf-8")
    sb.simulate(MODEL, CIRCLE, tilt=(0.01, 0.0), duration=1.0).save(tmp_path / "run.nc")
    xr.Dataset({"a": 1.0}, attrs={"kind": "map"}).to_netcdf(tmp_path / "map.nc", engine="h5netcdf")
    xr.Dataset({"a": math.pi}).to_netcdf(tmp_path / "other.nc", engine="h5netcdf")
    words = {
        "nofile.nc": "there is no such file",
        "": "it is a folder",
        "text.nc": "it is not a netCDF file",
        "run.nc": "a run; stylobate.load reads it",
        "map.nc": "a table of kind 'map'; xarray.open_dataset reads it",
        "other.nc": "other data; xarray.open_dataset reads them",
    }
    for name, expected in words.items():
        with pytest.raises(FileError, match=expected) as told:
            load_orbits(tmp_path / name)
        assert "\n" not in str(told.value)
        assert "HDF5" not in str(told.value)
    with pytest.raises(ParameterError, match="path must be the name of a file, got None"):
        load_orbits(None)


def test_a_run_s_loader_points_to_that_of_orbits(tmp_path):
    circle = sb.Harmonic.circular(acceleration=0.065, angular_frequency=2.0)
    orbit = sb.orbits.periodic_orbit(sb.Slender(sb.Column.dimensionless(0.1), damping=0.1), circle)
    with pytest.raises(FileError, match=r"stylobate\.load reads it"):
        sb.Run.load(orbit.save(tmp_path / "orbit.nc"))
    with pytest.raises(FileError, match="there is no such file"):
        sb.load(tmp_path / "none.nc")
    with pytest.raises(FileError, match="it is no store of a sweep"):
        sb.load(tmp_path)
