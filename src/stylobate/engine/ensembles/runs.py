"""Runs of an ensemble: their arguments, broadcast together, and the arrays of their results."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import numpy.typing as npt

from stylobate.engine.cost import require_memory
from stylobate.engine.forcing import without_dust
from stylobate.engine.kernel.columns import Change
from stylobate.engine.starts import RunStart, Turning, require_below_level
from stylobate.errors import ParameterError, require_size
from stylobate.models import Model
from stylobate.results.known_orbits import KnownOrbit, OrbitsOfRuns
from stylobate.results.outcomes import NOT_COMPUTED, NUMERICALLY_UNCERTAIN, outcome_attributes
from stylobate.run_arguments import EnsembleOptions

if TYPE_CHECKING:
    import xarray as xr

Floats = npt.NDArray[np.float64]
ArrayLike: TypeAlias = "npt.ArrayLike | xr.DataArray"

RUN, AXIS, COMPONENT = "run", "axis", "component"
"""Dimensions: the runs, x and y, and x, y and z."""
_COMPONENTS = {AXIS: 2, COMPONENT: 3}
_MASS_NAMES = ("mass", "transverse_inertia", "axial_inertia")


@dataclass(frozen=True, slots=True)
class EnsembleRuns:
    """Arguments that differ between the runs as flat arrays, and the layout of the results.

    Parameters
    ----------
    dims, shape
        Dimensions and shape of the results.
    tilt, tilt_rate
        Initial tilt vectors and rates, shape (n, 2) [rad], [rad/s].
    spin
        Angular velocity about the axis at the start, shape (n,) [rad/s].
    duration
        Shape (n,) [s].
    values
        Parameters by name, shape (n,).
    coordinates
        Coordinates of the results.
    turning
        Other initial conditions of each run; None without any.
    free
        Arrays of the arguments that only some models or runs have, by name.
    orbits
        The known orbits of each run; None without any.
    """

    dims: tuple[str, ...]
    shape: tuple[int, ...]
    tilt: Floats
    tilt_rate: Floats
    spin: Floats
    duration: Floats
    values: Mapping[str, Floats]
    coordinates: Mapping[str, "Given"]
    turning: tuple[Turning, ...] | None = None
    orbits: OrbitsOfRuns | None = None
    free: Mapping[str, Floats] = field(default_factory=dict)

    def __len__(self) -> int:
        return math.prod(self.shape)

    def part(self, chosen: slice | npt.NDArray[np.intp]) -> "EnsembleRuns":
        """Return some of the runs, without their layout."""
        length = len(self.duration[chosen])
        values = {name: value[chosen] for name, value in self.values.items()}
        starts = (self.tilt[chosen], self.tilt_rate[chosen], self.spin[chosen], self.duration[chosen])
        orbits = None if self.orbits is None else self.orbits.part(chosen)
        turning = self.turning and tuple(self.turning[k] for k in np.arange(len(self))[chosen])
        return EnsembleRuns((RUN,), (length,), *starts, values, {}, turning=turning, orbits=orbits)


def broadcast(
    tilt: ArrayLike,
    tilt_rate: ArrayLike,
    spin: ArrayLike,
    duration: ArrayLike,
    parameters: Mapping[str, ArrayLike],
    known_orbits: Sequence[KnownOrbit] = (),
    free: Mapping[str, ArrayLike] | None = None,
) -> EnsembleRuns:
    """Return the runs that these arguments describe; `free` are those that only some models or runs have.

    Raises
    ------
    ParameterError
        If an argument has a wrong shape, is not finite or out of range, or if two arguments are incompatible.
    """
    given = {"tilt": _vectors("tilt", tilt), "tilt_rate": _vectors("tilt_rate", tilt_rate)}
    given |= {"spin": _numbers("spin", spin), "duration": _numbers("duration", duration)}
    given |= {name: _numbers(name, value) for name, value in parameters.items()}
    vectors = {"position": AXIS, "velocity": COMPONENT}
    given |= {
        name: _vectors(name, value, vectors[name]) if name in vectors else _numbers(name, value)
        for name, value in (free or {}).items()
    }
    of_orbits = [_numbers_of_orbit(orbit, f"known_orbits[{k}]") for k, orbit in enumerate(known_orbits)]
    dims, shape = _common({**given, **{name: array for orbit in of_orbits for name, array in orbit.items()}})
    if not dims:
        dims, shape = (RUN,), (1,)
    flat = {name: _flat(array, dims, shape) for name, array in given.items()}
    _check(flat)
    values = {name: flat[name] for name in parameters}
    coordinates = {name: array for name, array in given.items() if set(array.dims) - _COMPONENTS.keys()}
    orbits = [{name.split(".")[1]: _flat(array, dims, shape) for name, array in orbit.items()} for orbit in of_orbits]
    return EnsembleRuns(
        *(dims, shape, without_dust(flat["tilt"]), flat["tilt_rate"], flat["spin"], flat["duration"]),
        *(values, coordinates),
        orbits=OrbitsOfRuns.of(orbits) if orbits else None,
        free={name: flat[name] for name in free or {}},
    )


@dataclass(frozen=True, slots=True)
class Given:
    """An argument: its values with the names of their dimensions, and the labels along these.

    A `DataArray` made of plain values would ask whether they are of Dask, and import it for half a second.
    """

    variable: "xr.Variable"
    coords: Mapping[str, "xr.DataArray"] = field(default_factory=dict)

    @property
    def dims(self) -> tuple[str, ...]:
        """Names of the dimensions."""
        return tuple(map(str, self.variable.dims))

    @property
    def sizes(self) -> Mapping[str, int]:
        """Length of each dimension."""
        return dict(zip(self.dims, self.variable.shape, strict=True))


def _numbers_of_orbit(orbit: KnownOrbit, place: str) -> dict[str, Given]:
    """Return the numbers of a known orbit, named by its position in the arguments."""
    vectors = ("tilt", "tilt_rate")
    return {
        f"{place}.{name}": (_vectors if name in vectors else _numbers)(f"{place}.{name}", value)
        for name, value in orbit.numbers().items()
    }


def one_run(start: RunStart) -> EnsembleRuns:
    """Return a single run, whose arguments have been checked."""
    vectors = (np.array([start.tilt]), np.array([start.tilt_rate]))
    numbers = (np.array([start.turning.spin]), np.array([start.duration]))
    return EnsembleRuns((RUN,), (1,), *vectors, *numbers, {}, {}, (start.turning,))


def _numbers(name: str, value: ArrayLike) -> Given:
    import xarray as xr

    if isinstance(value, xr.DataArray):
        return _labelled(name, value)
    array = _array(name, value)
    if array.ndim > 1:
        raise ParameterError(
            f"{name} must be a number, a list or a DataArray with named dimensions, got shape {array.shape}"
        )
    return Given(xr.Variable((RUN,) * array.ndim, array, fastpath=True))


def _vectors(name: str, value: ArrayLike, axis: str = AXIS) -> Given:
    import xarray as xr

    size = _COMPONENTS[axis]
    if isinstance(value, xr.DataArray):
        if value.sizes.get(axis) != size:
            raise ParameterError(f'{name} must have a dimension "{axis}" of length {size}, got {dict(value.sizes)}')
        return _labelled(name, value.drop_vars(axis, errors="ignore"))
    array = _array(name, value)
    if array.ndim not in (1, 2) or array.shape[-1] != size:
        raise ParameterError(f"{name} must have shape ({size},) or (n, {size}), got {array.shape}")
    return Given(xr.Variable((*((RUN,) * (array.ndim - 1)), axis), array, fastpath=True))


def _array(name: str, value: Any) -> Floats:
    try:
        return np.asarray(value, dtype=float)
    except (TypeError, ValueError):
        raise ParameterError(f"{name} must be a number or an array of numbers, got {value!r}") from None


def _labelled(name: str, value: "xr.DataArray") -> Given:
    return Given(
        value.variable.copy(data=_array(name, value.to_numpy())),
        {str(label): one for label, one in value.coords.items()},
    )


def _common(given: Mapping[str, Given]) -> tuple[tuple[str, ...], tuple[int, ...]]:
    labels: dict[str, tuple[str, xr.DataArray]] = {}
    for name, array in given.items():
        for dim in set(array.dims) & set(array.coords):
            other, index = labels.setdefault(dim, (name, array.coords[dim]))
            if array.sizes[dim] == index.size and not np.array_equal(array.coords[dim].to_numpy(), index.to_numpy()):
                raise ParameterError(f"{name} must have the same labels along {dim} as {other}; align them first")
    sizes: dict[str, int] = {}
    first: dict[str, str] = {}
    for name, array in given.items():
        for dim, size in array.sizes.items():
            if dim in _COMPONENTS:
                continue
            if sizes.setdefault(dim, size) != size:
                raise ParameterError(f"{name} must have {sizes[dim]} values along {dim} as {first[dim]}, got {size}")
            first.setdefault(dim, name)
    return tuple(sizes), tuple(sizes.values())


def _flat(array: Given, dims: tuple[str, ...], shape: tuple[int, ...]) -> Floats:
    own = [dim for dim in dims if dim in array.dims]
    tail = tuple(dim for dim in _COMPONENTS if dim in array.dims)
    order = (*own, *tail)
    values = (array.variable if array.dims == order else array.variable.transpose(*order)).values
    lengths = [array.sizes[dim] if dim in own else 1 for dim in dims]
    wide = np.broadcast_to(values.reshape(*lengths, *values.shape[len(own) :]), (*shape, *values.shape[len(own) :]))
    return wide.reshape(math.prod(shape), *values.shape[len(own) :])


def _check(flat: Mapping[str, Floats]) -> None:
    for name, array in flat.items():
        broken = ~np.isfinite(array)
        if broken.any():
            run = int(np.flatnonzero(broken.reshape(len(array), -1).any(axis=1))[0])
            where = f" in run {run}" if len(array) > 1 else ""
            raise ParameterError(f"{name} must be finite, got {float(array[broken][0])!r}{where}")
        require_size(name, float(np.abs(array).max(initial=0.0)), "kg" if name in _MASS_NAMES else "")
    require_below_level(flat["tilt"])
    if np.any(flat["duration"] <= 0.0):
        raise ParameterError(f"duration must be positive, got {float(flat['duration'].min())!r} s")


TIMES_OF_CONTACTS = tuple(column for column in Change if column.name.startswith("TIME_"))
CONTACT_KINDS = tuple(column.name.removeprefix("TIME_").lower() for column in TIMES_OF_CONTACTS)
"""Kinds of contact, in the order of their numbers."""

Arrays = dict[str, npt.NDArray[Any]]


@dataclass(frozen=True, slots=True)
class Variable:
    """Variable of the results: type, dimensions besides those of the runs, attributes, value if not computed."""

    dtype: type
    dims: tuple[str, ...]
    attributes: Mapping[str, Any]
    none: float = 0


def _declared_numbers(long_name: str, units: str, *dims: str) -> Variable:
    return Variable(np.float64, dims, {"long_name": long_name, "units": units}, np.nan)


_CONTACTS = (
    *(
        "strobe_footprint",
        "strobe_twist",
        "end_footprint",
        "end_twist",
        "end_contact",
        "mean_velocity",
        "mean_twist_rate",
        "impacts",
        "slips",
    ),
    *(f"time_{kind}" for kind in CONTACT_KINDS),
)


QUANTITIES: Mapping[str, Variable] = {
    "outcome": Variable(np.int8, (), outcome_attributes(), NOT_COMPUTED),
    "decided_at": _declared_numbers("time at which the outcome was decided", "s"),
    "end_time": _declared_numbers("end of the run", "s"),
    "uncertain": Variable(np.bool_, (), {"long_name": NUMERICALLY_UNCERTAIN}),
    "in_doubt": Variable(np.bool_, (), {"long_name": "finer thresholds or another tolerance could change the outcome"}),
    "planar": Variable(np.bool_, (), {"long_name": "moved in one vertical plane"}),
    "end_tilt": _declared_numbers("tilt vector at the end", "rad", "axis"),
    "end_tilt_rate": _declared_numbers("rate of the tilt vector at the end", "rad s-1", "axis"),
    "direction": _declared_numbers("azimuth in which it overturned", "rad"),
    "peak_tilt": _declared_numbers("peak tilt", "rad"),
    "time_of_peak_tilt": _declared_numbers("time of the peak tilt", "s"),
    "minimum_tilt": _declared_numbers("minimum tilt while it moves", "rad"),
    "turns": _declared_numbers("turns of the contact point", "1"),
    "mean_tilt": _declared_numbers("mean tilt over the last periods", "rad"),
    "phase": _declared_numbers(
        "phase of the tilt vector relative to the base acceleration, over the last periods", "rad"
    ),
    "mean_rolling_rate": _declared_numbers("mean rolling rate over the last periods", "rad s-1"),
    "repetition": _declared_numbers("change from period to period, over the last periods", "1"),
    "repeats_after": Variable(
        np.int8, (), {"long_name": "periods of the base motion after which the motion repeats; 0 if it does not"}
    ),
    "end_spin": _declared_numbers("angular velocity about the axis at the end", "rad s-1"),
    "would_slip": Variable(np.bool_, (), {"long_name": "needs more friction than friction_coefficient provides"}),
    "peak_friction_demand": _declared_numbers("peak friction force over normal force", "1"),
    "peak_pivoting_demand": _declared_numbers("peak moment about the vertical over normal force and radius", "1"),
    "minimum_normal_force": _declared_numbers("minimum normal force over weight", "1"),
    "end_footprint": _declared_numbers("centre of the footprint circle at the end", "m", "axis"),
    "end_twist": _declared_numbers("angle of turn about the axis at the end", "rad"),
    "end_contact": Variable(
        np.int8,
        (),
        {
            "long_name": "kind of contact at the end: "
            + ", ".join(f"{k} {kind}" for k, kind in enumerate(CONTACT_KINDS))
            + ", 5 jammed"
        },
    ),
    **{f"time_{kind}": _declared_numbers(f"time spent {kind}", "s") for kind in CONTACT_KINDS},
    "mean_velocity": _declared_numbers("mean velocity of the footprint over the last periods", "m s-1", "axis"),
    "mean_twist_rate": _declared_numbers("mean rate of the twist over the last periods", "rad s-1"),
    "impacts": Variable(np.int32, (), {"long_name": "landings and face impacts"}),
    "slips": Variable(np.int32, (), {"long_name": "times that a sticking contact began to slip"}),
    "uplifts": Variable(np.int32, (), {"long_name": "uplifts from rest"}),
    "steps": Variable(np.int32, (), {"long_name": "integration steps"}),
    "strobe_tilt": _declared_numbers("tilt vector at phase zero of the base motion", "rad", "strobe", "axis"),
    "strobe_tilt_rate": _declared_numbers("its rate at phase zero of the base motion", "rad s-1", "strobe", "axis"),
    "strobe_footprint": _declared_numbers("footprint at phase zero of the base motion", "m", "strobe", "axis"),
    "strobe_twist": _declared_numbers("angle of turn about the axis at phase zero of the base motion", "rad", "strobe"),
    "sample_time": _declared_numbers("time", "s", "sample"),
    "sampled_tilt": _declared_numbers("tilt vector", "rad", "sample", "axis"),
    "sampled_tilt_rate": _declared_numbers("rate of the tilt vector", "rad s-1", "sample", "axis"),
}


DEMANDS = ("peak_friction_demand", "peak_pivoting_demand", "minimum_normal_force")


def empty(model: Model, options: EnsembleOptions, count: int, *, slips: bool = False) -> Arrays:
    """Return arrays for the results of `count` runs, filled with the values for runs that are not computed.

    `slips` adds an array for runs with a friction coefficient.
    """
    sizes = {"axis": 2, "strobe": options["strobes"], "sample": options["samples"] or 0}
    left_out = {*(() if options["demands"] else DEMANDS), *(("end_spin",) if model.spin_state is None else ())}
    left_out |= {*(() if model.switches else _CONTACTS), *(() if slips else ("would_slip",))}
    shapes = {
        name: tuple(sizes[dim] for dim in quantity.dims)
        for name, quantity in QUANTITIES.items()
        if name not in left_out
    }
    shapes = {name: shape for name, shape in shapes.items() if 0 not in shape}
    bytes_of_a_run = sum(np.dtype(QUANTITIES[name].dtype).itemsize * math.prod(shape) for name, shape in shapes.items())
    require_memory(bytes_of_a_run * count, count, "Take fewer runs, samples or strobes")
    return {
        name: np.full((count, *shape), QUANTITIES[name].none, QUANTITIES[name].dtype) for name, shape in shapes.items()
    }
