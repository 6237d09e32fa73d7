"""Integrity: the distance from a state to the nearest initial condition that overturns, and its erosion."""

from collections.abc import Mapping
from dataclasses import dataclass, fields
from functools import partial
from typing import Any, Self, Unpack

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate.base_motions import BaseMotion
from stylobate.errors import Outcome, ParameterError, require_finite
from stylobate.models import Model
from stylobate.parameter_quantities import quantity_of
from stylobate.results.outcomes import NOT_COMPUTED
from stylobate.studies.checks import SYSTEM_STARTS, one_parameter, require_no_limits, require_starts, require_values
from stylobate.studies.maps.attractor_search import Floats
from stylobate.studies.study import StudyArguments, described, study
from stylobate.studies.sweeps import Sweep
from stylobate.studies.sweeps.designs import STARTS, checked_values
from stylobate.studies.sweeps.running import Label

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
            raise ParameterError(
                f"over must name at least one of {', '.join(STARTS)}; got {', '.join(over) or 'nothing'}"
            )
        c = model.column.slenderness
        units = {name: c / model.time_scale if "rate" in name else c for name in axes}
        chosen = dict(reference or {})
        for name in chosen:
            if name not in axes:
                raise ParameterError(f"reference must name starts of the grid, {', '.join(axes)}; got {name!r}")
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
        raise ParameterError(f"over[{name!r}] must be two or more increasing values, got {values!r}")
    return axis


def _within(name: str, value: float, axis: Floats) -> float:
    value = require_finite(f"reference[{name!r}]", value, quantity_of(name).unit)
    if not axis[0] <= value <= axis[-1]:
        raise ParameterError(
            f"reference[{name!r}] must lie within the grid, {axis[0]:g} to {axis[-1]:g}; got {value!r}"
        )
    return value


@study("integrity")
def integrity(
    model: Model,
    motion: BaseMotion | None = None,
    *,
    over: Mapping[str, npt.ArrayLike],
    reference: Mapping[str, float] | None = None,
    **run: Unpack[StudyArguments],
) -> tuple[Sweep, Label]:
    """Compute the distance from a state to the nearest initial condition that overturns.

    This is the local integrity measure of Soliman and Thompson, "Integrity measures quantifying the erosion of smooth
    and fractal basins of attraction", J. Sound Vib. 135 (1989), on a grid of initial conditions. Tilts are in units of
    c, tilt rates in units of cω0; distances are Euclidean. A start phase in `over` does not count towards the
    distance: the result is the distance at the worst phase.

    Parameters
    ----------
    model, motion
        The column and its base motion.
    over
        Values of each initial condition that varies, increasing: tilt_x, tilt_y [rad], tilt_rate_x, tilt_rate_y
        [rad/s], start_phase [rad]. `tilt` and `tilt_rate` set the others.
    reference
        State from which distances are measured, by the same names; 0 (a standing column) for names left out.
    **run

    Returns
    -------
    xarray.Dataset
        Of kind "integrity": the runs over the grid; `distance`; `resolution`, half the diagonal of the largest cell.
        The boundary lies between `distance_low` and `distance_high`. The upper end is the distance itself: a run at
        this distance overturned. The lower end is two resolutions less; it holds for boundaries that are smooth on the
        scale of the grid, and finer tongues may come nearer. `at_least` is True if no run overturned nearer than the
        edge of the grid, or nearer than a run of unknown outcome (failed, lifted off, not computed). `distance` then
        reaches to there, and `distance_high` is infinite. `nearest` is the nearest initial condition that overturned,
        over `start`; NaN if there is none.

    Raises
    ------
    ParameterError
        If an argument is out of range, a name in `over` is not an initial condition, the reference lies outside the
        grid, or `tilt_limit` is given: a run stopped there may still overturn.
    """
    require_starts("over", over)
    require_values("over", over)
    require_no_limits(run)
    metric = Metric.of(model, over, reference)
    sweep = Sweep.grid(model, motion, over=over, **described(run))
    label = partial(_integrity_of, metric=metric)
    return sweep, label


@study("erosion")
def erosion(
    model: Model,
    motion: BaseMotion | None = None,
    *,
    along: Mapping[str, npt.ArrayLike],
    over: Mapping[str, npt.ArrayLike],
    reference: Mapping[str, float] | None = None,
    **run: Unpack[StudyArguments],
) -> tuple[Sweep, Label]:
    """Compute the integrity measure along a parameter, such as a growing amplitude.

    Parameters
    ----------
    along
        One parameter of the model or the base motion, with its values, such as acceleration [m/s²].
    model, motion, over, reference
        As in `integrity`.
    **run

    Returns
    -------
    xarray.Dataset
        Of kind "erosion", over the parameter: `distance`, `distance_low`, `distance_high`, `resolution`, `at_least`
        and `nearest` as in `integrity`. `integrity` is the distance over the distance at the first value, between
        `integrity_low` and `integrity_high`. If `at_least` is True at the first value, all ratios are too high and
        their lower end is 0: use a grid that reaches farther.

    Raises
    ------
    ParameterError
        As in `integrity`; or if `along` does not have exactly one name, or changes the units of the distance.
    """
    require_starts("over", over)
    require_values("over", over)
    require_no_limits(run)
    metric = Metric.of(model, over, reference)
    name = _leaves_units(model, one_parameter(model, along, over)[0])
    sweep = Sweep.grid(model, motion, over={**along, **over}, **described(run))
    label = partial(_erosion_of, name=name, metric=metric)
    return sweep, label


def _integrity_of(runs: xr.Dataset, metric: Metric) -> xr.Dataset:
    measured = distance_to_overturning(runs["outcome"], metric)
    return runs.merge(measured).assign_attrs({**runs.attrs, **_metric_attributes(metric), "kind": "integrity"})


def _erosion_of(runs: xr.Dataset, name: str, metric: Metric) -> xr.Dataset:
    slices = [distance_to_overturning(runs["outcome"].isel({name: i}), metric) for i in range(runs.sizes[name])]
    measured = xr.concat(slices, dim=runs[name])
    attributes = {**runs.attrs, **_metric_attributes(metric), "kind": "erosion"}
    return measured.assign(_ratios(measured)).assign_attrs(attributes)


def _ratios(measured: xr.Dataset) -> dict[str, Any]:
    distance, least, largest = (measured[name].to_numpy() for name in ("distance", "distance_low", "distance_high"))
    first, dim = distance[0], measured["distance"].dims
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = np.where(first > 0.0, distance / first, np.nan)
        low = np.where(largest[0] > 0.0, least / largest[0], 0.0)
        high = np.where(least[0] > 0.0, largest / least[0], np.inf)
    return {
        "integrity": (dim, ratio, {"units": "1", "long_name": "integrity"}),
        "integrity_low": (
            dim,
            low,
            {"units": "1", "long_name": "lower bound of the integrity, for a boundary smooth on the scale of the grid"},
        ),
        "integrity_high": (dim, high, {"units": "1", "long_name": "upper bound of the integrity, for such a boundary"}),
    }


def _metric_attributes(metric: Metric) -> dict[str, float]:
    units = {f"unit_{name}": unit for name, unit in metric.units.items()}
    return units | {f"reference_{name}": value for name, value in metric.reference.items()}


def _leaves_units(model: Model, name: str) -> str:
    own = {field.name for field in fields(model.column)} | {"slenderness", "size"}
    if name in own or name in SYSTEM_STARTS:
        raise ParameterError(
            f"along must name a parameter of the model or the base motion, which leave the units; got {name!r}"
        )
    return name
