"""Broadcasting of arguments by the names of their dimensions to flat arrays over the runs."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import numpy.typing as npt

from stylobate.engine.starts import Start, Turning, require_below_level
from stylobate.engine.thresholds import without_dust
from stylobate.errors import ParameterError, require_size
from stylobate.results.known_orbits import KnownOrbit, OrbitsOfRuns

if TYPE_CHECKING:
    import xarray as xr

Floats = npt.NDArray[np.float64]
ArrayLike: TypeAlias = "npt.ArrayLike | xr.DataArray"

RUN, AXIS = "run", "axis"
_MASS_NAMES = ("mass", "transverse_inertia", "axial_inertia")


@dataclass(frozen=True, slots=True)
class Runs:
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
        Other initial conditions of a single run; None in ensembles.
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
    coordinates: Mapping[str, "xr.DataArray"]
    turning: Turning | None = None
    orbits: OrbitsOfRuns | None = None

    def __len__(self) -> int:
        return math.prod(self.shape)

    def part(self, chosen: slice | npt.NDArray[np.intp]) -> "Runs":
        """Return some of the runs, without their layout."""
        length = len(self.duration[chosen])
        values = {name: value[chosen] for name, value in self.values.items()}
        starts = (self.tilt[chosen], self.tilt_rate[chosen], self.spin[chosen], self.duration[chosen])
        orbits = None if self.orbits is None else self.orbits.part(chosen)
        return Runs((RUN,), (length,), *starts, values, {}, orbits=orbits)


def broadcast(
    tilt: ArrayLike,
    tilt_rate: ArrayLike,
    spin: ArrayLike,
    duration: ArrayLike,
    parameters: Mapping[str, ArrayLike],
    known_orbits: Sequence[KnownOrbit] = (),
) -> Runs:
    """Return the runs that these arguments describe.

    Raises
    ------
    ParameterError
        If an argument has a wrong shape, is not finite or out of range, or if two arguments are incompatible.
    """
    given = {"tilt": _vectors("tilt", tilt), "tilt_rate": _vectors("tilt_rate", tilt_rate)}
    given |= {"spin": _numbers("spin", spin), "duration": _numbers("duration", duration)}
    given |= {name: _numbers(name, value) for name, value in parameters.items()}
    of_orbits = [_numbers_of_orbit(orbit, f"known_orbits[{k}]") for k, orbit in enumerate(known_orbits)]
    dims, shape = _common({**given, **{name: array for orbit in of_orbits for name, array in orbit.items()}})
    if not dims:
        dims, shape = (RUN,), (1,)
    flat = {name: _flat(array, dims, shape) for name, array in given.items()}
    _check(flat)
    values = {name: flat[name] for name in parameters}
    coordinates = {name: array for name, array in given.items() if array.dims and array.dims != (AXIS,)}
    orbits = [{name.split(".")[1]: _flat(array, dims, shape) for name, array in orbit.items()} for orbit in of_orbits]
    return Runs(
        *(dims, shape, without_dust(flat["tilt"]), flat["tilt_rate"], flat["spin"], flat["duration"]),
        *(values, coordinates),
        orbits=OrbitsOfRuns.of(orbits) if orbits else None,
    )


def _numbers_of_orbit(orbit: KnownOrbit, place: str) -> "dict[str, xr.DataArray]":
    """Return the numbers of a known orbit, named by its position in the arguments."""
    vectors = ("tilt", "tilt_rate")
    return {
        f"{place}.{name}": (_vectors if name in vectors else _numbers)(f"{place}.{name}", value)
        for name, value in orbit.numbers().items()
    }


def one_run(start: Start) -> Runs:
    """Return a single run, whose arguments have been checked."""
    vectors = (np.array([start.tilt]), np.array([start.tilt_rate]))
    numbers = (np.array([start.turning.spin]), np.array([start.duration]))
    return Runs((RUN,), (1,), *vectors, *numbers, {}, {}, start.turning)


def _numbers(name: str, value: ArrayLike) -> "xr.DataArray":
    import xarray as xr

    if isinstance(value, xr.DataArray):
        return _as_float(name, value)
    array = _array(name, value)
    if array.ndim > 1:
        message = f"{name} must be a number, a list or a DataArray with named dimensions, got shape {array.shape}"
        raise ParameterError(message)
    return xr.DataArray(array, dims=(RUN,) * array.ndim)


def _vectors(name: str, value: ArrayLike) -> "xr.DataArray":
    import xarray as xr

    if isinstance(value, xr.DataArray):
        if value.sizes.get(AXIS) != 2:  # noqa: PLR2004
            message = f'{name} must have a dimension "{AXIS}" of length 2, got {dict(value.sizes)}'
            raise ParameterError(message)
        return _as_float(name, value).drop_vars(AXIS, errors="ignore")
    array = _array(name, value)
    if array.ndim not in (1, 2) or array.shape[-1] != 2:  # noqa: PLR2004
        message = f"{name} must have shape (2,) or (n, 2), got {array.shape}"
        raise ParameterError(message)
    return xr.DataArray(array, dims=(*((RUN,) * (array.ndim - 1)), AXIS))


def _array(name: str, value: Any) -> Floats:
    try:
        return np.asarray(value, dtype=float)
    except (TypeError, ValueError):
        message = f"{name} must be a number or an array of numbers, got {value!r}"
        raise ParameterError(message) from None


def _as_float(name: str, value: "xr.DataArray") -> "xr.DataArray":
    return value.copy(data=_array(name, value.to_numpy()))


def _common(given: Mapping[str, "xr.DataArray"]) -> tuple[tuple[str, ...], tuple[int, ...]]:
    labels: dict[str, tuple[str, xr.DataArray]] = {}
    for name, array in given.items():
        for dim in set(array.dims) & set(array.coords):
            other, index = labels.setdefault(str(dim), (name, array[dim]))
            if array.sizes[dim] == index.size and not np.array_equal(array[dim].to_numpy(), index.to_numpy()):
                message = f"{name} must have the same labels along {dim} as {other}; align them first"
                raise ParameterError(message)
    sizes: dict[str, int] = {}
    first: dict[str, str] = {}
    for name, array in given.items():
        for dim, size in array.sizes.items():
            if dim == AXIS:
                continue
            if sizes.setdefault(str(dim), size) != size:
                message = f"{name} must have {sizes[str(dim)]} values along {dim} as {first[str(dim)]}, got {size}"
                raise ParameterError(message)
            first.setdefault(str(dim), name)
    return tuple(sizes), tuple(sizes.values())


def _flat(array: "xr.DataArray", dims: tuple[str, ...], shape: tuple[int, ...]) -> Floats:
    own = [dim for dim in dims if dim in array.dims]
    tail = (AXIS,) if AXIS in array.dims else ()
    order = (*own, *tail)
    values = (array if array.dims == order else array.transpose(*order)).to_numpy()
    lengths = [array.sizes[dim] if dim in own else 1 for dim in dims]
    wide = np.broadcast_to(values.reshape(*lengths, *values.shape[len(own) :]), (*shape, *values.shape[len(own) :]))
    return wide.reshape(math.prod(shape), *values.shape[len(own) :])


def _check(flat: Mapping[str, Floats]) -> None:
    for name, array in flat.items():
        broken = ~np.isfinite(array)
        if broken.any():
            run = int(np.flatnonzero(broken.reshape(len(array), -1).any(axis=1))[0])
            where = f" in run {run}" if len(array) > 1 else ""
            message = f"{name} must be finite, got {float(array[broken][0])!r}{where}"
            raise ParameterError(message)
        require_size(name, float(np.abs(array).max(initial=0.0)), "kg" if name in _MASS_NAMES else "")
    require_below_level(flat["tilt"])
    if np.any(flat["duration"] <= 0.0):
        message = f"duration must be positive, got {float(flat['duration'].min())!r} s"
        raise ParameterError(message)
