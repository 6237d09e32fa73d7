"""Layout of a sweep's results: variables, types, sizes and fill values."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate.engine import simulate_ensemble
from stylobate.parameter_quantities import attributes_of
from stylobate.results.outcomes import NOT_COMPUTED
from stylobate.studies.sweeps.blocks import DISK_BLOCK, Block, Blocks
from stylobate.studies.sweeps.designs import Design, whole
from stylobate.studies.sweeps.recipe import Recipe

# Size of a value of a coordinate [bytes].
_FLOAT = 8


@dataclass(frozen=True, slots=True)
class Variable:
    """One result: an array over the runs and, for each run, over `dims` of `shape`."""

    name: str
    dtype: np.dtype[Any]
    dims: tuple[str, ...]
    shape: tuple[int, ...]
    attributes: Mapping[str, Any]

    @property
    def fill(self) -> Any:
        """Value for a run that is not computed: −1 for the outcome, NaN, 0 or False."""
        if self.name == "outcome":
            return NOT_COMPUTED
        return self.dtype.type(np.nan if self.dtype.kind == "f" else 0)

    @property
    def bytes_of_a_run(self) -> int:
        """Memory of the result of one run [bytes]."""
        return self.dtype.itemsize * math.prod(self.shape)

    def empty(self, runs: tuple[int, ...]) -> npt.NDArray[Any]:
        """Return an array of this shape of runs, filled with the value for runs that are not computed."""
        return np.full((*runs, *self.shape), self.fill, self.dtype)


@dataclass(frozen=True, slots=True)
class Layout:
    """The `variables` of a sweep's results, and the `labels` along the dimensions of each run."""

    variables: tuple[Variable, ...]
    labels: Mapping[str, list[Any]]


def layout_of(recipe: Recipe, names: tuple[str, ...]) -> Layout:
    """Determine the layout of a sweep's results over `names` from an ensemble without runs.

    Raises
    ------
    ParameterError
        If `simulate_ensemble` does not accept an option, or a name that varies.
    """
    nothing = {name: np.empty(0) for name in names}
    sample = simulate_ensemble(recipe.model, recipe.motion, **recipe.arguments(nothing))
    variables = []
    for name, array in sample.data_vars.items():
        own = {str(dim): size for dim, size in array.sizes.items() if dim != "run"}
        variables.append(Variable(str(name), array.dtype, tuple(own), tuple(own.values()), dict(array.attrs)))
    labels = {str(name): array.values.tolist() for name, array in sample.coords.items() if array.dims == (name,)}
    return Layout(tuple(variables), {name: values for name, values in labels.items() if name != "run"})


def dataset(
    design: Design, layout: Layout, arrays: Mapping[str, npt.NDArray[Any]], attributes: Mapping[str, Any]
) -> xr.Dataset:
    """Return `arrays`, each over all runs of the design, with their coordinates and attributes."""
    data = {
        variable.name: ((*design.dims, *variable.dims), arrays[variable.name], dict(variable.attributes))
        for variable in layout.variables
    }
    coordinates = {
        name: (design.coordinate_dims[name], values, attributes_of(name))
        for name, values in design.coordinates(whole(design)).items()
    }
    return xr.Dataset(data, coords={**coordinates, **layout.labels}, attrs=dict(attributes))


def bytes_on_disk(layout: Layout, design: Design, blocks: Blocks) -> int:
    """Return the maximum size of results and coordinates on disk [bytes]: no compression, whole disk blocks."""
    if not len(blocks):
        return DISK_BLOCK
    places = [design.dims.index(dim) for dim in design.coordinate_dims.values()]
    coordinates = sum(blocks.counts[place] * _on_disk(_FLOAT * blocks.edges[place]) for place in places)
    return len(blocks) * bytes_of_block(layout, blocks[0]) + coordinates


def bytes_of_block(layout: Layout, block: Block) -> int:
    """Return the maximum size of one `block` on disk, with its mark [bytes]."""
    sizes = (variable.bytes_of_a_run * block.size for variable in layout.variables)
    return DISK_BLOCK + sum(_on_disk(size) for size in sizes)


def _on_disk(size: int) -> int:
    """Return the maximum size of a chunk on disk; its compressed form can be larger by 1/256 and 72 bytes."""
    return -(-(size + size // 256 + 72) // DISK_BLOCK) * DISK_BLOCK
