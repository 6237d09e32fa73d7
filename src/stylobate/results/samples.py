"""The samples of a run as plain arrays, converted to a Dataset at first use because xarray is slow to import."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    import xarray as xr


class Labelled(NamedTuple):
    """An array with its labels, from which xarray makes a variable."""

    dimensions: tuple[str, ...]
    values: npt.NDArray[Any]
    attributes: Mapping[str, str]


@dataclass(frozen=True, slots=True)
class Samples:
    """Arrays along a run, by name.

    Parameters
    ----------
    time
        Times [s], shape (n,).
    variables
        Arrays with the dimensions "time", "axis" (x and y) and "direction" (x, y and z).
    attributes
        Attributes of the Dataset.
    """

    time: npt.NDArray[np.float64]
    variables: Mapping[str, Labelled]
    attributes: Mapping[str, float]

    def as_dataset(self) -> "xr.Dataset":
        """Make a Dataset of these arrays."""
        import xarray as xr

        coordinates = {
            "time": Labelled(("time",), self.time, {"units": "s", "long_name": "time"}),
            "axis": ["x", "y"],
            "direction": ["x", "y", "z"],
        }
        return xr.Dataset(self.variables, coords=coordinates, attrs=self.attributes)
