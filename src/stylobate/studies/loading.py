"""`load`: read any saved result."""

from pathlib import Path

import xarray as xr

from stylobate import orbits, results
from stylobate.errors import FileError, ParameterError
from stylobate.orbits.storage import load_orbits
from stylobate.results.storage import read_dataset
from stylobate.results.verdict import KIND
from stylobate.studies.sweeps.store import open_sweep

Orbits = orbits.PeriodicOrbit | orbits.Branch | orbits.BifurcationCurve


Result = results.Run | results.Verdict | results.Assessment | Orbits | xr.Dataset


def load(path: str | Path) -> Result:
    """Read a saved result of any kind.

    Parameters
    ----------
    path
        A netCDF file, or the store of a sweep.

    Returns
    -------
    Run, Verdict, PeriodicOrbit, Branch, BifurcationCurve, Assessment or xarray.Dataset
        The saved result; the result of a study or a sweep is a Dataset. Variables of a store are read on first use.

    Raises
    ------
    FileError
        If the file cannot be read, is damaged, or holds no result.
    """
    try:
        path = Path(path)
    except TypeError:
        raise ParameterError(f"path: no name of a file (got {path!r}). Pass the path of a saved result.") from None
    if path.is_dir():
        return open_sweep(path)
    data = read_dataset(path)
    written = str(data.attrs.get("format", ""))
    if written.startswith("stylobate assessment"):
        return results.Assessment.load(path)
    if written.startswith("stylobate run"):
        return results.Run.load(path)
    if written.startswith("stylobate "):
        return load_orbits(path)
    if data.attrs.get("kind") == KIND:
        return results.Verdict(data)
    if "kind" not in data.attrs:
        raise FileError(
            f"{path}: not saved by stylobate (got the variables {list(data.variables)}). Read it with xarray."
        )
    return data
