"""Runs at every combination of several choices: points of a sweep, and results over the choices."""

import math
from collections.abc import Mapping

import numpy as np
import numpy.typing as npt
import xarray as xr

Places = npt.NDArray[np.intp]


def crossed(lengths: Mapping[str, int]) -> dict[str, Places]:
    """Return flat arrays of the indices of each named choice over all combinations; the last choice varies fastest."""
    grids = np.indices(tuple(lengths.values()))
    return {name: grid.ravel() for name, grid in zip(lengths, grids, strict=True)}


def unfolded(runs: xr.Dataset, lengths: Mapping[str, int]) -> xr.Dataset:
    """Reshape `runs` from the dimension `run` to the dimensions of `crossed` choices; drop coordinates over `run`."""
    shape = tuple(lengths.values())
    assert runs.sizes["run"] == math.prod(shape)
    variables = {}
    for name, variable in runs.data_vars.items():
        ordered = variable.transpose("run", ...)
        values = ordered.to_numpy()
        dims = (*lengths, *ordered.dims[1:])
        variables[name] = xr.Variable(dims, values.reshape(*shape, *values.shape[1:]), variable.attrs)
    kept = {name: coordinate for name, coordinate in runs.coords.items() if "run" not in coordinate.dims}
    return xr.Dataset(variables, coords=kept, attrs=runs.attrs)
