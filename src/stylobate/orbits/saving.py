"""Saving of orbits, branches and curves with their system, from which shooting recovers them."""

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from stylobate.engine.flow.periodic import PeriodicSystem
from stylobate.errors import FileError, ParameterError, UnsupportedError
from stylobate.provenance import provenance_of_run
from stylobate.results.storage import write_netcdf

ORBIT, BRANCH, CURVE = "stylobate orbit 1", "stylobate branch 1", "stylobate bifurcation curve 1"
"""Formats of the files of orbits, branches and curves."""

SUPERCRITICAL = {True: 1, False: 0, None: -1}
"""Code of a supercritical loss of stability in files and tables; −1 if undecided."""

SUPERCRITICAL_OF = {code: supercritical for supercritical, code in SUPERCRITICAL.items()}
"""Meaning of the code."""

_SUFFIX = ".nc"


def write(data: xr.Dataset, path: str | Path) -> Path:
    """Write the data of an orbit, a branch or a curve to the netCDF file `path`.

    Raises
    ------
    ParameterError
        If the path does not end in .nc.
    FileError
        If the file cannot be written.
    """
    path = path_of(path)
    if path.suffix != _SUFFIX:
        message = f"path must end in {_SUFFIX}, the format of the file; got {str(path)!r}"
        raise ParameterError(message)
    if not path.parent.is_dir():
        message = f"cannot write {path}: there is no folder {path.parent}"
        raise FileError(message)
    return write_netcdf(data, path)


def path_of(path: str | Path) -> Path:
    """Return `path`, or raise ParameterError if it is not the name of a file."""
    try:
        return Path(path)
    except TypeError:
        message = f"path must be the name of a file, got {path!r}"
        raise ParameterError(message) from None


def file_attributes(system: PeriodicSystem, format_name: str, periods: int) -> dict[str, Any]:
    """Return the attributes of a file: its format, the length of the orbit and the system.

    Raises
    ------
    UnsupportedError
        If model or motion is of a class of your own, which a file cannot hold.
    """
    provenance = provenance_of_run(system.model, system.motion)
    for name in ("model", "motion"):
        if provenance[name].get("kind") == "other":
            message = f"an orbit of a {name} of your own cannot be saved: {provenance[name]['repr']}"
            raise UnsupportedError(message)
    return {
        "format": format_name,
        "periods": periods,
        "line": np.array(system.line if system.line is not None else (math.nan, math.nan)),
        "rtol": system.rtol,
        "provenance": json.dumps(provenance),
    }
