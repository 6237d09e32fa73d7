"""Computation of one block of a sweep, shared by all executors."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate.engine import simulate_ensemble
from stylobate.errors import Interrupted
from stylobate.progress import Report
from stylobate.studies.sweeps.blocks import Block
from stylobate.studies.sweeps.quantities import Floats
from stylobate.studies.sweeps.recipe import Recipe

Arrays = dict[str, npt.NDArray[Any]]


@dataclass(frozen=True, slots=True)
class Task:
    """One block of runs with the values of the quantities that vary."""

    block: Block
    values: Mapping[str, Floats]


@dataclass(frozen=True, slots=True)
class Computed:
    """The results of a task, flat over its runs; `interrupted` if Ctrl-C stopped it before all were computed."""

    arrays: Arrays
    interrupted: bool = False


def compute(
    recipe: Recipe, values: Mapping[str, Floats], threads: int | None, progress: Report | None = None
) -> Computed:
    """Compute the runs of `recipe` at these `values`."""
    arguments = recipe.arguments(values)
    try:
        result = simulate_ensemble(recipe.model, recipe.motion, **arguments, threads=threads, progress=progress)
    except Interrupted as stop:
        return Computed(_arrays(stop.partial), interrupted=True)
    return Computed(_arrays(result))


def _arrays(result: xr.Dataset) -> Arrays:
    return {str(name): np.asarray(array.values) for name, array in result.data_vars.items()}
