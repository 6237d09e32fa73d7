"""One function that reads any saved result."""

import numpy as np
import pytest
import xarray as xr

import stylobate as sb
from stylobate.errors import FileError, ParameterError
from stylobate.results.storage import write_netcdf

MODEL = sb.Slender(sb.Column.dimensionless(0.1), damping=0.1)
CIRCLE = sb.Harmonic.circular(acceleration=0.065, angular_frequency=2.0)
OVER = {"angular_frequency": [1.0, 2.0], "acceleration": [0.05, 0.3]}


def test_a_run_an_orbit_and_a_branch_are_read(tmp_path):
    run = sb.simulate(MODEL, CIRCLE, tilt=(0.03, 0.01), duration=5.0)
    again = sb.load(run.save(tmp_path / "run.nc"))
    assert again.outcome is run.outcome
    assert again.data.identical(run.data)
    orbit = sb.orbits.periodic_orbit(MODEL, CIRCLE)
    assert isinstance(sb.load(str(orbit.save(tmp_path / "orbit.nc"))), sb.orbits.PeriodicOrbit)
    branch = sb.orbits.continue_branch(orbit, parameter="angular_frequency", bounds=(1.95, 2.05))
    assert isinstance(sb.load(branch.save(tmp_path / "branch.nc")), sb.orbits.Branch)


def test_an_assessment_is_read(tmp_path):
    tables = {"verdicts": xr.Dataset({"tilt": ("run", np.linspace(0.0, 1.0, 5))})}
    saved = sb.results.Assessment(data=tables, setting={"title": "columns"}).save(tmp_path / "assessment.nc")
    assert sb.load(saved).setting == {"title": "columns"}


@pytest.mark.parametrize("write", [write_netcdf, lambda data, path: data.to_netcdf(path, engine="h5netcdf")])
def test_a_study_is_read_however_it_was_written(tmp_path, write):
    found = sb.studies.overturning_map(MODEL, CIRCLE, over=OVER, periods=3.0)
    write(found, tmp_path / "map.nc")
    again = sb.load(tmp_path / "map.nc")
    assert again.attrs["kind"] == "overturning map"
    xr.testing.assert_equal(again, found)


def test_a_store_is_read(tmp_path):
    sweep = sb.studies.Sweep.grid(MODEL, CIRCLE, over=OVER, periods=3.0)
    found = sb.studies.run_sweep(sweep, store=tmp_path / "runs.zarr")
    xr.testing.assert_equal(sb.load(tmp_path / "runs.zarr").load(), found.load())


def test_what_is_not_saved_by_stylobate_is_refused(tmp_path):
    path = tmp_path / "other.nc"
    xr.Dataset({"speed": ("time", [1.0, 2.0])}).to_netcdf(path, engine="h5netcdf")
    with pytest.raises(FileError, match=r"other\.nc: not saved by stylobate \(got the variables \['speed'\]\)"):
        sb.load(path)
    with pytest.raises(FileError, match="it is no store of a sweep"):
        sb.load(tmp_path)
    with pytest.raises(FileError, match="there is no such file"):
        sb.load(tmp_path / "none.nc")
    with pytest.raises(ParameterError, match=r"^path: no name of a file \(got None\)"):
        sb.load(None)
