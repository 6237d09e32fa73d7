"""Distance from a state to the nearest overturning initial condition on a grid."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Self

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate.errors import Outcome, ParameterError, require_finite
from stylobate.models import Model
from stylobate.parameter_quantities import quantity_of
from stylobate.results.outcomes import NOT_COMPUTED
from stylobate.studies.maps.stroboscopic import Floats
from stylobate.studies.sweeps.quantities import STARTS, checked_values

UNRESOLVED = (Outcome.FAILED, Outcome.LIFTED_OFF, Outcome.LIMIT_REACHED)
"""Outcomes of runs that end before overturning is decided."""


@dataclass(frozen=True, slots=True)
class Metric:
    """Metric of distances between initial conditions.

    Attributes
    ----------
    axes
        Values of each component along the grid [rad or rad/s], increasing.
    units
        Units of distances: c for tilts [rad], cω0 for tilt rates [rad/s].
    reference
        The state from which distances are measured.
    """

    axes: Mapping[str, Floats]
    units: Mapping[str, float]
    reference: Mapping[str, float]

    @classmethod
    def of(cls, model: Model, over: Mapping[str, npt.ArrayLike], reference: Mapping[str, float] | None) -> Self:
        """Return the metric of a column on the grid `over`.

        Raises
        ------
        ParameterError
            If a component has fewer than two values, its values do not increase, or the reference is not in the grid.
        """
        axes = {name: _increasing(name, values) for name, values in over.items() if name in STARTS}
        if not axes:
            message = f"over must name at least one of {', '.join(STARTS)}; got {', '.join(over) or 'nothing'}"
            raise ParameterError(message)
        c = model.column.slenderness
        units = {name: c / model.time_scale if "rate" in name else c for name in axes}
        chosen = dict(reference or {})
        for name in chosen:
            if name not in axes:
                message = f"reference must name starts of the grid, {', '.join(axes)}; got {name!r}"
                raise ParameterError(message)
        return cls(axes, units, {name: _within(name, chosen.get(name, 0.0), axis) for name, axis in axes.items()})

    @property
    def resolution(self) -> float:
        """Half the diagonal of the largest cell."""
        sides = [float(np.diff(axis).max()) / self.units[name] for name, axis in self.axes.items()]
        return float(np.hypot.reduce(sides)) / 2.0

    @property
    def reach(self) -> float:
        """Distance to the nearest edge of the grid."""
        return min(
            float(min(self.reference[name] - axis[0], axis[-1] - self.reference[name])) / self.units[name]
            for name, axis in self.axes.items()
        )

    def distances(self, dims: tuple[str, ...]) -> Floats:
        """Return the distance of every grid point over `dims`; other dimensions than components have length 1."""
        squares = np.zeros((1,) * len(dims))
        for name, axis in self.axes.items():
            shape = tuple(axis.size if dim == name else 1 for dim in dims)
            squares = squares + np.reshape(((axis - self.reference[name]) / self.units[name]) ** 2, shape)
        return np.asarray(np.sqrt(squares))


def distance_to_overturning(outcome: xr.DataArray, metric: Metric) -> xr.Dataset:
    """Compute the distance from the reference to the nearest grid point that overturned, with bounds.

    A grid point at the distance d that overturns proves that the boundary is no farther than d. The boundary may be
    nearer by up to the diagonal of a cell: if it is straight on the scale of the cells, at the distance r, there is a
    grid point behind it within r plus a diagonal. Folds and tongues finer than the cells may be nearer.

    Parameters
    ----------
    outcome
        Codes of the outcomes over the grid.
    metric
        Metric on the grid.

    Returns
    -------
    xarray.Dataset
        `distance`; `distance_low` and `distance_high`, between which the boundary lies; `at_least` (nothing overturned
        within the known part of the grid: then `distance` reaches to its edge, and `distance_high` is infinite);
        `resolution`, and `nearest` over `start`.
    """
    dims = tuple(str(dim) for dim in outcome.dims)
    codes = outcome.to_numpy()
    distances = np.broadcast_to(metric.distances(dims), codes.shape)
    overturned = np.where(codes == Outcome.OVERTURNED, distances, np.inf)
    unknown = np.where(np.isin(codes, [NOT_COMPUTED, *UNRESOLVED]), distances, np.inf)
    nearest, known = float(overturned.min(initial=np.inf)), min(float(unknown.min(initial=np.inf)), metric.reach)
    at_least = not nearest <= known
    place = np.unravel_index(int(np.argmin(overturned)), codes.shape) if codes.size else ()
    start = [np.nan if at_least else float(axis[place[dims.index(name)]]) for name, axis in metric.axes.items()]
    distance, diagonal = min(nearest, known), 2.0 * metric.resolution
    return xr.Dataset(
        {
            "distance": ((), distance, {"units": "1", "long_name": "distance to the nearest overturning run"}),
            "distance_low": (
                (),
                max(distance - diagonal, 0.0),
                {"units": "1", "long_name": "lower bound for a boundary smooth on the scale of the grid"},
            ),
            "distance_high": (
                (),
                np.inf if at_least else distance,
                {"units": "1", "long_name": "upper bound of the distance of the boundary"},
            ),
            "at_least": ((), at_least, {"long_name": "nothing overturned nearer than this"}),
            "resolution": ((), metric.resolution, {"units": "1", "long_name": "half the diagonal of a cell"}),
            "nearest": ("start", start, {"long_name": "nearest overturning initial condition"}),
        },
        coords={"start": np.array(list(metric.axes))},
    )


def _increasing(name: str, values: npt.ArrayLike) -> Floats:
    axis = checked_values("over", name, values)
    if axis.size < 2 or not np.all(np.diff(axis) > 0.0):  # noqa: PLR2004
        message = f"over[{name!r}] must be two or more increasing values, got {values!r}"
        raise ParameterError(message)
    return axis


def _within(name: str, value: float, axis: Floats) -> float:
    value = require_finite(f"reference[{name!r}]", value, quantity_of(name).unit)
    if not axis[0] <= value <= axis[-1]:
        message = f"reference[{name!r}] must lie within the grid, {axis[0]:g} to {axis[-1]:g}; got {value!r}"
        raise ParameterError(message)
    return value
