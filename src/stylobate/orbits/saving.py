"""Orbits, branches and curves are saved with their system, from which they are shot again when they are read."""

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from stylobate.config import provenance_of_run
from stylobate.engine.flow.periodic import PeriodicSystem
from stylobate.errors import FileError, ParameterError, UnsupportedError
from stylobate.results.storage import write_netcdf

ORBIT, BRANCH, CURVE = "stylobate orbit 1", "stylobate branch 1", "stylobate bifurcation curve 1"
"""The formats of their files."""

SUPERCRITICAL = {True: 1, False: 0, None: -1}
"""Code in files and tables of whether a loss of stability is supercritical; −1 if that is undecided."""

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
        message = f"path must end in {_SUFFIX}, which is what is written; got {str(path)!r}"
        raise ParameterError(message)
    if not path.parent.is_dir():
        message = f"cannot write {path}: there is no folder {path.parent}"
        raise FileError(message)
    return write_netcdf(data, path)


def path_of(path: str | Path) -> Path:
    """Return `path`, or raise ParameterError if it is no name of a file."""
    try:
        return Path(path)
    except TypeError:
        message = f"path must be the name of a file, got {path!r}"
        raise ParameterError(message) from None


def file_attributes(system: PeriodicSystem, format_name: str, periods: int) -> dict[str, Any]:
    """Return what a file states of the system and the length of an orbit.

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
